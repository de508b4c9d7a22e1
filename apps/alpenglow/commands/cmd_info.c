// SPDX-License-Identifier: MIT
// alpenglow info: contents and faults of a scene.
#include "commands/commands.h"
#include "output.h"
#include "pictures.h"
#include "printing/findings.h"
#include "printing/report.h"
#include "printing/work.h"
#include "session.h"
#include "setup/fields.h"

#include <ctype.h>
#include <math.h>

/// Rows of a table; JSON has all.
enum { ROW_LIMIT = 20 };

static bool is_far(const alp_scene_info *i)
{
    return i->origin[0] != 0.0 || i->origin[1] != 0.0 || i->origin[2] != 0.0;
}

/// A point in the world of the file, with more digits where that is far away.
static void print_point(const alp_scene_info *i, const float p[3])
{
    const double *o = i->origin;
    printf(is_far(i) ? "%.10g %.10g %.10g" : "%g %g %g", o[0] + (double)p[0], o[1] + (double)p[1],
           o[2] + (double)p[2]);
}

static void print_scene(const char *path, const alp_scene_info *i)
{
    printf("scene      ");
    print_clean(stdout, path);
    printf("\ntriangles  %u (%u usable)\nvertices   %u\nsurfaces   %u\nmaterials  %u\n"
           "images     %u\nlights     %u\ncameras    %u\n",
           i->triangles, i->usable_triangles, i->vertices, i->surfaces, i->materials, i->images,
           i->lights, i->cameras);
    const float *low = i->bounds_min, *high = i->bounds_max;
    printf("bounds     ");
    print_point(i, low);
    printf(" to ");
    print_point(i, high);
    printf(" m\n");
    printf("size       %g x %g x %g m\n", (double)high[0] - (double)low[0],
           (double)high[1] - (double)low[1], (double)high[2] - (double)low[2]);
    printf("area       %.6g m2\n", i->area);
}

/// Prints the unit of the file, and other guesses if it is in doubt.
static void print_unit(const alp_scene *scene, const alp_scene_info *i)
{
    alp_unit_guess guesses[ALP_UNIT_LIMIT];
    const uint32_t count = alp_scene_guess_unit(scene, guesses);
    if (i->unit_stated) {
        printf("unit       %g m, as the file or its format states", i->unit_metres);
    } else {
        printf("unit       not stated; 1 m is assumed");
    }
    if (i->up_axis != '\0') {
        printf("; %c is up", tolower((unsigned char)i->up_axis));
    }
    for (uint32_t k = 0; k < count; k++) {
        printf("%s%s (longest side %.3g m)",
               k == 0          ? "; by size perhaps "
               : k + 1 < count ? ", "
                               : " or ",
               guesses[k].name, guesses[k].longest_side);
    }
    putchar('\n');
}

static json_t *make_unit(const alp_scene *scene, const alp_scene_info *i)
{
    alp_unit_guess guesses[ALP_UNIT_LIMIT];
    const uint32_t count = alp_scene_guess_unit(scene, guesses);
    const char axis[2] = {i->up_axis, '\0'};
    json_t *list = json_array();
    for (uint32_t k = 0; k < count; k++) {
        json_array_append_new(list, json_pack("{s:s, s:o, s:o}", "name", guesses[k].name, "metres",
                                              json_number(guesses[k].metres), "longest_side",
                                              json_number(guesses[k].longest_side)));
    }
    return json_pack("{s:o, s:b, s:o, s:o}", "metres", json_number(i->unit_metres), "stated",
                     (int)i->unit_stated, "up_axis",
                     i->up_axis != '\0' ? json_string(axis) : json_null(), "candidates", list);
}

/// The work of two bakes with defaults: occlusion, and light with a stated error of 1 %.
typedef struct default_work {
    alp_bake_work ao, light;
} default_work;

static alp_result estimate_work(const session *s, default_work *work)
{
    alp_bake_options options = alp_bake_options_default();
    const alp_result result = alp_bake_estimate(s->scene, &options, &work->ao);
    options.maps = ALP_MAP_LIGHT;
    options.light.error = 0.01f;
    return result == ALP_OK ? alp_bake_estimate(s->scene, &options, &work->light) : result;
}

static void print_work(const default_work *work, double area)
{
    if (work->ao.texels > 0 && area > 0.0) {
        printf("density    --size 1024 gives about %.4g texels per metre\n",
               sqrt((double)work->ao.texels / area));
        printf("bake       --maps ao: ");
        work_print(stdout, &work->ao);
        printf("bake       --maps light: ");
        work_print(stdout, &work->light);
    }
}

static void print_surfaces(const alp_scene *scene, uint32_t count)
{
    if (count == 0) {
        return;
    }
    printf("\n%10s  %7s  %-5s  %-9s  %s\n", "triangles", "uv sets", "sides", "normals",
           "surface (material)");
    for (uint32_t i = 0; i < count && i < ROW_LIMIT; i++) {
        alp_surface_info s = alp_scene_get_surface(scene, i);
        printf("%10u  %7u  %-5s  %-9s  ", s.triangle_count, s.uv_sets,
               s.double_sided ? "two" : "one", s.normals_generated ? "generated" : "given");
        print_clean(stdout, s.name);
        printf(" (");
        print_clean(stdout, s.material[0] != '\0' ? s.material : "no material");
        printf(")%s\n", s.mirrored ? ", mirrored" : "");
    }
    if (count > ROW_LIMIT) {
        printf("%10s  %u more surface%s; --json lists all\n", "and", count - ROW_LIMIT,
               plural(count - ROW_LIMIT));
    }
}

static bool is_emissive(const alp_surface_info *s)
{
    return s->emission[0] > 0.0f || s->emission[1] > 0.0f || s->emission[2] > 0.0f;
}

static void print_light_name(const alp_light_info *l, uint32_t index)
{
    if (l->name[0] != '\0') {
        print_clean(stdout, l->name);
    } else {
        printf("light %u", index); // as in warnings
    }
}

/// Position and direction of a light, as far as its kind has them.
static void print_place(const alp_scene_info *info, const alp_light_info *l,
                        const alp_light_traits *traits)
{
    const double degrees = 180.0 / M_PI;
    if (traits->has_position) {
        printf(", at ");
        print_point(info, l->position);
        printf(" m");
    }
    if (traits->has_direction) {
        printf(", towards %g %g %g", (double)l->direction[0], (double)l->direction[1],
               (double)l->direction[2]);
    }
    if (traits->has_cone) {
        printf(", cone %g inside %g degrees", (double)l->inner_cone * degrees,
               (double)l->outer_cone * degrees);
    }
    if (traits->has_size) {
        printf(", size %g degrees", (double)l->size * degrees);
    }
    if (traits->has_position && isfinite(l->range)) {
        printf(", range %g m", (double)l->range);
    }
}

static void print_lamp(const alp_scene_info *info, const alp_light_info *l, uint32_t index)
{
    const alp_light_traits traits = alp_light_traits_of(l->kind);
    printf("light      ");
    print_light_name(l, index);
    printf(", %s: %g %s, colour %g %g %g", traits.name, (double)l->intensity, traits.unit,
           (double)l->color[0], (double)l->color[1], (double)l->color[2]);
    print_place(info, l, &traits);
    putchar('\n');
}

static void print_emissive(const alp_surface_info *s)
{
    printf("light      ");
    print_clean(stdout, s->name);
    printf(", emissive: %g %g %g W/(sr m2)\n", (double)s->emission[0], (double)s->emission[1],
           (double)s->emission[2]);
}

/// Counts the lights that were not listed.
static void print_rest(uint32_t count, const char *what)
{
    if (count > ROW_LIMIT) {
        const uint32_t rest = count - ROW_LIMIT;
        printf("light      and %u more %s%s; --json lists all\n", rest, what, plural(rest));
    }
}

/// Lists lights and emissive surfaces, with units.
static void print_lights(const alp_scene *scene, const alp_scene_info *info)
{
    uint32_t emissive = 0;
    putchar('\n');
    for (uint32_t i = 0; i < info->surfaces; i++) {
        const alp_surface_info s = alp_scene_get_surface(scene, i);
        if (is_emissive(&s) && emissive++ < ROW_LIMIT) {
            print_emissive(&s);
        }
    }
    print_rest(emissive, "emissive surface");
    for (uint32_t i = 0; i < info->lights && i < ROW_LIMIT; i++) {
        const alp_light_info l = alp_scene_get_light(scene, i);
        print_lamp(info, &l, i);
    }
    print_rest(info->lights, "lamp");
    if (info->lights + emissive == 0) {
        printf("light      none; --maps light needs a --sky, a --sun or a --lamp\n");
    }
}

static void print_animations(const alp_scene *scene, uint32_t count)
{
    for (uint32_t i = 0; i < count && i < ROW_LIMIT; i++) {
        const alp_animation_info a = alp_scene_get_animation(scene, i);
        printf("%sanimation  %u ", i == 0 ? "\n" : "", i);
        print_clean(stdout, a.name[0] != '\0' ? a.name : "(no name)");
        printf(", %g s, %u channel%s\n", a.seconds, a.channels, plural(a.channels));
    }
    if (count > ROW_LIMIT) {
        printf("animation  and %u more; --json lists all\n", count - ROW_LIMIT);
    }
}

static json_t *make_animations(const alp_scene *scene, uint32_t count)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < count; i++) {
        const alp_animation_info a = alp_scene_get_animation(scene, i);
        json_array_append_new(list, json_pack("{s:o, s:o, s:I}", "name", json_text(a.name),
                                              "seconds", json_number(a.seconds), "channels",
                                              (json_int_t)a.channels));
    }
    return list;
}

static json_t *make_vector(const float v[3])
{
    return json_pack("[o, o, o]", json_number((double)v[0]), json_number((double)v[1]),
                     json_number((double)v[2]));
}

/// A point in the world of the file.
static json_t *make_point(const alp_scene_info *i, const float p[3])
{
    return json_pack("[o, o, o]", json_number(i->origin[0] + (double)p[0]),
                     json_number(i->origin[1] + (double)p[1]),
                     json_number(i->origin[2] + (double)p[2]));
}

static json_t *make_scene(const alp_scene *scene, const alp_scene_info *i)
{
    return json_pack("{s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:{s:o, s:o}, s:o, s:o}",
                     "triangles", (json_int_t)i->triangles, "usable_triangles",
                     (json_int_t)i->usable_triangles, "vertices", (json_int_t)i->vertices,
                     "surfaces", (json_int_t)i->surfaces, "materials", (json_int_t)i->materials,
                     "images", (json_int_t)i->images, "lights", (json_int_t)i->lights, "cameras",
                     (json_int_t)i->cameras, "bounds", "minimum", make_point(i, i->bounds_min),
                     "maximum", make_point(i, i->bounds_max), "area", json_number(i->area), "unit",
                     make_unit(scene, i));
}

static json_t *make_surfaces(const alp_scene *scene, uint32_t count)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < count; i++) {
        alp_surface_info s = alp_scene_get_surface(scene, i);
        json_array_append_new(list,
                              json_pack("{s:o, s:o, s:I, s:I, s:b, s:b, s:b, s:o}", "name",
                                        json_text(s.name), "material", json_text(s.material),
                                        "triangles", (json_int_t)s.triangle_count, "uv_sets",
                                        (json_int_t)s.uv_sets, "double_sided", s.double_sided,
                                        "mirrored", s.mirrored, "normals_generated",
                                        s.normals_generated, "emission", make_vector(s.emission)));
    }
    return list;
}

/// An angle in degrees; null for a light without one.
static json_t *make_angle(bool has, float radians)
{
    return has ? json_number((double)radians * 180.0 / M_PI) : json_null();
}

static json_t *make_light(const alp_scene_info *info, const alp_light_info *l)
{
    const alp_light_traits traits = alp_light_traits_of(l->kind);
    return json_pack("{s:o, s:s, s:o, s:s, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "name",
                     json_text(l->name), "kind", traits.name, "intensity",
                     json_number((double)l->intensity), "unit", traits.unit, "color",
                     make_vector(l->color), "position", make_point(info, l->position), "direction",
                     make_vector(l->direction), "range", json_number((double)l->range),
                     "inner_cone_degrees", make_angle(traits.has_cone, l->inner_cone),
                     "outer_cone_degrees", make_angle(traits.has_cone, l->outer_cone),
                     "size_degrees", make_angle(traits.has_size, l->size));
}

static json_t *make_lights(const alp_scene *scene, const alp_scene_info *info)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < info->lights; i++) {
        const alp_light_info l = alp_scene_get_light(scene, i);
        json_array_append_new(list, make_light(info, &l));
    }
    return list;
}

static json_t *make_cameras(const alp_scene *scene, const alp_scene_info *info)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < info->cameras; i++) {
        alp_camera c = alp_scene_get_camera(scene, i);
        json_array_append_new(list, json_pack("{s:o, s:o, s:o, s:o}", "position",
                                              make_point(info, c.position), "target",
                                              make_point(info, c.target), "up", make_vector(c.up),
                                              "vertical_fov_degrees",
                                              json_number((double)c.vertical_fov * 180.0 / M_PI)));
    }
    return list;
}

/// @param a names the file, or none: standard output
static int write_json(const session *s, const command_line *a, const default_work *work,
                      const alp_diagnosis *diagnosis, json_t *pictures)
{
    const alp_scene_info info = alp_scene_get_info(s->scene);
    json_t *document = json_pack(
        "{s:s, s:o, s:{s:o, s:o}, s:o, s:o, s:o, s:o, s:o, s:o, s:O, s:o}", "version",
        alp_version(), "scene", make_scene(s->scene, &info), "work", "ao", work_json(&work->ao),
        "light", work_json(&work->light), "surfaces", make_surfaces(s->scene, info.surfaces),
        "lights", make_lights(s->scene, &info), "cameras", make_cameras(s->scene, &info),
        "animations", make_animations(s->scene, info.animations), "uv_sets",
        findings_uv_sets_json(diagnosis), "findings", findings_json(diagnosis), "pictures",
        pictures, "warnings", report_warnings(&s->messages));
    if (document == NULL) {
        return failure("out of memory");
    }
    const char *path = a->values[OPTION_JSON].text;
    const int code =
        output_write_json(document, path != NULL ? path : "-", a->values[OPTION_FORCE].given);
    json_decref(document);
    return code;
}

static void print_text(const session *s, const char *path, const alp_scene_info *info,
                       const default_work *work, const alp_diagnosis *diagnosis)
{
    print_scene(path, info);
    print_unit(s->scene, info);
    print_work(work, info->area);
    findings_print(diagnosis);
    print_animations(s->scene, info->animations);
    print_surfaces(s->scene, info->surfaces);
    findings_print_uv_sets(diagnosis);
    print_lights(s->scene, info);
}

/// The pictures first: with JSON, their names are in the one document.
static int tell(session *s, const command_line *a, const default_work *work,
                const alp_diagnosis *diagnosis)
{
    const alp_scene_info info = alp_scene_get_info(s->scene);
    const bool is_json = a->values[OPTION_JSON].given;
    json_t *pictures = NULL;
    const int drawn = pictures_write(s, diagnosis, a, &pictures);
    int code = drawn;
    if (is_json && drawn == EXIT_DONE) {
        code = write_json(s, a, work, diagnosis, pictures);
    } else if (!is_json) {
        print_text(s, a->operands[0], &info, work, diagnosis);
        for (size_t i = 0; drawn == EXIT_DONE && i < json_array_size(pictures); i++) {
            printf("%s%-9s  ", i == 0 ? "\n" : "", "picture");
            print_clean(stdout, json_string_value(json_array_get(pictures, i)));
            putchar('\n');
        }
    }
    json_decref(pictures);
    return code;
}

/// --probes: what they hold, and whether they fit the scene.
static int print_probes(session *s, const command_line *a)
{
    const char *path = a->values[OPTION_PROBES].text;
    alp_probes *probes = NULL;
    if (path == NULL) {
        return EXIT_DONE;
    }
    const int code = session_end(s, alp_probes_load(s->context, path, &probes));
    if (code == EXIT_DONE) {
        const alp_probes_info info = alp_probes_get_info(probes);
        const bool fits = info.scene_hash == alp_scene_get_info(s->scene).hash;
        printf("\n");
        probes_print(probes);
        printf("baked in   %s\n",
               fits ? "this scene"
                    : "another scene, or this one before it changed: bake them again");
    }
    alp_probes_destroy(probes);
    return code;
}

/// Collects all results before any is printed.
static int look(session *s, default_work *work, alp_diagnosis **diagnosis)
{
    int code = session_end(s, alp_scene_examine(s->scene, NULL, session_progress, s));
    if (code == EXIT_DONE) {
        code = session_end(s, estimate_work(s, work));
    }
    return code == EXIT_DONE ? findings_look(s, NULL, diagnosis) : code;
}

/// info FILE.probes.json
static int show_probe_file(const command_line *a)
{
    session s;
    alp_probes *probes = NULL;
    int code = session_open(&s, a);
    if (code == EXIT_DONE) {
        code = session_end(&s, alp_probes_load(s.context, a->operands[0], &probes));
    }
    if (code == EXIT_DONE) {
        probes_print(probes);
    }
    alp_probes_destroy(probes);
    session_close(&s);
    return code;
}

/// --json FILE must not be SCENE, and is refused before the work.
static int check_json(const command_line *a)
{
    const char *path = a->values[OPTION_JSON].text;
    if (path == NULL) {
        return EXIT_DONE;
    }
    if (output_is_same(path, a->operands[0])) {
        return usage_error(COMMAND_INFO, "--json %s: SCENE has the same name; give another", path);
    }
    return output_check_json(path, a->values[OPTION_FORCE].given);
}

/// Messages that are findings too are printed as such.
static void forget_findings(message_log *messages, const alp_diagnosis *diagnosis)
{
    for (uint32_t i = 0; i < alp_diagnosis_finding_count(diagnosis); i++) {
        messages_forget(messages, alp_diagnosis_get_finding(diagnosis, i).code);
    }
}

int command_info(const command_line *a)
{
    session s;
    const bool is_json = a->values[OPTION_JSON].given;
    if (is_json && a->values[OPTION_PROBES].given) {
        return usage_error(COMMAND_INFO, "--probes: prints text; leave out --json");
    }
    if (path_ends(a->operands[0], ".probes.json")) {
        return is_json ? usage_error(COMMAND_INFO, "%s: is JSON itself; leave out --json",
                                     a->operands[0])
                       : show_probe_file(a);
    }
    default_work work = {{0}, {0}};
    alp_diagnosis *diagnosis = NULL;
    int code = check_json(a);
    if (code != EXIT_DONE) {
        return code;
    }
    code = session_open(&s, a);
    s.messages.held = !a->values[OPTION_JSON].given; // most are among the findings
    if (code == EXIT_DONE) {
        code = session_load(&s, a);
    }
    if (code == EXIT_DONE) {
        code = look(&s, &work, &diagnosis);
    }
    forget_findings(&s.messages, diagnosis);
    messages_print_held(&s.messages);
    if (code == EXIT_DONE) {
        code = tell(&s, a, &work, diagnosis);
        code = code == EXIT_DONE ? print_probes(&s, a) : code;
    }
    alp_diagnosis_destroy(diagnosis);
    session_close(&s);
    return code;
}
