// SPDX-License-Identifier: MIT
// The live ambience volume: what its files share.
//
// The graph (ambience_graph.h) says where anchors are. The anchors (ambience_anchors.c) hold light
// and fade it. Requests (ambience_requests.c) deliver light. The plan (ambience_plan.c) says where
// to sample next. Readers see none of these: each update copies them to a snapshot
// (ambience_snapshot.h).
#ifndef ALPI_FIELDS_AMBIENCE_H
#define ALPI_FIELDS_AMBIENCE_H

#include "fields/ambience/ambience_graph.h"
#include "fields/ambience/ambience_snapshot.h"
#include "sh/sh9.h"

#include <alpenglow/ambience.h>

/// How far an anchor is.
typedef enum alpi_anchor_state {
    ALPI_ANCHOR_FREE = 0, // in the list of free ones
    ALPI_ANCHOR_EMPTY,    // waits for its first light
    ALPI_ANCHOR_LIT,
    ALPI_ANCHOR_SOLID
} alpi_anchor_state;

typedef struct alpi_anchor {
    int32_t index[3];      // of the topmost node of its place when it was made
    uint8_t level;         // of that node
    uint8_t state;         // alpi_anchor_state
    bool pending;          // a request for it is open
    bool leaving;          // its light has expired and fades out
    bool again;            // it goes stale when its fade ends
    bool coarse;           // sampled by few rays
    uint8_t fade_levels;   // on which its confidence changes light, at most
    uint32_t stale_light;  // serial of the change of light that it does not have yet; 0: none
    uint32_t stale_trace;  // the same of geometry
    float height;          // flat: metres of its place along y
    uint32_t slot;         // of alp_ambience.lights: its light, as readers see it; NO_SLOT: none
    uint32_t next;         // of alp_ambience.nexts: what it becomes; NO_SLOT: it is
    float mean;            // E of its light
    float surface;         // of a solid: metres to the nearest surface, at least
    float fade_left;       // seconds until then
    float confidence;      // [0, 1]
    float confidence_rate; // 1/s, below 0 while leaving
    float open;            // what `closed` leaves of its weight: 1: no solid; 0: solid
    float closed;          // [0, 1]: share of the fade to a solid; above 0 only without light
    float solid_rate;      // 1/s of that fade
    float change;          // relative change of E at its last renewal
    double born;           // when its newest light was sampled
    double wanted;         // when a window last held it
    uint32_t version;      // new whenever what readers see changes
    uint32_t next_free;
    void *hits;         // the sampler's
    uint32_t hits_face; // rays of them along an edge
} alpi_anchor;

typedef struct alpi_request_slot alpi_request_slot;
typedef struct alpi_face_table alpi_face_table;

/// A place that is wanted, with the urgency to sample it.
typedef struct alpi_wish {
    float urgency;
    uint32_t level;
    int32_t index[3];
} alpi_wish;

struct alp_ambience {
    alp_context *context;
    alp_ambience_options options;
    double unit;                         // metres: the cell of level 0
    double bounds_min[3], bounds_max[3]; // metres: where light is wanted; infinite by default
    alpi_graph graph;

    alpi_anchor *anchors;
    size_t anchor_capacity;
    uint32_t anchor_end, free_anchor, anchor_count;
    uint32_t version_serial; // of anchors
    uint32_t stale_serial;   // of changes of light and geometry
    alpi_light_pool lights, nexts;

    alpi_request_slot *slots;
    uint64_t slot_serial;
    bool requests_open;
    _Atomic(alpi_face_table *) face_tables; // a list that only grows, by any thread

    double time, first_time;          // NaN before the first update
    float base[ALPI_AMBIENCE_FLOATS]; // light where no anchor has any: follows their mean
    float mean;                       // E of the mean of all anchors
    float dawn;                       // [0, 1]: share of all light that is there
    float fade_rate;                  // 1/s: largest change of E that a fade makes, over the mean E
    alpi_snapshots snapshots;

    alpi_wish *wishes; // sorted, most urgent last
    size_t wish_capacity;
    uint32_t wish_count;
    uint32_t plan_age;      // updates since the last plan
    double planned_time;    // of that; NaN before
    double planned_from[3]; // where the camera was
    double velocity[3];     // of the camera, smoothed
    double rate;            // anchors per second that can be sampled, as far as measured
    uint32_t taken;         // anchors sampled since the last update
    uint64_t hit_bytes;     // memory of kept hits
    const alp_ambience_sampler *sampler;                            // NULL: none
    void (*drop_hits)(alp_ambience *ambience, alpi_anchor *anchor); // NULL: none are kept
};

// --- places --------------------------------------------------------------------------------------

/// Place of a node in metres; y of a flat volume from the ground.
void alpi_ambience_place(const alp_ambience *ambience, uint32_t level, const int32_t index[3],
                         double place[3]);
/// Index of the node that holds a place. @return false: beyond the lattice, or not finite
bool alpi_ambience_index(const alp_ambience *ambience, uint32_t level, const double place[3],
                         int32_t index[3]);
static inline double alpi_ambience_cell(const alp_ambience *ambience, uint32_t level)
{
    return ambience->unit * (double)alpi_graph_width(level);
}

/// The snapshot that readers begin with.
static inline const alp_ambience_snapshot *alpi_ambience_published(const alp_ambience *ambience)
{
    return ambience->snapshots.all[atomic_load(&ambience->snapshots.current)];
}

// --- anchors -------------------------------------------------------------------------------------

/// Makes the anchor of a node. @param anchor out: NO_ANCHOR at the limit
alp_result alpi_anchor_create(alp_ambience *ambience, uint32_t node, uint32_t *anchor);
void alpi_anchor_release(alp_ambience *ambience, uint32_t anchor);
/// Metres, as alpi_ambience_place; the height of the ground is that when the anchor was made.
void alpi_anchor_place(const alp_ambience *ambience, const alpi_anchor *anchor, double place[3]);
/// Takes new light. @param moments NULL, or [MOMENTS]: mean distance and its square
/// @param serial stale_serial when it was sampled: later changes stay to be sampled
/// @return ALP_OK; OUT_OF_MEMORY: it keeps what it has
alp_result alpi_anchor_light(alp_ambience *ambience, uint32_t anchor, const alpi_sh9 *radiance,
                             const float (*moments)[2], uint32_t serial);
/// @param surface metres to the nearest surface, at least
void alpi_anchor_solid(alp_ambience *ambience, uint32_t anchor, float surface, uint32_t serial);
/// Fades, expires and releases all by a step of time.
void alpi_anchors_step(alp_ambience *ambience, double step);
/// Gives memory of anchors that are gone back. @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_ambience_compact(alp_ambience *ambience);
/// Light where no anchor has any moves to the mean of all anchors. The first light dawns.
void alpi_ambience_find_base(alp_ambience *ambience, double step);
/// Mean irradiance over all directions, mean of the channels.
float alpi_ambience_mean(const float light[ALPI_AMBIENCE_FLOATS]);

// --- requests ------------------------------------------------------------------------------------

alp_result alpi_requests_create(alp_ambience *ambience);
void alpi_requests_destroy(alp_ambience *ambience);
/// Opens a request for an anchor. @return its number; 0: too many are open
uint64_t alpi_request_open(alp_ambience *ambience, uint32_t anchor);
/// Gives answers to their anchors, and drops requests that are too old.
/// @return ALP_OK; OUT_OF_MEMORY: some answers are lost, and their anchors are wanted again
alp_result alpi_requests_collect(alp_ambience *ambience);
uint64_t alpi_requests_bytes(void);
uint32_t alpi_requests_count(const alp_ambience *ambience);

// --- planning ------------------------------------------------------------------------------------

/// The most urgent anchor, marked as pending. @param anchor out: NO_ANCHOR: nothing is wanted
/// @return as alp_ambience_next
alp_result alpi_ambience_choose(alp_ambience *ambience, const alp_ambience_camera *camera,
                                uint32_t *anchor);

#endif
