// SPDX-License-Identifier: MIT
// Programs of shaders, and errors of OpenGL.
#include "test_gl.h"

#include "gl/gl_buffer.h"
#include "gl/gl_context.h"
#include "gl/gl_textures.h"
#include "options/options.h"
#include "passes/shader_list.h"
#include "shaders/bindings.h"

#include <stdio.h>
#include <unistd.h>

/// Standard error of a call, as text.
static FILE *caught;
static int kept;

static void catch_errors(void)
{
    caught = tmpfile();
    assert_non_null(caught);
    fflush(stderr);
    kept = dup(STDERR_FILENO);
    assert_true(dup2(fileno(caught), STDERR_FILENO) >= 0);
}

static void give_errors(char *text, size_t size)
{
    fflush(stderr);
    assert_true(dup2(kept, STDERR_FILENO) >= 0);
    close(kept);
    rewind(caught);
    text[fread(text, 1, size - 1, caught)] = '\0';
    fclose(caught);
}

static int count_blocks(const gl_shader *shader)
{
    int count = 0;
    for (const char *at = shader->text; (at = strstr(at, "layout(std430")) != NULL; at++) {
        count++;
    }
    return count;
}

// gl_context_open refuses cards that have fewer.
TEST(storage_blocks_are_counted)
{
    const gl_shader *const fragments[] = {
        &shader_none_frag,   &shader_albedo_frag,     &shader_lightmap_frag,
        &shader_direct_frag, &shader_ambient_frag,    &shader_shadow_frag,
        &shader_ao_frag,     &shader_sh_frag,         &shader_points_frag,
        &shader_field_frag,  &shader_map_frag,        &shader_ssao_places_frag,
        &shader_layer_frag,  &shader_background_frag, &shader_film_frag,
        &shader_air_frag};
    int most = 0;
    for (size_t i = 0; i < sizeof fragments / sizeof *fragments; i++) {
        const int count = count_blocks(fragments[i]);
        most = count > most ? count : most;
    }
    assert_int_equal(count_blocks(&shader_surfaces_vert), BLOCKS_VERTEX);
    assert_int_equal(most, BLOCKS_FRAGMENT);
}

TEST(programs_of_the_viewer_compile)
{
    if (!test_gl_open()) {
        skip();
    }
    const gl_shader *const fragments[] = {&shader_none_frag, &shader_albedo_frag,
                                          &shader_lightmap_frag};
    for (size_t i = 0; i < sizeof fragments / sizeof *fragments; i++) {
        const GLuint program = gl_program_create(&shader_surfaces_vert, fragments[i]);
        assert_true(program != 0);
        glDeleteProgram(program);
    }
    test_gl_check();
}

TEST(faults_of_shaders_name_file_and_line)
{
    if (!test_gl_open()) {
        skip();
    }
    static const char *const files[] = {"main.frag", "part.glsl"};
    const gl_shader broken = {"#version 450 core\n"
                              "#line 1 1\n"
                              "float part() { return 1.0; }\n"
                              "float wrong() { return unknown; }\n"
                              "#line 3 0\n"
                              "void main() {}\n",
                              files, 2};
    char text[2048];
    catch_errors();
    const GLuint program = gl_program_create(&shader_screen_vert, &broken);
    give_errors(text, sizeof text);
    assert_int_equal(program, 0);
    assert_non_null(strstr(text, "alpenglow: part.glsl:2"));
    assert_non_null(strstr(text, "unknown"));
    test_gl_check();
}

TEST(errors_of_opengl_are_failures)
{
    if (!test_gl_open()) {
        skip();
    }
    char text[2048];
    catch_errors();
    glEnable(GL_TEXTURE_2D_ARRAY); // is nothing that can be enabled
    test_gl_expect_failure();
    give_errors(text, sizeof text);
    assert_non_null(strstr(text, "alpenglow: OpenGL: "));
    assert_true(test_gl_open()); // forgets it
    test_gl_check();
}

TEST(buffers_are_refused_that_the_card_does_not_take)
{
    if (!test_gl_open()) {
        skip();
    }
    GLint64 most = 0;
    GLuint buffer = 1;
    char text[2048];
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
    catch_errors();
    const int code = gl_buffer_load("the test", NULL, (size_t)most + 1, &buffer);
    give_errors(text, sizeof text);
    assert_int_equal(code, EXIT_FAILED);
    assert_int_equal(buffer, 0);
    assert_non_null(strstr(text, "alpenglow: the test needs a buffer of "));
    test_gl_check();
}

TEST(empty_buffers_have_an_element)
{
    if (!test_gl_open()) {
        skip();
    }
    GLuint buffer = 0;
    GLint64 size = 0;
    assert_int_equal(gl_buffer_load("the test", NULL, 0, &buffer), EXIT_DONE);
    glGetNamedBufferParameteri64v(buffer, GL_BUFFER_SIZE, &size);
    assert_true(size > 0);
    glDeleteBuffers(1, &buffer);
    test_gl_check();
}

TEST_WITH_CONTEXT(images_are_refused_that_the_card_does_not_take, 1)
{
    if (!test_gl_open()) {
        skip();
    }
    GLint most = 0;
    GLuint texture = 0;
    alp_image *image = NULL;
    char text[2048];
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    const alp_image_info info = {
        .width = (uint32_t)most + 1, .height = 1, .channels = 1, .component = ALP_COMPONENT_U8};
    ASSERT_OK(context, alp_image_create(context, info, &image));
    catch_errors();
    const int code = gl_texture_create(image, false, &texture);
    const int sky = gl_texture_check("the image of the sky", 2, (uint32_t)most + 1);
    give_errors(text, sizeof text);
    assert_int_equal(code, EXIT_FAILED);
    assert_int_equal(sky, EXIT_FAILED);
    assert_int_equal(texture, 0);
    assert_non_null(strstr(text, "alpenglow: an image of the scene has "));
    assert_non_null(strstr(text, "alpenglow: the image of the sky has 2 x "));
    assert_int_equal(gl_texture_check("", (uint32_t)most, (uint32_t)most), EXIT_DONE);
    alp_image_destroy(image);
    test_gl_check();
}
