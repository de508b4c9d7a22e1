// SPDX-License-Identifier: MIT
// Draco's decoder as C sees it. draco_mesh.cpp is the only file of C++; builds without libdraco
// leave it out.
#ifndef ALPI_FORMATS_DRACO_MESH_H
#define ALPI_FORMATS_DRACO_MESH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct alpi_draco_mesh alpi_draco_mesh;

typedef enum alpi_draco_result {
    ALPI_DRACO_OK = 0,
    ALPI_DRACO_DAMAGED,
    ALPI_DRACO_OUT_OF_MEMORY
} alpi_draco_result;

/// Compressed bytes, and what the asset says that they hold: checked against the head of the stream
/// before anything of that size is made.
typedef struct alpi_draco_source {
    const uint8_t *bytes;
    size_t size;
    uint32_t vertex_count;
    uint32_t face_count; // 0 = not known, then at most face_limit
    uint32_t face_limit;
} alpi_draco_source;

/// Decodes; on DAMAGED `fault` [fault_size] says why.
alpi_draco_result alpi_draco_open(const alpi_draco_source *source, alpi_draco_mesh **mesh,
                                  char *fault, size_t fault_size);
void alpi_draco_close(alpi_draco_mesh *mesh); // NULL does nothing

uint32_t alpi_draco_vertex_count(const alpi_draco_mesh *mesh);
uint32_t alpi_draco_face_count(const alpi_draco_mesh *mesh);
/// @param corners [face_count][3]
void alpi_draco_faces(const alpi_draco_mesh *mesh, uint32_t (*corners)[3]);
/// Values of the attribute with the number `id` as a glTF component type (5120 … 5126).
/// @param values [vertex_count][components]
/// @return false: no such attribute, or not with so many components
bool alpi_draco_attribute(const alpi_draco_mesh *mesh, uint32_t id, uint32_t components,
                          uint32_t component_type, void *values);

#ifdef __cplusplus
}
#endif

#endif
