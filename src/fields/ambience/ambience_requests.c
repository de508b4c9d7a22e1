// SPDX-License-Identifier: MIT
// Requests and their answers, which may come from any thread. The thread of the ambience opens a
// slot: from FREE to OPEN. The first thread that answers moves it to TAKEN, and then to ANSWERED.
// The next update frees it.
#include "base/memory.h"
#include "fields/ambience/ambience.h"
#include "sh/sh_project.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

enum { SLOTS = 256, SLOT_BITS = 8, SAMPLES_MOST = 1 << 12 };

/// Low bits of a slot's word: where it is; the others: its serial, which a request's id holds too.
enum { FREE = 0, OPEN, TAKEN, ANSWERED, STATE_BITS = 2 };
static const uint64_t STATE_MASK = (1u << STATE_BITS) - 1u;

static const float LARGEST = 1e30f; // coefficient: sums stay finite

struct alpi_request_slot {
    _Atomic(uint64_t) word; // serial << STATE_BITS | state
    uint32_t anchor;
    uint32_t serial; // of the changes of light that were known
    double opened;
    bool solid;
    alpi_sh9 radiance;
};

/// How faces of one size are projected.
struct alpi_face_table {
    alpi_cube_table table;
    alpi_face_table *next;
};

alp_result alpi_requests_create(alp_ambience *a)
{
    atomic_init(&a->face_tables, NULL);
    a->slots = ALPI_NEW(a->context, alpi_request_slot, SLOTS);
    return a->slots != NULL ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
}

static void destroy_table(alp_context *context, alpi_face_table *table)
{
    alpi_cube_table_release(context, &table->table);
    alpi_release(context, table);
}

void alpi_requests_destroy(alp_ambience *a)
{
    alpi_face_table *next = NULL;
    for (alpi_face_table *t = atomic_load(&a->face_tables); t != NULL; t = next) {
        next = t->next;
        destroy_table(a->context, t);
    }
    alpi_release(a->context, a->slots);
}

uint64_t alpi_requests_bytes(void)
{
    return SLOTS * sizeof(alpi_request_slot);
}

uint32_t alpi_requests_count(const alp_ambience *a)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < SLOTS; i++) {
        count += (atomic_load(&a->slots[i].word) & STATE_MASK) != FREE;
    }
    return count;
}

uint64_t alpi_request_open(alp_ambience *a, uint32_t anchor)
{
    for (uint32_t k = 0; k < SLOTS; k++) {
        const uint32_t i = ((uint32_t)a->slot_serial + k) % SLOTS;
        alpi_request_slot *slot = &a->slots[i];
        if ((atomic_load(&slot->word) & STATE_MASK) != FREE) {
            continue;
        }
        const uint64_t serial = ++a->slot_serial << SLOT_BITS | i;
        slot->anchor = anchor;
        slot->serial = a->stale_serial;
        slot->opened = a->time;
        slot->solid = false;
        atomic_store(&slot->word, serial << STATE_BITS | OPEN);
        a->requests_open = true;
        return serial;
    }
    return 0;
}

/// Opens a slot for writing by whoever answers first.
static alpi_request_slot *take(alp_ambience *a, uint64_t id)
{
    alpi_request_slot *slot = &a->slots[id & (SLOTS - 1)];
    uint64_t expected = id << STATE_BITS | OPEN;
    return atomic_compare_exchange_strong(&slot->word, &expected, id << STATE_BITS | TAKEN) ? slot
                                                                                            : NULL;
}

static alp_result refuse(const alp_ambience *a, uint64_t id)
{
    return alpi_fail(a->context, ALP_ERROR_INVALID_ARGUMENT,
                     "ambience: request %llu is not open: it was answered, or waited for longer "
                     "than a lifetime; drop the answer",
                     (unsigned long long)id);
}

alp_result alp_ambience_submit(alp_ambience *ambience, uint64_t id, const alp_sh9 *radiance)
{
    if (ambience == NULL || radiance == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    for (int i = 0; i < ALPI_AMBIENCE_FLOATS; i++) {
        if (!(fabsf(radiance->c[i / 3][i % 3]) <= LARGEST)) {
            return alpi_fail(ambience->context, ALP_ERROR_INVALID_ARGUMENT,
                             "ambience: coefficient %d of request %llu is not finite, or above "
                             "1e30; the request "
                             "stays open",
                             i / 3, (unsigned long long)id);
        }
    }
    alpi_request_slot *slot = take(ambience, id);
    if (slot == NULL) {
        return refuse(ambience, id);
    }
    slot->radiance = *radiance;
    atomic_store(&slot->word, id << STATE_BITS | ANSWERED);
    return ALP_OK;
}

alp_result alp_ambience_submit_solid(alp_ambience *ambience, uint64_t id)
{
    if (ambience == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    alpi_request_slot *slot = take(ambience, id);
    if (slot == NULL) {
        return refuse(ambience, id);
    }
    slot->solid = true;
    atomic_store(&slot->word, id << STATE_BITS | ANSWERED);
    return ALP_OK;
}

/// The table of a face's size, made at its first use. Two threads may both make one.
static alp_result find_table(alp_ambience *a, uint32_t side, const alpi_cube_table **table)
{
    alpi_face_table *first = atomic_load(&a->face_tables);
    for (const alpi_face_table *t = first; t != NULL; t = t->next) {
        if (t->table.size == side) {
            *table = &t->table;
            return ALP_OK;
        }
    }
    alpi_face_table *made = ALPI_NEW(a->context, alpi_face_table, 1);
    if (made == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const alp_result result = alpi_cube_table_create(a->context, side, &made->table);
    if (result != ALP_OK) {
        destroy_table(a->context, made);
        return result;
    }
    do {
        made->next = first;
    } while (!atomic_compare_exchange_weak(&a->face_tables, &first, made));
    *table = &made->table;
    return ALP_OK;
}

alp_result alp_ambience_submit_faces(alp_ambience *ambience, uint64_t id, uint32_t side,
                                     const float *const faces[6])
{
    if (ambience == NULL || faces == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    if (side < 1 || side > SAMPLES_MOST) {
        return alpi_fail(ambience->context, ALP_ERROR_INVALID_ARGUMENT,
                         "ambience: faces of %u pixels, need 1 to %d", side, SAMPLES_MOST);
    }
    for (int i = 0; i < 6; i++) {
        if (faces[i] == NULL) {
            return alpi_fail(ambience->context, ALP_ERROR_INVALID_ARGUMENT,
                             "ambience: face %d of request %llu is missing", i,
                             (unsigned long long)id);
        }
    }
    const alpi_cube_table *table = NULL;
    alpi_cube_sums sums = {0};
    ALP_TRY(find_table(ambience, side, &table));
    for (int i = 0; i < ALPI_CUBE_FACES; i++) {
        alpi_cube_add(table, &ALPI_COMPILED_FOR(ambience->context, alpi_cube_sum), (alp_cube_face)i,
                      0, side, faces[i], &sums);
    }
    const alpi_sh9 radiance = alpi_cube_finish(&sums);
    return alp_ambience_submit(ambience, id, &radiance);
}

/// Frees a slot that waits too long, unless it is being answered right now.
static void drop_void(alp_ambience *a, alpi_request_slot *slot, uint64_t word)
{
    if (a->time - slot->opened > a->options.lifetime &&
        atomic_compare_exchange_strong(&slot->word, &word, word & ~STATE_MASK)) {
        a->anchors[slot->anchor].pending = false;
    }
}

alp_result alpi_requests_collect(alp_ambience *a)
{
    alp_result result = ALP_OK;
    if (!a->requests_open) {
        return ALP_OK;
    }
    a->requests_open = false;
    for (uint32_t i = 0; i < SLOTS; i++) {
        alpi_request_slot *slot = &a->slots[i];
        const uint64_t word = atomic_load(&slot->word);
        if ((word & STATE_MASK) == ANSWERED) {
            if (slot->solid) {
                alpi_anchor_solid(a, slot->anchor, 0.0f, slot->serial);
            } else {
                const alp_result one =
                    alpi_anchor_light(a, slot->anchor, &slot->radiance, NULL, slot->serial);
                result = result == ALP_OK ? one : result;
            }
            atomic_store(&slot->word, word & ~STATE_MASK);
        } else if ((word & STATE_MASK) == OPEN) {
            drop_void(a, slot, word);
        }
        a->requests_open |= (atomic_load(&slot->word) & STATE_MASK) != FREE;
    }
    return result;
}
