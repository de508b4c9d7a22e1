// SPDX-License-Identifier: MIT
// Numbers that C and the shaders share: bindings of buffers and textures, locations of uniforms.
// This file is valid C and GLSL.
#ifndef VIEWER_BINDINGS_H
#define VIEWER_BINDINGS_H

// Storage buffers.
#define BUFFER_POSITIONS 0       // float [vertex][3]
#define BUFFER_NORMALS 1         // float [vertex][3]
#define BUFFER_COLORS 2          // float [vertex][4]; one element where all are 1
#define BUFFER_UVS 3             // float [slot in use][vertex][2]
#define BUFFER_TRIANGLES 4       // uint [triangle][3]
#define BUFFER_MATERIALS 5       // material [material + 1]; the last is that of no material
#define BUFFER_MAP_UVS 6         // float [triangle][set][corner][2] of the light map
#define BUFFER_MAP_TRIANGLES 7   // uint [triangle] page, and which sets count
#define BUFFER_LIGHTS 8          // light [light]
#define BUFFER_SHADOW_VIEWS 9    // shadow_view [view]
#define BUFFER_AMBIENT 10        // an ambient model
#define BUFFER_FIELD_VERTICES 11 // float [front, back][vertex][3] irradiance
#define BUFFER_FIELD_OBJECTS 12  // vec4 [surface][9] spherical harmonics of irradiance
#define BUFFER_TANGENTS 13       // vec4 [vertex]; one element without normal maps
#define BUFFER_SUNS 0            // of pass_background: sun [sun]
#define BUFFER_SH_PARTS 0        // of gl_cube: float [part][9][3]
#define BUFFER_SH 1              // of gl_cube: float [9][3]
#define BUFFERS 14               // bindings in use

// Storage blocks of the shaders that have most of them.
#define BLOCKS_VERTEX 9   // surfaces.vert
#define BLOCKS_FRAGMENT 6 // field.frag and ambient.frag

// Textures of a material.
#define TEXTURE_BASE_COLOR 0
#define TEXTURE_METALLIC 1
#define TEXTURE_EMISSION 2
#define TEXTURE_TRANSMISSION 3
#define TEXTURE_NORMAL 4
#define TEXTURE_USES 5
// Other textures.
#define TEXTURE_LIGHTMAP 8
#define TEXTURE_SKY 9
#define TEXTURE_PICTURE 10
#define TEXTURE_THROUGH 11
#define TEXTURE_LEFT 12
#define TEXTURE_DEPTH 13        // of the layer before
#define TEXTURE_OPAQUE_DEPTH 16 // of opaque surfaces
#define TEXTURE_SUN_SHADOWS 14
#define TEXTURE_LAMP_SHADOWS 15
#define TEXTURE_LAYER_DEPTH 23 // of the layer that mist lies before
#define TEXTURE_FIELD 17
#define TEXTURE_PROBE_LIGHT 18
#define TEXTURE_PROBE_MOMENTS 19
#define TEXTURE_SSAO 22

// Uniforms of all passes that know the camera.
#define UNIFORM_ORIGIN 0   // vec3, metres
#define UNIFORM_FORWARD 1  // vec3, unit
#define UNIFORM_RIGHT 2    // vec3: x of the picture at distance 1, from -1 to 1, times this
#define UNIFORM_UP 3       // vec3: the same of y
#define UNIFORM_NEAR 4     // float, metres; of a parallel view 1 / the far plane
#define UNIFORM_SIZE 5     // vec2, pixels
#define UNIFORM_PARALLEL 6 // bool, whether rays are parallel
// Uniforms of pass_surfaces.
#define UNIFORM_MATERIAL 8    // uint
#define UNIFORM_VERTICES 9    // uint, vertices of the scene
#define UNIFORM_COLORED 10    // bool, whether vertices have colours
#define UNIFORM_METALS 11     // bool, whether metals are black
#define UNIFORM_AXES 12       // vec3 [3] of the surface's object
#define UNIFORM_MAP_SETS 15   // uint, coordinate sets of the light map: 1, or 3 that are blended
#define UNIFORM_MAP_EQUAL 16  // bool, whether sets that count have equal weight
#define UNIFORM_PEELED 17     // int, of PEEL_...
#define UNIFORM_LIGHTS 18     // uint, lights of BUFFER_LIGHTS
#define UNIFORM_AMBIENT 19    // int, an alp_ambient_model
#define UNIFORM_SURFACE 20    // uint, of the scene
#define UNIFORM_FIELD_READ 21 // int, READ_...
#define UNIFORM_MAP_PAGES 22  // uint, pages of a map of one value a texel
#define UNIFORM_FIRST_TRIANGLE 23 // uint, number of triangle 0 in pictures of triangles
#define UNIFORM_SSAO 48           // bool, whether TEXTURE_SSAO counts
// Uniforms of pass_maps.
#define UNIFORM_MAP_LIGHT 30 // uint, of BUFFER_LIGHTS
#define MAP_NO_LIGHT 0xffffffffu
// Uniforms of pass_background.
#define UNIFORM_SKY_KIND 8   // int, SKY_...
#define UNIFORM_SKY_UP 9     // vec3, radiance
#define UNIFORM_SKY_DOWN 10  // vec3, radiance
#define UNIFORM_SKY_TURN 11  // float, turns of the whole circle
#define UNIFORM_SUN_COUNT 12 // uint
// Uniforms of pass_ssao.
#define UNIFORM_SSAO_RADIUS 8 // float, metres
// Uniforms of pass_film.
#define UNIFORM_GAIN 8     // float, 2^exposure
#define UNIFORM_TONE 9     // int, an alp_tone
#define UNIFORM_WHITE 10   // float, the L that becomes white
#define UNIFORM_BALANCE 11 // mat3
#define UNIFORM_DITHER 12  // bool, whether rounding is hashed

// Kinds of light.
#define LIGHT_POINT 0
#define LIGHT_SPOT 1
#define LIGHT_SUN 2

// Fragments that are left out: those that do not lie behind TEXTURE_DEPTH, and those that lie
// behind TEXTURE_OPAQUE_DEPTH.
#define PEEL_BEHIND 1
#define PEEL_BEFORE 2

// Kinds of sky.
#define SKY_NONE 0
#define SKY_COLORS 1
#define SKY_IMAGE 2

// Places where a field is read, in the order of --read.
#define READ_PIXEL 0  // in TEXTURE_FIELD
#define READ_VERTEX 1 // in BUFFER_FIELD_VERTICES
#define READ_OBJECT 2 // in BUFFER_FIELD_OBJECTS
#define READ_PROBES 3 // at pixels too, from the textures of probes
#define READ_LPV 4    // at pixels too, from the volume on the card

// Flags of a material.
#define MATERIAL_DOUBLE_SIDED 1u
#define MATERIAL_EXISTS 2u
#define MATERIAL_NORMAL_MAP 4u

// Kinds of alpha, numbered as alp_alpha_mode.
#define ALPHA_OPAQUE 0u
#define ALPHA_MASK 1u
#define ALPHA_BLEND 2u

// Slots of texture coordinates: no such slot.
#define NO_SLOT 255u

// Entries of BUFFER_MAP_TRIANGLES: the page, and above it one bit for each set that counts.
#define MAP_NONE 0xffffffffu // not in the map
#define MAP_PAGE 0x0fffffffu
#define MAP_SETS_SHIFT 28

#endif
