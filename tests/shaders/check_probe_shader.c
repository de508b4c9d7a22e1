// SPDX-License-Identifier: MIT
// check_probe_shader SHADER: writes probes, lets the shader read their files, and compares it with
// the look-up of the library. 77 = skipped.
#include "shader_context.h"
#include "test_volume.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/warp.h"
#include "fields/probes/probes.h"
#include "formats/formats.h"
#include "formats/images/images.h"
#include "formats/probes/probe_format.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { POINTS = 4093, SIDE = ALPI_PROBE_MOMENT_SIDE, SKIPPED = 77 };

typedef struct shader_case {
    alpi_probe_basis basis;
    uint32_t size[3];
    bool moments;
    float times; // strength of the light
} shader_case;

static alp_context *context;
static float positions[POINTS][3], normals[POINTS][3], expected[POINTS][3], found[POINTS][4];

static void check(bool good, const char *what)
{
    if (!good) {
        fprintf(stderr, "%s: %s\n", what, alp_context_message(context));
        exit(1);
    }
}

/// Light that is above 0 for most normals, and distances that hide many probes in part.
static void write_probes(const shader_case *c, const char *path)
{
    alpi_probe_volume v =
        test_volume(context, (test_volume_options){.size = {c->size[0], c->size[1], c->size[2]},
                                                   .basis = c->basis,
                                                   .moments = c->moments,
                                                   .times = c->times});
    const uint32_t floats = 3 * v.coefficient_count;
    for (uint32_t i = 0; i < v.count * floats; i++) {
        const bool mean = i % floats < 3 || c->basis == ALPI_PROBE_AMBIENT_CUBE;
        v.coefficients[i] += mean ? 12.0f * c->times : 0.0f;
    }
    for (uint32_t i = 0; i < v.count * SIDE * SIDE && c->moments; i++) {
        const float share = alpi_unit_float(alpi_hash32(i));
        v.moments[i][0] = 0.3f * share * v.reach;
        v.moments[i][1] = v.moments[i][0] * v.moments[i][0] * 1.3f;
    }
    for (uint32_t i = 0; i < v.count; i++) { // cells of one state are rare, and of all states too
        const uint32_t random = alpi_hash32(i / 2) % 8;
        v.states[i] = (uint8_t)(random < 4 ? random : 0);
        for (int k = 0; k < 3; k++) {
            v.moves[i][k] = v.states[i] == ALPI_PROBE_MOVED ? 0.0625f * (float)(k + 1) : 0.0f;
        }
    }
    for (int k = 0; k < 3; k++) {
        v.origin[k] = 0.5 - 0.75 * k;
    }
    check(alpi_probes_save(&v, path, true) == ALP_OK, path);
    alpi_probe_volume_destroy(&v);
}

/// Points in the lattice and round it; the first are at probes.
static void draw_points(const alpi_probe_volume *v)
{
    for (uint32_t i = 0; i < POINTS; i++) {
        const vec2 u = {alpi_unit_float(alpi_hash32(8 * i)),
                        alpi_unit_float(alpi_hash32(8 * i + 1))};
        vec3_store(normals[i], alpi_warp_uniform_cone(u, -1.0f));
        for (uint32_t k = 0; k < 3; k++) {
            const float cells =
                1.5f * alpi_unit_float(alpi_hash32(8 * i + 2 + k)) * (float)v->size[k] - 0.5f;
            positions[i][k] =
                (float)v->origin[k] + v->spacing[k] * (i < 16 ? floorf(cells) : cells);
        }
    }
}

static void look_up(const char *path)
{
    alpi_probe_volume v;
    alp_field *field = NULL;
    check(alpi_probes_load(context, path, &v) == ALP_OK, path);
    check(alpi_probe_field_create(&v, ALP_LOOKUP_OURS, NULL, NULL, &field) == ALP_OK, path);
    draw_points(&v);
    alp_field_irradiance(field, POINTS, (const float(*)[3])positions, (const float(*)[3])normals,
                         expected);
    alp_field_destroy(field);
    alpi_probe_volume_destroy(&v);
}

// --- the shader ----------------------------------------------------------------------------------

static void load_points(GLuint program, const char *name, int unit, const float (*rows)[3])
{
    shader_texture(GL_TEXTURE_2D, unit);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB32F, POINTS, 1, 0, GL_RGB, GL_FLOAT, rows);
    glUniform1i(glGetUniformLocation(program, name), unit);
}

/// Loads the texture that the JSON names.
static void load_texture(GLuint program, const char *name, int unit, const char *path)
{
    alpi_half_texture t;
    size_t size;
    unsigned char *bytes = test_read_file(path, &size);
    check(alpi_ktx2_read(context, path, bytes, size, &t) == ALP_OK, path);
    shader_texture(GL_TEXTURE_3D, unit);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage3D(GL_TEXTURE_3D, 0, t.channels == 4 ? GL_RGBA16F : GL_RG16F, (GLsizei)t.width,
                 (GLsizei)t.height, (GLsizei)t.depth, 0, t.channels == 4 ? GL_RGBA : GL_RG,
                 GL_HALF_FLOAT, t.texels);
    glUniform1i(glGetUniformLocation(program, name), unit);
    alpi_release(context, t.texels);
    free(bytes);
}

static void set_three(GLuint program, const char *name, const json_t *root, const char *member)
{
    const json_t *numbers = json_object_get(root, member);
    const float n[3] = {(float)json_number_value(json_array_get(numbers, 0)),
                        (float)json_number_value(json_array_get(numbers, 1)),
                        (float)json_number_value(json_array_get(numbers, 2))};
    const GLint place = glGetUniformLocation(program, name);
    if (strcmp(member, "size") == 0) {
        glUniform3i(place, (GLint)n[0], (GLint)n[1], (GLint)n[2]);
    } else {
        glUniform3f(place, n[0], n[1], n[2]);
    }
}

/// Binds what the head of the shader states.
static void bind_probes(GLuint program, const char *folder, const char *path)
{
    json_t *root = json_load_file(path, 0, NULL);
    check(root != NULL, path);
    const json_t *textures = json_object_get(root, "textures"),
                 *scale = json_object_get(root, "scale");
    const json_t *light = json_object_get(textures, "coefficients");
    const json_t *moments = json_object_get(textures, "moments");
    load_texture(program, "alpenglowProbeLight", 0,
                 test_path(folder, json_string_value(json_object_get(light, "file"))));
    if (moments != NULL) {
        load_texture(program, "alpenglowProbeMoments", 1,
                     test_path(folder, json_string_value(json_object_get(moments, "file"))));
    } else {
        glUniform1i(glGetUniformLocation(program, "alpenglowProbeMoments"), 1);
    }
    set_three(program, "alpenglowProbeSize", root, "size");
    set_three(program, "alpenglowProbeOrigin", root, "origin");
    set_three(program, "alpenglowProbeSpacing", root, "spacing");
    glUniform1f(glGetUniformLocation(program, "alpenglowProbeScale"),
                scale != NULL ? (float)json_number_value(scale) : 1.0f);
    glUniform1f(glGetUniformLocation(program, "alpenglowProbeReach"),
                (float)json_number_value(json_object_get(moments, "reach")));
    json_decref(root);
}

static void run_shader(shader_language language, const char *text, const shader_case *c,
                       const char *folder, const char *path)
{
    static const char head[] = "uniform highp sampler2D positions, normals;\nout vec4 color;\n";
    static const char tail[] =
        "void main() {\n"
        "  ivec2 at = ivec2(gl_FragCoord.xy);\n"
        "  color.xyz = alpenglowProbeIrradiance("
        "texelFetch(positions, at, 0).xyz, texelFetch(normals, at, 0).xyz);\n"
        "  color.w = 1.0;\n"
        "}\n";
    char basis[64] = "";
    if (c->basis != ALPI_PROBE_SH9) {
        snprintf(basis, sizeof basis, "#define ALPENGLOW_PROBE_COEFFICIENTS %u\n",
                 alpi_probe_basis_count(c->basis));
    }
    const char *const parts[] = {basis, text, head, tail};
    const GLuint program = shader_program(language, parts, 4);
    bind_probes(program, folder, path);
    load_points(program, "positions", 2, (const float(*)[3])positions);
    load_points(program, "normals", 3, (const float(*)[3])normals);
    shader_run(POINTS, found[0]);
    glDeleteProgram(program);
}

/// Largest difference over the mean.
static double compare(void)
{
    double sum = 0.0, most = 0.0;
    for (uint32_t i = 0; i < 3 * POINTS; i++) {
        const double e = (double)expected[i / 3][i % 3];
        sum += e / (3.0 * POINTS);
        most = fmax(most, fabs((double)found[i / 3][i % 3] - e));
    }
    return sum > 0.0 ? most / sum : (double)INFINITY;
}

int main(int argc, char **argv)
{
    static const shader_case cases[] = {{ALPI_PROBE_SH9, {5, 4, 3}, true, 1.0f},
                                        {ALPI_PROBE_SH9, {5, 4, 3}, false, 1.0f},
                                        {ALPI_PROBE_SH4, {3, 4, 5}, true, 1.0f},
                                        {ALPI_PROBE_AMBIENT_CUBE, {4, 3, 5}, true, 1.0f},
                                        {ALPI_PROBE_SH9, {6, 1, 4}, true, 16384.0f},
                                        {ALPI_PROBE_SH9, {1, 1, 1}, true, 0.0009765625f}};
    static const char *const names[SHADER_LANGUAGES] = {"GLSL ES 3.00", "GLSL 3.30"};
    size_t size;
    int failures = 0, contexts = 0;
    if (argc != 2) {
        fprintf(stderr, "usage: check_probe_shader SHADER\n");
        return 2;
    }
    context = test_context(1);
    const char *folder = test_folder();
    char *text = (char *)test_read_file(argv[1], &size);
    text = realloc(text, size + 1);
    text[size] = '\0';
    for (int l = 0; l < SHADER_LANGUAGES; l++) {
        if (!shader_context_open((shader_language)l)) {
            printf("%s: skipped\n", names[l]);
            continue;
        }
        contexts++;
        for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
            char path[1024];
            snprintf(path, sizeof path, "%s", test_path(folder, "shader.probes.json"));
            write_probes(&cases[i], path);
            look_up(path);
            run_shader((shader_language)l, text, &cases[i], folder, path);
            const double apart = compare();
            printf("%s, case %zu: %.1e of the mean\n", names[l], i, apart);
            failures += apart <= 1e-4 ? 0 : 1;
        }
        shader_context_close();
    }
    free(text);
    alp_context_destroy(context);
    return failures > 0 ? 1 : contexts > 0 ? 0 : SKIPPED;
}
