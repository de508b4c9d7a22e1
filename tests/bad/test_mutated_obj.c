// SPDX-License-Identifier: MIT
// A good OBJ and its library with bytes changed, lines moved or cut off, some thousand times:
// whatever the reader says, it must not crash (the sanitizer builds look closer). The mutations are
// the same in every run.
#include "test_obj.h"

#include "base/random.h"
#include "formats/obj/obj.h"

#include <stdio.h>
#include <stdlib.h>

enum { ROUNDS = 8000 };

static const char asset[] =
    "# everything the reader knows\r\nmtllib a.mtl\nmtllib no.mtl a.mtl\n"
    "v 0 0 0\nv 1.5 0 0 0.5 1 1\nv 1 +1e0 -0.0\nv 0 1 \\\n0\nv .5 .25 1e-3\nv 2 0 0\n"
    "vt 0 0\nvt 1 0.5 0\nvt 0.25\nvn 0 0 1\nvn 0 1 0\n"
    "o box\ng side top\nusemtl red\ns 1\nf 1/1/1 2/2/1 3/3/2\nf 1//1 2//2 3//1 4//-1\n"
    "o other\nusemtl two words\nf -6/-1 -5/-2 -2/-3 -3/-1\nf 1 2 5 3 4\nf 1 2 \\\r\n 3\n"
    "l 1 2\np 3\nusemtl none\nf 6 5 4\n";
static const char library[] =
    "newmtl red\nKd 1 0.5 .25\nKe 2 2 2\nd 0.5\nmap_Kd -s 2 2 1 -o 0.5 0 -clamp on a.png\n"
    "Ks 1 1 1\nNs 9\nPr .5\nPm 1\nmap_Pr a.png -bm 2\nnorm C:\\x\\A.PNG\nmap_d %61.png\n"
    "newmtl two words\nKd 0.5\nTr 0.25\nmap_Ke -mm 0 1 sub\\b.png\nmap_d a.png\n"
    "alpenglow_occlusion map_Ka\nmap_Ka a.png\n";

static uint64_t next_random(uint64_t *seed)
{
    return *seed = alpi_hash64(*seed);
}

/// Changes some bytes, most to ones that mean something here; exchanges or repeats pieces.
static size_t mutate(char *text, size_t size, uint64_t *seed)
{
    static const char signs[] = "0123456789-+.eE/ \t\n\r\\#vfnotguslmpKd\0\x7f\xff";
    const uint64_t changes = 1 + next_random(seed) % 6;
    for (uint64_t i = 0; i < changes; i++) {
        const size_t at = next_random(seed) % size, from = next_random(seed) % size;
        size_t length = next_random(seed) % 24;
        switch (next_random(seed) % 4) {
        case 0:
            text[at] = (char)next_random(seed);
            break;
        case 1: // a piece somewhere else
            length = length < size - at ? length : size - at;
            length = length < size - from ? length : size - from;
            memmove(text + at, text + from, length);
            break;
        default:
            text[at] = signs[next_random(seed) % (sizeof signs - 1)];
        }
    }
    return next_random(seed) % 4 == 0 ? next_random(seed) % size : size;
}

/// What was read is sound, whatever it was.
static void check(const alp_scene *scene)
{
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        assert_in_range(scene->triangle_surface[t], 0, scene->surface_count - 1);
        for (int k = 0; k < 3; k++) {
            assert_in_range(scene->triangles[t][k], 0, scene->vertex_count - 1);
        }
    }
}

static alp_result read_once(alp_context *context, const char *folder, const char *text, size_t size)
{
    // A copy of its own, without a zero behind it, so that the sanitizer sees a step too far.
    char *copy = malloc(size + (size == 0));
    alp_scene *scene = NULL;
    assert_non_null(copy);
    memcpy(copy, text, size);
    char path[512];
    snprintf(path, sizeof path, "%s/a.obj", folder);
    alp_result result =
        alpi_obj_scene_from_bytes(context, path, (const uint8_t *)copy, size, &scene);
    if (result == ALP_OK) {
        check(scene);
    }
    alp_scene_destroy(scene);
    free(copy);
    return result;
}

TEST_WITH_CONTEXT(changed_bytes, 1)
{
    const char *folder = test_folder();
    char text[sizeof asset];
    uint64_t seed = 1;
    int accepted = 0;
    test_write_text(test_path(folder, "a.mtl"), library);
    ASSERT_OK(context, read_once(context, folder, asset, sizeof asset - 1));
    for (int round = 0; round < ROUNDS; round++) {
        memcpy(text, asset, sizeof asset);
        const size_t size = mutate(text, sizeof asset - 1, &seed);
        accepted += read_once(context, folder, text, size) == ALP_OK;
    }
    print_message("%d of %d accepted\n", accepted, ROUNDS);
    assert_in_range(accepted, ROUNDS / 10, ROUNDS * 9 / 10);
}

TEST_WITH_CONTEXT(changed_libraries, 1)
{
    const char *folder = test_folder();
    char text[sizeof library];
    uint64_t seed = 2;
    int accepted = 0;
    for (int round = 0; round < ROUNDS / 8; round++) {
        memcpy(text, library, sizeof library);
        const size_t size = mutate(text, sizeof library - 1, &seed);
        test_write_file(test_path(folder, "a.mtl"), text, size);
        accepted += read_once(context, folder, asset, sizeof asset - 1) == ALP_OK;
    }
    print_message("%d of %d accepted\n", accepted, ROUNDS / 8);
    assert_in_range(accepted, ROUNDS / 80, ROUNDS / 8);
}

TEST_WITH_CONTEXT(cut_files, 1)
{
    const char *folder = test_folder();
    for (size_t size = 0; size < sizeof asset - 1; size++) {
        (void)!read_once(context, folder, asset, size);
        (void)!read_once(context, folder, asset + size, sizeof asset - 1 - size);
    }
}

TEST(failing_allocations)
{
    const char *folder = test_folder();
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    int allowed = 0;
    test_write_text(test_path(folder, "a.mtl"), library);
    for (; result != ALP_OK; allowed++) {
        int left = 0;
        alp_context *context = test_context_failing(&left);
        left = allowed;
        result = read_once(context, folder, asset, sizeof asset - 1);
        assert_true(result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY);
        alp_context_destroy(context);
    }
    print_message("%d allocations failed in turn\n", allowed - 1);
    assert_in_range(allowed, 40, 10000);
}
