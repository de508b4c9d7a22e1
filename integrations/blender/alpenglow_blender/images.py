# SPDX-License-Identifier: MIT
"""Materials and textures of glTF from surfaces and images of Blender."""

import struct
import zlib

import bpy
import numpy

SIGNATURES = {b"\x89PNG": "image/png", b"\xff\xd8\xff\xe0": "image/jpeg",
              b"\xff\xd8\xff\xe1": "image/jpeg", b"\xff\xd8\xff\xdb": "image/jpeg",
              b"\xff\xd8\xff\xee": "image/jpeg"}


def png(pixels):
    """The bytes of an 8-bit RGBA PNG. pixels: uint8 [height][width][4], the first row on top.
    W3C, Portable Network Graphics (PNG) Specification, second edition."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + \
            struct.pack(">I", zlib.crc32(data, zlib.crc32(kind)))

    height, width = pixels.shape[:2]
    rows = numpy.zeros((height, 1 + 4 * width), numpy.uint8)
    rows[:, 1:] = pixels.reshape(height, -1)
    head = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + \
        chunk(b"IDAT", zlib.compress(rows.tobytes(), 6)) + chunk(b"IEND", b"")


def srgb(linear):
    """IEC 61966-2-1, clipped to [0, 1]."""
    linear = numpy.clip(linear, 0, 1)
    return numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def encoded(image):
    """(bytes, MIME type) of an image: its own file where that is PNG or JPEG, else a PNG."""
    data = b""
    if not image.is_dirty and image.source == "FILE" and image.colorspace_settings.name == "sRGB":
        data = stored(image)
    kind = SIGNATURES.get(data[:4])
    if kind is not None:
        return data, kind
    width, height = image.size
    pixels = numpy.empty(width * height * image.channels, numpy.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(height, width, -1)[::-1]  # Blender's first row is at the bottom
    full = numpy.ones((height, width, 4), numpy.float32)
    colours = min(image.channels, 3)
    full[..., :3] = pixels[..., :colours] if colours == 3 else pixels[..., :1]
    if image.is_float or image.colorspace_settings.name != "sRGB":
        full[..., :3] = srgb(full[..., :3])
    if image.channels == 4:
        full[..., 3] = pixels[..., 3]
    return png(numpy.uint8(numpy.clip(full, 0, 1) * 255 + 0.5)), "image/png"


def stored(image):
    """The bytes of the image's file, packed or on the disk; none if it has no file."""
    if image.packed_file is not None:
        return bytes(image.packed_file.data)
    try:
        with open(bpy.path.abspath(image.filepath, library=image.library), "rb") as file:
            return file.read()
    except OSError:
        return b""


def texture(exporter, image):
    """The index of the texture of an image, or None with a note."""
    key = image.name_full
    if key in exporter.textures:
        return exporter.textures[key]
    found = None
    if image.source not in ("FILE", "GENERATED") or 0 in image.size:
        exporter.notes.append(f"image {image.name} has no pixels: it counts as white")
    else:
        writer = exporter.writer
        data, kind = encoded(image)
        source = writer.add("images", {"name": image.name, "mimeType": kind,
                                       "bufferView": writer.add_view(data)})
        if "samplers" not in writer.document:
            writer.add("samplers", {"wrapS": 10497, "wrapT": 10497})
        found = writer.add("textures", {"source": source, "sampler": 0})
    exporter.textures[key] = found
    return found


def material_element(exporter, material, surface):
    """The glTF material of a Surface. `material` gives name, sides and kind of opacity."""
    base = [min(max(c, 0.0), 1.0) for c in surface.base.factor] + [surface.alpha]
    pbr = {"baseColorFactor": base, "metallicFactor": 0.0, "roughnessFactor": 1.0}
    element = {"name": material.name if material else "no material", "pbrMetallicRoughness": pbr,
               "doubleSided": not material.use_backface_culling if material else True}
    add_texture(exporter, pbr, "baseColorTexture", surface.base)
    add_emission(exporter, element, surface.emission)
    has_texture_alpha = surface.alpha_source is not None and "baseColorTexture" in pbr
    if has_texture_alpha and getattr(material, "blend_method", "") == "CLIP":
        element.update(alphaMode="MASK", alphaCutoff=material.alpha_threshold)
    elif has_texture_alpha or surface.alpha < 1:
        element["alphaMode"] = "BLEND"
    if surface.transmission > 0:
        exporter.writer.use("KHR_materials_transmission")
        transmission = {"transmissionFactor": min(surface.transmission, 1.0)}
        element.setdefault("extensions", {})["KHR_materials_transmission"] = transmission
    return element


def add_texture(exporter, place, name, colour):
    if colour.image is not None:
        index = texture(exporter, colour.image)
        if index is not None:
            place[name] = {"index": index}


def add_emission(exporter, element, emission):
    """Emission above 1 needs the factor of KHR_materials_emissive_strength."""
    strongest = max(emission.factor)
    if strongest <= 0:
        return
    strength = max(strongest, 1.0)
    element["emissiveFactor"] = [max(0.0, c) / strength for c in emission.factor]
    add_texture(exporter, element, "emissiveTexture", emission)
    if strength > 1:
        exporter.writer.use("KHR_materials_emissive_strength")
        element.setdefault("extensions", {})["KHR_materials_emissive_strength"] = {
            "emissiveStrength": strength}
