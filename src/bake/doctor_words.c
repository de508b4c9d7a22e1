// SPDX-License-Identifier: MIT
// What the doctor says of each kind of finding: how grave it is, what will be seen, what to do.
// docs/doctor.md holds the same for people to read; a test compares the two.
#include "bake/doctor.h"

#include <string.h>

static const alpi_finding_words words[] = {
    {ALP_FINDING_MESSAGE, "message", ALP_SEVERITY_WARNING, "", ""},

    {ALP_FINDING_NO_TRIANGLES, "no-triangles", ALP_SEVERITY_ERROR,
     "nothing: bake and render stop with a message",
     "export meshes as triangles, and check that the right scene and layers were exported"},
    {ALP_FINDING_BAD_COORDINATES, "bad-coordinates", ALP_SEVERITY_WARNING,
     "holes where those triangles should be, and light through them",
     "export the mesh anew; a division by zero in a modifier or a script is the usual cause"},
    {ALP_FINDING_ZERO_AREA, "zero-area", ALP_SEVERITY_NOTE,
     "nothing: they are invisible, and left out",
     "nothing; to be rid of them, merge vertices by distance before export"},
    {ALP_FINDING_DUPLICATES, "duplicates", ALP_SEVERITY_WARNING,
     "flicker where the two look different, and twice the texels for one place",
     "delete one of the two (in Blender: select, merge by distance)"},
    {ALP_FINDING_BACK_TO_BACK, "back-to-back", ALP_SEVERITY_NOTE,
     "each side gets texels of its own, the inner side too, which nobody may see",
     "nothing where both sides are seen; else delete the faces that look inwards"},
    {ALP_FINDING_BAD_NORMALS, "bad-normals", ALP_SEVERITY_WARNING,
     "facets where the surface should be smooth", "recalculate the normals before export"},
    {ALP_FINDING_REVERSED_NORMALS, "reversed-normals", ALP_SEVERITY_WARNING,
     "dark or black patches: they ask for light on the side that is inside",
     "recalculate the normals outside, or flip the faces, before export"},
    {ALP_FINDING_NO_NORMALS, "no-normals", ALP_SEVERITY_NOTE,
     "facets: right for boxes, edges on what should be round",
     "export normals with the mesh if it is to look smooth"},
    {ALP_FINDING_BACKS_SEEN, "backs-seen", ALP_SEVERITY_WARNING,
     "those backs are black and stop light: dark stains on what is before them",
     "turn the faces round, close the mesh, or make its material double-sided"},
    {ALP_FINDING_MIRRORED, "mirrored", ALP_SEVERITY_NOTE,
     "nothing: their triangles are turned round, so that fronts stay fronts", ""},
    {ALP_FINDING_SIZE, "size", ALP_SEVERITY_NOTE,
     "with another unit, lamps are too dark or too bright by its square, and lengths in options "
     "(--ao-distance, --texels-per-metre) mean something else",
     "nothing where metres are right; else scale the scene to metres before export"},
    {ALP_FINDING_PRECISION, "precision", ALP_SEVERITY_WARNING,
     "steps and noise in occlusion, and edges that do not meet",
     "move the scene near the origin before export"},

    {ALP_FINDING_NO_UVS, "no-uvs", ALP_SEVERITY_NOTE,
     "nothing: a bake makes charts, and writes their coordinates with the mesh", ""},
    {ALP_FINDING_UV_MISSING, "uv-missing", ALP_SEVERITY_WARNING,
     "--atlas keep stops; --atlas auto makes charts, in another set",
     "unwrap those surfaces into the set, or give no set: charts are made"},
    {ALP_FINDING_UV_OUTSIDE, "uv-outside", ALP_SEVERITY_WARNING,
     "--atlas keep stops, as texels outside of the page do not exist; --atlas auto makes charts",
     "pack the set into the unit square (in Blender: UV, pack islands), or use --atlas charts"},
    {ALP_FINDING_UV_FLAT, "uv-flat", ALP_SEVERITY_WARNING,
     "--atlas keep stops: all of such a triangle would show one texel; --atlas auto makes charts",
     "unwrap those triangles, or use --atlas charts"},
    {ALP_FINDING_UV_OVERLAP, "uv-overlap", ALP_SEVERITY_WARNING,
     "--atlas keep stops: places that share texels would show each other's shadows; --atlas auto "
     "makes charts",
     "unwrap the set without overlaps (in Blender: lightmap pack), or use --atlas charts"},
    {ALP_FINDING_UV_SHARED, "uv-shared", ALP_SEVERITY_WARNING,
     "--atlas keep stops: nodes that show one mesh would show each other's shadows; --atlas auto "
     "makes charts, and each node gets its own",
     "use --atlas charts; for occlusion of each object by itself, --ao-self keeps them shared"},
    {ALP_FINDING_UV_PADDING, "uv-padding", ALP_SEVERITY_WARNING,
     "with --atlas keep, light bleeds over the seams: viewers mix neighbouring texels",
     "give the set a margin of two texels or more, bake it larger, or use --atlas charts"},
    {ALP_FINDING_UV_DENSITY, "uv-density", ALP_SEVERITY_NOTE,
     "with --atlas keep, sharp shadows on the one and blurred ones on the other",
     "scale the islands to one density, or use --atlas charts"},

    {ALP_FINDING_MATERIAL_RANGE, "material-range", ALP_SEVERITY_WARNING,
     "a look that differs from what the file says: with such values light would grow at every "
     "bounce",
     "give colours and factors between 0 and 1"},
    {ALP_FINDING_WHITE, "white", ALP_SEVERITY_NOTE,
     "rooms too bright and flat, and more noise: light is hardly lost at a bounce (0.95 is the "
     "most that is used)",
     "use 0.8 for white paint, 0.9 for snow"},
    {ALP_FINDING_METAL, "metal", ALP_SEVERITY_WARNING,
     "black in a light bake: a metal has no diffuse colour and bounces nothing",
     "give what is no metal a metallicFactor of 0; without one, glTF takes 1"},
    {ALP_FINDING_IMAGE, "image", ALP_SEVERITY_WARNING,
     "the material without this texture: plain colours in bounced light, no holes, no glow",
     "check the name and the file, and export the texture as PNG or JPEG"},
    {ALP_FINDING_EMISSION_OFF, "emission-off", ALP_SEVERITY_WARNING,
     "nothing glows: the texture is multiplied by the factor, and glTF's default is 0",
     "set emissiveFactor to 1, 1, 1"},
    {ALP_FINDING_EMISSION_BLACK, "emission-black", ALP_SEVERITY_NOTE,
     "nothing glows: the factor is multiplied by a black texture",
     "remove the texture if the material should glow"},
    {ALP_FINDING_INVISIBLE, "invisible", ALP_SEVERITY_NOTE,
     "nothing: rays pass through, but its triangles take texels",
     "leave such helpers out of the export, or out of the bake with --only"},

    {ALP_FINDING_NO_LIGHT, "no-light", ALP_SEVERITY_NOTE,
     "black with --maps light; occlusion needs no lights",
     "for light, give one: --sky, --sun, --lamp"},
    {ALP_FINDING_LIGHT_INSIDE, "light-inside", ALP_SEVERITY_WARNING,
     "the lamp lights nothing, and the room stays dark", "move it, or remove what is around it"},
    {ALP_FINDING_LIGHT_ON_SURFACE, "light-on-surface", ALP_SEVERITY_WARNING,
     "a glaring spot, noise around it, and light on both sides",
     "move it off, to the side it is to light"},
    {ALP_FINDING_CLOSED_ROOM, "closed-room", ALP_SEVERITY_WARNING,
     "black with --maps light: neither sky nor sun gets in", "give the room a lamp, or an opening"},
    {ALP_FINDING_LIGHT_VALUES, "light", ALP_SEVERITY_WARNING,
     "a light that differs from what the file says", "give values as KHR_lights_punctual has them"},
    {ALP_FINDING_LIGHT_OFF, "light-off", ALP_SEVERITY_NOTE, "nothing of this light",
     "give it an intensity, or remove it"},
    {ALP_FINDING_LIGHT_STRONG, "light-strong", ALP_SEVERITY_WARNING,
     "white surfaces near it, and all else dark beside it",
     "check the unit: candela for lamps (a bulb has 100), lux for suns (noon has 100,000)"},
    {ALP_FINDING_LIGHT_RANGE, "light-range", ALP_SEVERITY_WARNING,
     "the lamp lights nothing: its range ends before the first surface",
     "remove the range, or make it longer; light needs none"},

    // Messages of the readers.
    {ALP_FINDING_MESSAGE, "mtllib", ALP_SEVERITY_WARNING,
     "grey surfaces: colours and textures are missing", "put the .mtl beside the .obj"},
    {ALP_FINDING_MESSAGE, "material", ALP_SEVERITY_WARNING, "grey surfaces",
     "add the material to the .mtl, or correct its name"},
    {ALP_FINDING_MESSAGE, "effect", ALP_SEVERITY_WARNING, "grey surfaces",
     "export with the common profile"},
    {ALP_FINDING_MESSAGE, "alpha", ALP_SEVERITY_WARNING,
     "surfaces that may have been meant to be seen through cast full shadows",
     "nothing where they are solid; else export as glTF, whose alpha is not in doubt"},
    {ALP_FINDING_MESSAGE, "light-units", ALP_SEVERITY_WARNING,
     "light of a strength that is a guess", "compare, and set the light's intensity"},
    {ALP_FINDING_MESSAGE, "leftover-indices", ALP_SEVERITY_WARNING,
     "a triangle may be missing at the end of the mesh", "export the mesh anew"},
    {ALP_FINDING_MESSAGE, "bad-faces", ALP_SEVERITY_WARNING, "faces may be missing",
     "export the mesh anew"},
    {ALP_FINDING_MESSAGE, "crossed-faces", ALP_SEVERITY_WARNING,
     "faces that flicker, and holes beside them", "cut such faces into triangles before export"},
    {ALP_FINDING_MESSAGE, "short-array", ALP_SEVERITY_WARNING, "vertices may be missing",
     "export the mesh anew"},
    {ALP_FINDING_MESSAGE, "bad-uvs", ALP_SEVERITY_WARNING,
     "a texture that is smeared over those triangles", "unwrap them anew"},
    {ALP_FINDING_MESSAGE, "no-uv", ALP_SEVERITY_WARNING,
     "one texel of the texture all over the surface", "unwrap it, or remove the texture"},
    {ALP_FINDING_MESSAGE, "uv-set", ALP_SEVERITY_WARNING,
     "plain colours in the place of that texture", "use one of the first four sets"},
    {ALP_FINDING_MESSAGE, "external", ALP_SEVERITY_WARNING, "that part of the scene is missing",
     "merge the documents into one"},
    {ALP_FINDING_MESSAGE, "camera", ALP_SEVERITY_WARNING, "renders from another place",
     "give one with --camera"},
    {ALP_FINDING_MESSAGE, "rotation", ALP_SEVERITY_WARNING, "an object that may be turned wrongly",
     "export the scene anew"},
    {ALP_FINDING_MESSAGE, "skin", ALP_SEVERITY_WARNING, "a part of the mesh out of place",
     "export the mesh in its pose, without its skin"},
    {ALP_FINDING_MESSAGE, "no-scene", ALP_SEVERITY_WARNING, "meshes at places that are a guess",
     "export the document with its scene"},
};

enum { WORDS_COUNT = sizeof words / sizeof *words };

const alpi_finding_words *alpi_finding_words_of(alp_finding_kind kind)
{
    for (size_t i = 0; i < WORDS_COUNT; i++) {
        if (words[i].kind == kind) {
            return &words[i];
        }
    }
    return &words[0];
}

const alpi_finding_words *alpi_finding_words_by_code(const char *code)
{
    for (size_t i = 0; i < WORDS_COUNT; i++) {
        if (strcmp(words[i].code, code) == 0) {
            return &words[i];
        }
    }
    return &words[0];
}
