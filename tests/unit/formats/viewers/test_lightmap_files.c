// SPDX-License-Identifier: MIT
// Scenes with baked light as three.js and Babylon.js files, parsed back by another reader: the same
// triangles, coordinates, light and colours.
#include "test_support.h"

#include "base/memory.h"
#include "formats/formats.h"
#include "formats/text/text_edits.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 9, HEIGHT = 8, PAGES = 2 };

/// A room whose first surface lies on both pages, whose last has no map and whose others lie on the
/// second; page 1 is too bright for half floats.
typedef struct room {
    alp_context *context;
    alp_scene *scene;
    float (*uvs)[3][2];
    uint32_t *pages;
    float values[PAGES][HEIGHT][WIDTH][4];
    const float *pointers[PAGES];
    alpi_light_pages light;
} room;

static void room_create(room *r)
{
    *r = (room){.context = test_context(1)};
    ASSERT_OK(r->context, alp_scene_load(r->context, "builtin:cornell", &r->scene));
    const uint32_t count = r->scene->triangle_count;
    r->uvs = calloc(count, sizeof *r->uvs);
    r->pages = calloc(count, sizeof *r->pages);
    for (uint32_t t = 0; t < count; t++) {
        uint32_t surface = r->scene->triangle_surface[t];
        r->pages[t] = surface == 0 ? t % 2 : surface == r->scene->surface_count - 1 ? ALPI_NONE : 1;
        for (int k = 0; k < 3; k++) { // corners of one vertex meet in every second triangle
            r->uvs[t][k][0] = (float)r->scene->triangles[t][k] / 1000.0f + (float)(t % 3 == 0) / 3;
            r->uvs[t][k][1] = 0.1f + (float)surface / 100.0f;
        }
    }
    for (uint32_t i = 0; i < PAGES * HEIGHT * WIDTH * 4; i++) {
        (&r->values[0][0][0][0])[i] = 0.37f + (float)i * (i < HEIGHT * WIDTH * 4 ? 0.7f : 1621.0f);
    }
    r->pointers[0] = &r->values[0][0][0][0];
    r->pointers[1] = &r->values[1][0][0][0];
    r->light = (alpi_light_pages){.page_count = PAGES,
                                  .width = WIDTH,
                                  .height = HEIGHT,
                                  .corner_uvs = (const float(*)[3][2])r->uvs,
                                  .triangle_pages = r->pages,
                                  .pages = r->pointers,
                                  .irradiance_per_unit = 1.0f};
}

static void room_destroy(room *r)
{
    alp_scene_destroy(r->scene);
    alp_context_destroy(r->context);
    free(r->uvs);
    free(r->pages);
}

static const char *const names[PAGES] = {"a.hdr", "a.1.hdr"};

static json_t *parse(const uint8_t *bytes, size_t size)
{
    json_error_t error;
    json_t *root = json_loadb((const char *)bytes, size, JSON_REJECT_DUPLICATES, &error);
    if (root == NULL) {
        fail_msg("%s at byte %d", error.text, error.position);
    }
    return root;
}

static json_t *encode(const room *r, bool babylon)
{
    uint8_t *bytes = NULL, *again = NULL;
    size_t size = 0, size_again = 0;
    for (int i = 0; i < 2; i++) {
        uint8_t **b = i == 0 ? &bytes : &again;
        size_t *s = i == 0 ? &size : &size_again;
        ASSERT_OK(r->context, babylon ? alpi_babylon_encode(r->scene, &r->light, names, b, s)
                                      : alpi_three_encode(r->scene, &r->light, b, s));
    }
    assert_int_equal(size, size_again); // no state, no addresses, no time
    assert_memory_equal(bytes, again, size);
    json_t *root = parse(bytes, size);
    alpi_release(r->context, bytes);
    alpi_release(r->context, again);
    return root;
}

static json_t *named(json_t *list, const char *key, const char *name)
{
    size_t i;
    json_t *item;
    json_array_foreach(list, i, item)
    {
        if (strcmp(json_string_value(json_object_get(item, key)), name) == 0) {
            return item;
        }
    }
    fail_msg("nothing has %s = %s", key, name);
    return NULL;
}

static json_t *get(json_t *object, const char *key)
{
    json_t *value = json_object_get(object, key);
    if (value == NULL) {
        fail_msg("there is no %s", key);
    }
    return value;
}

static double number(json_t *array, size_t index)
{
    json_t *value = json_array_get(array, index);
    assert_true(json_is_number(value));
    return json_number_value(value);
}

static double half_value(uint32_t half)
{
    int exponent = (int)(half >> 10 & 31);
    double mantissa = half & 1023;
    double size = exponent == 0 ? ldexp(mantissa, -24) : ldexp(1024.0 + mantissa, exponent - 25);
    return half & 0x8000 ? -size : size;
}

// --- numbers -------------------------------------------------------------------------------------

TEST_WITH_CONTEXT(floats_come_back, 1)
{
    uint32_t bits = 1;
    for (int i = 0; i < 20000; i++) {
        bits = bits * 1664525u + 1013904223u;
        float value;
        memcpy(&value, &bits, sizeof value);
        if (isfinite(value)) {
            alpi_bytes text = alpi_bytes_create(context);
            alpi_bytes_float(&text, value);
            assert_true(strtof((const char *)text.bytes, NULL) == value);
            alpi_bytes_destroy(&text);
        }
    }
    const struct {
        float value;
        const char *text;
    } short_ones[] = {{0.1f, "0.1"}, {0.0f, "0"}, {-2.5f, "-2.5"}, {1.0f / 3.0f, "0.33333334"}};
    for (int i = 0; i < 4; i++) {
        alpi_bytes text = alpi_bytes_create(context);
        alpi_bytes_float(&text, short_ones[i].value);
        assert_string_equal((const char *)text.bytes, short_ones[i].text);
        alpi_bytes_destroy(&text);
    }
}

// --- geometry ------------------------------------------------------------------------------------

/// A mesh of either file.
typedef struct mesh {
    json_t *positions, *normals, *light_uvs, *indices;
    const char *material;
    bool clockwise;
} mesh;

static mesh three_mesh(json_t *root, size_t index)
{
    json_t *object = json_array_get(get(get(root, "object"), "children"), index);
    const char *name = json_string_value(get(object, "geometry"));
    json_t *data = get(named(get(root, "geometries"), "uuid", name), "data");
    json_t *attributes = get(data, "attributes"), *uv1 = json_object_get(attributes, "uv1");
    assert_string_equal(json_string_value(get(object, "type")), "Mesh");
    return (mesh){
        get(get(attributes, "position"), "array"),  get(get(attributes, "normal"), "array"),
        uv1 != NULL ? get(uv1, "array") : NULL,     get(get(data, "index"), "array"),
        json_string_value(get(object, "material")), false};
}

static mesh babylon_mesh(json_t *root, size_t index)
{
    json_t *object = json_array_get(get(root, "meshes"), index);
    return (mesh){get(object, "positions"),
                  get(object, "normals"),
                  json_object_get(object, "uvs2"),
                  get(object, "indices"),
                  json_string_value(get(object, "materialId")),
                  true};
}

/// The next triangle of the surface on the page, as the scene has it.
static void check_triangle(const room *r, const mesh *m, size_t triangle, uint32_t t)
{
    for (size_t k = 0; k < 3; k++) {
        size_t corner = m->clockwise ? (3 - k) % 3 : k;
        size_t v = (size_t)number(m->indices, 3 * triangle + corner);
        uint32_t vertex = r->scene->triangles[t][k];
        for (size_t axis = 0; axis < 3; axis++) { // printed floats come back exactly
            assert_true((float)number(m->positions, 3 * v + axis) ==
                        r->scene->positions[vertex][axis]);
            assert_true((float)number(m->normals, 3 * v + axis) == r->scene->normals[vertex][axis]);
        }
        for (size_t axis = 0; axis < 2 && m->light_uvs != NULL; axis++) {
            assert_true((float)number(m->light_uvs, 2 * v + axis) == r->uvs[t][k][axis]);
        }
    }
}

/// Meshes stand in the order of surfaces, then pages, then those without one; triangles in theirs.
static void check_meshes(const room *r, json_t *root, mesh (*at)(json_t *, size_t),
                         const char *page_of[PAGES + 1])
{
    size_t index = 0;
    for (uint32_t s = 0; s < r->scene->surface_count; s++) {
        const alpi_surface *surface = &r->scene->surfaces[s];
        for (uint32_t p = 0; p <= PAGES; p++) {
            size_t found = 0;
            mesh m = {0};
            for (uint32_t i = 0; i < surface->triangle_count; i++) {
                uint32_t t = surface->first_triangle + i;
                if (r->pages[t] == (p < PAGES ? p : ALPI_NONE)) {
                    m = found == 0 ? at(root, index) : m;
                    assert_true((m.light_uvs != NULL) == (p < PAGES));
                    check_triangle(r, &m, found++, t);
                }
            }
            if (found > 0) {
                assert_int_equal(json_array_size(m.indices), 3 * found);
                page_of[p] = m.material;
                index++;
            }
        }
    }
    assert_int_equal(index, r->scene->surface_count + 1); // the first twice
}

/// As many vertices as differ in vertex or place.
TEST(vertices_are_shared)
{
    room r;
    room_create(&r);
    for (uint32_t t = 0; t < r.scene->triangle_count; t++) {
        r.pages[t] = 0;
        for (int k = 0; k < 3; k++) {
            r.uvs[t][k][0] = (float)r.scene->triangles[t][k] / 1000.0f;
        }
    }
    json_t *root = encode(&r, true);
    for (uint32_t s = 0; s < r.scene->surface_count; s++) {
        mesh m = babylon_mesh(root, s);
        assert_int_equal(json_array_size(m.positions), 3 * r.scene->surfaces[s].vertex_count);
    }
    json_decref(root);
    room_destroy(&r);
}

// --- three.js ------------------------------------------------------------------------------------

static void check_three_page(const room *r, json_t *root, uint32_t page, double intensity)
{
    char name[16];
    snprintf(name, sizeof name, "light %u", page);
    json_t *texture = named(get(root, "textures"), "uuid", name);
    const struct {
        const char *key;
        int value;
    } wanted[] = {{"channel", 1}, {"type", 1016}, {"format", 1023}, {"magFilter", 1006}};
    for (int i = 0; i < 4; i++) {
        assert_int_equal(json_integer_value(get(texture, wanted[i].key)), wanted[i].value);
    }
    assert_true(json_is_false(get(texture, "flipY")));
    assert_string_equal(json_string_value(get(texture, "colorSpace")), "srgb-linear");
    const char *image = json_string_value(get(texture, "image"));
    json_t *url = get(named(get(root, "images"), "uuid", image), "url"), *data = get(url, "data");
    assert_int_equal(json_integer_value(get(url, "width")), WIDTH);
    assert_int_equal(json_integer_value(get(url, "height")), HEIGHT);
    assert_int_equal(json_array_size(data), 4 * WIDTH * HEIGHT);
    for (size_t i = 0; i < WIDTH * HEIGHT * 4; i++) { // row 0 first
        double value = half_value((uint32_t)number(data, i)) * (i % 4 < 3 ? intensity : 1.0);
        double wants = i % 4 < 3 ? (double)r->pointers[page][i] : 1.0;
        ASSERT_NEAR(value, wants, wants * 0x1p-11); // half a unit of ten bits
    }
}

TEST(three_holds_the_scene)
{
    room r;
    room_create(&r);
    json_t *root = encode(&r, false);
    const char *materials[PAGES + 1] = {NULL};
    check_meshes(&r, root, three_mesh, materials);
    check_three_page(&r, root, 0, 1.0);
    // 0.37 + 574 · 1621 is between 14 and 15 times the largest half.
    check_three_page(&r, root, 1, 16.0);
    const double intensities[PAGES] = {1.0, 16.0};
    for (uint32_t p = 0; p <= PAGES; p++) {
        json_t *material = named(get(root, "materials"), "uuid", materials[p]);
        assert_string_equal(json_string_value(get(material, "type")), "MeshLambertMaterial");
        if (p < PAGES) {
            ASSERT_NEAR(json_number_value(get(material, "lightMapIntensity")), intensities[p], 0);
        } else { // the lamp: radiance 20.717, 10.855, 2.771
            assert_null(json_object_get(material, "lightMap"));
            json_int_t color = json_integer_value(get(material, "emissive"));
            double most = json_number_value(get(material, "emissiveIntensity"));
            ASSERT_NEAR(most, 20.717, 1e-5);
            const double wants[] = {20.717, 10.855, 2.771};
            for (int k = 0; k < 3; k++) { // half a step of eight bits of sRGB, its slope ≤ 2.3
                float srgb = (float)(color >> (16 - 8 * k) & 255) / 255.0f;
                ASSERT_NEAR((double)alpi_srgb_to_linear(srgb) * most, wants[k],
                            most * 2.3 * 0.5 / 255);
            }
        }
    }
    // Page 1 has the white, green and red walls, page 0 the floor alone, the lamp none.
    assert_int_equal(json_array_size(get(root, "materials")), 5);
    json_decref(root);
    room_destroy(&r);
}

/// A wall of metal has its base colour, unless metals are black.
TEST(three_shows_metals)
{
    room r;
    room_create(&r);
    for (int black = 0; black < 2; black++) {
        uint32_t colored = 0;
        for (uint32_t m = 0; m < r.scene->material_count; m++) {
            r.scene->materials[m].metallic = 1.0f;
        }
        alp_scene_set_metals(r.scene, (alp_metals)black);
        json_t *root = encode(&r, false), *materials = get(root, "materials");
        for (size_t i = 0; i < json_array_size(materials); i++) {
            colored += json_integer_value(get(json_array_get(materials, i), "color")) != 0;
        }
        assert_int_equal(colored, black ? 0 : json_array_size(materials));
        json_decref(root);
    }
    room_destroy(&r);
}

TEST(three_has_the_camera)
{
    room r;
    room_create(&r);
    json_t *root = encode(&r, false), *children = get(get(root, "object"), "children");
    json_t *camera = json_array_get(children, json_array_size(children) - 1);
    const alp_camera *wanted = &r.scene->cameras[0];
    assert_string_equal(json_string_value(get(camera, "type")), "PerspectiveCamera");
    ASSERT_NEAR(json_number_value(get(camera, "fov")), (double)wanted->vertical_fov * 180 / ALPI_PI,
                1e-5); // a float of 39
    json_t *matrix = get(camera, "matrix");
    const double looks[16] = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0.278, 0.273, -0.8, 1};
    for (size_t i = 0; i < 16; i++) {
        ASSERT_NEAR(number(matrix, i), looks[i], 1e-6);
    }
    json_decref(root);
    room_destroy(&r);
}

/// Light that is stored as E/π, and values that no map should hold.
TEST(units_and_faults)
{
    room r;
    room_create(&r);
    r.light.irradiance_per_unit = 3.0f;
    r.values[0][0][0][0] = NAN;
    r.values[0][0][0][1] = -1.0f;
    json_t *root = encode(&r, false);
    json_t *data = get(get(named(get(root, "images"), "uuid", "page 0"), "url"), "data");
    assert_int_equal(number(data, 0), 0);
    assert_int_equal(number(data, 1), 0);
    double wants = 3.0 * (double)r.values[0][0][0][2];
    ASSERT_NEAR(half_value((uint32_t)number(data, 2)), wants, wants * 0x1p-11);
    json_decref(root);
    room_destroy(&r);
}

// --- Babylon.js ----------------------------------------------------------------------------------

TEST(babylon_holds_the_scene)
{
    room r;
    room_create(&r);
    json_t *root = encode(&r, true);
    const char *materials[PAGES + 1] = {NULL};
    check_meshes(&r, root, babylon_mesh, materials);
    assert_true(json_is_true(get(root, "useRightHandedSystem")));
    for (size_t k = 0; k < 3; k++) {
        ASSERT_NEAR(number(get(root, "ambientColor"), k), 1.0, 0.0);
    }
    for (uint32_t p = 0; p < PAGES; p++) {
        json_t *material = named(get(root, "materials"), "id", materials[p]);
        json_t *map = get(material, "lightmapTexture");
        assert_string_equal(json_string_value(get(map, "name")), names[p]);
        assert_int_equal(json_integer_value(get(map, "coordinatesIndex")), 1);
        assert_int_equal(json_integer_value(get(map, "vScale")), -1);
        assert_int_equal(json_integer_value(get(map, "vOffset")), 1);
        assert_true(json_is_true(get(material, "useLightmapAsShadowmap")));
    }
    json_t *lamp = named(get(root, "materials"), "id", materials[PAGES]);
    assert_null(json_object_get(lamp, "lightmapTexture"));
    ASSERT_NEAR(number(get(lamp, "ambient"), 0), 0.0, 0.0); // no map: not lit
    ASSERT_NEAR(number(get(lamp, "emissive"), 2), 2.771, 1e-6);
    json_t *white = named(get(root, "materials"), "id", materials[0]);
    ASSERT_NEAR(number(get(white, "albedo"), 0), 0.73826, 1e-7);
    json_decref(root);
    room_destroy(&r);
}

/// What its reader would misread is not written.
TEST(babylon_wants_eight_texels)
{
    room r;
    room_create(&r);
    uint8_t *bytes = NULL;
    size_t size = 0;
    for (int i = 0; i < 2; i++) {
        r.light.width = i == 0 ? 7 : WIDTH;
        r.light.height = i == 0 ? HEIGHT : 7;
        assert_int_equal(alpi_babylon_encode(r.scene, &r.light, names, &bytes, &size),
                         ALP_ERROR_UNSUPPORTED);
        assert_null(bytes);
    }
    room_destroy(&r);
}

TEST(babylon_pages_are_radiance)
{
    room r;
    room_create(&r);
    for (uint32_t p = 0; p < PAGES; p++) {
        uint8_t *bytes = NULL;
        size_t size = 0;
        alp_image *image = NULL;
        ASSERT_OK(r.context, alpi_babylon_encode_page(r.scene, &r.light, p, &bytes, &size));
        ASSERT_OK(r.context, alpi_hdr_decode(r.context, "page", bytes, size, &image));
        for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
            float pixel[4];
            alpi_image_pixel(image, i % WIDTH, i / WIDTH, pixel);
            const float *wanted = r.values[p][i / WIDTH][i % WIDTH];
            double most = fmax(fmax((double)wanted[0], (double)wanted[1]), (double)wanted[2]);
            for (int k = 0; k < 3; k++) { // half a step of eight bits of the largest
                ASSERT_NEAR(pixel[k], (double)wanted[k] / ALPI_PI, most / ALPI_PI / 256);
            }
        }
        alp_image_destroy(image);
        alpi_release(r.context, bytes);
    }
    room_destroy(&r);
}

// --- textures ------------------------------------------------------------------------------------

/// Gives the first material a picture of 2 × 1 pixels, scaled and turned, and the room coordinates.
static void add_texture(room *r)
{
    alp_scene *scene = r->scene;
    const alp_image_info info = {2, 1, 3, ALP_COMPONENT_U8};
    scene->images = ALPI_NEW(r->context, alp_image *, 1);
    scene->image_count = 1;
    ASSERT_OK(r->context, alp_image_create(r->context, info, &scene->images[0]));
    memcpy(alp_image_bytes(scene->images[0]), "\x10\x20\x30\x40\x50\x60", 6);
    scene->uvs[0] = alpi_allocate(r->context, scene->vertex_count, sizeof *scene->uvs[0]);
    for (uint32_t v = 0; v < scene->vertex_count; v++) {
        scene->uvs[0][v][0] = (float)v;
        scene->uvs[0][v][1] = 1.0f;
    }
    scene->materials[0].base_color_texture = (alpi_texture){.image = 0,
                                                            .wrap_u = ALPI_WRAP_CLAMP,
                                                            .offset = {0.25f, 0.5f},
                                                            .scale = {2.0f, 3.0f},
                                                            .rotation = (float)ALPI_PI / 2.0f};
    scene->materials[0].double_sided = true;
}

/// A quarter turn: u' = 3 v + ¼, v' = ½ − 2 u.
static void check_turned(const room *r, json_t *uvs, json_t *indices, bool clockwise)
{
    assert_true(json_array_size(uvs) > 0);
    for (size_t k = 0; k < 3; k++) {
        size_t v = (size_t)number(indices, clockwise ? (3 - k) % 3 : k);
        uint32_t vertex = r->scene->triangles[r->scene->surfaces[0].first_triangle][k];
        ASSERT_NEAR(number(uvs, 2 * v), 3.25, 1e-5); // cos 90° is 4e-8
        ASSERT_NEAR(number(uvs, 2 * v + 1), 0.5 - 2.0 * vertex, 1e-5);
    }
}

TEST(textures_come_along)
{
    room r;
    room_create(&r);
    add_texture(&r);
    json_t *root = encode(&r, false);
    json_t *material = json_array_get(get(root, "materials"), 0);
    assert_int_equal(json_integer_value(get(material, "side")), 2);
    json_t *map = named(get(root, "textures"), "uuid", json_string_value(get(material, "map")));
    assert_int_equal(number(get(map, "wrap"), 0), 1001);
    assert_int_equal(number(get(map, "wrap"), 1), 1000);
    assert_int_equal(json_integer_value(get(map, "channel")), 0);
    const char *image = json_string_value(get(map, "image"));
    const char *url = json_string_value(get(named(get(root, "images"), "uuid", image), "url"));
    assert_memory_equal(url, "data:image/png;base64,iVBORw0KGgo", 33); // the signature of PNG
    json_t *data = get(json_array_get(get(root, "geometries"), 0), "data");
    json_t *indices = get(get(data, "index"), "array");
    check_turned(&r, get(get(get(data, "attributes"), "uv"), "array"), indices, false);
    json_decref(root);

    root = encode(&r, true);
    material = json_array_get(get(root, "materials"), 0);
    assert_true(json_is_false(get(material, "backFaceCulling")));
    assert_int_equal(json_integer_value(get(get(material, "albedoTexture"), "wrapU")), 0);
    json_t *first = json_array_get(get(root, "meshes"), 0);
    check_turned(&r, get(first, "uvs"), get(first, "indices"), true);
    json_decref(root);
    room_destroy(&r);
}

// --- memory --------------------------------------------------------------------------------------

/// Every allocation may fail: told as such, and nothing is left behind (address sanitizer).
TEST(memory_may_end)
{
    for (int babylon = 0; babylon < 2; babylon++) {
        int left = 0;
        alp_context *context = test_context_failing(&left);
        room r;
        room_create(&r);
        alp_scene *scene = test_load(context, "builtin:cornell");
        alp_result result = ALP_ERROR_OUT_OF_MEMORY;
        for (int allowed = 0; result != ALP_OK; allowed++) {
            uint8_t *bytes = NULL;
            size_t size = 0;
            left = allowed;
            result = babylon ? alpi_babylon_encode(scene, &r.light, names, &bytes, &size)
                             : alpi_three_encode(scene, &r.light, &bytes, &size);
            assert_true(result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY);
            assert_true((bytes != NULL) == (result == ALP_OK));
            alpi_release(context, bytes);
        }
        left = 1000;
        alp_scene_destroy(scene);
        alp_context_destroy(context);
        room_destroy(&r);
    }
}
