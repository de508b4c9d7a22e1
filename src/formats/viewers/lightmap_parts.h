// SPDX-License-Identifier: MIT
// A scene with baked light as viewers without glTF draw it: a mesh for every surface on every page,
// a material for every material on every page.
#ifndef ALPI_FORMATS_LIGHTMAP_PARTS_H
#define ALPI_FORMATS_LIGHTMAP_PARTS_H

#include "formats/text/text_edits.h"
#include "formats/viewers/viewers.h"

/// What is drawn at once.
typedef struct alpi_lightmap_part {
    uint32_t surface;
    uint32_t slot; // its material, below
    uint32_t first_vertex, vertex_count;
    uint32_t first_index, index_count; // indices count from the part's own first vertex
} alpi_lightmap_part;

typedef struct alpi_lightmap_slot {
    uint32_t material; // of the scene; ALPI_NONE: none, ρ = .5
    uint32_t page;     // ALPI_NONE: no map
    bool colored;      // colours at the vertices that are not all white
    uint32_t next;     // slot of the same material; ALPI_NONE: none
} alpi_lightmap_slot;

typedef struct alpi_lightmap_parts {
    const alp_scene *scene;
    alpi_lightmap_part *parts; // [part_count] in the order of surfaces, then pages
    uint32_t part_count;
    alpi_lightmap_slot *slots; // [slot_count] in the order of their first use
    uint32_t slot_count;
    uint32_t *vertices; // of the scene
    float (*uvs)[2];    // of the map, at the same places
    uint32_t *indices;
} alpi_lightmap_parts;

/// Usable triangles alone. A vertex of the scene comes out once for each place that it has in a
/// map.
/// @return ALP_OK; LIMIT (more corners than indices can count); OUT_OF_MEMORY
alp_result alpi_lightmap_parts_create(const alp_scene *scene, const alpi_light_pages *light,
                                      alpi_lightmap_parts *parts);
void alpi_lightmap_parts_destroy(alpi_lightmap_parts *parts); ///< also of a failed create

/// The numbers of an array: of the scene's values at the vertices, `width` each.
void alpi_lightmap_print_vertices(alpi_bytes *text, const alpi_lightmap_parts *parts,
                                  const alpi_lightmap_part *part, const float *values,
                                  size_t width);
/// Coordinates at which a texture is read, its transform applied.
void alpi_lightmap_print_uvs(alpi_bytes *text, const alpi_lightmap_parts *parts,
                             const alpi_lightmap_part *part, const alpi_texture *texture);
void alpi_lightmap_print_light_uvs(alpi_bytes *text, const alpi_lightmap_parts *parts,
                                   const alpi_lightmap_part *part);
/// @param clockwise seen from outside, against the scene's order
void alpi_lightmap_print_indices(alpi_bytes *text, const alpi_lightmap_parts *parts,
                                 const alpi_lightmap_part *part, bool clockwise);
/// A point of the scene in the world of its file: three numbers with commas between.
void alpi_lightmap_print_point(alpi_bytes *text, const alp_scene *scene, const float point[3]);
/// `count` numbers with commas between, each as short as brings the float back.
void alpi_lightmap_print_floats(alpi_bytes *text, const float *values, size_t count);
/// A member of an object that is not its first.
void alpi_lightmap_print_float(alpi_bytes *text, const char *name, float value);
/// What stands before an item of a list: nothing before the first.
const char *alpi_lightmap_comma(uint32_t index);

/// Bytes of text that a scene takes, about, without its maps.
uint64_t alpi_lightmap_text_size(const alp_scene *scene);

/// The material of a slot, or a plain one where it has none (ρ = .5).
alpi_material alpi_lightmap_material(const alp_scene *scene, const alpi_lightmap_slot *slot);
/// Diffuse albedo before the texture: base colour × (1 − metallic), clamped as the bake does where
/// no texture follows.
vec3 alpi_lightmap_albedo(const alp_scene *scene, const alpi_material *material);
/// Warns of materials whose metalness varies over a texture: it is left out (lightmap-metal).
void alpi_lightmap_warn_of_metal(const alpi_lightmap_parts *parts);
/// Whether the scene has pixels for the texture that a PNG can hold.
bool alpi_lightmap_has_image(const alp_scene *scene, const alpi_texture *texture);
/// "data:image/png;base64,…", with quotes.
alp_result alpi_lightmap_print_image(alpi_bytes *text, const alp_image *image);

/// From a camera to the farthest corner of the scene.
float alpi_lightmap_far(const alp_scene *scene, const alp_camera *camera);

#endif
