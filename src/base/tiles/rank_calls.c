// SPDX-License-Identifier: MIT
#include "base/tiles/rank_calls.h"

#include "base/memory.h"
#include "base/tiles/tiles.h"

#include <alpenglow/ranks.h>

#include <stdio.h>
#include <string.h>

// Shapes of calls that are no loops. Those of loops are hashes.
enum { SHAPE_BEGIN = 1, SHAPE_END = 2, SHAPE_LOWEST = 3 };

alp_ranks alp_ranks_default(void)
{
    return (alp_ranks){.struct_size = sizeof(alp_ranks), .count = 1};
}

const alp_ranks *alpi_ranks_now(alp_context *context)
{
    return alpi_context_tiles(context)->together ? alpi_context_ranks(context) : NULL;
}

bool alpi_ranks_write(const alp_context *context)
{
    const alp_ranks *ranks = alpi_context_ranks(context);
    return ranks == NULL || ranks->rank == 0;
}

// --- one call ------------------------------------------------------------------------------------

/// State of a call while bytes of others arrive.
typedef struct receiving {
    const alpi_rank_call *call;
    bool differs, damaged;
    uint32_t failed;           // the lowest rank that failed
    alp_result result;         // and its result
    char text[ALPI_RANK_TEXT]; // and its message
} receiving;

static bool receive(void *receiver, uint32_t rank, const void *bytes, size_t size)
{
    receiving *r = receiver;
    alpi_rank_head head;
    if (size < sizeof head) {
        r->damaged = true;
        return true;
    }
    memcpy(&head, bytes, sizeof head);
    if (head.result != ALP_OK) {
        if (r->result == ALP_OK) {
            r->result = (alp_result)head.result;
            r->failed = rank;
            memcpy(r->text, head.text, sizeof r->text);
            r->text[sizeof r->text - 1] = '\0';
        }
    } else if (head.shape != r->call->shape || head.number != r->call->number) {
        r->differs = true;
    } else if (r->call->result == ALP_OK && r->call->take != NULL) {
        r->damaged = !r->call->take(r->call->user, rank, (const uint8_t *)bytes + sizeof head,
                                    size - sizeof head) ||
                     r->damaged;
    }
    return true;
}

/// The result of a call. Only damaged bytes are a failure that others do not know of.
static alp_result judge(alp_context *context, const receiving *r, bool exchanged)
{
    alpi_tiles *tiles = alpi_context_tiles(context);
    tiles->together = exchanged && !r->differs && r->result == ALP_OK && r->call->result == ALP_OK;
    if (r->call->result != ALP_OK) {
        return r->call->result;
    }
    if (!exchanged) {
        return alpi_fail(context, ALP_ERROR_IO,
                         "another rank is gone; start the command again, with --checkpoint it "
                         "goes on from what was written, with any number of ranks");
    }
    if (r->result != ALP_OK) {
        return alpi_fail(context, r->result, "rank %u stopped%s%s", r->failed,
                         r->text[0] != '\0' ? ": " : "", r->text);
    }
    if (r->differs) {
        return alpi_fail(context, ALP_ERROR_IO,
                         "the ranks run different bakes; start all of them with the same command, "
                         "file and version");
    }
    return r->damaged ? alpi_fail(context, ALP_ERROR_IO,
                                  "bytes of another rank are damaged; start the command again, "
                                  "with --checkpoint it goes on from what was written")
                      : ALP_OK;
}

alp_result alpi_rank_exchange(alp_context *context, const alpi_rank_call *call)
{
    const alp_ranks *ranks = alpi_context_ranks(context);
    receiving in = {.call = call};
    alpi_rank_head head = {.shape = call->shape, .number = call->number, .result = call->result};
    const void *sent = &head;
    size_t size = sizeof head;
    if (call->result != ALP_OK) {
        snprintf(head.text, sizeof head.text, "%s", alp_context_message(context));
    } else if (call->bytes != NULL) {
        memcpy(call->bytes, &head, sizeof head);
        sent = call->bytes;
        size = call->size;
    }
    const bool exchanged = ranks->exchange(ranks->user, sent, size, receive, &in);
    alpi_context_tiles(context)->claims++;
    return judge(context, &in, exchanged);
}

// --- beginning and end ---------------------------------------------------------------------------

/// The settings of this rank, and the first line that differs in another.
typedef struct comparison {
    const char *settings;
    uint32_t rank;
    const char *line; // of ours; NULL: none differs
} comparison;

static bool compare(void *user, uint32_t rank, const uint8_t *bytes, size_t size)
{
    comparison *c = user;
    const size_t own = strlen(c->settings) + 1;
    size_t line = 0, at = 0;
    if (c->line != NULL || (own == size && memcmp(bytes, c->settings, size) == 0)) {
        return true;
    }
    for (; at < own && at < size && (char)bytes[at] == c->settings[at]; at++) {
        line = c->settings[at] == '\n' ? at + 1 : line;
    }
    c->line = c->settings + line;
    c->rank = rank;
    return true;
}

static alp_result begin(alp_context *context, const char *settings, uint8_t *bytes, size_t size)
{
    const uint32_t own = alpi_context_ranks(context)->rank;
    comparison c = {.settings = settings};
    memcpy(bytes + sizeof(alpi_rank_head), settings, size - sizeof(alpi_rank_head));
    ALP_TRY(alpi_rank_exchange(
        context,
        &(alpi_rank_call){
            .shape = SHAPE_BEGIN, .bytes = bytes, .size = size, .take = compare, .user = &c}));
    if (c.line == NULL) {
        return ALP_OK;
    }
    alpi_context_tiles(context)->together = false; // every rank sees a difference
    return alpi_fail(context, ALP_ERROR_IO,
                     "the ranks run different bakes: rank %u has \"%.*s\", rank %u has not; start "
                     "all of them with the same command, file and version",
                     own, (int)strcspn(c.line, "\n"), c.line, c.rank);
}

alp_result alpi_ranks_begin(alp_context *context, const char *settings, bool *began)
{
    alpi_tiles *tiles = alpi_context_tiles(context);
    *began = alpi_context_ranks(context) != NULL && !tiles->together;
    if (!*began) {
        return ALP_OK;
    }
    tiles->together = true;
    const size_t size = sizeof(alpi_rank_head) + strlen(settings) + 1;
    uint8_t *bytes = ALPI_NEW(context, uint8_t, size);
    if (bytes == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY; // the end lets others know
    }
    const alp_result result = begin(context, settings, bytes, size);
    alpi_release(context, bytes);
    return result;
}

static bool take_lower(void *user, uint32_t rank, const uint8_t *bytes, size_t size)
{
    (void)rank;
    uint64_t *value = user, other = 0;
    if (size != sizeof other) {
        return false;
    }
    memcpy(&other, bytes, size);
    *value = other < *value ? other : *value;
    return true;
}

alp_result alpi_ranks_lowest(alp_context *context, uint64_t *value)
{
    uint8_t bytes[sizeof(alpi_rank_head) + sizeof *value];
    if (alpi_ranks_now(context) == NULL) {
        return ALP_OK;
    }
    memcpy(bytes + sizeof(alpi_rank_head), value, sizeof *value);
    return alpi_rank_exchange(context, &(alpi_rank_call){.shape = SHAPE_LOWEST,
                                                         .bytes = bytes,
                                                         .size = sizeof bytes,
                                                         .take = take_lower,
                                                         .user = value});
}

/// Leaves no tile of the next loop to others, so that they see the failure soon.
static void claim_all(alp_context *context)
{
    const alp_ranks *ranks = alpi_context_ranks(context);
    for (uint32_t i = 0; i < ranks->count; i++) {
        (void)ranks->claim(ranks->user, alpi_context_tiles(context)->claims, i, UINT32_MAX);
    }
}

alp_result alpi_ranks_end(alp_context *context, alp_result result)
{
    alpi_tiles *tiles = alpi_context_tiles(context);
    if (!tiles->together) {
        return result;
    }
    if (result != ALP_OK) {
        claim_all(context);
    }
    result = alpi_rank_exchange(context, &(alpi_rank_call){.shape = SHAPE_END, .result = result});
    tiles->together = false;
    return result;
}
