// SPDX-License-Identifier: MIT
// The words for each kind of finding: severity, visible effect, advice. docs/manual/doctor.md holds
// the same for people to read; a test compares the two.
#include "doctor/doctor_words.h"

#include <string.h>

static const alpi_finding_words words[] = {
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "message", "", ""},

    {ALP_FINDING_NO_TRIANGLES, ALP_SEVERITY_ERROR, "no-triangles",
     "nothing: bake and render stop with a message",
     "export meshes as triangles, and check that the right scene and layers were exported"},
    {ALP_FINDING_BAD_COORDINATES, ALP_SEVERITY_WARNING, "bad-coordinates",
     "holes where those triangles should be, and light through them",
     "export the mesh anew; a division by zero in a modifier or a script is the usual cause"},
    {ALP_FINDING_ZERO_AREA, ALP_SEVERITY_NOTE, "zero-area",
     "nothing: they are invisible, and left out",
     "nothing; to be rid of them, merge vertices by distance before export"},
    {ALP_FINDING_DUPLICATES, ALP_SEVERITY_WARNING, "duplicates",
     "flicker if the two differ, and twice the texels for one place",
     "delete one of the two (in Blender: select, merge by distance)"},
    {ALP_FINDING_BACK_TO_BACK, ALP_SEVERITY_NOTE, "back-to-back",
     "each side has its own texels, even an inner side that is never visible",
     "nothing if both sides are visible; else delete the faces that point inwards"},
    {ALP_FINDING_COPLANAR, ALP_SEVERITY_WARNING, "coplanar",
     "flicker that moves with the camera if the two differ, and twice the texels for one place",
     "cut one along the other, or move it by a millimetre"},
    {ALP_FINDING_BAD_NORMALS, ALP_SEVERITY_WARNING, "bad-normals",
     "facets on a surface that should be smooth", "recalculate the normals before export"},
    {ALP_FINDING_REVERSED_NORMALS, ALP_SEVERITY_WARNING, "reversed-normals",
     "dark or black patches: light is gathered on the inner side",
     "recalculate the normals outside, or flip the faces, before export"},
    {ALP_FINDING_INSIDE_OUT, ALP_SEVERITY_NOTE, "inside-out",
     "nothing in a bake: the map holds the outer side; programs that cull backs show the inside",
     "flip the faces (in Blender: mesh, normals, recalculate outside)"},
    {ALP_FINDING_NO_NORMALS, ALP_SEVERITY_NOTE, "no-normals",
     "facets: correct for boxes, visible edges on round shapes",
     "export normals with the mesh if it should be smooth"},
    {ALP_FINDING_BACKS_SEEN, ALP_SEVERITY_WARNING, "backs-seen",
     "those backs are black and block light: dark stains on the surfaces in front of them",
     "flip the faces, close the mesh, or make its material double-sided"},
    {ALP_FINDING_MIRRORED, ALP_SEVERITY_NOTE, "mirrored",
     "nothing: their triangles are flipped, so that fronts stay fronts", ""},
    {ALP_FINDING_SIZE, ALP_SEVERITY_NOTE, "size",
     "with another unit, lamps are too dark or too bright by its square, and lengths in "
     "options (--ao-distance, --texels-per-metre) have another size",
     "nothing if metres are right; else scale the scene to metres before export"},
    {ALP_FINDING_PRECISION, ALP_SEVERITY_WARNING, "precision",
     "steps and noise in occlusion, and edges that do not meet",
     "move the scene near the origin before export"},
    {ALP_FINDING_T_JUNCTIONS, ALP_SEVERITY_NOTE, "t-junctions",
     "cracks of single pixels, and a seam: the two sides share neither corners nor charts",
     "cut the long edge at that vertex (in Blender: loop cut, merge by distance)"},
    {ALP_FINDING_THIN_WALL, ALP_SEVERITY_NOTE, "thin-wall",
     "light or shadow of the open side on the other one: a texel holds one value for both",
     "give the sheet a thickness (in Blender: solidify), so that each side has its own texels"},
    {ALP_FINDING_BURIED, ALP_SEVERITY_NOTE, "buried",
     "nothing of that part; its texels are wasted, and their black darkens the border of the "
     "visible part",
     "cut away the hidden part, or move the object out"},
    {ALP_FINDING_SCALE, ALP_SEVERITY_NOTE, "scale-outlier",
     "too large an object takes the texels of all others, and enlarges the scene's box and all"
     " lengths that are a share of it; too small a one is a dot",
     "scale the object to the unit of the others; leave skies and helpers out of the export, "
     "or out of the bake with --only"},

    {ALP_FINDING_NO_UVS, ALP_SEVERITY_NOTE, "no-uvs",
     "nothing: a bake makes charts, and writes their coordinates with the mesh", ""},
    {ALP_FINDING_UV_MISSING, ALP_SEVERITY_WARNING, "uv-missing",
     "--atlas keep stops; --atlas auto makes charts, in another set",
     "unwrap those surfaces into the set, or remove the set: charts are made"},
    {ALP_FINDING_UV_OUTSIDE, ALP_SEVERITY_WARNING, "uv-outside",
     "--atlas keep stops, as texels outside of the page do not exist; --atlas auto makes charts",
     "pack the set into the unit square (in Blender: UV, pack islands), or use --atlas charts"},
    {ALP_FINDING_UV_FLAT, ALP_SEVERITY_WARNING, "uv-flat",
     "--atlas keep stops: such a triangle would have one texel; --atlas auto makes charts",
     "unwrap those triangles, or use --atlas charts"},
    {ALP_FINDING_UV_OVERLAP, ALP_SEVERITY_WARNING, "uv-overlap",
     "places that share texels have each other's shadows: --atlas keep warns, or stops above 1 % "
     "of "
     "the texels; --atlas auto makes charts",
     "unwrap the set without overlaps (in Blender: lightmap pack), or use --atlas charts"},
    {ALP_FINDING_UV_SHARED, ALP_SEVERITY_WARNING, "uv-shared",
     "--atlas keep stops: nodes of one mesh would have each other's shadows; --atlas auto "
     "makes charts, and each node gets its own",
     "use --atlas charts; for occlusion of each object by itself, --ao-self keeps them shared"},
    {ALP_FINDING_UV_PADDING, ALP_SEVERITY_WARNING, "uv-padding",
     "with --atlas keep, light bleeds over the seams: viewers mix neighbouring texels",
     "give the set a margin of two texels or more, bake it larger, or use --atlas charts"},
    {ALP_FINDING_UV_DENSITY, ALP_SEVERITY_NOTE, "uv-density",
     "with --atlas keep, sharp shadows on one surface and blurred ones on another",
     "scale the islands to one density, or use --atlas charts"},
    {ALP_FINDING_UV_MIPS, ALP_SEVERITY_NOTE, "uv-mips",
     "with --atlas keep, light bleeds over the seams at a distance: smaller mip levels mix the"
     " islands",
     "give the set a margin of two texels for the first smaller level, four for the second, or "
     "bake without mip-maps"},
    {ALP_FINDING_UV_TINY, ALP_SEVERITY_WARNING, "uv-tiny",
     "with --atlas keep, one value for such an island: no shadow crosses it",
     "scale those islands up, bake at that size, or use --atlas charts"},
    {ALP_FINDING_UV_STRETCH, ALP_SEVERITY_WARNING, "uv-stretch",
     "with --atlas keep, shadows with steps in one direction and sharp in the other",
     "unwrap the surface with less stretch, or use --atlas charts"},

    {ALP_FINDING_MATERIAL_RANGE, ALP_SEVERITY_WARNING, "material-range",
     "other colours than in the file: with its values light would grow at every bounce",
     "give colours and factors between 0 and 1"},
    {ALP_FINDING_WHITE, ALP_SEVERITY_NOTE, "white",
     "rooms too bright and flat, and more noise: a bounce loses almost no light (0.95 is the "
     "largest albedo in use)",
     "use 0.8 for white paint, 0.9 for snow"},
    {ALP_FINDING_METAL, ALP_SEVERITY_WARNING, "metal",
     "black where a viewer multiplies a light map by the diffuse colour, which metals lack",
     "set metallicFactor to 0 on other materials; without one, glTF assumes 1"},
    {ALP_FINDING_IMAGE, ALP_SEVERITY_WARNING, "image",
     "the material without this texture: plain colours in bounced light, no holes, no glow",
     "check the name and the file, and export the texture as PNG or JPEG"},
    {ALP_FINDING_EMISSION_OFF, ALP_SEVERITY_WARNING, "emission-off",
     "nothing glows: the texture is multiplied by the factor, and glTF's default is 0",
     "set emissiveFactor to 1, 1, 1"},
    {ALP_FINDING_EMISSION_BLACK, ALP_SEVERITY_NOTE, "emission-black",
     "nothing glows: the factor is multiplied by a black texture",
     "remove the texture if the material should glow"},
    {ALP_FINDING_INVISIBLE, ALP_SEVERITY_NOTE, "invisible",
     "nothing: rays pass through, but its triangles take texels",
     "leave such helpers out of the export, or out of the bake with --only"},
    {ALP_FINDING_UNLIT, ALP_SEVERITY_NOTE, "unlit",
     "its base colour alone: viewers do not show baked occlusion there",
     "nothing if it should ignore light; else take the extension out, or bake --atlas vertex"},

    {ALP_FINDING_NO_LIGHT, ALP_SEVERITY_NOTE, "no-light",
     "--maps light refuses the scene; occlusion needs no lights",
     "for light, give one: --sky, --sun, --lamp"},
    {ALP_FINDING_LIGHT_INSIDE, ALP_SEVERITY_WARNING, "light-inside",
     "the lamp lights nothing, and the room stays dark",
     "move it, or remove the surface around it"},
    {ALP_FINDING_LIGHT_ON_SURFACE, ALP_SEVERITY_WARNING, "light-on-surface",
     "a glaring spot, noise around it, and light on both sides",
     "move it to the side that it should light"},
    {ALP_FINDING_CLOSED_ROOM, ALP_SEVERITY_WARNING, "closed-room",
     "black with --maps light: no sky or sun reaches it", "add a lamp, or an opening"},
    {ALP_FINDING_LIGHT_VALUES, ALP_SEVERITY_WARNING, "light", "another light than in the file",
     "use values that KHR_lights_punctual allows"},
    {ALP_FINDING_LIGHT_OFF, ALP_SEVERITY_NOTE, "light-off", "this light adds nothing",
     "give it an intensity, or remove it"},
    {ALP_FINDING_LIGHT_STRONG, ALP_SEVERITY_WARNING, "light-strong",
     "white surfaces near it, and all others dark in comparison",
     "check the unit: candela for lamps (a bulb has 100), lux for suns (noon has 100,000)"},
    {ALP_FINDING_LIGHT_RANGE, ALP_SEVERITY_WARNING, "light-range",
     "the lamp lights nothing: its range ends before the first surface",
     "remove the range, or make it longer; light needs none"},

    // Messages of the readers.
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "mtllib",
     "grey surfaces: colours and textures are missing", "put the .mtl beside the .obj"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "material", "grey surfaces",
     "add the material to the .mtl, or correct its name"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "map-d", "full shadows of surfaces with holes",
     "give map_d the same -s, -o and -clamp as map_Kd"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "mtl-numbers",
     "the material without those statements", "correct the numbers in the .mtl"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "missing-data",
     "flat shading, or textures that are missing", "export the mesh anew, with all that it names"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "effect", "grey surfaces",
     "export with the common profile"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "alpha",
     "full shadows of surfaces that may be meant as transparent",
     "nothing if they are solid; else export as glTF, whose alpha is unambiguous"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "light-units", "light of a guessed strength",
     "compare, and set the light's intensity"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "leftover-indices",
     "a triangle may be missing at the end of the mesh", "export the mesh anew"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "bad-faces", "faces may be missing",
     "export the mesh anew"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "crossed-faces",
     "faces that flicker, and holes beside them", "cut such faces into triangles before export"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "short-array", "vertices may be missing",
     "export the mesh anew"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "bad-uvs", "a smeared texture on those triangles",
     "unwrap them anew"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "no-uv",
     "one texel of the texture on the whole surface", "unwrap it, or remove the texture"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "uv-set", "plain colours instead of that texture",
     "use one of the first four sets"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "external", "that part of the scene is missing",
     "merge the documents into one"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "camera", "renders from another position",
     "give one with --camera"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "rotation", "an object with a wrong rotation",
     "export the scene anew"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "animation",
     "an object, or a property of one, that does not move",
     "export the animation as moves of nodes and morph targets, without extensions"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "skin", "a part of the mesh out of place",
     "export the mesh in its pose, without its skin"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "no-scene", "meshes at guessed positions",
     "export the document with its scene"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "not-mesh", "those shapes are missing",
     "turn splines and solids into meshes before export"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "missing",
     "a part, lamp, camera, colour or texture that was meant to be there is missing",
     "export the file anew, or correct the reference"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "bad-input", "facets or plain colours on that part",
     "export the mesh anew"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "empty-geometry",
     "nothing: there is nothing to see",
     "nothing; to be rid of it, delete the empty object before export"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "bad-fixture", "that light or camera is missing",
     "correct its numbers, or export it anew"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "encoding",
     "wrong letters in names, or a texture that is not found by its name",
     "save the file as UTF-8"},
    {ALP_FINDING_MESSAGE, ALP_SEVERITY_WARNING, "trailing-bytes",
     "nothing; but the file may be damaged, or hide data", "export the file anew"},
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
