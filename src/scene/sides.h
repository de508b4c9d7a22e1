// SPDX-License-Identifier: MIT
// Which side of a double-sided surface a map holds. It is the front, but for solids that are wound
// inwards: there it is the back, which is the side that is seen from outside.
#ifndef ALPI_SCENE_SIDES_H
#define ALPI_SCENE_SIDES_H

#include "scene/scene.h"

/// Solids that are wound inwards. A solid is a set of opaque double-sided triangles, connected at
/// edges of equal positions, closed, and wound in one sense. Its signed volume is negative. Rooms
/// are left out: solids that hold a whole other part of the scene, a lamp or a camera, or that
/// shine and are the whole scene. So are cavities: solids that lie wholly inside others wound
/// outwards.
struct alpi_sides {
    uint32_t count;
    uint32_t *first;     // [count + 1]
    uint32_t *triangles; // [first[count]] of the solids, one after the other
    bool *turned;        // [triangle_count] whether the map holds the back
};

/// Finds scene->sides; NULL if there is no such solid. Scenes without double-sided materials take
/// no time, others that of alpi_adjacency_create. Windings are counted exactly, without rays,
/// within a limit of work: solids that would exceed it are left as they are.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_sides_create(alp_scene *scene);
void alpi_sides_destroy(alp_context *context, alpi_sides *sides);

/// Takes lamps that are not the file's into account, until the next call: solids that hold one of
/// them are rooms. @param lamps [count] positions, metres
void alpi_sides_choose(const alp_scene *scene, const vec3 *lamps, uint32_t count);

/// Whether the map holds the back of a triangle.
static inline bool alpi_sides_is_turned(const alp_scene *scene, uint32_t triangle)
{
    return scene->sides != NULL && scene->sides->turned[triangle];
}

/// Unit normal of the triangle on the side that the map holds.
vec3 alpi_sides_normal(const alp_scene *scene, uint32_t triangle);
/// Normals of its corners, on the same side: those of the file, reversed where the file's agree
/// with the winding and the triangle is turned.
void alpi_sides_corner_normals(const alp_scene *scene, uint32_t triangle, vec3 normals[3]);

#endif
