// SPDX-License-Identifier: MIT
// glTF 2.0 → scene.
#ifndef ALPI_FORMATS_GLTF_SCENE_H
#define ALPI_FORMATS_GLTF_SCENE_H

#include "scene/light_maps.h"

/// Reads a .gltf or .glb into a scene and keeps the document with it (ALPI_ATTACHMENT_DOCUMENT).
alp_result alpi_gltf_read_scene(alp_context *context, const char *path, alp_scene **scene);
/// The same with one of its scenes, by number or name; NULL = the one it shows first.
alp_result alpi_gltf_read_choice(alp_context *context, const char *path, const char *choice,
                                 alp_scene **scene);

/// The scene of a glTF with its nodes where one of its animations places them. It shares document
/// and images, and has the origin of `scene`. Says nothing that reading `scene` has said.
/// @param animation < scene.animation_count
alp_result alpi_gltf_read_pose(const alp_scene *scene, uint32_t animation, double seconds,
                               alp_scene **posed);

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

/// Reads the maps of light that the materials of a scene's document name for viewers: MOZ_lightmap,
/// else extras.lightmap. A scene without a document has none.
/// @param maps out; released by alpi_light_maps_release, also on failure
/// @return ALP_OK; what reading an image gives; UNSUPPORTED (a KTX2 other than RGBA16F)
alp_result alpi_gltf_read_light_maps(const alp_scene *scene, alpi_light_maps *maps);
void alpi_light_maps_release(alp_context *context, alpi_light_maps *maps);

#endif
