// SPDX-License-Identifier: MIT
#include "picture_texts.h"

#include "printing/messages.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Characters that no shell reads as something else.
static const char PLAIN[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                            "-_=+./,:@%";

/// Appends a word as a shell reads it. @param text has room for 4 times the word, and 4
static char *add_word(char *text, const char *word)
{
    const bool plain = word[0] != '\0' && word[strspn(word, PLAIN)] == '\0';
    *text++ = ' ';
    if (plain) {
        return stpcpy(text, word);
    }
    *text++ = '\'';
    for (const char *at = word; *at != '\0'; at++) {
        if (*at == '\'') {
            text = stpcpy(text, "'\\''");
        } else {
            *text++ = *at;
        }
    }
    return stpcpy(text, "'");
}

/// The command line; malloc'ed.
static char *command_of(const command_line *a)
{
    static const char name[] = "alpenglow view";
    size_t size = sizeof name;
    for (int i = 0; i < a->word_count; i++) {
        size += 4 * strlen(a->words[i]) + 4;
    }
    char *text = allocate_or_exit(NULL, size), *end = stpcpy(text, name);
    for (int i = 0; i < a->word_count; i++) {
        end = add_word(end, a->words[i]);
    }
    return text;
}

static void write_camera(const alp_camera *c, const double origin[3], char *text, size_t size)
{
    double n[6];
    for (int k = 0; k < 3; k++) {
        n[k] = origin[k] + (double)c->position[k];
        n[k + 3] = origin[k] + (double)c->target[k];
    }
    snprintf(text, size, "%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.7g", n[0], n[1], n[2], n[3], n[4], n[5],
             (double)c->vertical_fov * (180.0 / M_PI));
}

alp_result picture_add_texts(alp_image *picture, const picture_facts *facts)
{
    char software[64], camera[256], exposure[32];
    char *command = command_of(facts->arguments);
    const alp_scene_info info = alp_scene_get_info(facts->scene);
    snprintf(software, sizeof software, "alpenglow %s", alp_version());
    write_camera(facts->camera, info.origin, camera, sizeof camera);
    snprintf(exposure, sizeof exposure, "%.4g", facts->exposure);
    const char *const texts[][2] = {{"Software", software},
                                    {"Command", command},
                                    {"Camera", camera},
                                    {"Exposure", exposure},
                                    {"OpenGL", facts->renderer}};
    alp_result result = ALP_OK;
    for (size_t i = 0; i < sizeof texts / sizeof *texts && result == ALP_OK; i++) {
        result = alp_image_add_text(picture, texts[i][0], texts[i][1]);
    }
    free(command);
    return result;
}
