// SPDX-License-Identifier: MIT
// Parts of the headers of alpenglow that the module uses, for cffi. "..." stands for parts that the
// C compiler fills in; flat_ functions are those of flat.h.

// result.h, context.h
typedef int32_t alp_result;
#define ALP_OK 0
const char *alp_result_name(alp_result result);
typedef struct alp_context alp_context;
typedef enum alp_log_level { ALP_LOG_NOTE, ALP_LOG_WARNING, ... } alp_log_level;
typedef struct alp_log_message {
    alp_log_level level;
    const char *code, *object, *text;
    ...;
} alp_log_message;
typedef void alp_log_fn(void *user, const alp_log_message *message);
typedef struct alp_progress {
    const char *stage;
    uint64_t done, total;
    double rays_per_second, seconds_left;
    ...;
} alp_progress;
typedef bool alp_progress_fn(void *user, const alp_progress *progress);
typedef struct alp_context_options {
    uint32_t worker_count;
    alp_log_fn *log;
    bool read_outside;
    ...;
} alp_context_options;
alp_context_options alp_context_options_default(void);
alp_result alp_context_create(const alp_context_options *options, alp_context **context);
void alp_context_destroy(alp_context *context);
const char *alp_context_message(const alp_context *context);
uint32_t alp_context_worker_count(const alp_context *context);
const char *alp_version(void);
extern "Python" bool alpenglow_progress(void *user, const alp_progress *progress);
extern "Python" void alpenglow_log(void *user, const alp_log_message *message);

// image.h
typedef struct alp_image alp_image;
typedef enum alp_component { ALP_COMPONENT_U8, ALP_COMPONENT_FLOAT, ... } alp_component;
typedef struct alp_image_info {
    uint32_t width, height, channels;
    alp_component component;
    ...;
} alp_image_info;
alp_result alp_image_create(alp_context *context, alp_image_info info, alp_image **image);
void alp_image_destroy(alp_image *image);
alp_image_info alp_image_get_info(const alp_image *image);
uint8_t *alp_image_bytes(alp_image *image);
float *alp_image_floats(alp_image *image);
alp_result alp_image_load(alp_context *context, const char *path, alp_image **image);
alp_result alp_image_save(const alp_image *image, const char *path, bool overwrite);

// scene.h
typedef struct alp_scene alp_scene;
typedef struct alp_mesh {
    const char *name;
    const float *positions, *normals, *uvs;
    const uint32_t *indices;
    uint32_t vertex_count, triangle_count;
    float base_color[3];
    bool double_sided;
    float emission[3];
    ...;
} alp_mesh;
alp_result alp_scene_load(alp_context *context, const char *path, alp_scene **scene);
alp_result alp_scene_create_from_meshes(alp_context *context, const alp_mesh *meshes,
                                        uint32_t mesh_count, alp_scene **scene);
void alp_scene_destroy(alp_scene *scene);
typedef struct alp_scene_info {
    uint32_t triangles, usable_triangles, surfaces, vertices;
    uint32_t materials, images, cameras, lights, animations;
    float bounds_min[3], bounds_max[3];
    double area, unit_metres;
    double origin[3];
    uint64_t hash;
    ...;
} alp_scene_info;
alp_scene_info alp_scene_get_info(const alp_scene *scene);
const float *flat_positions(const alp_scene *scene);
const float *flat_normals(const alp_scene *scene);
const uint32_t *flat_triangles(const alp_scene *scene);

// light.h
#define ALP_BOUNCES_CONVERGE ...
typedef enum alp_sky_kind {
    ALP_SKY_NONE, ALP_SKY_CONSTANT, ALP_SKY_HEMISPHERE, ALP_SKY_IMAGE, ALP_SKY_CLEAR, ...
} alp_sky_kind;
typedef struct alp_sky_options {
    alp_sky_kind kind;
    float up[3], down[3];
    const alp_image *image;
    ...;
} alp_sky_options;
typedef struct alp_sun_options {
    float azimuth, elevation, illuminance;
    float size;
    ...;
} alp_sun_options;
typedef struct alp_lamp {
    float position[3];
    float intensity;
    float color[3];
    ...;
} alp_lamp;
alp_lamp alp_lamp_default(void);
typedef struct alp_lighting_options {
    alp_sky_options sky;
    alp_sun_options sun;
    float file_sun_size;
    const alp_lamp *lamps;
    uint32_t lamp_count;
    ...;
} alp_lighting_options;

// atlas.h, lightmap.h
typedef struct alp_atlas alp_atlas;
typedef enum alp_atlas_mode { ALP_ATLAS_AUTO, ALP_ATLAS_KEEP, ALP_ATLAS_CHARTS, ... } alp_atlas_mode;
typedef struct alp_atlas_options {
    alp_atlas_mode mode;
    uint32_t size;
    double texels_per_metre;
    ...;
} alp_atlas_options;
typedef struct alp_atlas_info {
    uint32_t pages, width, height, charts;
    uint64_t texels;
    double utilisation, texels_per_metre;
    ...;
} alp_atlas_info;
alp_atlas_info alp_atlas_get_info(const alp_atlas *atlas);
const float *alp_atlas_corner_uvs(const alp_atlas *atlas);
const uint32_t *alp_atlas_triangle_pages(const alp_atlas *atlas);
typedef enum alp_map {
    ALP_MAP_AO, ALP_MAP_BENT, ALP_MAP_LIGHT, ALP_MAP_OBSCURANCE, ALP_MAP_DIRECTION, ...
} alp_map;
typedef struct alp_lightmap alp_lightmap;
void alp_lightmap_destroy(alp_lightmap *lightmap);
uint32_t alp_lightmap_page_count(const alp_lightmap *lightmap);
const float *alp_lightmap_map_page(const alp_lightmap *lightmap, alp_map map, uint32_t page,
                                   uint32_t *width, uint32_t *height);
const alp_atlas *alp_lightmap_atlas(const alp_lightmap *lightmap);

// bake.h
typedef enum alp_lightmap_as {
    ALP_LIGHTMAP_AS_NONE, ALP_LIGHTMAP_AS_EMISSIVE, ALP_LIGHTMAP_AS_MOZ, ALP_LIGHTMAP_AS_EXTRAS,
    ALP_LIGHTMAP_AS_THREE, ALP_LIGHTMAP_AS_BABYLON, ...
} alp_lightmap_as;
typedef struct alp_occlusion_options {
    uint32_t samples;
    float distance;
    uint64_t seed;
    ...;
} alp_occlusion_options;
typedef struct alp_light_options {
    alp_lighting_options lighting;
    uint32_t bounces;
    float error;
    bool bounded;
    uint32_t samples;
    ...;
} alp_light_options;
typedef struct alp_sampling_options {
    float error;
    ...;
} alp_sampling_options;
typedef struct alp_bake_options {
    alp_atlas_options atlas;
    alp_occlusion_options occlusion;
    alp_light_options light;
    alp_sampling_options sampling;
    unsigned maps;
    alp_lightmap_as lightmap_as;
    bool overwrite;
    const char *only, *output, *maps_folder;
    alp_progress_fn *progress;
    ...;
} alp_bake_options;
alp_bake_options alp_bake_options_default(void);
typedef struct alp_bake_report {
    alp_scene_info scene;
    alp_atlas_info atlas;
    float ao_distance;
    uint32_t ao_samples;
    uint64_t traced, interpolated, dropped;
    double ao_relative_error, ao_p99_error;
    double ao_mean, light_mean, light_relative_error, light_p99_error;
    uint32_t light_samples, light_passes, light_rounds;
    bool light_bounded;
    double seconds_atlas, seconds_build, seconds_bake, seconds_seams, seconds_write, seconds_total;
    uint64_t rays;
    uint32_t surfaces_baked, threads;
    uint64_t seed, input_hash, peak_memory_bytes;
    ...;
} alp_bake_report;
alp_result alp_bake(const alp_scene *scene, const alp_bake_options *options,
                    alp_lightmap **lightmap, alp_bake_report *report);

// field.h, probes.h
typedef struct alp_field alp_field;
void alp_field_destroy(alp_field *field);
void flat_irradiance(const alp_field *field, uint32_t count, const float *positions,
                     const float *normals, float *irradiance);
typedef struct alp_probes alp_probes;
typedef enum alp_probe_basis {
    ALP_PROBE_SH9, ALP_PROBE_SH4, ALP_PROBE_AMBIENT_CUBE, ...
} alp_probe_basis;
typedef struct alp_probe_options {
    float spacing;
    float bounds_min[3], bounds_max[3];
    alp_probe_basis basis;
    bool visibility, direct;
    uint32_t rays;
    alp_lighting_options lighting;
    uint32_t bounces;
    bool one_sided;
    uint64_t seed;
    alp_progress_fn *progress;
    ...;
} alp_probe_options;
alp_probe_options alp_probe_options_default(void);
void flat_set_positions(alp_probe_options *options, const float *positions, uint32_t count);
alp_result alp_probes_bake(const alp_scene *scene, const alp_probe_options *options,
                           alp_probes **probes);
void alp_probes_destroy(alp_probes *probes);
typedef struct alp_probes_info {
    bool is_list;
    uint32_t count;
    uint32_t size[3];
    double origin[3];
    float spacing[3];
    uint32_t coefficients;
    bool visibility, direct;
    uint32_t states[4];
    float error, interpolation, mean;
    uint32_t rays;
    uint64_t bytes, scene_hash;
    ...;
} alp_probes_info;
alp_probes_info alp_probes_get_info(const alp_probes *probes);
const float *alp_probes_coefficients(const alp_probes *probes, uint32_t layer);
const uint8_t *alp_probes_states(const alp_probes *probes);
void alp_probes_position(const alp_probes *probes, uint32_t index, double position[3]);
alp_result alp_probes_save(const alp_probes *probes, const char *path, bool overwrite);
alp_result alp_probes_load(alp_context *context, const char *path, alp_probes **probes);
typedef enum alp_probe_lookup { ALP_LOOKUP_OURS, ALP_LOOKUP_THREE, ... } alp_probe_lookup;
alp_result alp_field_create_probes(const alp_probes *probes, alp_probe_lookup lookup,
                                   const double origin[3], const float *strengths,
                                   alp_field **field);
