# SPDX-License-Identifier: MIT
"""Lights beside those of the scene, in the arguments that bakes share."""
import math
import os

import numpy

from . import image
from .arrays import color, put
from .native import ffi, lib


def fill(lighting, context, sky, sun, sun_size, lamps):
    """Fills an alp_lighting_options. Returns what must stay alive during the call."""
    kept = []
    if isinstance(sky, str) and sky == "clear":
        if sun is None:
            raise ValueError("sky: 'clear' needs a sun; give sun=(150, 40, 60000) or another")
        lighting.sky.kind = lib.ALP_SKY_CLEAR
    elif isinstance(sky, (str, os.PathLike)):
        kept.append(image.load(context, sky))
    elif numpy.ndim(sky) == 3:
        kept.append(image.make(context, numpy.asarray(sky, numpy.float32)))
    elif sky is not None:
        _fill_colors(lighting.sky, sky)
    if kept:
        lighting.sky.kind, lighting.sky.image = lib.ALP_SKY_IMAGE, kept[0].pointer
    if sun is not None:
        _fill_sun(lighting.sun, sun)
    if sun_size is not None:
        put(lighting.sun, "size", sun_size, "sun_size")
        lighting.sun.size = lighting.file_sun_size = math.radians(sun_size)
    if lamps is not None:
        kept.append(_make_lamps(lamps))
        lighting.lamps, lighting.lamp_count = kept[-1], len(kept[-1])
    return kept


def _fill_colors(sky, colors):
    two = numpy.ndim(colors) == 2
    if two and numpy.shape(colors) != (2, 3):
        raise ValueError("sky: give (up, down) as two colours of three numbers each")
    sky.kind = lib.ALP_SKY_HEMISPHERE if two else lib.ALP_SKY_CONSTANT
    sky.up = color(colors[0] if two else colors, "sky")
    if two:
        sky.down = color(colors[1], "sky")


def _fill_sun(options, sun):
    if numpy.shape(sun) != (3,):
        raise ValueError(f"sun: {sun!r}; give (azimuth, elevation, lux), such as (150, 40, 60000)")
    options.azimuth, options.elevation = math.radians(sun[0]), math.radians(sun[1])
    options.illuminance = sun[2]


def _make_lamps(lamps):
    rows = numpy.asarray(lamps, numpy.float32)
    if rows.ndim != 2 or rows.shape[1] not in (4, 7):
        raise ValueError("lamps: give (x, y, z, candela) or (x, y, z, candela, r, g, b) for each")
    made = ffi.new("alp_lamp[]", len(rows))
    for i, row in enumerate(rows.tolist()):
        made[i] = lib.alp_lamp_default()
        made[i].position, made[i].intensity = row[:3], row[3]
        made[i].color = row[4:] or [1.0, 1.0, 1.0]
    return made
