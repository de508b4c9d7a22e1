// SPDX-License-Identifier: MIT
// Writes those files of the first corpus that no editor makes: images of every kind that is read,
// probes, checkpoints, and inputs of the accessors' target. (Texts, and the archives of texts, were
// written by hand.)
//
//   fuzz_seeds FOLDER
#include "seeds.h"

#include <stdio.h>
#include <stdlib.h>

static const char *folder;

_Noreturn void seed_fail(const char *what)
{
    fprintf(stderr, "fuzz_seeds: %s\n", what);
    exit(1);
}

void seed_put(const char *target, const char *name, const void *bytes, size_t size)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s/%s", folder, target, name);
    FILE *file = fopen(path, "wb");
    if (file == NULL || fwrite(bytes, 1, size, file) != size || fclose(file) != 0) {
        seed_fail(path);
    }
}

int main(int count, char **arguments)
{
    alp_context *context = NULL;
    if (count != 2 || alp_context_create(NULL, &context) != ALP_OK) {
        seed_fail("usage: fuzz_seeds FOLDER");
    }
    folder = arguments[1];
    seeds_checkpoint(context);
    seeds_images(context);
    seeds_packed();
    seeds_probes(context);
    alp_context_destroy(context);
    return 0;
}
