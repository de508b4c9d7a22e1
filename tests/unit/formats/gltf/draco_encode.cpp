// SPDX-License-Identifier: MIT
#include "draco_encode.h"

#include <draco/compression/encode.h>

#include <cstring>
#include <memory>

static void add_attribute(draco::Mesh &mesh, draco::GeometryAttribute::Type type,
                          const float *values, int8_t components, uint32_t count)
{
    draco::GeometryAttribute shape;
    const int64_t size = static_cast<int64_t>(sizeof(float)) * components;
    shape.Init(type, nullptr, static_cast<uint8_t>(components), draco::DT_FLOAT32, false, size, 0);
    draco::PointAttribute *attribute = mesh.attribute(mesh.AddAttribute(shape, true, count));
    for (uint32_t i = 0; i < count; i++) {
        attribute->SetAttributeValue(draco::AttributeValueIndex(i),
                                     values + static_cast<size_t>(components) * i);
    }
}

size_t draco_encode(const draco_input *input, uint8_t *bytes, size_t capacity,
                    uint32_t *point_count)
{
    draco::Mesh mesh;
    mesh.set_num_points(input->vertex_count);
    mesh.SetNumFaces(input->index_count / 3);
    for (uint32_t i = 0; i < input->index_count / 3; i++) {
        draco::Mesh::Face face;
        for (uint32_t k = 0; k < 3; k++) {
            face[k] = draco::PointIndex(input->indices[3 * i + k]);
        }
        mesh.SetFace(draco::FaceIndex(i), face);
    }
    add_attribute(mesh, draco::GeometryAttribute::POSITION, input->positions[0], 3,
                  input->vertex_count);
    add_attribute(mesh, draco::GeometryAttribute::NORMAL, input->normals[0], 3,
                  input->vertex_count);
    add_attribute(mesh, draco::GeometryAttribute::TEX_COORD, input->uvs[0], 2, input->vertex_count);
    if (input->has_metadata) {
        auto metadata = std::make_unique<draco::GeometryMetadata>();
        metadata->AddEntryString("name", "wave");
        mesh.AddMetadata(std::move(metadata));
    }
    draco::Encoder encoder;
    encoder.SetEncodingMethod(input->is_sequential ? draco::MESH_SEQUENTIAL_ENCODING
                                                   : draco::MESH_EDGEBREAKER_ENCODING);
    if (input->position_bits > 0) {
        encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, input->position_bits);
        encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, 10);
        encoder.SetAttributeQuantization(draco::GeometryAttribute::TEX_COORD, 14);
    }
    encoder.SetTrackEncodedProperties(true);
    draco::EncoderBuffer buffer;
    if (!encoder.EncodeMeshToBuffer(mesh, &buffer).ok() || buffer.size() > capacity) {
        return 0;
    }
    std::memcpy(bytes, buffer.data(), buffer.size());
    *point_count = static_cast<uint32_t>(encoder.num_encoded_points());
    return buffer.size();
}
