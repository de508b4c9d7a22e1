// SPDX-License-Identifier: MIT
// alpenglow merge: writes the result of a bake whose shards are complete. It runs the command of
// the shards again, which reads their tiles instead of tracing rays.
#include "bake_defaults.h"
#include "commands/commands.h"
#include "output.h"
#include "printing/messages.h"
#include "scale/checkpoints.h"

#include <alpenglow/alpenglow.h>

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/// The absolute form of a path that may not exist yet. The caller frees it.
static char *make_absolute(const char *path)
{
    char folder[PATH_MAX] = "";
    const bool is_absolute = path[0] == '/' || getcwd(folder, sizeof folder) == NULL;
    const size_t size = strlen(folder) + strlen(path) + 2;
    char *text = allocate_or_exit(NULL, size);
    snprintf(text, size, is_absolute ? "%s%s" : "%s/%s", is_absolute ? "" : folder, path);
    return text;
}

static bool is_asset(const char *path)
{
    static const char *const endings[] = {".glb", ".gltf", ".dae", ".obj", ".json", ".babylon"};
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        if (path_ends(path, endings[i])) {
            return true;
        }
    }
    return false;
}

/// Whether a path names a folder: it is one, ends in a slash, or has no ending.
static bool is_folder(const char *path)
{
    struct stat status;
    const char *slash = strrchr(path, '/'), *name = slash != NULL ? slash + 1 : path;
    return (stat(path, &status) == 0 && S_ISDIR(status.st_mode)) || strrchr(name, '.') == NULL;
}

/// Refuses an output that is neither an asset nor a folder.
static int check_output(const char *path)
{
    return path == NULL || is_asset(path) || is_folder(path)
               ? EXIT_DONE
               : usage_error(COMMAND_MERGE,
                             "-o %s: need an asset (.glb, .gltf, .dae, .obj, .json, .babylon) or a "
                             "folder of maps; a folder with this name ends in a slash",
                             path);
}

/// Gives options of outputs their defaults.
static void reset(command_line *bake, const option_id *ids, size_t count)
{
    char scene[] = "builtin:cornell", *words[] = {scene};
    command_line plain;
    (void)arguments_parse(COMMAND_BAKE, 1, words, &plain);
    for (size_t i = 0; i < count; i++) {
        bake->values[ids[i]] = plain.values[ids[i]];
    }
}

/// Replaces the outputs of a bake by one asset or one folder of maps.
static void replace_outputs(command_line *bake, const char *output)
{
    static const option_id of_folders[] = {OPTION_MAPS_FOLDER, OPTION_MAPS_AS};
    static const option_id of_assets[] = {OPTION_OUTPUT, OPTION_LIGHTMAP_AS, OPTION_UNITS,
                                          OPTION_LIGHTMAP_FORMAT};
    const option_value given = {.given = true, .text = output};
    const option_value form = bake->values[OPTION_LIGHTMAP_AS];
    const char *note;
    free(bake_defaults_fill(bake, &note)); // the name of the bake's asset may choose its maps
    bake->values[OPTION_LIGHTMAP_AS] = form;
    if (is_folder(output)) {
        reset(bake, of_assets, sizeof of_assets / sizeof *of_assets);
        bake->values[OPTION_MAPS_FOLDER] = given;
    } else {
        reset(bake, of_folders, sizeof of_folders / sizeof *of_folders);
        bake->values[OPTION_OUTPUT] = given;
    }
}

/// Adds what the merge itself was given: the output, -f, and how it reports.
static void add_own_options(const command_line *a, const char *output, command_line *bake)
{
    static const option_id own[] = {OPTION_FORCE, OPTION_QUIET, OPTION_THREADS};
    if (output != NULL) {
        replace_outputs(bake, output);
    }
    for (size_t i = 0; i < sizeof own / sizeof *own; i++) {
        if (a->values[own[i]].given) {
            bake->values[own[i]] = a->values[own[i]];
        }
    }
}

static int run(const command_line *a, const alp_checkpoint_process *process)
{
    const char *out = a->values[OPTION_OUTPUT].text;
    restart_words words;
    command_line bake;
    if (!restart_parse(process->restart, &words)) {
        restart_release(&words);
        return failure("merge: the checkpoint does not keep its command; run the bake again with "
                       "names in UTF-8");
    }
    char *folder = make_absolute(a->operands[0]);
    char *output = out != NULL ? make_absolute(out) : NULL;
    int code = EXIT_FAILED;
    if (chdir(words.folder) != 0) {
        fprintf(stderr, "alpenglow: merge: %s: the folder of the bake cannot be entered: %s\n",
                words.folder, strerror(errno));
    } else {
        code = arguments_parse(COMMAND_BAKE, words.count, words.words, &bake);
    }
    if (code == EXIT_DONE) {
        add_own_options(a, output, &bake);
        bake.merging = true;
        bake.merged_shards = process->shards;
        bake.merged_folder = folder;
        code = command_bake(&bake);
    }
    restart_release(&words);
    free(folder);
    free(output);
    return code;
}

/// Any shard tells the command: all of them have the same settings.
static int merge(const command_line *a, const alp_checkpoint_info *info)
{
    uint32_t count = 0;
    const alp_checkpoint_process *p = alp_checkpoint_processes(info, &count);
    for (uint32_t i = 0; i < count; i++) {
        if (p[i].shards > 0) {
            return run(a, &p[i]);
        }
    }
    return failure("merge: the folder keeps no shards; run the bake itself again, it goes on from "
                   "its checkpoint");
}

int command_merge(const command_line *a)
{
    if (check_output(a->values[OPTION_OUTPUT].text) != EXIT_DONE) {
        return EXIT_USAGE;
    }
    return checkpoint_run(a, merge);
}
