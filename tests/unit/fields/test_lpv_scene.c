// SPDX-License-Identifier: MIT
// Light propagation in scenes: flux of lamps against closed forms, surfaces of all kinds, and the
// same bits for any number of workers.
#include "field_scenes.h"
#include "lpv_volumes.h"

#include <stdio.h>

TEST_CONTEXT(2);

static const vec3 none = {0.0f, 0.0f, 0.0f};

/// A floor of side² about the origin that faces up, alone.
static alp_scene *floor_scene(float side, vec3 albedo, vec3 emission)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    const float h = 0.5f * side;
    alpi_builder_start(&b, context, "floor");
    alpi_builder_surface(&b, "floor", alpi_builder_material(&b, "floor", albedo, emission));
    alpi_builder_quad(&b, (const vec3[4]){{-h, 0, h}, {h, 0, h}, {h, 0, -h}, {-h, 0, -h}});
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

static alp_lpv *open_volume(uint32_t side, double cell, uint32_t cascades)
{
    alp_lpv_options o = lpv_cube(side, cell);
    o.cascades = cascades;
    o.iterations = 2;
    return lpv_open(context, o);
}

static alp_lpv_scene_options sun_from(double azimuth, double elevation, float illuminance)
{
    alp_lpv_scene_options o = alp_lpv_scene_options_default();
    o.lighting.sun.azimuth = (float)azimuth;
    o.lighting.sun.elevation = (float)elevation;
    o.lighting.sun.illuminance = illuminance;
    o.points = 1024;
    return o;
}

/// Lights the scene and gives the flux in the coarsest grid.
static vec3 light_up(alp_lpv *lpv, const alp_scene *scene, const alp_lpv_scene_options *options)
{
    alp_lpv_report report;
    ASSERT_OK(context, alp_lpv_light_scene(lpv, scene, options, &report));
    return (vec3){(float)report.flux[0], (float)report.flux[1], (float)report.flux[2]};
}

/// Sum of a term of what was injected into a grid.
static double sum_of(const alp_lpv *lpv, uint32_t cascade, uint32_t row)
{
    const alpi_lpv_grid *g = &lpv->grids[cascade];
    const size_t n = g->size[0], rows = (size_t)g->size[1] * g->size[2];
    double sum = 0.0;
    for (size_t r = 0; r < rows; r++) {
        for (size_t x = 0; x < n; x++) {
            sum += (double)g->injected[(r * ALPI_LPV_ROWS + row) * n + x];
        }
    }
    return sum;
}

// --- suns ----------------------------------------------------------------------------------------

TEST(a_sun_on_a_floor_has_its_flux)
{
    alp_scene *scene = floor_scene(4.0f, (vec3){0.5f, 0.25f, 0.9f}, none);
    const double elevations[3] = {FIELD_PI / 2.0, 0.9, 0.25};
    for (uint32_t cascades = 1; cascades <= 3; cascades += 2) {
        for (int i = 0; i < 3; i++) {
            alp_lpv *lpv = open_volume(16, 0.5, cascades);
            const alp_lpv_scene_options o = sun_from(0.7 * i, elevations[i], 10.0f);
            const vec3 flux = light_up(lpv, scene, &o);
            const double met = 10.0 * sin(elevations[i]) * 16.0;
            ASSERT_NEAR((double)flux.x / (0.5 * met), 1.0, 0.01);
            ASSERT_NEAR((double)flux.y / (0.25 * met), 1.0, 0.01);
            ASSERT_NEAR((double)flux.z / (0.9 * met), 1.0, 0.01);
            // All of it leaves upwards, from the cells above the floor.
            ASSERT_NEAR(sum_of(lpv, 0, 2) / sum_of(lpv, 0, 0), 2.0, 1e-5);
            alp_lpv_destroy(lpv);
        }
    }
    alp_scene_destroy(scene);
}

/// A floor that is wider than the grid: the map reaches the grid's border wherever it lies.
TEST(maps_reach_the_borders_of_their_grids)
{
    alp_scene *scene = floor_scene(40.0f, (vec3){0.5f, 0.5f, 0.5f}, none);
    for (int i = 0; i < 8; i++) {
        alp_lpv *lpv = open_volume(16, 0.5, 1);
        const double eye[3] = {0.5 * i, 0.0, -0.5 * (i % 3)}, nowhere[3] = {0.0, 0.0, 0.0};
        ASSERT_OK(context, alp_lpv_follow(lpv, eye, nowhere));
        alp_lpv_scene_options o = sun_from(0.1, i % 2 == 0 ? FIELD_PI / 2.0 : 1.0, 10.0f);
        o.map_size = 48; // texels of a third of a cell
        const vec3 flux = light_up(lpv, scene, &o);
        const double met = 10.0 * sin((double)o.lighting.sun.elevation) * 64.0;
        ASSERT_NEAR((double)flux.x / (0.5 * met), 1.0, 0.007);
        alp_lpv_destroy(lpv);
    }
    alp_scene_destroy(scene);
}

/// A grid that moves by whole cells under a sun that does not has the same light at the same
/// places: texels do not move in the world.
TEST(texels_stay_where_they_are)
{
    alp_scene *scene = floor_scene(40.0f, (vec3){0.5f, 0.5f, 0.5f}, none);
    static float before[16 * 16 * 16 * ALPI_LPV_ROWS];
    alp_lpv *lpv = open_volume(16, 0.5, 1);
    const alp_lpv_scene_options o = sun_from(0.4, 0.8, 10.0f);
    double largest = 0.0, apart = 0.0;
    for (int i = 0; i < 2; i++) {
        const double eye[3] = {1.5 * i, 0.0, -1.0 * i}, nowhere[3] = {0.0, 0.0, 0.0};
        ASSERT_OK(context, alp_lpv_follow(lpv, eye, nowhere));
        (void)light_up(lpv, scene, &o);
        const alpi_lpv_grid *g = &lpv->grids[0];
        if (i == 0) {
            memcpy(before, g->injected, sizeof before);
            continue;
        }
        for (int z = 3; z < 13; z++) { // cells that both hold, 3 and −2 cells apart
            for (int x = 4; x < 12; x++) {
                const size_t row = (size_t)(z * 16 + 8) * ALPI_LPV_ROWS;
                const size_t was = (size_t)((z - 2) * 16 + 8) * ALPI_LPV_ROWS;
                const double now = (double)g->injected[row * 16 + (size_t)x];
                const double then = (double)before[was * 16 + (size_t)x + 3];
                largest = fmax(largest, then);
                apart = fmax(apart, fabs(now - then));
            }
        }
    }
    assert_true(largest > 0.0);
    print_message("cells differ by %.3g of the light\n", apart / largest);
    ASSERT_NEAR(apart / largest, 0.0, 0.02); // texels at the borders of cells
    alp_lpv_destroy(lpv);
    alp_scene_destroy(scene);
}

// --- lamps ---------------------------------------------------------------------------------------

TEST(a_spot_on_a_floor_has_its_flux)
{
    alp_scene *scene = floor_scene(8.0f, (vec3){0.5f, 0.5f, 0.5f}, none);
    const float inner[4] = {0.3f, 0.0f, 1.1f, 1.2f}, outer[4] = {0.6f, 1.0f, 1.19f, 1.25f};
    for (int i = 0; i < 4; i++) {
        alp_lamp lamp = alp_lamp_default();
        lamp.kind = ALP_LIGHT_SPOT;
        lamp.intensity = 3.0f;
        lamp.position[1] = i < 2 ? 2.0f : 1.0f;
        lamp.direction[1] = -1.0f;
        lamp.direction[2] = 0.0f;
        lamp.inner_cone = inner[i];
        lamp.outer_cone = outer[i];
        alp_lpv_scene_options o = alp_lpv_scene_options_default();
        o.lighting.lamps = &lamp;
        o.lighting.lamp_count = 1;
        alp_lpv *lpv = open_volume(20, 0.5, 1);
        const vec3 flux = light_up(lpv, scene, &o);
        // ∫ over the cone of ((cos θ − cos outer)/(cos inner − cos outer))², clamped.
        const double ci = cos((double)inner[i]), co = cos((double)outer[i]);
        const double met = 2.0 * FIELD_PI * 3.0 * ((1.0 - ci) + (ci - co) / 3.0);
        ASSERT_NEAR((double)flux.y / (0.5 * met), 1.0, 0.01);
        alp_lpv_destroy(lpv);
    }
    alp_scene_destroy(scene);
}

TEST(a_point_light_on_a_floor_has_its_flux)
{
    alp_scene *scene = floor_scene(8.0f, (vec3){0.5f, 0.5f, 0.5f}, none);
    for (int i = 0; i < 3; i++) {
        alp_lamp lamp = alp_lamp_default();
        lamp.intensity = 3.0f;
        lamp.color[1] = 0.5f;
        lamp.position[1] = 0.7f + (float)i;
        alp_lpv_scene_options o = alp_lpv_scene_options_default();
        o.lighting.lamps = &lamp;
        o.lighting.lamp_count = 1;
        alp_lpv *lpv = open_volume(20, 0.5, 1);
        const vec3 flux = light_up(lpv, scene, &o);
        const double d = (double)lamp.position[1], h = 4.0;
        const double met = 3.0 * 4.0 * atan(h * h / (d * sqrt(2.0 * h * h + d * d)));
        ASSERT_NEAR((double)flux.x / (0.5 * met), 1.0, 0.01);
        ASSERT_NEAR((double)flux.y / (0.25 * met), 1.0, 0.01);
        alp_lpv_destroy(lpv);
    }
    alp_scene_destroy(scene);
}

// --- surfaces that shine -------------------------------------------------------------------------

/// A lamp of half a square metre that looks down in a closed room: πLe·A itself, and the albedo of
/// the room times that.
TEST(a_shining_quad_has_its_flux)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    const vec3 emission = {2.0f, 4.0f, 0.5f};
    alpi_builder_start(&b, context, "lamp in a room");
    alpi_builder_surface(&b, "walls",
                         alpi_builder_material(&b, "walls", (vec3){0.6f, 0.3f, 0.9f}, none));
    alpi_builder_box(&b, (vec3){2.0f, 2.0f, 2.0f}, none, ALPI_FACE_ALL);
    alpi_builder_surface(&b, "lamp", alpi_builder_material(&b, "lamp", none, emission));
    alpi_builder_quad(
        &b, (const vec3[4]){
                {0.5f, 1.5f, 0.5f}, {1.5f, 1.5f, 0.5f}, {1.5f, 1.5f, 1.0f}, {0.5f, 1.5f, 1.0f}});
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    const alp_lpv_options o = alp_lpv_options_for_scene(scene, 20, 1);
    alp_lpv *lpv = NULL;
    ASSERT_OK(context, alp_lpv_create(context, &o, &lpv));
    const vec3 flux = light_up(lpv, scene, NULL);
    ASSERT_NEAR((double)flux.x, FIELD_PI * 2.0 * 0.5 * 1.6, 0.01 * FIELD_PI * 1.6);
    ASSERT_NEAR((double)flux.y, FIELD_PI * 4.0 * 0.5 * 1.3, 0.01 * FIELD_PI * 2.6);
    ASSERT_NEAR((double)flux.z, FIELD_PI * 0.5 * 0.5 * 1.9, 0.01 * FIELD_PI * 0.475);
    alp_lpv_destroy(lpv);
    alp_scene_destroy(scene);
}

/// A double-sided floor that shines has the same light above and below, everywhere on it.
TEST(a_double_sided_lamp_shines_to_both_sides)
{
    alp_scene *scene = floor_scene(8.0f, none, (vec3){1.0f, 1.0f, 1.0f});
    for (int both = 0; both < 2; both++) {
        scene->materials[0].double_sided = both != 0;
        alp_lpv *lpv = open_volume(16, 1.0, 1);
        const vec3 flux = light_up(lpv, scene, NULL);
        ASSERT_NEAR((double)flux.x / (FIELD_PI * 64.0), both != 0 ? 2.0 : 1.0, 1e-3);
        const float *injected = lpv->grids[0].injected;
        for (size_t z = 5; z < 11; z++) { // beside its border, which is shared with cells outside
            for (size_t x = 5; x < 11; x++) { // the floor lies between cells 7 and 8
                const float above = injected[(z * 16 + 8) * ALPI_LPV_ROWS * 16 + x];
                const float below = injected[(z * 16 + 7) * ALPI_LPV_ROWS * 16 + x];
                ASSERT_NEAR((double)above, 0.25, 0.01);
                ASSERT_NEAR((double)below, both != 0 ? 0.25 : 0.0, 0.01);
            }
        }
        alp_lpv_destroy(lpv);
    }
    alp_scene_destroy(scene);
}

/// Triangles so small that each has one point at most still shine to both sides.
TEST(small_double_sided_lamps_shine_to_both_sides)
{
    enum { SIDE = 24 };
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "leaves");
    alpi_builder_surface(&b, "leaves",
                         alpi_builder_material(&b, "leaves", none, (vec3){1.0f, 1.0f, 1.0f}));
    for (int i = 0; i < SIDE * SIDE; i++) {
        const float x = (float)(i % SIDE) / 3.0f - 4.0f, z = (float)(i / SIDE) / 3.0f - 4.0f;
        const float s = 1.0f / 3.0f;
        alpi_builder_quad(
            &b, (const vec3[4]){{x, 0, z + s}, {x + s, 0, z + s}, {x + s, 0, z}, {x, 0, z}});
    }
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    scene->materials[0].double_sided = true;
    alp_lpv_scene_options o = alp_lpv_scene_options_default();
    o.map_size = 32; // 1024 points on 1152 triangles
    o.points = 1024;
    alp_lpv *lpv = open_volume(16, 1.0, 1);
    (void)light_up(lpv, scene, &o);
    ASSERT_NEAR(sum_of(lpv, 0, 2) / sum_of(lpv, 0, 0), 0.0, 0.1); // upwards less downwards
    double along = 0.0, all = 0.0;
    for (size_t i = 0; i < alpi_lpv_nodes(lpv->grids[0].size); i++) {
        along += (double)lpv->grids[0].nodes[i * ALPI_LPV_NODE_TERMS + 2];
        all += (double)lpv->grids[0].nodes[i * ALPI_LPV_NODE_TERMS];
    }
    ASSERT_NEAR(along / all, 0.0, 0.1);
    alp_lpv_destroy(lpv);
    alp_scene_destroy(scene);
}

// --- surfaces ------------------------------------------------------------------------------------

/// A sun from below: the back of a floor is black, that of a double-sided one reflects downwards.
TEST(backs_reflect_where_they_are_double_sided)
{
    alp_scene *scene = floor_scene(4.0f, (vec3){0.5f, 0.5f, 0.5f}, none);
    const alp_lpv_scene_options o = sun_from(0.0, -1.0, 10.0f);
    for (int both = 0; both < 2; both++) {
        scene->materials[0].double_sided = both != 0;
        alp_lpv *lpv = open_volume(16, 0.5, 1);
        const vec3 flux = light_up(lpv, scene, &o);
        const double met = 10.0 * sin(1.0) * 16.0;
        ASSERT_NEAR((double)flux.x, both != 0 ? 0.5 * met : 0.0, 0.005 * met);
        ASSERT_NEAR(sum_of(lpv, 0, 2), -2.0 * sum_of(lpv, 0, 0), 1e-4);
        alp_lpv_destroy(lpv);
    }
    alp_scene_destroy(scene);
}

static const char mirrored_gltf[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
    "\"nodes\":[{\"mesh\":0,\"scale\":[-1,1,1]}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
    "\"min\":[-2,0,-2],\"max\":[2,0,2]}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
    "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,"
    "AAAAwAAAAAAAAABAAAAAQAAAAAAAAABAAAAAQAAAAAAAAADA\"}]}";

/// A triangle of 8 m² that a node of scale −1 mirrors still faces up.
TEST(mirrored_surfaces_reflect_on_their_front)
{
    const char *path = test_path(test_folder(), "mirrored.gltf");
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(mirrored_gltf, 1, strlen(mirrored_gltf), file), strlen(mirrored_gltf));
    assert_int_equal(fclose(file), 0);
    alp_scene *scene = test_load(context, path);
    assert_true(scene->surfaces[0].mirrored);
    alp_lpv *lpv = open_volume(16, 0.5, 1);
    const alp_lpv_scene_options o = sun_from(0.3, 1.0, 10.0f);
    const vec3 flux = light_up(lpv, scene, &o);
    ASSERT_NEAR((double)flux.x / (0.5 * 10.0 * sin(1.0) * 8.0), 1.0, 0.01);
    ASSERT_NEAR(sum_of(lpv, 0, 2) / sum_of(lpv, 0, 0), 2.0, 1e-5);
    alp_lpv_destroy(lpv);
    alp_scene_destroy(scene);
}

/// A cube of .3 m is wider than cells of .5 m by its diagonal, and smaller than those of 1 m.
TEST(small_objects_are_left_out_of_coarse_grids)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    const vec3 black = {0.01f, 0.01f, 0.01f}, white = {0.9f, 0.9f, 0.9f};
    alpi_builder_start(&b, context, "cube on a floor");
    alpi_builder_surface(&b, "floor", alpi_builder_material(&b, "floor", black, none));
    alpi_builder_box(&b, (vec3){-2.0f, -0.5f, -2.0f}, (vec3){2.0f, 0.0f, 2.0f}, ALPI_FACE_TOP);
    alpi_builder_surface(&b, "cube", alpi_builder_material(&b, "cube", white, none));
    alpi_builder_box(&b, (vec3){-0.15f, 0.0f, -0.15f}, (vec3){0.15f, 0.3f, 0.15f}, ALPI_FACE_ALL);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    alp_lpv *lpv = open_volume(16, 0.5, 2);
    alp_lpv_scene_options o = sun_from(0.0, FIELD_PI / 2.0, 10.0f);
    o.map_size = 512;
    (void)light_up(lpv, scene, &o);
    const double floor_flux = 0.01 * 10.0 * (16.0 - 0.09), cube_flux = 0.9 * 10.0 * 0.09;
    ASSERT_NEAR(4.0 * FIELD_PI * sum_of(lpv, 0, 0), floor_flux + cube_flux, 0.03 * cube_flux);
    ASSERT_NEAR(4.0 * FIELD_PI * sum_of(lpv, 1, 0), floor_flux, 0.03 * cube_flux);
    alp_lpv_destroy(lpv);
    alp_scene_destroy(scene);
}

// --- blockers ------------------------------------------------------------------------------------

/// Area of all surface in the nodes, m².
static double blocked_area(const alp_lpv *lpv)
{
    const alpi_lpv_grid *g = &lpv->grids[0];
    double sum = 0.0;
    for (size_t i = 0; i < alpi_lpv_nodes(g->size); i++) {
        sum += (double)g->nodes[i * ALPI_LPV_NODE_TERMS];
    }
    return 4.0 * sum * g->cell * g->cell;
}

TEST(blockers_have_the_area_of_their_surfaces)
{
    alp_scene *scene = floor_scene(4.0f, (vec3){0.5f, 0.5f, 0.5f}, (vec3){1.0f, 1.0f, 1.0f});
    alp_lpv *lpv = open_volume(16, 0.5, 1);
    alp_lpv_scene_options o = alp_lpv_scene_options_default();
    (void)light_up(lpv, scene, &o);
    ASSERT_NEAR(blocked_area(lpv), 16.0, 1e-3); // of points
    o.points = 0;
    (void)light_up(lpv, scene, &o);
    ASSERT_NEAR(blocked_area(lpv), 0.0, 0.0); // no view
    const alp_camera camera = {
        .position = {1.0f, 5.0f, 2.0f}, .up = {0.0f, 0.0f, -1.0f}, .vertical_fov = 1.2f};
    o.camera = &camera;
    (void)light_up(lpv, scene, &o);
    ASSERT_NEAR(blocked_area(lpv), 16.0, 0.16); // of a camera that sees all of it
    alp_lpv_destroy(lpv);
    alp_scene_destroy(scene);
    scene = floor_scene(4.0f, (vec3){0.5f, 0.5f, 0.5f}, none);
    lpv = open_volume(16, 0.5, 1);
    o = sun_from(0.5, 0.6, 1.0f);
    o.points = 0;
    (void)light_up(lpv, scene, &o);
    ASSERT_NEAR(blocked_area(lpv), 16.0, 0.16); // of a sun's map
    alp_lpv_destroy(lpv);
    alp_scene_destroy(scene);
}

/// A double-sided floor blocks both ways, everywhere on it.
TEST(a_double_sided_floor_blocks_both_ways)
{
    alp_scene *scene = floor_scene(8.0f, (vec3){0.5f, 0.5f, 0.5f}, none);
    scene->materials[0].double_sided = true;
    alp_lpv *lpv = open_volume(16, 1.0, 1);
    alp_lpv_scene_options o = sun_from(0.5, 0.6, 1.0f);
    o.points = 65536;
    (void)light_up(lpv, scene, &o);
    ASSERT_NEAR(blocked_area(lpv), 128.0, 1e-2);
    for (size_t z = 5; z < 12; z++) {
        for (size_t x = 5; x < 12; x++) {
            const float *node = lpv->grids[0].nodes + ((z * 17 + 8) * 17 + x) * ALPI_LPV_NODE_TERMS;
            ASSERT_NEAR((double)node[0], 0.5, 0.02);
            ASSERT_NEAR((double)node[2], 0.0, 1e-5); // the same points on both sides
        }
    }
    alp_lpv_destroy(lpv);
    alp_scene_destroy(scene);
}

// --- look-ups ------------------------------------------------------------------------------------

/// The same isotropic light in all cells: E = πL, radiance L, fluence 4πL, everywhere.
TEST(even_light_reads_as_it_is)
{
    alp_lpv *lpv = open_volume(10, 0.3, 3);
    const float radiance[3] = {2.0f, 0.5f, 7.0f};
    for (uint32_t c = 0; c < 3; c++) {
        alpi_lpv_grid *g = &lpv->grids[c];
        for (size_t i = 0; i < ALPI_LPV_ROWS * alpi_lpv_cells(g->size); i++) {
            const size_t row = i / g->size[0] % ALPI_LPV_ROWS;
            g->sum[i] = row % ALPI_LPV_TERMS == 0
                            ? (float)(ALP_LPV_GAIN * g->cell * g->cell) * radiance[row / 4]
                            : 0.0f;
        }
    }
    alp_field *field = NULL;
    ASSERT_OK(context, alp_field_create_lpv(lpv, &field));
    for (int i = 0; i < 500; i++) {
        const vec3 n = field_tilted(0.3 + 0.005 * i, 0.7 * i);
        const float p[1][3] = {{0.02f * (float)i - 5.0f, 0.011f * (float)i, 0.3f}};
        const float d[1][3] = {{n.x, n.y, n.z}};
        float e[1][3], l[1][3], f[1][3];
        alp_field_irradiance(field, 1, p, d, e);
        alp_lpv_radiance(lpv, 1, p, d, l);
        alp_lpv_fluence(lpv, 1, p, f);
        for (int k = 0; k < 3; k++) {
            const double expected = (double)radiance[k];
            ASSERT_NEAR((double)e[0][k] / expected, FIELD_PI, 2e-5);
            ASSERT_NEAR((double)l[0][k] / expected, 1.0, 1e-5);
            ASSERT_NEAR((double)f[0][k] / expected, 4.0 * FIELD_PI, 1e-4);
        }
    }
    alp_field_destroy(field);
    alp_lpv_destroy(lpv);
}

/// Light that travels one way comes from where it was sent: L(ω) = p0 − p·ω. Its E on a surface
/// that faces that way is π p0 + 2π/3 |p|.
TEST(light_comes_from_its_source)
{
    alp_lpv *lpv = open_volume(10, 0.5, 1);
    alpi_lpv_grid *g = &lpv->grids[0];
    for (size_t i = 0; i < ALPI_LPV_ROWS * alpi_lpv_cells(g->size); i++) {
        const size_t term = i / g->size[0] % ALPI_LPV_TERMS;
        g->sum[i] = (float)(ALP_LPV_GAIN * 0.25) * (term == 0 ? 1.0f : term == 2 ? 0.5f : 0.0f);
    }
    const float p[2][3] = {{0.1f, 0.2f, 0.3f}, {0.1f, 0.2f, 0.3f}};
    const float d[2][3] = {{0.0f, -1.0f, 0.0f}, {0.0f, 1.0f, 0.0f}};
    float l[2][3];
    alp_lpv_radiance(lpv, 2, p, d, l);
    ASSERT_NEAR((double)l[0][1], 1.5, 1e-5); // light that travels up comes from below
    ASSERT_NEAR((double)l[1][1], 0.5, 1e-5);
    alp_field *field = NULL;
    ASSERT_OK(context, alp_field_create_lpv(lpv, &field));
    alp_field_irradiance(field, 2, p, d, l);
    ASSERT_NEAR((double)l[0][1], FIELD_PI * (1.0 + 1.0 / 3.0), 1e-5);
    ASSERT_NEAR((double)l[1][1], FIELD_PI * (1.0 - 1.0 / 3.0), 1e-5);
    alp_field_destroy(field);
    alp_lpv_destroy(lpv);
}

// --- workers -------------------------------------------------------------------------------------

enum { POINTS = 64, SIDE = 18 };

typedef struct lpv_bits {
    float sums[2][SIDE * SIDE * SIDE * ALPI_LPV_ROWS];
    float irradiance[POINTS][3], radiance[POINTS][3], fluence[POINTS][3];
    float positions[POINTS][3], normals[POINTS][3];
    double flux[3];
} lpv_bits;

static void light_and_read(uint32_t workers, const void *what, void *bytes)
{
    const bool views = *(const bool *)what;
    lpv_bits *bits = bytes;
    alp_context *own = test_context(workers);
    alp_scene *scene = test_load(own, "builtin:cornell");
    const alp_lpv_options o = alp_lpv_options_for_scene(scene, SIDE, 2);
    const alp_camera camera = alp_scene_get_camera(scene, 0);
    alp_lamp lamp = alp_lamp_default();
    alp_lpv *lpv = NULL;
    alp_field *field = NULL;
    lamp.intensity = 0.1f;
    lamp.position[0] = lamp.position[1] = lamp.position[2] = 0.3f;
    alp_lpv_scene_options s = sun_from(0.3, 0.5, 10.0f);
    s.lighting.lamps = &lamp;
    s.lighting.lamp_count = 1;
    s.points = views ? 0 : 20000;
    s.camera = &camera;
    s.map_size = 100;
    ASSERT_OK(own, alp_scene_free_points(scene, 3, POINTS, bits->positions, bits->normals));
    ASSERT_OK(own, alp_lpv_create(own, &o, &lpv));
    alp_lpv_report report;
    ASSERT_OK(own, alp_lpv_light_scene(lpv, scene, &s, &report));
    memcpy(bits->flux, report.flux, sizeof bits->flux);
    for (int c = 0; c < 2; c++) {
        memcpy(bits->sums[c], lpv->grids[c].sum, sizeof bits->sums[c]);
    }
    const float(*p)[3] = (const float(*)[3])bits->positions;
    const float(*n)[3] = (const float(*)[3])bits->normals;
    ASSERT_OK(own, alp_field_create_lpv(lpv, &field));
    alp_field_irradiance(field, POINTS, p, n, bits->irradiance);
    alp_lpv_radiance(lpv, POINTS, p, n, bits->radiance);
    alp_lpv_fluence(lpv, POINTS, p, bits->fluence);
    alp_field_destroy(field);
    alp_lpv_destroy(lpv);
    alp_scene_destroy(scene);
    alp_context_destroy(own);
}

TEST(workers_change_no_bit_of_light)
{
    for (int i = 0; i < 2; i++) {
        const bool views = i == 1;
        lpv_bits *bits = test_any_workers(light_and_read, &views, sizeof *bits);
        double sums[3] = {0.0, 0.0, 0.0};
        for (int k = 0; k < POINTS; k++) {
            sums[0] += (double)bits->irradiance[k][0];
            sums[1] += (double)bits->radiance[k][0];
            sums[2] += (double)bits->fluence[k][0];
        }
        assert_true(sums[0] > 0.0 && sums[1] > 0.0 && sums[2] > 0.0 && bits->flux[0] > 0.0);
        free(bits);
    }
}

// --- surfels for hosts ---------------------------------------------------------------------------

/// A host that collects surfels and injects them has the light of alp_lpv_light_scene.
TEST(collected_surfels_light_a_volume)
{
    alp_scene *scene = test_load(context, "builtin:cornell");
    const alp_lpv_options o = alp_lpv_options_for_scene(scene, 12, 1);
    alp_lpv_scene_options frame = alp_lpv_scene_options_default();
    frame.map_size = 32;
    frame.points = 1000;
    alp_lpv *one = NULL, *other = NULL;
    alp_lpv_collection *emitters = NULL, *points = NULL;
    ASSERT_OK(context, alp_lpv_create(context, &o, &one));
    ASSERT_OK(context, alp_lpv_create(context, &o, &other));
    ASSERT_OK(context, alp_lpv_light_scene(one, scene, &frame, NULL));
    ASSERT_OK(context, alp_lpv_collect(scene, ALP_LPV_EMITTERS, 2 * 32 * 32, 0, &emitters));
    ASSERT_OK(context, alp_lpv_collect(scene, ALP_LPV_POINTS, 1000, 0, &points));
    const alp_lpv_surfels light = alp_lpv_collection_surfels(emitters);
    const alp_lpv_surfels blockers = alp_lpv_collection_surfels(points);
    alp_lpv_begin(other);
    ASSERT_OK(context, alp_lpv_add_light(other, ALP_LPV_ALL_CASCADES, &light));
    ASSERT_OK(context, alp_lpv_add_blockers(other, ALP_LPV_ALL_CASCADES, &blockers));
    ASSERT_OK(context, alp_lpv_propagate(other));
    assert_memory_equal(one->grids[0].sum, other->grids[0].sum,
                        ALPI_LPV_ROWS * alpi_lpv_cells(o.size) * sizeof(float));
    alp_lpv_collection_destroy(points);
    alp_lpv_collection_destroy(emitters);
    alp_lpv_collection_destroy(NULL);
    alp_lpv_destroy(other);
    alp_lpv_destroy(one);
    assert_int_equal(alp_lpv_collect(scene, ALP_LPV_POINTS, 1, 0, &points),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(alp_context_message(context), "1 surfels"));
    alp_scene_destroy(scene);
}
