// SPDX-License-Identifier: MIT
// Bakes that outlive their process, or are cut into shards: what they keep in a folder.
#ifndef ALPENGLOW_CHECKPOINT_H
#define ALPENGLOW_CHECKPOINT_H

#include <alpenglow/context.h>

ALP_BEGIN_DECLS

/// The checkpoint of a bake. Finished work is appended to files of a folder. The same bake, run
/// again with the same folder, reads it and goes on; its result has the bits of an undisturbed
/// bake. A process that is killed loses the work since the last write, and nothing else.
typedef struct alp_checkpoint_options {
    size_t struct_size;
    const char *folder; ///< made if missing; NULL (default): none
    double every;       ///< seconds between two writes, [0.1, 86400]; default 10. The first follows
                        ///< within 5 seconds of the first ray.
    /// One line that is kept for the caller, such as a command that runs this bake again; NULL
    /// (default): none. Later bakes may have another one.
    const char *restart;

    /// Shards: `shards` processes each do a part of the work, and exchange nothing. This one is
    /// number `shard`, in [1, shards]; 0 (default): the whole bake. A shard gathers its own
    /// tiles of the map, leaves them in the folder, and writes no outputs. Needs a folder, a fixed
    /// number of samples, and sampling.accuracy ALP_ADAPTIVE_OFF. Light: each shard solves the
    /// bounces of the whole scene.
    uint32_t shard, shards;
    /// Merge: reads the tiles of all `shards` shards instead of tracing rays, and writes the
    /// outputs of the bake. Missing tiles are INVALID_DATA: the message lists the shards.
    bool merge;
} alp_checkpoint_options;
ALP_API alp_checkpoint_options alp_checkpoint_options_default(void);

/// The state of one process of a bake, as its folder keeps it.
typedef struct alp_checkpoint_process {
    const char *name;       ///< "bake", "rank-3" or "shard-2"
    const char *phase;      ///< "running", "killed" (no process holds the lock of its tiles; where
                            ///< locks do not reach other machines, also "running" on one of them),
                            ///< "stopped" or "complete"
    const char *stage;      ///< of the bake
    uint64_t done, total;   ///< units of the stage
    double seconds;         ///< since the process began
    double seconds_left;    ///< of the stage, at the last write; negative: unknown
    double error;           ///< stated so far, relative; NaN: unknown
    uint64_t written;       ///< seconds since 1970 of the last write
    uint32_t shard, shards; ///< this one, from 1, of so many; both 0: no shard
    const char *restart;    ///< see alp_checkpoint_options
} alp_checkpoint_process;

typedef struct alp_checkpoint_info alp_checkpoint_info;

/// Reads the states of a folder.
/// @param info out, which the caller destroys; NULL on failure
/// @return ALP_OK; INVALID_ARGUMENT (NULL); IO (unreadable); INVALID_DATA (no such folder, or no
///         checkpoint in it); OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_checkpoint_read(alp_context *context, const char *folder,
                                                     alp_checkpoint_info **info);
/// The processes, in the order of their names; owned by info.
ALP_API const alp_checkpoint_process *alp_checkpoint_processes(const alp_checkpoint_info *info,
                                                               uint32_t *count);
/// Lists the shards without a complete state, as for the --array of a scheduler: "2,4-6". A list
/// longer than `room` ends in ", ..." after a whole entry.
/// @param text [room] out: "" if all are complete, or there are no shards
ALP_API void alp_checkpoint_missing(const alp_checkpoint_info *info, char *text, size_t room);
/// Number of states that could not be read.
ALP_API uint32_t alp_checkpoint_damaged(const alp_checkpoint_info *info);
ALP_API void alp_checkpoint_info_destroy(alp_checkpoint_info *info); ///< NULL does nothing

ALP_END_DECLS

#endif
