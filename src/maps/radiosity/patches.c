// SPDX-License-Identifier: MIT
#include "maps/radiosity/patches.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "maps/radiosity/patch_lookup.h"
#include "scene/lights/lighting.h"

#include <math.h>
#include <string.h>

enum { ALBEDO_STRATA = 4, SPACING_LIMIT = 16, BLOCK_LIMIT = SPACING_LIMIT * SPACING_LIMIT };

// --- what a texel reflects -----------------------------------------------------------------------

static uint32_t material_of(const alp_scene *scene, uint32_t triangle)
{
    return scene->surfaces[scene->triangle_surface[triangle]].material;
}

/// Whether all points of a texel are alike: of one material, without textures or vertex colours.
static bool is_even(const alpi_patches *p, uint32_t texel)
{
    const alp_scene *scene = p->scene;
    const alpi_texels *t = p->texels;
    const uint32_t material = material_of(scene, t->triangles[texel]);
    const alpi_material *m = material != ALPI_NONE ? &scene->materials[material] : NULL;
    const bool textured =
        m != NULL &&
        (m->base_color_texture.image != ALPI_NONE ||
         (scene->metals_black && m->metallic_texture.image != ALPI_NONE) ||
         m->emission_texture.image != ALPI_NONE || m->transmission_texture.image != ALPI_NONE);
    bool even = scene->colors == NULL && !textured;
    for (uint32_t k = t->piece_first[texel]; k < t->piece_first[texel + 1] && even; k++) {
        even = material_of(scene, alpi_atlas_triangle(t->atlas, t->piece_triangles[k])) == material;
    }
    return even;
}

static vec3 outward(const alp_scene *scene, uint32_t triangle)
{
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    return vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
}

static bool is_masked_out(const alp_scene *scene, const alpi_texel_spot *s)
{
    const uint32_t material = material_of(scene, s->triangle);
    return material != ALPI_NONE && scene->materials[material].alpha_mode == ALPI_ALPHA_MASK &&
           alpi_surface_is_cut(scene, s->triangle, s->b1, s->b2);
}

/// Albedo and emission, means over those of the texel's strata that are there for a ray to meet.
static void find_material(const alpi_patches *p, uint32_t texel, bool even)
{
    const uint32_t strata = even ? 1 : ALBEDO_STRATA;
    double albedo[3] = {0.0}, emission[3] = {0.0};
    uint32_t met = 0;
    for (uint32_t i = 0; i < strata * strata; i++) {
        const uint32_t column = i % strata, row = i / strata;
        const float at[2] = {((float)column + 0.5f) / (float)strata,
                             ((float)row + 0.5f) / (float)strata};
        alpi_texel_spot s;
        alpi_texels_spot(p->texels, texel, at, &s);
        if (is_masked_out(p->scene, &s)) {
            continue;
        }
        met++;
        const alpi_pane pane = alpi_surface_pane(p->scene, s.triangle, s.b1, s.b2);
        const vec3 a = alpi_surface_albedo(p->scene, s.triangle, s.b1, s.b2);
        const vec3 e =
            alpi_surface_emission(p->scene, s.triangle, s.b1, s.b2, outward(p->scene, s.triangle));
        const float ab[3] = {a.x, a.y, a.z}, eb[3] = {e.x, e.y, e.z};
        for (int k = 0; k < 3; k++) {
            albedo[k] += (double)(pane.kept * ab[k]);
            emission[k] += (double)eb[k];
        }
    }
    for (int k = 0; k < 3 && met > 0; k++) {
        p->reflectances[texel][k] = (float)(albedo[k] / met);
    }
    p->emissions[texel] =
        met > 0 ? (float)((emission[0] + emission[1] + emission[2]) / (3.0 * met)) : 0.0f;
}

/// How far a hit counts as near, while nothing is known of the light (patch_reach.h).
static void note_side(const alpi_patches *p, uint32_t texel)
{
    for (int of = ALPI_FRONT; of <= (p->two_sided ? ALPI_BACK : ALPI_FRONT); of++) {
        const uint32_t cell = alpi_patches_cell(p, texel, (alpi_side)of);
        p->cells[cell][ALPI_CELL_SIDE] = alpi_texels_side(p->texels, texel);
    }
}

static alp_result find_materials(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const alpi_patches *p = user;
    uint32_t known = ALPI_NONE; // an even texel, whose material is mostly that of the next one too
    for (uint32_t t = begin; t < end; t++) {
        note_side(p, t);
        const bool even = is_even(p, t);
        if (even && known != ALPI_NONE &&
            material_of(p->scene, p->texels->triangles[known]) ==
                material_of(p->scene, p->texels->triangles[t])) {
            memcpy(p->reflectances[t], p->reflectances[known], sizeof *p->reflectances);
            p->emissions[t] = p->emissions[known];
            continue;
        }
        find_material(p, t, even);
        known = even ? t : known;
    }
    return ALP_OK;
}

// --- blocks --------------------------------------------------------------------------------------
//
// Rows of squares make their blocks side by side: where the texels of each begin is counted first,
// and blocks, which are no more than texels, begin there too until it is known how many there are.

/// A row of squares of a page, and what is made of it.
typedef struct square_row {
    uint32_t first, placed;  // texels before those of this row, and before the next one to place
    uint32_t blocks, before; // made in this row, and in those before
} square_row;

/// Texels of one square of the page, with light of their own, chart by chart.
typedef struct page_square {
    uint32_t count;
    uint32_t texels[BLOCK_LIMIT];
} page_square;

static void list_square(const alpi_patches *p, uint32_t page, uint32_t x0, uint32_t y0,
                        uint32_t spacing, page_square *s)
{
    s->count = 0;
    for (uint32_t y = y0; y < y0 + spacing; y++) {
        for (uint32_t x = x0; x < x0 + spacing; x++) {
            const uint32_t t = alpi_lattice_texel(p->lattice, page, x, y);
            if (t != ALPI_NONE && p->blocks[t] != ALPI_NONE) {
                s->texels[s->count++] = t;
            }
        }
    }
}

/// Takes the texels of the first one's chart out of a square and makes a block of them.
static void take_block(const alpi_patches *p, page_square *s, square_row *row)
{
    const uint32_t chart = p->texels->charts[s->texels[0]], first = row->placed;
    uint32_t placed = first, left = 0;
    double area = 0.0;
    for (uint32_t i = 0; i < s->count; i++) {
        const uint32_t t = s->texels[i];
        if (p->texels->charts[t] != chart) {
            s->texels[left++] = t;
            continue;
        }
        area += (double)alpi_texels_area(p->texels, t);
        p->blocks[t] = row->blocks;
        p->block_ends[placed] = (float)area;
        p->block_texels[placed++] = t;
    }
    for (uint32_t i = first; i < placed; i++) {
        p->block_ends[i] = area > 0.0 ? (float)((double)p->block_ends[i] / area)
                                      : (float)(i - first + 1) / (float)(placed - first);
    }
    p->block_ends[placed - 1] = 1.0f;
    p->block_areas[row->first + row->blocks] = area;
    p->block_first[row->first + row->blocks] = first;
    row->blocks++;
    row->placed = placed;
    s->count = left;
}

/// Side of the blocks of a square, by the rule. Of texels that lie in a solid in part the light is
/// that of the other part.
static uint32_t choose_side(const alpi_patches *p, const page_square *s, uint32_t spacing)
{
    uint32_t side = spacing;
    for (uint32_t i = 0; i < s->count && p->near != NULL; i++) {
        const uint32_t t = s->texels[i];
        if ((p->texels->valid != NULL && p->texels->valid[t] != 0) || p->near[t] == ALPI_TOUCHING) {
            return 1;
        }
        side = p->near[t] == ALPI_FAR ? side : spacing % 2 == 0 ? spacing / 2 : 1;
    }
    return side;
}

/// Blocks of one square of the page, or of its parts, where light changes fast.
static void split_square(const alpi_patches *p, uint32_t page, uint32_t x0, uint32_t y0,
                         uint32_t spacing, square_row *row)
{
    page_square s;
    list_square(p, page, x0, y0, spacing, &s);
    const uint32_t part = choose_side(p, &s, spacing);
    while (part == spacing && s.count > 0) {
        take_block(p, &s, row);
    }
    for (uint32_t y = y0; y < y0 + spacing && part < spacing; y += part) {
        for (uint32_t x = x0; x < x0 + spacing; x += part) {
            list_square(p, page, x, y, part, &s);
            while (s.count > 0) {
                take_block(p, &s, row);
            }
        }
    }
}

typedef struct block_job {
    const alpi_patches *patches;
    uint32_t spacing, rows; // of squares, of each page
    square_row *all;        // [pages × rows]
} block_job;

/// Texels with light of their own in each row.
static alp_result count_rows(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const block_job *job = user;
    const alpi_patches *p = job->patches;
    const alpi_lattice *l = p->lattice;
    for (uint32_t r = begin; r < end; r++) {
        const uint32_t page = r / job->rows, y0 = r % job->rows * job->spacing;
        const uint32_t rows = l->height - y0 < job->spacing ? l->height - y0 : job->spacing;
        const uint32_t *texels = &l->grid[alpi_lattice_pixel(l, page, 0, y0)];
        uint32_t count = 0;
        for (size_t i = 0; i < (size_t)l->width * rows; i++) {
            count += texels[i] != ALPI_NONE && p->blocks[texels[i]] != ALPI_NONE ? 1 : 0;
        }
        job->all[r].placed = count;
    }
    return ALP_OK;
}

static alp_result split_rows(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const block_job *job = user;
    for (uint32_t r = begin; r < end; r++) {
        const uint32_t page = r / job->rows, y0 = r % job->rows * job->spacing;
        for (uint32_t x = 0; x < job->patches->lattice->width; x += job->spacing) {
            split_square(job->patches, page, x, y0, job->spacing, &job->all[r]);
        }
    }
    return ALP_OK;
}

/// Tells the texels of each row the numbers that its blocks have among all.
static alp_result number_rows(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const block_job *job = user;
    const alpi_patches *p = job->patches;
    for (uint32_t r = begin; r < end; r++) {
        const square_row *row = &job->all[r];
        for (uint32_t i = row->first; i < row->placed; i++) {
            p->blocks[p->block_texels[i]] += row->before;
        }
    }
    return ALP_OK;
}

/// Moves the blocks of each row behind those of the rows before.
static void join_rows(alpi_patches *p, uint32_t count, square_row *rows)
{
    for (uint32_t r = 0; r < count; r++) {
        const uint32_t first = rows[r].first, blocks = rows[r].blocks, to = p->block_count;
        memmove(p->block_first + to, p->block_first + first, blocks * sizeof *p->block_first);
        memmove(p->block_areas + to, p->block_areas + first, blocks * sizeof *p->block_areas);
        rows[r].before = to;
        p->block_count += blocks;
    }
    p->block_first[p->block_count] = count > 0 ? rows[count - 1].placed : 0;
}

static alp_result make_blocks(alpi_patches *p, uint32_t spacing)
{
    enum { ROWS_PER_RANGE = 4 };
    const uint32_t rows = (p->lattice->height + spacing - 1) / spacing;
    const uint32_t count = p->lattice->page_count * rows;
    block_job job = {p, spacing, rows, ALPI_NEW(p->context, square_row, count)};
    if (job.all == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result =
        alpi_parallel_for(p->context, count, ROWS_PER_RANGE, count_rows, &job, NULL);
    for (uint32_t r = 0, first = 0; r < count && result == ALP_OK; r++) {
        const uint32_t texels = job.all[r].placed;
        job.all[r] = (square_row){.first = first, .placed = first};
        first += texels;
    }
    if (result == ALP_OK) {
        result = alpi_parallel_for(p->context, count, ROWS_PER_RANGE, split_rows, &job, NULL);
    }
    if (result == ALP_OK) {
        join_rows(p, count, job.all);
        result = alpi_parallel_for(p->context, count, ROWS_PER_RANGE, number_rows, &job, NULL);
    }
    result = result == ALP_OK ? alpi_tick(p->context, "light", 0, 1) : result;
    alpi_release(p->context, job.all);
    return result;
}

/// The member of a block that holds u of its area.
static uint32_t find_member(const alpi_patches *p, uint32_t block, float u)
{
    uint32_t low = p->block_first[block], high = p->block_first[block + 1] - 1;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (u < p->block_ends[middle]) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return low;
}

// --- receivers -----------------------------------------------------------------------------------

/// The other side of each point.
static void turn_over(uint32_t count, alpi_receiver_point *points)
{
    for (uint32_t i = 0; i < count; i++) {
        points[i].geometric_normal = vec3_scale(points[i].geometric_normal, -1.0f);
        points[i].shading_normal = vec3_scale(points[i].shading_normal, -1.0f);
    }
}

static void place_in_texel(const void *user, uint32_t receiver, uint32_t count,
                           const float (*square)[2], alpi_receiver_point *points)
{
    const alpi_patches *p = user;
    const alpi_receivers texels = alpi_texels_receivers(p->texels);
    const bool back = receiver >= texels.count;
    texels.place(texels.user, back ? receiver - texels.count : receiver, count, square, points);
    if (back) {
        turn_over(count, points);
    }
}

alpi_receivers alpi_patches_texel_receivers(const alpi_patches *patches)
{
    return (alpi_receivers){.count = patches->texels->count * (patches->two_sided ? 2u : 1u),
                            .extended = true,
                            .place = place_in_texel,
                            .user = patches};
}

enum { PLACE_BATCH = 64 };

/// Points that fall into one texel of a block are placed together: they are chained texel by texel.
static void place_batch(const alpi_patches *p, uint32_t block, uint32_t count,
                        const float (*square)[2], alpi_receiver_point *points)
{
    enum { NONE = UINT8_MAX };
    _Static_assert((int)PLACE_BATCH <= (int)NONE, "points are numbers below it");
    const alpi_receivers texels = alpi_texels_receivers(p->texels);
    const uint32_t first = p->block_first[block], members = p->block_first[block + 1] - first;
    if (members == 1) {
        texels.place(texels.user, p->block_texels[first], count, square, points);
        return;
    }
    uint8_t heads[BLOCK_LIMIT], next[PLACE_BATCH] = {0}, lanes[PLACE_BATCH];
    float inside[PLACE_BATCH][2];
    alpi_receiver_point placed[PLACE_BATCH];
    memset(heads, NONE, members);
    for (uint32_t i = count; i-- > 0;) {
        uint8_t *head = &heads[find_member(p, block, square[i][0]) - first];
        next[i] = *head;
        *head = (uint8_t)i;
    }
    for (uint32_t m = 0; m < members; m++) {
        const float begin = m == 0 ? 0.0f : p->block_ends[first + m - 1];
        const float width = p->block_ends[first + m] - begin;
        uint32_t together = 0;
        for (uint8_t i = heads[m]; i != NONE; i = next[i]) {
            const float u = width > 0.0f ? (square[i][0] - begin) / width : 0.0f;
            inside[together][0] = fminf(fmaxf(u, 0.0f), 1.0f - 0x1p-24f);
            inside[together][1] = square[i][1];
            lanes[together++] = i;
        }
        if (together > 0) {
            texels.place(texels.user, p->block_texels[first + m], together,
                         (const float(*)[2])inside, placed);
        }
        for (uint32_t k = 0; k < together; k++) {
            points[lanes[k]] = placed[k];
        }
    }
}

static void place_in_block(const void *user, uint32_t receiver, uint32_t count,
                           const float (*square)[2], alpi_receiver_point *points)
{
    const alpi_patches *p = user;
    const bool back = receiver >= p->block_count;
    const uint32_t block = back ? receiver - p->block_count : receiver;
    for (uint32_t i = 0; i < count; i += PLACE_BATCH) {
        place_batch(p, block, count - i < PLACE_BATCH ? count - i : PLACE_BATCH, square + i,
                    points + i);
    }
    if (back) {
        turn_over(count, points);
    }
}

alpi_receivers alpi_patches_block_receivers(const alpi_patches *patches)
{
    return (alpi_receivers){.count = patches->block_count * (patches->two_sided ? 2u : 1u),
                            .extended = true,
                            .place = place_in_block,
                            .user = patches};
}

// --- making --------------------------------------------------------------------------------------

bool alpi_patches_are_two_sided(const alp_scene *scene)
{
    for (uint32_t i = 0; i < scene->material_count; i++) {
        if (scene->materials[i].double_sided) {
            return true;
        }
    }
    return false;
}

static uint32_t count_charts(const alpi_patches *p)
{
    uint32_t count = 0;
    for (uint32_t t = 0; t < alpi_atlas_face_count(p->atlas); t++) {
        const uint32_t chart = p->atlas->triangle_charts[t];
        count = chart != ALPI_NONE && chart >= count ? chart + 1 : count;
    }
    return count;
}

/// Makes an array shorter. @return ALP_OK; OUT_OF_MEMORY
static alp_result trim(alp_context *context, void **items, size_t count, size_t size)
{
    void *fewer = alpi_reallocate(context, *items, count, size);
    if (fewer == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    *items = fewer;
    return ALP_OK;
}

/// Room for as many blocks as texels, while nobody knows better.
static alp_result make_room(alpi_patches *p, uint32_t count)
{
    const uint32_t texels = p->texels->count;
    const size_t pixels = (size_t)p->lattice->page_count * p->lattice->width * p->lattice->height;
    ALPI_TRY_NEW(p->context, p->places, pixels);
    memset(p->places, 0xff, pixels * sizeof *p->places);
    ALPI_TRY_NEW(p->context, p->blocks, texels);
    ALPI_TRY_NEW(p->context, p->block_first, (size_t)count + 1);
    ALPI_TRY_NEW(p->context, p->block_texels, count);
    ALPI_TRY_NEW(p->context, p->block_ends, count);
    ALPI_TRY_NEW(p->context, p->block_areas, count);
    return ALP_OK;
}

/// What is made when it is known how many blocks there are.
static alp_result make_rest(alpi_patches *p)
{
    const size_t texels = p->texels->count, sides = p->two_sided ? 2 : 1;
    ALP_TRY(trim(p->context, (void **)&p->block_first, (size_t)p->block_count + 1,
                 sizeof *p->block_first));
    ALP_TRY(trim(p->context, (void **)&p->block_areas, p->block_count, sizeof *p->block_areas));
    ALPI_TRY_NEW(p->context, p->seen_backs, p->two_sided ? p->block_count : 0);
    ALPI_TRY_NEW(p->context, p->reflectances, texels);
    ALPI_TRY_NEW(p->context, p->emissions, texels);
    ALPI_TRY_NEW(p->context, p->cells, ALPI_CELL_FIRST + sides * texels);
    return ALP_OK;
}

static alp_result create(alpi_patches *p, const uint32_t *order, uint32_t count, uint32_t spacing)
{
    const uint32_t texels = p->texels->count, charts = count_charts(p);
    ALP_TRY(make_room(p, count));
    ALPI_TRY_NEW(p->context, p->chart_texels, charts);
    memset(p->blocks, 0xff, texels * sizeof *p->blocks);
    memset(p->chart_texels, 0xff, charts * sizeof *p->chart_texels);
    for (uint32_t i = 0; i < count; i++) {
        p->blocks[order[i]] = 0; // has light of its own; which block, comes next
    }
    ALP_TRY(make_blocks(p, spacing));
    ALP_TRY(make_rest(p));
    ALP_TRY(alpi_patch_places_create(p));
    const alpi_task_progress told = {.stage = "light"};
    return alpi_parallel_for(p->context, texels, 1024, find_materials, p, &told);
}

alp_result alpi_patches_create(const alpi_lattice *lattice, const alp_atlas *atlas,
                               const uint32_t *order, uint32_t count, const alpi_block_rule *rule,
                               alpi_patches *patches)
{
    *patches = (alpi_patches){.context = lattice->context,
                              .scene = atlas->scene,
                              .atlas = atlas,
                              .texels = lattice->texels,
                              .lattice = lattice,
                              .near = rule->near,
                              .two_sided = alpi_patches_are_two_sided(atlas->scene)};
    const alp_result result = create(patches, order, count, rule->spacing);
    patches->near = NULL; // borrowed for this call
    if (result != ALP_OK) {
        alpi_patches_destroy(patches);
    }
    return result;
}

void alpi_patches_settle(alpi_patches *patches, bool lit_again)
{
    alp_context *context = patches->context;
    alpi_release(context, patches->emissions);
    alpi_release(context, patches->block_first);
    alpi_release(context, patches->block_texels);
    alpi_release(context, patches->block_ends);
    alpi_release(context, patches->block_areas);
    patches->block_ends = patches->emissions = NULL;
    patches->block_first = patches->block_texels = NULL;
    patches->block_areas = NULL;
    if (!lit_again) {
        alpi_release(context, patches->reflectances);
        patches->reflectances = NULL;
    }
    if (!lit_again && !patches->two_sided) { // else they say whose back is seen
        alpi_release(context, patches->blocks);
        patches->blocks = NULL;
    }
}

void alpi_patches_destroy(alpi_patches *patches)
{
    alp_context *context = patches->context;
    if (context == NULL) {
        return;
    }
    alpi_release(context, patches->triangles);
    alpi_release(context, patches->places);
    alpi_release(context, patches->chart_texels);
    alpi_release(context, patches->reflectances);
    alpi_release(context, patches->emissions);
    alpi_release(context, patches->blocks);
    alpi_release(context, patches->block_first);
    alpi_release(context, patches->block_texels);
    alpi_release(context, patches->block_ends);
    alpi_release(context, patches->block_areas);
    alpi_release(context, patches->seen_backs);
    alpi_release(context, patches->cells);
    *patches = (alpi_patches){0};
}
