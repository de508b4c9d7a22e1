// SPDX-License-Identifier: MIT
#include "gl/gl_object.h"

#include "options/options.h"
#include "printing/messages.h"

int gl_object_place(alp_context *context, const alp_render_object *what, uint32_t first_triangle,
                    gl_object *object)
{
    gl_object_destroy(object);
    if (alp_render_object_mesh(context, what, &object->scene) != ALP_OK) {
        return failure(alp_context_message(context));
    }
    object->what = *what;
    const int code = gl_scene_create(object->scene, false, false, &object->drawn);
    object->drawn.first_triangle = first_triangle;
    return code;
}

void gl_object_destroy(gl_object *object)
{
    gl_scene_destroy(&object->drawn);
    gl_field_destroy_reader(&object->field);
    alp_scene_destroy(object->scene);
    *object = (gl_object){0};
}

const gl_scene *gl_object_drawn(const gl_object *object)
{
    return object->what.kind != ALP_OBJECT_NONE ? &object->drawn : NULL;
}

void gl_object_update(gl_object *object, const gl_field *light)
{
    if (object->what.kind == ALP_OBJECT_NONE || light->vertices == 0) {
        return;
    }
    if (object->field.vertices == 0) {
        gl_field_create_reader(object->scene, light, &object->field);
    }
    gl_field_follow(&object->field, light);
    object->field.gloss = false; // as in render
    gl_field_update(&object->field, object->scene);
}
