// SPDX-License-Identifier: MIT
// A run of view, and its two kinds of output.
#ifndef VIEWER_VIEW_JOB_H
#define VIEWER_VIEW_JOB_H

#include "drawing.h"
#include "gl/gl_context.h"
#include "view_options.h"

/// The second mode of a picture.
typedef struct view_beside {
    command_line arguments; // --with is --beside
    const view_mode *mode;  // NULL without one
    drawing drawing;
} view_beside;

typedef struct view_job {
    const command_line *arguments;
    view_settings settings;
    session session;
    gl_context gl;
    drawing drawing;
    view_beside beside;
    flight path;          // of the camera; empty where the light has the flight
    flight object_path;   // of --object; empty without one
    alp_image *reference; // NULL without one
    alp_scene *rest;      // of which a flight poses session.scene; NULL: nothing is posed
    uint32_t animation;   // that a flight plays; ALP_NONE: none
    double prepare_seconds;
} view_job;

/// Draws a frame. @return as alp_render, of modes that trace paths
alp_result view_draw(view_job *job, const alp_camera *camera);
/// Develops it. @param film, developed, light as of drawing_develop
alp_result view_develop(view_job *job, alp_film_options *film, alp_image **developed,
                        alp_image **light);

/// Writes a picture of -o. @return the exit code
int view_picture(view_job *job);
/// Reads the flight, and takes the view of its beginning.
/// @return EXIT_DONE, or EXIT_FAILED after a message
int view_flight_read(view_job *job);
/// Finds the animation that a flight plays. @return EXIT_DONE, or EXIT_FAILED after a message
int view_pose_find(view_job *job);
/// Poses the scene for a time of the flight, if it plays an animation. session.scene and what both
/// modes draw become the pose.
/// @return EXIT_DONE, or an exit code after a message
int view_pose_move(view_job *job, double time, const alp_lighting_options *lighting);
/// Puts session.scene back.
void view_pose_end(view_job *job);
/// Writes the pictures of a flight. @return the exit code
int view_flight(view_job *job);

/// Writes an image, with its texts where it is developed, unless OpenGL has failed.
/// @return EXIT_DONE, or EXIT_FAILED after a message
int view_save(view_job *job, const alp_camera *camera, double exposure, alp_image *image,
              const char *path);
/// Prints the summary of a run.
void view_print_done(const view_job *job, const char *what, double draw_seconds);

#endif
