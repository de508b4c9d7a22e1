// SPDX-License-Identifier: MIT
// The immutable description that every room reads: world-space triangles in flat arrays, grouped
// into surfaces (one per node × primitive), with materials, images, lights and cameras.
#ifndef ALPI_SCENE_SCENE_H
#define ALPI_SCENE_SCENE_H

#include "base/context.h"
#include "base/image.h"
#include "base/vec.h"

#include <alpenglow/scene.h>

#define ALPI_NONE UINT32_MAX
enum { ALPI_UV_SET_LIMIT = 4 }; // sets 0…3 of a vertex are kept; textures that use more are ignored
/// Where coordinates are kept: the sets, and behind them those that overlapping charts have where
/// no set was free (_ALPENGLOW_UV_1 and _2 of a glTF).
enum { ALPI_UV_SLOT_COUNT = ALPI_UV_SET_LIMIT + 2 };

/// A texture as a material uses it: image, wrapping, coordinate set and KHR_texture_transform.
typedef struct alpi_texture {
    uint32_t image; // index into scene.images, ALPI_NONE = no texture
    uint32_t uv_set;
    alpi_wrap wrap_u, wrap_v;
    float offset[2], scale[2], rotation; // radians, counter-clockwise as KHR_texture_transform
    bool lost;    // without an image because that could not be used: the factor stands for it
    bool blended; // read in the three slots below, one for each axis of the object, by the normal
    uint8_t slots[3]; // the first is uv_set
} alpi_texture;

typedef enum alpi_alpha_mode {
    ALPI_ALPHA_OPAQUE = 0,
    ALPI_ALPHA_MASK,
    ALPI_ALPHA_BLEND
} alpi_alpha_mode;

/// Gloss and relief. Light does not read them: they are carried from format to format.
typedef struct alpi_shine {
    float roughness;                // [0, 1], of glTF
    alpi_texture roughness_texture; // channel G, linear
    float index;                    // of refraction; 0 = not stated
    bool has_specular;              // the file states the next two
    float specular[3];              // linear
    alpi_texture specular_texture;  // sRGB
    alpi_texture bump_texture;      // heights, or normals of which the file does not say that
    float bump_scale;
} alpi_shine;

typedef struct alpi_material {
    char *name;                      // "" where the file has none
    float base_color[4];             // linear, [0, 1]
    alpi_texture base_color_texture; // sRGB + alpha
    float metallic;                  // [0, 1]
    bool metallic_assumed;           // the file gives no metalness: it is a default
    alpi_texture metallic_texture;   // channel B, linear
    float emission[3]; // radiance W·sr⁻¹·m⁻²: emissiveFactor × emissiveStrength
    alpi_texture emission_texture; // sRGB
    alpi_alpha_mode alpha_mode;
    float alpha_cutoff;
    bool double_sided;
    alpi_texture occlusion_texture; // channel R, linear: accessibility
    float occlusion_strength;       // [0, 1]: 1 + strength (R − 1)
    uint8_t blend_sets;             // bit n: slot n is one of three that are blended
    float transmission; // [0, 1]: share of light that passes through, KHR_materials_transmission
    alpi_texture transmission_texture; // channel R, linear
    alpi_texture normal_texture;       // tangent space, linear; bakes do not read it
    float normal_scale;                // of its x and y
    bool unlit;                        // viewers draw the base colour alone
    alpi_shine shine;
} alpi_material;

typedef struct alpi_surface {
    char *name; // node name, else mesh name, else "node N"
    uint32_t node, mesh,
        primitive;     // indices in the source file; surface i, i, 0 when there is none
    uint32_t instance; // of those in which the node shows its mesh, 0 where it is shown once
    uint32_t material; // ALPI_NONE = none: ρ = .5
    uint32_t first_vertex, vertex_count;
    uint32_t flat_count; // triangles without area, which are left out
    uint32_t first_triangle,
        triangle_count;     // triangles of the primitive in file order, none dropped
    uint32_t uv_sets;       // sets 0 … uv_sets−1 are present in the file
    uint8_t uv_slots;       // bit n: slot n is, as far as blended textures may be read
    bool mirrored;          // negative determinant: the winding was reversed on reading
    bool normals_generated; // flat normals, because the file has none
    float axes[3][3];       // x, y and z axis of its object in the world, of any length: a normal n
                            // of the world has components n·axes there, before it is normalised.
                            // All 0: the world's own
} alpi_surface;

typedef struct alpi_light {
    char *name;
    alp_light_kind kind;
    vec3 color;                   // linear, unitless
    float intensity;              // candela or lux: alp_light_traits.unit
    vec3 position, direction;     // world; direction: where the light travels, unit
    float range;                  // metres, INFINITY = none
    float inner_cone, outer_cone; // radians, half-angles
    float size;                   // radians, full angle of a directional light's disk; 0 = a point
} alpi_light;

/// An animation of the file.
typedef struct alpi_animation {
    char *name;        // "" where the file has none
    double seconds;    // of its last key
    uint32_t channels; // that are read
} alpi_animation;

/// Something another room keeps with a scene, destroyed with it. Only that room knows what it is.
typedef struct alpi_attachment {
    void *data;
    void (*destroy)(alp_context *context, void *data);
} alpi_attachment;
typedef enum alpi_attachment_kind {
    ALPI_ATTACHMENT_DOCUMENT,   // the file as read (formats)
    ALPI_ATTACHMENT_COLLADA,    // the same of a COLLADA file (formats)
    ALPI_ATTACHMENT_OBJ,        // an OBJ with its libraries (formats)
    ALPI_ATTACHMENT_TRACER,     // acceleration structure, made at its first use (trace)
    ALPI_ATTACHMENT_LIGHT_MAPS, // alpi_light_maps, where they were read (formats)
    ALPI_ATTACHMENT_COUNT
} alpi_attachment_kind;

/// Solids that are wound inwards, see sides.h.
typedef struct alpi_sides alpi_sides;

struct alp_scene {
    alp_context *context;
    char *name; // path or "builtin:…", for messages

    /// Origin of positions, lights, cameras and bounds, in metres: file = origin + scene. 0 unless
    /// the file's coordinates are far (origin.h).
    double origin[3];
    float rounded_at; // metres: largest coordinate that a far file holds as a float, else 0

    // Vertices, world space. A primitive without normals has three vertices of its own per
    // triangle.
    uint32_t vertex_count;
    float (*positions)[3]; // metres
    float (*normals)[3];   // unit, finite
    float (
        *uvs[ALPI_UV_SLOT_COUNT])[2]; // NULL where no surface has the set; zeros where one lacks it
    float (*colors)[4];      // COLOR_0, linear RGBA in [0, 1]; NULL where no surface has it
    uint32_t *vertex_source; // index of the vertex in its source primitive

    // Triangles, counter-clockwise outside, in the order of the source primitives.
    uint32_t triangle_count;
    uint32_t (*triangles)[3];   // indices into the vertices
    uint32_t *triangle_surface; // surface of each
    bool *triangle_usable;      // finite, |coordinate| ≤ ALPI_COORDINATE_LIMIT, area > 0
    alpi_sides *sides;          // NULL: maps hold the fronts of all triangles
    uint32_t usable_count;

    uint32_t surface_count;
    alpi_surface *surfaces;
    uint32_t material_count;
    alpi_material *materials;
    uint32_t image_count;
    alp_image **images; // NULL where none of our uses needs it or decoding failed (with a warning)
    alp_image **normal_maps; // [image_count] images that only alp_scene_get_image gives, apart so
                             // that writers do not copy them; NULL before they are loaded
    uint32_t light_count;
    alpi_light *lights;
    uint32_t camera_count;
    alp_camera *cameras;
    uint32_t animation_count;
    uint32_t light_map_count; // materials that name a map of light for viewers
    alpi_animation *animations;

    vec3 bounds_min, bounds_max; // over usable triangles
    double area;

    double unit_metres; // of one unit of the file, by which its lengths were multiplied
    bool unit_assumed;  // the file does not say it: metres were taken
    bool metals_black;  // ALP_METALS_BLACK
    char up_axis;       // 'X', 'Y' or 'Z' as the file states it (it was turned to y), else 0

    /// Decodes an image of the file that light does not need, for alpi_scene_open_image; NULL with
    /// a warning where it cannot be read. NULL: the file is not known.
    alp_result (*read_image)(const alp_scene *scene, uint32_t index, alp_image **image);

    uint64_t input_hash;          // of the source bytes (FNV-1a 64), or of the arrays
    alpi_attachment *attachments; // [ALPI_ATTACHMENT_COUNT]; filled in later even in a const scene
};

/// Beyond this a float product of two extents overflows and Embree drops the triangle.
#define ALPI_COORDINATE_LIMIT 1e15f

/// An empty scene that owns what is put into it; fill the arrays (allocated with the context), then
/// call alpi_scene_finish. Destroy with alp_scene_destroy at any time.
alp_result alpi_scene_create(alp_context *context, const char *name, alp_scene **scene);

/// Checks and completes a filled scene: marks usable triangles, replaces normals that are zero or
/// not finite by the triangle's, clamps material values, computes bounds and area, warns of what is
/// odd (counts and names). Non-finite positions are set to 0 and their triangles made unusable.
/// Finds solids that are wound inwards.
/// @return ALP_OK; INVALID_DATA (an index out of range: a programming error of the reader);
///         OUT_OF_MEMORY; CANCELLED
alp_result alpi_scene_finish(alp_scene *scene);

/// The same without warnings that a scene with the same materials and places gave before.
alp_result alpi_scene_finish_quietly(alp_scene *scene);
/// The second set of coordinates in the words of the scene's file, for messages.
const char *alpi_scene_second_set(const alp_scene *scene);

/// Fingerprint of the shape and the lights, which a pose moves.
uint64_t alpi_scene_pose_hash(const alp_scene *scene);
/// Fingerprint of the images that were read. The content of the file does not hold them all.
uint64_t alpi_scene_images_hash(const alp_scene *scene);

/// Warns of a scene that is mostly metal by glTF's default: a metal has no diffuse colour for a
/// viewer to multiply a light map by. A metal that the file states is meant, and a black one may
/// emit all its light.
void alpi_scene_warn_of_metal(const alp_scene *scene);

/// An image of a scene, decoded now where it was not: one more owner of it, who destroys it. NULL
/// for one that cannot be read, with a warning, and where the scene's file is not known.
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_scene_open_image(const alp_scene *scene, uint32_t index, alp_image **image);

/// Shares the images and normal maps of a scene with one that has none.
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_scene_share_images(const alp_scene *from, alp_scene *to);

/// A material with glTF's defaults except metallic 0, named `name`.
alpi_material alpi_material_default(void);
/// No texture.
alpi_texture alpi_texture_none(void);

/// Positions of the corners of a triangle.
static inline void alpi_triangle_corners(const alp_scene *scene, uint32_t triangle, vec3 corner[3])
{
    for (int k = 0; k < 3; k++) {
        corner[k] = vec3_load(scene->positions[scene->triangles[triangle][k]]);
    }
}

/// The coordinates a texture is read at, for uv of its set: KHR_texture_transform applied.
vec2 alpi_texture_transform(const alpi_texture *texture, vec2 uv);

/// uv of slot `set` at barycentrics (b1, b2) of a triangle (weight of corners 1 and 2); 0 if
/// absent.
vec2 alpi_triangle_uv(const alp_scene *scene, uint32_t triangle, uint32_t set, float b1, float b2);

/// Coverage (alpha) of the material at a point of a triangle: base colour alpha × texture alpha ×
/// vertex colour alpha.
float alpi_surface_alpha(const alp_scene *scene, uint32_t triangle, float b1, float b2);

/// Share of light that passes through the material there: transmission × texture. 0 without one.
float alpi_surface_transmission(const alp_scene *scene, uint32_t triangle, float b1, float b2);

/// Whether a ray passes through the triangle there: MASK below its cutoff, BLEND below one half.
bool alpi_surface_is_cut(const alp_scene *scene, uint32_t triangle, float b1, float b2);
/// Whether the triangle's material is double-sided; false without a material.
bool alpi_surface_is_double_sided(const alp_scene *scene, uint32_t triangle);
/// Whether light passes through the surface's material in part: blended, or with transmission.
bool alpi_surface_is_pane(const alp_scene *scene, uint32_t surface);

/// What becomes of light that meets a surface, with alpha a (1 unless blended), base colour c and
/// transmission t, less its metallic part. glTF says how a blended surface covers what is behind
/// it, 1 − a, and not what it does to light: here its colour takes hold with its alpha. Where a
/// mask cuts, all goes through.
typedef struct alpi_pane {
    vec3 through; // goes straight on: (1 − a) lerp(1, c, a) + a t c
    float kept;   // of this share the material reflects its albedo: a (1 − t)
} alpi_pane;
alpi_pane alpi_surface_pane(const alp_scene *scene, uint32_t triangle, float b1, float b2);

/// Whether any point of the surface can be cut (so that the tracer must ask).
bool alpi_surface_has_cuts(const alp_scene *scene, uint32_t surface);

/// Metalness: metallic × texture; 0 without a material.
float alpi_surface_metallic(const alp_scene *scene, uint32_t triangle, float b1, float b2);
/// The share of its base colour that a material of this metalness reflects: alp_scene_set_metals.
static inline float alpi_scene_diffuse_share(const alp_scene *scene, float metallic)
{
    return scene->metals_black ? 1.0f - metallic : 1.0f;
}
/// Diffuse albedo ρ, clamped to [0, .95]: base colour, × (1 − metallic) where metals are black; .5
/// without a material.
vec3 alpi_surface_albedo(const alp_scene *scene, uint32_t triangle, float b1, float b2);
/// The same of a metal that is not black: what its mirrored light is multiplied by.
vec3 alpi_surface_color(const alp_scene *scene, uint32_t triangle, float b1, float b2);

/// A place on a triangle: barycentric weights of corners 1 and 2.
typedef struct alpi_surface_place {
    uint32_t triangle;
    float b1, b2;
} alpi_surface_place;
/// Whether a texture is read in three slots on a surface, which must have all of them: tools that
/// drop what they do not know leave the first alone, which is a map too.
bool alpi_surface_is_blended(const alp_scene *scene, const alpi_texture *texture, uint32_t surface);
/// Bilinear look-up of an image as a texture of the triangle's material has it, blended by the
/// normal where its charts overlap.
void alpi_surface_look_up(const alp_scene *scene, const alpi_texture *texture,
                          const alp_image *image, alpi_surface_place at, bool srgb, float rgba[4]);

/// Accessibility from the material's own occlusion map at a point; false where it has none.
bool alpi_surface_occlusion(const alp_scene *scene, uint32_t triangle, float b1, float b2,
                            float *accessibility);

/// Whether a set of coordinates is one of three that a shader blends, on any surface that has it:
/// charts of an earlier bake that overlap, projected and steep at their ends.
bool alpi_scene_set_is_blended(const alp_scene *scene, uint32_t set);

/// Built-in scenes (scene/builtin_*.c). `name` without "builtin:", settings after commas as
/// alp_scene_load tells.
/// @return ALP_OK; INVALID_ARGUMENT (no such scene or setting: the message lists them);
///         OUT_OF_MEMORY; CANCELLED
alp_result alpi_builtin_create(alp_context *context, const char *name, alp_scene **scene);

#endif
