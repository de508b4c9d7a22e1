# SPDX-License-Identifier: MIT
"""The world of Blender as the sky of the command: radiance, linear.

It reads the colour and the strength of a Background node, and before it an Environment Texture with
an .exr or .hdr image. The middle of the image looks along +X in Blender. In the command it looks
along -Z, which is Blender's +Y."""

import os

from . import images, nodes

BLACK = "the sky is black"  # the end of a note
ENDINGS = {b"\x76\x2f\x31\x01": ".exr", b"#?RA": ".hdr", b"#?RG": ".hdr"}


def sky_options(world, folder, notes):
    """Options of the command; an image is written into `folder`. notes: lines for the user."""
    if world is None:
        return []
    if not world.use_nodes:
        return even_sky(world.color)
    output = nodes.output_of(world.node_tree)
    links = output.inputs["Surface"].links if output else ()
    if not links:
        return []
    background = links[0].from_node
    if background.type != "BACKGROUND":
        notes.append(f"world {world.name}: {background.name} is not read; {BLACK}")
        return []
    colour, strength = background.inputs["Color"], background.inputs["Strength"]
    if strength.links:
        notes.append(f"world {world.name}: the strength of {background.name} is a link, which is "
                     "not read; the value behind it counts")
    if colour.links:
        return picture_sky(world, colour.links[0].from_node, strength.default_value, folder, notes)
    return even_sky([c * strength.default_value for c in colour.default_value[:3]])


def even_sky(colour):
    colour = [max(0.0, c) for c in colour]
    return ["--sky", ",".join(f"{c:.9g}" for c in colour)] if max(colour) > 0 else []


def picture_sky(world, node, strength, folder, notes):
    image = node.image if node.type == "TEX_ENVIRONMENT" else None
    if image is None or node.projection != "EQUIRECTANGULAR":
        is_empty = node.type == "TEX_ENVIRONMENT" and image is None
        fault = "has no image" if is_empty else "is not read"
        notes.append(f"world {world.name}: {node.name} {fault}; {BLACK}")
        return []
    if node.inputs["Vector"].links:
        notes.append(f"world {world.name}: nodes before {node.name} are not read; the image is not "
                     "turned")
    data = images.stored(image)
    ending = ENDINGS.get(data[:4])
    if ending is None:
        notes.append(f"world {world.name}: {image.name} is no .exr or .hdr file; {BLACK}")
        return []
    if strength <= 0:
        return []
    path = os.path.join(folder, "sky" + ending)
    with open(path, "wb") as file:
        file.write(data)
    return ["--sky", path, "--sky-turn", "-90", "--sky-strength", f"{strength:.9g}"]
