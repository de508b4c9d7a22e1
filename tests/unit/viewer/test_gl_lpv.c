// SPDX-License-Identifier: MIT
// Light propagation on the graphics card against the library's, from the same light and blockers.
#include "test_gl.h"

#include "base/random.h"
#include "fields/propagation/lpv.h"
#include "lpv_frame.h"
#include "options/options.h"

#include <alpenglow/lpv.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

TEST_CONTEXT(2);

enum { ROWS = ALPI_LPV_ROWS };

enum { WIDE = 30, HIGH = 20, COUNT = WIDE * HIGH };
static struct {
    float positions[COUNT][3], normals[COUNT][3], flux[COUNT][3], albedo[COUNT][3], areas[COUNT],
        radii[COUNT];
} map;

/// Random surfels in the finest grid or beyond it, some of which shine.
/// @param reach half the side of their box, in halves of the grid
static alp_lpv_surfels make_map(const alp_lpv_options *o, float reach, uint32_t seed)
{
    uint32_t state = seed;
    for (int i = 0; i < COUNT; i++) {
        vec3 n;
        float u[10];
        for (int k = 0; k < 10; k++) {
            state = alpi_hash32(state + 0x9e3779b9u);
            u[k] = alpi_unit_float(state);
        }
        n = vec3_normalize_or((vec3){u[0] - 0.5f, u[1] - 0.5f, u[2] - 0.5f}, (vec3){0, 1, 0});
        vec3_store(map.normals[i], n);
        for (int k = 0; k < 3; k++) {
            const float half = 0.5f * (float)(o->cell * o->size[k]);
            map.positions[i][k] = reach * half * (2.0f * u[3 + k] - 1.0f);
            map.flux[i][k] = i % 15 == 0 ? u[6 + k] : 0.0f;
            map.albedo[i][k] = u[8 - k];
        }
        map.areas[i] = (float)(o->cell * o->cell) * u[8];
        map.radii[i] = u[9] < 0.5f ? 0.0f : (float)o->cell * 2.0f * u[9];
    }
    return (alp_lpv_surfels){.count = COUNT,
                             .positions = (const float(*)[3])map.positions,
                             .normals = (const float(*)[3])map.normals,
                             .flux = (const float(*)[3])map.flux,
                             .areas = map.areas,
                             .albedo = (const float(*)[3])map.albedo,
                             .radii = map.radii};
}

static void fill(alp_lpv *lpv, const alp_lpv_options *o)
{
    const alp_lpv_surfels s = make_map(o, 1.0f, 7);
    alp_lpv_begin(lpv);
    ASSERT_OK(context, alp_lpv_add_light(lpv, ALP_LPV_ALL_CASCADES, &s));
    if (o->blockers) {
        ASSERT_OK(context, alp_lpv_add_blockers(lpv, ALP_LPV_ALL_CASCADES, &s));
    }
}

/// Element of a texture of the card that is term `term` of a channel in a cell.
static size_t place_of(const gl_lpv *v, size_t cascade, size_t cell, size_t channel, size_t term)
{
    const size_t cells = alpi_lpv_cells(v->options.size);
    return 4 * ((channel * v->options.cascades + cascade) * cells + cell) + term;
}

/// The same in a volume of the library.
static size_t own_place(const gl_lpv *v, size_t cell, size_t channel, size_t term)
{
    const size_t n = v->options.size[0];
    return (cell / n * ROWS + channel * ALPI_LPV_TERMS + term) * n + cell % n;
}

/// The injected light, to the card.
static void copy_light(const alp_lpv *lpv, const gl_lpv *v)
{
    const uint32_t *n = v->options.size;
    const size_t cells = alpi_lpv_cells(n), all = v->options.cascades * cells;
    float *texels = malloc(12 * all * sizeof *texels);
    assert_non_null(texels);
    for (size_t i = 0; i < 12 * all; i++) {
        const size_t at = i / 12 % cells, cascade = i / 12 / cells;
        texels[place_of(v, cascade, at, i % 12 / 4, i % 4)] =
            lpv->grids[cascade].injected[own_place(v, at, i % 12 / 4, i % 4)];
    }
    glTextureSubImage3D(v->injected, 0, 0, 0, 0, (GLsizei)n[0], (GLsizei)n[1],
                        (GLsizei)(3 * v->options.cascades * n[2]), GL_RGBA, GL_FLOAT, texels);
    free(texels);
}

static void copy_blockers(const alp_lpv *lpv, const gl_lpv *v)
{
    const uint32_t *n = v->options.size;
    const size_t nodes = alpi_lpv_nodes(n);
    float(*opacities)[4] = malloc(nodes * sizeof *opacities);
    float(*albedos)[4] = malloc(nodes * sizeof *albedos);
    assert_non_null(opacities);
    assert_non_null(albedos);
    for (uint32_t c = 0; c < v->options.cascades; c++) {
        for (size_t i = 0; i < nodes; i++) {
            const float *node = lpv->grids[c].nodes + i * ALPI_LPV_NODE_TERMS;
            memcpy(opacities[i], node, sizeof opacities[i]);
            memcpy(albedos[i], node + ALPI_LPV_TERMS, 3 * sizeof(float));
            albedos[i][3] = 0.0f;
        }
        const GLsizei size[3] = {(GLsizei)n[0] + 1, (GLsizei)n[1] + 1, (GLsizei)n[2] + 1};
        const GLint z = (GLint)(c * (n[2] + 1));
        glTextureSubImage3D(v->opacities, 0, 0, 0, z, size[0], size[1], size[2], GL_RGBA, GL_FLOAT,
                            opacities);
        glTextureSubImage3D(v->albedos, 0, 0, 0, z, size[0], size[1], size[2], GL_RGBA, GL_FLOAT,
                            albedos);
    }
    free(opacities);
    free(albedos);
}

/// Largest difference of a texture and a volume of the library, over the largest value.
/// @param sums whether they are the sums, else what was injected
static double compare_volumes(const alp_lpv *lpv, const gl_lpv *v, bool sums)
{
    const size_t cells = alpi_lpv_cells(v->options.size), all = v->options.cascades * cells;
    float *texels = malloc(12 * all * sizeof *texels);
    double most = 0.0, apart = 0.0;
    assert_non_null(texels);
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    glGetTextureImage(sums ? v->sum : v->injected, 0, GL_RGBA, GL_FLOAT,
                      (GLsizei)(12 * all * sizeof *texels), texels);
    for (size_t i = 0; i < 12 * all; i++) {
        const size_t at = i / 12 % cells, cascade = i / 12 / cells;
        const alpi_lpv_grid *g = &lpv->grids[cascade];
        const float *values = sums ? g->sum : g->injected;
        const double own = (double)values[own_place(v, at, i % 12 / 4, i % 4)];
        const double other = (double)texels[place_of(v, cascade, at, i % 12 / 4, i % 4)];
        most = fmax(most, fabs(own));
        apart = fmax(apart, fabs(own - other));
    }
    free(texels);
    assert_true(most > 0.0);
    return apart / most;
}

// --- injection -----------------------------------------------------------------------------------

static GLuint upload(const float (*values)[3], const float *fourth)
{
    static float texels[COUNT][4];
    GLuint texture = 0;
    for (int i = 0; i < COUNT; i++) {
        memcpy(texels[i], values[i], sizeof values[i]);
        texels[i][3] = fourth != NULL ? fourth[i] : 0.0f;
    }
    glCreateTextures(GL_TEXTURE_2D, 1, &texture);
    glTextureStorage2D(texture, 1, GL_RGBA32F, WIDE, HIGH);
    glTextureSubImage2D(texture, 0, 0, 0, WIDE, HIGH, GL_RGBA, GL_FLOAT, texels);
    return texture;
}

static gl_lpv_map upload_map(int cascade)
{
    return (gl_lpv_map){.positions = upload((const float(*)[3])map.positions, map.radii),
                        .normals = upload((const float(*)[3])map.normals, map.areas),
                        .flux = upload((const float(*)[3])map.flux, NULL),
                        .albedos = upload((const float(*)[3])map.albedo, NULL),
                        .width = WIDE,
                        .height = HIGH,
                        .cascade = cascade};
}

static void destroy_map(const gl_lpv_map *m)
{
    const GLuint textures[4] = {m->positions, m->normals, m->flux, m->albedos};
    glDeleteTextures(4, textures);
}

/// Largest difference of opacity and albedo × opacity of the nodes, over the largest.
static double compare_blockers(const alp_lpv *lpv, const gl_lpv *v)
{
    const size_t nodes = alpi_lpv_nodes(v->options.size);
    const size_t bytes = v->options.cascades * nodes * 4 * sizeof(float);
    float(*terms[2])[4] = {malloc(bytes), malloc(bytes)};
    double most = 0.0, apart = 0.0;
    assert_true(terms[0] != NULL && terms[1] != NULL);
    glGetTextureImage(v->opacities, 0, GL_RGBA, GL_FLOAT, (GLsizei)bytes, terms[0]);
    glGetTextureImage(v->albedos, 0, GL_RGBA, GL_FLOAT, (GLsizei)bytes, terms[1]);
    for (uint32_t c = 0; c < v->options.cascades; c++) {
        for (size_t i = 0; i < nodes * ALPI_LPV_NODE_TERMS; i++) {
            const size_t node = i / ALPI_LPV_NODE_TERMS, t = i % ALPI_LPV_NODE_TERMS;
            const double own = (double)lpv->grids[c].nodes[i];
            most = fmax(most, fabs(own));
            apart = fmax(apart, fabs(own - (double)terms[t / 4][c * nodes + node][t % 4]));
        }
    }
    free(terms[0]);
    free(terms[1]);
    assert_true(most > 0.0);
    return apart / most;
}

/// Maps of cascades and of all, views of one grid and of all, and grids that have moved.
TEST(maps_are_injected_as_in_the_library)
{
    if (!test_gl_open()) {
        skip();
    }
    const double eye[3] = {0.73, -1.3, 2.1}, ahead[3] = {0.6, 0.0, -0.8};
    for (int i = 0; i < 12; i++) {
        alp_lpv_options o = alp_lpv_options_default();
        o.size[0] = 12, o.size[1] = 9, o.size[2] = 10;
        o.mode = i % 2 == 0 ? ALP_LPV_ACCURATE : ALP_LPV_CONFORMANCE;
        o.cascades = i % 4 < 2 ? 3 : 1;
        alp_lpv *lpv = NULL;
        gl_lpv volume;
        ASSERT_OK(context, alp_lpv_create(context, &o, &lpv));
        assert_int_equal(gl_lpv_create(&o, &volume), EXIT_DONE);
        ASSERT_OK(context, alp_lpv_follow(lpv, eye, ahead));
        gl_lpv_follow(&volume, eye, ahead);
        alp_lpv_begin(lpv);
        const float most[3] = {COUNT, COUNT, COUNT};
        gl_lpv_begin(&volume);
        for (uint32_t k = 0; k < 2; k++) { // two maps, each of which is a view
            const uint32_t cascade = k == 0 ? ALP_LPV_ALL_CASCADES : o.cascades - 1;
            const alp_lpv_surfels s = make_map(&o, (float)(1 + i % 3), 7 + k);
            const gl_lpv_map m = upload_map(k == 0 ? -1 : (int)cascade);
            ASSERT_OK(context, alp_lpv_add_light(lpv, cascade, &s));
            ASSERT_OK(context, alp_lpv_add_blockers(lpv, cascade, &s));
            gl_lpv_add_light(&volume, &m, most);
            gl_lpv_add_blockers(&volume, &m, k == 1);
            gl_lpv_end_view(&volume);
            destroy_map(&m);
        }
        const double light = compare_volumes(lpv, &volume, false),
                     blocked = compare_blockers(lpv, &volume);
        print_message("%2d: light apart by %.2g, blockers by %.2g\n", i, light, blocked);
        ASSERT_NEAR(light, 0.0, 1e-5);
        ASSERT_NEAR(blocked, 0.0, 3e-5); // opacity is held in units
        gl_lpv_destroy(&volume);
        alp_lpv_destroy(lpv);
        test_gl_check();
    }
}

TEST(light_propagates_as_in_the_library)
{
    if (!test_gl_open()) {
        skip();
    }
    static const uint32_t sizes[3][3] = {{16, 16, 16}, {7, 9, 12}, {4, 5, 6}};
    for (int i = 0; i < 24; i++) {
        alp_lpv_options o = alp_lpv_options_default();
        memcpy(o.size, sizes[i / 8], sizeof o.size);
        o.mode = i % 2 == 0 ? ALP_LPV_ACCURATE : ALP_LPV_CONFORMANCE;
        o.bounces = i % 4 / 2 == 0 ? ALP_BOUNCES_CONVERGE : 1;
        o.blockers = i % 8 != 4;
        o.cascades = i % 3 == 0 ? 3 : 1;
        alp_lpv *lpv = NULL;
        gl_lpv volume;
        ASSERT_OK(context, alp_lpv_create(context, &o, &lpv));
        assert_int_equal(gl_lpv_create(&o, &volume), EXIT_DONE);
        fill(lpv, &o);
        copy_light(lpv, &volume);
        if (o.blockers) {
            copy_blockers(lpv, &volume);
        }
        ASSERT_OK(context, alp_lpv_propagate(lpv));
        gl_lpv_propagate(&volume);
        const double apart = compare_volumes(lpv, &volume, true);
        print_message("%2d: apart by %.2g of the largest sum\n", i, apart);
        ASSERT_NEAR(apart, 0.0, 1e-5);
        gl_lpv_destroy(&volume);
        alp_lpv_destroy(lpv);
        test_gl_check();
    }
}

// --- frames --------------------------------------------------------------------------------------

/// Flux of the coarsest grid of the card: 4π Σ p0 over what was injected.
static double flux_on_card(const gl_lpv *v, size_t channel)
{
    const size_t cells = alpi_lpv_cells(v->options.size), all = v->options.cascades * cells;
    float *texels = malloc(12 * all * sizeof *texels);
    double sum = 0.0;
    assert_non_null(texels);
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    glGetTextureImage(v->injected, 0, GL_RGBA, GL_FLOAT, (GLsizei)(12 * all * sizeof *texels),
                      texels);
    for (size_t i = 0; i < cells; i++) {
        sum += (double)texels[place_of(v, v->options.cascades - 1, i, channel, 0)];
    }
    free(texels);
    return 4.0 * M_PI * sum;
}

/// Light of a scene by rays and by rasterising: the flux of the maps, and the sums of the volume.
static void compare_frames(const char *name, const alp_lighting_options *lighting, uint32_t points,
                           uint32_t cascades, double flux_share, double sum_share)
{
    alp_scene *scene = test_load(context, name);
    alp_lpv_options o = alp_lpv_options_for_scene(scene, 16, cascades);
    alp_lpv_scene_options frame = alp_lpv_scene_options_default();
    frame.lighting = *lighting;
    frame.points = points;
    alp_lpv *lpv = NULL;
    alp_lpv_report report;
    lpv_frame f;
    gl_scene drawn;
    gl_lights lights;
    int code = EXIT_DONE;
    ASSERT_OK(context, alp_lpv_create(context, &o, &lpv));
    ASSERT_OK(context, alp_lpv_light_scene(lpv, scene, &frame, &report));
    assert_int_equal(gl_scene_create(scene, true, false, &drawn), EXIT_DONE);
    assert_int_equal(gl_lights_create(scene, lighting, &lights), EXIT_DONE);
    ASSERT_OK(context, lpv_frame_create(scene, &o, &frame, &code, &f));
    assert_int_equal(code, EXIT_DONE);
    const lpv_frame_scene in = {.scene = scene,
                                .drawn = &drawn,
                                .lights = &lights,
                                .eye = {o.centre[0], o.centre[1], o.centre[2]}};
    lpv_frame_light(&f, &in);
    const double apart = compare_volumes(lpv, &f.volume, true);
    for (size_t k = 0; k < 3; k++) {
        const double ratio = flux_on_card(&f.volume, k) / report.flux[k];
        print_message("%s: flux %.4f of that by rays, sums apart by %.3g\n", name, ratio, apart);
        ASSERT_NEAR(ratio, 1.0, flux_share);
    }
    ASSERT_NEAR(apart, 0.0, sum_share);
    lpv_frame_destroy(&f);
    gl_lights_destroy(&lights);
    gl_scene_destroy(&drawn);
    alp_lpv_destroy(lpv);
    alp_scene_destroy(scene);
    test_gl_check();
}

/// Suns, lamps and emissive surfaces. Rays are jittered in texels and pixels are not.
TEST(frames_have_the_light_of_the_library)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_lighting_options l = alp_lighting_options_default();
    compare_frames("builtin:cornell", &l, 4096, 1, 1e-5, 1e-5); // the same surfels
    compare_frames("builtin:teapot-room", &l, 4096, 1, 0.01, 0.05);
    const alp_lamp lamps[2] = {{.kind = ALP_LIGHT_POINT,
                                .color = {1.0f, 0.5f, 0.25f},
                                .intensity = 9.0f,
                                .position = {0.3f, 0.4f, 0.4f}},
                               {.kind = ALP_LIGHT_SPOT,
                                .color = {1.0f, 1.0f, 1.0f},
                                .intensity = 20.0f,
                                .position = {0.4f, 0.5f, 0.2f},
                                .direction = {0.0f, -1.0f, 0.2f},
                                .outer_cone = 0.6f,
                                .inner_cone = 0.3f}};
    l.lamps = lamps;
    l.lamp_count = 2;
    compare_frames("builtin:cornell", &l, 4096, 1, 0.002, 0.01);
    compare_frames("builtin:cornell", &l, 0, 1, 0.002, 0.01);
    l.lamp_count = 0;
    l.sun.illuminance = 10.0f;
    l.sun.elevation = 0.9f;
    l.sun.azimuth = 0.3f;
    compare_frames("builtin:atrium", &l, 4096, 1, 0.01, 0.08);
    compare_frames("builtin:atrium", &l, 0, 3, 0.01, 0.08);
}

/// The flux of a closed room's lamps under a sun of some illuminance, which lights its roof alone.
static double flux_under_sun(float illuminance)
{
    alp_scene *scene = test_load(context, "builtin:teapot-room");
    const alp_lpv_options o = alp_lpv_options_for_scene(scene, 8, 1);
    alp_lpv_scene_options frame = alp_lpv_scene_options_default();
    alp_lighting_options lighting = alp_lighting_options_default();
    lighting.sun.illuminance = illuminance;
    lighting.sun.elevation = 1.5f;
    lpv_frame f;
    gl_scene drawn;
    gl_lights lights;
    int code = EXIT_DONE;
    assert_int_equal(gl_scene_create(scene, true, false, &drawn), EXIT_DONE);
    assert_int_equal(gl_lights_create(scene, &lighting, &lights), EXIT_DONE);
    frame.points = 0;
    ASSERT_OK(context, lpv_frame_create(scene, &o, &frame, &code, &f));
    assert_int_equal(code, EXIT_DONE);
    const lpv_frame_scene in = {.scene = scene,
                                .drawn = &drawn,
                                .lights = &lights,
                                .eye = {o.centre[0], o.centre[1], o.centre[2]}};
    lpv_frame_light(&f, &in);
    const double flux = flux_on_card(&f.volume, 1);
    lpv_frame_destroy(&f);
    gl_lights_destroy(&lights);
    gl_scene_destroy(&drawn);
    alp_scene_destroy(scene);
    test_gl_check();
    return flux;
}

/// Each map is counted in units of its own, so that weak light beside a strong sun is not lost.
TEST(weak_light_is_kept_beside_a_strong_sun)
{
    if (!test_gl_open()) {
        skip();
    }
    const double alone = flux_under_sun(0.0f), beside = flux_under_sun(1e6f);
    print_message("%.4g W alone, %.4g W under a sun\n", alone, beside);
    assert_true(alone > 0.0);
    assert_true(beside >= 0.9999 * alone);
}

/// A volume that the card cannot hold is refused by one message, before anything is made.
TEST(a_volume_beyond_the_card_is_refused)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_lpv_options o = alp_lpv_options_default();
    gl_lpv volume;
    o.size[0] = o.size[1] = o.size[2] = 512;
    o.cascades = 8;
    assert_int_equal(gl_lpv_create(&o, &volume), EXIT_FAILED);
    gl_lpv_destroy(&volume);
    test_gl_check();
}
