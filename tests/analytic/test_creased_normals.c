// SPDX-License-Identifier: MIT
// Smooth normals over creases describe no smooth surface: a roof keeps the shadow of its ridge, a
// round tower the shadow of its ledge.
#include "test_support.h"

#include "maps/lightmap.h"

#include <math.h>

#define PI 3.14159265358979323846

TEST_CONTEXT(2);

enum { VERTEX_LIMIT = 1024 };
static float positions[VERTEX_LIMIT][3], normals[VERTEX_LIMIT][3];
static uint32_t triangles[VERTEX_LIMIT][3];

static alp_mesh start_mesh(const char *name)
{
    return (alp_mesh){.name = name,
                      .positions = positions[0],
                      .normals = normals[0],
                      .indices = triangles[0],
                      .base_color = {0.5f, 0.5f, 0.5f}};
}

static uint32_t add_vertex(alp_mesh *mesh, const double p[3], const double n[3])
{
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; k++) {
        positions[mesh->vertex_count][k] = (float)p[k];
        normals[mesh->vertex_count][k] = (float)(n[k] / length);
    }
    return mesh->vertex_count++;
}

/// Corners counter-clockwise from outside.
static void add_quad(alp_mesh *mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    memcpy(triangles[mesh->triangle_count++], (uint32_t[]){a, b, c}, sizeof *triangles);
    memcpy(triangles[mesh->triangle_count++], (uint32_t[]){a, c, d}, sizeof *triangles);
}

/// Direct light of a sun, in charts. @param elevation, azimuth radians
static alp_lightmap *bake_sun(const alp_mesh *mesh, float azimuth, float elevation,
                              alp_scene **scene)
{
    alp_lightmap *lightmap = NULL;
    alp_bake_options o = test_light_options(256);
    o.light.bounces = 0;
    o.light.samples = 8;
    o.light.lighting.sun.illuminance = 1e5f;
    o.light.lighting.sun.azimuth = azimuth;
    o.light.lighting.sun.elevation = elevation;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, mesh, 1, scene));
    ASSERT_OK(context, alp_bake(*scene, &o, &lightmap, NULL));
    return lightmap;
}

static vec3 texel_place(const alp_lightmap *lightmap, uint32_t i, vec3 *normal)
{
    const alpi_texels *t = &lightmap->texels;
    vec3 c[3];
    alpi_triangle_corners(lightmap->scene, t->triangles[i], c);
    const float *b = t->barycentrics[i];
    *normal = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0, 0, 0});
    return vec3_mad(vec3_mad(c[0], b[0], vec3_sub(c[1], c[0])), b[1], vec3_sub(c[2], c[0]));
}

static double texel_light(const alp_lightmap *lightmap, uint32_t i)
{
    const alpi_texels *t = &lightmap->texels;
    uint32_t width = 0;
    const float *page = alp_lightmap_map_page(lightmap, ALP_MAP_LIGHT, t->pages[i], &width, NULL);
    return (double)page[4 * ((size_t)t->pixels[i][1] * width + t->pixels[i][0])];
}

/// Slopes of 37°, whose eaves have the slopes' normals (averaged 0) or those averaged with walls.
static alp_mesh make_roof(bool averaged)
{
    alp_mesh mesh = start_mesh("roof");
    uint32_t v[6];
    for (int side = 0; side < 3; side++) { // front eave, ridge, back eave
        const double z = 2.0 * (1 - side), out = averaged ? 0.45 : 0.8,
                     along = averaged ? 0.89 : 0.6;
        const double n[3] = {0, side == 1 ? 1.0 : out, along * (1 - side)};
        for (int x = 0; x < 2; x++) {
            const double p[3] = {x == 0 ? -4 : 4, side == 1 ? 3.5 : 2.0, z};
            v[2 * side + x] = add_vertex(&mesh, p, n);
        }
    }
    add_quad(&mesh, v[0], v[1], v[3], v[2]);
    add_quad(&mesh, v[2], v[3], v[5], v[4]);
    return mesh;
}

/// The sun stands behind the far slope, 3° below its plane but above the ridge's tangent plane.
TEST(a_ridge_shadows_its_far_slope)
{
    for (int averaged = 0; averaged < 2; averaged++) {
        const alp_mesh mesh = make_roof(averaged != 0);
        alp_scene *scene = NULL;
        // −z is the sun's side.
        alp_lightmap *lightmap = bake_sun(&mesh, (float)PI, (float)(34.0 * PI / 180.0), &scene);
        uint32_t dark = 0, lit = 0;
        for (uint32_t i = 0; i < lightmap->texels.count; i++) {
            vec3 normal;
            const vec3 place = texel_place(lightmap, i, &normal);
            if (normal.z > 0.0f && place.z > 0.1f) { // texels at the ridge are of both slopes
                ASSERT_NEAR(texel_light(lightmap, i), 0.0, 0.0);
                dark++;
            } else {
                lit += texel_light(lightmap, i) > 0.0;
            }
        }
        assert_true(dark > 1000 && lit > 1000);
        alp_lightmap_destroy(lightmap);
        alp_scene_destroy(scene);
    }
}

static void add_ring(alp_mesh *mesh, uint32_t sides, double radius, double y, double up)
{
    for (uint32_t s = 0; s < sides; s++) {
        const double a = 2.0 * PI * s / sides, p[3] = {radius * sin(a), y, radius * cos(a)};
        const double n[3] = {up != 0.0 ? 0.0 : sin(a), up, up != 0.0 ? 0.0 : cos(a)};
        (void)add_vertex(mesh, p, n);
    }
}

/// A round wall of radius 2 m and height 4 m with smooth normals, over it a flat ledge, .3 m wide.
static alp_mesh make_tower(uint32_t sides)
{
    alp_mesh mesh = start_mesh("tower");
    add_ring(&mesh, sides, 2.0, 0.0, 0.0);
    add_ring(&mesh, sides, 2.0, 4.0, 0.0);
    add_ring(&mesh, sides, 2.0, 4.0, -1.0);
    add_ring(&mesh, sides, 2.3, 4.0, -1.0);
    for (uint32_t s = 0; s < sides; s++) {
        const uint32_t next = (s + 1) % sides;
        add_quad(&mesh, s, next, sides + next, sides + s);
        add_quad(&mesh, 3 * sides + s, 2 * sides + s, 2 * sides + next, 3 * sides + next);
    }
    return mesh;
}

/// At 60° a ledge of .3 m shadows .52 m of the wall that faces the sun, and more beside it.
TEST(a_ledge_shadows_its_round_wall)
{
    static const uint32_t sides[] = {6, 8, 12, 24};
    for (int k = 0; k < 4; k++) {
        const alp_mesh mesh = make_tower(sides[k]);
        alp_scene *scene = NULL;
        alp_lightmap *lightmap = bake_sun(&mesh, (float)PI, (float)(PI / 3.0), &scene);
        uint32_t dark = 0, lit = 0, faulty = 0;
        for (uint32_t i = 0; i < lightmap->texels.count; i++) {
            vec3 normal;
            const vec3 place = texel_place(lightmap, i, &normal);
            const double side = 0.1; // m, three texels
            const double low = 4.0 - 0.3 * cos(PI / sides[k]) * tan(PI / 3.0);
            if (normal.z < -0.7f && (double)place.y > low + side) {
                faulty += texel_light(lightmap, i) > 100.0; // stitching brings less
                dark++;
            } else if (normal.z < -0.7f && (double)place.y < 3.0) {
                lit += texel_light(lightmap, i) > 0.0;
            }
        }
        print_message("%u sides: %u texels in the ledge's shadow, %u lit; %u lit below\n", sides[k],
                      dark, faulty, lit);
        assert_int_equal(faulty, 0);
        assert_true(dark > 100 && lit > 100);
        alp_lightmap_destroy(lightmap);
        alp_scene_destroy(scene);
    }
}
