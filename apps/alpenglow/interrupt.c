// SPDX-License-Identifier: MIT
// Ctrl-C and SIGTERM: end at once, or cancel long work.
#include "interrupt.h"

#include "options/options.h"

#include <signal.h>
#include <stdatomic.h>
#include <stddef.h>
#include <unistd.h>

// A handler has no argument of ours; lock-free atomics may be used in one.
static atomic_int asked;
static atomic_int deferred;
static atomic_int keeps_work;
static atomic_int remembers;
static atomic_int remembered;

static bool is_stop(int signal_number)
{
    return signal_number == SIGTERM || signal_number == SIGUSR1;
}

static void end_at_once(int signal_number)
{
    static const char interrupted[] = "\nalpenglow: interrupted at once\n";
    static const char stopped[] = "\nalpenglow: stopped before the bake began; the same command "
                                  "runs it\n";
    const bool stops =
        atomic_load(&keeps_work) && !atomic_load(&deferred) && is_stop(signal_number);
    ssize_t written = stops ? write(STDERR_FILENO, stopped, sizeof stopped - 1)
                            : write(STDERR_FILENO, interrupted, sizeof interrupted - 1);
    (void)written;
    _exit(stops ? EXIT_STOPPED : EXIT_INTERRUPTED);
}

static void handle(int signal_number)
{
    if (atomic_load(&remembers)) {
        atomic_store(&remembered, signal_number);
    } else if (!atomic_load(&deferred) || atomic_exchange(&asked, signal_number)) {
        end_at_once(signal_number);
    }
}

static void install(int signal_number)
{
    struct sigaction old, action = {.sa_handler = handle, .sa_flags = SA_RESTART};
    sigemptyset(&action.sa_mask);
    // nohup and background jobs of scripts start us with the signal ignored: it stays so.
    if (sigaction(signal_number, NULL, &old) == 0 && old.sa_handler != SIG_IGN) {
        sigaction(signal_number, &action, NULL);
    }
}

void interrupt_install(void)
{
    install(SIGINT);
    install(SIGTERM);
}

void interrupt_remember(void)
{
    atomic_store(&remembers, 1);
    install(SIGTERM);
    install(SIGUSR1);
}

void interrupt_decide(bool keeps)
{
    struct sigaction used;
    atomic_store(&keeps_work, keeps ? 1 : 0);
    if (keeps) {
        install(SIGUSR1);
    } else if (sigaction(SIGUSR1, NULL, &used) == 0 && used.sa_handler == handle) {
        signal(SIGUSR1, SIG_DFL);
    }
    atomic_store(&remembers, 0);
    const int signal_number = atomic_load(&remembered);
    if (signal_number == SIGUSR1 && !keeps) {
        (void)raise(SIGUSR1);
    } else if (signal_number != 0) {
        end_at_once(signal_number);
    }
}

void interrupt_defer(void)
{
    atomic_store(&deferred, 1);
}

bool interrupt_keeps_work(void)
{
    return atomic_load(&keeps_work) != 0;
}

bool interrupt_stops(void)
{
    return atomic_load(&keeps_work) && is_stop(atomic_load(&asked));
}

bool interrupt_asked(void)
{
    return atomic_load(&asked) != 0;
}
