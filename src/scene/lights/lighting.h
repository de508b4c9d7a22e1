// SPDX-License-Identifier: MIT
// All light that falls on a scene, as a sampler asks for it: punctual lights, the sun, emissive
// triangles and the sky behind one door. Of many lights the one that is asked is drawn in
// proportion to what each can give at the point.
#ifndef ALPI_SCENE_LIGHTING_H
#define ALPI_SCENE_LIGHTING_H

#include "scene/scene.h"
#include "scene/sky/sky.h"

typedef enum alpi_light_class {
    ALPI_LIGHT_CLASS_PUNCTUAL, // point, spot, and directional without size: never hit by chance
    ALPI_LIGHT_CLASS_SUN,      // directional with a size (below 2e-5 rad it is a point)
    ALPI_LIGHT_CLASS_SURFACE,  // emissive triangles
    ALPI_LIGHT_CLASS_SKY,
    ALPI_LIGHT_CLASS_COUNT
} alpi_light_class;

typedef struct alpi_lighting alpi_lighting; // immutable

/// @param scene   borrowed: it must live as long as the lighting
/// @param options checked here; NULL = defaults
/// @return ALP_OK; INVALID_ARGUMENT (named); OUT_OF_MEMORY
alp_result alpi_lighting_create(const alp_scene *scene, const alp_lighting_options *options,
                                alpi_lighting **lighting);
/// The same without warnings: of what is made only to be looked at, who makes it to use it tells.
alp_result alpi_lighting_create_quietly(const alp_scene *scene, const alp_lighting_options *options,
                                        alpi_lighting **lighting);
/// Sky and emissive surfaces alone: without punctual lights and suns, and without warnings.
alp_result alpi_lighting_create_without_lamps(const alp_scene *scene,
                                              const alp_lighting_options *options,
                                              alpi_lighting **lighting);
/// All light as two that add up to it: a soft sky alone with all else, and the bright spots of the
/// sky with all else. Each has the lights and emissive triangles whole: who asks for both takes
/// only the sky of the first. Paths that have the second alone find all light, if there are spots:
/// these are drawn and never met, and rays that leave meet the soft sky, which is never drawn. It
/// is that of the first, which must live as long.
/// @param lighting made of the same scene and options
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_lighting_split_sky(const alpi_lighting *lighting,
                                   const alp_lighting_options *options, alpi_lighting **soft,
                                   alpi_lighting **spots);
/// Takes the bright spots out of the sky of a lighting, which keeps the soft sky and all else. The
/// spots come with the emissive triangles, without punctual lights and suns. Rays that leave meet
/// the soft sky: the lighting must live as long.
/// @param lighting made with the same options
/// @return ALP_OK; OUT_OF_MEMORY: the lighting stays as it is
alp_result alpi_lighting_take_spots(alpi_lighting *lighting, const alp_lighting_options *options,
                                    alpi_lighting **spots);
void alpi_lighting_destroy(alp_context *context, alpi_lighting *lighting); // NULL does nothing
/// Whether there is no light at all.
bool alpi_lighting_is_dark(const alpi_lighting *lighting);

/// Refuses a scene that no light reaches by any option: without a lamp that shines, emission and
/// sky. Cost: lights of the file and of the options answer at once; otherwise emission and sky are
/// collected.
/// @return ALP_OK; INVALID_ARGUMENT (no light); OUT_OF_MEMORY; a fault of the options
alp_result alpi_lighting_refuse_darkness(const alp_scene *scene,
                                         const alp_lighting_options *options);

/// Warns ("no-light") where there is none.
void alpi_lighting_warn(const alp_scene *scene, const alpi_lighting *lighting);

/// A way from a point to light.
typedef struct alpi_light_sample {
    alpi_light_class kind; // PUNCTUAL: no ray meets it, of a sky's spots too
    vec3 direction;        // unit, from the point
    float distance;        // metres to the light, INFINITY for sun, directional and sky
    vec3 light;        // radiance that comes from there; PUNCTUAL: E on a surface that faces it.
                       // SUN and SKY: of sky and suns together, whichever was drawn
    float density;     // of drawing this, per steradian: what alpi_lighting_density says of it;
                       // PUNCTUAL: the probability of the light
    uint32_t triangle; // of SURFACE, else ALPI_NONE
} alpi_light_sample;

/// Draws one light and a direction to it. Unshadowed: the caller asks the tracer, and multiplies
/// light · cosθ / density.
/// @param normal the side that gathers   @param pick [0,1)   @param u [0,1)²
/// @return false: nothing here can give light (a closed lid, a light behind): counts as 0.
///         *sample then says no more than the kind and triangle that were asked
/// Cost: a walk down the hierarchy of emitters, and of point and spot lights beyond 16; each
/// directional light is asked. Draws are functions of what is passed in alone.
bool alpi_lighting_sample(const alpi_lighting *lighting, vec3 point, vec3 normal, float pick,
                          vec2 u, alpi_light_sample *sample);

/// Density, per steradian, with which alpi_lighting_sample draws from `point` a direction that hits
/// emissive triangle `triangle` (any other triangle: 0), or, ALPI_NONE, leaves the scene (sun and
/// sky together). Over all directions and triangles it makes 1, less the probability of PUNCTUAL
/// lights and of ways down the hierarchy that end before a light.
float alpi_lighting_density(const alpi_lighting *lighting, vec3 point, vec3 normal, vec3 direction,
                            uint32_t triangle);

/// The same two with less care: directions to emissive triangles are even over their areas, not
/// their solid angles, which takes a fraction of the time and makes more noise near them.
bool alpi_lighting_sample_by_area(const alpi_lighting *lighting, vec3 point, vec3 normal,
                                  float pick, vec2 u, alpi_light_sample *sample);
/// @param distance metres from the point to where the direction meets emissive triangle `triangle`
float alpi_lighting_density_by_area(const alpi_lighting *lighting, vec3 point, vec3 normal,
                                    vec3 direction, uint32_t triangle, float distance);

/// Radiance of sky and sun disks in a direction that leaves the scene; of a sky of spots, of the
/// soft one in its place.
vec3 alpi_lighting_escaped(const alpi_lighting *lighting, vec3 direction);

/// The parts, for gathering each light alone: PUNCTUAL and SUN lights, file first, then the lamps
/// of the options, then their sun. A light of the file with a value that is none keeps its place,
/// with intensity 0.
uint32_t alpi_lighting_light_count(const alpi_lighting *lighting);
const alpi_light *alpi_lighting_light(const alpi_lighting *lighting, uint32_t index);
/// What light `index` gives at a point: direction, distance, light and density as above, drawn in
/// the disk for a SUN. @return false: out of its range or cone
bool alpi_lighting_sample_light(const alpi_lighting *lighting, uint32_t index, vec3 point, vec2 u,
                                alpi_light_sample *sample);
const alpi_sky *alpi_lighting_sky(const alpi_lighting *lighting); // may be NULL
uint32_t alpi_lighting_emitter_count(const alpi_lighting *lighting);
double alpi_lighting_emitter_area(const alpi_lighting *lighting); // m², one side

/// Radiance that leaves a triangle towards `direction` at barycentrics: emission × texture, at most
/// 1e20; 0 from behind unless double-sided, and where a mask cuts; of a blended surface its alpha.
vec3 alpi_surface_emission(const alp_scene *scene, uint32_t triangle, float b1, float b2,
                           vec3 direction);

#endif
