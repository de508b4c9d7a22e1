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

/// Statements of each kind, and of illum.
typedef struct losses {
    uint32_t kinds[KIND_COUNT], mirrors;
} losses;

/// A material while its statements are read.
typedef struct block {
    bool is_used;
    bool has_occlusion; // map_Ka is occlusion
    bool reflects;      // Ks is not black
    bool is_physical;   // Pr or Pm: glTF reflects by them
    bool mirrors;       // illum 3 and above: 0 to 2 are diffuse and glossy
} block;

/// A model of mirrors changes nothing without a colour that they reflect.
static void end_block(losses *l, block *b)
{
    l->mirrors += b->is_used && b->reflects && b->mirrors && !b->is_physical;
    *b = (block){0};
}

static bool is_positive(alpi_obj_text *t)
{
    bool positive = false;
    float value;
    while (alpi_obj_more(t) && alpi_obj_take_float(t, "Ks", &value) == ALP_OK) {
        positive |= value > 0.0f;
    }
    return positive;
}

static void count_statement(const bool *used, const alpi_obj_names *materials, alpi_obj_text *t,
                            block *b, losses *l)
{
    const alpi_obj_word key = alpi_obj_take_word(t);
    if (alpi_obj_word_is(key, "newmtl")) {
        const alpi_obj_word name = alpi_obj_take_rest(t);
        const uint32_t number = alpi_obj_names_find(materials, name.text, name.size);
        end_block(l, b);
        b->is_used = number != ALPI_NONE && used[number];
    } else if (alpi_obj_word_is(key, "alpenglow_occlusion")) {
        b->has_occlusion = true;
    } else if (alpi_obj_word_is(key, "Ks")) {
        b->reflects = is_positive(t);
    } else if (alpi_obj_word_is(key, "illum")) {
        const alpi_obj_word model = alpi_obj_take_word(t);
        b->mirrors = model.size > 1 || (model.size == 1 && *model.text > '2');
    } else if (alpi_obj_word_is(key, "Pr") || alpi_obj_word_is(key, "Pm")) {
        b->is_physical = true;
    }
    for (size_t i = 0; b->is_used && i < KIND_COUNT; i++) {
        l->kinds[i] += alpi_obj_word_is(key, kinds[i]) && !(b->has_occlusion && i == 0);
    }
}

/// Counts in the materials that surfaces have.
static void count_statements(const alp_scene *scene, const alpi_obj_source *source,
                             const bool *used, losses *l)
{
    for (uint32_t i = 0; i < source->library_count; i++) {
        block b = {0};
        alpi_obj_text t = {.context = scene->context,
                           .path = scene->name,
                           .at = source->libraries[i].text,
                           .end = source->libraries[i].text + source->libraries[i].size,
                           .line = 1};
        while (alpi_obj_next_line(&t)) {
            count_statement(used, &source->materials, &t, &b, l);
        }
        end_block(l, &b);
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

alp_result alpi_obj_note_losses(const alp_scene *scene)
{
    const alpi_obj_source *source = alpi_obj_source_of(scene);
    losses l = {0};
    if (source == NULL) {
        return ALP_OK;
    }
    bool *used = ALPI_NEW(scene->context, bool, source->materials.count);
    if (used == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        const uint32_t material = scene->surfaces[s].material;
        if (material < source->materials.count) {
            used[material] = true;
        }
    }
    count_statements(scene, source, used, &l);
    alpi_release(scene->context, used);
    for (size_t i = 0; i < KIND_COUNT; i++) {
        note(scene, kinds[i], l.kinds[i]);
    }
    note(scene, "illum", l.mirrors);
    return ALP_OK;
}
