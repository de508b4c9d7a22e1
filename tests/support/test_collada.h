// SPDX-License-Identifier: MIT
// COLLADA documents made in memory by tests. In the text, ' stands for " so that it can be read.
#ifndef TEST_COLLADA_H
#define TEST_COLLADA_H

#include "test_support.h"

#include "formats/collada/collada_document.h"
#include "scene/scene.h"

/// Four corners (0,0,0) (1,0,0) (1,1,0) (0,1,0) as source "p" and vertices "v" of geometry "g",
/// with these primitives.
#define TEST_COLLADA_SQUARE(primitives)                                                            \
    TEST_COLLADA_MESH("0 0 0 1 0 0 1 1 0 0 1 0", "12", "4", primitives)
#define TEST_COLLADA_MESH(numbers, number_count, count, primitives)                                \
    "<library_geometries><geometry id='g'><mesh><source id='p'><float_array id='pa' "              \
    "count='" number_count "'>" numbers "</float_array><technique_common><accessor "               \
    "source='#pa' count='" count "' stride='3'><param name='X' type='float'/><param name='Y' "     \
    "type='float'/><param name='Z' type='float'/></accessor></technique_common></source>"          \
    "<vertices id='v'><input semantic='POSITION' source='#p'/></vertices>" primitives              \
    "</mesh></geometry></library_geometries>"
/// Geometry "g" shown once.
#define TEST_COLLADA_SHOWN                                                                         \
    "<library_visual_scenes><visual_scene id='s'><node id='n'><instance_geometry url='#g'/>"       \
    "</node></visual_scene></library_visual_scenes>" TEST_COLLADA_SCENE
#define TEST_COLLADA_SCENE "<scene><instance_visual_scene url='#s'/></scene>"
#define TEST_COLLADA_INPUT "<input semantic='VERTEX' source='#v' offset='0'/>"

/// The whole document with this inside <COLLADA>; released with free.
char *test_collada_text(const char *inside, size_t *size);
/// A zip archive of stored files, names and texts in turn; released with free.
uint8_t *test_collada_zip(const char *const (*files)[2], size_t count, size_t *size);
/// Reads bytes as "test.dae".
alp_result test_collada_bytes(alp_context *context, const void *bytes, size_t size,
                              alp_scene **scene);
/// Reads a document with this inside <COLLADA>.
alp_result test_collada_scene(alp_context *context, const char *inside, alp_scene **scene);

#endif
