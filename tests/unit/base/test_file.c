// SPDX-License-Identifier: MIT
// Files appear whole or not at all, and never in the place of one that was to be kept.
#include "test_support.h"

#include "base/file.h"
#include "base/memory.h"

#include <dirent.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

enum { LIMIT = 1000 };

static int files_in(const char *folder)
{
    DIR *directory = opendir(folder);
    assert_non_null(directory);
    int count = 0;
    for (const struct dirent *entry; (entry = readdir(directory)) != NULL;) {
        count += entry->d_name[0] != '.';
    }
    closedir(directory);
    return count;
}

static void assert_holds(const char *path, const char *text)
{
    size_t size = 0;
    unsigned char *bytes = test_read_file(path, &size);
    assert_int_equal(size, strlen(text));
    assert_memory_equal(bytes, text, size);
    free(bytes);
}

TEST_WITH_CONTEXT(what_is_written_is_read, 1)
{
    const char *folder = test_folder(), *path = test_path(folder, "a.bin");
    ASSERT_OK(context, alpi_file_write(context, path, false, "a\0b", 3));
    assert_int_equal(files_in(folder), 1); // nothing temporary is left
    uint8_t *bytes = NULL;
    size_t size = 0;
    ASSERT_OK(context, alpi_file_read(context, path, 3, &bytes, &size));
    assert_int_equal(size, 3);
    assert_memory_equal(bytes, "a\0b\0", 4); // and a zero after the end
    alpi_release(context, bytes);
    assert_int_equal(alpi_file_read(context, path, 2, &bytes, &size), ALP_ERROR_LIMIT);
    assert_null(bytes);
}

TEST_WITH_CONTEXT(nothing_is_seen_before_commit, 1)
{
    const char *folder = test_folder(), *path = test_path(folder, "a.txt");
    alpi_file_writer writer;
    ASSERT_OK(context, alpi_file_open(context, path, false, &writer));
    ASSERT_OK(context, alpi_file_append(&writer, "one ", 4));
    assert_int_not_equal(access(path, F_OK), 0);
    ASSERT_OK(context, alpi_file_append(&writer, "two", 3));
    ASSERT_OK(context, alpi_file_commit(&writer));
    assert_holds(path, "one two");
    alpi_file_abandon(&writer); // harmless
    assert_int_equal(files_in(folder), 1);
}

TEST_WITH_CONTEXT(giving_up_leaves_nothing, 1)
{
    const char *folder = test_folder(), *path = test_path(folder, "a.txt");
    ASSERT_OK(context, alpi_file_write(context, path, false, "old", 3));
    alpi_file_writer writer;
    ASSERT_OK(context, alpi_file_open(context, path, true, &writer));
    ASSERT_OK(context, alpi_file_append(&writer, "new and longer", 14));
    assert_int_equal(files_in(folder), 2);
    alpi_file_abandon(&writer);
    alpi_file_abandon(&writer);
    assert_int_equal(files_in(folder), 1);
    assert_holds(path, "old");
}

TEST_WITH_CONTEXT(a_file_is_kept_unless_it_may_go, 1)
{
    const char *folder = test_folder(), *path = test_path(folder, "a.txt");
    ASSERT_OK(context, alpi_file_write(context, path, false, "first", 5));
    assert_int_equal(alpi_file_write(context, path, false, "second", 6), ALP_ERROR_IO);
    assert_non_null(strstr(alp_context_message(context), path));
    assert_non_null(strstr(alp_context_message(context), "-f"));
    assert_holds(path, "first");
    ASSERT_OK(context, alpi_file_write(context, path, true, "second", 6));
    assert_holds(path, "second");
    assert_int_equal(files_in(folder), 1);
}

TEST_WITH_CONTEXT(a_file_that_appears_meanwhile_is_kept, 1)
{
    const char *folder = test_folder(), *path = test_path(folder, "a.txt");
    alpi_file_writer writer;
    ASSERT_OK(context, alpi_file_open(context, path, false, &writer));
    ASSERT_OK(context, alpi_file_append(&writer, "ours", 4));
    ASSERT_OK(context, alpi_file_write(context, path, false, "theirs", 6));
    assert_int_equal(alpi_file_commit(&writer), ALP_ERROR_IO);
    assert_holds(path, "theirs");
    assert_int_equal(files_in(folder), 1);
}

TEST_WITH_CONTEXT(two_writers_of_one_file_do_not_meet, 1)
{
    const char *folder = test_folder(), *path = test_path(folder, "a.txt");
    alpi_file_writer one, two;
    ASSERT_OK(context, alpi_file_open(context, path, true, &one));
    ASSERT_OK(context, alpi_file_open(context, path, true, &two));
    ASSERT_OK(context, alpi_file_append(&one, "one", 3));
    ASSERT_OK(context, alpi_file_append(&two, "two", 3));
    ASSERT_OK(context, alpi_file_commit(&two));
    assert_holds(path, "two");
    ASSERT_OK(context, alpi_file_commit(&one));
    assert_holds(path, "one");
    assert_int_equal(files_in(folder), 1);
}

static void assert_refused(alp_context *context, const char *path, const char *words)
{
    assert_int_equal(alpi_file_check_writable(context, path, true), ALP_ERROR_IO);
    assert_non_null(strstr(alp_context_message(context), words));
    assert_int_equal(alpi_file_write(context, path, true, "x", 1), ALP_ERROR_IO);
}

TEST_WITH_CONTEXT(places_that_cannot_be_written_are_named, 1)
{
    const char *folder = test_folder();
    assert_refused(context, folder, "is a folder");
    assert_refused(context, test_path(folder, "missing/a.txt"), "missing/a.txt");
    assert_refused(context, test_path(folder, ""), "a file name is needed");
    assert_refused(context, "", "a file name is needed");
    const char *pipe = test_path(folder, "pipe");
    assert_int_equal(mkfifo(pipe, 0600), 0);
    assert_refused(context, pipe, "not a regular file");
    assert_int_equal(files_in(folder), 1);
}

TEST_WITH_CONTEXT(places_that_cannot_be_read_are_named, 1)
{
    const char *folder = test_folder();
    uint8_t *bytes = NULL;
    size_t size = 0;
    const char *missing = test_path(folder, "missing");
    assert_int_equal(alpi_file_read(context, missing, LIMIT, &bytes, &size), ALP_ERROR_IO);
    assert_non_null(strstr(alp_context_message(context), missing));
    assert_int_equal(alpi_file_read(context, folder, LIMIT, &bytes, &size), ALP_ERROR_IO);
    assert_non_null(strstr(alp_context_message(context), "folder"));
    const char *pipe = test_path(folder, "pipe"); // nobody writes: waiting would be for ever
    assert_int_equal(mkfifo(pipe, 0600), 0);
    assert_int_equal(alpi_file_read(context, pipe, LIMIT, &bytes, &size), ALP_ERROR_IO);
    assert_null(bytes);
}

TEST_WITH_CONTEXT(folders_are_made_with_their_parents, 1)
{
    const char *folder = test_folder(), *deep = test_path(folder, "a//b/c/");
    struct stat status;
    ASSERT_OK(context, alpi_folder_create(context, deep));
    ASSERT_OK(context, alpi_folder_create(context, deep)); // there already
    assert_true(stat(deep, &status) == 0 && S_ISDIR(status.st_mode));
    const char *file = test_path(folder, "file");
    ASSERT_OK(context, alpi_file_write(context, file, false, "x", 1));
    assert_int_equal(alpi_folder_create(context, file), ALP_ERROR_IO);
    assert_int_equal(alpi_folder_create(context, test_path(folder, "file/b")), ALP_ERROR_IO);
    assert_int_equal(alpi_folder_create(context, ""), ALP_ERROR_IO);
}

TEST_WITH_CONTEXT(paths_are_taken_apart, 1)
{
    const char *const paths[][3] = {
        {"a/b/c.glb", "a/b/", "c.glb"}, {"c.glb", "", "c.glb"}, {"/c", "/", "c"}, {"a/", "a/", ""}};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        char *folder = alpi_path_folder(context, paths[i][0]);
        assert_string_equal(folder, paths[i][1]);
        assert_string_equal(alpi_path_name(paths[i][0]), paths[i][2]);
        alpi_release(context, folder);
    }
    assert_true(alpi_path_has_ending("x.GLB", ".glb"));
    assert_false(alpi_path_has_ending("glb", ".glb"));
    assert_false(alpi_path_has_ending("x.glb.txt", ".glb"));
}
