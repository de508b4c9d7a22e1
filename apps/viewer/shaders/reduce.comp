#version 450 core
// Adds the parts of a projection, in their order.
#include "bindings.h"

layout(local_size_x = 27) in;

layout(std430, binding = BUFFER_SH_PARTS) readonly buffer part_list { float parts[]; };
layout(std430, binding = BUFFER_SH) writeonly buffer sum_list { float sums[]; };

void main()
{
    uint k = gl_LocalInvocationID.x;
    float sum = 0.0;
    for (uint at = k; at < uint(parts.length()); at += 27u) {
        sum += parts[at];
    }
    sums[k] = sum;
}
