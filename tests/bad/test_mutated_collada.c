// SPDX-License-Identifier: MIT
// A good document and a good archive with bytes changed or cut off, a few thousand times: whatever
// the reader and the writer say, they must not crash (the sanitizer builds look closer). The
// mutations are the same in every run.
#include "test_collada.h"

#include "base/memory.h"
#include "formats/collada/collada_read.h"
#include "formats/formats.h"

#include <stdlib.h>

enum { ROUNDS = 4000 };

/// Everything the reader knows, in one small document.
static const char inside[] =
    "<asset><unit meter='0.01' name='cm'/><up_axis>Z_UP</up_axis></asset>"
    "<library_images><image id='i'><init_from>absent.png</init_from></image></library_images>"
    "<library_effects><effect id='e'><profile_COMMON><newparam sid='u'><surface type='2D'>"
    "<init_from>i</init_from></surface></newparam><newparam sid='m'><sampler2D><source>u</source>"
    "</sampler2D></newparam><technique sid='t'><phong><emission><color>0 1 0 1</color></emission>"
    "<diffuse><texture texture='m' texcoord='C'/></diffuse><transparent opaque='RGB_ZERO'><color>"
    ".5 .5 .5 1</color></transparent></phong></technique></profile_COMMON></effect>"
    "</library_effects><library_materials><material id='m'><instance_effect url='#e'/></material>"
    "</library_materials><library_lights><light id='l'><technique_common><spot><color>1 1 1</color>"
    "<falloff_angle>40</falloff_angle></spot></technique_common></light></library_lights>"
    "<library_cameras><camera id='c'><optics><technique_common><perspective><yfov>40</yfov>"
    "</perspective></technique_common></optics></camera></library_cameras>"
    "<library_geometries><geometry id='g'><mesh><source id='p'><float_array id='pa' count='24'>"
    "0 0 0 3 0 0 3 3 0 0 3 0 1 1 0 2 1 0 2 2 0 1 2 0</float_array><technique_common><accessor "
    "source='#pa' count='8' stride='3'><param name='X' type='float'/><param name='Y' type='float'/>"
    "<param name='Z' type='float'/></accessor></technique_common></source><source id='t'>"
    "<float_array id='ta' count='4'>0 0 1 1</float_array><technique_common><accessor source='#ta' "
    "count='2' stride='2'><param name='S'/><param name='T'/></accessor></technique_common></source>"
    "<vertices id='v'><input semantic='POSITION' source='#p'/></vertices>"
    "<polylist material='S' count='2'><input semantic='VERTEX' source='#v' offset='0'/><input "
    "semantic='TEXCOORD' source='#t' offset='1' set='1'/><vcount>4 5</vcount><p>0 0 1 1 2 0 3 1 0 "
    "0 "
    "1 0 6 0 2 1 3 1</p></polylist><polygons count='1'><input semantic='VERTEX' source='#v' "
    "offset='0'/><ph><p>0 1 2 3</p><h>4 7 6 5</h></ph></polygons><tristrips count='1'><input "
    "semantic='VERTEX' source='#v' offset='0'/><p>0 1 3 2</p></tristrips><trifans count='1'><input "
    "semantic='VERTEX' source='#v' offset='0'/><p>0 1 2 3</p></trifans></mesh></geometry>"
    "</library_geometries><library_nodes><node id='k'><scale>1 -1 1</scale><instance_geometry "
    "url='#g'><bind_material><technique_common><instance_material symbol='S' target='#m'>"
    "<bind_vertex_input semantic='C' input_semantic='TEXCOORD' input_set='1'/></instance_material>"
    "</technique_common></bind_material></instance_geometry></node></library_nodes>"
    "<library_visual_scenes><visual_scene id='s'><node id='n'><lookat>1 2 3 0 0 0 0 1 0</lookat>"
    "<instance_node url='#k'/><instance_light url='#l'/><instance_camera url='#c'/></node><node>"
    "<rotate>0 0 1 30</rotate><instance_node url='#k'/></node></visual_scene>"
    "</library_visual_scenes><scene><instance_visual_scene url='#s'/></scene>";

static uint32_t next_random(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u; // Knuth's MMIX
    return (uint32_t)(*state >> 33);
}

/// Any bytes, or digits into digits, which leaves the document well-formed and its numbers wrong.
static void mutate(uint8_t *bytes, size_t size, bool digits, uint64_t *state)
{
    static const char tokens[] = "0123456789-<>/\"= #.&!e";
    uint32_t changes = 1 + next_random(state) % 4;
    for (uint32_t i = 0; i < changes;) {
        size_t place = next_random(state) % size;
        uint32_t kind = next_random(state) % 4;
        uint8_t flipped = (uint8_t)(bytes[place] ^ 1u << next_random(state) % 8);
        uint8_t token = (uint8_t)tokens[next_random(state) % (digits ? 11 : sizeof tokens - 1)];
        bool is_digit = bytes[place] >= '0' && bytes[place] <= '9';
        if (digits && !is_digit) {
            continue;
        }
        bytes[place] = digits      ? token
                       : kind == 0 ? (uint8_t)next_random(state)
                       : kind == 1 ? flipped
                                   : token;
        i++;
    }
}

/// Writes what could be read, with made-up coordinates on two pages, and reads that.
static void write_back(alp_context *context, const alp_scene *scene)
{
    float(*uvs)[3][2] = alpi_allocate(context, scene->triangle_count, sizeof *uvs);
    uint32_t *pages = alpi_allocate(context, scene->triangle_count, sizeof *pages);
    assert_true(uvs != NULL && pages != NULL);
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        pages[t] = t / 5 % 2;
        uvs[t][1][0] = uvs[t][2][1] = (float)(t % 3) / 3.0f;
    }
    const uint8_t *const pngs[] = {(const uint8_t *)"x", (const uint8_t *)"y"};
    const size_t sizes[] = {1, 1};
    const alpi_mesh_patch patch = {.page_count = 2,
                                   .corner_uvs = (const float(*)[3][2])uvs,
                                   .triangle_pages = pages,
                                   .page_pngs = pngs,
                                   .page_png_sizes = sizes};
    const char *path = test_path(test_folder(), "out.dae");
    alp_scene *again = NULL;
    ASSERT_OK(context, alpi_scene_write_patched(scene, &patch, path, true));
    ASSERT_OK(context, alp_scene_load(context, path, &again));
    assert_int_equal(again->triangle_count, scene->triangle_count);
    alp_scene_destroy(again);
    alpi_release(context, uvs);
    alpi_release(context, pages);
}

TEST_WITH_CONTEXT(changed_bytes, 1)
{
    size_t size;
    char *good = test_collada_text(inside, &size);
    uint8_t *bad = malloc(size);
    alp_scene *scene = NULL;
    ASSERT_OK(context, test_collada_bytes(context, good, size, &scene));
    write_back(context, scene);
    alp_scene_destroy(scene);
    uint64_t seed = 1;
    int accepted = 0, refused = 0;
    for (int round = 0; round < ROUNDS; round++) {
        memcpy(bad, good, size);
        mutate(bad, size, round % 2 == 0, &seed);
        alp_result result = test_collada_bytes(context, bad, size, &scene);
        if (result == ALP_OK && round % 8 == 0) {
            write_back(context, scene);
        }
        accepted += result == ALP_OK;
        refused += result != ALP_OK;
        assert_true(result == ALP_OK || alp_context_message(context)[0] != '\0');
        alp_scene_destroy(scene);
        scene = NULL;
    }
    print_message("%d of %d mutations accepted\n", accepted, ROUNDS);
    assert_true(accepted > ROUNDS / 20 && refused > ROUNDS / 20); // both sides were exercised
    free(bad);
    free(good);
}

TEST_WITH_CONTEXT(cut_files, 1)
{
    size_t size;
    char *good = test_collada_text(inside, &size);
    for (size_t cut = 0; cut + 2 < size; cut++) { // white space follows the root
        alp_scene *scene = NULL;
        assert_int_not_equal(test_collada_bytes(context, good, cut, &scene), ALP_OK);
        assert_null(scene);
    }
    free(good);
}

/// Every allocation of ours fails once; the sanitizer build sees what is not given back.
TEST(failing_allocations)
{
    size_t size;
    char *good = test_collada_text(inside, &size);
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    int allowed = 0;
    for (; result != ALP_OK; allowed++) {
        int left = allowed;
        alp_context *context = test_context_failing(&left);
        left = allowed;
        alp_scene *scene = NULL;
        result = test_collada_bytes(context, good, size, &scene);
        assert_true(result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY);
        assert_int_equal(result == ALP_OK, scene != NULL);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
    print_message("%d allocations failed in turn\n", allowed - 1);
    assert_in_range(allowed, 60, 10000);
    free(good);
}
