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

static void handle(int signal_number)
{
    static const char text[] = "\nalpenglow: interrupted at once\n";
    if (!atomic_load(&deferred) || atomic_exchange(&asked, signal_number)) {
        ssize_t written = write(STDERR_FILENO, text, sizeof text - 1);
        (void)written;
        _exit(EXIT_INTERRUPTED);
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

void interrupt_defer(void)
{
    atomic_store(&deferred, 1);
}

void interrupt_keep_work(void)
{
    atomic_store(&keeps_work, 1);
    install(SIGUSR1);
}

bool interrupt_keeps_work(void)
{
    return atomic_load(&keeps_work) != 0;
}

bool interrupt_stops(void)
{
    const int signal_number = atomic_load(&asked);
    return atomic_load(&keeps_work) && (signal_number == SIGTERM || signal_number == SIGUSR1);
}

bool interrupt_asked(void)
{
    return atomic_load(&asked) != 0;
}
