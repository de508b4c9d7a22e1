// SPDX-License-Identifier: MIT
#include "bake_defaults.h"

#include "output.h"
#include "printing/messages.h"

#include <alpenglow/alpenglow.h>

#include <stdio.h>
#include <string.h>

const char *bake_light_option(const command_line *a)
{
    static const option_id of_light[] = {
        OPTION_SKY,      OPTION_SUN,         OPTION_LAMP,     OPTION_SPOT,         OPTION_BOUNCES,
        OPTION_DENOISE,  OPTION_LAYERS,      OPTION_DIRECT,   OPTION_GATHER,       OPTION_HEMICUBE,
        OPTION_EMITTERS, OPTION_LIGHTMAP_AS, OPTION_SKY_TURN, OPTION_SKY_STRENGTH, OPTION_SUN_SIZE};
    return option_find_given(a, of_light, sizeof of_light / sizeof *of_light);
}

const char *bake_occlusion_option(const command_line *a)
{
    static const option_id of_occlusion[] = {OPTION_AO_SAMPLES,      OPTION_AO_DISTANCE,
                                             OPTION_AO_FALLOFF,      OPTION_AO_CONE,
                                             OPTION_AO_DISTRIBUTION, OPTION_AO_INTO};
    return option_find_given(a, of_occlusion, sizeof of_occlusion / sizeof *of_occlusion);
}

unsigned bake_maps(const option_value *values)
{
    static const alp_map maps[] = {ALP_MAP_AO, ALP_MAP_BENT,      ALP_MAP_LIGHT,
                                   ALP_MAP_SH, ALP_MAP_DIRECTION, ALP_MAP_PROBES};
    const uint64_t choices = values[OPTION_MAPS].whole;
    unsigned bits = 0;
    for (unsigned i = 0; i < sizeof maps / sizeof *maps; i++) {
        bits |= (choices >> i & 1u) != 0 ? (unsigned)maps[i] : 0u;
    }
    return bits;
}

alp_lightmap_as bake_form(const option_value *values)
{
    const option_value *as = &values[OPTION_LIGHTMAP_AS];
    return as->given ? (alp_lightmap_as)(as->choice + 1) : ALP_LIGHTMAP_AS_NONE;
}

/// The form that the name of the output asks for, or NULL.
static const char *form_of_name(const char *output)
{
    return output == NULL                  ? NULL
           : path_ends(output, ".json")    ? "three"
           : path_ends(output, ".babylon") ? "babylon"
                                           : NULL;
}

static void fill_maps(command_line *a)
{
    const option_value *values = a->values;
    const bool light =
        bake_light_option(a) != NULL || form_of_name(values[OPTION_OUTPUT].text) != NULL;
    const bool ao = bake_occlusion_option(a) != NULL || values[OPTION_EXISTING_AO].given ||
                    values[OPTION_AO_BLEED].given;
    if (!values[OPTION_MAPS].given && light) {
        option_give(a, OPTION_MAPS, ao ? "ao,light" : "light");
        a->values[OPTION_MAPS].given = false;
    }
}

/// How the light that it emits is held by an output, and which other forms there are.
static const char *note_of_emission(const char *output)
{
    return path_ends(output, ".obj")
               ? "it emits the light: map_Ke of its .mtl names the map (--lightmap-as emissive), "
                 "the only form of an .obj; a .glb or .gltf has moz and extras too; --maps-dir DIR "
                 "gets the light as files"
           : path_ends(output, ".dae")
               ? "it emits the light: <emission> of its effects names the map (--lightmap-as "
                 "emissive), the only form of a .dae; a .glb or .gltf has moz and extras too; "
                 "--maps-dir DIR gets the light as files"
               : "it emits the light, which every viewer shows (--lightmap-as emissive); other "
                 "forms are moz and extras, three in OUT.json and babylon in OUT.babylon; "
                 "--maps-dir DIR gets the light as files";
}

/// The place of light that no option names.
typedef enum light_place { PLACE_NAMED, PLACE_EMITTED, PLACE_FOLDER } light_place;

/// Fills in --lightmap-as. With --maps-dir, occlusion has its place in OUT and light has its own
/// in the folder.
static light_place fill_form(command_line *a)
{
    const option_value *values = a->values;
    const unsigned maps = bake_maps(values);
    const char *named = form_of_name(values[OPTION_OUTPUT].text);
    const bool output = values[OPTION_OUTPUT].given, folder = values[OPTION_MAPS_FOLDER].given;
    if (values[OPTION_LIGHTMAP_AS].given || (maps & ALP_MAP_LIGHT) == 0 ||
        values[OPTION_UNITS].given || values[OPTION_LIGHTMAP_FORMAT].given ||
        (named == NULL && folder && !output)) {
        return PLACE_NAMED;
    }
    if (named == NULL && folder && (maps & ALP_MAP_AO) != 0) {
        return PLACE_FOLDER;
    }
    option_give(a, OPTION_LIGHTMAP_AS, named != NULL ? named : "emissive");
    return named != NULL ? PLACE_NAMED : PLACE_EMITTED;
}

/// The ending of an output that has a place for all that is baked.
static const char *choose_ending(const option_value *values, const char *scene)
{
    const alp_lightmap_as as = bake_form(values);
    const int atlas = values[OPTION_ATLAS].choice;
    const bool is_dae = path_ends(scene, ".dae") || path_ends(scene, ".zae");
    const bool plain = atlas != (int)ALP_ATLAS_VERTEX &&
                       values[OPTION_AO_INTO].choice != (int)ALP_AO_INTO_ORM &&
                       (as == ALP_LIGHTMAP_AS_NONE || as == ALP_LIGHTMAP_AS_EMISSIVE);
    return as == ALP_LIGHTMAP_AS_THREE                                          ? ".json"
           : as == ALP_LIGHTMAP_AS_BABYLON                                      ? ".babylon"
           : path_ends(scene, ".gltf")                                          ? ".gltf"
           : plain && is_dae                                                    ? ".dae"
           : plain && path_ends(scene, ".obj") && atlas != (int)ALP_ATLAS_BLEND ? ".obj"
                                                                                : ".glb";
}

/// The name of a scene without folder, ending, ".baked", and settings of a built-in one.
static void find_stem(const char *scene, const char **stem, size_t *length)
{
    static const char builtin[] = "builtin:", baked[] = ".baked";
    const size_t tail = sizeof baked - 1;
    const char *slash = strrchr(scene, '/');
    if (strncmp(scene, builtin, sizeof builtin - 1) == 0) {
        *stem = scene + sizeof builtin - 1;
        *length = strcspn(*stem, ",");
        return;
    }
    *stem = slash == NULL ? scene : slash + 1;
    const char *dot = strrchr(*stem, '.');
    *length = dot == NULL || dot == *stem ? strlen(*stem) : (size_t)(dot - *stem);
    if (*length > tail && strncmp(*stem + *length - tail, baked, tail) == 0) {
        *length -= tail;
    }
}

static char *make_name(const option_value *values, const char *scene)
{
    const char *stem, *ending = choose_ending(values, scene);
    size_t length;
    find_stem(scene, &stem, &length);
    const size_t size = length + sizeof ".baked" + strlen(ending);
    char *name = allocate_or_exit(NULL, size);
    snprintf(name, size, "%.*s.baked%s", (int)length, stem, ending);
    return name;
}

char *bake_defaults_fill(command_line *a, const char **note)
{
    option_value *output = &a->values[OPTION_OUTPUT];
    char *name = NULL;
    fill_maps(a);
    const light_place place = fill_form(a);
    if (!output->given && !a->values[OPTION_MAPS_FOLDER].given) {
        name = make_name(a->values, a->operands[0]);
        *output = (option_value){.given = true, .text = name};
    }
    *note = place == PLACE_EMITTED  ? note_of_emission(output->text)
            : place == PLACE_FOLDER ? "it holds the occlusion alone; the light is in the folder of "
                                      "--maps-dir; --lightmap-as emissive puts it into this file "
                                      "too"
                                    : NULL;
    return name;
}
