// SPDX-License-Identifier: MIT
// Light at vertices: every vertex stands for the part of the surface that is nearest to it, and is
// a receiver whose points lie all over that part.
#ifndef ALPI_MAPS_VERTEX_MAP_H
#define ALPI_MAPS_VERTEX_MAP_H

#include "scene/receivers.h"
#include "scene/scene.h"

/// The vertices of a scene as receivers. Vertices with one position and one normal are one
/// receiver, so that no seam appears where a file splits them for other reasons (texture
/// coordinates, materials, primitives); vertices split by their normals are apart.
///
/// The share of a vertex in a triangle is where its barycentric weight is the largest: a third of
/// the area, the quadrilateral between the corner, the middles of its two edges and the centroid.
typedef struct alpi_vertex_map {
    alp_context *context;
    const alp_scene *scene;
    uint32_t
        *vertex_receivers; // [scene vertices] ALPI_NONE where no usable triangle has the vertex
    uint32_t count;        // receivers
    uint32_t *first_share; // [count + 1] into shares and ends
    uint32_t *shares;      // 3 × triangle + corner; neighbours of a receiver in triangle order
    float *ends;   // sum of this share and those before it over the sum of all of the receiver
    double *areas; // [count] m², of all shares of a receiver
} alpi_vertex_map;

/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_vertex_map_create(const alp_scene *scene, alpi_vertex_map *map);
void alpi_vertex_map_destroy(alpi_vertex_map *map);

/// Each vertex as a receiver: points are uniform over its shares. The map must outlive them.
alpi_receivers alpi_vertex_map_receivers(const alpi_vertex_map *map);

/// Turns means over the shares into values at the vertices.
///
/// What a GPU shows is the linear interpolant of the values, and its mean over a share is not the
/// value at the vertex. The fit looks for values whose interpolant has over every share the mean
/// that was measured, and stays near the means: with K a = per triangle of area A, (A/3) [11/18 own
/// value + 7/36 each other] summed over the shares, D = areas of the receivers and a pull p = 0.5,
/// (K + p D) values = (1 + p) D means. Symmetric, positive definite; conjugate gradients. Unlike
/// the paper, test functions are the shares themselves, so that receivers are plain pieces of
/// surface; their matrix is the better conditioned. Noise of the rays grows by about a quarter.
/// Based on: L. Kavan, A. W. Bargteil, P.-P. Sloan. Least Squares Vertex Baking. EGSR 2011.
/// @param values [count] in: means; out: values in [0, 1]
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_vertex_map_fit(const alpi_vertex_map *map, float *values);

/// One point of a triangle as a receiver: barycentric weights b1, b2 of corners 1 and 2.
alpi_receiver_point alpi_vertex_map_point(const alp_scene *scene, uint32_t triangle, double b1,
                                          double b2);

#endif
