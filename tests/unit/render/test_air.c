// SPDX-License-Identifier: MIT
// Media and mirrors of a propagation volume, against closed forms.
#include "test_support.h"

#include "scene/builtin/mesh_builder.h"

#include <alpenglow/lpv.h>
#include <alpenglow/render.h>
#include <alpenglow/shared_constants.h>

#include <math.h>

enum { WIDTH = 12, HEIGHT = 8, PIXELS = WIDTH * HEIGHT };

TEST_CONTEXT(2);

static const double PI = 3.14159265358979323846;
static const vec3 NO_EMISSION = {0.0f, 0.0f, 0.0f};

typedef float picture[PIXELS][4];

/// A volume round a scene with radiance L from everywhere: p0 = 1.5 L s².
static alp_lpv *make_volume(const alp_scene *scene, float radiance)
{
    alp_lpv *lpv = NULL;
    alp_lpv_grid g;
    const alp_lpv_options o = alp_lpv_options_for_scene(scene, 8, 1);
    ASSERT_OK(context, alp_lpv_create(context, &o, &lpv));
    alp_lpv_get_grid(lpv, 0, &g);
    float *intensities; // of the volume, which may change
    memcpy(&intensities, &g.intensities, sizeof intensities);
    const size_t rows = (size_t)g.size[1] * g.size[2] * 12;
    for (size_t i = 0; i < rows * g.size[0]; i++) {
        const bool mean = i / g.size[0] % 4 == 0;
        intensities[i] = mean ? (float)(ALP_LPV_GAIN * g.cell * g.cell) * radiance : 0.0f;
    }
    return lpv;
}

static alp_render_options options_of(const alp_lpv *lpv, const alp_field *field)
{
    alp_render_options o = alp_render_options_default();
    o.method = ALP_RENDER_FIELD;
    o.width = WIDTH;
    o.height = HEIGHT;
    o.samples = 4;
    o.lpv = lpv;
    o.field = field;
    return o;
}

/// Draws with the light of a volume. @param o without field and volume
static void draw(const alp_scene *scene, const alp_lpv *lpv, alp_render_options o, picture pixels)
{
    alp_image *image = NULL;
    alp_field *field = NULL;
    ASSERT_OK(context, alp_field_create_lpv(lpv, &field));
    o.lpv = lpv;
    o.field = field;
    ASSERT_OK(context, alp_render(scene, &o, &image));
    memcpy(pixels, alp_image_floats(image), sizeof(picture));
    alp_image_destroy(image);
    alp_field_destroy(field);
}

static void assert_even(picture pixels, double value, double tolerance)
{
    for (int i = 0; i < PIXELS; i++) {
        for (int k = 0; k < 3; k++) {
            ASSERT_NEAR(pixels[i][k], value, tolerance);
        }
    }
}

/// L = 2 in every direction: as much is scattered into each ray as out of it.
TEST(the_furnace_stays_two_in_any_medium)
{
    static const float coefficients[] = {0.0f, 1e-6f, 0.1f, 3.0f, 1000.0f};
    static picture pixels;
    alp_scene *scene = test_load(context, "builtin:furnace");
    alp_lpv *lpv = make_volume(scene, 2.0f);
    for (size_t i = 0; i < sizeof coefficients / sizeof *coefficients; i++) {
        alp_render_options o = options_of(NULL, NULL);
        o.scattering = coefficients[i];
        draw(scene, lpv, o, pixels);
        assert_even(pixels, 2.0, 1e-5);
    }
    alp_lpv_destroy(lpv);
    alp_scene_destroy(scene);
}

/// Specks at two corners of a box of air, 2 m long. The camera looks between them, along z.
static void add_specks(alpi_builder *b)
{
    const vec3 corners[2] = {{-1.0f, -1.0f, -1.0f}, {1.0f, 1.0f, 1.0f}};
    const uint32_t black = alpi_builder_material(b, "black", NO_EMISSION, NO_EMISSION);
    alpi_builder_surface(b, "specks", black);
    for (int i = 0; i < 2; i++) {
        const float inside = i == 0 ? 1e-3f : -1e-3f;
        const vec3 other = vec3_mad(corners[i], inside, (vec3){1, 1, 1});
        alpi_builder_box(b, vec3_min(corners[i], other), vec3_max(corners[i], other),
                         ALPI_FACE_ALL);
    }
    alpi_builder_camera(b, (vec3){0.0f, 0.0f, 5.0f}, (vec3){0.0f, 0.0f, 0.0f}, 4e-5f);
}

static alp_scene *make_air(void)
{
    alp_scene *scene = NULL;
    alpi_builder b;
    alpi_builder_start(&b, context, "air");
    add_specks(&b);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

/// The same with a pane across its middle, at z = 0.
static alp_scene *make_air_with_pane(double alpha, const double color[3])
{
    const vec3 c = {(float)color[0], (float)color[1], (float)color[2]};
    alp_scene *scene = NULL;
    alpi_builder b;
    alpi_builder_start(&b, context, "air behind a pane");
    add_specks(&b);
    const uint32_t pane = alpi_builder_material(&b, "pane", c, NO_EMISSION);
    b.scene->materials[pane].alpha_mode = ALPI_ALPHA_BLEND;
    b.scene->materials[pane].base_color[3] = (float)alpha;
    alpi_builder_surface(&b, "pane", pane);
    alpi_builder_quad(
        &b, (const vec3[4]){{-.1f, -.1f, 0}, {.1f, -.1f, 0}, {.1f, .1f, 0}, {-.1f, .1f, 0}});
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

/// A sun of E gives the air the fluence E, and 2 m of it the radiance E / 4π (1 − e^(−2 S)): the
/// share 1 − e^(−2 S) of the picture is covered by E / 4π.
TEST(a_sun_lights_air_by_its_closed_form)
{
    static picture pixels;
    alp_scene *scene = make_air();
    alp_lpv *lpv = make_volume(scene, 0.0f);
    alp_render_options o = options_of(NULL, NULL);
    o.scattering = 0.7f;
    o.lighting.sun.illuminance = 10.0f;
    o.lighting.sun.azimuth = 1.0f;
    o.lighting.sun.elevation = 0.3f;
    o.lighting.sun.size = 0.0f;
    draw(scene, lpv, o, pixels);
    assert_even(pixels, 10.0 / (4.0 * PI), 1e-5);
    for (int i = 0; i < PIXELS; i++) {
        ASSERT_NEAR(pixels[i][3], 1.0 - exp(-1.4), 1e-5);
    }
    o.without_direct = true;
    draw(scene, lpv, o, pixels);
    assert_even(pixels, 0.0, 0.0);
    alp_lpv_destroy(lpv);
    alp_scene_destroy(scene);
}

/// A lamp of I candela at distance h from the middle of the ray:
///     L = S I / 4π ∫ e^(−S t) / (h² + (t − 1)²) dt,   t from 0 to 2
TEST(a_lamp_lights_air_by_its_closed_form)
{
    enum { PARTS = 20000 };
    static picture pixels;
    const double s = 0.7, h = 0.8, intensity = 3.0;
    alp_scene *scene = make_air();
    alp_lpv *lpv = make_volume(scene, 0.0f);
    alp_render_options o = options_of(NULL, NULL);
    alp_lamp lamp = alp_lamp_default();
    lamp.position[1] = (float)h;
    lamp.intensity = (float)intensity;
    o.scattering = (float)s;
    o.samples = 16;
    o.lighting.lamps = &lamp;
    o.lighting.lamp_count = 1;
    draw(scene, lpv, o, pixels);
    double sum = 0.0;
    for (int i = 0; i < PARTS; i++) {
        const double t = 2.0 * (i + 0.5) / PARTS;
        sum += exp(-s * t) / (h * h + (t - 1.0) * (t - 1.0)) * 2.0 / PARTS;
    }
    const double expected = s * intensity / (4.0 * PI) * sum;
    for (int i = 0; i < PIXELS; i++) {
        ASSERT_NEAR(pixels[i][1] * pixels[i][3], expected, 2e-4 * expected);
    }
    alp_lpv_destroy(lpv);
    alp_scene_destroy(scene);
}

/// A pane of colour c and alpha a in the middle of 2 m of air tints the light of the half behind
/// it:
///     L = E / 4π ((1 − e^(−S)) + through (e^(−S) − e^(−2 S))),   through = (1 − a)(1 − a + a c)
TEST(a_pane_tints_the_air_behind_it)
{
    static picture pixels;
    const double s = 0.7, alpha = 0.6, colors[3] = {0.8, 0.4, 0.2};
    alp_scene *scene = make_air_with_pane(alpha, colors);
    alp_lpv *lpv = make_volume(scene, 0.0f);
    alp_render_options o = options_of(NULL, NULL);
    o.scattering = (float)s;
    o.samples = 64;
    o.lighting.sun.illuminance = 10.0f;
    o.lighting.sun.azimuth = (float)(0.5 * PI); // along the pane
    o.lighting.sun.elevation = 0.3f;
    o.lighting.sun.size = 0.0f;
    draw(scene, lpv, o, pixels);
    o.scattering = 0.0f; // the pane itself, which the sun lights
    static picture pane;
    draw(scene, lpv, o, pane);
    for (int i = 0; i < PIXELS; i++) {
        for (int k = 0; k < 3; k++) {
            const double through = (1.0 - alpha) * (1.0 - alpha + alpha * colors[k]);
            const double air = (1.0 - exp(-s)) + through * (exp(-s) - exp(-2.0 * s));
            const double own = (double)pane[i][k] * (double)pane[i][3] * exp(-s);
            const double seen = (double)pixels[i][k] * (double)pixels[i][3] - own;
            ASSERT_NEAR(seen / (10.0 / (4.0 * PI) * air), 1.0, 5e-3);
        }
    }
    alp_lpv_destroy(lpv);
    alp_scene_destroy(scene);
}

/// A sun of E behind the camera shines on a pane of colour c and alpha a, in the middle of 2 m of
/// air. The pane reflects E a c / π through 1 m of air. Sunlight passes the pane on its way into
/// the air behind it, and back:
///     L = E a c / π e^(−S) + E / 4π ((1 − e^(−S)) + through² (e^(−S) − e^(−2 S)))
TEST(air_behind_a_pane_does_not_dim_its_reflection)
{
    static picture pixels;
    const double s = 0.7, e = 10.0, alpha = 0.6, colors[3] = {0.8, 0.4, 0.2};
    alp_scene *scene = make_air_with_pane(alpha, colors);
    alp_lpv *lpv = make_volume(scene, 0.0f);
    alp_render_options o = options_of(NULL, NULL);
    o.scattering = (float)s;
    o.samples = 64;
    o.lighting.sun.illuminance = (float)e;
    o.lighting.sun.size = 0.0f;
    draw(scene, lpv, o, pixels);
    for (int i = 0; i < PIXELS; i++) {
        for (int k = 0; k < 3; k++) {
            const double through = (1.0 - alpha) * (1.0 - alpha + alpha * colors[k]);
            const double behind = through * through * (exp(-s) - exp(-2.0 * s));
            const double air = e / (4.0 * PI) * (1.0 - exp(-s) + behind);
            const double own = e * alpha * colors[k] / PI * exp(-s);
            ASSERT_NEAR((double)pixels[i][k] * (double)pixels[i][3] / (air + own), 1.0, 2e-3);
        }
    }
    alp_lpv_destroy(lpv);
    alp_scene_destroy(scene);
}

/// Panes of alpha a that emit Le, at depths of 1 and 1.5 m in 2 m of dark air. Each is dimmed by
/// the air before it, and by the panes before it:
///     L = Σ a Le through^k e^(−S d),   alpha = 1 − through² e^(−2 S)
TEST(each_pane_that_emits_is_dimmed_by_the_air_before_it)
{
    static picture pixels;
    const double s = 0.7, alpha = 0.6, radiance = 3.0, through = (1.0 - alpha) * (1.0 - alpha);
    const vec3 black = {0.0f, 0.0f, 0.0f}, glow = {3.0f, 3.0f, 3.0f};
    alp_scene *scene = NULL;
    alpi_builder b;
    alpi_builder_start(&b, context, "panes that emit");
    add_specks(&b);
    const uint32_t pane = alpi_builder_material(&b, "pane", black, glow);
    b.scene->materials[pane].alpha_mode = ALPI_ALPHA_BLEND;
    b.scene->materials[pane].base_color[3] = (float)alpha;
    for (int i = 0; i < 2; i++) {
        const float z = -0.5f * (float)i, h = 0.1f;
        alpi_builder_surface(&b, "pane", pane);
        alpi_builder_quad(&b, (const vec3[4]){{-h, -h, z}, {h, -h, z}, {h, h, z}, {-h, h, z}});
    }
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    alp_lpv *lpv = make_volume(scene, 0.0f);
    alp_render_options o = options_of(NULL, NULL);
    o.scattering = (float)s;
    draw(scene, lpv, o, pixels);
    const double expected = alpha * radiance * (exp(-s) + through * exp(-1.5 * s));
    for (int i = 0; i < PIXELS; i++) {
        ASSERT_NEAR((double)pixels[i][0] * (double)pixels[i][3], expected, 1e-5);
        ASSERT_NEAR(pixels[i][3], 1.0 - through * through * exp(-2.0 * s), 1e-5);
    }
    alp_lpv_destroy(lpv);
    alp_scene_destroy(scene);
}

/// A camera that faces a plane of albedo ½ in light of radiance L from everywhere sees
/// (1 − metallic)(1 − F) L / 2 + F L, with F = .04, or the base colour ½ of a metal.
TEST(a_plane_mirrors_by_schlick)
{
    static picture pixels;
    for (int i = 0; i < 3; i++) {
        const double metal = 0.5 * i;
        alp_scene *scene = NULL;
        alpi_builder b;
        alpi_builder_start(&b, context, "plane");
        const uint32_t grey =
            alpi_builder_material(&b, "grey", (vec3){0.5f, 0.5f, 0.5f}, NO_EMISSION);
        alpi_builder_surface(&b, "plane", grey);
        alpi_builder_box(&b, (vec3){-1.0f, -1.0f, -1.0f}, (vec3){1.0f, 1.0f, 0.0f}, ALPI_FACE_ALL);
        alpi_builder_camera(&b, (vec3){0.0f, 0.0f, 3.0f}, (vec3){0.0f, 0.0f, 0.0f}, 0.01f);
        ASSERT_OK(context, alpi_builder_finish(&b, &scene));
        scene->materials[grey].metallic = (float)metal;
        alp_lpv *lpv = make_volume(scene, 1.0f);
        alp_render_options o = options_of(NULL, NULL);
        const double f = 0.04 + metal * (0.5 - 0.04);
        draw(scene, lpv, o, pixels);
        assert_even(pixels, 0.5, 1e-5);
        o.gloss = true;
        for (int black = 0; black < 2; black++) { // as metals are baked, they mirror alike
            alp_scene_set_metals(scene, black == 1 ? ALP_METALS_BLACK : ALP_METALS_DIFFUSE);
            draw(scene, lpv, o, pixels);
            assert_even(pixels, (1.0 - metal) * (1.0 - f) * 0.5 + f, 1e-5);
        }
        alp_lpv_destroy(lpv);
        alp_scene_destroy(scene);
    }
}

TEST(media_without_a_volume_are_refused)
{
    alp_scene *scene = test_load(context, "builtin:furnace");
    alp_lpv *lpv = make_volume(scene, 1.0f);
    alp_field *field = NULL;
    alp_image *image = NULL;
    ASSERT_OK(context, alp_field_create_lpv(lpv, &field));
    alp_render_options o = options_of(NULL, field);
    o.gloss = true;
    assert_int_equal(alp_render(scene, &o, &image), ALP_ERROR_INVALID_ARGUMENT);
    o.gloss = false;
    o.scattering = 1.0f;
    assert_int_equal(alp_render(scene, &o, &image), ALP_ERROR_INVALID_ARGUMENT);
    o.lpv = lpv;
    o.scattering = -1.0f;
    assert_int_equal(alp_render(scene, &o, &image), ALP_ERROR_INVALID_ARGUMENT);
    o.scattering = NAN;
    assert_int_equal(alp_render(scene, &o, &image), ALP_ERROR_INVALID_ARGUMENT);
    alp_field_destroy(field);
    alp_lpv_destroy(lpv);
    alp_scene_destroy(scene);
}

TEST(the_camera_of_a_picture_is_found)
{
    alp_scene *scene = test_load(context, "builtin:furnace");
    alp_render_options o = alp_render_options_default();
    alp_camera camera;
    ASSERT_OK(context, alp_render_find_camera(scene, &o, &camera));
    ASSERT_NEAR(camera.position[0], 0.85, 1e-6);
    o.camera = camera;
    o.camera.position[0] = 0.5f;
    ASSERT_OK(context, alp_render_find_camera(scene, &o, &camera));
    ASSERT_NEAR(camera.position[0], 0.5, 0.0);
    alp_scene_destroy(scene);
}
