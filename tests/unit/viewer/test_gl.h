// SPDX-License-Identifier: MIT
// OpenGL of the viewer in tests, and pictures of it beside those of render.
#ifndef TEST_GL_H
#define TEST_GL_H

#include "test_support.h"

#include "drawing.h"

/// Opens OpenGL without a window, once in a program.
/// @return false: there is none, which was printed; call skip()
bool test_gl_open(void);
/// Fails the test if OpenGL has reported an error.
void test_gl_check(void);
/// Fails it if OpenGL has reported none.
void test_gl_expect_failure(void);

/// A picture of the viewer and that of render by one sample a pixel.
typedef struct test_pair {
    alp_image *drawn, *rendered;             // 8-bit RGB
    alp_image *drawn_light, *rendered_light; // float RGBA
    uint32_t width, height;
    /// [height][width] Both see the same triangles in the 3 × 3 pixels around. With FIELD also: the
    /// same lights reach these pixels by rays, so that no edge of a shadow is near.
    bool *alike;
    double alike_share;
    bool *on_object; // [height][width] the viewer sees the object of the options
} test_pair;

/// Draws and renders.
/// @param options method ALBEDO, LIGHTMAP, whose lightmap is baked already, or FIELD; the viewer's
///        mode is that of the method. That of fields which are no ambient model is direct.
test_pair test_gl_pair(const alp_scene *scene, const alp_render_options *options);
/// The mode of a name of --with.
const view_mode *test_gl_mode(const char *name);
/// The same in a mode of --with.
/// @param light of the mode; it is destroyed
test_pair test_gl_pair_in(const char *mode, mode_light light, const alp_scene *scene,
                          const alp_render_options *options);
void test_pair_destroy(test_pair *pair);

/// Share of the pixels that are alike whose bytes differ by 1 at most.
double test_pair_equal_share(const test_pair *pair);

#endif
