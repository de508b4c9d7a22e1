// SPDX-License-Identifier: MIT
// Statements of material libraries that glTF has no place for.
#include "formats/obj/obj_materials.h"
#include "formats/obj/obj_scene.h"

#include "base/memory.h"

/// Ka is no loss: glTF has no ambient light. The scene itself has Kd and the like.
static const char *const kinds[] = {"map_Ka", "map_Ns", "disp",    "map_disp", "decal", "refl",
                                    "Ps",     "map_Ps", "Pc",      "Pcr",      "Tf",    "aniso",
                                    "anisor", "map_Tr", "map_RMA", "map_ORM"};
enum { KIND_COUNT = sizeof kinds / sizeof *kinds };

static void count_statements(const alp_scene *scene, const alpi_obj_file *library,
                             uint32_t counts[KIND_COUNT + 1])
{
    alpi_obj_text t = {.context = scene->context,
                       .path = scene->name,
                       .at = library->text,
                       .end = library->text + library->size,
                       .line = 1};
    bool ours = false; // map_Ka is occlusion
    while (alpi_obj_next_line(&t)) {
        const alpi_obj_word key = alpi_obj_take_word(&t);
        ours = !alpi_obj_word_is(key, "newmtl") &&
               (ours || alpi_obj_word_is(key, "alpenglow_occlusion"));
        for (size_t i = 0; i < KIND_COUNT; i++) {
            counts[i] += alpi_obj_word_is(key, kinds[i]) && !(ours && i == 0);
        }
        if (alpi_obj_word_is(key, "illum")) { // 0 to 2 are diffuse and glossy, others mirror
            const alpi_obj_word model = alpi_obj_take_word(&t);
            counts[KIND_COUNT] += model.size > 1 || (model.size == 1 && *model.text > '2');
        }
    }
}

static void note(const alp_scene *scene, const char *kind, uint32_t count)
{
    if (count > 0) {
        alpi_note(scene->context, "mtl-lost", kind,
                  "glTF has no place for it: %u statements are left out; an .obj keeps them",
                  count);
    }
}

void alpi_obj_note_losses(const alp_scene *scene)
{
    const alpi_obj_source *source = alpi_obj_source_of(scene);
    uint32_t counts[KIND_COUNT + 1] = {0};
    for (uint32_t i = 0; source != NULL && i < source->library_count; i++) {
        count_statements(scene, &source->libraries[i], counts);
    }
    for (size_t i = 0; i < KIND_COUNT; i++) {
        note(scene, kinds[i], counts[i]);
    }
    note(scene, "illum", counts[KIND_COUNT]);
}
