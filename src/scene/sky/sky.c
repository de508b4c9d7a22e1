// SPDX-License-Identifier: MIT
// The sky's kinds behind one door: an even or two-coloured one in closed form, an image as a table,
// the clear sky in closed form with a coarse table of itself to draw directions from.
#include "scene/sky/sky.h"

#include "base/image.h"
#include "base/memory.h"
#include "scene/sky/sky_clear.h"
#include "scene/sky/sky_spots.h"

#include <float.h>
#include <string.h>

/// Beyond this, sums of radiances would leave floats.
#define MOST_RADIANCE 1e30f
/// Turbidities that the clear sky's coefficients were fitted for.
static const float LEAST_TURBIDITY = 1.7f, MOST_TURBIDITY = 10.0f;
/// What the clear sky's ground gives back of the sky's light: soil and grass.
static const double GROUND_ALBEDO = 0.2;
/// Size of the table of the clear sky: its horizon lies between two rows. Small enough to stay in a
/// processor's cache beside the scene; directions are only drawn from it.
enum { CLEAR_WIDTH = 64, CLEAR_HEIGHT = 32 };
/// Directions that are asked together.
enum { CLEAR_BATCH = 64 };
/// In how many places across and down its light on level ground is summed up, for each of those.
enum { GROUND_FINER = 4 };
/// Of the soft part of an image. More leaves fewer spots and makes rays noisier: radiosity of a
/// house under a hall's lamps took 15 % longer for the same error with 2, 5 % with 1.25 or 1.6.
static const double SOFT_UNEVENNESS = 1.4;

struct alpi_sky {
    alp_sky_kind kind;     // CONSTANT is a HEMISPHERE of one colour
    vec3 up, down;         // of HEMISPHERE
    alpi_sky_table table;  // of IMAGE and CLEAR
    alpi_sky_looks *looks; // of spots, else NULL
    alpi_clear_sky clear;  // of CLEAR
    vec3 ground;           // of CLEAR
    float strength;        // of CLEAR, with twilight
    vec3 mean;
};

// --- checking ------------------------------------------------------------------------------------

/// Whether least ≤ value ≤ most; NaN is not.
static bool is_within(float value, float least, float most)
{
    return value >= least && value <= most;
}

static alp_result check_colors(alp_context *context, const alp_sky_options *o)
{
    const struct {
        const char *name;
        const float *color;
    } colors[] = {{"up", o->up}, {"down", o->down}};
    int count = o->kind == ALP_SKY_HEMISPHERE ? 2 : 1;
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            float value = colors[i].color[k];
            if (!is_within(value, 0.0f, MOST_RADIANCE) ||
                !is_within(value * o->strength, 0.0f, MOST_RADIANCE)) {
                return alpi_fail(
                    context, ALP_ERROR_INVALID_ARGUMENT,
                    "sky: %s[%d] is %g, times strength %g; both and their product must "
                    "be 0 to 1e30",
                    colors[i].name, k, (double)value, (double)o->strength);
            }
        }
    }
    return ALP_OK;
}

static alp_result check_image(alp_context *context, const alp_image *image)
{
    if (image == NULL) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "sky: its kind is an image, and the image is NULL; give one");
    }
    if (image->info.component != ALP_COMPONENT_FLOAT) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "sky: its image has 8 bits, which hold no radiance; give a float image "
                         "(.hdr, .exr)");
    }
    if (image->info.channels < 3) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "sky: its image has %u channel%s; give one of 3 or 4",
                         image->info.channels, image->info.channels == 1 ? "" : "s");
    }
    if (image->info.width != 2 * image->info.height) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "sky: its image has %u x %u pixels; an equirectangular one is twice as "
                         "wide as high",
                         image->info.width, image->info.height);
    }
    return ALP_OK;
}

static alp_result check_clear(alp_context *context, const alp_sky_options *o, vec3 sun)
{
    if (!is_within(o->turbidity, LEAST_TURBIDITY, MOST_TURBIDITY)) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "sky: turbidity %g; it must be 1.7 to 10", (double)o->turbidity);
    }
    float length = vec3_length(sun);
    if (!is_within(length, 0.999f, 1.001f)) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "sky: the sun's direction (%g, %g, %g) must be a unit vector",
                         (double)sun.x, (double)sun.y, (double)sun.z);
    }
    return ALP_OK;
}

static alp_result check(alp_context *context, const alp_sky_options *o, vec3 sun)
{
    if ((int)o->kind < ALP_SKY_NONE || o->kind > ALP_SKY_CLEAR) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT, "sky: kind %d is none of 0 to %d",
                         (int)o->kind, ALP_SKY_CLEAR);
    }
    if (!is_within(o->strength, 0.0f, MOST_RADIANCE)) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "sky: strength %g; it must be 0 to 1e30", (double)o->strength);
    }
    if (!isfinite(o->turn)) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "sky: turn %g; it must be finite, in radians", (double)o->turn);
    }
    switch (o->kind) {
    case ALP_SKY_CONSTANT:
    case ALP_SKY_HEMISPHERE:
        return check_colors(context, o);
    case ALP_SKY_IMAGE:
        return check_image(context, o->image);
    case ALP_SKY_CLEAR:
        return check_clear(context, o, sun);
    default:
        return ALP_OK;
    }
}

// --- making --------------------------------------------------------------------------------------

/// Values of an image that are no radiance.
typedef struct faults {
    uint64_t negative, infinite; // negative or NaN; infinite or absurdly bright
    float brightest;             // of all others
} faults;

static faults find_faults(const alp_image *image)
{
    faults f = {0, 0, 0.0f};
    size_t count = (size_t)image->info.width * image->info.height;
    uint32_t channels = image->info.channels;
    const float *values = image->pixels;
    for (size_t i = 0; i < count; i++) {
        for (uint32_t k = 0; k < 3; k++) {
            float value = values[i * channels + k];
            f.negative += !(value >= 0.0f);
            f.infinite += value > MOST_RADIANCE;
            f.brightest = value <= MOST_RADIANCE && value > f.brightest ? value : f.brightest;
        }
    }
    return f;
}

static float clean(float value, float brightest, float strength)
{
    return !(value >= 0.0f) ? 0.0f : fminf(value, brightest) * strength;
}

static alp_result make_image(alp_context *context, const alp_sky_options *o, alpi_sky *sky)
{
    const alp_image *image = o->image;
    faults f = find_faults(image);
    if (f.negative + f.infinite > 0) {
        alpi_warn(context, "sky-image", NULL,
                  "the sky's image: %llu values are negative or NaN and count as 0, %llu are "
                  "infinite and count as its brightest, %g",
                  (unsigned long long)f.negative, (unsigned long long)f.infinite,
                  (double)f.brightest);
    }
    if (!(f.brightest * o->strength <= MOST_RADIANCE)) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "sky: strength %g makes more than 1e30 of the image's brightest value, "
                         "%g; lower it",
                         (double)o->strength, (double)f.brightest);
    }
    uint32_t width = image->info.width, height = image->info.height;
    ALP_TRY(alpi_sky_table_create(context, width, height, o->turn, &sky->table));
    const float *values = image->pixels;
    for (size_t i = 0; i < (size_t)width * height; i++, values += image->info.channels) {
        sky->table.pixels[i] = (vec3){clean(values[0], f.brightest, o->strength),
                                      clean(values[1], f.brightest, o->strength),
                                      clean(values[2], f.brightest, o->strength)};
    }
    alpi_sky_table_finish(&sky->table);
    sky->mean = alpi_sky_table_mean(&sky->table);
    return ALP_OK;
}

/// Of up to CLEAR_BATCH directions: the sky's above the horizon, the ground's below.
static void clear_batch(const alpi_sky *sky, const vec3 *directions, uint32_t count,
                        vec3 *radiances)
{
    vec3 above[CLEAR_BATCH], seen[CLEAR_BATCH];
    uint32_t up = 0, next = 0;
    for (uint32_t i = 0; i < count; i++) {
        above[up] = directions[i];
        up += directions[i].y >= 0.0f ? 1 : 0;
    }
    sky->clear.radiances(&sky->clear, above, up, seen);
    for (uint32_t i = 0; i < count; i++) {
        radiances[i] =
            directions[i].y >= 0.0f ? vec3_scale(seen[next++], sky->strength) : sky->ground;
    }
}

static void clear_radiances(const alpi_sky *sky, const vec3 *directions, uint32_t count,
                            vec3 *radiances)
{
    for (uint32_t first = 0; first < count; first += CLEAR_BATCH) {
        const uint32_t left = count - first;
        clear_batch(sky, directions + first, left < CLEAR_BATCH ? left : CLEAR_BATCH,
                    radiances + first);
    }
}

static vec3 clear_radiance(const alpi_sky *sky, vec3 direction)
{
    vec3 radiance = sky->ground;
    if (direction.y >= 0.0f) {
        alpi_clear_sky_radiances_one_by_one(&sky->clear, &direction, 1, &radiance);
        radiance = vec3_scale(radiance, sky->strength);
    }
    return radiance;
}

/// What the ground gives back of what falls onto it from the sky.
static vec3 clear_ground(const alpi_sky *sky)
{
    enum { W = CLEAR_WIDTH * GROUND_FINER, H = CLEAR_HEIGHT * GROUND_FINER };
    double sum[3] = {0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < H / 2 * W; i++) {
        uint32_t x = i % W, y = i / W;
        vec3 direction = alpi_sky_table_direction(&sky->table, (x + 0.5) / GROUND_FINER - 0.5,
                                                  (y + 0.5) / GROUND_FINER - 0.5);
        vec3 radiance = clear_radiance(sky, direction);
        // ∫ sinθ cosθ dθ over the row is half the difference of sin²θ at its edges.
        double above = sin(y * ALPI_PI / H), below = sin((y + 1) * ALPI_PI / H);
        double weight = ALPI_PI / W * (below * below - above * above);
        sum[0] += (double)radiance.x * weight;
        sum[1] += (double)radiance.y * weight;
        sum[2] += (double)radiance.z * weight;
    }
    double scale = GROUND_ALBEDO / ALPI_PI;
    return (vec3){(float)(sum[0] * scale), (float)(sum[1] * scale), (float)(sum[2] * scale)};
}

/// Fills the table's upper half with the sky and the lower with the ground.
static void fill_clear(alpi_sky *sky)
{
    alpi_sky_table *t = &sky->table;
    uint32_t half = CLEAR_HEIGHT / 2 * CLEAR_WIDTH;
    sky->ground = clear_ground(sky);
    for (uint32_t i = 0; i < 2 * half; i++) {
        const uint32_t x = i % CLEAR_WIDTH, y = i / CLEAR_WIDTH;
        t->pixels[i] =
            i < half ? clear_radiance(sky, alpi_sky_table_direction(t, x, y)) : sky->ground;
    }
}

static alp_result make_clear(alp_context *context, const alp_sky_options *o, vec3 sun,
                             alpi_sky *sky)
{
    double fading = alpi_clear_sky_init(&sky->clear, sun, (double)o->turbidity);
    sky->clear.radiances = ALPI_COMPILED_FOR(context, alpi_clear_sky_radiances);
    sky->strength = (float)((double)o->strength * fading);
    if (fading < 1.0) {
        alpi_warn(context, "sun-below-horizon", NULL,
                  "the sun is below the horizon: the clear sky fades to %.2g of its value at "
                  "sunset",
                  fading);
    }
    ALP_TRY(alpi_sky_table_create(context, CLEAR_WIDTH, CLEAR_HEIGHT, 0.0f, &sky->table));
    fill_clear(sky);
    alpi_sky_table_finish(&sky->table);
    sky->mean = alpi_sky_table_mean(&sky->table);
    if (!vec3_is_finite(sky->mean) || !(sky->table.total <= (double)MOST_RADIANCE)) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "sky: strength %g makes the clear sky brighter than 1e30; lower it",
                         (double)o->strength);
    }
    return ALP_OK;
}

static void make_hemisphere(const alp_sky_options *o, alpi_sky *sky)
{
    sky->up = vec3_scale(vec3_load(o->up), o->strength);
    sky->down = o->kind == ALP_SKY_CONSTANT ? sky->up : vec3_scale(vec3_load(o->down), o->strength);
    sky->kind = ALP_SKY_HEMISPHERE;
    sky->mean = vec3_scale(vec3_add(sky->up, sky->down), 0.5f);
}

static alp_result make(alp_context *context, const alp_sky_options *options, vec3 sun,
                       alpi_sky *sky)
{
    sky->kind = options->kind;
    if (options->kind == ALP_SKY_IMAGE) {
        return make_image(context, options, sky);
    }
    if (options->kind == ALP_SKY_CLEAR) {
        return make_clear(context, options, sun, sky);
    }
    make_hemisphere(options, sky);
    return ALP_OK;
}

static bool is_black(const alpi_sky *sky)
{
    return sky->kind == ALP_SKY_HEMISPHERE
               ? !(alpi_sky_brightness(sky->up) + alpi_sky_brightness(sky->down) > 0.0)
               : !(sky->table.total > 0.0);
}

alp_result alpi_sky_create(alp_context *context, const alp_sky_options *options, vec3 sun_direction,
                           alpi_sky **sky)
{
    *sky = NULL;
    ALP_TRY(check(context, options, sun_direction));
    if (options->kind == ALP_SKY_NONE) {
        return ALP_OK;
    }
    alpi_sky *made = ALPI_NEW(context, alpi_sky, 1);
    if (made == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = make(context, options, sun_direction, made);
    if (result != ALP_OK || is_black(made)) {
        alpi_sky_destroy(context, made);
        return result;
    }
    *sky = made;
    return ALP_OK;
}

void alpi_sky_destroy(alp_context *context, alpi_sky *sky)
{
    if (sky != NULL) {
        alpi_sky_table_release(context, &sky->table);
        alpi_release(context, sky->looks);
        alpi_release(context, sky);
    }
}

// --- splitting -----------------------------------------------------------------------------------

static alp_result copy_table(alp_context *context, const alpi_sky_table *from, alpi_sky_table *to)
{
    ALP_TRY(alpi_sky_table_create(context, from->width, from->height, 0.0f, to));
    to->turn = from->turn;
    memcpy(to->pixels, from->pixels, (size_t)from->width * from->height * sizeof *to->pixels);
    alpi_sky_table_finish(to);
    return ALP_OK;
}

static alp_result split_image(alp_context *context, const alpi_sky *sky, alpi_sky *soft,
                              alpi_sky *spots)
{
    ALP_TRY(
        alpi_sky_spots_part(context, &sky->table, SOFT_UNEVENNESS, &soft->table, &spots->table));
    soft->kind = spots->kind = ALP_SKY_IMAGE;
    soft->mean = alpi_sky_table_mean(&soft->table);
    spots->mean = alpi_sky_table_mean(&spots->table);
    return is_black(spots) ? ALP_OK : alpi_sky_spots_look(context, &spots->table, &spots->looks);
}

static alp_result copy(alp_context *context, const alpi_sky *sky, alpi_sky *to)
{
    *to = *sky;
    to->table = (alpi_sky_table){0};
    return sky->kind == ALP_SKY_CLEAR ? copy_table(context, &sky->table, &to->table) : ALP_OK;
}

alp_result alpi_sky_split(alp_context *context, const alpi_sky *sky, alpi_sky **soft,
                          alpi_sky **spots)
{
    alpi_sky *made[2] = {ALPI_NEW(context, alpi_sky, 1), ALPI_NEW(context, alpi_sky, 1)};
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    if (made[0] != NULL && made[1] != NULL) {
        result = sky->kind == ALP_SKY_IMAGE ? split_image(context, sky, made[0], made[1])
                                            : copy(context, sky, made[0]);
    }
    for (int i = 0; i < 2; i++) {
        if (result != ALP_OK || is_black(made[i])) {
            alpi_sky_destroy(context, made[i]);
            made[i] = NULL;
        }
    }
    *soft = made[0];
    *spots = made[1];
    return result;
}

bool alpi_sky_is_image(const alpi_sky *sky)
{
    return sky->kind == ALP_SKY_IMAGE;
}

const alpi_sky_looks *alpi_sky_spot_looks(const alpi_sky *sky)
{
    return sky->looks;
}

// --- asking --------------------------------------------------------------------------------------

vec3 alpi_sky_radiance(const alpi_sky *sky, vec3 direction)
{
    if (sky->kind == ALP_SKY_IMAGE) {
        return alpi_sky_table_radiance(&sky->table, direction);
    }
    if (sky->kind == ALP_SKY_CLEAR) {
        return clear_radiance(sky, direction);
    }
    return direction.y >= 0.0f ? sky->up : sky->down;
}

void alpi_sky_radiances(const alpi_sky *sky, const vec3 *directions, uint32_t count,
                        vec3 *radiances)
{
    if (sky->kind == ALP_SKY_IMAGE) {
        alpi_sky_table_radiances(&sky->table, directions, count, radiances);
        return;
    }
    if (sky->kind == ALP_SKY_CLEAR) {
        clear_radiances(sky, directions, count, radiances);
        return;
    }
    for (uint32_t i = 0; i < count; i++) {
        radiances[i] = alpi_sky_radiance(sky, directions[i]);
    }
}

float alpi_sky_density(const alpi_sky *sky, vec3 direction)
{
    if (sky->kind != ALP_SKY_HEMISPHERE) {
        return alpi_sky_table_density(&sky->table, direction);
    }
    double down = alpi_sky_brightness(sky->down), up = alpi_sky_brightness(sky->up);
    return (float)((direction.y >= 0.0f ? up : down) / (2.0 * ALPI_PI * (up + down)));
}

/// Height above the ground is even in solid angle.
static vec3 sample_hemisphere(const alpi_sky *sky, vec2 u)
{
    // One half or the other in proportion to its brightness, evenly within it.
    double down = alpi_sky_brightness(sky->down), up = alpi_sky_brightness(sky->up);
    double share = down / (up + down), x = (double)u.x;
    double y = x < share ? x / share - 1.0 : (x - share) / (1.0 - share);
    double sine = sqrt(fmax(1.0 - y * y, 0.0)), phi = 2.0 * ALPI_PI * (double)u.y;
    return (vec3){(float)(sine * sin(phi)), (float)y, (float)(sine * cos(phi))};
}

vec3 alpi_sky_sample(const alpi_sky *sky, vec2 u, float *density)
{
    vec3 direction = sky->kind == ALP_SKY_HEMISPHERE ? sample_hemisphere(sky, u)
                                                     : alpi_sky_table_sample(&sky->table, u);
    // Asked anew of the direction that rounding left us with: what is looked up there fits to it.
    // On the rim of what is lit that may be 0, and the radiance with it.
    if (density != NULL) {
        *density = fmaxf(alpi_sky_density(sky, direction), FLT_MIN);
    }
    return direction;
}

vec3 alpi_sky_mean(const alpi_sky *sky)
{
    return sky->mean;
}
