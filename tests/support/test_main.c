// SPDX-License-Identifier: MIT
// The program of a room's tests.
//
//     test_ROOM [FILE [CASE]]      runs the cases of files that match; * and ? match any characters
//     test_ROOM --list             lists "FILE CASE" lines instead
//
// TEST_CASES in the environment is a CASE too. TEST_FAST leaves slow cases out. Exit status: 0 if
// every case passed or was skipped, 1 if one failed, 2 if no case matches.
#include "test_support.h"

#include <fnmatch.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static test_case *cases;
static test_surroundings *surroundings;

void test_register(test_case *added)
{
    added->next = cases;
    cases = added;
}

void test_register_surroundings(test_surroundings *added)
{
    added->next = surroundings;
    surroundings = added;
}

// --- which cases run -----------------------------------------------------------------------------

/// "test_pack" of "/home/x/tests/unit/atlas/test_pack.c", in a static buffer.
static const char *stem(const char *path)
{
    static char name[128];
    const char *slash = strrchr(path, '/');
    const char *base = slash != NULL ? slash + 1 : path;
    snprintf(name, sizeof name, "%.*s", (int)strcspn(base, "."), base);
    return name;
}

static bool matches(const char *pattern, const char *text)
{
    return pattern == NULL || fnmatch(pattern, text, 0) == 0;
}

static bool is_chosen(const test_case *c, const char *file, const char *name)
{
    return matches(file, stem(c->file)) && matches(name, c->name) &&
           matches(getenv("TEST_CASES"), c->name) && !(c->slow && test_is_quick());
}

/// By file, then by line.
static int compare(const void *a, const void *b)
{
    const test_case *first = *(test_case *const *)a, *second = *(test_case *const *)b;
    const int files = strcmp(first->file, second->file);
    return files != 0 ? files : (first->line > second->line) - (first->line < second->line);
}

static test_case **choose(const char *file, const char *name, size_t *count)
{
    size_t all = 0;
    for (const test_case *c = cases; c != NULL; c = c->next) {
        all++;
    }
    test_case **chosen = malloc((all + 1) * sizeof *chosen);
    *count = 0;
    for (test_case *c = cases; c != NULL && chosen != NULL; c = c->next) {
        if (is_chosen(c, file, name)) {
            chosen[(*count)++] = c;
        }
    }
    if (*count > 0) {
        qsort(chosen, *count, sizeof *chosen, compare);
    }
    return chosen;
}

// --- running them --------------------------------------------------------------------------------

static alp_context *context_of_case;
static clock_t started;

static const test_surroundings *surroundings_of(const test_case *c)
{
    const test_surroundings *s = surroundings;
    while (s != NULL && strcmp(s->file, c->file) != 0) {
        s = s->next;
    }
    return s;
}

static int before(void **state)
{
    const test_case *c = *state;
    const test_surroundings *s = surroundings_of(c);
    test_log_clear();
    if (s != NULL) {
        s->before();
    }
    if (c->run_with != NULL) {
        context_of_case = test_context(c->workers);
    }
    started = clock();
    return 0;
}

static void run(void **state)
{
    const test_case *c = *state;
    if (c->run != NULL) {
        c->run();
    } else {
        c->run_with(context_of_case);
    }
}

static int after(void **state)
{
    const double seconds = (double)(clock() - started) / CLOCKS_PER_SEC;
    if (seconds >= 1.0) {
        print_message("%.1f s of the cores\n", seconds);
    }
    alp_context_destroy(context_of_case);
    context_of_case = NULL;
    const test_surroundings *s = surroundings_of(*state);
    if (s != NULL) {
        s->after();
    }
    return 0;
}

/// Runs the cases of one file, the first `count` of these. Gives how many failed.
static int run_file(test_case *const *of_file, size_t count)
{
    struct CMUnitTest *tests = calloc(count, sizeof *tests);
    if (tests == NULL) {
        return 1;
    }
    for (size_t i = 0; i < count; i++) {
        tests[i] = (struct CMUnitTest){of_file[i]->name, run, before, after, of_file[i]};
    }
    const int failed = _cmocka_run_group_tests(stem(of_file[0]->file), tests, count, NULL, NULL);
    free(tests);
    return failed;
}

int main(int count, char **words)
{
    const bool list = count > 1 && strcmp(words[1], "--list") == 0;
    size_t chosen_count = 0;
    test_case **chosen =
        choose(count > 1 && !list ? words[1] : NULL, count > 2 ? words[2] : NULL, &chosen_count);
    if (chosen_count == 0) {
        fprintf(stderr, "%s: no case matches; --list shows all\n", words[0]);
        free(chosen);
        return 2;
    }
    int failed = 0;
    for (size_t first = 0, end = 0; first < chosen_count; first = end) {
        while (end < chosen_count && strcmp(chosen[end]->file, chosen[first]->file) == 0) {
            end++;
        }
        for (size_t i = first; list && i < end; i++) {
            printf("%s %s\n", stem(chosen[i]->file), chosen[i]->name);
        }
        failed += list ? 0 : run_file(chosen + first, end - first);
    }
    free(chosen);
    return failed != 0;
}
