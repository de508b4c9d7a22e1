// SPDX-License-Identifier: MIT
// The limit: Embree called directly on rays that lie ready.
#ifndef BENCH_RAW_EMBREE_H
#define BENCH_RAW_EMBREE_H

#include "embree_clock.h"

typedef struct raw_embree raw_embree;
/// The scene's usable triangles with the flags and the quality that src/trace/embree.c asks for.
/// @param robust as its careful hierarchy, else as its quick one
/// @return NULL after a message
raw_embree *raw_embree_create(const alp_scene *scene, bool robust);
void raw_embree_destroy(raw_embree *raw);
double raw_embree_build_seconds(const raw_embree *raw);

/// rtcOccluded8 on each packet in place, all lanes.
void raw_embree_occluded(const raw_embree *raw, alpi_rays *packets, uint32_t count);
/// rtcOccludedNM on all packets at once.
void raw_embree_occluded_stream(const raw_embree *raw, alpi_rays *packets, uint32_t count);

/// Packets two by two, as the calls of sixteen rays take them. An odd last is left out.
void raw_embree_lay_pairs(const alpi_rays *packets, uint32_t count, alpi_ray_pair *pairs);
/// rtcOccluded16.
void raw_embree_occluded_pairs(const raw_embree *raw, alpi_ray_pair *pairs, uint32_t count);

/// rtcIntersect8, with the coherent flag or without, on copies of the packets that lie ready in the
/// cache. Of one scene by many threads.
/// @param clock bench_thread_seconds or alpi_seconds
/// @return its seconds of the calls alone
double raw_embree_time_nearest(const raw_embree *raw, const alpi_rays *packets, uint32_t count,
                               bool coherent, double (*clock)(void));
/// The same of pairs of packets by rtcIntersect16, with the coherent flag. An odd last is left out.
double raw_embree_time_pairs(const raw_embree *raw, const alpi_rays *packets, uint32_t count,
                             double (*clock)(void));
/// The recorded calls that begin at packets [begin, end), in the same way.
double raw_embree_time_calls(const raw_embree *raw, const embree_record *record, uint32_t begin,
                             uint32_t end, double (*clock)(void));

#endif
