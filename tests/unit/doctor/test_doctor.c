// SPDX-License-Identifier: MIT
// The doctor's findings about geometry, materials, lights and messages: each from a scene that has
// it, and none from one that is like it and has not.
#include "test_support.h"

#include "base/memory.h"
#include "doctor/doctor.h"
#include "doctor/doctor_words.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const float SQUARE[4][3] = {{0, 0, 0}, {2, 0, 0}, {2, 0, -2}, {0, 0, -2}};
static const float SQUARE_AGAIN[4][3] = {{0, -0.0f, 0}, {2, 0, 0}, {2, 0, -2}, {0, 0, -2}};
static const float ABOVE[4][3] = {{0, 0.001f, 0}, {2, 0, 0}, {2, 0.001f, -2}, {0, 0, -2}};
static const float POINT[4][3] = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
static const float UP[4][3] = {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}};
static const float DOWN[4][3] = {{0, -1, 0}, {0, -1, 0}, {0, -1, 0}, {0, -1, 0}};
static const float UVS[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
static const uint32_t TRIANGLES[2][3] = {{0, 1, 2}, {0, 2, 3}};
static const uint32_t SHIFTED[2][3] = {{1, 2, 0}, {3, 0, 2}};
static const uint32_t TURNED[2][3] = {{0, 2, 1}, {0, 3, 2}};

static alp_mesh square(void)
{
    return (alp_mesh){.vertex_count = 4,
                      .positions = SQUARE[0],
                      .normals = UP[0],
                      .uvs = UVS[0],
                      .triangle_count = 2,
                      .indices = TRIANGLES[0],
                      .base_color = {0.5f, 0.5f, 0.5f}};
}

static alp_scene *make(alp_context *context, const alp_mesh *meshes, uint32_t count)
{
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, count, &scene));
    return scene;
}

/// The only finding of a kind; an empty one where there is none.
static alp_finding find(const alp_diagnosis *d, alp_finding_kind kind)
{
    alp_finding found = alp_diagnosis_get_finding(NULL, 0);
    bool any = false;
    for (uint32_t i = 0; i < alp_diagnosis_finding_count(d); i++) {
        const alp_finding f = alp_diagnosis_get_finding(d, i);
        if (f.kind == kind) {
            assert_false(any);
            any = true;
            found = f;
        }
    }
    return found;
}

static alp_diagnosis *diagnose(const alp_scene *scene)
{
    alp_diagnosis *d = NULL;
    ASSERT_OK(scene->context, alp_scene_diagnose(scene, NULL, &d));
    return d;
}

/// Fails unless the scene has one finding of the kind (or none at all), and nothing else.
static void has_only(const alp_scene *scene, alp_finding_kind kind, uint64_t count, double value)
{
    alp_diagnosis *d = diagnose(scene);
    if (alp_diagnosis_finding_count(d) != 1) {
        for (uint32_t i = 0; i < alp_diagnosis_finding_count(d); i++) {
            print_error("%s: %s\n", alp_diagnosis_get_finding(d, i).code,
                        alp_diagnosis_get_finding(d, i).what);
        }
    }
    assert_int_equal(alp_diagnosis_finding_count(d), 1);
    const alp_finding f = alp_diagnosis_get_finding(d, 0);
    assert_int_equal(f.kind, kind);
    assert_int_equal(f.count, count);
    if (isfinite(value)) {
        ASSERT_NEAR(f.value, value, 1e-6 * fabs(value)); // single precision
    }
    assert_true(f.what[0] != '\0' && f.seen[0] != '\0' && f.code[0] != '\0');
    alp_diagnosis_destroy(d);
}

static void has_none(const alp_scene *scene)
{
    alp_diagnosis *d = diagnose(scene);
    if (alp_diagnosis_finding_count(d) > 0) {
        print_error("%s\n", alp_diagnosis_get_finding(d, 0).what);
    }
    assert_int_equal(alp_diagnosis_finding_count(d), 0);
    alp_diagnosis_destroy(d);
}

static const double ANY = (double)NAN;

// --- geometry ------------------------------------------------------------------------------------

TEST_WITH_CONTEXT(a_good_scene_is_well, 1)
{
    const alp_mesh mesh = square();
    alp_scene *scene = make(context, &mesh, 1);
    has_none(scene);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(nothing_to_bake_is_an_error, 1)
{
    alp_mesh mesh = square();
    mesh.positions = POINT[0];
    alp_scene *scene = make(context, &mesh, 1);
    alp_diagnosis *d = diagnose(scene);
    const alp_finding f = alp_diagnosis_get_finding(d, 0);
    assert_int_equal(f.kind, ALP_FINDING_NO_TRIANGLES);
    assert_int_equal(f.severity, ALP_SEVERITY_ERROR);
    assert_int_equal(f.count, 2);
    alp_diagnosis_destroy(d);
    alp_scene_destroy(scene);
}

/// Triangles without area have one finding, which counts them all.
TEST_WITH_CONTEXT(triangles_without_area, 1)
{
    static const uint32_t half[2][3] = {{0, 1, 2}, {0, 1, 1}};
    static const char *const words[] = {"1 of 2 triangles has no area",
                                        "1 of 2 triangles has no area (3 in 2 surfaces)"};
    alp_mesh meshes[3] = {square(), square(), square()};
    meshes[1].indices = half[0];
    meshes[2].positions = POINT[0];
    for (uint32_t count = 1; count <= 3; count++) {
        alp_scene *scene = make(context, meshes, count);
        alp_diagnosis *d = diagnose(scene);
        const alp_finding f = find(d, ALP_FINDING_ZERO_AREA);
        assert_int_equal(f.count, count == 1 ? 0 : count == 2 ? 1 : 3);
        if (count > 1) {
            assert_int_equal(f.severity, ALP_SEVERITY_NOTE);
            assert_int_equal(f.index, 1);
            assert_string_equal(f.what, words[count - 2]);
        }
        alp_diagnosis_destroy(d);
        alp_scene_destroy(scene);
    }
}

TEST_WITH_CONTEXT(unlit_materials, 1)
{
    const alp_mesh mesh = square();
    alp_scene *scene = make(context, &mesh, 1);
    assert_true(scene->material_count > 0 && scene->surfaces[0].material != ALPI_NONE);
    scene->materials[scene->surfaces[0].material].unlit = true;
    has_only(scene, ALP_FINDING_UNLIT, 0, ANY);
    // a bake has warned of it
    const alp_report_finding told = {"unlit", "out.glb", "1 material is unlit"};
    alp_diagnosis_options options = alp_diagnosis_options_default();
    options.messages = &told;
    options.message_count = 1;
    alp_diagnosis *d = NULL;
    ASSERT_OK(context, alp_scene_diagnose(scene, &options, &d));
    assert_int_equal(alp_diagnosis_finding_count(d), 1);
    alp_diagnosis_destroy(d);
    alp_scene_destroy(scene);
}

/// Two squares, the second of other corners or in another order; coordinates are left out, as two
/// that lie in one place are another finding.
static alp_scene *make_twins(alp_context *context, const float (*positions)[3],
                             const uint32_t (*triangles)[3])
{
    alp_mesh meshes[2] = {square(), square()};
    meshes[1].positions = positions[0];
    meshes[1].indices = triangles[0];
    meshes[1].normals = triangles == TURNED ? DOWN[0] : UP[0];
    meshes[0].uvs = meshes[1].uvs = NULL;
    return make(context, meshes, 2);
}

/// Parts of one mesh have one name: findings tell them apart by their materials.
TEST_WITH_CONTEXT(parts_of_one_name, 1)
{
    alp_mesh meshes[2] = {square(), square()};
    meshes[0].name = meshes[1].name = "house";
    meshes[0].uvs = meshes[1].uvs = NULL;
    alp_scene *scene = make(context, meshes, 2);
    const char *wall = scene->materials[scene->surfaces[0].material].name;
    const char *roof = scene->materials[scene->surfaces[1].material].name;
    char first[64], second[64];
    snprintf(first, sizeof first, "house (%s)", wall);
    snprintf(second, sizeof second, "house (%s)", roof);
    alp_diagnosis *d = diagnose(scene);
    const alp_finding f = find(d, ALP_FINDING_DUPLICATES);
    assert_string_equal(f.name, second);
    assert_non_null(strstr(f.what, first));
    alp_diagnosis_destroy(d);
    alp_scene_destroy(scene);
}

TEST(triangles_in_one_place)
{
    static const struct {
        const float (*positions)[3];
        const uint32_t (*triangles)[3];
        uint64_t duplicates, back_to_back;
    } cases[] = {{SQUARE, TRIANGLES, 2, 0},
                 {SQUARE, SHIFTED, 2, 0},         // corners in another order
                 {SQUARE_AGAIN, TRIANGLES, 2, 0}, // −0 is 0
                 {SQUARE, TURNED, 0, 2},
                 {ABOVE, TRIANGLES, 0, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_context *context = test_context(1);
        alp_scene *scene = make_twins(context, cases[i].positions, cases[i].triangles);
        alp_diagnosis *d = diagnose(scene);
        assert_int_equal(find(d, ALP_FINDING_DUPLICATES).count, cases[i].duplicates);
        assert_int_equal(find(d, ALP_FINDING_BACK_TO_BACK).count, cases[i].back_to_back);
        if (cases[i].duplicates > 0) {
            const alp_finding f = find(d, ALP_FINDING_DUPLICATES);
            assert_int_equal(f.index, 1); // the one that came later
            assert_string_equal(f.name, "mesh 1");
            assert_non_null(strstr(f.what, "mesh 0"));
            ASSERT_NEAR(f.value, 1.0, 0.0);
            assert_true(f.spot.known);
            assert_int_equal(f.spot.surface, 1);
        }
        alp_diagnosis_destroy(d);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

TEST_WITH_CONTEXT(normals_against_their_triangles, 1)
{
    alp_mesh mesh = square();
    mesh.normals = DOWN[0];
    alp_scene *scene = make(context, &mesh, 1);
    has_only(scene, ALP_FINDING_REVERSED_NORMALS, 2, 1.0);
    vec3_store(scene->normals[0], (vec3){0.0f, 1.0f, 0.0f}); // a corner of both: smooth
    has_none(scene);
    alp_scene_destroy(scene);
    mesh.normals = NULL;
    scene = make(context, &mesh, 1);
    has_only(scene, ALP_FINDING_NO_NORMALS, 1, ANY);
    scene->surfaces[0].normals_generated = false;
    scene->surfaces[0].mirrored = true;
    has_only(scene, ALP_FINDING_MIRRORED, 1, ANY);
    alp_scene_destroy(scene);
}

TEST(sizes_that_are_odd)
{
    static const struct {
        float side;
        bool odd;
        const char *words;
    } cases[] = {{0.01f, true, "0.01 m"}, {0.03f, false, ""},       {2.0f, false, ""},
                 {250.0f, false, ""},     {556.0f, true, "5.56 m"}, {20000.0f, true, "20 m"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_context *context = test_context(1);
        float positions[4][3];
        for (int k = 0; k < 12; k++) {
            positions[k / 3][k % 3] = SQUARE[k / 3][k % 3] * 0.5f * cases[i].side;
        }
        alp_mesh mesh = square();
        mesh.positions = positions[0];
        alp_scene *scene = make(context, &mesh, 1);
        if (cases[i].odd) {
            has_only(scene, ALP_FINDING_SIZE, 0, (double)cases[i].side);
            alp_diagnosis *d = diagnose(scene);
            const char *what = alp_diagnosis_get_finding(d, 0).what;
            assert_non_null(strstr(what, cases[i].words));
            alp_unit_guess guesses[ALP_UNIT_LIMIT]; // all that the line `unit` of info names
            for (uint32_t k = 0; k < alp_scene_guess_unit(scene, guesses); k++) {
                assert_non_null(strstr(what, guesses[k].name));
            }
            alp_diagnosis_destroy(d);
        } else {
            has_none(scene);
        }
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

/// A square over another: the lower one sees the upper one, from below where that looks up too.
TEST(backs_that_others_see)
{
    static const float ROOF[4][3] = {{0, 1, 0}, {2, 1, 0}, {2, 1, -2}, {0, 1, -2}};
    static const float FAR_ROOF[4][3] = {{0, 19, 0}, {2, 19, 0}, {2, 19, -2}, {0, 19, -2}};
    for (int i = 0; i < 4; i++) {
        alp_context *context = test_context(1);
        alp_mesh meshes[2] = {square(), square()};
        meshes[0].uvs = meshes[1].uvs = NULL;
        meshes[1].positions = i == 3 ? FAR_ROOF[0] : ROOF[0];
        meshes[1].double_sided = i == 1;
        if (i == 2) {
            meshes[1].indices = TURNED[0];
            meshes[1].normals = DOWN[0];
        }
        alp_scene *scene = make(context, meshes, 2);
        alp_diagnosis *d = diagnose(scene);
        const alp_finding f = find(d, ALP_FINDING_BACKS_SEEN);
        if (i == 0) {
            ASSERT_NEAR(f.value, 1.0, 0.0); // nothing else is seen
            assert_int_equal(f.index, 1);
        } else { // from so far, one ray in 90 · 2 meets it: too few to say
            assert_int_equal(f.kind, ALP_FINDING_MESSAGE);
        }
        alp_diagnosis_destroy(d);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

// --- materials -----------------------------------------------------------------------------------

TEST_WITH_CONTEXT(colours_that_take_no_light, 1)
{
    alp_mesh mesh = square();
    mesh.base_color[1] = 1.0f;
    alp_scene *scene = make(context, &mesh, 1);
    has_only(scene, ALP_FINDING_WHITE, 0, 1.0);
    alp_image *lost = NULL; // white in the place of a texture that cannot be read is no paint
    scene->images = &lost;
    scene->image_count = 1;
    scene->materials[0].base_color_texture.image = 0;
    has_none(scene);
    scene->materials[0].base_color_texture = alpi_texture_none();
    scene->images = NULL;
    scene->image_count = 0;
    scene->materials[0].base_color_texture.lost = true;
    has_none(scene);
    scene->materials[0].base_color_texture.lost = false;
    scene->materials[0].metallic = 1.0f;
    alp_scene_set_metals(scene, ALP_METALS_BLACK);
    has_none(scene);
    alp_scene_set_metals(scene, ALP_METALS_DIFFUSE);
    scene->materials[0].metallic = 0.0f;
    scene->materials[0].base_color[1] = 0.94f;
    has_none(scene);
    alp_scene_destroy(scene);
}

/// Gives the scene an image of one grey pixel.
static void give_image(alp_scene *scene, uint8_t grey)
{
    alp_image *image = NULL;
    ASSERT_OK(
        scene->context,
        alp_image_create(scene->context, (alp_image_info){1, 1, 1, ALP_COMPONENT_U8}, &image));
    *alp_image_bytes(image) = grey;
    scene->images = ALPI_NEW(scene->context, alp_image *, 1);
    scene->images[0] = image;
    scene->image_count = 1;
}

TEST_WITH_CONTEXT(emission_that_does_not_glow, 1)
{
    const alp_mesh mesh = square();
    alp_scene *scene = make(context, &mesh, 1);
    give_image(scene, 0);
    alpi_material *m = &scene->materials[0];
    m->emission_texture.image = 0;
    has_only(scene, ALP_FINDING_EMISSION_OFF, 0, ANY);
    m->emission[2] = 1.0f;
    has_only(scene, ALP_FINDING_EMISSION_BLACK, 0, ANY);
    *alp_image_bytes(scene->images[0]) = 1;
    has_none(scene);
    m->emission_texture.image = ALPI_NONE;
    has_none(scene);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(materials_that_are_cut_away, 1)
{
    const alp_mesh mesh = square();
    alp_scene *scene = make(context, &mesh, 1);
    alpi_material *m = &scene->materials[0];
    m->base_color[3] = 0.0f; // opaque: alpha has no meaning
    has_none(scene);
    m->alpha_mode = ALPI_ALPHA_BLEND;
    has_only(scene, ALP_FINDING_INVISIBLE, 0, 0.0);
    m->base_color[3] = 0.25f;
    has_none(scene);
    m->alpha_mode = ALPI_ALPHA_MASK;
    m->alpha_cutoff = 0.5f;
    has_only(scene, ALP_FINDING_INVISIBLE, 0, 0.25);
    m->alpha_cutoff = 0.25f;
    has_none(scene);
    alp_scene_destroy(scene);
}

// --- lights --------------------------------------------------------------------------------------

static alpi_light lamp(vec3 position, float intensity, float range)
{
    return (alpi_light){.kind = ALP_LIGHT_POINT,
                        .color = {1.0f, 0.5f, 0.0f},
                        .intensity = intensity,
                        .position = position,
                        .direction = {0.0f, -1.0f, 0.0f},
                        .range = range};
}

TEST(lights_that_do_nothing_or_too_much)
{
    const vec3 above = {1.0f, 3.0f, -1.0f}, on = {1.5f, 0.0f, -1.0f}, beside = {5.0f, 0.0f, -1.0f};
    const alpi_light sun = {.kind = ALP_LIGHT_DIRECTIONAL,
                            .color = {1.0f, 1.0f, 1.0f},
                            .intensity = 1e5f,
                            .direction = {0.0f, -1.0f, 0.0f}};
    alpi_light strong_sun = sun, black = lamp(above, 40.0f, INFINITY);
    strong_sun.intensity = 2e5f;
    black.color = (vec3){0.0f, 0.0f, 0.0f};
    const struct {
        alpi_light light;
        int kind; // −1 = none
        double value;
    } cases[] = {{lamp(above, 40.0f, INFINITY), -1, 0.0},
                 {lamp(above, 0.0f, INFINITY), ALP_FINDING_LIGHT_OFF, 0.0},
                 {black, ALP_FINDING_LIGHT_OFF, 0.0},
                 {lamp(above, 1e6f, INFINITY), -1, 0.0},
                 {lamp(above, 2e6f, INFINITY), ALP_FINDING_LIGHT_STRONG, 2e6},
                 {sun, -1, 0.0},
                 {strong_sun, ALP_FINDING_LIGHT_STRONG, 2e5},
                 {lamp(above, 40.0f, 2.9f), ALP_FINDING_LIGHT_RANGE, 3.0},
                 {lamp(above, 40.0f, 3.1f), -1, 0.0},
                 {lamp(on, 40.0f, INFINITY), ALP_FINDING_LIGHT_ON_SURFACE, 0.0},
                 {lamp(beside, 40.0f, INFINITY), -1, 0.0}}; // in its plane, and off it
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_context *context = test_context(1);
        const alp_mesh mesh = square();
        alp_scene *scene = make(context, &mesh, 1);
        scene->lights = ALPI_NEW(context, alpi_light, 1);
        scene->lights[0] = cases[i].light;
        scene->light_count = 1;
        if (cases[i].kind < 0) {
            has_none(scene);
        } else {
            has_only(scene, (alp_finding_kind)cases[i].kind, 0, cases[i].value);
        }
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

/// In the plane of a triangle and in its box, and not in it.
TEST_WITH_CONTEXT(a_lamp_beside_a_triangle, 1)
{
    alp_mesh mesh = square();
    mesh.triangle_count = 1; // of which x ≥ −z
    alp_scene *scene = make(context, &mesh, 1);
    scene->lights = ALPI_NEW(context, alpi_light, 1);
    scene->light_count = 1;
    scene->lights[0] = lamp((vec3){0.5f, 0.0f, -1.5f}, 40.0f, INFINITY);
    has_none(scene);
    scene->lights[0].position = (vec3){1.5f, 0.0f, -0.5f};
    has_only(scene, ALP_FINDING_LIGHT_ON_SURFACE, 0, 0.0);
    alp_scene_destroy(scene);
}

// --- messages and order --------------------------------------------------------------------------

TEST_WITH_CONTEXT(messages_become_findings, 1)
{
    alp_mesh mesh = square();
    mesh.base_color[0] = 1.0f;
    alp_scene *scene = make(context, &mesh, 1);
    const alp_report_finding messages[] = {
        {"made-up", "thing", "one; two; three"},
        {"zero-area", "mesh 7", "2 of 4 triangles left out: they have no area"},
        {"light", "bulb", "odd"},
        {NULL, NULL, NULL},
        {"no-triangles", scene->name, "nothing"}};
    alp_diagnosis_options o = alp_diagnosis_options_default();
    o.messages = messages;
    o.message_count = 5;
    alp_diagnosis *d = NULL;
    ASSERT_OK(context, alp_scene_diagnose(scene, &o, &d));
    static const struct {
        alp_finding_kind kind;
        alp_severity severity;
        alp_finding_place place;
        const char *code, *name, *what;
    } expected[] = {
        {ALP_FINDING_NO_TRIANGLES, ALP_SEVERITY_ERROR, ALP_PLACE_SCENE, "no-triangles", NULL,
         "nothing"},
        {ALP_FINDING_LIGHT_VALUES, ALP_SEVERITY_WARNING, ALP_PLACE_MESSAGE, "light", "bulb", "odd"},
        {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, ALP_PLACE_MESSAGE, "", "", ""},
        {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, ALP_PLACE_MESSAGE, "made-up", "thing",
         "one; two"},
        {ALP_FINDING_ZERO_AREA, ALP_SEVERITY_NOTE, ALP_PLACE_MESSAGE, "zero-area", "mesh 7",
         "2 of 4 triangles left out: they have no area"},
        {ALP_FINDING_WHITE, ALP_SEVERITY_NOTE, ALP_PLACE_MATERIAL, "white", NULL, NULL}};
    assert_int_equal(alp_diagnosis_finding_count(d), 6);
    for (uint32_t i = 0; i < 6; i++) {
        const alp_finding f = alp_diagnosis_get_finding(d, i);
        assert_int_equal(f.kind, expected[i].kind);
        assert_int_equal(f.severity, expected[i].severity);
        assert_int_equal(f.place, expected[i].place);
        assert_string_equal(f.code, expected[i].code);
        assert_string_equal(f.name, expected[i].name != NULL ? expected[i].name : f.name);
        assert_string_equal(f.what, expected[i].what != NULL ? expected[i].what : f.what);
    }
    assert_string_equal(alp_diagnosis_get_finding(d, 3).todo, "three");
    assert_string_equal(alp_diagnosis_get_finding(d, 6).what, "");
    alp_diagnosis_destroy(d);
    alp_scene_destroy(scene);
}

/// Finds each kind of the header in the words, and its words in the manual.
TEST(the_manual_says_the_same)
{
    size_t size = 0;
    unsigned char *bytes = test_read_file(ALP_SOURCE_FOLDER "/docs/manual/doctor.md", &size);
    char *text = test_malloc(size + 1);
    memcpy(text, bytes, size);
    text[size] = '\0';
    uint32_t known = 0;
    for (int kind = 1; kind <= ALP_FINDING_LIGHT_RANGE; kind++) {
        const alpi_finding_words *w = alpi_finding_words_of((alp_finding_kind)kind);
        if (w->kind == ALP_FINDING_MESSAGE) {
            continue; // a number that is not used
        }
        known++;
        char row[800];
        snprintf(row, sizeof row, "| `%s` | %s |", w->code, alp_severity_name(w->severity));
        const char *at = strstr(text, row);
        assert_non_null(at);
        snprintf(row, sizeof row, " | %s | %s |\n", w->seen, w->todo[0] != '\0' ? w->todo : "–");
        const char *end = strchr(at, '\n') + 1;
        if (strlen(row) > (size_t)(end - at) || strncmp(end - strlen(row), row, strlen(row)) != 0) {
            fail_msg("docs/manual/doctor.md says otherwise of %s:%s", w->code, row);
        }
        assert_ptr_equal(alpi_finding_words_by_code(w->code), w);
    }
    assert_int_equal(known, 45); // of the header
    test_free(text);
    free(bytes);
}

TEST_WITH_CONTEXT(what_is_asked_wrongly_is_refused, 1)
{
    const alp_mesh mesh = square();
    alp_scene *scene = make(context, &mesh, 1);
    alp_diagnosis *d = NULL;
    assert_int_equal(alp_scene_diagnose(NULL, NULL, &d), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_scene_diagnose(scene, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    alp_diagnosis_options o = alp_diagnosis_options_default();
    o.message_count = 1;
    assert_int_equal(alp_scene_diagnose(scene, &o, &d), ALP_ERROR_INVALID_ARGUMENT);
    o = (alp_diagnosis_options){0};
    assert_int_equal(alp_scene_diagnose(scene, &o, &d), ALP_ERROR_INVALID_ARGUMENT);
    assert_null(d);
    alp_diagnosis_destroy(NULL);
    assert_int_equal(alp_diagnosis_finding_count(NULL), 0);
    assert_int_equal(alp_diagnosis_uv_set_count(NULL), 0);
    assert_string_equal(alp_severity_name((alp_severity)9), "");
    alp_scene_destroy(scene);
}

TEST(every_allocation_may_fail)
{
    int left = 0;
    alp_context *context = test_context_failing(&left);
    alp_mesh meshes[2] = {square(), square()};
    meshes[1].base_color[0] = 1.0f;
    alp_scene *scene = make(context, meshes, 2);
    const alp_report_finding messages[] = {{"made-up", "thing", "one; two"}};
    alp_diagnosis_options o = alp_diagnosis_options_default();
    o.messages = messages;
    o.message_count = 1;
    int failures = 0;
    alp_diagnosis *d = NULL;
    for (left = 0; alp_scene_diagnose(scene, &o, &d) != ALP_OK; left = failures) {
        assert_null(d);
        failures += TEST_STEP;
        assert_true(failures < 1000);
    }
    assert_true(failures > 20);
    alp_diagnosis_destroy(d);
    left = 1000;
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}
