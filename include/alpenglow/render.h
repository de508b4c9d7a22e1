// SPDX-License-Identifier: MIT
// Pictures of a scene: the effect of a bake, the reference, and classic ambient light.
#ifndef ALPENGLOW_RENDER_H
#define ALPENGLOW_RENDER_H

#include <alpenglow/display.h>
#include <alpenglow/film.h>
#include <alpenglow/image.h>
#include <alpenglow/light.h>
#include <alpenglow/lightmap.h>
#include <alpenglow/lpv.h>
#include <alpenglow/occlusion.h>
#include <alpenglow/probes.h>
#include <alpenglow/scene.h>

ALP_BEGIN_DECLS

/// REFERENCE, RADIOSITY, LIGHTMAP and FIELD pass light through panes (blended or transmissive
/// materials).
/// AO, ALBEDO and HEMISPHERE cut BLEND at alpha ½, and take transmission as opaque.
typedef enum alp_render_method {
    /// Accessibility from the scene's occlusion maps. Surfaces without a map trace rays per pixel.
    /// Backs of single-sided surfaces are left out, as viewers do.
    ALP_RENDER_AO = 0,
    /// Constant ambient light of radiance 1: the albedo (alp_scene_set_metals), at most
    /// 0.95.
    ALP_RENDER_ALBEDO = 1,
    /// Unoccluded ambient light of a sky of radiance `lighting.sky.up` above the horizon and `down`
    /// below it: radiance ρ (up (1 + n·y) + down (1 − n·y)) / 2.
    ALP_RENDER_HEMISPHERE = 2,
    /// Path tracing of all light of the scene and of `lighting`.
    ALP_RENDER_REFERENCE = 3,
    /// A baked picture as viewers display it: Le + ρ/π · E, with E bilinear from ALP_MAP_LIGHT of
    /// `lightmap`. Sky and sun of `lighting` are background only. The map holds the light of front
    /// sides; backs of double-sided surfaces use it too, other backs are black. Surfaces without a
    /// map are black but for their emission.
    ALP_RENDER_LIGHTMAP = 4,
    /// Final gather. A radiosity (RAYS of alp_light_options) is solved on an atlas. Paths of the
    /// reference then end after one bounce in its light. Direct light is computed at each pixel.
    /// The bias of the radiosity remains, and is visible only through a bounce.
    ALP_RENDER_RADIOSITY = 5,
    /// The view of a point as a hemicube sees it: the five faces of half a cube, unfolded to a
    /// cross of 2n × 2n pixels, front in the middle, +Y above. See alp_hemicube_show. The view
    /// starts at the camera's position, which may lie on a surface, along its axis. If the axis is
    /// the normal, this is the light that a texel gathers there. The camera's angle, `width`,
    /// `height` and `samples` are ignored.
    ALP_RENDER_HEMICUBE = 6,
    /// A field as a host displays it: Le + ρ/π · E at each pixel, with E from `field`, and light
    /// straight from lamps and suns of the scene and of `lighting`, with shadows, if the field
    /// leaves that out. The sky is background.
    ALP_RENDER_FIELD = 7
} alp_render_method;

/// An object of albedo .8 in the picture, lit by the scene. It casts no shadow and reflects
/// nothing onto others.
typedef enum alp_object_kind {
    ALP_OBJECT_NONE = 0,
    ALP_OBJECT_SPHERE,
    ALP_OBJECT_TEAPOT ///< twice the radius high, its spout towards +X
} alp_object_kind;
typedef struct alp_render_object {
    alp_object_kind kind; ///< default NONE
    float position[3];    ///< metres: its centre
    float radius;         ///< metres, > 0
} alp_render_object;

/// Pictures of ALP_RENDER_HEMICUBE. Alpha is 1. The corners, which belong to no face, are black.
/// Based on: H. Elias. Radiosity; M. F. Cohen, D. P. Greenberg. The Hemi-Cube. SIGGRAPH 1985.
typedef enum alp_hemicube_show {
    /// Radiance [W·sr⁻¹·m⁻²] through the middle of each pixel (default): emission, the sky, and
    /// reflected light from a radiosity with the texels of RADIOSITY. Lamps and suns are visible
    /// only by the light that surfaces reflect.
    ALP_HEMICUBE_SEEN = 0,
    ALP_HEMICUBE_PRODUCT,     ///< SEEN times WEIGHT: E = 4 / n² · sum of the pixels
    ALP_HEMICUBE_WEIGHT,      ///< weight of a pixel, 1 straight ahead: its exact form factor times
                              ///< π n² / 4; about PERSPECTIVE times LAMBERT
    ALP_HEMICUBE_PERSPECTIVE, ///< cos³ of the angle to the axis of its face
    ALP_HEMICUBE_LAMBERT      ///< cosine of the angle to the normal
} alp_hemicube_show;

typedef struct alp_render_options {
    size_t struct_size;
    alp_render_method method;
    uint32_t width, height; ///< pixels, [1, 16384]; default 960 × 540
    uint32_t samples;       ///< camera rays per pixel, [1, 65536]; default 16. A single one goes
                            ///< through the middle of the pixel. REFERENCE and RADIOSITY: paths,
                            ///< rounded up to a multiple of 16
    alp_camera camera;      ///< vertical_fov 0 (default) = camera `camera_index` of the scene
    /// Default 0. Past the last camera, an automatic one: alp_scene_get_camera's, unless one of 17
    /// other places, outside and inside the bounding box, sees far more front-facing surface. From
    /// outside it is as near as a picture of this shape allows that holds all triangles.
    uint32_t camera_index;
    alp_occlusion_options
        occlusion; ///< AO by rays; its `samples` are rays per pixel, its progress is ignored
    const char *occluders; ///< surfaces that occlude, as in alp_bake_options; NULL (default) = all
    /// AO: NULL, or maps of this scene, used instead of its textures. LIGHTMAP: maps of this scene
    /// with ALP_MAP_LIGHT, or NULL: those of the file (alp_scene_read_light_maps). Surfaces without
    /// one reflect nothing then.
    const alp_lightmap *lightmap;
    /// RADIOSITY, HEMICUBE: atlas of the radiosity; default size 512, because its light is smooth.
    /// Its progress is ignored.
    alp_atlas_options atlas;
    uint32_t hemicube; ///< HEMICUBE: n, pixels along an edge, even, [2, 1024]; default 256
    alp_hemicube_show hemicube_show; ///< HEMICUBE
    /// REFERENCE, RADIOSITY, HEMICUBE; lamps and suns of FIELD; the background of LIGHTMAP and
    /// FIELD. HEMISPHERE uses its sky, always of two colours; default there: up 1, down 0.
    alp_lighting_options lighting;
    uint32_t bounces;       ///< REFERENCE, RADIOSITY, HEMICUBE: 0 = direct light alone; default
                            ///< ALP_BOUNCES_CONVERGE
    bool no_next_event;     ///< REFERENCE: rays are never aimed at lights. A slow cross-check that
                            ///< never finds lights without extent.
    const alp_field *field; ///< FIELD: made of this scene's light
    const alp_lpv *lpv; ///< FIELD: the volume of `gloss` and `scattering`; NULL (default) without
    /// FIELD: surfaces mirror the light of `lpv`; default false. v points to the camera, r is v
    /// mirrored at the normal n, Lmirrored is alp_lpv_radiance along r, Schlick's F has F0 = .04,
    /// the base colour of a metal, or a mixture by its metallic m. Metals reflect no diffuse light:
    ///     L = Le + (1 − m)(1 − F) ρ/π E + F Lmirrored(r),   F = F0 + (1 − F0)(1 − n·v)⁵
    bool gloss;
    /// FIELD: coefficient S [m⁻¹] ≥ 0 of a medium in the bounds of the scene, which scatters light
    /// into all directions alike and absorbs none; 0 (default) = none. With the fluence Φ of `lpv`
    /// and, unless without_direct, of lamps and suns, with shadows:
    ///     L = ∫ S e^(−S t) c(t) Φ(t) / 4π dt + e^(−S T) Lsurface,   t from 0 to the surface at T
    /// c(t) is the colour of the panes before t. The own light of a pane at t is dimmed by e^(−S
    /// t). Light is dimmed on its way to the camera alone. By 32 steps a camera ray.
    float scattering;
    /// REFERENCE, RADIOSITY and FIELD: surfaces that the camera sees get no light straight from
    /// punctual lamps and suns. A field that holds that light keeps it. Default false.
    bool without_direct;
    alp_render_object object; ///< REFERENCE, FIELD
    /// All but HEMICUBE: NULL, or probes to draw as small spheres that show their own
    /// light, at most the 20,000 nearest. Orange: filled in a solid. Magenta: black in a solid.
    const alp_probes *overlay;
    alp_image **error; ///< NULL, or out: REFERENCE and RADIOSITY: standard error of each pixel from
                       ///< the spread of its paths, float RGBA, which the caller destroys
    alp_progress_fn *progress;
    void *progress_user;
} alp_render_options;
ALP_API alp_render_options alp_render_options_default(void);

/// The camera that alp_render takes with these options: `camera`, or the one of `camera_index`.
/// @param options  NULL = defaults   @param camera out
/// @return ALP_OK; OUT_OF_MEMORY; UNSUPPORTED (the ray tracer fails); CANCELLED
ALP_API ALP_NODISCARD alp_result alp_render_find_camera(const alp_scene *scene,
                                                        const alp_render_options *options,
                                                        alp_camera *camera);

/// The object as a scene of its own, for viewers: one surface, white (albedo .8) and single-sided.
/// @param scene out, which the caller destroys; NULL on failure
/// @return ALP_OK; INVALID_ARGUMENT (also without a kind or a radius); OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_render_object_mesh(alp_context *context,
                                                        const alp_render_object *object,
                                                        alp_scene **scene);

/// Renders linear radiance (AO: accessibility) as float RGBA. Alpha is 0 if no surface is visible.
/// Without a sky, panes of REFERENCE, RADIOSITY and LIGHTMAP in front of nothing have the alpha
/// that they absorb. With a sky, alpha of these three is 1 everywhere.
///
/// Warns of a camera in a wall (camera-inside), except for AO, ALBEDO and pictures of hemicubes
/// without light. REFERENCE, RADIOSITY and HEMICUBE give the warnings of alp_scene_examine.
/// @param image out, which the caller destroys; NULL on failure
/// @return ALP_OK; INVALID_ARGUMENT (also a pattern without a match; LIGHTMAP without a map of
///         light; FIELD without a field, or with gloss or scattering and
///         without a volume; an object without a radius; REFERENCE, RADIOSITY, and
///         HEMICUBE with light, of a scene without lamp, emission and sky); OUT_OF_MEMORY;
///         CANCELLED; RADIOSITY and HEMICUBE: as alp_atlas_create
ALP_API ALP_NODISCARD alp_result alp_render(const alp_scene *scene,
                                            const alp_render_options *options, alp_image **image);

/// Film options for pictures of a method. AO and ALBEDO lie between 0 and 1 and stay as they are
/// (alp_film_options_default). All other methods get film, automatic exposure and hashed dithering.
ALP_API alp_film_options alp_render_film_options(alp_render_method method);

ALP_END_DECLS

#endif
