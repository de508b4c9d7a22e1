// SPDX-License-Identifier: MIT
// The public projection of cube maps: it checks rows and keeps the sums between calls.
#include "base/memory.h"
#include "sh/sh_project.h"

#include <string.h>

struct alp_sh_projection {
    alp_context *context;
    alpi_cube_table table;
    alpi_cube_sum_fn *sum;
    alpi_cube_sums sums;
    uint8_t *added;   // [6][size] rows: 1, or 0
    uint32_t missing; // rows of all faces
};

static void empty(alp_sh_projection *p)
{
    memset(&p->sums, 0, sizeof p->sums);
    memset(p->added, 0, (size_t)ALPI_CUBE_FACES * p->table.size);
    p->missing = ALPI_CUBE_FACES * p->table.size;
}

static alp_result fill(alp_sh_projection *p, uint32_t size)
{
    ALP_TRY(alpi_cube_table_create(p->context, size, &p->table));
    ALPI_TRY_NEW(p->context, p->added, (size_t)ALPI_CUBE_FACES * size);
    p->sum = &ALPI_COMPILED_FOR(p->context, alpi_cube_sum);
    empty(p);
    return ALP_OK;
}

alp_result alp_sh_projection_create(alp_context *context, uint32_t size,
                                    alp_sh_projection **projection)
{
    if (context == NULL || projection == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    *projection = NULL;
    if (size < 1 || size > ALPI_CUBE_SIZE_LIMIT) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "cube map: faces of %u texels; give 1 to %d", size, ALPI_CUBE_SIZE_LIMIT);
    }
    alp_sh_projection *p = ALPI_NEW(context, alp_sh_projection, 1);
    if (p == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    p->context = context;
    const alp_result result = fill(p, size);
    if (result != ALP_OK) {
        alp_sh_projection_destroy(p);
        return result;
    }
    *projection = p;
    return ALP_OK;
}

void alp_sh_projection_destroy(alp_sh_projection *projection)
{
    if (projection != NULL) {
        alpi_cube_table_release(projection->context, &projection->table);
        alpi_release(projection->context, projection->added);
        alpi_release(projection->context, projection);
    }
}

alp_result alp_sh_projection_add(alp_sh_projection *p, alp_cube_face face, uint32_t first_row,
                                 uint32_t row_count, const float *pixels)
{
    if (p == NULL || pixels == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    const uint32_t size = p->table.size;
    if ((unsigned)face >= ALPI_CUBE_FACES || first_row > size || row_count > size - first_row) {
        return alpi_fail(p->context, ALP_ERROR_INVALID_ARGUMENT,
                         "cube map: face %d, rows %u + %u; there are 6 faces of %u rows", (int)face,
                         first_row, row_count, size);
    }
    uint8_t *added = p->added + (size_t)face * size + first_row;
    if (memchr(added, 1, row_count) != NULL) {
        return alpi_fail(p->context, ALP_ERROR_INVALID_ARGUMENT,
                         "cube map: face %d, rows %u + %u: a row was added before", (int)face,
                         first_row, row_count);
    }
    memset(added, 1, row_count);
    p->missing -= row_count;
    alpi_cube_add(&p->table, p->sum, face, first_row, row_count, pixels, &p->sums);
    return ALP_OK;
}

alp_result alp_sh_projection_finish(alp_sh_projection *p, alp_sh9 *radiance)
{
    if (p == NULL || radiance == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    if (p->missing > 0) {
        return alpi_fail(p->context, ALP_ERROR_INVALID_ARGUMENT,
                         "cube map: %u of its %u rows are missing", p->missing,
                         ALPI_CUBE_FACES * p->table.size);
    }
    *radiance = alpi_cube_finish(&p->sums);
    empty(p);
    return ALP_OK;
}

alp_result alp_sh_project_cube(alp_sh_projection *p, const float *const faces[6], alp_sh9 *radiance)
{
    if (p == NULL || faces == NULL || radiance == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    empty(p);
    for (int face = 0; face < ALPI_CUBE_FACES; face++) {
        ALP_TRY(alp_sh_projection_add(p, (alp_cube_face)face, 0, p->table.size, faces[face]));
    }
    return alp_sh_projection_finish(p, radiance);
}
