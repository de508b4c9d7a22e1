// SPDX-License-Identifier: MIT
#include "views.h"

#include "printing/messages.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

enum { SIDE_LIMIT = 16384, CHANNELS = 4 };

int resolution_read(const command_line *a, uint32_t *out_width, uint32_t *out_height)
{
    const char *text = a->values[OPTION_RESOLUTION].text;
    char width_text[16] = "";
    const char *x = strchr(text, 'x');
    uint64_t width = 0, height = 0;
    if (x != NULL && (size_t)(x - text) < sizeof width_text) {
        memcpy(width_text, text, (size_t)(x - text));
    }
    if (number_parse_whole(width_text, &width) != NUMBER_OK ||
        number_parse_whole(x + 1, &height) != NUMBER_OK || width < 1 || width > SIDE_LIMIT ||
        height < 1 || height > SIDE_LIMIT) {
        return usage_error(a->command,
                           "--resolution: '%s' is not a size; give WxH, each 1 to %d pixels", text,
                           SIDE_LIMIT);
    }
    *out_width = (uint32_t)width;
    *out_height = (uint32_t)height;
    return EXIT_DONE;
}

char *pictures_path(const char *folder, const char *name)
{
    const size_t size = strlen(folder) + strlen(name) + sizeof "/.png";
    char *path = allocate_or_exit(NULL, size);
    const char *slash = folder[strlen(folder) - 1] == '/' ? "" : "/";
    snprintf(path, size, "%s%s%s.png", folder, slash, name);
    return path;
}

int pictures_folder(const char *folder)
{
    struct stat there;
    if (mkdir(folder, 0777) == 0 ||
        (errno == EEXIST && stat(folder, &there) == 0 && S_ISDIR(there.st_mode))) {
        return EXIT_DONE;
    }
    char text[512];
    snprintf(text, sizeof text, "--pictures %.300s: the folder cannot be made: %s", folder,
             errno == EEXIST ? "a file has its name" : strerror(errno));
    return failure(text);
}

alp_result images_join(alp_context *context, alp_image *const *images, uint32_t count,
                       alp_image **joined)
{
    alp_image_info info = alp_image_get_info(images[0]);
    const size_t row = (size_t)info.width * CHANNELS;
    info.width *= count;
    const alp_result result = alp_image_create(context, info, joined);
    for (uint32_t y = 0; y < info.height && result == ALP_OK; y++) {
        for (uint32_t i = 0; i < count; i++) {
            float *to = alp_image_floats(*joined) + row * ((size_t)y * count + i);
            memcpy(to, alp_image_floats(images[i]) + row * y, row * sizeof *to);
        }
    }
    return result;
}
