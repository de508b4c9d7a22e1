// SPDX-License-Identifier: MIT
// Draco's decoder for C: no exception leaves this file, and no size is believed before the head of
// the stream was held against what the asset says.
//
// Rossignac. Edgebreaker: Connectivity Compression for Triangle Meshes. IEEE TVCG 5(1), 1999: what
// Draco's bitstream 2.2 is built on.
#include "formats/gltf/draco_mesh.h"

#include <draco/compression/decode.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>

#include <cstdio>
#include <exception>
#include <memory>
#include <new>

struct alpi_draco_mesh {
    std::unique_ptr<draco::Mesh> mesh;
};

namespace {

enum { MESH = 1, SEQUENTIAL = 0, EDGEBREAKER = 1, HAS_METADATA = 0x8000 };

/// Where all symbols are alike its entropy coder takes -log2(4095/4096) = 1/2840 bit for each.
enum { MOST_PER_BYTE = 8 * 4096 };

/// Why a stream is refused, NULL = it is not. Bitstream 2.2, which is glTF's: "DRACO", version,
/// kind, method, flags; metadata; counts.
const char *fault_of_head(const alpi_draco_source &source)
{
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char *>(source.bytes), source.size);
    char magic[5];
    uint8_t major = 0, minor = 0, kind = 0, method = 0, traversal = 0;
    uint16_t flags = 0;
    if (!buffer.Decode(magic, sizeof magic) || std::char_traits<char>::compare(magic, "DRACO", 5)) {
        return "they do not begin with DRACO";
    }
    if (!buffer.Decode(&major) || !buffer.Decode(&minor) || major != 2 || minor != 2) {
        return "their version is not 2.2";
    }
    if (!buffer.Decode(&kind) || !buffer.Decode(&method) || !buffer.Decode(&flags) ||
        kind != MESH || (method != SEQUENTIAL && method != EDGEBREAKER)) {
        return "they are no mesh";
    }
    buffer.set_bitstream_version(static_cast<uint16_t>(major << 8 | minor));
    draco::GeometryMetadata metadata;
    if ((flags & HAS_METADATA) != 0 &&
        !draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata)) {
        return "their metadata are damaged";
    }
    uint32_t faces = 0, vertices = 0;
    bool good =
        method == SEQUENTIAL
            ? draco::DecodeVarint(&faces, &buffer) && draco::DecodeVarint(&vertices, &buffer)
            : buffer.Decode(&traversal) && draco::DecodeVarint(&vertices, &buffer) &&
                  draco::DecodeVarint(&faces, &buffer);
    if (!good) {
        return "they end too early";
    }
    bool fits = source.face_count != 0 ? faces == source.face_count : faces <= source.face_limit;
    return !fits                            ? "they hold another number of triangles"
           : vertices > source.vertex_count ? "they hold more vertices"
           : faces / MOST_PER_BYTE > source.size || vertices / MOST_PER_BYTE > source.size
               ? "they are too few for so many triangles"
               : nullptr;
}

alpi_draco_result refuse(const char *reason, char *fault, size_t fault_size)
{
    std::snprintf(fault, fault_size, "%s", reason);
    return ALPI_DRACO_DAMAGED;
}

alpi_draco_result decode(const alpi_draco_source &source, alpi_draco_mesh **mesh, char *fault,
                         size_t fault_size)
{
    const char *reason = fault_of_head(source);
    if (reason != nullptr) {
        return refuse(reason, fault, fault_size);
    }
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char *>(source.bytes), source.size);
    auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) {
        return refuse(decoded.status().error_msg(), fault, fault_size);
    }
    auto made = std::make_unique<alpi_draco_mesh>();
    made->mesh = std::move(decoded).value();
    if (made->mesh->num_points() != source.vertex_count) {
        return refuse("they hold another number of vertices", fault, fault_size);
    }
    *mesh = made.release();
    return ALPI_DRACO_OK;
}

template <typename T>
bool copy_values(const draco::PointAttribute &attribute, uint32_t count, uint32_t components,
                 void *values)
{
    T *place = static_cast<T *>(values);
    for (uint32_t i = 0; i < count; i++, place += components) {
        const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(i));
        if (value.value() >= attribute.size() ||
            !attribute.ConvertValue<T>(value, static_cast<int8_t>(components), place)) {
            return false;
        }
    }
    return true;
}

} // namespace

alpi_draco_result alpi_draco_open(const alpi_draco_source *source, alpi_draco_mesh **mesh,
                                  char *fault, size_t fault_size)
{
    *mesh = nullptr;
    try {
        return decode(*source, mesh, fault, fault_size);
    } catch (const std::bad_alloc &) {
        return ALPI_DRACO_OUT_OF_MEMORY;
    } catch (const std::exception &problem) {
        return refuse(problem.what(), fault, fault_size);
    }
}

void alpi_draco_close(alpi_draco_mesh *mesh)
{
    delete mesh;
}

uint32_t alpi_draco_vertex_count(const alpi_draco_mesh *mesh)
{
    return mesh->mesh->num_points();
}

uint32_t alpi_draco_face_count(const alpi_draco_mesh *mesh)
{
    return mesh->mesh->num_faces();
}

void alpi_draco_faces(const alpi_draco_mesh *mesh, uint32_t (*corners)[3])
{
    for (uint32_t i = 0; i < mesh->mesh->num_faces(); i++) {
        const draco::Mesh::Face &face = mesh->mesh->face(draco::FaceIndex(i));
        for (int k = 0; k < 3; k++) {
            corners[i][k] = face[static_cast<size_t>(k)].value();
        }
    }
}

bool alpi_draco_attribute(const alpi_draco_mesh *mesh, uint32_t id, uint32_t components,
                          uint32_t component_type, void *values)
{
    const draco::PointAttribute *attribute = mesh->mesh->GetAttributeByUniqueId(id);
    const uint32_t count = mesh->mesh->num_points();
    if (attribute == nullptr || static_cast<uint32_t>(attribute->num_components()) != components ||
        attribute->data_type() == draco::DT_BOOL) { // glTF has none, and any byte would be read so
        return false;
    }
    switch (component_type) {
    case 5120:
        return copy_values<int8_t>(*attribute, count, components, values);
    case 5121:
        return copy_values<uint8_t>(*attribute, count, components, values);
    case 5122:
        return copy_values<int16_t>(*attribute, count, components, values);
    case 5123:
        return copy_values<uint16_t>(*attribute, count, components, values);
    case 5125:
        return copy_values<uint32_t>(*attribute, count, components, values);
    case 5126:
        return copy_values<float>(*attribute, count, components, values);
    default:
        return false;
    }
}
