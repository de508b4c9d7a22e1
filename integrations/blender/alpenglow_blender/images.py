# SPDX-License-Identifier: MIT
"""Materials and textures of glTF from surfaces and images of Blender."""

import struct
import zlib

import bpy
import numpy

from .surface import Opacity

DARKEST = 1 / (2 * 255 * 12.92)  # of white: what 8 bits of sRGB round to black
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


def rows_of(image):
    """Pixels [height][width][4] as Blender holds them, the first row on top."""
    width, height = image.size
    pixels = numpy.empty(width * height * image.channels, numpy.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(height, width, -1)[::-1]  # Blender's first row is at the bottom
    full = numpy.ones((height, width, 4), numpy.float32)
    colours = min(image.channels, 3)
    full[..., :3] = pixels[..., :colours] if colours == 3 else pixels[..., :1]
    if image.channels == 4:
        full[..., 3] = pixels[..., 3]
    return numpy.nan_to_num(full)


def peak_of(image):
    """The largest channel of an image of floats; at least 1."""
    return max(1.0, float(rows_of(image)[..., :3].max())) if image.is_float else 1.0


def encoded(image, alpha, peak):
    """(bytes, MIME type) of an image: its own file where that is PNG or JPEG, else a PNG.

    image: None is white. alpha: the image whose alpha it has, or None: opaque. Colours are divided
    by `peak`."""
    data = b""
    has_same_alpha = alpha == image or (alpha is None and image.depth in (24, 48))
    if has_same_alpha and not image.is_dirty and image.source == "FILE" and \
            image.colorspace_settings.name == "sRGB" and peak == 1:
        data = stored(image)
    kind = SIGNATURES.get(data[:4])
    if kind is not None:
        return data, kind
    full = numpy.ones_like(rows_of(alpha)) if image is None else rows_of(image)
    if image is not None and (image.is_float or image.colorspace_settings.name != "sRGB"):
        full[..., :3] = srgb(full[..., :3] / peak)
    full[..., 3] = 1 if alpha is None else rows_of(alpha)[..., 3]
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


def is_readable(exporter, image):
    if image.source in ("FILE", "GENERATED") and 0 not in image.size:
        return True
    exporter.notes.append(f"image {image.name} has no pixels: it counts as white")
    return False


def texture(exporter, image, alpha, peak=1.0):
    """The index of the texture of an image; the parameters are those of encoded()."""
    key = tuple(i and i.name_full for i in (image, alpha)) + (peak,)
    if key not in exporter.textures:
        writer = exporter.writer
        data, kind = encoded(image, alpha, peak)
        source = writer.add("images", {"name": (image or alpha).name, "mimeType": kind,
                                       "bufferView": writer.add_view(data)})
        if "samplers" not in writer.document:
            writer.add("samplers", {"wrapS": 10497, "wrapT": 10497})
        exporter.textures[key] = writer.add("textures", {"source": source, "sampler": 0})
    return exporter.textures[key]


def material_element(exporter, material, surface):
    """(glTF material, UV maps by coordinate set) of a Surface. `material` gives name, sides and
    kind of opacity."""
    name, uv_maps = material.name if material else "no material", []
    pbr = {"metallicFactor": 0.0, "roughnessFactor": 1.0}
    element = {"name": name, "pbrMetallicRoughness": pbr,
               "doubleSided": not material.use_backface_culling if material else True}
    image, alpha, opacity = textures_of(exporter, name, surface)
    pbr["baseColorFactor"] = [min(max(c, 0.0), 1.0) for c in surface.base.factor] + [opacity.factor]
    if image is not None or alpha is not None:
        uv_map = surface.base.uv_map if image is not None else opacity.uv_map
        is_opaque = opacity.factor == 1 and opacity.cutoff is None
        pbr["baseColorTexture"] = {"index": texture(exporter, image,
                                                    alpha or (image if is_opaque else None)),
                                   "texCoord": set_of(uv_maps, uv_map)}
    add_emission(exporter, element, surface.emission, uv_maps)
    if opacity.cutoff is not None:
        element.update(alphaMode="MASK", alphaCutoff=max(opacity.cutoff, 0.0))
    elif alpha is not None and getattr(material, "blend_method", "") == "CLIP":
        element.update(alphaMode="MASK", alphaCutoff=material.alpha_threshold)
    elif alpha is not None or opacity.factor < 1:
        element["alphaMode"] = "BLEND"
    if surface.transmission > 0:
        exporter.writer.use("KHR_materials_transmission")
        transmission = {"transmissionFactor": min(surface.transmission, 1.0)}
        element.setdefault("extensions", {})["KHR_materials_transmission"] = transmission
    return element, uv_maps


def textures_of(exporter, name, surface):
    """(image of the colour, image of the alpha, Opacity) that one texture of glTF can hold."""
    image, opacity = surface.base.image, surface.opacity
    alpha = opacity.image
    if image is not None and not is_readable(exporter, image):
        image = None
    if alpha is not None and (alpha.alpha_mode == "NONE" or not is_readable(exporter, alpha)):
        alpha = None
    if alpha is None or image is None or alpha == image or \
            (tuple(alpha.size) == tuple(image.size) and opacity.uv_map == surface.base.uv_map):
        return image, alpha, opacity
    exporter.notes.append(f"{name}: the opacity by image {alpha.name} is not read, since image "
                          f"{image.name} of the colour has another size or UV map; the bake takes "
                          "the surface as opaque")
    return image, None, Opacity()


def set_of(uv_maps, name):
    """The coordinate set of a UV map. It is added to `uv_maps` if it is new."""
    if name not in uv_maps:
        uv_maps.append(name)
    return uv_maps.index(name)


def add_emission(exporter, element, emission, uv_maps):
    """Emission above 1 needs the factor of KHR_materials_emissive_strength."""
    image, peak = emission.image, 1.0
    if max(emission.factor) <= 0:
        return
    if image is not None and is_readable(exporter, image):
        peak = peak_of(image)
        element["emissiveTexture"] = {"index": texture(exporter, image, image, peak),
                                      "texCoord": set_of(uv_maps, emission.uv_map)}
    if peak > 1:
        exporter.notes.append(f"image {image.name} emits up to {peak:.4g}: the bake reads it with "
                              f"8 bits, and as black below {peak * DARKEST:.2g}")
    factor = [max(0.0, c) * peak for c in emission.factor]
    strength = max(1.0, *factor)
    element["emissiveFactor"] = [c / strength for c in factor]
    if strength > 1:
        exporter.writer.use("KHR_materials_emissive_strength")
        element.setdefault("extensions", {})["KHR_materials_emissive_strength"] = {
            "emissiveStrength": strength}
