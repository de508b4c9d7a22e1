// SPDX-License-Identifier: MIT
// A second UV set is kept where it can hold a bake; else the message says what is wrong and where.
#include "atlas_scenes.h"

/// Two squares, each its own island unless the coordinates say otherwise.
static alp_scene *two_squares(alp_context *context, const float (*uvs)[2])
{
    static const float p[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                  {2, 0, 0}, {3, 0, 0}, {3, 1, 0}, {2, 1, 0}};
    static const uint32_t indices[4][3] = {{0, 1, 2}, {2, 3, 0}, {4, 5, 6}, {6, 7, 4}};
    return scene_of(context, p, uvs, 8, indices, 4);
}

static const float GOOD[8][2] = {{0.1f, 0.1f}, {0.4f, 0.1f}, {0.4f, 0.4f}, {0.1f, 0.4f},
                                 {0.6f, 0.1f}, {0.9f, 0.1f}, {0.9f, 0.4f}, {0.6f, 0.4f}};

static alp_result keep(alp_context *context, const float (*uvs)[2], alp_atlas_mode mode,
                       alp_atlas_info *info)
{
    alp_scene *scene = two_squares(context, uvs);
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = mode;
    options.size = 64;
    alp_atlas *atlas = NULL;
    alp_result result = alp_atlas_create(scene, &options, &atlas);
    *info = alp_atlas_get_info(atlas);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
    return result;
}

TEST_WITH_CONTEXT(a_good_set_is_kept, 1)
{
    alp_atlas_info info;
    ASSERT_OK(context, keep(context, GOOD, ALP_ATLAS_KEEP, &info));
    assert_int_equal(info.mode, ALP_ATLAS_KEEP);
    assert_int_equal(info.charts, 2);
    assert_int_equal(info.pages, 1);
    ASSERT_OK(context, keep(context, GOOD, ALP_ATLAS_AUTO, &info));
    assert_int_equal(info.mode, ALP_ATLAS_KEEP);
    assert_string_equal(alp_context_message(context), "");
}

/// KEEP fails with these words in its message, and AUTO makes charts instead.
static void check_fault(const float (*uvs)[2], const char *fault, const char *triangles)
{
    alp_context *context = test_context(1);
    alp_atlas_info info;
    assert_int_equal(keep(context, uvs, ALP_ATLAS_KEEP, &info), ALP_ERROR_INVALID_DATA);
    const char *message = alp_context_message(context);
    if (!strstr(message, fault) || !strstr(message, triangles)) {
        fail_msg("message: %s", message);
    }
    assert_non_null(strstr(message, "thing"));
    assert_non_null(strstr(message, "--atlas charts"));
    ASSERT_OK(context, keep(context, uvs, ALP_ATLAS_AUTO, &info));
    assert_int_equal(info.mode, ALP_ATLAS_CHARTS);
    alp_context_destroy(context);
}

TEST(a_missing_set_is_said)
{
    check_fault(NULL, "missing", "4 triangles, such as 0, 1, 2, 3;");
}

TEST_WITH_CONTEXT(out_of_range_is_said, 1)
{
    float uvs[8][2];
    memcpy(uvs, GOOD, sizeof uvs);
    uvs[7][1] = 1.001f;
    check_fault((const float(*)[2])uvs, "outside [0, 1]", "1 triangle, such as 3;");
    uvs[7][1] = (float)NAN;
    check_fault((const float(*)[2])uvs, "outside [0, 1]", "1 triangle, such as 3;");
    uvs[7][1] = 0.4f;
    uvs[0][0] = -0.00005f; // clamped
    alp_atlas_info info;
    ASSERT_OK(context, keep(context, (const float(*)[2])uvs, ALP_ATLAS_KEEP, &info));
}

TEST(no_area_is_said)
{
    float uvs[8][2];
    memcpy(uvs, GOOD, sizeof uvs);
    memcpy(uvs[1], uvs[0], sizeof uvs[0]);
    check_fault((const float(*)[2])uvs, "no area", "1 triangle, such as 0;");
}

TEST(overlap_is_said)
{
    float uvs[8][2];
    memcpy(uvs, GOOD, sizeof uvs);
    for (int i = 4; i < 8; i++) {
        uvs[i][0] -= 0.25f; // the second square over the first by 3.2 texels
    }
    check_fault((const float(*)[2])uvs, "overlap", "with");
    for (int i = 4; i < 8; i++) {
        uvs[i][0] = GOOD[i][0] - 0.207f; // by 0.45 texels
    }
    check_fault((const float(*)[2])uvs, "overlap", "with");
}

/// A corner of one square lies over a corner of the other. KEEP takes it up to 1 % of the texels
/// and names the triangles; AUTO makes charts.
TEST(few_overlaps_are_warned_of)
{
    static const float depths[] = {0.02f, 0.06f}; // of a corner: 2 and 22 texels of 740
    for (int i = 0; i < 2; i++) {
        float uvs[8][2];
        memcpy(uvs, GOOD, sizeof uvs);
        for (int k = 4; k < 8; k++) {
            uvs[k][0] += GOOD[0][0] - GOOD[4][0] + 0.3f - depths[i];
            uvs[k][1] += GOOD[0][1] - GOOD[4][1] + 0.3f - depths[i];
        }
        alp_context *context = test_context(1);
        alp_atlas_info info;
        test_log_clear();
        const alp_result result = keep(context, (const float(*)[2])uvs, ALP_ATLAS_KEEP, &info);
        const bool few = result == ALP_OK;
        assert_int_equal(few, i == 0);
        if (few) {
            assert_int_equal(info.mode, ALP_ATLAS_KEEP);
            assert_true(info.overlapping_texels > 0);
        } else {
            assert_int_equal(result, ALP_ERROR_INVALID_DATA);
            assert_non_null(strstr(alp_context_message(context),
                                   "on 2.97 % of its texels, above the limit of 1 %"));
        }
        assert_int_equal(test_log_has("kept-overlap"), few);
        ASSERT_OK(context, keep(context, (const float(*)[2])uvs, ALP_ATLAS_AUTO, &info));
        assert_int_equal(info.mode, ALP_ATLAS_CHARTS);
        alp_context_destroy(context);
    }
}

TEST_WITH_CONTEXT(sharing_a_texel_is_no_overlap, 1)
{
    float uvs[8][2];
    memcpy(uvs, GOOD, sizeof uvs);
    for (int i = 4; i < 8; i++) {
        uvs[i][0] -= 0.2f; // side by side
    }
    alp_atlas_info info;
    ASSERT_OK(context, keep(context, (const float(*)[2])uvs, ALP_ATLAS_KEEP, &info));
}

TEST_WITH_CONTEXT(mirrored_coordinates_are_kept, 1)
{
    float uvs[8][2];
    for (int i = 0; i < 8; i++) {
        uvs[i][0] = 1.0f - GOOD[i][0];
        uvs[i][1] = GOOD[i][1];
    }
    alp_atlas_info info, straight;
    ASSERT_OK(context, keep(context, (const float(*)[2])uvs, ALP_ATLAS_KEEP, &info));
    ASSERT_OK(context, keep(context, GOOD, ALP_ATLAS_KEEP, &straight));
    assert_int_equal(info.texels, straight.texels);
    ASSERT_NEAR(info.texels_per_metre, straight.texels_per_metre, 1e-4);
}
