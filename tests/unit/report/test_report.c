// SPDX-License-Identifier: MIT
// The page about a bake: well-formed, self-contained, true to the maps, and proof against names.
#include "base/image.h"
#include "maps/lightmap.h"
#include "page_check.h"
#include "report/report_parts.h"
#include "test_scenes.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

enum { SIZE = 64 };

typedef struct baked {
    alp_context *context;
    alp_scene *scene;
    alp_lightmap *lightmap;
    alp_bake_report report;
} baked;

static alp_bake_options small_options(unsigned maps)
{
    alp_bake_options options = alp_bake_options_default();
    options.atlas.size = SIZE;
    options.atlas.mode = ALP_ATLAS_CHARTS;
    options.occlusion.samples = 16;
    options.light.samples = 16;
    options.maps = maps;
    return options;
}

static baked bake(alp_context *context, alp_scene *scene, const alp_bake_options *options)
{
    baked b = {.context = context, .scene = scene};
    ASSERT_OK(context, alp_bake(scene, options, &b.lightmap, &b.report));
    return b;
}

static baked bake_builtin(const char *name, const alp_bake_options *options)
{
    alp_context *context = test_context(2);
    alp_scene *scene = test_load(context, name);
    return bake(context, scene, options);
}

static void end(baked *b)
{
    alp_lightmap_destroy(b->lightmap);
    alp_scene_destroy(b->scene);
    alp_context_destroy(b->context);
}

/// The page as text, freed by the caller.
static char *write_page(const baked *b, const alp_report_options *options)
{
    const char *path = test_path(test_folder(), "page.html");
    ASSERT_OK(b->context, alp_bake_write_report(b->scene, b->lightmap, &b->report, options, path));
    size_t size = 0;
    char *bytes = (char *)test_read_file(path, &size), *text = malloc(size + 1);
    memcpy(text, bytes, size);
    text[size] = '\0';
    assert_int_equal(strlen(text), size);
    free(bytes);
    return text;
}

TEST(page_is_whole_and_has_its_figures)
{
    const alp_bake_options options =
        small_options(ALP_MAP_AO | ALP_MAP_BENT | ALP_MAP_LIGHT | ALP_MAP_OBSCURANCE);
    baked b = bake_builtin("builtin:cornell", &options);
    b.report.seconds_load = 12.5;
    b.report.rays = 1234567;
    alp_report_options page = alp_report_options_default();
    page.command = "alpenglow bake builtin:cornell";
    char *text = write_page(&b, &page), wanted[128];
    page_check_form(text);
    page_check_self_contained(text);
    // The scene, four maps, two of them with a heat map; the layout is no <img>.
    assert_int_equal(page_count_of(text, "<img "), 7);
    assert_int_equal(page_count_of(text, "<svg class=\"layout\""), 1);
    snprintf(wanted, sizeof wanted, "<dt>Triangles</dt><dd>%u</dd>", b.report.scene.triangles);
    ASSERT_HAS(text, wanted);
    snprintf(wanted, sizeof wanted, "1 page of %d × %d", SIZE, SIZE);
    ASSERT_HAS(text, wanted);
    ASSERT_HAS(text, "<dt>Rays</dt><dd>1\u202F234\u202F567</dd>");
    ASSERT_HAS(text, "Load</th><td>12.50\u00A0s</td>");
    ASSERT_HAS(text, "<span>alpenglow</span> <span>bake</span> <span>builtin:cornell</span>");
    ASSERT_HAS(text, "exposure: L = 2<sup>");
    // Beside the steps at seams, of occlusion and of light; of obscurance none is stated.
    assert_true(b.report.seams.count > 0);
    assert_int_equal(page_count_of(text, "; the map's noise is "), 2);
    snprintf(wanted, sizeof wanted, "%016llx", (unsigned long long)b.report.input_hash);
    ASSERT_HAS(text, wanted);
    ASSERT_HAS(text, "<dt>Findings</dt><dd>0</dd>");
    assert_null(strstr(text, "id=\"findings\""));
    assert_true(b.report.light_passes > 0);
    ASSERT_HAS(text, "id=\"passes\"");
    ASSERT_HAS(text, "<bdi>short block</bdi>");
    free(text);
    end(&b);
}

/// Light where it was baked, else occlusion.
TEST(the_scene_is_shown_with_what_was_baked)
{
    static const unsigned maps[] = {ALP_MAP_AO | ALP_MAP_LIGHT, ALP_MAP_AO};
    static const char *const said[] = {"With baked light, from its first camera",
                                       "With baked occlusion, from its first camera"};
    double means[2][3] = {{0.0}};
    for (int i = 0; i < 2; i++) {
        const alp_bake_options options = small_options(maps[i]);
        baked b = bake_builtin("builtin:cornell", &options);
        char *text = write_page(&b, NULL);
        ASSERT_HAS(text, said[i]);
        alp_image *image = page_find_picture(b.context, text, "Picture of the scene");
        const size_t count = (size_t)image->info.width * image->info.height;
        const uint32_t channels = image->info.channels;
        for (size_t p = 0; p < 3 * count; p++) {
            means[i][p % 3] += alp_image_bytes(image)[p / 3 * channels + p % 3] / (double)count;
        }
        alp_image_destroy(image);
        free(text);
        end(&b);
    }
    for (int i = 0; i < 2; i++) { // neither black nor white
        assert_true(means[i][0] > 30.0 && means[i][0] < 225.0);
    }
    assert_true(fabs(means[1][0] - means[1][2]) < 1e-9); // occlusion is grey
    assert_true(means[0][0] > means[0][2] + 3.0);        // the lamp is yellow
}

TEST(vertices_have_a_page_without_maps)
{
    alp_bake_options options = small_options(ALP_MAP_AO);
    options.atlas.mode = ALP_ATLAS_VERTEX;
    baked b = bake_builtin("builtin:cornell", &options);
    char *text = write_page(&b, NULL);
    page_check_form(text);
    assert_int_equal(page_count_of(text, "data:image"), 1); // the scene
    assert_null(strstr(text, "id=\"maps\""));
    assert_null(strstr(text, "id=\"passes\""));
    ASSERT_HAS(text, "<dt>Vertices</dt>");
    free(text);
    end(&b);
}

// --- text from outside ---------------------------------------------------------------------------

static const float square[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
static const uint32_t two_triangles[6] = {0, 1, 2, 0, 2, 3};

static alp_mesh named_square(const char *name)
{
    return (alp_mesh){.name = name,
                      .positions = &square[0][0],
                      .indices = two_triangles,
                      .vertex_count = 4,
                      .triangle_count = 2};
}

TEST(only_the_first_pages_are_shown)
{
    alp_bake_options options = small_options(ALP_MAP_AO);
    options.atlas.size = 16;
    options.atlas.texels_per_metre = 12.0; // no two squares on a page
    options.occlusion.samples = 4;
    enum { COUNT = 18 };
    alp_mesh meshes[COUNT];
    for (int i = 0; i < COUNT; i++) {
        meshes[i] = named_square("square");
    }
    alp_context *context = test_context(1);
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, COUNT, &scene));
    baked b = bake(context, scene, &options);
    assert_true(b.report.atlas.pages > 16);
    char *text = write_page(&b, NULL), wanted[64];
    page_check_form(text);
    assert_int_equal(page_count_of(text, "<h3>Page "), 16);
    assert_int_equal(page_count_of(text, "<svg class=\"layout\""), 16);
    snprintf(wanted, sizeof wanted, "The first 16 of %u pages are shown.", b.report.atlas.pages);
    ASSERT_HAS(text, wanted);
    free(text);
    end(&b);
}

TEST(text_from_outside_stays_text)
{
    static char long_name[5001];
    memset(long_name, 'x', 5000);
    const alp_mesh meshes[] = {
        named_square("</title><script>alert(1)</script>"),
        named_square("a \"quoted\" & 'single' <b>"),
        named_square("broken \xFF\xC3( \xE2\x82 \xED\xA0\x80 \xC0\xAF \xF4\x90\x80\x80 end"),
        named_square("control \x01\x1B[31m\x7F \xC2\x9B tab\there \xEF\xBF\xBE"),
        named_square(long_name),
        named_square("Straße \xE2\x80\xAE 雪 \xF0\x9F\x8F\x94")};
    alp_context *context = test_context(1);
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, 6, &scene));
    const alp_bake_options options = small_options(ALP_MAP_AO);
    baked b = bake(context, scene, &options);
    const alp_report_finding findings[] = {
        {"<code>", "</li>&", "it's <wrong>; do \"this\" & that; then go"}, {NULL, NULL, NULL}};
    alp_report_options page = alp_report_options_default();
    page.findings = findings;
    page.finding_count = 2;
    page.command = "alpenglow bake '<x>' \xFE";
    char *text = write_page(&b, &page);
    page_check_form(text);
    page_check_self_contained(text);
    ASSERT_HAS(text, "&lt;/title&gt;&lt;script&gt;alert(1)&lt;/script&gt;</bdi>");
    ASSERT_HAS(text, "a &quot;quoted&quot; &amp; &#39;single&#39; &lt;b&gt;</bdi>");
    // Each byte that belongs to no character is one U+FFFD: Unicode says how many, loosely.
    ASSERT_HAS(text, "broken \uFFFD\uFFFD( \uFFFD\uFFFD \uFFFD\uFFFD\uFFFD \uFFFD\uFFFD "
                     "\uFFFD\uFFFD\uFFFD\uFFFD end</bdi>");
    ASSERT_HAS(text, "control \uFFFD\uFFFD[31m\uFFFD \uFFFD tab here \uFFFD</bdi>");
    ASSERT_HAS(text, "xxx…</bdi>");
    assert_true(strlen(text) > 10000 && page_count_of(text, "x") < 3000);
    ASSERT_HAS(text, "Straße \xE2\x80\xAE 雪 \xF0\x9F\x8F\x94</bdi>");
    ASSERT_HAS(text, "<code>&lt;code&gt;</code><b><bdi>&lt;/li&gt;&amp;</bdi></b>"
                     "<p><bdi>it&#39;s &lt;wrong&gt;; do &quot;this&quot; &amp; that</bdi></p>"
                     "<p class=\"advice\"><bdi>then go</bdi></p></li>");
    ASSERT_HAS(text, "<span>&#39;&lt;x&gt;&#39;</span> <span>\uFFFD</span></code>");
    ASSERT_HAS(text, "<dt>Findings</dt><dd>2</dd>");
    free(text);
    end(&b);
}

// --- pictures ------------------------------------------------------------------------------------

TEST(pictures_show_the_maps)
{
    const alp_bake_options options = small_options(ALP_MAP_AO | ALP_MAP_BENT | ALP_MAP_LIGHT);
    baked b = bake_builtin("builtin:cornell", &options);
    char *text = write_page(&b, NULL);
    const char *exposure_text = strstr(text, "L = 2<sup>");
    exposure_text += strlen("L = 2<sup>");
    const char *minus = "−";
    const bool is_negative = strncmp(exposure_text, minus, strlen(minus)) == 0;
    double exposure = strtod(exposure_text + (is_negative ? strlen(minus) : 0), NULL);
    exposure = is_negative ? -exposure : exposure;
    static const struct {
        alp_map map;
        const char *alt;
    } maps[] = {{ALP_MAP_AO, "Map of ambient occlusion"},
                {ALP_MAP_BENT, "Map of bent normals"},
                {ALP_MAP_LIGHT, "Map of irradiance"}};
    for (int m = 0; m < 3; m++) {
        alp_image *image = page_find_picture(b.context, text, maps[m].alt);
        const float *page = alp_lightmap_map_page(b.lightmap, maps[m].map, 0, NULL, NULL);
        const uint8_t *bytes = alp_image_bytes(image);
        assert_true(image->info.width == SIZE && image->info.height == SIZE);
        for (size_t i = 0; i < (size_t)SIZE * SIZE; i++) {
            assert_int_equal(bytes[4 * i + 3], page[4 * i + 3] > 0.0f ? 255 : 0);
            for (size_t k = 0; k < 3 && page[4 * i + 3] > 0.0f; k++) {
                const double value = (double)page[4 * i + k];
                const double film = 1.0 - exp(-exp2(exposure) * value);
                const double shown = maps[m].map == ALP_MAP_AO ? value
                                     : maps[m].map == ALP_MAP_BENT
                                         ? 0.5 * value + 0.5
                                         : (double)alpi_linear_to_srgb((float)film);
                // half a byte, and rounding of floats
                ASSERT_NEAR(bytes[4 * i + k] / 255.0, shown, 0.501 / 255.0);
            }
        }
        alp_image_destroy(image);
    }
    free(text);
    end(&b);
}

/// A PNG's size is any number of bytes, and base64 takes three at a time.
TEST(pictures_of_all_sizes_come_back)
{
    alp_context *context = test_context(1);
    size_t rests[3] = {0};
    for (uint32_t width = 1; width < 24; width++) {
        alp_image *image = NULL;
        const alp_image_info info = {width, 1, 4, ALP_COMPONENT_U8};
        ASSERT_OK(context, alp_image_create(context, info, &image));
        for (size_t i = 0; i < (size_t)4 * width; i++) {
            alp_image_bytes(image)[i] = (uint8_t)(37 * i * i + 11 * width);
        }
        const char *path = test_path(test_folder(), "page.html");
        alpi_file_writer writer;
        ASSERT_OK(context, alpi_file_open(context, path, false, &writer));
        alpi_page page = {.context = context, .writer = &writer};
        alpi_page_picture(&page, image, "It");
        ASSERT_OK(context, alpi_page_flush(&page));
        ASSERT_OK(context, alpi_file_commit(&writer));
        size_t size = 0;
        char *text = (char *)test_read_file(path, &size);
        text[size - 1] = '\0'; // a bracket
        rests[(size_t)page_count_of(text, "=\"/") + (size_t)page_count_of(text, "==\"/")]++;
        alp_image *back = page_find_picture(context, text, "It");
        assert_int_equal(back->info.width, width);
        assert_memory_equal(alp_image_bytes(back), alp_image_bytes(image), (size_t)4 * width);
        free(text);
        alp_image_destroy(back);
        alp_image_destroy(image);
    }
    assert_true(rests[0] > 0 && rests[1] > 0 && rests[2] > 0);
    alp_context_destroy(context);
}

/// Bytes of a colour's luminance, near enough to order colours by.
static int brightness(const uint8_t rgb[3])
{
    return 2 * rgb[0] + 7 * rgb[1] + rgb[2];
}

TEST(heat_maps_show_errors_over_the_mean)
{
    uint8_t last[3], color[3];
    alpi_heat_color(0.0f, last);
    for (int i = 1; i <= 100; i++) { // in grey the order stays
        alpi_heat_color((float)i / 100.0f, color);
        assert_true(brightness(color) > brightness(last));
        memcpy(last, color, sizeof last);
    }
    const alp_bake_options options = small_options(ALP_MAP_AO);
    baked b = bake_builtin("builtin:cornell", &options);
    char *text = write_page(&b, NULL);
    const char *top_text = strstr(text, "<span>≥\u00A0");
    assert_non_null(top_text);
    const double top = strtod(top_text + strlen("<span>≥\u00A0"), NULL) / 100.0;
    // Rounded up to 1, 2 or 5 times a power of ten: at most by 2.5.
    assert_true(top >= 0.999 * b.report.ao_p99_error && top <= 2.51 * b.report.ao_p99_error);
    const alp_lightmap *l = b.lightmap;
    const float *page = alp_lightmap_page(l, 0, NULL, NULL);
    double mean = 0.0, count = 0.0;
    for (size_t i = 0; i < (size_t)SIZE * SIZE; i++) {
        mean += page[4 * i + 3] > 0.0f ? (double)page[4 * i] : 0.0;
        count += page[4 * i + 3] > 0.0f;
    }
    mean /= count;
    alp_image *image = page_find_picture(b.context, text, "Heat map of the standard error");
    const uint8_t *bytes = alp_image_bytes(image);
    for (uint32_t i = 0; i < l->texels.count; i++) {
        const uint8_t *pixel =
            bytes + 4 * ((size_t)l->texels.pixels[i][1] * SIZE + l->texels.pixels[i][0]);
        alpi_heat_color((float)((double)l->errors[i] / mean / top), color);
        for (int k = 0; k < 3 && pixel[3] > 0; k++) {
            ASSERT_NEAR(pixel[k], color[k], 1.0); // rounding of the mean
        }
    }
    alp_image_destroy(image);
    free(text);
    end(&b);
}

/// A square whose lightmap coordinates cover a corner of a large page.
static baked bake_corner(uint32_t size, float side)
{
    const float uvs[4][2] = {{0, 0}, {side, 0}, {side, side}, {0, side}};
    alp_mesh mesh = named_square("corner"), above = named_square("above");
    static const float near_square[4][3] = {
        {0.2f, 0.2f, 0.1f}, {0.2f, 0.7f, 0.1f}, {0.6f, 0.7f, 0.1f}, {0.6f, 0.2f, 0.1f}};
    mesh.uvs = &uvs[0][0];
    above.positions = &near_square[0][0];
    above.uvs = &uvs[0][0];
    const alp_mesh meshes[] = {above, mesh};
    alp_context *context = test_context(1);
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, 2, &scene));
    alp_bake_options options = small_options(ALP_MAP_AO);
    options.atlas.mode = ALP_ATLAS_KEEP;
    options.atlas.size = size;
    options.only = "corner";
    options.sampling.accuracy = ALP_ADAPTIVE_OFF;
    options.occlusion.distance = 1.0f;
    return bake(context, scene, &options);
}

TEST(large_pages_are_means_of_covered_texels)
{
    enum { LARGE = 2500, STEP = 3, SMALL = (LARGE + STEP - 1) / STEP };
    baked b = bake_corner(LARGE, 40.5f / LARGE);
    char *text = write_page(&b, NULL);
    ASSERT_HAS(text, "the covered ones of 3 × 3");
    // What was baked lies there, and nothing else.
    ASSERT_HAS(text, "<rect x=\"0.00\" y=\"0.00\" width=\"40.50\" height=\"40.50\"><title>1: "
                     "corner</title></rect>");
    assert_null(strstr(text, "<bdi>above"));
    assert_int_equal(b.report.atlas.texels, 41 * 41);
    ASSERT_HAS(text, "<td>1\u202F681</td>");
    alp_image *image = page_find_picture(b.context, text, "Map of ambient occlusion");
    assert_true(image->info.width == SMALL && image->info.height == SMALL);
    const float *page = alp_lightmap_map_page(b.lightmap, ALP_MAP_AO, 0, NULL, NULL);
    const uint8_t *bytes = alp_image_bytes(image);
    uint32_t partly = 0;
    for (size_t y = 0; y < 20; y++) {
        for (size_t x = 0; x < 20; x++) {
            double sum = 0.0, count = 0.0;
            for (size_t i = 0; i < (size_t)STEP * STEP; i++) {
                const size_t at = (STEP * y + i / STEP) * LARGE + STEP * x + i % STEP;
                const double covered = page[4 * at + 3] > 0.0f ? 1.0 : 0.0;
                sum += covered * (double)page[4 * at];
                count += covered;
            }
            const uint8_t *pixel = bytes + 4 * (y * SMALL + x);
            assert_int_equal(pixel[3], count > 0.0 ? 255 : 0);
            if (count > 0.0) {
                ASSERT_NEAR(pixel[0] / 255.0, sum / count, 0.501 / 255.0);
            }
            partly += count > 0.0 && count < 9.0;
        }
    }
    assert_true(partly > 20); // the rim, where a mean over all nine would be too dark
    alp_image_destroy(image);
    free(text);
    end(&b);
}

// --- plots ---------------------------------------------------------------------------------------

TEST(passes_are_plotted_by_decades)
{
    const alp_bake_options options = small_options(ALP_MAP_AO);
    baked b = bake_builtin("builtin:cornell", &options);
    b.report.light_passes = 3;
    memcpy(b.report.light_changes, (float[]){1.0f, 0.1f, 0.01f}, 3 * sizeof(float));
    b.report.light_energy = (alp_light_energy){true, 12.5, 10.0, 1.5, 0.75, 0.25};
    char *text = write_page(&b, NULL);
    page_check_form(text);
    const char *points = strstr(text, "class=\"curve\" points=\"");
    assert_non_null(points);
    double x[3], y[3];
    char *at = strchr(points + strlen("class=\"curve\" points="), '"');
    for (int i = 0; i < 3; i++) {
        x[i] = strtod(at + 1, &at);
        y[i] = strtod(at + 1, &at);
    }
    assert_int_equal(*at, '"');
    ASSERT_NEAR(x[1] - x[0], x[2] - x[1], 0.11); // a tenth is what is written
    ASSERT_NEAR(y[1] - y[0], y[2] - y[1], 0.11);
    assert_true(x[1] > x[0] && y[1] > y[0] + 20.0); // less is lower
    ASSERT_HAS(text, "bounce 3 changed it by 1.0\u00A0%");
    free(text);
    // What no pass should give: none, infinite, no number, more than there is room for.
    b.report.light_passes = UINT32_MAX;
    memcpy(b.report.light_changes, (float[]){INFINITY, NAN, -1.0f, 0.0f, 1e-30f},
           5 * sizeof(float));
    text = write_page(&b, NULL);
    page_check_form(text);
    assert_null(strstr(text, "nan"));
    assert_null(strstr(text, "inf"));
    free(text);
    end(&b);
}

// --- faults --------------------------------------------------------------------------------------

static int files_in(const char *folder)
{
    DIR *list = opendir(folder);
    int count = -2; // . and ..
    while (readdir(list) != NULL) {
        count++;
    }
    closedir(list);
    return count;
}

TEST(existing_files_and_bad_places_are_refused)
{
    const alp_bake_options options = small_options(ALP_MAP_AO);
    baked b = bake_builtin("builtin:cornell", &options);
    const char *folder = test_folder(), *path = test_path(folder, "page.html");
    alp_report_options page = alp_report_options_default();
    ASSERT_OK(b.context, alp_bake_write_report(b.scene, b.lightmap, &b.report, &page, path));
    assert_int_equal(alp_bake_write_report(b.scene, b.lightmap, &b.report, &page, path),
                     ALP_ERROR_IO);
    ASSERT_HAS(alp_context_message(b.context), "exists already");
    page.overwrite = true;
    ASSERT_OK(b.context, alp_bake_write_report(b.scene, b.lightmap, &b.report, &page, path));
    assert_int_equal(files_in(folder), 1);
    path = test_path(folder, "missing/page.html");
    assert_int_equal(alp_bake_write_report(b.scene, b.lightmap, &b.report, &page, path),
                     ALP_ERROR_IO);
    page.finding_count = 1; // of none
    assert_int_equal(alp_bake_write_report(b.scene, b.lightmap, &b.report, &page, path),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_bake_write_report(NULL, b.lightmap, &b.report, NULL, path),
                     ALP_ERROR_INVALID_ARGUMENT);
    end(&b);
}

/// @param step of the allocation that fails: 1, each
static void fail_allocations(uint32_t picture_samples, int step)
{
    int left = 0;
    alp_context *context = test_context_failing(&left);
    alp_scene *scene = test_load(context, "builtin:cornell");
    const alp_bake_options options = small_options(ALP_MAP_AO | ALP_MAP_LIGHT);
    baked b = bake(context, scene, &options);
    const char *folder = test_folder(), *path = test_path(folder, "page.html");
    alp_report_options page = alp_report_options_default();
    page.command = "alpenglow bake";
    page.picture_samples = picture_samples;
    const int enough = left;
    int needed = 0;
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    for (; result != ALP_OK && needed < 500; needed += step) {
        left = needed;
        result = alp_bake_write_report(scene, b.lightmap, &b.report, &page, path);
        assert_true(result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY);
        assert_int_equal(files_in(folder), result == ALP_OK);
    }
    assert_true(result == ALP_OK && needed > 10);
    left = enough;
    end(&b);
}

TEST(every_allocation_may_fail)
{
    fail_allocations(0, 1);
    fail_allocations(1, 13); // each that fails after the picture draws it first
}
