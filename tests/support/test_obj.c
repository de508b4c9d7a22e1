// SPDX-License-Identifier: MIT
#include "test_obj.h"

#include "formats/obj/obj.h"

#include <stdio.h>

alp_result test_obj_read(alp_context *context, const char *folder, const char *text,
                         alp_scene **scene)
{
    char path[512];
    snprintf(path, sizeof path, "%s%stest.obj", folder != NULL ? folder : "",
             folder != NULL ? "/" : "");
    return alpi_obj_scene_from_bytes(context, path, (const uint8_t *)text, strlen(text), scene);
}

alp_scene *test_obj_scene(alp_context *context, const char *text)
{
    alp_scene *scene = NULL;
    ASSERT_OK(context, test_obj_read(context, NULL, text, &scene));
    return scene;
}

void test_write_file(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

void test_write_text(const char *path, const char *text)
{
    test_write_file(path, text, strlen(text));
}
