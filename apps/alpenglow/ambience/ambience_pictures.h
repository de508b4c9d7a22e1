// SPDX-License-Identifier: MIT
// The pictures of ambience: --pictures and --preview.
#ifndef COMMAND_AMBIENCE_PICTURES_H
#define COMMAND_AMBIENCE_PICTURES_H

#include "setup/fields.h"

enum { PREVIEW_LIMIT = 8 }; ///< moments side by side

typedef struct ambience_pictures {
    const command_line *arguments;
    flight_run *run;
    const char *folder;              // NULL: none are wanted
    uint32_t width, height;          // of a half
    field_source constant;           // of the right half
    alp_film_adaptation adapted;     // from frame to frame
    uint32_t seconds;                // of the flight
    alp_image *tiles[PREVIEW_LIMIT]; // linear
    uint32_t tile_count;
} ambience_pictures;

/// Checks the files before the work, and makes the folder.
/// @param seconds pictures of a flight
/// @return EXIT_DONE, or EXIT_FAILED after a message; ambience_pictures_close in both cases
int ambience_pictures_open(flight_run *run, const command_line *arguments, uint32_t seconds,
                           ambience_pictures *pictures);
void ambience_pictures_close(ambience_pictures *pictures);

/// Writes the picture of one second, and keeps a moment of the preview.
/// @param second from 1
/// @return EXIT_DONE, or an exit code after a message
int ambience_pictures_add(ambience_pictures *pictures, const flight_frame *frame, uint32_t second);
/// Writes the preview.
int ambience_pictures_finish(ambience_pictures *pictures);

#endif
