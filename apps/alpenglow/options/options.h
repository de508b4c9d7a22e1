// SPDX-License-Identifier: MIT
// The one table of commands and options: parsing, --help and completion all read it.
#ifndef COMMAND_OPTIONS_H
#define COMMAND_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// Exit codes of the contract.
enum { EXIT_DONE = 0, EXIT_FAILED = 1, EXIT_USAGE = 2, EXIT_STOPPED = 75, EXIT_INTERRUPTED = 130 };

typedef enum command_id {
    COMMAND_BAKE,
    COMMAND_RENDER,
    COMMAND_INFO,
    COMMAND_COMPARE,
    COMMAND_SAMPLE,
    COMMAND_PROBES,
    COMMAND_AMBIENCE,
    COMMAND_LPV,
    COMMAND_SH,
    COMMAND_BENCH,
    COMMAND_VIEW,
    COMMAND_STATUS,
    COMMAND_MERGE,
    COMMAND_WEB,
    COMMAND_COUNT
} command_id;

enum {
    IN_BAKE = 1 << COMMAND_BAKE,
    IN_RENDER = 1 << COMMAND_RENDER,
    IN_INFO = 1 << COMMAND_INFO,
    IN_COMPARE = 1 << COMMAND_COMPARE,
    IN_SAMPLE = 1 << COMMAND_SAMPLE,
    IN_PROBES = 1 << COMMAND_PROBES,
    IN_AMBIENCE = 1 << COMMAND_AMBIENCE,
    IN_LPV = 1 << COMMAND_LPV,
    IN_SH = 1 << COMMAND_SH,
    IN_BENCH = 1 << COMMAND_BENCH,
    IN_VIEW = 1 << COMMAND_VIEW,
    IN_STATUS = 1 << COMMAND_STATUS,
    IN_MERGE = 1 << COMMAND_MERGE,
    IN_WEB = 1 << COMMAND_WEB,
};

/// Every option that can be given; OPTION_LATER stands for all that are not built yet.
typedef enum option_id {
    OPTION_OUTPUT,
    OPTION_MAPS,
    OPTION_MAPS_FOLDER,
    OPTION_MAPS_AS,
    OPTION_SIZE,
    OPTION_TEXELS_PER_METRE,
    OPTION_ATLAS,
    OPTION_PADDING,
    OPTION_BLOCK,
    OPTION_MIPS,
    OPTION_DENSITY,
    OPTION_VERTEX_ATTRIBUTE,
    OPTION_ONLY,
    OPTION_OCCLUDERS,
    OPTION_AT,
    OPTION_PROBES,
    OPTION_SPACING,
    OPTION_BOUNDS,
    OPTION_BASIS,
    OPTION_VISIBILITY,
    OPTION_WARM,
    OPTION_GRADIENTS,
    OPTION_LOOKUP,
    OPTION_EXPORT,
    OPTION_EXPORT_SCALE,
    OPTION_OBJECT,
    OPTION_OBJECT_PATH,
    OPTION_OVERLAY,
    OPTION_PATH,
    OPTION_TIME,
    OPTION_FPS,
    OPTION_BUDGET,
    OPTION_BUDGET_MS,
    OPTION_PREDICTION,
    OPTION_DAY,
    OPTION_CELL,
    OPTION_DEPTH,
    OPTION_ANCHORS,
    OPTION_LIFETIME,
    OPTION_FADE,
    OPTION_FLAT,
    OPTION_DETAIL,
    OPTION_CSV,
    OPTION_PREVIEW,
    OPTION_ERRORS,
    OPTION_REFERENCE_SAMPLES,
    OPTION_GRID,
    OPTION_CASCADES,
    OPTION_ITERATIONS,
    OPTION_MODE,
    OPTION_BLOCKERS,
    OPTION_MAP_SIZE,
    OPTION_FRAMES,
    OPTION_SUN_TURN,
    OPTION_VOLUME,
    OPTION_GLOSS,
    OPTION_MEDIA,
    OPTION_AO_SAMPLES,
    OPTION_AO_DISTANCE,
    OPTION_AO_FALLOFF,
    OPTION_AO_CONE,
    OPTION_AO_DISTRIBUTION,
    OPTION_AO_SELF,
    OPTION_ONE_SIDED,
    OPTION_AO_BLEED,
    OPTION_EXISTING_AO,
    OPTION_AO_INTO,
    OPTION_LIGHTMAP_AS,
    OPTION_UNITS,
    OPTION_LIGHTMAP_FORMAT,
    OPTION_BOUNCES,
    OPTION_GATHER,
    OPTION_HEMICUBE,
    OPTION_EMITTERS,
    OPTION_DIRECT,
    OPTION_LAYERS,
    OPTION_DENOISE,
    OPTION_STITCH,
    OPTION_METALS,
    OPTION_SKY,
    OPTION_SKY_TURN,
    OPTION_SKY_STRENGTH,
    OPTION_SUN,
    OPTION_SUN_SIZE,
    OPTION_LAMP,
    OPTION_SPOT,
    OPTION_QUALITY,
    OPTION_ERROR,
    OPTION_TIME_LIMIT,
    OPTION_MEMORY_LIMIT,
    OPTION_ADAPTIVE,
    OPTION_KEEP_PARTIAL,
    OPTION_WITH,
    OPTION_SCENE,
    OPTION_ANIMATION,
    OPTION_ANIMATION_TIME,
    OPTION_ALLOW_OUTSIDE,
    OPTION_CAMERA,
    OPTION_RESOLUTION,
    OPTION_SHOW,
    OPTION_SAMPLES,
    OPTION_TEXEL_SAMPLES,
    OPTION_EXPOSURE,
    OPTION_TONE,
    OPTION_WHITE_BALANCE,
    OPTION_SCALE,
    OPTION_MAX_RMSE,
    OPTION_MAP,
    OPTION_POINTS,
    OPTION_HEATMAP,
    OPTION_READ,
    OPTION_NORMAL_MAPS,
    OPTION_REFERENCE,
    OPTION_REFERENCE_THRESHOLD,
    OPTION_CONVENTION,
    OPTION_CAPTURE,
    OPTION_BESIDE,
    OPTION_DIVIDER,
    OPTION_SSAO,
    OPTION_SSAO_RADIUS,
    OPTION_BENCH_SCENE,
    OPTION_QUICK,
    OPTION_MARKDOWN,
    OPTION_CHECKPOINT,
    OPTION_CHECKPOINT_EVERY,
    OPTION_SHARD,
    OPTION_SEED,
    OPTION_THREADS,
    OPTION_PROGRESS,
    OPTION_JSON,
    OPTION_REPORT,
    OPTION_PICTURES,
    OPTION_WARNINGS_AS_ERRORS,
    OPTION_QUIET,
    OPTION_FORCE,
    OPTION_HELP, // has precedence over all others
    OPTION_COUNT,
    OPTION_LATER
} option_id;

typedef enum option_group {
    GROUP_OUTPUT,
    GROUP_WHAT,
    GROUP_FLIGHT,
    GROUP_VOLUME,
    GROUP_PICTURE,
    GROUP_AO,
    GROUP_LIGHT,
    GROUP_STOP,
    GROUP_SCALE,
    GROUP_RUN,
    GROUP_LATER,
    GROUP_COUNT
} option_group;

typedef enum option_kind {
    KIND_FLAG,   // no value; with `value`, one may follow: - or a .json
    KIND_TEXT,   // any text that is not empty
    KIND_CHOICE, // one of `choices`
    KIND_LIST,   // some of `choices`, with commas between
    KIND_WHOLE,  // a whole number in [minimum, maximum], or one of `choices`
    KIND_REAL,   // a number in [minimum, maximum], or one of `choices`
    KIND_SIZE,   // bytes: a whole number with an optional K, M, G (of 1024), in [minimum, maximum]
} option_kind;

typedef struct option {
    option_id id;
    unsigned commands; // which commands have it: IN_…
    option_group group;
    option_kind kind;
    unsigned common;           // commands whose --help begins with it; --help all has the others
    bool repeats;              // may be given several times (KIND_TEXT): command_line.repeated
    bool sides;                // KIND_WHOLE: a side of a square, also 1k or 1024x1024
    const char *name;          // "--size"
    const char *alias;         // a second spelling, or NULL
    const char *value;         // name of its value, NULL for a flag
    const char *choices;       // "auto|keep|charts", or NULL
    const char *later_choices; // choices of the contract that are not built yet, or NULL
    const char *synonyms;      // "lightmap=light|...": other words for choices, or NULL
    double minimum, maximum;
    const char *unit;    // "metres", or NULL
    const char *initial; // the default, parsed like a given value; or NULL
    const char *example; // a value for messages, or NULL
    const char *help;    // for options not built yet: the alternative
} option;

/// The value of an option. A number has choice −1; a list has bit i of `whole` for its choice i.
typedef struct option_value {
    bool given;
    const char *text;
    int choice;
    uint64_t whole;
    double real;
} option_value;

enum { REPEAT_LIMIT = 64 }; ///< of all options that repeat together

/// A parsed command line.
typedef struct command_line {
    command_id command;
    char **words; // [word_count] as they were given, after the command's name
    int word_count;
    const char *operands[2]; // SCENE, or A and B
    option_value values[OPTION_COUNT];
    struct {
        option_id id;
        const char *text;
    } repeated[REPEAT_LIMIT]; // [repeated_count], as they were given; `values` has the last of each
    int repeated_count;
    bool merging;              // a merge runs this bake: it reads shards
    uint32_t merged_shards;    // how many
    const char *merged_folder; // where they are
} command_line;

typedef struct command_entry {
    const char *name;
    const char *synopsis;
    const char *summary;
    int operand_count; // −n: up to n, none is needed
    const char *help;  // paragraph under the synopsis
} command_entry;

const command_entry *command_table(void);          ///< [COMMAND_COUNT]
const option *program_option_table(size_t *count); ///< of alpenglow itself, before any command
const char *const *builtin_scene_names(size_t *count);
const char *builtin_scene_settings(void); ///< lines with the settings of built-in scenes
const char *option_group_title(option_group group);
/// The options that a command has, in order: the one after `last`, or the first (NULL).
/// @return NULL after the last one
const option *option_after(command_id command, const option *last);
/// The same within one group.
const option *option_next(command_id command, option_group group, const option *last);
/// Whether a command reads a SCENE, which may be a built-in one.
bool command_has_scene(command_id command);
/// Whether a command makes pictures, to which it adds light straight from lamps and suns itself.
bool command_is_picture(command_id command);
/// Largest number of operands of a command.
int command_operand_limit(command_id command);
/// Whether Ctrl-C ends the command cleanly with EXIT_INTERRUPTED.
bool command_interruptible(command_id command);

/// The name of an option of the command.
const char *option_name(command_id command, option_id id);
/// The name of the first of these options that is given, or NULL.
const char *option_find_given(const command_line *arguments, const option_id *ids, size_t count);
/// Gives an option a value, as if it stood on the command line. @param text a value that it takes
void option_give(command_line *arguments, option_id id, const char *text);
/// The option of this name that the command has, or NULL.
const option *option_find(command_id command, const char *name, size_t length);
/// Writes the range of a numeric option, such as "1 to 64 texels, or auto".
void option_range(const option *option, char *text, size_t size);
/// Writes "Range 1 to 64 texels. Default 2.", as far as the option has them.
void option_facts(const option *option, char *text, size_t size);
enum { OPTION_FACTS_SIZE = 256 }; ///< size for option_facts
/// The known option or command nearest to a misspelt one, or NULL if none is near.
const char *option_nearest(command_id command, const char *name);
const char *command_nearest(const char *name);
/// Writes the choice nearest to a misspelt word, "" if none is near. @param choices "a|b|c", or
/// NULL
void choice_nearest(const char *choices, const char *word, size_t length, char *nearest,
                    size_t size);

typedef enum help_request {
    HELP_NONE,
    HELP_COMMON, // the options that people use, where a command marks some
    HELP_ALL
} help_request;
/// Whether one of the words before "--" is --help or -h, and the next one is all.
help_request arguments_ask_for_help(int count, char **words);
/// Parses the words after the command's name. @return EXIT_DONE, or EXIT_USAGE after a message.
int arguments_parse(command_id command, int count, char **words, command_line *parsed);

/// Strict numbers: the whole text, no blanks, no hexadecimal, no NaN, no infinity.
typedef enum number_result { NUMBER_OK, NUMBER_NONE, NUMBER_TOO_LARGE } number_result;
number_result number_parse_whole(const char *text, uint64_t *number);
/// A side of a square: "1024", "1k" or "1024x1024".
number_result number_parse_side(const char *text, uint64_t *number);
number_result number_parse_size(const char *text, uint64_t *number);
number_result number_parse_real(const char *text, double *number);
/// Exactly `count` numbers of at most 1e9 with commas between; a slash ends a list too.
/// @return the end of the last one, or NULL
const char *number_parse_list(const char *text, double *numbers, int count);

/// Prints "alpenglow COMMAND: message" and a hint to --help, to stderr. @return EXIT_USAGE
int usage_error(command_id command, const char *format, ...) __attribute__((format(printf, 2, 3)));

int help_print(void); ///< of the whole program, to stdout
int help_print_command(command_id command, help_request request); ///< to stdout
int manual_print(void); ///< alpenglow.1, as roff, to stdout
int manual_print_command(command_id command);
int completion_print(const char *shell); ///< "bash", "zsh" or "fish"; to stdout

#endif
