// SPDX-License-Identifier: MIT
// The live ambience volume along a flight, frame by frame.
#ifndef COMMAND_FLIGHT_RUN_H
#define COMMAND_FLIGHT_RUN_H

#include "ambience/flight.h"
#include "session.h"

#include <alpenglow/ambience.h>

typedef struct flight_run {
    session *session;
    flight path;
    double (*known)[4]; // [path.count] time, x, y, z: --prediction path; or NULL
    alp_ambience *ambience;
    alp_ambience_sampler *sampler;
    alp_ambience_options options;  // of the volume
    alp_lighting_options noon;     // at the beginning; borrowed parts
    alp_lighting_options lighting; // of the last frame
    double day;                    // seconds of --day; 0 = the sun stands still
    uint64_t light_step;           // of the lighting that the sampler has
    double start, end;             // seconds; the end is that of the flight, or --time
    double fps;
    double detail;    // metres, of the scene that is sampled; 0 = the scene itself
    uint32_t budget;  // samples a frame
    double budget_ms; // 0 = no limit
    // Done, and all. Frames lie before the end; where light is read after the flight, a last one
    // lies at the end.
    uint64_t frame, frame_count;
    uint64_t rays;
    double seconds; // of the clock, spent in frames
    double opened;  // by the clock
} flight_run;

/// One frame.
typedef struct flight_frame {
    double time;
    flight_camera camera;
    alp_ambience_work work;
    double seconds; // of the clock: lighting, update and sampling
} flight_frame;

/// Refuses options that contradict each other, and a flight that is missing.
/// @return EXIT_DONE, or EXIT_USAGE after a message
int flight_run_check(const command_line *arguments);
/// Refuses the options of flights, for a --with that has none.
/// @return EXIT_DONE, or EXIT_USAGE after a message
int flight_run_refuse(const command_line *arguments);

/// Reads the flight and makes the volume and its sampler. `run` must not move in memory.
/// @param lighting copied, not its parts
/// @return EXIT_DONE, or an exit code after a message; flight_run_close in both cases
int flight_run_open(session *s, const command_line *arguments, const alp_lighting_options *lighting,
                    flight_run *run);
void flight_run_close(flight_run *run);

/// Moves the volume to the next frame and samples it.
/// @return as the library; CANCELLED on Ctrl-C
alp_result flight_run_next(flight_run *run, flight_frame *frame);
/// Moves it on to a time: all frames until then.
/// @return as the library; CANCELLED on Ctrl-C
alp_result flight_run_reach(flight_run *run, double time);

/// The camera of the last frame.
flight_camera flight_run_camera(const flight_run *run);

/// An alp_progress_fn, whose `user` is a flight_run: shows the progress of the flight.
bool flight_run_progress(void *user, const alp_progress *unused);

#endif
