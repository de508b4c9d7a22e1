// SPDX-License-Identifier: MIT
// The table of options, from its parts: every option of the contract.
#include "options/option_parts.h"

/// In the order of help and completion.
static const option_part *const parts[] = {
    &option_part_output,    &option_part_what,  &option_part_space,   &option_part_ambience,
    &option_part_lpv,       &option_part_stop,  &option_part_picture, &option_part_light,
    &option_part_ao,        &option_part_run,   &option_part_view,    &option_part_later,
    &option_part_view_more, &option_part_scale,
};

/// Options of alpenglow itself, without a command.
static const option program_options[] = {
    {.id = OPTION_HELP,
     .kind = KIND_FLAG,
     .name = "-h",
     .alias = "--help",
     .help = "Print the commands; after a command, its options."},
    {.id = OPTION_COUNT, .kind = KIND_FLAG, .name = "--version", .help = "Print the version."},
    {.id = OPTION_COUNT,
     .kind = KIND_CHOICE,
     .name = "--completion",
     .value = "bash|zsh|fish",
     .choices = "bash|zsh|fish",
     .help = "Print a completion script for that shell: commands, options and file names."},
};

static const char *const group_titles[GROUP_COUNT] = {
    [GROUP_OUTPUT] = "Output",
    [GROUP_WHAT] = "Main",
    [GROUP_FLIGHT] = "Flight of ambience",
    [GROUP_VOLUME] = "Light propagation",
    [GROUP_PICTURE] = "Picture",
    [GROUP_AO] = "Ambient occlusion",
    [GROUP_LIGHT] = "Light",
    [GROUP_STOP] = "Quality and limits",
    [GROUP_SCALE] = "Checkpoints and shards",
    [GROUP_RUN] = "Run",
    [GROUP_LATER] = "Not built yet (refused by name)",
};

const option *option_after(command_id command, const option *last)
{
    bool behind = last == NULL;
    for (size_t p = 0; p < sizeof parts / sizeof *parts; p++) {
        for (size_t i = 0; i < parts[p]->count; i++) {
            const option *o = &parts[p]->rows[i];
            if (behind && (o->commands & (1u << command)) != 0) {
                return o;
            }
            behind = behind || o == last;
        }
    }
    return NULL;
}

const option *option_next(command_id command, option_group group, const option *last)
{
    const option *o = option_after(command, last);
    while (o != NULL && o->group != group) {
        o = option_after(command, o);
    }
    return o;
}

const option *program_option_table(size_t *count)
{
    *count = sizeof program_options / sizeof *program_options;
    return program_options;
}

const char *option_group_title(option_group group)
{
    return group_titles[group];
}
