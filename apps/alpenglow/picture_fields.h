// SPDX-License-Identifier: MIT
// The field of a picture: of render and of view.
#ifndef COMMAND_PICTURE_FIELDS_H
#define COMMAND_PICTURE_FIELDS_H

#include "setup/fields.h"

#include <alpenglow/render.h>

/// A field by its name in --with.
typedef struct picture_field {
    field_model model;
    alp_ambient_model ambient; // of FIELD_OTHER
} picture_field;

/// Makes the field of a picture by the options of its model.
/// @param options lighting, bounces and camera of the picture. ambience sets the light of the last
///                moment of its flight, and without --camera its view. lpv sets the camera that its
///                grids follow, and the volume.
/// @return EXIT_DONE, or an exit code after a message; field_source_clear in both cases
int picture_field_make(session *s, const command_line *arguments, picture_field field,
                       alp_render_options *options, field_source *source);
/// Makes the volume of a picture, which holds no light yet: for hosts that light it themselves.
/// @return EXIT_DONE, or an exit code after a message; field_source_clear in both cases
int picture_field_open_lpv(session *s, const command_line *arguments, alp_render_options *options,
                           field_source *source);

#endif
