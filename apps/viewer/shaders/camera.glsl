// The camera: a pinhole, as of render.
#include "bindings.h"

layout(location = UNIFORM_ORIGIN) uniform vec3 camera_origin;
layout(location = UNIFORM_FORWARD) uniform vec3 camera_forward;
layout(location = UNIFORM_RIGHT) uniform vec3 camera_right;
layout(location = UNIFORM_UP) uniform vec3 camera_up;
layout(location = UNIFORM_NEAR) uniform float camera_near; // of a parallel view 1 / far plane
layout(location = UNIFORM_PARALLEL) uniform bool camera_parallel;
layout(location = UNIFORM_SIZE) uniform vec2 picture_size; // pixels
