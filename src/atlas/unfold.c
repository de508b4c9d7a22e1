// SPDX-License-Identifier: MIT
// As rigid as possible: every triangle is turned to fit where its corners lie, then the corners are
// laid where the turned triangles want their edges, and again. The second step is one sparse linear
// system, the same each time, solved by conjugate gradients in double.
// Conformal maps (LSCM) were not taken: they keep angles and pay with density, which an atlas needs
// to be even; this map keeps lengths, and is exact on what can be unrolled.
// Based on: L. Liu, L. Zhang, Y. Xu, C. Gotsman, S. J. Gortler. A Local/Global Approach to Mesh
// Parameterization. SGP, 2008.
#include "atlas/patch.h"

#include "base/memory.h"

#include <math.h>

// Cotangents of slivers and of obtuse triangles are kept within these: then all weights are
// positive, and the system is well enough conditioned. Rigid triangles stay what it asks for.
static const double LEAST_WEIGHT = 0.05, LARGEST_WEIGHT = 20.0;
// Accuracy of the linear system: residual against its right side. What comes out is judged anyway.
static const double RESIDUAL = 3e-4;

/// What a vertex is tied to.
typedef struct tie {
    uint32_t vertex;
    double weight;
} tie;

typedef struct unfolder {
    alpi_patch *patch;
    double (*weights)[3];       // [count] of edges corner k → k + 1
    uint32_t *first;            // [vertex_count + 1] in ties: room for each vertex
    uint32_t *end;              // [vertex_count] in ties
    tie *ties;                  // the matrix off its diagonal
    double (*wanted)[2];        // [vertex_count] right side
    double (*residual)[2];      // [vertex_count]
    double (*step)[2];          // [vertex_count] direction
    double (*image)[2];         // [vertex_count] the matrix times the direction
    double *diagonal, *inverse; // [vertex_count] and one over it
} unfolder;

static alp_result unfolder_create(unfolder *u)
{
    alp_context *context = u->patch->context;
    const size_t n = u->patch->vertex_count;
    ALPI_TRY_NEW(context, u->weights, u->patch->count);
    ALPI_TRY_NEW(context, u->first, n + 1);
    ALPI_TRY_NEW(context, u->end, n);
    ALPI_TRY_NEW(context, u->ties, 6 * (size_t)u->patch->count);
    ALPI_TRY_NEW(context, u->wanted, n);
    ALPI_TRY_NEW(context, u->residual, n);
    ALPI_TRY_NEW(context, u->step, n);
    ALPI_TRY_NEW(context, u->image, n);
    ALPI_TRY_NEW(context, u->diagonal, n);
    ALPI_TRY_NEW(context, u->inverse, n);
    return ALP_OK;
}

static void unfolder_destroy(unfolder *u)
{
    alp_context *context = u->patch->context;
    alpi_release(context, u->weights);
    alpi_release(context, u->first);
    alpi_release(context, u->end);
    alpi_release(context, u->ties);
    alpi_release(context, u->wanted);
    alpi_release(context, u->residual);
    alpi_release(context, u->step);
    alpi_release(context, u->image);
    alpi_release(context, u->diagonal);
    alpi_release(context, u->inverse);
}

/// Edge k of a triangle in its own plane.
static void flat_edge(const double flat[3], int k, double edge[2])
{
    edge[0] = k == 0 ? flat[0] : k == 1 ? flat[1] - flat[0] : -flat[1];
    edge[1] = k == 0 ? 0.0 : k == 1 ? flat[2] : -flat[2];
}

static void weigh(unfolder *u)
{
    const alpi_patch *p = u->patch;
    for (uint32_t i = 0; i < p->count; i++) {
        const double twice_area = p->flat[i][0] * p->flat[i][2];
        for (int k = 0; k < 3; k++) { // half the cotangent of the opposite corner
            double to[2], from[2];
            flat_edge(p->flat[i], (k + 1) % 3, to);
            flat_edge(p->flat[i], (k + 2) % 3, from);
            const double dot = -(to[0] * from[0] + to[1] * from[1]);
            const double cotangent = twice_area > 0.0 ? dot / twice_area : LARGEST_WEIGHT;
            const double w = fmin(fmax(0.5 * cotangent, LEAST_WEIGHT), LARGEST_WEIGHT);
            u->weights[i][k] = w;
            u->diagonal[p->vertices[i][k]] += w;
            u->diagonal[p->vertices[i][(k + 1) % 3]] += w;
        }
    }
}

static void tie_vertices(unfolder *u, uint32_t from, uint32_t to, double weight)
{
    uint32_t i = u->first[from];
    while (i < u->end[from] && u->ties[i].vertex != to) {
        i++;
    }
    if (i == u->end[from]) {
        u->ties[u->end[from]++] = (tie){.vertex = to};
    }
    u->ties[i].weight += weight;
}

/// The matrix, row by row: every edge once, with the weights of both its triangles.
static void fill_matrix(unfolder *u)
{
    const alpi_patch *p = u->patch;
    for (uint32_t i = 0; i < 3 * p->count; i++) { // two edges at each corner
        u->first[p->vertices[i / 3][i % 3] + 1] += 2;
    }
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        u->inverse[v] = 1.0 / u->diagonal[v]; // of at least two edges
        u->first[v + 1] += u->first[v];
        u->end[v] = u->first[v];
    }
    for (uint32_t i = 0; i < p->count; i++) {
        for (int k = 0; k < 3; k++) {
            const uint32_t a = p->vertices[i][k], b = p->vertices[i][(k + 1) % 3];
            tie_vertices(u, a, b, u->weights[i][k]);
            tie_vertices(u, b, a, u->weights[i][k]);
        }
    }
}

/// Turns every triangle to fit where its corners lie, and sums what its edges want at the vertices.
static void turn_triangles(unfolder *u)
{
    const alpi_patch *p = u->patch;
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        u->wanted[v][0] = u->wanted[v][1] = 0.0;
    }
    for (uint32_t i = 0; i < p->count; i++) {
        double edges[3][2], cosine = 0.0, sine = 0.0;
        for (int k = 0; k < 3; k++) {
            const double *a = p->at[p->vertices[i][k]], *b = p->at[p->vertices[i][(k + 1) % 3]];
            const double x = b[0] - a[0], y = b[1] - a[1], w = u->weights[i][k];
            flat_edge(p->flat[i], k, edges[k]);
            cosine += w * (edges[k][0] * x + edges[k][1] * y);
            sine += w * (edges[k][0] * y - edges[k][1] * x);
        }
        const double length = sqrt(cosine * cosine + sine * sine);
        cosine = length > 0.0 ? cosine / length : 1.0;
        sine = length > 0.0 ? sine / length : 0.0;
        for (int k = 0; k < 3; k++) {
            const double w = u->weights[i][k];
            const double x = w * (cosine * edges[k][0] - sine * edges[k][1]);
            const double y = w * (sine * edges[k][0] + cosine * edges[k][1]);
            double *a = u->wanted[p->vertices[i][k]], *b = u->wanted[p->vertices[i][(k + 1) % 3]];
            a[0] -= x;
            a[1] -= y;
            b[0] += x;
            b[1] += y;
        }
    }
}

/// image = the matrix times `of`.
static void apply(unfolder *u, const double (*of)[2])
{
    for (uint32_t v = 0; v < u->patch->vertex_count; v++) {
        double x = u->diagonal[v] * of[v][0], y = u->diagonal[v] * of[v][1];
        for (uint32_t i = u->first[v]; i < u->end[v]; i++) {
            const double *other = of[u->ties[i].vertex];
            x -= u->ties[i].weight * other[0];
            y -= u->ties[i].weight * other[1];
        }
        u->image[v][0] = x;
        u->image[v][1] = y;
    }
}

/// Where the solver begins: the residual at the start, and the first direction. Gives the
/// residual's size, in which the right side is `goal`.
static double begin_solving(unfolder *u, double *goal)
{
    const alpi_patch *p = u->patch;
    double rho = 0.0, size = 0.0;
    apply(u, (const double(*)[2])p->at);
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        for (int k = 0; k < 2; k++) {
            const double r = u->wanted[v][k] - u->image[v][k];
            u->residual[v][k] = r;
            u->step[v][k] = r * u->inverse[v];
            rho += r * r * u->inverse[v];
            size += u->wanted[v][k] * u->wanted[v][k] * u->inverse[v];
        }
    }
    *goal = size;
    return rho;
}

/// Goes on along the direction; the size of the residual then.
static double make_step(unfolder *u, double rho)
{
    const uint32_t n = u->patch->vertex_count;
    apply(u, (const double(*)[2])u->step);
    double curvature = 0.0, next = 0.0;
    for (uint32_t v = 0; v < n; v++) {
        curvature += u->step[v][0] * u->image[v][0] + u->step[v][1] * u->image[v][1];
    }
    const double length = curvature > 0.0 ? rho / curvature : 0.0;
    for (uint32_t v = 0; v < n; v++) {
        const double x = u->residual[v][0] - length * u->image[v][0];
        const double y = u->residual[v][1] - length * u->image[v][1];
        u->patch->at[v][0] += length * u->step[v][0];
        u->patch->at[v][1] += length * u->step[v][1];
        u->residual[v][0] = x;
        u->residual[v][1] = y;
        next += (x * x + y * y) * u->inverse[v];
    }
    const double turn = next / rho;
    for (uint32_t v = 0; v < n; v++) {
        u->step[v][0] = u->residual[v][0] * u->inverse[v] + turn * u->step[v][0];
        u->step[v][1] = u->residual[v][1] * u->inverse[v] + turn * u->step[v][1];
    }
    return next;
}

/// Conjugate gradients with the diagonal as preconditioner, for both coordinates at once. The
/// matrix leaves a common shift open, and neither the right side nor a start's residual has one.
static void lay_vertices(unfolder *u)
{
    double goal, rho = begin_solving(u, &goal);
    const uint32_t limit = 20 + 4 * (uint32_t)sqrt((double)u->patch->vertex_count);
    for (uint32_t round = 0; round < limit && rho > RESIDUAL * RESIDUAL * goal; round++) {
        rho = make_step(u, rho);
    }
}

alp_result alpi_patch_unfold(alpi_patch *patch, int steps)
{
    unfolder u = {.patch = patch};
    const alp_result result = unfolder_create(&u);
    if (result == ALP_OK) {
        weigh(&u);
        fill_matrix(&u);
        for (int i = 0; i < steps; i++) {
            turn_triangles(&u);
            lay_vertices(&u);
        }
    }
    unfolder_destroy(&u);
    return result;
}
