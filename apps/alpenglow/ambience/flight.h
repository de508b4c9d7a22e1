// SPDX-License-Identifier: MIT
// A camera's flight: FLIGHT.csv of ambience.
#ifndef COMMAND_FLIGHT_H
#define COMMAND_FLIGHT_H

#include <alpenglow/scene.h>

#include <stdbool.h>
#include <stdint.h>

typedef struct flight_point {
    double time;                   // seconds
    double position[3], target[3]; // metres, in the scene
    double vfov;                   // radians
} flight_point;

typedef struct flight {
    uint32_t count;       // ≥ 1
    flight_point *points; // [count], times rise
} flight;

/// The camera at one moment.
typedef struct flight_camera {
    double position[3], target[3]; // metres
    double velocity[3];            // metres per second
    double vfov;                   // radians
} flight_camera;

/// Reads lines of t,px,py,pz,tx,ty,tz[,vfov] by number_lines_read: seconds, metres, degrees.
/// @param path   "-" is standard input
/// @param origin of the scene in the world of its file: subtracted
/// @return EXIT_DONE, or EXIT_FAILED after a message that names file and line
int flight_read(const char *path, const double origin[3], flight *flight);
/// Reads lines of t,px,py,pz in the same way: the path of something that looks nowhere. The targets
/// of its points hold nothing.
int flight_read_places(const char *path, const double origin[3], flight *flight);
/// The flight through builtin:terrain.
void flight_terrain(flight *flight);
void flight_clear(flight *flight);

double flight_start(const flight *flight);
/// The time of the last point; of a single point, FLIGHT_STAND seconds after it.
double flight_end(const flight *flight);
enum { FLIGHT_STAND = 5 };

/// The camera at a time: on straight lines between points. It stands still before the first point
/// and from the last one on.
flight_camera flight_at(const flight *flight, double time);
/// The same as a camera of pictures.
alp_camera flight_view(const flight_camera *camera);
/// Metres between two places.
double flight_distance(const double a[3], const double b[3]);

#endif
