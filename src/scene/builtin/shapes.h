// SPDX-License-Identifier: MIT
// Closed solids that scenes are put together from: every edge belongs to two triangles, normals are
// smooth along curves and flat elsewhere. Each shape can also only count its triangles, so that a
// scene can be asked for a number of them (alpi_shaper_fit).
#ifndef ALPI_SCENE_SHAPES_H
#define ALPI_SCENE_SHAPES_H

#include "scene/builtin/mesh_builder.h"

/// Where shapes go and how fine they are cut.
typedef struct alpi_shaper {
    alpi_builder *builder;
    bool counting;           // nothing is built
    uint64_t triangle_count; // so far, built or counted
    double fineness;         // cells of curves and 1/edge of flat parts grow with it
    vec3 origin;             // local (0, 0, 0) in the scene
    float cosine, sine;      // local axes turned about +y: +z towards +x
} alpi_shaper;

/// At the scene's origin, not turned.
alpi_shaper alpi_shaper_start(alpi_builder *builder, double fineness);
/// What follows stands at `origin`, turned by `yaw` radians. Quarter turns are exact.
void alpi_shaper_place(alpi_shaper *shaper, vec3 origin, double yaw);
/// Begins a surface, unless the shapes are only counted.
void alpi_shaper_surface(alpi_shaper *shaper, const char *name, uint32_t material);

/// A scene whose fineness is to be chosen: builds or counts.
typedef void alpi_shaper_fn(alpi_shaper *shaper, const void *user);
/// The fineness in [low, high] at which `build` gives nearest to `wanted` triangles; the number
/// must not fall where fineness grows.
double alpi_shaper_fit(alpi_shaper_fn *build, const void *user, double low, double high,
                       uint64_t wanted);

/// round(count × fineness), at least `least`.
uint32_t alpi_shaper_divide(const alpi_shaper *shaper, double count, uint32_t least);
/// Cells along a flat length, of `edge` metres at fineness 1.
uint32_t alpi_shaper_cells(const alpi_shaper *shaper, double length, double edge);

void alpi_shape_triangle(alpi_shaper *shaper, vec3 a, vec3 b, vec3 c); ///< flat
void alpi_shape_quad(alpi_shaper *shaper, const vec3 corners[4]);      ///< flat

/// A grid of u × v cells whose vertices a function gives; ∂u × ∂v looks outside.
typedef void alpi_patch_fn(const void *shape, uint32_t i, uint32_t j, vec3 *position, vec3 *normal);
typedef struct alpi_patch {
    uint32_t u_count, v_count;  // cells; the function is asked for one vertex more each way
    bool closed;                // vertex u_count is vertex 0
    bool low_point, high_point; // all vertices of the first, of the last row coincide
    alpi_patch_fn *at;
    const void *shape;
} alpi_patch;
void alpi_shape_patch(alpi_shaper *shaper, const alpi_patch *patch);

/// A flat grid between four corners, counter-clockwise from outside; opposite sides alike.
void alpi_shape_panel(alpi_shaper *shaper, const vec3 corners[4], uint32_t u_count,
                      uint32_t v_count);

/// Cells between planes across three axes, some solid: walls with windows, frames, steps. Solid
/// cells must not touch along an edge alone.
typedef struct alpi_blocks {
    const float *cuts[3]; // along x, y, z, growing
    uint32_t counts[3];   // of cuts, both ends included; at most ALPI_BLOCK_CUTS
    bool (*solid)(const void *user, uint32_t x, uint32_t y, uint32_t z); // NULL = all are
    const void *user;
    float edge; // m, of cells at fineness 1; HUGE_VALF = as few as the cuts allow
} alpi_blocks;
enum { ALPI_BLOCK_CUTS = 32 };
void alpi_shape_blocks(alpi_shaper *shaper, const alpi_blocks *blocks);
/// A box, its edges cut off at 45°: `bevel` metres along each face, 0 < bevel < half a side. Below
/// a fineness of ALPI_BEVEL_FINENESS they stay sharp.
#define ALPI_BEVEL_FINENESS 0.85
void alpi_shape_bevelled_box(alpi_shaper *shaper, vec3 low, vec3 high, float bevel);
/// A box with sharp edges, two triangles a face.
void alpi_shape_box(alpi_shaper *shaper, vec3 low, vec3 high);

// --- round shapes (shapes_round.c) ---------------------------------------------------------------

/// A point of a profile and the piece from it to the next: straight, or bent to the right of the
/// way (away from the axis on the way up) by `bulge` × its length.
typedef struct alpi_profile_point {
    float out, up, bulge;
} alpi_profile_point;

/// A profile turned about the axis: a solid where the profile begins and ends on the axis.
/// `slices` at fineness 1.
void alpi_shape_turned(alpi_shaper *shaper, const alpi_profile_point *points, uint32_t count,
                       double slices);

/// A closed section swept round a rectangle of half sides (x, z) in the plane y = 0, `out` counting
/// towards the middle: a cornice. The last point's piece ends at the first.
void alpi_shape_cornice(alpi_shaper *shaper, const alpi_profile_point *section, uint32_t count,
                        float half_x, float half_z);

/// A closed section swept along a half circle about (x, y) in the plane z = 0, `out` counting from
/// its centre and `up` along z: the moulding of an arch.
void alpi_shape_archivolt(alpi_shaper *shaper, const alpi_profile_point *section, uint32_t count,
                          float x, float y);

/// A wall along x, z from −thickness/2 to +thickness/2, on half-circle arches.
typedef struct alpi_arcade {
    float start, end;      // along x
    float first, distance; // centre of the first arch, and from each to the next
    uint32_t arch_count;   // 1 at least
    float radius, thickness;
    float spring, top; // heights
} alpi_arcade;
void alpi_shape_arcade(alpi_shaper *shaper, const alpi_arcade *arcade);

/// A ball of uneven radius about the local origin, for crowns and shrubs: smooth normals.
typedef struct alpi_blob {
    float radius, height_scale; // y is scaled by the latter
    float roughness;            // of the radius, about [0, .3]
    uint32_t key;               // each its own
    double slices;              // at fineness 1
} alpi_blob;
void alpi_shape_blob(alpi_shaper *shaper, const alpi_blob *blob);

/// A leaf: a flat double pyramid about the local point `middle`; `along` and `across` are half
/// axes at right angles, `thickness` metres. Twelve triangles.
void alpi_shape_leaf(alpi_shaper *shaper, vec3 middle, vec3 along, vec3 across, float thickness);

#endif
