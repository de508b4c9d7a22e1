// SPDX-License-Identifier: MIT
// The origin of a scene whose file has large coordinates, such as those of a national grid. Readers
// subtract it in double, because floats that far out are millimetres to metres apart.
#ifndef ALPI_SCENE_ORIGIN_H
#define ALPI_SCENE_ORIGIN_H

#include "scene/scene.h"

/// A box of points in the world of the file.
typedef struct alpi_world_box {
    double low[3], high[3]; // low > high: empty
} alpi_world_box;
alpi_world_box alpi_world_box_empty(void);
/// Adds a point. Points that are not finite, or beyond ALPI_COORDINATE_LIMIT, are left out.
void alpi_world_box_add(alpi_world_box *box, const double point[3]);
/// The box of all vertices of a scene.
alpi_world_box alpi_world_box_of(const alp_scene *scene);

/// Chooses the origin by the box of all vertices: 0 unless they are far away for their extent.
///   far: the centre is 8 extents away and floats there are 1e-5 extents apart, or it is 2 extents
///        away and they are a millimetre apart
/// The origin is the centre, rounded to a multiple of the power of two above the extent.
void alpi_origin_choose(const alpi_world_box *box, double origin[3]);

/// A box of vertices that were rounded far out is not exact: readers find it again after a step.
enum { ALPI_ORIGIN_ROUNDS = 3 };
/// Chooses the origin by the scene's vertices.
/// @param base whose origin the scene takes instead, or NULL   @param step out: new origin − old
/// @return whether it has moved: vertices, lights and cameras are still where they were
bool alpi_origin_step(alp_scene *scene, const alp_scene *base, double step[3]);

/// Notes a transform from floats of a file to the scene: one that still reaches far brings large
/// coordinates back, which the file itself holds rounded.
void alpi_origin_note_rounding(alp_scene *scene, const mat4 *world);

/// A point of the scene in the world of the file.
static inline void alpi_origin_restore(const alp_scene *scene, vec3 point, double world[3])
{
    world[0] = (double)point.x + scene->origin[0];
    world[1] = (double)point.y + scene->origin[1];
    world[2] = (double)point.z + scene->origin[2];
}

/// Moves a transform to the world into one to the scene.
static inline void alpi_origin_move(mat4 *world, const double step[3])
{
    for (int k = 0; k < 3; k++) {
        world->m[12 + k] -= step[k];
    }
}

#endif
