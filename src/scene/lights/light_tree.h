// SPDX-License-Identifier: MIT
// A binary hierarchy of lights by place, direction and power, from which one is drawn in proportion
// to what it may give at a point: thousands cost a walk down the hierarchy.
#ifndef ALPI_SCENE_LIGHT_TREE_H
#define ALPI_SCENE_LIGHT_TREE_H

#include "base/context.h"
#include "base/vec.h"

#include <stdint.h>

/// What a light, or several, may give: where it is, where it shines, how strong.
typedef struct alpi_light_bound {
    vec3 low, high;    // metres: the box around it
    vec3 axis;         // unit: the middle of its normals
    float cone, reach; // radians: normals lie within `cone` of the axis, light leaves within
                       // `reach` of a normal, in proportion to the cosine at most
    bool two_sided;    // it shines towards −axis alike
    double power;      // intensity along a normal: area × radiance, or candela
} alpi_light_bound;

typedef struct alpi_light_tree alpi_light_tree; // immutable

/// @param bounds [count], count > 0, power > 0
alp_result alpi_light_tree_create(alp_context *context, const alpi_light_bound *bounds,
                                  uint32_t count, alpi_light_tree **tree);
void alpi_light_tree_destroy(alp_context *context, alpi_light_tree *tree); // NULL does nothing

/// Estimate of the irradiance that all of them give at a point on the side of `normal`; 0 only if
/// none can give any.
double alpi_light_tree_importance(const alpi_light_tree *tree, vec3 point, vec3 normal);

/// Draws a light. @param pick [0,1)   @param light out: index into `bounds`
/// @return its probability; 0: a place in the hierarchy where none can give light after all
double alpi_light_tree_sample(const alpi_light_tree *tree, vec3 point, vec3 normal, double pick,
                              uint32_t *light);
/// Probability that alpi_light_tree_sample draws `light` there.
double alpi_light_tree_probability(const alpi_light_tree *tree, vec3 point, vec3 normal,
                                   uint32_t light);

#endif
