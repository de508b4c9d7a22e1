// SPDX-License-Identifier: MIT
// The doctor: faults of a scene that will be visible in its bake, and their remedies.
#ifndef ALPENGLOW_DOCTOR_H
#define ALPENGLOW_DOCTOR_H

#include <alpenglow/image.h>
#include <alpenglow/scene.h>

ALP_BEGIN_DECLS

/// A message of the log; see alp_log_message. NULL counts as "".
typedef struct alp_report_finding {
    const char *code, *object, *text;
} alp_report_finding;

/// The findings of a scene. Opaque and immutable; made by alp_scene_diagnose. Destroy it before its
/// scene.
typedef struct alp_diagnosis alp_diagnosis;

typedef enum alp_severity {
    ALP_SEVERITY_ERROR = 0,   ///< cannot be baked
    ALP_SEVERITY_WARNING = 1, ///< the result will have a visible fault
    ALP_SEVERITY_NOTE = 2     ///< worth knowing
} alp_severity;

/// Kind of a finding. docs/manual/doctor.md has the visible effect and the remedy of each. Values
/// are never reused.
typedef enum alp_finding_kind {
    ALP_FINDING_MESSAGE = 0, ///< a message of the log without an entry of its own

    ALP_FINDING_NO_TRIANGLES = 1,     ///< no triangles, or none with area
    ALP_FINDING_BAD_COORDINATES = 2,  ///< coordinates not finite or beyond 1e15 m; left out
    ALP_FINDING_ZERO_AREA = 3,        ///< triangles that are lines or points; left out
    ALP_FINDING_DUPLICATES = 4,       ///< coincident triangles that face the same way
    ALP_FINDING_BACK_TO_BACK = 5,     ///< coincident triangles that face opposite ways
    ALP_FINDING_BAD_NORMALS = 6,      ///< normals zero or not finite; replaced by the triangle's
    ALP_FINDING_REVERSED_NORMALS = 7, ///< normals that point to the back of their triangle
    ALP_FINDING_NO_NORMALS = 8,       ///< no normals; flat ones were made
    ALP_FINDING_BACKS_SEEN = 9,       ///< single-sided surfaces that others see from behind
    ALP_FINDING_MIRRORED = 10,        ///< placed by a matrix that mirrors
    ALP_FINDING_SIZE = 11,            ///< so large or small that the unit may be another
    ALP_FINDING_PRECISION = 12,       ///< too far from the origin for floats
    ALP_FINDING_T_JUNCTIONS = 13,     ///< vertices within the open edges of other triangles
    ALP_FINDING_THIN_WALL = 14,       ///< double-sided sheets whose sides see unequal shares of sky
    ALP_FINDING_BURIED = 15,          ///< surface inside other objects
    ALP_FINDING_SCALE = 16,           ///< objects of another order of size than all others
    ALP_FINDING_COPLANAR = 17,        ///< triangles that partly overlap others in their plane
    ALP_FINDING_INSIDE_OUT = 18,      ///< double-sided solids that are wound inwards

    ALP_FINDING_NO_UVS = 30,     ///< no coordinates at all
    ALP_FINDING_UV_MISSING = 31, ///< some surfaces lack the set
    ALP_FINDING_UV_OUTSIDE = 32, ///< coordinates outside of [0, 1]
    ALP_FINDING_UV_FLAT = 33,    ///< triangles without area in the set
    ALP_FINDING_UV_OVERLAP = 34, ///< overlapping triangles in the set
    ALP_FINDING_UV_SHARED = 35,  ///< overlap between nodes of one mesh
    ALP_FINDING_UV_PADDING = 36, ///< islands without a free texel between them
    ALP_FINDING_UV_DENSITY = 37, ///< some surfaces have far more texels than others
    ALP_FINDING_UV_MIPS = 38,    ///< islands without space for a second mip level
    ALP_FINDING_UV_TINY = 39,    ///< islands smaller than a texel
    ALP_FINDING_UV_STRETCH = 40, ///< texels that are long and narrow on the surface

    ALP_FINDING_MATERIAL_RANGE = 60, ///< values that were clamped
    ALP_FINDING_WHITE = 61,          ///< an albedo that absorbs almost no light
    ALP_FINDING_METAL = 62,          ///< most of the scene is metal
    ALP_FINDING_IMAGE = 63,          ///< an image that cannot be read
    ALP_FINDING_EMISSION_OFF = 64,   ///< an emissive texture times a factor of 0
    ALP_FINDING_EMISSION_BLACK = 65, ///< an emissive factor times a black texture
    ALP_FINDING_INVISIBLE = 66,      ///< a material that is cut away everywhere
    ALP_FINDING_UNLIT = 67,          ///< a material that viewers draw without light and occlusion

    ALP_FINDING_NO_LIGHT = 90,         ///< no light at all
    ALP_FINDING_LIGHT_INSIDE = 91,     ///< a lamp inside something
    ALP_FINDING_LIGHT_ON_SURFACE = 92, ///< a lamp in a surface
    ALP_FINDING_CLOSED_ROOM = 93,      ///< a room that no sky reaches
    ALP_FINDING_LIGHT_VALUES = 94,     ///< values that were corrected
    ALP_FINDING_LIGHT_OFF = 95,        ///< an intensity or colour of 0
    ALP_FINDING_LIGHT_STRONG = 96,     ///< brighter than real lamps and suns
    ALP_FINDING_LIGHT_RANGE = 97       ///< a range that ends before the first surface
} alp_finding_kind;

/// Subject of a finding.
typedef enum alp_finding_place {
    ALP_PLACE_SCENE = 0,
    ALP_PLACE_SURFACE = 1,
    ALP_PLACE_MATERIAL = 2,
    ALP_PLACE_LIGHT = 3,
    ALP_PLACE_UV_SET = 4, ///< a set over all surfaces
    ALP_PLACE_MESSAGE = 5 ///< the object of a log message, in `name`; without index
} alp_finding_place;

/// The worst place of a finding.
typedef struct alp_finding_spot {
    bool known; ///< false: there is none, and the other fields have no meaning
    uint32_t surface;
    uint32_t triangle; ///< index within the surface
    float at[3];       ///< a point of the triangle, metres
    float uv[2];       ///< findings of a UV set: a point of the set; else NAN
} alp_finding_spot;

/// One finding. Its texts are English, without a full stop, never NULL, and owned by the diagnosis.
typedef struct alp_finding {
    alp_finding_kind kind;
    const char *code; ///< short stable name: "uv-overlap"
    alp_severity severity;
    alp_finding_place place;
    uint32_t index;   ///< of the surface, material, light or UV set; else 0
    const char *name; ///< name of the subject, or of the file
    uint64_t count;   ///< number of triangles, surfaces, …; 0 if none are counted
    double value;     ///< measured value, defined in docs/manual/doctor.md; NAN without one
    const char *what; ///< the fault
    const char *seen; ///< its visible effect; "" if unknown
    const char *todo; ///< its remedy; "" if unknown
    alp_finding_spot spot;
} alp_finding;

/// Quality of a set of texture coordinates for a bake, over all surfaces with usable triangles.
/// Measured on a page of page_size² texels (see alp_diagnosis_options).
typedef struct alp_uv_set_info {
    uint32_t set;                        ///< n of TEXCOORD_n, from 0
    uint32_t surfaces, missing_surfaces; ///< surfaces with the set, and without it
    uint32_t triangles;                  ///< usable triangles with the set
    uint32_t outside_triangles;          ///< triangles out of [0, 1]
    uint32_t flat_triangles;             ///< triangles without area in the set
    uint32_t overlapping_triangles;      ///< at least so many of those inside [0, 1] overlap
    uint32_t islands;                    ///< parts connected both in space and in the set
    uint32_t touching_islands;           ///< islands without a free texel to another one
    double coverage;                     ///< share of the unit square in use, [0, 1]
    double overlap;                      ///< share of its texels in which triangles overlap, [0, 1]
    double shared;        ///< share of its texels in which nodes of one mesh overlap, [0, 1]
    double density_ratio; ///< √(texels per m²) of the finest over the coarsest surface, of surfaces
                          ///< with at least 1 % of the area; 1 = even
    /// Islands smaller than a texel. This and the next two fields are measured only for set 1, if
    /// it can hold a bake; else 0.
    uint32_t tiny_islands;
    uint32_t free_texels; ///< least number between two islands; page_size with one island
    /// Largest L2 stretch of surfaces with at least 1 % of the area; 1 = none.
    /// Based on: P. V. Sander et al. Texture Mapping Progressive Meshes. SIGGRAPH 2001.
    double stretch;
    bool holds_bake;    ///< set 1 meets the needs of ALP_ATLAS_KEEP
    const char *reason; ///< the reason if not; else ""
} alp_uv_set_info;

typedef struct alp_diagnosis_options {
    size_t struct_size;
    /// Messages of the context's log about this scene, [message_count]; copied. They alone have the
    /// faults that were repaired while reading. NULL (default) = none.
    const alp_report_finding *messages;
    uint32_t message_count; ///< default 0
    bool light;         ///< light will be baked: NO_LIGHT is a warning, not a note; default false
    uint32_t page_size; ///< side in texels of the page for measuring UV sets, [1, 16384];
                        ///< default 1024
    alp_progress_fn *progress; ///< NULL, or called to learn whether to go on
    void *progress_user;
} alp_diagnosis_options;
ALP_API alp_diagnosis_options alp_diagnosis_options_default(void);

/// Finds faults of a scene that a bake would make visible: geometry, texture coordinates,
/// materials, lights, and messages of the log (see options). The same scene and options give the
/// same findings for any number of workers. Call alp_scene_examine first to include its warnings of
/// light.
/// @param options   NULL = defaults
/// @param diagnosis out, which the caller destroys before the scene
/// @return ALP_OK, with or without findings; INVALID_ARGUMENT; OUT_OF_MEMORY; UNSUPPORTED (the ray
///         tracer fails); CANCELLED
/// Cost: several passes over the triangles, a sort of them (n log n, 116 bytes each meanwhile), a
/// raster of each UV set. The acceleration structure, which the scene keeps. Rays: up to 147,456;
/// up to 131,072 more with double-sided surfaces; 16 for each of up to 16,384 places of overlap.
/// Some seconds for a million triangles.
ALP_API ALP_NODISCARD alp_result alp_scene_diagnose(const alp_scene *scene,
                                                    const alp_diagnosis_options *options,
                                                    alp_diagnosis **diagnosis);
ALP_API void alp_diagnosis_destroy(alp_diagnosis *diagnosis); ///< NULL does nothing

/// Number of findings: errors first, then warnings, then notes; each by kind. NULL has none.
ALP_API uint32_t alp_diagnosis_finding_count(const alp_diagnosis *diagnosis);
/// @param index < count, else a finding of empty texts
ALP_API alp_finding alp_diagnosis_get_finding(const alp_diagnosis *diagnosis, uint32_t index);

/// Number of UV sets that any surface has, among the first four.
ALP_API uint32_t alp_diagnosis_uv_set_count(const alp_diagnosis *diagnosis);
/// @param index < count, else a zeroed struct with an empty reason
ALP_API alp_uv_set_info alp_diagnosis_get_uv_set(const alp_diagnosis *diagnosis, uint32_t index);

/// Number of pictures of the findings; 0 if there is nothing to bake. In order:
///   The scene, 960 × 720, from the place that sees most of it, in even light. Red: normals that
///   point to the back. Orange: backs of single-sided surfaces.
///   Each UV set, 1024 × 1024, row 0 is v = 0. Every island has a colour. Red: overlapping
///   triangles. Orange lines: triangles outside of the unit square, which then has a white frame
///   and up to four tiles around it. Rings: spots of findings. A close view of the worst spot of
///   each kind of finding, at most eight: its triangle in magenta, the spot ringed.
ALP_API uint32_t alp_diagnosis_picture_count(const alp_diagnosis *diagnosis);
/// Name of a picture for a file: "scene", "uv0" … "uv3", or "spot-" and the code of a finding. ""
/// past the last. Owned by the diagnosis.
ALP_API const char *alp_diagnosis_picture_name(const alp_diagnosis *diagnosis, uint32_t index);
/// Draws a picture.
/// @param image out: 8-bit RGB, which the caller destroys
/// @return ALP_OK; INVALID_ARGUMENT; OUT_OF_MEMORY; UNSUPPORTED (the ray tracer fails)
/// Cost: for the scene some seconds, as alp_render; for a set one raster.
ALP_API ALP_NODISCARD alp_result alp_diagnosis_picture(const alp_diagnosis *diagnosis,
                                                       uint32_t index, alp_image **image);

enum { ALP_UNIT_LIMIT = 9 }; ///< number of units that are tried

/// A unit that the scene may have been modelled in.
typedef struct alp_unit_guess {
    const char *name;    ///< "1 mm", "1 cm", "1 inch", "1 dm", "1 foot", "1 m", "10 m", "100 m",
                         ///< "1 km"; static
    double metres;       ///< of the unit
    double longest_side; ///< of the scene's box in that unit, metres
} alp_unit_guess;

/// Guesses the unit of the file if it is in doubt: the file states none, or the longest side of the
/// scene is above 30 m or below 0.05 m. A valley of 2 km is then in doubt too. Guesses are the
/// units, from small to large, that make the longest side 0.5 to 20 m, the size of rooms and their
/// contents.
/// @param guesses [ALP_UNIT_LIMIT], without the unit in use
/// @return number of guesses; 0 without doubt, or if no other unit gives such a size
ALP_API uint32_t alp_scene_guess_unit(const alp_scene *scene,
                                      alp_unit_guess guesses[ALP_UNIT_LIMIT]);

/// "error", "warning", "note". Static.
ALP_API const char *alp_severity_name(alp_severity severity);
/// "scene", "surface", "material", "light", "uv-set", "message". Static.
ALP_API const char *alp_finding_place_name(alp_finding_place place);

ALP_END_DECLS

#endif
