# SPDX-License-Identifier: MIT
"""Reads the numbers that light needs from the nodes of a material: diffuse colour, emission,
opacity and transmission. Roughness, metalness and relief do not matter to diffuse light."""

from dataclasses import dataclass, field
from typing import Any, Tuple

from . import nodes

GREY = (0.5, 0.5, 0.5)
BARE = (0.8, 0.8, 0.8)  # Blender shows objects without a material in this colour
COLOURED = {"BSDF_DIFFUSE", "BSDF_GLOSSY", "BSDF_ANISOTROPIC", "BSDF_VELVET", "BSDF_SHEEN",
            "BSDF_TOON", "BSDF_TRANSLUCENT", "SUBSURFACE_SCATTERING", "BSDF_METALLIC"}
CLEAR = {"BSDF_GLASS", "BSDF_REFRACTION"}


@dataclass
class Colour:
    """factor x image, linear. `source` is the output socket that has the whole colour; without one
    the colour is `factor`. `weight` is the factor on `source`."""
    factor: Tuple[float, float, float] = (0.0, 0.0, 0.0)
    image: Any = None
    uv_map: str = ""
    source: Any = None
    weight: Tuple[float, float, float] = (1.0, 1.0, 1.0)

    def scaled(self, by):
        """This colour times `by`, three numbers."""
        def product(a):
            return tuple(x * y for x, y in zip(a, by))
        return Colour(product(self.factor), self.image, self.uv_map, self.source,
                      product(self.weight))

    def is_black(self):
        return max(self.factor) <= 0

    def is_plain(self):
        return self.image is None and self.source is None


@dataclass
class Opacity:
    """factor x the alpha of an image, in [0, 1]. `source` is the output socket that has the whole
    number, also where its nodes are not read. cutoff: None, or opaque from there on, else open."""
    factor: float = 1.0
    image: Any = None
    uv_map: str = ""
    cutoff: Any = None
    source: Any = None


@dataclass
class Surface:
    base: Colour = field(default_factory=Colour)
    emission: Colour = field(default_factory=Colour)  # radiance, strength included
    opacity: Opacity = field(default_factory=Opacity)
    transmission: float = 0.0
    tinted: list = field(default_factory=list)  # colour inputs of the shaders, for occlusion

    @property
    def alpha(self):
        return self.opacity.factor

    @property
    def alpha_source(self):
        return self.opacity.source

    def is_pane(self):
        return self.transmission > 0


def read(material):
    """(Surface, notes) of a material, or of None. Notes are lines for the user."""
    if material is None:
        return Surface(base=Colour(BARE)), []
    if not material.use_nodes or material.node_tree is None:
        return Surface(base=Colour(tuple(material.diffuse_color[:3]))), []
    output = nodes.output_of(material.node_tree)
    if output is None:
        return Surface(), [f"{material.name} has no output node; it counts as black"]
    notes = []
    surface = shader(output.inputs["Surface"], notes)
    return surface, [f"{material.name}: {note}" for note in dict.fromkeys(notes)]


def origin(socket):
    """The output socket that feeds an input, behind reroutes and muted links; None without one."""
    for _ in range(1000):
        if not socket.links or socket.links[0].is_muted:
            return None
        source = socket.links[0].from_socket
        if source.node.type != "REROUTE":
            return source
        socket = source.node.inputs[0]
    return None


def number(socket, notes):
    if origin(socket) is not None:
        notes.append(f"{socket.name} of {socket.node.name} is a link, which is not read; the value "
                     "behind it counts")
    return float(socket.default_value)


def uv_of(node):
    """The UV map that an image node reads; "" is the active one."""
    source = origin(node.inputs["Vector"])
    return source.node.uv_map if source is not None and source.node.type == "UVMAP" else ""


def colour(socket, notes):
    source = origin(socket)
    if source is None:
        return Colour(tuple(socket.default_value[:3]))
    found = colour_of_node(source.node, notes)
    return Colour(found.factor, found.image, found.uv_map, source)


def colour_of_node(node, notes):
    if node.type == "TEX_IMAGE" and node.image is not None:
        source = origin(node.inputs["Vector"])
        if source is not None and source.node.type not in ("UVMAP", "TEX_COORD"):
            notes.append(f"{source.node.name} before {node.name} is not read; the bake takes the "
                         "UV map as it is")
        return Colour((1.0, 1.0, 1.0), node.image, uv_of(node))
    if node.type == "RGB":
        return Colour(tuple(node.outputs[0].default_value[:3]))
    if node.type in ("VERTEX_COLOR", "ATTRIBUTE"):
        notes.append(f"{node.name}: colours of vertices are not read; they count as white")
        return Colour((1.0, 1.0, 1.0))
    if nodes.is_group(node, nodes.OCCLUSION):
        return colour(node.inputs["Color"], notes)
    if node.type in ("MIX_RGB", "MIX"):
        mixed = mixed_colour(node, notes)
        if mixed is not None:
            return mixed
    notes.append(f"{node.name} ({node.type}) is not read; its colour counts as grey 0.5")
    return Colour(GREY)


def mixed_colour(node, notes):
    """A product, or a mean of two constants; None for any other mix."""
    used = [s for s in node.inputs if s.enabled]
    if len(used) != 3 or getattr(node, "data_type", "RGBA") != "RGBA":
        return None
    amount = number(used[0], notes)
    a, b = colour(used[1], notes), colour(used[2], notes)
    if node.blend_type == "MULTIPLY" and (b.image is None or (a.image is None and amount == 1)):
        if b.image is not None:
            a, b = b, a
        return a.scaled(tuple(1 - amount + amount * x for x in b.factor))
    if node.blend_type == "MIX" and (amount == 0 or amount == 1):
        return b if amount == 1 else a
    if node.blend_type == "MIX" and a.image is None and b.image is None:
        return Colour(tuple((1 - amount) * x + amount * y for x, y in zip(a.factor, b.factor)))
    return None


def shader(socket, notes):
    """The Surface of what feeds a shader input."""
    source = origin(socket)
    if source is None:
        return Surface()
    node = source.node
    if nodes.is_group(node, nodes.LIGHT):
        return shader(node.inputs["Original"], notes)
    if node.type == "BSDF_PRINCIPLED":
        return principled(node, notes)
    if node.type == "EMISSION":
        strength = number(node.inputs["Strength"], notes)
        return Surface(emission=colour(node.inputs["Color"], notes).scaled((strength,) * 3))
    if node.type in COLOURED | CLEAR:
        socket = node.inputs["Base Color" if "Base Color" in node.inputs else "Color"]
        return Surface(base=colour(socket, notes), transmission=float(node.type in CLEAR),
                       tinted=[socket])
    if node.type == "BSDF_TRANSPARENT":
        return Surface(opacity=Opacity(0.0))
    if node.type == "MIX_SHADER":
        return mixed_shader(node, notes)
    if node.type == "ADD_SHADER":
        return added(shader(node.inputs[0], notes), shader(node.inputs[1], notes), notes)
    notes.append(f"{node.name} ({node.type}) is not read; the surface counts as grey 0.5")
    return Surface(base=Colour(GREY))


def first_input(node, *names):
    """The input by the name that this Blender has for it."""
    return next(node.inputs[name] for name in names if name in node.inputs)


def principled(node, notes):
    base = node.inputs["Base Color"]
    strength = number(node.inputs["Emission Strength"], notes)
    emission = colour(first_input(node, "Emission Color", "Emission"), notes)
    return Surface(colour(base, notes), emission.scaled((strength,) * 3),
                   opacity(node.inputs["Alpha"], notes),
                   number(first_input(node, "Transmission Weight", "Transmission"), notes), [base])


def opacity(socket, notes):
    """The Opacity that a number input gets."""
    source = origin(socket)
    if source is None:
        return Opacity(float(socket.default_value))
    found = opacity_of(source)
    if found is None:
        notes.append(f"{source.name} of {source.node.name} is not read as opacity; the bake takes "
                     "the surface as opaque")
        found = Opacity()
    found.source = source
    return found


def opacity_of(source, depth=0):
    """The Opacity of an output socket; None if its nodes are not read."""
    node = source.node
    if node.type == "TEX_IMAGE" and node.image is not None and source.name == "Alpha":
        return Opacity(image=node.image, uv_map=uv_of(node))
    if node.type == "VALUE":
        return Opacity(min(max(float(source.default_value), 0.0), 1.0))
    return arithmetic(node, depth) if node.type == "MATH" and depth < 100 else None


def arithmetic(node, depth):
    """A product of an Opacity with a constant in [0, 1], or its comparison with a constant."""
    used = [s for s in node.inputs if s.enabled]
    linked = [s for s in used if origin(s) is not None]
    found = opacity_of(origin(linked[0]), depth + 1) if len(linked) == 1 else None
    if found is None or found.cutoff is not None:
        return None
    other = next((float(s.default_value) for s in used if s is not linked[0]), 0.5)
    if node.operation == "MULTIPLY" and 0 <= other <= 1:
        found.factor *= other
        return found
    is_above = {"GREATER_THAN": linked[0] == used[0], "LESS_THAN": linked[0] != used[0],
                "ROUND": True}
    if not is_above.get(node.operation, False):
        return None
    found.cutoff = other
    return found


def mixed_shader(node, notes):
    amount = node.inputs["Fac"] if "Fac" in node.inputs else node.inputs[0]
    a, b = shader(node.inputs[1], notes), shader(node.inputs[2], notes)
    if a.alpha == 0 or b.alpha == 0:
        return veiled(node, amount, a, b, notes)
    share = number(amount, notes) if origin(amount) is None else 0.5
    if origin(amount) is not None:
        notes.append(f"the factor of {node.name} is a link, which is not read; it counts as 0.5")
    return added(scaled(a, 1 - share), scaled(b, share), notes)


def veiled(node, amount, a, b, notes):
    """A mix with a transparent shader: the other one with an opacity."""
    solid, share = (b, opacity(amount, notes)) if a.alpha == 0 else (a, Opacity())
    if solid is a and origin(amount) is None:
        share = Opacity(1 - float(amount.default_value))
    elif solid is a:
        notes.append(f"the factor of {node.name} is a link from a solid to a transparent shader, "
                     "which is not read; the bake takes the surface as opaque")
    if solid.alpha_source is not None or 0 < solid.alpha < 1:
        notes.append(f"{node.name} mixes two opacities; its own counts alone")
    solid.opacity = share
    return solid


def scaled(surface, by):
    surface.base = surface.base.scaled((by,) * 3)
    surface.emission = surface.emission.scaled((by,) * 3)
    surface.transmission *= by
    return surface


def total(a, b, notes):
    """The sum of two colours: exact if one is black, or if neither has a texture."""
    if a.is_black() or b.is_black():
        return b if a.is_black() else a
    if not a.is_plain() or not b.is_plain():
        notes.append("a mix of textures is not read; the first texture counts for all")
        first, other = (a, b) if not a.is_plain() else (b, a)
        grown = [1 + y / x if x > 0 else 1 for x, y in zip(first.factor, other.factor)]
        return first.scaled(grown)
    return Colour(tuple(x + y for x, y in zip(a.factor, b.factor)))


def added(a, b, notes):
    return Surface(total(a.base, b.base, notes), total(a.emission, b.emission, notes),
                   a.opacity if a.opacity.source or a.alpha < b.alpha else b.opacity,
                   min(1.0, a.transmission + b.transmission), a.tinted + b.tinted)
