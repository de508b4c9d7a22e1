// SPDX-License-Identifier: MIT
// The doctor: what of a scene will be seen as a fault of its bake, and what to do about it.
#ifndef ALPENGLOW_DOCTOR_H
#define ALPENGLOW_DOCTOR_H

#include <alpenglow/image.h>
#include <alpenglow/scene.h>

ALP_BEGIN_DECLS

/// A message of the log as the page shows it; see alp_log_message. NULL counts as "".
typedef struct alp_report_finding {
    const char *code, *object, *text;
} alp_report_finding;

typedef struct alp_diagnosis alp_diagnosis;

typedef enum alp_severity {
    ALP_SEVERITY_ERROR = 0,   ///< cannot be baked
    ALP_SEVERITY_WARNING = 1, ///< something will look wrong
    ALP_SEVERITY_NOTE = 2     ///< worth knowing
} alp_severity;

/// What was found; docs/doctor.md tells of each what is seen and what to do. Values are never
/// reused.
typedef enum alp_finding_kind {
    ALP_FINDING_MESSAGE = 0, ///< a message of the log of which the doctor knows no more

    ALP_FINDING_NO_TRIANGLES = 1,     ///< none, or none with area
    ALP_FINDING_BAD_COORDINATES = 2,  ///< not finite, or beyond 1e15 m; left out
    ALP_FINDING_ZERO_AREA = 3,        ///< triangles that are lines or points; left out
    ALP_FINDING_DUPLICATES = 4,       ///< triangles in the place of others, facing alike
    ALP_FINDING_BACK_TO_BACK = 5,     ///< triangles in the place of others, facing away
    ALP_FINDING_BAD_NORMALS = 6,      ///< zero or not finite; the triangle's are used
    ALP_FINDING_REVERSED_NORMALS = 7, ///< normals that look to the back of their triangle
    ALP_FINDING_NO_NORMALS = 8,       ///< flat ones were made
    ALP_FINDING_BACKS_SEEN = 9,       ///< single-sided surfaces that others see from behind
    ALP_FINDING_MIRRORED = 10,        ///< placed by a matrix that mirrors
    ALP_FINDING_SIZE = 11,            ///< so large or small that the unit may be another
    ALP_FINDING_PRECISION = 12,       ///< too far from the origin for floats
    ALP_FINDING_T_JUNCTIONS = 13,     ///< vertices within the open edges of other triangles
    ALP_FINDING_THIN_WALL = 14,       ///< double-sided sheets whose sides see unlike much sky
    ALP_FINDING_BURIED = 15,          ///< surface that lies inside other objects
    ALP_FINDING_SCALE = 16,           ///< objects of another order of size than all others
    ALP_FINDING_COPLANAR = 17,        ///< triangles in the plane and partly the place of others

    ALP_FINDING_NO_UVS = 30,     ///< no coordinates at all
    ALP_FINDING_UV_MISSING = 31, ///< some surfaces lack the set that others have
    ALP_FINDING_UV_OUTSIDE = 32, ///< outside of [0, 1]
    ALP_FINDING_UV_FLAT = 33,    ///< triangles without area in the set
    ALP_FINDING_UV_OVERLAP = 34, ///< triangles in one place of the set
    ALP_FINDING_UV_SHARED = 35,  ///< the same between nodes that show one mesh
    ALP_FINDING_UV_PADDING = 36, ///< islands without a free texel between them
    ALP_FINDING_UV_DENSITY = 37, ///< some surfaces have much more texels than others
    ALP_FINDING_UV_MIPS = 38,    ///< islands without space for a second mip level
    ALP_FINDING_UV_TINY = 39,    ///< islands smaller than a texel
    ALP_FINDING_UV_STRETCH = 40, ///< texels that are long and narrow on the surface

    ALP_FINDING_MATERIAL_RANGE = 60, ///< values that were clamped
    ALP_FINDING_WHITE = 61,          ///< an albedo that hardly takes any light
    ALP_FINDING_METAL = 62,          ///< most of the scene is metal
    ALP_FINDING_IMAGE = 63,          ///< an image that cannot be read
    ALP_FINDING_EMISSION_OFF = 64,   ///< an emissive texture times a factor of 0
    ALP_FINDING_EMISSION_BLACK = 65, ///< an emissive factor times a black texture
    ALP_FINDING_INVISIBLE = 66,      ///< a material that is cut away everywhere

    ALP_FINDING_NO_LIGHT = 90,         ///< nothing gives light
    ALP_FINDING_LIGHT_INSIDE = 91,     ///< a lamp inside something
    ALP_FINDING_LIGHT_ON_SURFACE = 92, ///< a lamp in a surface
    ALP_FINDING_CLOSED_ROOM = 93,      ///< where no sky gets in
    ALP_FINDING_LIGHT_VALUES = 94,     ///< values that were set right
    ALP_FINDING_LIGHT_OFF = 95,        ///< an intensity or colour of 0
    ALP_FINDING_LIGHT_STRONG = 96,     ///< brighter than lamps and suns are
    ALP_FINDING_LIGHT_RANGE = 97       ///< a range that ends before the first surface
} alp_finding_kind;

/// What a finding is about.
typedef enum alp_finding_place {
    ALP_PLACE_SCENE = 0,
    ALP_PLACE_SURFACE = 1,
    ALP_PLACE_MATERIAL = 2,
    ALP_PLACE_LIGHT = 3,
    ALP_PLACE_UV_SET = 4, ///< over all surfaces
    ALP_PLACE_MESSAGE = 5 ///< what the log called `name`; it has no index
} alp_finding_place;

/// The worst place of a finding.
typedef struct alp_finding_spot {
    bool known; ///< false: it has none, and the rest says nothing
    uint32_t surface;
    uint32_t triangle; ///< of the surface
    float at[3];       ///< a point there, metres
    float uv[2];       ///< of findings of a UV set: a point of the set, else NAN
} alp_finding_spot;

/// One finding. Texts are owned by the diagnosis, in English, never NULL, without a full stop.
typedef struct alp_finding {
    alp_finding_kind kind;
    const char *code; ///< short stable name: "uv-overlap"
    alp_severity severity;
    alp_finding_place place;
    uint32_t index;   ///< of the surface, material, light or UV set; else 0
    const char *name; ///< of it, or of the file
    uint64_t count;   ///< how many triangles, surfaces, …; 0 where nothing is counted
    double value;     ///< what was measured (docs/doctor.md says what); NAN where nothing is
    const char *what; ///< what is wrong
    const char *seen; ///< what will be seen; "" where nobody knows
    const char *todo; ///< what to do; "" where nobody knows
    alp_finding_spot spot;
} alp_finding;

/// A set of texture coordinates as a place for a bake, over all surfaces with usable triangles.
/// Measured on a page of page_size² texels (see alp_diagnosis_options).
typedef struct alp_uv_set_info {
    uint32_t set;                               ///< n of TEXCOORD_n, from 0
    uint32_t surfaces, missing_surfaces;        ///< that have it, that do not
    uint32_t triangles;                         ///< usable ones that have it
    uint32_t outside_triangles, flat_triangles; ///< out of [0, 1]; without area in it
    uint32_t overlapping_triangles;             ///< of those inside [0, 1], at least so many
    uint32_t islands;                           ///< connected in space and in the set
    uint32_t touching_islands;                  ///< without a free texel to another one
    double coverage;      ///< share of the unit square that holds something, [0, 1]
    double overlap;       ///< share of its texels in which triangles overlap, [0, 1]
    double shared;        ///< share of those texels where nodes of one mesh do
    double density_ratio; ///< √ of texels per m² of the finest over the coarsest surface (of those
                          ///< with 1 % of the area or more); 1 = even
    uint32_t tiny_islands; ///< smaller than a texel; like the two below of set 1 alone, and only
                           ///< where it holds a bake, else 0
    uint32_t free_texels;  ///< least between two islands; page_size where there is but one
    double stretch;     ///< L2 stretch of the surface that has most, of those with 1 % of the area;
                        ///< 1 = none. Sander et al., Texture Mapping Progressive Meshes, 2001
    bool holds_bake;    ///< what ALP_ATLAS_KEEP asks of set 1
    const char *reason; ///< why it does not, "" where it does
} alp_uv_set_info;

typedef struct alp_diagnosis_options {
    size_t struct_size;
    const alp_report_finding *messages; ///< [message_count], warnings that the context's log heard
                                        ///< of this scene: what was set right in reading is known
                                        ///< by them alone; copied. NULL (default) = none
    uint32_t message_count;             ///< default 0
    bool light; ///< light is to be baked: NO_LIGHT is a warning then, not a note; default false
    uint32_t page_size; ///< side of the page that UV sets are measured on, texels, 1 to 16384;
                        ///< default 1024
    alp_progress_fn *progress; ///< NULL, or asked whether to go on
    void *progress_user;
} alp_diagnosis_options;
ALP_API alp_diagnosis_options alp_diagnosis_options_default(void);

/// Makes a diagnosis (alp_diagnosis: immutable, to be destroyed before its scene).
/// Looks for what will go wrong with a bake of the scene: geometry, texture coordinates, materials,
/// lights, and what was told before (see options). The same scene and options give the same
/// findings on any number of workers. alp_scene_examine looks at the light that gets in, by rays,
/// and tells the log: call it first, to have its messages here.
/// @param options NULL = defaults
/// @return ALP_OK, whatever was found; INVALID_ARGUMENT; OUT_OF_MEMORY; UNSUPPORTED (the ray tracer
///         fails); CANCELLED
/// Cost: some looks at each triangle, a sort of them (n log n, and 116 bytes each for a while), a
/// raster of each UV set, the acceleration structure, which the scene keeps, and rays: up to
/// 147,456, as many as 131,072 more where surfaces are double-sided, and 16 for each of up to 4,096
/// places where triangles overlap; some seconds for a million triangles.
ALP_API ALP_NODISCARD alp_result alp_scene_diagnose(const alp_scene *scene,
                                                    const alp_diagnosis_options *options,
                                                    alp_diagnosis **diagnosis);
ALP_API void alp_diagnosis_destroy(alp_diagnosis *diagnosis); ///< NULL does nothing

/// Findings, errors first, then warnings, then notes, of those by kind. NULL has none.
ALP_API uint32_t alp_diagnosis_finding_count(const alp_diagnosis *diagnosis);
/// @param index < count, else a finding of empty texts
ALP_API alp_finding alp_diagnosis_get_finding(const alp_diagnosis *diagnosis, uint32_t index);

/// The sets that any surface has, of the first four.
ALP_API uint32_t alp_diagnosis_uv_set_count(const alp_diagnosis *diagnosis);
/// @param index < count, else a zeroed struct with an empty reason
ALP_API alp_uv_set_info alp_diagnosis_get_uv_set(const alp_diagnosis *diagnosis, uint32_t index);

/// Pictures of what was found: 0 is the scene, 960 × 720, from where most of it is seen, its
/// colours in even light; red: normals that look to the back, orange: backs of single-sided
/// surfaces. Then the UV sets in their order, 1024 × 1024, row 0 is v = 0: islands in colours of
/// their own, red where triangles overlap; orange lines are triangles outside of the unit square,
/// which then is framed in white, with up to four tiles around it; spots of findings are ringed.
/// Then the worst spot of each kind of finding that has one in the scene, at most eight, from
/// nearby: its triangle in magenta, the spot ringed. None where there is nothing to bake.
ALP_API uint32_t alp_diagnosis_picture_count(const alp_diagnosis *diagnosis);
/// "scene", "uv0" … "uv3", "spot-" and the code of a finding: to name a file by. "" past the last.
/// Owned by the diagnosis.
ALP_API const char *alp_diagnosis_picture_name(const alp_diagnosis *diagnosis, uint32_t index);
/// @param image out: 8-bit RGB, which the caller destroys
/// @return ALP_OK; INVALID_ARGUMENT; OUT_OF_MEMORY; UNSUPPORTED (the ray tracer fails)
/// Cost: of the scene some seconds, as alp_render takes; of a set a raster.
ALP_API ALP_NODISCARD alp_result alp_diagnosis_picture(const alp_diagnosis *diagnosis,
                                                       uint32_t index, alp_image **image);

enum { ALP_UNIT_LIMIT = 9 }; ///< how many units are tried

/// A unit that the scene may have been meant in.
typedef struct alp_unit_guess {
    const char *name;    ///< "1 mm", "1 cm", "1 inch", "1 dm", "1 foot", "1 m", "10 m", "100 m",
                         ///< "1 km"; static
    double metres;       ///< of the unit
    double longest_side; ///< of the scene's box in that unit, metres
} alp_unit_guess;

/// What else the unit of the file may be, by the size that it gives: units, from small to large, in
/// which the longest side of the scene is between 0.5 and 20 m, as of rooms and of what stands in
/// them. Asked where the one that was taken is in doubt: the file states none, or the longest side
/// is above 30 m or below 0.05 m. A valley of 2 km is in doubt too: it is a guess.
/// @param guesses [ALP_UNIT_LIMIT]; the unit that was taken is not among them
/// @return how many; 0 where there is no doubt, no other unit gives such a size, or nothing has one
ALP_API uint32_t alp_scene_guess_unit(const alp_scene *scene,
                                      alp_unit_guess guesses[ALP_UNIT_LIMIT]);

/// "error", "warning", "note". Static.
ALP_API const char *alp_severity_name(alp_severity severity);
/// "scene", "surface", "material", "light", "uv-set", "message". Static.
ALP_API const char *alp_finding_place_name(alp_finding_place place);

ALP_END_DECLS

#endif
