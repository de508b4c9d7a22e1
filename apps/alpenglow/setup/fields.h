// SPDX-License-Identifier: MIT
// Fields of light as the command line names them.
#ifndef COMMAND_FIELDS_H
#define COMMAND_FIELDS_H

#include "ambience/flight_run.h"
#include "lpv/lpv_run.h"

/// The parts behind the field of a command.
typedef struct field_source {
    alp_field *field;   // owned
    alp_probes *probes; // owned, or NULL
    flight_run *flight; // owned, or NULL
    lpv_run *lpv;       // owned, or NULL
} field_source;

/// Models of --with that have options of their own.
typedef enum field_model { FIELD_OTHER, FIELD_PROBES, FIELD_AMBIENCE, FIELD_LPV } field_model;

/// Refuses options of other models, and those that contradict each other.
/// @param models set of 1u << field_model: those of one picture
/// @return EXIT_DONE, or EXIT_USAGE after a message
int field_check(const command_line *arguments, unsigned models);

/// Probe options of the arguments: grid, rays, basis, light. `lighting` is copied, not its parts.
/// @param origin of the scene in the world of its file
/// @return EXIT_DONE, or EXIT_USAGE after a message
int probe_options_read(const command_line *arguments, const alp_lighting_options *lighting,
                       const double origin[3], alp_probe_options *options);

/// Refuses --spacing and --bounds beside --probes, and bounds that are none.
/// @return EXIT_DONE, or EXIT_USAGE after a message
int probe_file_check(const command_line *arguments);

/// Fits an ambient model. @return as the library
alp_result field_fit(session *s, const command_line *arguments, alp_ambient_model model,
                     const alp_lighting_options *lighting, field_source *source);
/// Loads the probes of --probes, or bakes them.
/// @return EXIT_DONE, or an exit code after a message
int field_probes(session *s, const command_line *arguments, const alp_lighting_options *lighting,
                 alp_probe_lookup lookup, field_source *source);
/// Opens the flight and its volume, without light yet. `source` owns them.
/// @return EXIT_DONE, or an exit code after a message
int field_ambience_open(session *s, const command_line *arguments,
                        const alp_lighting_options *lighting, field_source *source);
/// Flies on to a time, and makes the field of that moment.   @return as the library
alp_result field_ambience_reach(field_source *source, double time);
/// Flies to the end of the flight, and makes the field of the volume.
/// @return EXIT_DONE, or an exit code after a message
int field_ambience(session *s, const command_line *arguments, const alp_lighting_options *lighting,
                   field_source *source);
/// Makes a volume, which holds no light yet, without a field.
/// @param camera NULL, or the view of a picture
/// @return EXIT_DONE, or an exit code after a message
int field_lpv_open(session *s, const command_line *arguments, const alp_lighting_options *lighting,
                   const alp_camera *camera, field_source *source);
/// Makes a volume, lights it once, and makes its field.
/// @param camera NULL, or the view of a picture
/// @return EXIT_DONE, or an exit code after a message
int field_lpv(session *s, const command_line *arguments, const alp_lighting_options *lighting,
              const alp_camera *camera, field_source *source);
/// Moves the camera of a volume, and lights it again. Its field reads the new light.
/// @return as the library
alp_result field_lpv_follow(field_source *source, const alp_camera *camera);
/// Prints what probes hold, and how good they are.
void probes_print(const alp_probes *probes);
void field_source_clear(field_source *source);

#endif
