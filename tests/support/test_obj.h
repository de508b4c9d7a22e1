// SPDX-License-Identifier: MIT
// OBJ assets from text.
#ifndef TEST_OBJ_H
#define TEST_OBJ_H

#include "test_support.h"

#include "scene/scene.h"

/// Reads a text as "test.obj", its libraries from `folder` (NULL: the working folder).
alp_result test_obj_read(alp_context *context, const char *folder, const char *text,
                         alp_scene **scene);
/// The same; fails the test when it is refused.
alp_scene *test_obj_scene(alp_context *context, const char *text);
void test_write_file(const char *path, const void *bytes, size_t size);
void test_write_text(const char *path, const char *text);

#endif
