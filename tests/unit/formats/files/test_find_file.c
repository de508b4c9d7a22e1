// SPDX-License-Identifier: MIT
// Files that an asset names, found as people's files name them.
#include "test_obj.h"

#include "base/memory.h"
#include "formats/files/find_file.h"

#include <stdio.h>
#include <sys/stat.h>

typedef struct wanted {
    const char *from, *name, *path; // path NULL: outside
    alpi_found found;
} wanted;

static void check(alp_context *context, const char *folder, const wanted *cases, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        char *path = NULL;
        alpi_found found;
        ASSERT_OK(context,
                  alpi_find_file(context, folder, cases[i].from, cases[i].name, &path, &found));
        if (found != cases[i].found || (path == NULL) != (cases[i].path == NULL) ||
            (path != NULL && strcmp(path, cases[i].path) != 0)) {
            fail_msg("\"%s\" from \"%s\": %s, %d", cases[i].name, cases[i].from,
                     path != NULL ? path : "outside", (int)found);
        }
        alpi_release(context, path);
    }
}

/// "FOLDER/" with a.png, Wood.PNG, my wood.png, hölzern.png, sub/b.png and Sub2/C.png.
static const char *make_folder(void)
{
    static char folder[512];
    static const char *const files[] = {"a.png",     "Wood.PNG",   "my wood.png",
                                        "sub/b.png", "Sub2/C.png", "h\xc3\xb6lzern.png"};
    const char *made = test_folder();
    mkdir(test_path(made, "sub"), 0777);
    mkdir(test_path(made, "Sub2"), 0777);
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        test_write_text(test_path(made, files[i]), files[i]);
    }
    snprintf(folder, sizeof folder, "%s/", made);
    return folder;
}

TEST_WITH_CONTEXT(names_of_people, 1)
{
    static const wanted cases[] = {
        {"", "a.png", "a.png", ALPI_FOUND_AS_NAMED},
        {"", "./sub/../a.png", "a.png", ALPI_FOUND_AS_NAMED},
        {"", "sub\\b.png", "sub/b.png", ALPI_FOUND_AS_NAMED},
        {"sub/", "b.png", "sub/b.png", ALPI_FOUND_AS_NAMED},
        {"sub/", "../a.png", "a.png", ALPI_FOUND_AS_NAMED},
        {"", "wood.png", "Wood.PNG", ALPI_FOUND_OTHER_CASE},
        {"", "SUB/B.png", "sub/b.png", ALPI_FOUND_OTHER_CASE},
        {"", "sub2\\c.PNG", "Sub2/C.png", ALPI_FOUND_OTHER_CASE},
        {"", "my%20wood.png", "my wood.png", ALPI_FOUND_AS_NAMED},
        // by the last parts of a path of another machine, the longest that is there
        {"", "C:\\Users\\someone\\a.png", "a.png", ALPI_FOUND_BY_NAME},
        {"", "c:/models/sub/b.png", "sub/b.png", ALPI_FOUND_BY_NAME},
        {"", "\\\\host\\share\\WOOD.png", "Wood.PNG", ALPI_FOUND_BY_NAME},
        {"", "/home/someone/a.png", "a.png", ALPI_FOUND_BY_NAME},
        {"", "file:///D:/x/my%20wood.png", "my wood.png", ALPI_FOUND_BY_NAME},
        {"", "../textures/a.png", "a.png", ALPI_FOUND_BY_NAME},
        {"", "textures/a.png", "a.png", ALPI_FOUND_BY_NAME},
        // in Latin-1
        {"", "h\xf6lzern.png", "h\xc3\xb6lzern.png", ALPI_FOUND_AS_NAMED},
        {"", "D:\\h\xf6lzern.png", "h\xc3\xb6lzern.png", ALPI_FOUND_BY_NAME},
        // not there
        {"", "gone.png", "gone.png", ALPI_FOUND_NOTHING},
        {"", "sub", "sub", ALPI_FOUND_NOTHING}, // a folder
        {"", "C:\\gone.png", NULL, ALPI_FOUND_NOTHING},
        {"", "/etc/passwd", NULL, ALPI_FOUND_NOTHING},
        {"", "../gone.png", NULL, ALPI_FOUND_NOTHING},
        {"", "", NULL, ALPI_FOUND_NOTHING},
    };
    check(context, make_folder(), cases, sizeof cases / sizeof *cases);
}

/// Escapes are decoded before; a backslash that was one is part of the name where a file has it.
TEST_WITH_CONTEXT(uris, 1)
{
    static const struct {
        const char *uri, *path; // from the folder; NULL: outside
        alpi_found found;
    } cases[] = {{"a.png", "a.png", ALPI_FOUND_AS_NAMED},
                 {"100%25.png", "100%25.png", ALPI_FOUND_AS_NAMED}, // once
                 {"back\\slash.png", "back\\slash.png", ALPI_FOUND_AS_NAMED},
                 {"wood.png", "Wood.PNG", ALPI_FOUND_OTHER_CASE},
                 {"file:///D:/x/A.png", "a.png", ALPI_FOUND_BY_NAME},
                 {"http://localhost/sub/b.png", "sub/b.png", ALPI_FOUND_BY_NAME},
                 {"gone.png", "gone.png", ALPI_FOUND_NOTHING},
                 {"http://localhost/gone.png", NULL, ALPI_FOUND_NOTHING},
                 {"file:///etc/passwd", NULL, ALPI_FOUND_NOTHING},
                 {"/etc/passwd", NULL, ALPI_FOUND_NOTHING},
                 {"../gone.png", NULL, ALPI_FOUND_NOTHING}};
    const char *folder = make_folder();
    test_write_text(test_path(folder, "100%25.png"), "x");
    test_write_text(test_path(folder, "100%.png"), "x");
    test_write_text(test_path(folder, "back\\slash.png"), "x");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *path = NULL, expected[600];
        alpi_found found;
        ASSERT_OK(context, alpi_find_uri(context, folder, cases[i].uri, &path, &found));
        assert_int_equal(found, cases[i].found);
        assert_int_equal(path == NULL, cases[i].path == NULL);
        if (path != NULL) {
            snprintf(expected, sizeof expected, "%s%s", folder, cases[i].path);
            assert_string_equal(path, expected);
        }
        alpi_release(context, path);
    }
}

TEST(outside_where_it_is_allowed)
{
    char folder[600], absolute[600];
    alp_context_options options = alp_context_options_default();
    options.worker_count = 1;
    options.read_outside = true;
    alp_context *open = NULL;
    assert_int_equal(alp_context_create(&options, &open), ALP_OK);
    const char *made = make_folder();
    snprintf(folder, sizeof folder, "%ssub/", made);
    snprintf(absolute, sizeof absolute, "%sa.png", made);
    const wanted cases[] = {{"", "../a.png", "../a.png", ALPI_FOUND_AS_NAMED},
                            {"", absolute, absolute, ALPI_FOUND_AS_NAMED},
                            {"", "../A.png", "../a.png", ALPI_FOUND_OTHER_CASE},
                            {"", "/gone/b.png", "b.png", ALPI_FOUND_BY_NAME}};
    check(open, folder, cases, sizeof cases / sizeof *cases);
    alp_context_destroy(open);
}

TEST(failing_allocations)
{
    const char *folder = make_folder();
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    for (int allowed = 0; result != ALP_OK; allowed++) {
        int left = allowed;
        char *path = NULL;
        alpi_found found;
        alp_context *context = test_context_failing(&left);
        left = allowed;
        result = alpi_find_uri(context, folder, "C:/x/sub/H\xd6LZERN%2epng", &path, &found);
        assert_true(result == ALP_OK || (result == ALP_ERROR_OUT_OF_MEMORY && path == NULL));
        alpi_release(context, path);
        left = result == ALP_OK ? allowed : 0;
        result = alpi_find_file(context, folder, "", "C:/x/sub/MY%20WOOD.png", &path, &found);
        assert_true(result == ALP_OK || (result == ALP_ERROR_OUT_OF_MEMORY && path == NULL));
        alpi_release(context, path);
        alp_context_destroy(context);
        assert_in_range(allowed, 0, 100);
    }
}
