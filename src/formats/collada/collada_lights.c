// SPDX-License-Identifier: MIT
// Lights and cameras. COLLADA's lights are those of fixed-function graphics: a colour that a facing
// white surface shows, times 1 / (c + l d + q d²) in the file's unit. Ours is E = I / d² in W/m²:
// a surface of albedo ρ shows ρ E / π, so a colour C is E = π C.
// Barnes, Finch. COLLADA – Digital Asset Schema Release 1.4.1, 2nd edition. Khronos, 2008: <point>,
// <spot>, <directional>, <ambient>, <perspective>.
#include "formats/collada/collada_read.h"

#include "base/memory.h"
#include "formats/collada/collada_numbers.h"
#include "scene/lights/light_kinds.h"

#include <math.h>

// --- lights --------------------------------------------------------------------------------------

static alp_result read_member(const alpi_collada_reader *reader, const xmlNode *element,
                              const char *name, double *value)
{
    const xmlNode *member = alpi_xml_child(element, name);
    return member == NULL ? ALP_OK : alpi_collada_doubles(reader->document, member, 1, value);
}

static alp_result read_color(const alpi_collada_reader *reader, const xmlNode *element,
                             alpi_light *light)
{
    const double most = 1e10; // sums of more overflow
    double color[3] = {1.0, 1.0, 1.0};
    const xmlNode *member = alpi_xml_child(element, "color");
    if (member != NULL) {
        ALP_TRY(alpi_collada_doubles(reader->document, member, 3, color));
    }
    for (int k = 0; k < 3; k++) {
        color[k] = fmin(fmax(color[k], 0.0), most);
    }
    light->color = (vec3){(float)color[0], (float)color[1], (float)color[2]};
    return ALP_OK;
}

/// Half the diagonal of what the scene shows: the distance at which attenuation is matched.
static double middle_distance(const alp_scene *scene)
{
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (uint32_t v = 0; v < scene->vertex_count; v++) {
        for (int k = 0; k < 3; k++) {
            const double value = (double)scene->positions[v][k];
            low[k] = value < low[k] ? value : low[k];
            high[k] = value > high[k] ? value : high[k];
        }
    }
    double square = 0.0;
    for (int k = 0; k < 3 && scene->vertex_count > 0; k++) {
        square += (high[k] - low[k]) * (high[k] - low[k]);
    }
    return square > 0.0 && isfinite(square) ? 0.5 * sqrt(square) : 1.0;
}

/// Candela of a colour of 1.
static alp_result read_intensity(const alpi_collada_reader *reader, const xmlNode *element,
                                 double distance, alpi_light *light)
{
    double c = 1.0, l = 0.0, q = 0.0;
    ALP_TRY(read_member(reader, element, "constant_attenuation", &c));
    ALP_TRY(read_member(reader, element, "linear_attenuation", &l));
    ALP_TRY(read_member(reader, element, "quadratic_attenuation", &q));
    const double d = distance / reader->metres_per_unit;
    const double divisor = fmax(c, 0.0) + fmax(l, 0.0) * d + fmax(q, 0.0) * d * d;
    const double intensity = ALPI_PI * distance * distance / fmax(divisor, 1e-20);
    light->intensity = (float)fmin(intensity, 1e20);
    char owner[ALPI_COLLADA_OWNER_SIZE];
    alpi_collada_owner(reader->document, element, owner);
    alpi_warn(reader->context, "light-units", owner,
              "attenuation 1 / (%g + %g d + %g d²) has no unit: taken as %g W/sr per colour of 1, "
              "which is as bright at %g m, half the diagonal of the scene",
              c, l, q, (double)light->intensity, distance);
    return ALP_OK;
}

/// falloff_angle is the whole cone; an exponent softens it from the axis on: full within the angle
/// where cosᵉ has lost a tenth.
static alp_result read_cone(const alpi_collada_reader *reader, const xmlNode *element,
                            alpi_light *light)
{
    double angle = 180.0, exponent = 0.0;
    ALP_TRY(read_member(reader, element, "falloff_angle", &angle));
    ALP_TRY(read_member(reader, element, "falloff_exponent", &exponent));
    const double outer = fmin(fmax(0.5 * angle, 0.1), 90.0) * ALPI_PI / 180.0;
    const double inner = exponent > 0.0 ? acos(pow(0.9, 1.0 / exponent)) : outer;
    light->outer_cone = (float)outer;
    light->inner_cone = (float)fmin(inner, outer);
    return ALP_OK;
}

/// The element that makes a <light> one of a kind; NULL without any.
static const xmlNode *find_kind(const xmlNode *common, alp_light_kind *kind)
{
    for (int k = 0;; k++) {
        const char *name = alp_light_traits_of((alp_light_kind)k).name;
        const xmlNode *element = name[0] != '\0' ? alpi_xml_child(common, name) : NULL;
        if (element != NULL || name[0] == '\0') {
            *kind = (alp_light_kind)k;
            return element;
        }
    }
}

static alp_result read_light(const alpi_collada_reader *reader, const alpi_collada_fixture *at,
                             double distance, alpi_light *light, bool *usable)
{
    const xmlNode *common = alpi_xml_child(at->target, "technique_common");
    alp_light_kind kind = ALP_LIGHT_POINT;
    const xmlNode *element = find_kind(common, &kind);
    *usable = element != NULL;
    if (element == NULL) {
        char owner[ALPI_COLLADA_OWNER_SIZE];
        alpi_collada_owner(reader->document, at->target, owner);
        alpi_warn(reader->context, "light", owner,
                  alpi_xml_child(common, "ambient") != NULL
                      ? "an <ambient> light is left out: the bake computes ambient light itself"
                      : "left out: it is not a point, spot or directional light");
        return ALP_OK;
    }
    const alp_light_traits traits = alp_light_traits_of(kind);
    *light = (alpi_light){.kind = kind, .range = INFINITY};
    ALP_TRY(read_color(reader, element, light));
    if (traits.has_position) {
        ALP_TRY(read_intensity(reader, element, distance, light));
    } else {
        light->intensity = (float)ALPI_PI;
    }
    if (traits.has_cone) {
        ALP_TRY(read_cone(reader, element, light));
    }
    *usable = alpi_light_place(light, &at->world);
    if (*usable) {
        light->name = alpi_collada_copy_name(reader->context, at->target, "light");
    }
    return *usable && light->name == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

// --- cameras -------------------------------------------------------------------------------------

/// yfov, or what xfov and the aspect ratio make of it; radians, 0 without either.
static alp_result read_field_of_view(const alpi_collada_reader *reader, const xmlNode *element,
                                     double *fov)
{
    double x = 0.0, y = 0.0, aspect = 1.0;
    ALP_TRY(read_member(reader, element, "xfov", &x));
    ALP_TRY(read_member(reader, element, "yfov", &y));
    ALP_TRY(read_member(reader, element, "aspect_ratio", &aspect));
    *fov = y * ALPI_PI / 180.0;
    if (!(y > 0.0) && x > 0.0 && x < 180.0 && aspect > 0.0) {
        *fov = 2.0 * atan(tan(0.5 * x * ALPI_PI / 180.0) / aspect);
    }
    return ALP_OK;
}

static alp_result read_camera(const alpi_collada_reader *reader, const alpi_collada_fixture *at,
                              alp_camera *camera, bool *usable)
{
    static const char *const way[] = {"optics", "technique_common", "perspective", NULL};
    const xmlNode *element = alpi_xml_descend(at->target, way);
    double fov = 0.0;
    if (element != NULL) {
        ALP_TRY(read_field_of_view(reader, element, &fov));
    }
    const vec3 zero = {0.0f, 0.0f, 0.0f};
    const vec3 origin = mat4_transform_point(&at->world, zero);
    const vec3 forward =
        vec3_normalize_or(mat4_transform_direction(&at->world, (vec3){0.0f, 0.0f, -1.0f}), zero);
    const vec3 up =
        vec3_normalize_or(mat4_transform_direction(&at->world, (vec3){0.0f, 1.0f, 0.0f}), zero);
    const vec3 target = vec3_add(origin, forward);
    *usable = fov > 0.0 && fov < ALPI_PI && vec3_is_finite(target) &&
              vec3_length(vec3_sub(target, origin)) > 0.5f && // far away a step of 1 m rounds off
              vec3_length(vec3_cross(forward, up)) > 1e-4f;
    if (!*usable) {
        char owner[ALPI_COLLADA_OWNER_SIZE];
        alpi_collada_owner(reader->document, at->target, owner);
        alpi_note(reader->context, "camera", owner,
                  "left out: it is not a perspective camera, or its transform cannot be used");
        return ALP_OK;
    }
    *camera = (alp_camera){.vertical_fov = (float)fov};
    vec3_store(camera->position, origin);
    vec3_store(camera->target, target);
    vec3_store(camera->up, up);
    return ALP_OK;
}

// --- both ----------------------------------------------------------------------------------------

alp_result alpi_collada_read_fixtures(alpi_collada_reader *reader)
{
    alp_scene *scene = reader->scene;
    const double distance = middle_distance(scene);
    ALPI_TRY_NEW(reader->context, scene->lights, reader->fixture_count);
    ALPI_TRY_NEW(reader->context, scene->cameras, reader->fixture_count);
    for (uint32_t i = 0; i < reader->fixture_count; i++) {
        const alpi_collada_fixture *at = &reader->fixtures[i];
        char reason[ALPI_COLLADA_REASON_SIZE];
        bool usable = false;
        const bool is_light = alpi_xml_is(at->target, "light");
        alp_result result =
            is_light ? read_light(reader, at, distance, &scene->lights[scene->light_count], &usable)
                     : read_camera(reader, at, &scene->cameras[scene->camera_count], &usable);
        if (alpi_collada_survives(reader->document, &result, reason)) {
            usable = false;
            if (reader->bad_fixtures++ < ALPI_COLLADA_TOLD_LIMIT) {
                alpi_warn(reader->context, "bad-fixture", reader->document->path,
                          "%s; the light or camera is left out", reason);
            }
        }
        ALP_TRY(result);
        scene->light_count += usable && is_light;
        scene->camera_count += usable && !is_light;
    }
    return ALP_OK;
}
