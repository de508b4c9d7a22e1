// SPDX-License-Identifier: MIT
// The pictures of --pictures.
#include "pictures.h"

#include "output.h"
#include "views.h"

#include <stdio.h>
#include <stdlib.h>

static int write_one(session *s, const alp_diagnosis *diagnosis, uint32_t index, const char *path,
                     bool overwrite)
{
    alp_image *image = NULL;
    alp_result result = alp_diagnosis_picture(diagnosis, index, &image);
    if (result == ALP_OK) {
        result = alp_image_save(image, path, overwrite);
    }
    alp_image_destroy(image);
    return session_end(s, result);
}

int pictures_write(session *s, const alp_diagnosis *diagnosis, const command_line *a,
                   json_t **paths)
{
    *paths = json_array();
    const char *folder = a->values[OPTION_PICTURES].text;
    if (folder == NULL) {
        return EXIT_DONE;
    }
    const bool overwrite = a->values[OPTION_FORCE].given;
    const uint32_t count = alp_diagnosis_picture_count(diagnosis);
    if (count == 0) {
        fputs("alpenglow: --pictures: there is nothing to draw: no triangle has an area\n", stderr);
        return EXIT_DONE;
    }
    int code = pictures_folder(folder);
    for (int pass = 0; pass < 2; pass++) { // all are checked before any is drawn
        for (uint32_t i = 0; i < count && code == EXIT_DONE; i++) {
            char *path = pictures_path(folder, alp_diagnosis_picture_name(diagnosis, i));
            if (pass == 0) {
                code = output_check(path, overwrite);
            } else {
                code = write_one(s, diagnosis, i, path, overwrite);
                json_array_append_new(*paths, json_text(path));
            }
            free(path);
        }
    }
    return code;
}
