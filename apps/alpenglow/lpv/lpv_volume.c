// SPDX-License-Identifier: MIT
#include "lpv/lpv_volume.h"

#include "output.h"

#include <alpenglow/shared_constants.h>

#include <math.h>
#include <stdlib.h>

/// Cells that a file may hold. Each takes about 25 bytes.
static const uint64_t CELL_LIMIT = 2097152; // 128^3

void lpv_cell_fluence(const alp_lpv_grid *g, const uint32_t cell[3], float fluence[3])
{
    enum { TERMS = 4, ROWS = 3 * TERMS };
    const size_t n = g->size[0], column = ((size_t)cell[2] * g->size[1] + cell[1]) * ROWS;
    const double scale = 4.0 * M_PI / (ALP_LPV_GAIN * g->cell * g->cell);
    for (size_t k = 0; k < 3; k++) {
        const float p0 = g->intensities[(column + k * TERMS) * n + cell[0]];
        fluence[k] = (float)(scale * fmax((double)p0, 0.0));
    }
}

int lpv_volume_check(const command_line *a)
{
    const char *path = a->values[OPTION_VOLUME].text, *json = a->values[OPTION_JSON].text;
    if (path == NULL) {
        return EXIT_DONE;
    }
    if (!path_ends(path, ".json")) {
        return usage_error(COMMAND_LPV, "--volume %s: the name must end in .json", path);
    }
    const bool is_json = json != NULL && output_is_same(path, json);
    if (is_json || output_is_same(path, a->operands[0])) {
        return usage_error(COMMAND_LPV, "--volume %s: %s has the same name; give another", path,
                           is_json ? "--json" : "SCENE");
    }
    const uint64_t n = (uint64_t)a->values[OPTION_GRID].whole;
    const uint64_t cells = n * n * n * (uint64_t)a->values[OPTION_CASCADES].whole;
    if (cells > CELL_LIMIT) {
        return usage_error(COMMAND_LPV,
                           "--volume: holds up to %llu cells, and these grids have %llu; give a "
                           "smaller --grid or fewer --cascades",
                           (unsigned long long)CELL_LIMIT, (unsigned long long)cells);
    }
    return output_check(path, a->values[OPTION_FORCE].given);
}

static void write_cells(FILE *stream, const alp_lpv_grid *g)
{
    uint32_t cell[3];
    for (cell[2] = 0; cell[2] < g->size[2]; cell[2]++) {
        for (cell[1] = 0; cell[1] < g->size[1]; cell[1]++) {
            fputs(cell[1] + cell[2] > 0 ? ",\n" : "\n", stream);
            for (cell[0] = 0; cell[0] < g->size[0]; cell[0]++) {
                float f[3];
                lpv_cell_fluence(g, cell, f);
                fprintf(stream, "%s%.5g,%.5g,%.5g", cell[0] > 0 ? "," : "", (double)f[0],
                        (double)f[1], (double)f[2]);
            }
        }
    }
}

/// Writes lengths with 15 digits: the corner may be far from the origin.
/// @param origin of the scene in the world of its file
static void write_grid(FILE *stream, const alp_lpv_grid *g, const double origin[3])
{
    fprintf(stream, "{\"cell\":%.15g,\"corner\":[%.15g,%.15g,%.15g],", g->cell,
            origin[0] + g->corner[0], origin[1] + g->corner[1], origin[2] + g->corner[2]);
    fprintf(stream, "\"size\":[%u,%u,%u],\"fluence\":[", g->size[0], g->size[1], g->size[2]);
    write_cells(stream, g);
    fputs("]}", stream);
}

static void write_document(FILE *stream, const lpv_run *run)
{
    const alp_scene_info info = alp_scene_get_info(run->session->scene);
    fprintf(stream,
            "{\"format\":\"alpenglow-volume\",\n\"version\":1,\n\"generator\":\"Alpenglow %s\",\n"
            "\"quantity\":\"fluence\",\n\"units\":\"W/m2\",\n\"scene\":{\"hash\":\"%016llx\"},\n"
            "\"grids\":[",
            alp_version(), (unsigned long long)info.hash);
    for (uint32_t c = 0; c < run->options.cascades; c++) {
        alp_lpv_grid grid;
        alp_lpv_get_grid(run->lpv, c, &grid);
        fputs(c > 0 ? ",\n" : "\n", stream);
        write_grid(stream, &grid, info.origin);
    }
    fputs("]}\n", stream);
}

int lpv_volume_write(const lpv_run *run, const command_line *a)
{
    const char *path = a->values[OPTION_VOLUME].text;
    if (path == NULL) {
        return EXIT_DONE;
    }
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (stream == NULL) {
        return failure("out of memory");
    }
    write_document(stream, run);
    const bool good = ferror(stream) == 0;
    const bool closed = fclose(stream) == 0;
    const int code = good && closed ? output_write_text(text, path, a->values[OPTION_FORCE].given)
                                    : failure("out of memory");
    free(text);
    return code;
}
