// SPDX-License-Identifier: MIT
#include "bake_defaults.h"

#include "messages.h"
#include "output.h"

#include <alpenglow/alpenglow.h>

#include <stdio.h>
#include <string.h>

const char *bake_light_option(const option_value *values)
{
    static const named_option of_light[] = {
        {OPTION_SKY, "--sky"},           {OPTION_SUN, "--sun"},
        {OPTION_LAMP, "--lamp"},         {OPTION_SPOT, "--spot"},
        {OPTION_BOUNCES, "--bounces"},   {OPTION_DENOISE, "--denoise"},
        {OPTION_LAYERS, "--layers"},     {OPTION_DIRECT, "--direct"},
        {OPTION_GATHER, "--gather"},     {OPTION_HEMICUBE, "--hemicube"},
        {OPTION_EMITTERS, "--emitters"}, {OPTION_LIGHTMAP_AS, "--lightmap-as"},
        {OPTION_SKY_TURN, "--sky-turn"}, {OPTION_SKY_STRENGTH, "--sky-strength"},
        {OPTION_SUN_SIZE, "--sun-size"},
    };
    return option_find_given(values, of_light, sizeof of_light / sizeof *of_light);
}

const char *bake_occlusion_option(const option_value *values)
{
    static const named_option of_occlusion[] = {
        {OPTION_AO_SAMPLES, "--ao-samples"},           {OPTION_AO_DISTANCE, "--ao-distance"},
        {OPTION_AO_FALLOFF, "--ao-falloff"},           {OPTION_AO_CONE, "--ao-cone"},
        {OPTION_AO_DISTRIBUTION, "--ao-distribution"}, {OPTION_AO_INTO, "--ao-into"}};
    return option_find_given(values, of_occlusion, sizeof of_occlusion / sizeof *of_occlusion);
}

/// Names of choices of --maps and --lightmap-as, in their order.
enum { MAP_AO = 1, MAP_LIGHT = 4 };
enum { FORM_EMISSIVE = 0, FORM_THREE = 3, FORM_BABYLON = 4 };

/// The form that the name of the output asks for, or −1.
static int form_of_name(const char *output)
{
    return output == NULL                  ? -1
           : path_ends(output, ".json")    ? FORM_THREE
           : path_ends(output, ".babylon") ? FORM_BABYLON
                                           : -1;
}

static void fill_maps(option_value *values)
{
    const bool light =
        bake_light_option(values) != NULL || form_of_name(values[OPTION_OUTPUT].text) >= 0;
    const bool ao = bake_occlusion_option(values) != NULL || values[OPTION_EXISTING_AO].given ||
                    values[OPTION_AO_BLEED].given;
    if (!values[OPTION_MAPS].given && light) {
        values[OPTION_MAPS].whole = ao ? MAP_AO | MAP_LIGHT : MAP_LIGHT;
    }
}

/// @return whether the form is one of several that OUT could have
static bool fill_form(option_value *values)
{
    static const char *const names[] = {"emissive", "moz", "extras", "three", "babylon"};
    option_value *as = &values[OPTION_LIGHTMAP_AS];
    const uint64_t maps = values[OPTION_MAPS].whole;
    const int named = form_of_name(values[OPTION_OUTPUT].text);
    // With --maps-dir, occlusion has its place in OUT and light has its own in the folder.
    const bool apart =
        values[OPTION_MAPS_FOLDER].given && (!values[OPTION_OUTPUT].given || (maps & MAP_AO) != 0);
    if (as->given || (maps & MAP_LIGHT) == 0 || (apart && named < 0) ||
        values[OPTION_UNITS].given || values[OPTION_LIGHTMAP_FORMAT].given) {
        return false;
    }
    as->given = true;
    as->choice = named >= 0 ? named : FORM_EMISSIVE;
    as->text = names[as->choice];
    return named < 0;
}

/// The ending of an output that has a place for all that is baked.
static const char *choose_ending(const option_value *values, const char *scene)
{
    const option_value *as = &values[OPTION_LIGHTMAP_AS];
    const int atlas = values[OPTION_ATLAS].choice;
    const bool is_dae = path_ends(scene, ".dae") || path_ends(scene, ".zae");
    const bool plain = atlas != (int)ALP_ATLAS_VERTEX &&
                       values[OPTION_AO_INTO].choice != (int)ALP_AO_INTO_ORM &&
                       (!as->given || as->choice == FORM_EMISSIVE);
    return as->given && as->choice == FORM_THREE                                ? ".json"
           : as->given && as->choice == FORM_BABYLON                            ? ".babylon"
           : path_ends(scene, ".gltf")                                          ? ".gltf"
           : plain && is_dae                                                    ? ".dae"
           : plain && path_ends(scene, ".obj") && atlas != (int)ALP_ATLAS_BLEND ? ".obj"
                                                                                : ".glb";
}

/// The name of a scene without folder, ending, and settings of a built-in one.
static void find_stem(const char *scene, const char **stem, size_t *length)
{
    static const char builtin[] = "builtin:";
    const char *slash = strrchr(scene, '/');
    if (strncmp(scene, builtin, sizeof builtin - 1) == 0) {
        *stem = scene + sizeof builtin - 1;
        *length = strcspn(*stem, ",");
        return;
    }
    *stem = slash == NULL ? scene : slash + 1;
    const char *dot = strrchr(*stem, '.');
    *length = dot == NULL || dot == *stem ? strlen(*stem) : (size_t)(dot - *stem);
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
    option_value *values = a->values, *output = &values[OPTION_OUTPUT];
    char *name = NULL;
    fill_maps(values);
    *note = fill_form(values)
                ? "it emits the light, which every viewer shows (--lightmap-as emissive); other "
                  "forms are moz, extras, three and babylon; --maps-dir DIR gets it as files"
                : NULL;
    if (!output->given && !values[OPTION_MAPS_FOLDER].given) {
        name = make_name(values, a->operands[0]);
        *output = (option_value){.given = true, .text = name};
    }
    return name;
}
