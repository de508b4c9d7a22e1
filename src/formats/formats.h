// SPDX-License-Identifier: MIT
// Bytes ↔ scene, image, patched scene. All untrusted input ends in this room.
#ifndef ALPI_FORMATS_FORMATS_H
#define ALPI_FORMATS_FORMATS_H

#include "base/file_set.h"
#include "base/image.h"
#include "scene/mesh_patch.h"
#include "scene/scene.h"

/// Reads a .gltf or .glb into a scene and keeps the document with it (ALPI_ATTACHMENT_DOCUMENT).
alp_result alpi_gltf_read_scene(alp_context *context, const char *path, alp_scene **scene);
/// The same with one of its scenes, by number or name; NULL = the one it shows first.
alp_result alpi_gltf_read_choice(alp_context *context, const char *path, const char *choice,
                                 alp_scene **scene);

/// Reads an .obj and its material libraries into a scene. No unit is stated: metres are taken.
alp_result alpi_obj_read_scene(alp_context *context, const char *path, alp_scene **scene);

/// Reads a .dae or .zae into a scene and keeps the document with it (ALPI_ATTACHMENT_COLLADA).
alp_result alpi_collada_read_scene(alp_context *context, const char *path, alp_scene **scene);

typedef enum alpi_image_encoding {
    ALPI_IMAGE_ENCODING_PNG_8, // or fewer bits a channel
    ALPI_IMAGE_ENCODING_PNG_16,
    ALPI_IMAGE_ENCODING_JPEG,
    ALPI_IMAGE_ENCODING_WEBP,
    ALPI_IMAGE_ENCODING_OTHER // or not readable, or of a scene without a document
} alpi_image_encoding;
typedef struct alpi_image_source {
    alpi_image_encoding encoding;
    char name[96]; // for messages: "image 3 (wood.png)"
} alpi_image_source;
/// How image `image` of the scene's document is stored; what cannot be read is OTHER.
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_gltf_image_source(const alp_scene *scene, uint32_t image,
                                  alpi_image_source *source);

/// A map of light that a material shows.
typedef struct alpi_light_map {
    alpi_texture texture; // image: index into the list of images, ALPI_NONE = no map
    float scale;          // what texels are multiplied by
} alpi_light_map;
typedef struct alpi_light_maps {
    alpi_light_map *maps; // [materials of the scene]
    uint32_t image_count;
    alp_image **images; // [image_count], linear
} alpi_light_maps;
/// Reads the maps of light that the materials of a scene's document name for viewers: MOZ_lightmap,
/// else extras.lightmap. A scene without a document has none. Such images are not kept with the
/// scene, which has no use for them.
/// @param maps out; released by alpi_light_maps_release, also on failure
/// @return ALP_OK; what reading an image gives; UNSUPPORTED (a KTX2)
alp_result alpi_gltf_read_light_maps(const alp_scene *scene, alpi_light_maps *maps);
void alpi_light_maps_release(alp_context *context, alpi_light_maps *maps);

/// Writes the scene's document with the patch to `path` (.glb or .gltf by its ending). A scene that
/// came from no file is first exported to glTF. Its files are added to a set, the asset last.
alp_result alpi_gltf_add_patched(const alp_scene *scene, const alpi_mesh_patch *patch,
                                 const char *path, alpi_file_set *files);

/// Every file that alpi_gltf_add_patched would make for `path` is checked before the long work:
/// writable, not there already unless overwrite.
alp_result alpi_gltf_check_output(const alp_scene *scene, uint32_t page_count, const char *path,
                                  bool overwrite);
/// Images that a patch brings.
typedef struct alpi_gltf_images {
    uint32_t occlusion, packed, light;
    const char *light_ending; // ".png"; NULL without light
    bool light_is_beside;     // a .glb too has them as files beside it
} alpi_gltf_images;
/// The same for a patch with other images than occlusion.
alp_result alpi_gltf_check_outputs(const alp_scene *scene, const alpi_gltf_images *images,
                                   const char *path, bool overwrite);

/// Writes the COLLADA document that a scene was read from, with the patch, to `path` (.dae), and
/// the maps beside it. @return also UNSUPPORTED (another scene, values at vertices, light that is
/// not emissive)
alp_result alpi_collada_add_patched(const alp_scene *scene, const alpi_mesh_patch *patch,
                                    const char *path, alpi_file_set *files);
/// Every file of it is checked before the long work.
alp_result alpi_collada_check_outputs(const alp_scene *scene, const alpi_gltf_images *images,
                                      const char *path, bool overwrite);

/// Writes any scene with the patch as OUT.obj, OUT.mtl and pictures beside them, in world space,
/// triangles without area left out. Baked coordinates take the place of vt, and textures that need
/// others are left out with a warning; with kept ones both stay. Occlusion: map_Ka, and map_Kd
/// where that is free; light: Kd 0, Ke and map_Ke (other forms, values at vertices and packed
/// images are UNSUPPORTED).
alp_result alpi_obj_add_patched(const alp_scene *scene, const alpi_mesh_patch *patch,
                                const char *path, alpi_file_set *files);
/// Every file that it would make is checked before the long work.
alp_result alpi_obj_check_outputs(const alp_scene *scene, const alpi_gltf_images *images,
                                  const char *path, bool overwrite);

/// The same for any ending that is written: .obj, .dae, else glTF.
alp_result alpi_scene_add_patched(const alp_scene *scene, const alpi_mesh_patch *patch,
                                  const char *path, alpi_file_set *files);
/// As a set of its own: all files are put in place together.
alp_result alpi_scene_write_patched(const alp_scene *scene, const alpi_mesh_patch *patch,
                                    const char *path, bool overwrite);
alp_result alpi_scene_check_outputs(const alp_scene *scene, const alpi_gltf_images *images,
                                    const char *path, bool overwrite);

/// A scene without a document as GLB bytes: node i, mesh i, primitive 0 = surface i; materials and
/// cameras too (png.c encodes images). *bytes is released by the caller.
alp_result alpi_gltf_export_scene(const alp_scene *scene, uint8_t **bytes, size_t *size);

/// Baked light over the pages of an atlas, for formats that hold a scene together with its map.
typedef struct alpi_light_pages {
    uint32_t page_count, width, height;
    const float (*corner_uvs)[3][2]; // [triangle_count] of each corner; v = 0 at row 0
    const uint32_t *triangle_pages;  // [triangle_count] NULL = all on page 0; ALPI_NONE = no map
    const float *const *pages;       // [page_count] → [height][width][4]; A is not read
    float irradiance_per_unit;       // irradiance E = this × value: 1 for E, π for E/π
} alpi_light_pages;

/// The whole scene as three.js Object JSON, in one file: MeshLambertMaterial with a lightMap of
/// half floats, T · lightMapIntensity = E, which three.js since r155 shows as albedo · E/π; no
/// lights. Colours of materials have the 8 bits of sRGB that the format gives them. Surfaces
/// without a map show their emission alone. Textures of metalness are left out, with a warning
/// (lightmap-metal). *bytes is released by the caller.
/// @return ALP_OK; LIMIT; OUT_OF_MEMORY
alp_result alpi_three_encode(const alp_scene *scene, const alpi_light_pages *light, uint8_t **bytes,
                             size_t *size);
/// The same as a .babylon file, whose maps are the Radiance pictures `page_names` beside it:
/// PBRMaterial with useLightmapAsShadowmap, T = E/π.
/// @return also UNSUPPORTED (pages of less than 8 × 8 texels)
alp_result alpi_babylon_encode(const alp_scene *scene, const alpi_light_pages *light,
                               const char *const *page_names, uint8_t **bytes, size_t *size);
/// One of those pictures.
alp_result alpi_babylon_encode_page(const alp_scene *scene, const alpi_light_pages *light,
                                    uint32_t page, uint8_t **bytes, size_t *size);

/// Decodes from memory; `name` is for messages. Limits: ALPI_IMAGE_PIXEL_LIMIT.
alp_result alpi_png_decode(alp_context *context, const char *name, const uint8_t *bytes,
                           size_t size, alp_image **image);
alp_result alpi_jpeg_decode(alp_context *context, const char *name, const uint8_t *bytes,
                            size_t size, alp_image **image);
/// Three channels, or four where it has alpha; animated ones are UNSUPPORTED.
alp_result alpi_webp_decode(alp_context *context, const char *name, const uint8_t *bytes,
                            size_t size, alp_image **image);
alp_result alpi_exr_decode(alp_context *context, const char *name, const uint8_t *bytes,
                           size_t size, alp_image **image);
/// Three channels; an exposure that the header states is taken out again.
alp_result alpi_hdr_decode(alp_context *context, const char *name, const uint8_t *bytes,
                           size_t size, alp_image **image);
/// By the first bytes.
alp_result alpi_image_decode(alp_context *context, const char *name, const uint8_t *bytes,
                             size_t size, alp_image **image);

/// Encodes to memory; *bytes is released by the caller. PNG takes bytes, EXR and HDR floats.
alp_result alpi_png_encode(const alp_image *image, uint8_t **bytes, size_t *size);
alp_result alpi_exr_encode(const alp_image *image, uint8_t **bytes, size_t *size);
/// Half floats of red, green and blue, and of alpha if wanted: nearest, ties to even. The header
/// says "alpenglowScale", what 1 of the colours stands for, where that is not 1; alpi_exr_decode
/// multiplies by it.
alp_result alpi_exr_encode_half(const alp_image *image, float scale, bool alpha, uint8_t **bytes,
                                size_t *size);
/// RGBA16F with the first row at the top, one level, Zstandard; halves as above, and so the key
/// "alpenglowScale", a power of two as text. Takes float images of four channels.
alp_result alpi_ktx2_encode(const alp_image *image, float scale, uint8_t **bytes, size_t *size);
/// Without alpha; what the format cannot hold is clamped, with a warning (hdr-range).
alp_result alpi_hdr_encode(const alp_image *image, uint8_t **bytes, size_t *size);

#endif
