// SPDX-License-Identifier: MIT
// Pictures of the reference against stored ones by a Z-test: mean and variance of each pixel, made
// once with many more paths and another seed.
//
// Pixels are pooled in tiles of 8 × 8: z = Σ (x − y) / √ Σ (var x + var y), channel by channel, and
// once over the whole picture, plainly and weighted. Pooled variances rest on nearly a thousand
// degrees of freedom, so z is normal where nothing is wrong: over 12 seeds (`SHOW_SEEDS=12`) the
// mean square of the tiles was 0.6 (a third of the Cornell box's tiles are black) to 1.1, the
// greatest of 3,600 sums 3.5. 4 pictures × 26 sums × 3 channels beyond ±5 by chance: once in 5,600
// changes of the random numbers; as long as these stay, the test always says the same.
//
//     UPDATE_PICTURES=4096 build/dev/tests/test_truth test_stored_pictures pictures_agree
//
// writes the stored pictures anew by 4096 paths a pixel. Do so only after a change that is known to
// make them truer.
#include "test_support.h"

#include "scene/scene.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

enum { WIDTH = 48, HEIGHT = 32, PIXELS = WIDTH * HEIGHT, TILE = 8 };
enum { TILES = PIXELS / (TILE * TILE) };
// With 8 to 16 times the paths of the test the stored noise adds little to its own.
enum { SEED = 7, UPDATE_SEED = 20260401 };
static const double GREATEST_Z = 5.0;

typedef struct subject {
    const char *name, *scene;
    uint32_t paths; // as many as show 2 % more light
    bool daylight;  // a clear sky with its sun
} subject;
static const subject subjects[] = {{"cornell", "builtin:cornell", 256, false},
                                   {"teapot-room", "builtin:teapot-room", 256, false},
                                   {"windows", "builtin:windows", 512, false},
                                   {"atrium", "builtin:atrium", 256, true}};
enum { CORNELL = 0, TEAPOT_ROOM = 1, WINDOWS = 2 };
enum { SUBJECT_COUNT = sizeof subjects / sizeof *subjects };

/// Radiance over the whole pixel, and the variance of that mean.
typedef struct picture {
    float mean[3 * PIXELS], variance[3 * PIXELS];
} picture;

static picture ours, stored;
TEST_CONTEXT(2);

// --- pictures ------------------------------------------------------------------------------------

static alp_render_options options_of(const subject *s, uint32_t paths, uint64_t seed)
{
    alp_render_options o = alp_render_options_default();
    o.method = ALP_RENDER_REFERENCE;
    o.width = WIDTH;
    o.height = HEIGHT;
    o.samples = paths;
    o.occlusion.seed = seed;
    if (s->daylight) {
        o.lighting.sky.kind = ALP_SKY_CLEAR;
        o.lighting.sun.azimuth = 2.6f;
        o.lighting.sun.elevation = 0.9f;
        o.lighting.sun.illuminance = 1e5f;
    }
    return o;
}

/// Renders a scene that was loaded, and perhaps broken since.
static void render(const alp_scene *scene, const subject *s, uint32_t paths, uint64_t seed)
{
    alp_image *image = NULL, *error = NULL;
    alp_render_options o = options_of(s, paths, seed);
    o.error = &error;
    ASSERT_OK(context, alp_render(scene, &o, &image));
    const float *values = alp_image_floats(image), *errors = alp_image_floats(error);
    for (int i = 0; i < PIXELS; i++) {
        for (int k = 0; k < 3; k++) { // colours are those of what is covered
            const float alpha = values[4 * i + 3], spread = errors[4 * i + k] * alpha;
            ours.mean[3 * i + k] = values[4 * i + k] * alpha;
            ours.variance[3 * i + k] = spread * spread;
        }
    }
    alp_image_destroy(image);
    alp_image_destroy(error);
}

static alp_scene *load(const subject *s)
{
    alp_scene *scene = test_load(context, s->scene);
    return scene;
}

static const char *path_of(const char *folder, const char *name, const char *what,
                           const char *ending)
{
    static char file[128];
    snprintf(file, sizeof file, "%s.%s.%s", name, what, ending);
    return test_path(folder, file);
}

static alp_image *image_of(const float *pixels)
{
    const alp_image_info info = {WIDTH, HEIGHT, 3, ALP_COMPONENT_FLOAT};
    alp_image *image = NULL;
    ASSERT_OK(context, alp_image_create(context, info, &image));
    memcpy(alp_image_floats(image), pixels, sizeof *pixels * 3 * PIXELS);
    return image;
}

static void save(const float *pixels, const char *path)
{
    alp_image *image = image_of(pixels);
    ASSERT_OK(context, alp_image_save(image, path, true));
    alp_image_destroy(image);
}

static void load_pixels(const char *path, float *pixels)
{
    alp_image *image = NULL;
    ASSERT_OK(context, alp_image_load(context, path, &image));
    const alp_image_info info = alp_image_get_info(image);
    assert_true(info.width == WIDTH && info.height == HEIGHT && info.channels == 3);
    memcpy(pixels, alp_image_floats(image), sizeof *pixels * 3 * PIXELS);
    alp_image_destroy(image);
}

static void load_stored(const subject *s)
{
    load_pixels(path_of(STORED_FOLDER, s->name, "mean", "exr"), stored.mean);
    load_pixels(path_of(STORED_FOLDER, s->name, "variance", "exr"), stored.variance);
}

// --- the test ------------------------------------------------------------------------------------

/// Sums over the pixels of a rectangle in one channel.
typedef struct pooled {
    double apart, light;     // Σ (x − y), Σ y
    double variance, stored; // of `apart`, and the stored picture's part of it
} pooled;

static pooled pool(int x0, int y0, int width, int height, int channel)
{
    pooled p = {0.0, 0.0, 0.0, 0.0};
    for (int y = y0; y < y0 + height; y++) {
        for (int x = x0; x < x0 + width; x++) {
            const int i = 3 * (y * WIDTH + x) + channel;
            p.apart += (double)ours.mean[i] - (double)stored.mean[i];
            p.light += (double)stored.mean[i];
            p.stored += (double)stored.variance[i];
            p.variance += (double)ours.variance[i];
        }
    }
    const double rounding = 1e-6 * p.light; // of floats, where there is hardly any noise
    p.stored += rounding * rounding;
    p.variance += p.stored;
    return p;
}

static double z_of(const pooled *p)
{
    return p->apart == 0.0 ? 0.0 : p->apart / sqrt(p->variance);
}

/// The worst z so far and which it is of.
typedef struct worst_z {
    double z;
    char what[32];
} worst_z;

static void hold(worst_z *worst, double z, const char *what, int tile)
{
    if (!(fabs(z) <= fabs(worst->z))) { // NaN is the worst
        worst->z = z;
        snprintf(worst->what, sizeof worst->what, tile < 0 ? "%s" : "%s %d", what, tile);
    }
}

/// All tests of one channel. A light that is wrong by a factor shows best in the sum of tiles
/// weighted by y / var y. @return sum of the tiles' z²
static double hold_channel(int channel, worst_z *worst)
{
    double squares = 0.0;
    pooled scaled = {0.0, 0.0, 0.0, 0.0};
    for (int tile = 0; tile < TILES; tile++) {
        const int x = tile % (WIDTH / TILE) * TILE, y = tile / (WIDTH / TILE) * TILE;
        const pooled p = pool(x, y, TILE, TILE, channel);
        const double weight = p.light > 0.0 ? p.light / p.stored : 0.0;
        scaled.apart += weight * p.apart;
        scaled.variance += weight * weight * p.variance;
        squares += z_of(&p) * z_of(&p);
        hold(worst, z_of(&p), "tile", tile);
    }
    const pooled whole = pool(0, 0, WIDTH, HEIGHT, channel);
    hold(worst, z_of(&whole), "the sum", -1);
    hold(worst, z_of(&scaled), "the brightness", -1);
    return squares;
}

/// The worst of all tests, told; and the mean of the tiles' z², near 1 where nothing is wrong.
static double find_worst(const char *name)
{
    worst_z worst = {0.0, "any"};
    double squares = 0.0;
    for (int k = 0; k < 3; k++) {
        squares += hold_channel(k, &worst);
    }
    print_message("%s: greatest z %+.2f, of %s; mean square %.2f\n", name, worst.z, worst.what,
                  squares / (3 * TILES));
    return worst.z;
}

// --- what a failure leaves -----------------------------------------------------------------------

static void save_png(alp_image *linear, double exposure, const char *path)
{
    alp_film_options film = alp_film_options_default();
    alp_image *display = NULL;
    film.exposure = exposure;
    film.tone = ALP_TONE_FILM;
    ASSERT_OK(context, alp_film_develop(linear, &film, &display, NULL));
    ASSERT_OK(context, alp_image_save(display, path, true));
    alp_image_destroy(display);
    alp_image_destroy(linear);
}

/// Grey where both agree, red where ours is too bright, blue where it is too dark, full at five
/// standard errors.
static alp_image *picture_of_z(void)
{
    static float pixels[3 * PIXELS];
    for (int i = 0; i < PIXELS; i++) {
        const pooled p = pool(i % WIDTH, i / WIDTH, 1, 1, 1);
        const double z = z_of(&p) / 5.0;
        pixels[3 * i] = (float)fmin(1.0, 0.2 + fmax(z, 0.0));
        pixels[3 * i + 1] = 0.2f;
        pixels[3 * i + 2] = (float)fmin(1.0, 0.2 + fmax(-z, 0.0));
    }
    return image_of(pixels);
}

/// Image, reference and difference, as numbers and to look at.
static void leave_evidence(const char *name)
{
    static float difference[3 * PIXELS];
    assert_true(mkdir(FAILED_FOLDER, 0777) == 0 || errno == EEXIST);
    for (int i = 0; i < 3 * PIXELS; i++) {
        difference[i] = ours.mean[i] - stored.mean[i];
    }
    save(ours.mean, path_of(FAILED_FOLDER, name, "image", "exr"));
    save(stored.mean, path_of(FAILED_FOLDER, name, "reference", "exr"));
    save(difference, path_of(FAILED_FOLDER, name, "difference", "exr"));
    double log2_light = 0.0;
    alp_image *reference = image_of(stored.mean);
    ASSERT_OK(context, alp_film_meter(reference, NULL, &log2_light, NULL));
    const double exposure = log2(0.18) - log2_light; // one for both, so that they compare
    save_png(reference, exposure, path_of(FAILED_FOLDER, name, "reference", "png"));
    save_png(image_of(ours.mean), exposure, path_of(FAILED_FOLDER, name, "image", "png"));
    save_png(picture_of_z(), 0.0, path_of(FAILED_FOLDER, name, "difference", "png"));
    print_error("%s: image, reference and difference (.exr, .png) are in %s\n", name,
                FAILED_FOLDER);
}

// --- maintenance, on request ----------------------------------------------------------------

static void update(uint32_t paths)
{
    for (int s = 0; s < SUBJECT_COUNT; s++) {
        const subject *what = &subjects[s];
        alp_scene *scene = load(what);
        render(scene, what, paths, UPDATE_SEED);
        save(ours.mean, path_of(STORED_FOLDER, what->name, "mean", "exr"));
        save(ours.variance, path_of(STORED_FOLDER, what->name, "variance", "exr"));
        alp_scene_destroy(scene);
        printf("%s: %u paths a pixel\n", what->name, paths);
    }
}

/// What the figures above say of a right renderer, seed by seed.
static void show_seeds(uint64_t seeds)
{
    for (int s = 0; s < SUBJECT_COUNT; s++) {
        alp_scene *scene = load(&subjects[s]);
        load_stored(&subjects[s]);
        for (uint64_t seed = 1; seed <= seeds; seed++) {
            render(scene, &subjects[s], subjects[s].paths, seed);
            find_worst(subjects[s].name);
        }
        alp_scene_destroy(scene);
    }
}

/// Does what the environment asks for. Gives whether it asked.
static bool maintain(void)
{
    const char *paths = getenv("UPDATE_PICTURES"), *seeds = getenv("SHOW_SEEDS");
    if (paths != NULL) {
        update((uint32_t)strtoul(paths, NULL, 10));
    }
    if (seeds != NULL) {
        show_seeds(strtoul(seeds, NULL, 10));
    }
    return paths != NULL || seeds != NULL;
}

// --- tests ---------------------------------------------------------------------------------------

TEST(pictures_agree)
{
    if (maintain()) {
        skip();
    }
    bool good = true;
    for (int s = 0; s < SUBJECT_COUNT; s++) {
        alp_scene *scene = load(&subjects[s]);
        load_stored(&subjects[s]);
        render(scene, &subjects[s], subjects[s].paths, SEED);
        if (!(fabs(find_worst(subjects[s].name)) < GREATEST_Z)) {
            leave_evidence(subjects[s].name);
            good = false;
        }
        alp_scene_destroy(scene);
    }
    assert_true(good);
}

static void brighten_lights(alp_scene *scene)
{
    for (uint32_t m = 0; m < scene->material_count; m++) {
        for (int k = 0; k < 3; k++) {
            scene->materials[m].emission[k] *= 1.02f;
        }
    }
}

static void darken_surfaces(alp_scene *scene)
{
    for (uint32_t m = 0; m < scene->material_count; m++) {
        for (int k = 0; k < 3; k++) {
            scene->materials[m].base_color[k] *= 0.97f;
        }
    }
}

/// Turns a shelf inside out: some pixels of the picture.
static void flip_normals(alp_scene *scene)
{
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        uint32_t *corners = scene->triangles[t];
        if (strcmp(scene->surfaces[scene->triangle_surface[t]].name, "shelf") == 0) {
            const uint32_t second = corners[1];
            corners[1] = corners[2];
            corners[2] = second;
        }
    }
    for (uint32_t i = 0; i < scene->surface_count; i++) {
        const alpi_surface *s = &scene->surfaces[i];
        for (uint32_t v = s->first_vertex; v < s->first_vertex + s->vertex_count; v++) {
            for (int k = 0; k < 3 && strcmp(s->name, "shelf") == 0; k++) {
                scene->normals[v][k] = -scene->normals[v][k];
            }
        }
    }
}

/// What the comparison is worth: small faults that it must see, and the files they leave.
TEST(faults_are_seen)
{
    static const struct {
        const char *name;
        int subject;
        void (*make)(alp_scene *scene);
    } faults[] = {{"fault: light 2 % too strong", CORNELL, brighten_lights},
                  {"fault: sun 2 % too strong", WINDOWS, brighten_lights},
                  {"fault: albedo 3 % too low", TEAPOT_ROOM, darken_surfaces},
                  {"fault: a shelf inside out", TEAPOT_ROOM, flip_normals}};
    for (size_t f = 0; f < sizeof faults / sizeof *faults; f++) {
        const subject *s = &subjects[faults[f].subject];
        alp_scene *scene = load(s);
        faults[f].make(scene);
        load_stored(s);
        render(scene, s, s->paths, SEED);
        assert_true(fabs(find_worst(faults[f].name)) > GREATEST_Z);
        alp_scene_destroy(scene);
    }
}

/// Of the last fault: six files that can be read again.
TEST(a_failure_leaves_evidence)
{
    static const char *const names[] = {"image", "reference", "difference"};
    leave_evidence("example");
    for (int n = 0; n < 3; n++) {
        float pixels[3 * PIXELS];
        load_pixels(path_of(FAILED_FOLDER, "example", names[n], "exr"), pixels);
        alp_image *image = NULL;
        const char *path = path_of(FAILED_FOLDER, "example", names[n], "png");
        ASSERT_OK(context, alp_image_load(context, path, &image));
        alp_image_destroy(image);
    }
}
