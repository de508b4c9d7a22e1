// SPDX-License-Identifier: MIT
#include "dispatch.h"

#include "commands/commands.h"
#include "compare_assets.h"
#include "interrupt.h"
#include "library.h"
#include "printing/messages.h"

#include <alpenglow/alpenglow.h>

#include <stdio.h>
#include <string.h>

static int (*const runs[COMMAND_COUNT])(const command_line *arguments) = {
    [COMMAND_BAKE] = command_bake,
    [COMMAND_RENDER] = command_render,
    [COMMAND_INFO] = command_info,
    [COMMAND_COMPARE] = command_compare,
    [COMMAND_SAMPLE] = command_sample,
    [COMMAND_PROBES] = command_probes,
    [COMMAND_AMBIENCE] = command_ambience,
    [COMMAND_LPV] = command_lpv,
    [COMMAND_SH] = command_sh,
    [COMMAND_BENCH] = command_bench,
    [COMMAND_VIEW] = command_view,
    [COMMAND_STATUS] = command_status,
    [COMMAND_MERGE] = command_merge,
    [COMMAND_WEB] = command_web,
};

/// Proposes commands for a scene that stands alone.
static void propose(const char *scene)
{
    fputs("alpenglow: ", stderr);
    print_clean(stderr, scene);
    fputs(": a scene, without a command; give one:\n  alpenglow info ", stderr);
    print_clean(stderr, scene);
    fputs("  its contents and faults\n  alpenglow bake ", stderr);
    print_clean(stderr, scene);
    fputs("  occlusion; --sky 1 or another light for light\nTry 'alpenglow --help'.\n", stderr);
}

/// Whether a word names a file: no command has a dot or a slash.
static bool names_file(const char *word)
{
    return word[0] != '-' && strpbrk(word, "./") != NULL;
}

/// Says what a file is that stands alone: a scene whose ending is unusual, or no scene.
static void explain_file(const char *path)
{
    alp_context *context = NULL;
    alp_scene *scene = NULL;
    alp_result result = alp_context_create(NULL, &context);
    if (result == ALP_OK) {
        result = alp_scene_load(context, path, &scene);
    }
    if (result == ALP_OK) {
        propose(path);
    } else {
        failure(context != NULL ? alp_context_message(context) : alp_result_name(result));
    }
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

/// alpenglow alone.
static int print_examples(void)
{
    fputs("alpenglow: no command; three to begin with:\n"
          "  alpenglow info scene.glb             its contents and faults\n"
          "  alpenglow bake scene.glb             occlusion, into scene.baked.glb\n"
          "  alpenglow bake scene.glb lit.glb --maps light --sky 1\n"
          "                                       light of its lamps and of a white sky\n"
          "Try 'alpenglow --help'.\n",
          stderr);
    return EXIT_USAGE;
}

/// An option before any command.
static void refuse_option(const char *name)
{
    for (command_id i = 0; i < COMMAND_COUNT; i++) {
        if (option_find(i, name, strcspn(name, "=")) != NULL) {
            usage_error(COMMAND_COUNT, "%s: the command comes first, as in alpenglow %s SCENE %s",
                        name, command_table()[i].name, name);
            return;
        }
    }
    usage_error(
        COMMAND_COUNT,
        "unknown option '%s'; the command comes first: bake, render, info, compare or bench", name);
}

/// The command of this name, or COMMAND_COUNT after a message.
static command_id find_command(const char *name)
{
    for (command_id i = 0; i < COMMAND_COUNT; i++) {
        if (strcmp(command_table()[i].name, name) == 0) {
            return i;
        }
    }
    const char *nearest = command_nearest(name);
    if (compare_is_scene(name)) {
        propose(name);
    } else if (names_file(name)) {
        explain_file(name);
    } else if (name[0] == '-') {
        refuse_option(name);
    } else if (nearest != NULL) {
        usage_error(COMMAND_COUNT, "unknown command '%s'; did you mean %s?", name, nearest);
    } else {
        usage_error(COMMAND_COUNT, "unknown command '%s'", name);
    }
    return COMMAND_COUNT;
}

static int run_command(int count, char **words)
{
    command_id id = find_command(words[0]);
    if (id == COMMAND_COUNT) {
        return EXIT_USAGE;
    }
    if (id == COMMAND_BAKE) {
        interrupt_remember();
    }
    const help_request request = arguments_ask_for_help(count - 1, words + 1);
    if (request != HELP_NONE) {
        return help_print_command(id, request);
    }
    command_line parsed;
    int code = arguments_parse(id, count - 1, words + 1, &parsed);
    return code == EXIT_DONE ? runs[id](&parsed) : code;
}

/// Prints the manual page of a command, or of alpenglow itself. The build installs these pages.
static int print_manual(int count, char **words)
{
    command_id id = count > 0 ? find_command(words[0]) : COMMAND_COUNT;
    if (count > 0 && id == COMMAND_COUNT) {
        return EXIT_USAGE;
    }
    return count > 0 ? manual_print_command(id) : manual_print();
}

/// Prints the commands, a line each, for the build.
static int print_commands(void)
{
    for (int i = 0; i < COMMAND_COUNT; i++) {
        puts(command_table()[i].name);
    }
    return EXIT_DONE;
}

/// Options without a command. Those that --help leaves out are for the build.
static int dispatch_option(int count, char **words)
{
    if (strcmp(words[0], "--version") == 0) {
        printf("alpenglow %s\n", alp_version());
        return EXIT_DONE;
    }
    if (strcmp(words[0], "--completion") == 0) {
        return completion_print(count > 1 ? words[1] : "");
    }
    if (strcmp(words[0], "--man") == 0) {
        return print_manual(count - 1, words + 1);
    }
    if (strcmp(words[0], "--commands") == 0) {
        return print_commands();
    }
    return run_command(count, words);
}

int command_dispatch(int count, char **words)
{
    if (library_check() != EXIT_DONE) {
        return EXIT_FAILED;
    }
    if (count < 1) {
        return print_examples();
    }
    if (arguments_ask_for_help(1, words) != HELP_NONE) {
        return help_print();
    }
    if (strcmp(words[0], "help") == 0) {
        const command_id id = count > 1 ? find_command(words[1]) : COMMAND_COUNT;
        const bool all = count > 2 && strcmp(words[2], "all") == 0;
        return count == 1            ? help_print()
               : id == COMMAND_COUNT ? EXIT_USAGE
                                     : help_print_command(id, all ? HELP_ALL : HELP_COMMON);
    }
    return dispatch_option(count, words);
}
