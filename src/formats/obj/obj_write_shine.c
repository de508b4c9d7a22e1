// SPDX-License-Identifier: MIT
// Gloss and relief of a scene's materials as MTL statements: those of Wavefront (Ks, Ns, Ni) and of
// its extension for physically based materials (Pr, Pm, norm; exocortex.com, 2014). And what has no
// place there.
#include "formats/obj/obj_write.h"

#include <math.h>
#include <stdio.h>

static void print_number(alpi_obj_writer *w, const char *what, float value)
{
    alpi_bytes_print(&w->mtl, "%s ", what);
    alpi_bytes_float(&w->mtl, value);
    alpi_bytes_print(&w->mtl, "\n");
}

/// The exponent of Blinn-Phong, the inverse of what obj_materials.c reads: n = 2 / roughness⁴ − 2.
static float exponent_of(float roughness)
{
    enum { LARGEST = 1000 }; // as Wavefront has it
    const float square = roughness * roughness;
    const float n = square * square > 0.0f ? 2.0f / (square * square) - 2.0f : (float)LARGEST;
    return fminf(n, (float)LARGEST);
}

static void print_relief(alpi_obj_writer *w, alpi_obj_use use, const alpi_material *m)
{
    char what[64];
    if (m->normal_scale == 1.0f) {
        alpi_obj_print_texture(w, use, "norm", &m->normal_texture, ALPI_OBJ_PICTURE_WHOLE);
        return;
    }
    alpi_bytes number = alpi_bytes_create(w->context);
    alpi_bytes_float(&number, m->normal_scale);
    w->mtl.failed |= number.failed;
    if (!number.failed) {
        snprintf(what, sizeof what, "norm -bm %.40s", (const char *)number.bytes);
        alpi_obj_print_texture(w, use, what, &m->normal_texture, ALPI_OBJ_PICTURE_WHOLE);
    }
    alpi_bytes_destroy(&number);
}

void alpi_obj_print_shine(alpi_obj_writer *w, alpi_obj_use use, const alpi_material *m)
{
    const alpi_shine *s = &m->shine;
    const bool has_metal = m->metallic > 0.0f;
    const bool is_rough = s->roughness == 1.0f && s->roughness_texture.image == ALPI_NONE;
    const bool shines = !is_rough || has_metal || s->has_specular;
    if (s->has_specular) {
        alpi_obj_print_color(w, "Ks", s->specular);
        alpi_obj_print_texture(w, use, "map_Ks", &s->specular_texture, ALPI_OBJ_PICTURE_WHOLE);
    }
    if (shines) {
        alpi_bytes_print(&w->mtl, "Ns ");
        alpi_bytes_number(&w->mtl, (double)exponent_of(s->roughness), 6); // roughness rounds it
        alpi_bytes_print(&w->mtl, "\n");
        print_number(w, "Pr", s->roughness);
        alpi_obj_print_texture(w, use, "map_Pr", &s->roughness_texture, ALPI_OBJ_PICTURE_ROUGHNESS);
    }
    if (has_metal) {
        print_number(w, "Pm", m->metallic);
        alpi_obj_print_texture(w, use, "map_Pm", &m->metallic_texture, ALPI_OBJ_PICTURE_METALNESS);
    }
    if (s->index > 0.0f) {
        print_number(w, "Ni", s->index);
    }
    alpi_bytes_print(&w->mtl, "illum %d\n", shines ? 2 : 1);
    print_relief(w, use, m);
}

static void note(const alp_scene *scene, const char *kind, uint32_t count)
{
    if (count > 0) {
        alpi_note(scene->context, "obj-lost", kind,
                  "an OBJ has no place for it: %u of them are left out", count);
    }
}

void alpi_obj_note_scene_losses(const alp_scene *scene)
{
    uint32_t clear = 0, masked = 0;
    for (uint32_t i = 0; i < scene->material_count; i++) {
        clear += scene->materials[i].transmission > 0.0f;
        masked += scene->materials[i].alpha_mode == ALPI_ALPHA_MASK &&
                  scene->materials[i].alpha_cutoff != 0.5f;
    }
    note(scene, "lights", scene->light_count);
    note(scene, "cameras", scene->camera_count);
    note(scene, "animations", scene->animation_count);
    note(scene, "transmission of materials", clear);
    note(scene, "alphaCutoff other than 0.5", masked);
}
