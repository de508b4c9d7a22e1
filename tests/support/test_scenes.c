// SPDX-License-Identifier: MIT
#include "test_scenes.h"

#include "scene/scene.h"

#include <math.h>

static float vertices[TEST_VERTEX_LIMIT][3];
static uint32_t triangles[TEST_TRIANGLE_LIMIT][3];

test_mesh *test_mesh_start(void)
{
    static test_mesh mesh;
    mesh = (test_mesh){.positions = vertices, .triangles = triangles};
    return &mesh;
}

uint32_t test_mesh_vertex(test_mesh *mesh, double x, double y, double z)
{
    assert_true(mesh->vertex_count < TEST_VERTEX_LIMIT);
    float *p = mesh->positions[mesh->vertex_count];
    p[0] = (float)x;
    p[1] = (float)y;
    p[2] = (float)z;
    return mesh->vertex_count++;
}

void test_mesh_triangle(test_mesh *mesh, uint32_t a, uint32_t b, uint32_t c)
{
    assert_true(mesh->triangle_count < TEST_TRIANGLE_LIMIT);
    uint32_t *t = mesh->triangles[mesh->triangle_count++];
    t[0] = a;
    t[1] = b;
    t[2] = c;
}

void test_mesh_quad(test_mesh *mesh, const double p[3], const double u[3], const double v[3])
{
    uint32_t a = test_mesh_vertex(mesh, p[0], p[1], p[2]);
    uint32_t b = test_mesh_vertex(mesh, p[0] + u[0], p[1] + u[1], p[2] + u[2]);
    uint32_t c = test_mesh_vertex(mesh, p[0] + u[0] + v[0], p[1] + u[1] + v[1], p[2] + u[2] + v[2]);
    uint32_t d = test_mesh_vertex(mesh, p[0] + v[0], p[1] + v[1], p[2] + v[2]);
    test_mesh_triangle(mesh, a, b, c);
    test_mesh_triangle(mesh, a, c, d);
}

void test_mesh_sphere(test_mesh *mesh, const double center[3], double radius, int slices,
                      int stacks, double y_cut, int outside)
{
    const double end = acos(-y_cut); // polar angle from the −y pole
    uint32_t first = mesh->vertex_count;
    for (int j = 0; j <= stacks; j++) {
        double theta = end * j / stacks;
        for (int i = 0; i < slices; i++) {
            double phi = 2.0 * ALPI_PI * i / slices;
            test_mesh_vertex(mesh, center[0] + radius * sin(theta) * cos(phi),
                             center[1] - radius * cos(theta),
                             center[2] + radius * sin(theta) * sin(phi));
        }
    }
    for (int j = 0; j < stacks; j++) {
        for (int i = 0; i < slices; i++) {
            uint32_t a = first + (uint32_t)(j * slices + i);
            uint32_t b = first + (uint32_t)(j * slices + (i + 1) % slices);
            uint32_t c = a + (uint32_t)slices, d = b + (uint32_t)slices;
            if (j > 0) {
                test_mesh_triangle(mesh, a, outside ? d : b, outside ? b : d);
            }
            if (j + 1 < stacks || y_cut < 1.0) {
                test_mesh_triangle(mesh, a, outside ? c : d, outside ? d : c);
            }
        }
    }
}

alp_scene *test_mesh_scene(alp_context *context, const test_mesh *mesh, int double_sided)
{
    alp_mesh m = {.name = "test",
                  .vertex_count = mesh->vertex_count,
                  .positions = mesh->positions[0],
                  .triangle_count = mesh->triangle_count,
                  .indices = mesh->triangles[0],
                  .base_color = {0.5f, 0.5f, 0.5f},
                  .double_sided = double_sided != 0};
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, &m, 1, &scene));
    return scene;
}

typedef struct point {
    double x, y, z;
} point;

static double dot(point a, point b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static point cross(point a, point b)
{
    return (point){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

enum { CORNER_LIMIT = 2048 };

/// Keeps what lies above the plane through the origin with normal n.
static int clip(const point *in, int count, point n, point *out)
{
    int kept = 0;
    for (int i = 0; i < count; i++) {
        point a = in[i], b = in[(i + 1) % count];
        double da = dot(a, n), db = dot(b, n);
        if (da >= 0.0) {
            out[kept++] = a;
        }
        if ((da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0)) {
            double t = da / (da - db);
            out[kept++] =
                (point){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
        }
    }
    return kept;
}

double test_polygon_form_factor(const double p[3], const double normal[3],
                                const double (*corners)[3], int count)
{
    static point moved[CORNER_LIMIT], clipped[2 * CORNER_LIMIT];
    assert_true(count <= CORNER_LIMIT);
    point n = {normal[0], normal[1], normal[2]};
    for (int i = 0; i < count; i++) {
        moved[i] = (point){corners[i][0] - p[0], corners[i][1] - p[1], corners[i][2] - p[2]};
    }
    int kept = clip(moved, count, n, clipped);
    double sum = 0.0;
    for (int i = 0; i < kept; i++) {
        point a = clipped[i], b = clipped[(i + 1) % kept];
        point c = cross(a, b);
        double length = sqrt(dot(c, c));
        if (length > 0.0) {
            sum += atan2(length, dot(a, b)) * dot(n, c) / length;
        }
    }
    return fabs(sum) / (2.0 * ALPI_PI);
}

double test_occlusion(const alp_scene *scene, const double position[3], const double normal[3],
                      const alp_occlusion_options *options)
{
    float p[3], n[3], value = -1.0f;
    for (int k = 0; k < 3; k++) {
        p[k] = (float)position[k];
        n[k] = (float)normal[k];
    }
    ASSERT_OK(scene->context, alp_occlusion_at_points(scene, 1, p, NULL, n, options, &value));
    return (double)value;
}
