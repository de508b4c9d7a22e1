// SPDX-License-Identifier: MIT
// Pictures of a scene, to see what a bake looks like.
#ifndef ALPENGLOW_RENDER_H
#define ALPENGLOW_RENDER_H

#include <alpenglow/display.h>
#include <alpenglow/film.h>
#include <alpenglow/image.h>
#include <alpenglow/light.h>
#include <alpenglow/lightmap.h>
#include <alpenglow/occlusion.h>
#include <alpenglow/scene.h>

ALP_BEGIN_DECLS

typedef enum alp_render_method {
    ALP_RENDER_AO = 0, ///< accessibility, from the scene's occlusion maps; surfaces without one,
                       ///< and scenes without any, by rays at each pixel
    ALP_RENDER_CONSTANT = 1,   ///< constant ambient light of radiance 1: the albedo,
                               ///< base colour × (1 − metallic), at most 0.95
    ALP_RENDER_HEMISPHERE = 2, ///< ambient light of a sky of radiance `lighting.sky.up` above the
                               ///< horizon and `down` below it, nothing in its way: radiance
                               ///< ρ (up (1 + n·y) + down (1 − n·y)) / 2
    ALP_RENDER_REFERENCE = 3,  ///< path tracing: all light of the scene and of `lighting`, which
                               ///< panes (blended or transmissive materials) filter; AO, CONSTANT
                               ///< and HEMISPHERE cut BLEND at alpha ½ and take transmission for
                               ///< opaque
    /// What a viewer shows of ALP_MAP_LIGHT of `lightmap`: Le + ρ/π · E, E bilinear between texels,
    /// through panes, before sky and sun of `lighting`, which light nothing here. The map is that
    /// of the fronts; backs of double-sided surfaces show it too, others are black. So is what the
    /// map leaves out, but for what it emits.
    ALP_RENDER_LIGHTMAP = 4,
    /// Final gather: a radiosity (as alp_light_options says of RAYS) is solved on an atlas; then
    /// paths of the reference end where they have bounced once, with the light that it knows there:
    /// direct light is that of each pixel. The bias of texels that light others is left, and is
    /// seen only by way of a bounce.
    ALP_RENDER_RADIOSITY = 5,
    /// What a point sees as a hemicube about it does: the five faces of half a cube, unfolded to a
    /// cross of 2n × 2n pixels, front in the middle, +Y above; see alp_hemicube_show. From the
    /// camera's place, which may lie on a surface, along its axis; if that is the normal, what a
    /// texel gathers there. Its angle, `width`, `height` and `samples` are not read.
    ALP_RENDER_HEMICUBE = 6
} alp_render_method;

/// Pictures of ALP_RENDER_HEMICUBE, alpha 1; black in the corners, which belong to no face.
/// Based on: H. Elias. Radiosity; M. F. Cohen, D. P. Greenberg. The Hemi-Cube. SIGGRAPH 1985.
typedef enum alp_hemicube_show {
    /// Radiance [W·sr⁻¹·m⁻²] through the middle of each pixel: what surfaces emit, what they
    /// reflect, by a radiosity as RADIOSITY has it, with its texels, and the sky; no lamps and no
    /// suns, whose light surfaces show (default).
    ALP_HEMICUBE_SEEN = 0,
    ALP_HEMICUBE_PRODUCT,     ///< the same times WEIGHT: E = 4 / n² · sum of the pixels
    ALP_HEMICUBE_WEIGHT,      ///< what a pixel counts for, 1 straight ahead: its exact form factor
                              ///< times π n² / 4; about PERSPECTIVE times LAMBERT
    ALP_HEMICUBE_PERSPECTIVE, ///< cos³ of the angle to the axis of its face
    ALP_HEMICUBE_LAMBERT      ///< cosine of the angle to the normal
} alp_hemicube_show;

typedef struct alp_render_options {
    size_t struct_size;
    alp_render_method method;
    uint32_t width, height; ///< pixels, [1, 16384]; default 960 × 540
    uint32_t samples;       ///< camera rays per pixel, [1, 65536]; default 16. REFERENCE and
                            ///< RADIOSITY: paths, rounded up to a multiple of 16
    alp_camera camera;      ///< vertical_fov 0 (default) = camera `camera_index` of the scene
    uint32_t camera_index;  ///< default 0; past the last, an automatic one: alp_scene_get_camera's,
                            ///< unless one of 17 other places, outside and inside the bounding box,
                            ///< shows much more of the surface from its front; it depends on the
                            ///< scene alone
    alp_occlusion_options
        occlusion;         ///< for AO by rays, `samples` per pixel; its progress is ignored
    const char *occluders; ///< which surfaces occlude, as in alp_bake_options; NULL (default) = all
    const alp_lightmap *lightmap; ///< AO: NULL, or maps of this scene that are read instead of its
                                  ///< textures; LIGHTMAP: maps of this scene with ALP_MAP_LIGHT
    alp_atlas_options atlas; ///< RADIOSITY, HEMICUBE: where it is solved; default of size 512, what
                             ///< it lights is smooth; its progress is ignored
    uint32_t hemicube;       ///< HEMICUBE: n, pixels along an edge, even, [2, 1024]; default 256
    alp_hemicube_show hemicube_show; ///< HEMICUBE
    alp_lighting_options lighting; ///< for HEMISPHERE, whose sky is always of two colours (default
                                   ///< there: up 1, down 0), REFERENCE, RADIOSITY, HEMICUBE, and
                                   ///< what stands behind a LIGHTMAP
    uint32_t bounces;   ///< REFERENCE, RADIOSITY, HEMICUBE: 0 = direct light alone; default
                        ///< ALP_BOUNCES_CONVERGE
    bool no_next_event; ///< REFERENCE: light is found by chance alone, a slow cross-check that
                        ///< never finds lights without extent
    alp_image **error;  ///< NULL, or out: REFERENCE and RADIOSITY: the standard error of each pixel
                        ///< by the spread of its paths, float RGBA, which the caller destroys
    alp_progress_fn *progress;
    void *progress_user;
} alp_render_options;
ALP_API alp_render_options alp_render_options_default(void);

/// Renders linear radiance (AO: accessibility) as float RGBA, alpha 0 where no surface is seen;
/// REFERENCE, RADIOSITY and LIGHTMAP: of a pane with nothing behind it what it takes, and with a
/// sky 1 everywhere. Warns of a camera in a wall, to these and HEMISPHERE (camera-inside), and
/// REFERENCE and RADIOSITY of what alp_scene_examine tells.
/// @return ALP_OK; INVALID_ARGUMENT (a pattern without a match among them, or LIGHTMAP without a
/// map of light); OUT_OF_MEMORY; CANCELLED; RADIOSITY: what alp_atlas_create returns
ALP_API ALP_NODISCARD alp_result alp_render(const alp_scene *scene,
                                            const alp_render_options *options, alp_image **image);

/// How pictures of a method are best shown: accessibility and the albedo lie between 0 and 1 and
/// are shown as they are (alp_film_options_default); radiance, which every other method gives, by
/// film with automatic exposure and hashed dithering.
ALP_API alp_film_options alp_render_film_options(alp_render_method method);

ALP_END_DECLS

#endif
