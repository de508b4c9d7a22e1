// SPDX-License-Identifier: MIT
// Rows of the table of options: bakes that outlive a process, or are cut into shards.
#include "options/option_parts.h"

static const option rows[] = {
    {.id = OPTION_CHECKPOINT,
     .commands = IN_BAKE,
     .group = GROUP_SCALE,
     .kind = KIND_TEXT,
     .name = "--checkpoint",
     .value = "DIR",
     .help = "Keep finished work in DIR. The same command, run again, goes on from it, and ends "
             "with the same bits. After the bake, DIR keeps no work."},
    {.id = OPTION_CHECKPOINT_EVERY,
     .commands = IN_BAKE,
     .group = GROUP_SCALE,
     .kind = KIND_REAL,
     .name = "--checkpoint-every",
     .value = "S",
     .minimum = 0.1,
     .maximum = 86400.0,
     .unit = "seconds",
     .initial = "10",
     .help = "Time between two writes of the checkpoint: a kill loses at most the work of this "
             "time."},
    {.id = OPTION_SHARD,
     .commands = IN_BAKE,
     .group = GROUP_SCALE,
     .kind = KIND_TEXT,
     .name = "--shard",
     .value = "I/N",
     .help = "Bake part I of N, from 1, and leave it in the DIR of --checkpoint. slurm/N takes I "
             "from SLURM_ARRAY_TASK_ID. 'alpenglow merge DIR' writes the result. Needs fixed "
             "samples; turns --adaptive off."},
};

const option_part option_part_scale = {rows, sizeof rows / sizeof *rows};
