// SPDX-License-Identifier: MIT
// The fingerprint of lighting options: every field changes it, padding and addresses do not.
#include "test_support.h"

#include "scene/lights/lighting_options.h"

#include <alpenglow/image.h>

/// The first number of each field, or the only one.
#define FIELDS(o, lamp)                                                                            \
    {                                                                                              \
        &(o).sky.up[0], &(o).sky.up[2], &(o).sky.down[0], &(o).sky.down[2], &(o).sky.turn,         \
            &(o).sky.strength, &(o).sky.turbidity, &(o).sun.azimuth, &(o).sun.elevation,           \
            &(o).sun.illuminance, &(o).sun.color[0], &(o).sun.color[2], &(o).sun.size,             \
            &(o).file_sun_size, &(lamp).position[0], &(lamp).position[2], &(lamp).direction[0],    \
            &(lamp).direction[2], &(lamp).intensity, &(lamp).color[0], &(lamp).color[2],           \
            &(lamp).inner_cone, &(lamp).outer_cone                                                 \
    }

TEST(every_number_counts)
{
    alp_lamp lamps[2] = {alp_lamp_default(), alp_lamp_default()};
    alp_lighting_options o = alp_lighting_options_default();
    o.lamps = lamps;
    o.lamp_count = 2;
    const uint64_t before = alpi_lighting_options_hash(&o);
    float *const fields[] = FIELDS(o, lamps[1]);
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++) {
        const float value = *fields[i];
        *fields[i] = value + 0.25f;
        if (alpi_lighting_options_hash(&o) == before) {
            fail_msg("field %zu does not count", i);
        }
        *fields[i] = value;
    }
    assert_true(alpi_lighting_options_hash(&o) == before);
}

TEST(kinds_and_counts_count)
{
    alp_lamp lamps[2] = {alp_lamp_default(), alp_lamp_default()};
    alp_lighting_options o = alp_lighting_options_default();
    o.lamps = lamps;
    o.lamp_count = 2;
    const uint64_t before = alpi_lighting_options_hash(&o);
    lamps[1].kind = ALP_LIGHT_SPOT;
    assert_true(alpi_lighting_options_hash(&o) != before);
    lamps[1].kind = ALP_LIGHT_POINT;
    o.sky.kind = ALP_SKY_CLEAR;
    assert_true(alpi_lighting_options_hash(&o) != before);
    o.sky.kind = ALP_SKY_NONE;
    o.lamp_count = 1;
    assert_true(alpi_lighting_options_hash(&o) != before);
}

TEST(padding_and_addresses_do_not_count)
{
    alp_lamp first[1] = {alp_lamp_default()}, second[1] = {alp_lamp_default()};
    alp_lighting_options a, b;
    memset(&a, 0x11, sizeof a);
    memset(&b, 0x22, sizeof b);
    a.sky = b.sky = alp_lighting_options_default().sky;
    a.sun = b.sun = alp_lighting_options_default().sun;
    a.file_sun_size = b.file_sun_size = 0.0f;
    a.lamp_count = b.lamp_count = 1;
    a.lamps = first;
    b.lamps = second;
    assert_true(alpi_lighting_options_hash(&a) == alpi_lighting_options_hash(&b));
    a.lamps = NULL; // the check of options comes later
    (void)alpi_lighting_options_hash(&a);
}

TEST(pixels_and_shape_of_the_sky_count)
{
    alp_context *context = test_context(1);
    uint64_t hashes[3];
    for (int i = 0; i < 3; i++) {
        const alp_image_info info = {i == 1 ? 2 : 4, i == 1 ? 4 : 2, 3, ALP_COMPONENT_FLOAT};
        alp_lighting_options o = alp_lighting_options_default();
        alp_image *image = NULL;
        ASSERT_OK(context, alp_image_create(context, info, &image));
        alp_image_floats(image)[23] = i == 2 ? 1.0f : 0.0f;
        o.sky.image = image;
        hashes[i] = alpi_lighting_options_hash(&o);
        alp_image_destroy(image);
    }
    assert_true(hashes[0] != hashes[1]);
    assert_true(hashes[0] != hashes[2]);
    alp_context_destroy(context);
}
