// SPDX-License-Identifier: MIT
// alpenglow-mpi: the command, run by the ranks of an MPI job together. Rank 0 prints and writes.
//
// The ranks meet at fixed points: when they start, after loading, and before they end. A rank that
// fails by itself comes to the next of these points, so that the others see its exit code there.
#include "captured.h"
#include "dispatch.h"
#include "interrupt.h"
#include "levels.h"
#include "printing/messages.h"
#include "ranks/ranks_mpi.h"
#include "session.h"
#include "streams.h"

#include <mpi.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// The hooks of a session have no argument of ours.
static alpi_ranks_mpi *job;
static int *codes;    // [count of ranks] of the last meeting
static bool has_met;  // after loading
static bool was_told; // another rank failed there

/// The lowest instruction set of all ranks; NULL where they have the same.
static const char *agree_on_level(void)
{
    return alpi_ranks_mpi_meet(job, levels_own(), codes)
               ? levels_lowest(codes, alpi_ranks_mpi_calls(job)->count)
               : NULL;
}

// --- meetings ------------------------------------------------------------------------------------

/// The code of the lowest rank that failed, or EXIT_DONE. @param failed out: that rank
static int first_failure(uint32_t *failed)
{
    const uint32_t count = alpi_ranks_mpi_calls(job)->count;
    for (*failed = 0; *failed < count; ++*failed) {
        if (codes[*failed] != EXIT_DONE) {
            return codes[*failed];
        }
    }
    return EXIT_DONE;
}

/// Meets with a code. The lowest rank that failed prints why, unless it is rank 0, which did.
static int meet(int code)
{
    uint32_t failed;
    const uint32_t rank = alpi_ranks_mpi_calls(job)->rank;
    if (!alpi_ranks_mpi_meet(job, code, codes)) {
        return code != EXIT_DONE ? code : EXIT_FAILED;
    }
    const int first = first_failure(&failed);
    if (first != EXIT_DONE && failed == rank && rank > 0 && !was_told) {
        captured_print(rank);
    }
    was_told = was_told || first != EXIT_DONE;
    return code != EXIT_DONE ? code : first;
}

static int meet_after_loading(int code)
{
    has_met = true;
    return meet(code);
}

/// The last two meetings, or the last alone.
static int meet_before_end(int code)
{
    if (!has_met) {
        code = meet_after_loading(code);
    }
    return meet(code);
}

// -------------------------------------------------------------------------------------------------

/// Refuses commands that ranks cannot share.
static int check_command(const char *name)
{
    static const char *const alone[] = {"render", "info",  "compare", "sample", "ambience", "lpv",
                                        "sh",     "bench", "view",    "status", "merge",    "web"};
    char text[256];
    for (size_t i = 0; name != NULL && i < sizeof alone / sizeof *alone; i++) {
        if (strcmp(name, alone[i]) == 0) {
            snprintf(text, sizeof text,
                     "%s: runs in one process; start it with 'alpenglow %s', ranks share bake and "
                     "probes",
                     name, name);
            failure(text);
            return EXIT_USAGE;
        }
    }
    return EXIT_DONE;
}

static int run_together(int count, char **words)
{
    const alp_ranks *ranks = alpi_ranks_mpi_calls(job);
    if (ranks->rank > 0) {
        captured_begin();
    }
    const session_ranks together = {
        .ranks = ranks, .max_isa = agree_on_level(), .meet = meet_after_loading};
    session_set_ranks(&together);
    int code = check_command(count > 0 ? words[0] : NULL);
    code = code == EXIT_DONE ? streams_close(command_dispatch(count, words)) : code;
    return meet_before_end(code);
}

/// Ends all ranks at once: one of them is gone, or does something else. Whoever told this rank to
/// stop ends the others.
static int abandon(int code)
{
    fflush(stdout);
    fflush(stderr);
    if (interrupt_asked()) {
        _exit(code);
    }
    MPI_Abort(MPI_COMM_WORLD, code != EXIT_DONE ? code : EXIT_FAILED);
    return code;
}

int main(int count, char **words)
{
    int level, code;
    streams_open();
    if (count > 1 && strcmp(words[1], "bake") == 0) {
        interrupt_remember(); // MPI takes its time to start
    }
    if (MPI_Init_thread(&count, &words, MPI_THREAD_FUNNELED, &level) != MPI_SUCCESS ||
        (job = alpi_ranks_mpi_create(interrupt_asked)) == NULL) {
        return failure("MPI cannot be started; start alpenglow-mpi with mpirun or srun");
    }
    const alp_ranks *ranks = alpi_ranks_mpi_calls(job);
    codes = allocate_or_exit(NULL, ranks->count * sizeof *codes);
    const int given = count > 0 ? count - 1 : 0;
    code = ranks->count > 1 ? run_together(given, words + 1)
                            : streams_close(command_dispatch(given, words + 1));
    if (alpi_ranks_mpi_is_broken(job)) {
        return abandon(code);
    }
    alpi_ranks_mpi_destroy(job);
    free(codes);
    MPI_Finalize();
    return code;
}
