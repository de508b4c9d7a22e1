// SPDX-License-Identifier: MIT
// A scene: triangles in world space with materials, lights and cameras. Immutable once made, but
// for alp_scene_set_metals and alp_scene_load_normal_maps.
#ifndef ALPENGLOW_SCENE_H
#define ALPENGLOW_SCENE_H

#include <alpenglow/context.h>

ALP_BEGIN_DECLS

/// Metres, right-handed, +Y up. Triangles wind counter-clockwise seen from outside. Calls that take
/// a scene run on the context that made it: one at a time.
typedef struct alp_scene alp_scene;

/// Reads a scene file (.gltf, .glb, .obj, .dae, .zae) or makes a built-in scene: "builtin:cornell",
/// "builtin:furnace", "builtin:bowl", "builtin:sphere-plane", "builtin:torus-plane",
/// "builtin:teapot-room", "builtin:windows", "builtin:atrium", "builtin:terrain".
///
/// Two built-in scenes take a size, met to 15 %:
///   "builtin:atrium,triangles=N"    20000 to 4000000, default 50000
///   "builtin:terrain,triangles=N"   5000 to 4000000, default 60000; `,trees=N` is 0 to 20000,
///                                   default by size
/// Faults of the file that can be repaired are warned of in the context's log.
/// @return ALP_OK; IO; INVALID_ARGUMENT (no such built-in scene or setting); INVALID_DATA
///         (malformed: names file, object and fault); UNSUPPORTED (a required extension, or a file
///         format that is not read); LIMIT; OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_scene_load(alp_context *context, const char *path,
                                                alp_scene **scene);

/// Reads one of the scenes of a file that holds several.
/// @param choice its number from 0, or its name; NULL = the file's default scene, as alp_scene_load
/// @return as alp_scene_load; INVALID_ARGUMENT also for no such scene (the message lists them), or
///         a choice in a file of one scene
ALP_API ALP_NODISCARD alp_result alp_scene_load_choice(alp_context *context, const char *path,
                                                       const char *choice, alp_scene **scene);

/// Whether the file at `path` is one that the asset of a scene names: a buffer, a picture or a
/// material library. Whoever writes files beside a scene spares those. Links are followed. The
/// asset itself is none.
/// @return false also where there is no file; true where memory does not suffice to find out
ALP_API bool alp_scene_refers_to(const alp_scene *scene, const char *path);

/// No item of an array: an index that is none.
#define ALP_NONE UINT32_MAX

/// An animation of a glTF.
typedef struct alp_animation_info {
    const char *name;  ///< "" without one; owned by the scene
    double seconds;    ///< of its last key; 0 without a channel that is read
    uint32_t channels; ///< that are read
} alp_animation_info;
/// @param index < animations of alp_scene_get_info, else a zeroed struct with an empty name
ALP_API alp_animation_info alp_scene_get_animation(const alp_scene *scene, uint32_t index);

/// The first animation of this name, else the one of this number from 0.
/// @return ALP_NONE: there is none such
ALP_API uint32_t alp_scene_find_animation(const alp_scene *scene, const char *choice);

/// Makes a scene whose nodes stand where an animation of the file places them, with their meshes,
/// lights and cameras. Joints of skins and weights of morph targets follow. Rotations are
/// interpolated on the sphere. Before the first key a node has its first value, after the last key
/// the last one. Members that no channel moves stay as the file has them.
///
/// Surfaces, triangles, vertices, materials and images have the same numbers in both scenes, which
/// share document and images. The origin of alp_scene_info is the same. The corners of a triangle
/// have another order where the sign of its surface's determinant differs. Faulty channels are left
/// out; reading the file has warned of them. Normal maps are those that `scene` has loaded.
/// @param animation < animations of alp_scene_get_info
/// @param seconds   since the beginning of the animation; finite
/// @param posed     out, which the caller destroys, before or after `scene`; NULL on failure
/// @return ALP_OK; INVALID_ARGUMENT; INVALID_DATA or LIMIT as alp_scene_load; OUT_OF_MEMORY;
///         CANCELLED
ALP_API ALP_NODISCARD alp_result alp_scene_pose(const alp_scene *scene, uint32_t animation,
                                                double seconds, alp_scene **posed);

/// A mesh as arrays, in world space.
typedef struct alp_mesh {
    const char *name;        ///< NULL = "mesh N"
    const float *positions;  ///< [vertex_count][3] metres
    const float *normals;    ///< [vertex_count][3] unit, or NULL: flat normals of the triangles
    const float *uvs;        ///< [vertex_count][2] lightmap coordinates in [0,1], or NULL
    const uint32_t *indices; ///< [triangle_count][3], each < vertex_count
    uint32_t vertex_count;
    uint32_t triangle_count;
    float base_color[3]; ///< linear diffuse colour, [0, 1] (clamped with a warning)
    bool double_sided;
    float emission[3]; ///< radiance that it emits, W·sr⁻¹·m⁻², ≥ 0 (clamped with a warning)
} alp_mesh;

/// Makes a scene from arrays, which are copied. `uvs` become the scene's second UV set, for
/// ALP_ATLAS_KEEP.
/// @return ALP_OK; INVALID_ARGUMENT (NULL array); INVALID_DATA (index out of range); OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_scene_create_from_meshes(alp_context *context,
                                                              const alp_mesh *meshes,
                                                              uint32_t mesh_count,
                                                              alp_scene **scene);

/// Makes a scene with fewer triangles, for light that is sampled coarsely. Each surface is
/// simplified alone by meshoptimizer. Materials, lights, cameras and images are copied. Triangles
/// have other numbers; surfaces keep theirs. Borders of surfaces that touch others stay. A surface
/// of many small parts, such as leaves, keeps 80 % of its area, with less error or as it is.
/// @param error  metres that surfaces move at most, by the simplifier's own measure; > 0
/// @param simple out, which the caller destroys; NULL on failure
/// @return ALP_OK; INVALID_ARGUMENT; OUT_OF_MEMORY; CANCELLED
ALP_API ALP_NODISCARD alp_result alp_scene_simplify(const alp_scene *scene, float error,
                                                    alp_scene **simple);

ALP_API void alp_scene_destroy(alp_scene *scene); ///< NULL does nothing

/// Light that a metal reflects. Every surface is diffuse here, and a metal has no diffuse colour.
typedef enum alp_metals {
    ALP_METALS_DIFFUSE = 0, ///< albedo = base colour, as of other materials: about what it reflects
    ALP_METALS_BLACK = 1    ///< albedo = base colour × (1 − metallic)
} alp_metals;

/// Sets how metals count in all light, coloured obscurance and albedo of the scene from now on, and
/// in colours of files for three.js and Babylon.js and of .obj. Default DIFFUSE. Not during another
/// call with the scene. NULL and unknown values do nothing.
///
/// Viewers that multiply a light map by their own diffuse colour show metals black whatever is
/// baked. ALP_LIGHTMAP_AS_EMISSIVE and units of radiance hold the reflected light itself.
ALP_API void alp_scene_set_metals(alp_scene *scene, alp_metals metals);

/// Counts, bounds and unit of a scene.
typedef struct alp_scene_info {
    uint32_t triangles;        ///< all triangles, degenerate ones included
    uint32_t usable_triangles; ///< triangles with area and finite coordinates
    uint32_t surfaces;         ///< one for each pair of node and primitive
    uint32_t vertices;         ///< in world space, with those of generated flat normals
    uint32_t materials, images, cameras, lights, animations;
    float bounds_min[3], bounds_max[3]; ///< metres, over usable triangles; 0 without any
    double area;                        ///< square metres, one side, over usable triangles
    double unit_metres; ///< metres of one unit of the file; lengths were multiplied by it
    bool unit_stated;   ///< the file or its format states the unit; else metres were assumed
    char up_axis; ///< of a COLLADA: 'X', 'Y' or 'Z'; 0 = not stated. The scene itself is +Y up.
    /// World of the file = origin + scene, in metres. 0 unless the file's coordinates are so far
    /// that floats lose detail, such as those of a national grid. Bounds, cameras, lights, and
    /// points, cameras and lamps that the caller gives are positions in the scene.
    double origin[3];
    uint64_t hash; ///< of the bytes of its files and its pose, or of the arrays it was made of
    /// Materials of a glTF that name a light map for viewers: MOZ_lightmap or extras.lightmap.
    /// Only alp_scene_compare_maps and alp_scene_read_light_maps read such maps.
    uint32_t light_maps;
} alp_scene_info;
ALP_API alp_scene_info alp_scene_get_info(const alp_scene *scene);

/// Reads the light maps that the materials of a glTF name (MOZ_lightmap, else extras.lightmap), and
/// keeps them with the scene for ALP_RENDER_LIGHTMAP. Without any, it keeps that there is none. A
/// second call does nothing. Values of MOZ_lightmap are taken as irradiance; extras state theirs.
/// @return ALP_OK; INVALID_ARGUMENT; IO, INVALID_DATA, UNSUPPORTED, LIMIT (an image); OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_scene_read_light_maps(alp_scene *scene);

/// One surface: a primitive placed in the world by a node.
typedef struct alp_surface_info {
    const char *name;     ///< name of its node, else of its mesh; owned by the scene
    const char *material; ///< name of its material, "" without one; owned by the scene
    uint32_t first_triangle, triangle_count;
    uint32_t uv_sets; ///< number of its texture coordinate sets
    bool double_sided, mirrored, normals_generated;
    float emission[3];       ///< radiance of its material, W·sr⁻¹·m⁻², before its texture
    uint32_t material_index; ///< of its material (alpenglow/geometry.h); ALP_NONE without one
    uint32_t uv_slots;       ///< bit n: it has the coordinates of slot n of alp_geometry.uvs
    /// The x, y and z axis of its object in the world, of any length: a normal n of the world has
    /// the components n · axes[k] in the object, before it is normalised. The axes of the world
    /// where joints place the object, or where its axes are nearly in one plane.
    float axes[3][3];
} alp_surface_info;
/// @param index < surfaces, else a zeroed struct with empty names and material_index ALP_NONE
ALP_API alp_surface_info alp_scene_get_surface(const alp_scene *scene, uint32_t index);

typedef enum alp_light_kind {
    ALP_LIGHT_POINT = 0,      ///< intensity in candela
    ALP_LIGHT_SPOT = 1,       ///< intensity in candela
    ALP_LIGHT_DIRECTIONAL = 2 ///< intensity in lux
} alp_light_kind;

/// Properties of a kind of light. Fields of alp_light_info that its kind does not have are unused.
typedef struct alp_light_traits {
    const char *name;   ///< "point", "spot", "directional"; static
    const char *unit;   ///< of the intensity: "candela" or "lux"; static
    bool has_position;  ///< and a range
    bool has_direction; ///< along which its light travels
    bool has_cone;      ///< inner and outer, about the direction
    bool has_size;      ///< an angle that its disk fills in the sky
} alp_light_traits;
/// @param kind else than those of the enumeration: a zeroed struct with empty names
ALP_API alp_light_traits alp_light_traits_of(alp_light_kind kind);

/// A punctual light of the file.
typedef struct alp_light_info {
    const char *name; ///< owned by the scene
    alp_light_kind kind;
    float intensity;                 ///< candela or lux by kind, per channel times `color`
    float color[3];                  ///< linear
    float position[3], direction[3]; ///< metres; unit, the way light travels
    float range;                     ///< metres, INFINITY = none
    float inner_cone, outer_cone;    ///< spot: radians from its axis
    float size; ///< directional: full angle of its disk, radians; 0 = a point, unless
                ///< alp_lighting_options.file_sun_size widens it
} alp_light_info;
/// @param index < lights, else a zeroed struct with an empty name
ALP_API alp_light_info alp_scene_get_light(const alp_scene *scene, uint32_t index);

/// A pinhole camera.
typedef struct alp_camera {
    float position[3];  ///< metres
    float target[3];    ///< a point on the view axis, not the position
    float up[3];        ///< not parallel to the view axis
    float vertical_fov; ///< full angle in radians, (0, π)
} alp_camera;
/// Camera `index` of the scene. With index ≥ cameras, the usual view of an object: from above a
/// corner of the bounding box towards its centre. If more area faces the centre than faces away, it
/// is a room, and the camera is inside the box. Surfaces in the way are ignored, so the view into
/// an open box may be blocked; alp_render tries more places and may choose another. Cost: one pass
/// over the triangles.
ALP_API alp_camera alp_scene_get_camera(const alp_scene *scene, uint32_t index);

ALP_END_DECLS

#endif
