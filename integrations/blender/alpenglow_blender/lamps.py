# SPDX-License-Identifier: MIT
"""Lamps of Blender as glTF and as options of the command.

Units are radiometric, as Cycles has them: the strength of an emission is radiance L [W/sr/m2]. The
command reads 1 candela as 1 W/sr and 1 lux as 1 W/m2, so there is no factor of 683 lm/W.

A point lamp of power P [W] in Cycles is a sphere of radius r that emits L = P / (4 pi^2 r^2). Its
intensity is L pi r^2:

    I = P / (4 pi)              [W/sr]

A spot lamp has the same I within its cone. A sun of strength S lights a surface that faces it by

    E = S                       [W/m2]

An area lamp of power P and area A emits from its front

    L = P / (4 A)               [W/sr/m2]

That is pi / 4 of a plate that emits P in all. tests/integrations/blender/test_lamps.py compares
each formula with a picture by Cycles."""

import math

import numpy

from .surface import Colour, Opacity, Surface

DISK_CORNERS = 32
PLATE_ALPHA = 0.25  # occlusion takes a blended surface as open below 0.5


def intensity_of(power):
    """Radiant intensity [W/sr] of a point or spot lamp of `power` [W]."""
    return power / (4 * math.pi)


def radiance_of(power, area):
    """Radiance [W/sr/m2] of an area lamp of `power` [W] and `area` [m2]."""
    return power / (4 * area)


def cone_of(size, blend):
    """Inner and outer half angle of a spot. Cycles fades between the cosines of the half cone, c,
    and c + (1 - c) blend. glTF has another curve between the same two."""
    outer = min(size / 2, math.pi / 2)
    cosine = math.cos(outer)
    inner = math.acos(min(1.0, cosine + (1 - cosine) * blend))
    return min(inner, outer - 1e-4), outer


def is_dark(shown):
    """Whether a lamp lights no diffuse surface. A portal guides the rays of Cycles to the sky."""
    lamp = shown.data
    cycles = getattr(lamp, "cycles", None)
    return lamp.energy <= 0 or max(lamp.color) <= 0 or not shown.visible_diffuse or \
        (lamp.type == "AREA" and getattr(cycles, "is_portal", False))


def unread(shown):
    """Lines for the user: settings of a lamp that no bake reads."""
    lamp = shown.data
    cycles = getattr(lamp, "cycles", None)
    if lamp.use_nodes:
        yield f"{shown.name}: nodes of lamps are not read; colour and power are"
    if lamp.type == "AREA" and lamp.spread < math.pi - 1e-3:
        yield f"{shown.name}: the spread is not read; the lamp shines by the cosine to all angles"
    if not getattr(cycles, "cast_shadow", lamp.use_shadow):
        yield f"{shown.name}: a lamp without shadows is not read; objects shade its light"
    linking = getattr(shown, "light_linking", None)  # from Blender 4.0
    if linking is not None and (linking.receiver_collection or linking.blocker_collection):
        yield f"{shown.name}: light linking is not read; the lamp lights all objects"


def plate(lamp, radiance):
    """The Surface of an area lamp of `radiance` [W/sr/m2]. No lamp of Cycles blocks light.

    A surface of alpha a, transmission 1 and colour 1 lets (1 - a) + a = 1 of the light through,
    reflects nothing, and emits a L (docs/conventions.md, "Sides and panes")."""
    emission = Colour(tuple(radiance / PLATE_ALPHA * c for c in lamp.color))
    return Surface(Colour((1.0, 1.0, 1.0)), emission, Opacity(PLATE_ALPHA), transmission=1.0)


def punctual(lamp):
    """The KHR_lights_punctual light of a point, spot or sun lamp."""
    light = {"name": lamp.name, "color": [max(0.0, c) for c in lamp.color]}
    strongest = max(1.0, *light["color"])
    light["color"] = [c / strongest for c in light["color"]]
    if lamp.type == "SUN":
        return dict(light, type="directional", intensity=lamp.energy * strongest)
    light["intensity"] = intensity_of(lamp.energy) * strongest
    if lamp.type == "SPOT":
        inner, outer = cone_of(lamp.spot_size, lamp.spot_blend)
        return dict(light, type="spot", spot={"innerConeAngle": inner, "outerConeAngle": outer})
    return dict(light, type="point")


def outline_of(lamp):
    """Corners [n][3] of an area lamp in its own space. It shines along -Z."""
    width = lamp.size
    depth = lamp.size_y if lamp.shape in ("RECTANGLE", "ELLIPSE") else width
    if lamp.shape in ("DISK", "ELLIPSE"):
        turn = -2 * math.pi * numpy.arange(DISK_CORNERS) / DISK_CORNERS
        plane = numpy.stack([numpy.cos(turn), numpy.sin(turn)], axis=1)
    else:
        plane = numpy.array([(-1, -1), (-1, 1), (1, 1), (1, -1)], dtype=float)
    corners = numpy.zeros((len(plane), 3))
    corners[:, :2] = plane * (width / 2, depth / 2)
    return corners


def world_area(corners, matrix):
    """Area [m2] of a flat outline [n][3], counter-clockwise or not, under a 4 x 4 matrix."""
    placed = corners @ numpy.array(matrix)[:3, :3].T
    return float(numpy.linalg.norm(sum(numpy.cross(a, b) for a, b in
                                       zip(placed, numpy.roll(placed, -1, axis=0)))) / 2)


def sun_options(suns):
    """Options of the command for the angle of all suns: that of the strongest. suns: pairs of
    strength [W/m2] and angle [radians]."""
    if not suns:
        return []
    _, angle = max(suns)
    return ["--sun-size", f"{min(math.degrees(angle), 90):.6g}"]
