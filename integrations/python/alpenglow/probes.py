# SPDX-License-Identifier: MIT
"""Light probes: irradiance at any point, for things that move."""
import numpy

from . import light
from .arrays import given, pointer, put, view
from .lightmap import choose
from .native import Context, as_dict, chars, ffi, lib

_BASES = {"sh9": lib.ALP_PROBE_SH9, "sh4": lib.ALP_PROBE_SH4, "cube": lib.ALP_PROBE_AMBIENT_CUBE}
_STATES = ("valid", "moved", "filled", "invalid")


class Probes:
    """Light at points of space: Probes.bake or Probes.load, then sample."""

    def __init__(self, handle, context, origin=None):
        self.handle, self.context = handle, context
        self._field = context.make("alp_field", lib.alp_field_destroy, (handle,),
                                   lib.alp_field_create_probes, handle, lib.ALP_LOOKUP_OURS,
                                   ffi.NULL if origin is None else ffi.new("double[3]", origin),
                                   ffi.NULL, ...)

    @classmethod
    def bake(cls, scene, *, spacing=0.0, bounds=None, positions=None, basis="sh9", visibility=True,
             direct=False, rays=1536, bounces=None, one_sided=False, sky=None, sun=None,
             sun_size=None, lamps=None, seed=0, progress=None):
        """Solves the light of a scene, and samples it at probes.

        spacing: metres between neighbours; 0: about 4,096 probes in the bounds.
        bounds: ((x, y, z) low, (x, y, z) high) in metres; None: those of the scene.
        positions: [n, 3] metres, for probes at these places instead of a lattice.
        basis: "sh9", "sh4" or "cube". visibility: store distances, against light through walls.
        direct: whether light straight from lamps and suns is in it; a host may add it with shadows.
        rays: of each probe. sky, sun, sun_size, lamps, bounces, progress: as in Scene.bake.
        """
        options = lib.alp_probe_options_default()
        for name, value in (("spacing", spacing), ("rays", rays), ("seed", seed)):
            put(options, name, value, name)
        options.basis = choose(_BASES, basis, "basis")
        options.visibility, options.direct, options.one_sided = visibility, direct, one_sided
        put(options, "bounces", lib.ALP_BOUNCES_CONVERGE if bounces is None else bounces, "bounces")
        if bounds is not None:
            options.bounds_min, options.bounds_max = given(bounds, 3, "bounds").tolist()
        places = None if positions is None else given(positions, 3, "positions")
        if places is not None:
            address = pointer(places)
            lib.flat_set_positions(ffi.addressof(options), address, len(places))
        kept = light.fill(options.lighting, scene.context, sky, sun, sun_size, lamps)
        options.progress = lib.alpenglow_progress
        made = scene.context.make("alp_probes", lib.alp_probes_destroy, (scene.handle,),
                                  lib.alp_probes_bake, scene.handle, ffi.addressof(options), ...,
                                  progress=progress)
        del kept
        return cls(made, scene.context, scene.info["origin"])

    @classmethod
    def load(cls, path, context=None):
        """Reads a .probes.json and its files. Positions are those of the world of the scene's file."""
        context = context or Context()
        return cls(context.make("alp_probes", lib.alp_probes_destroy, (), lib.alp_probes_load,
                                context.handle, chars(path), ...), context)

    def save(self, path, overwrite=False):
        """Writes PATH.probes.json, and .ktx2 files beside it."""
        self.context.call(lib.alp_probes_save, self.handle, chars(path), overwrite)

    def sample(self, points, normals):
        """Irradiance [n, 3] in W/m2 at points [n, 3] in metres with unit normals [n, 3].

        Any number of threads may call it at once. It is 0 where a value is not finite.
        """
        points, normals = given(points, 3, "points"), given(normals, 3, "normals")
        if len(points) != len(normals):
            raise ValueError(f"normals: {len(normals)} of {len(points)} points")
        irradiance = numpy.empty_like(points)
        lib.flat_irradiance(self._field.pointer, len(points), pointer(points), pointer(normals),
                            pointer(irradiance))
        return irradiance

    @property
    def info(self):
        """Counts and quality as a dict: "count", "size", "spacing", "error", "mean" and others."""
        info = as_dict(lib.alp_probes_get_info(self.handle.pointer))
        info["states"] = dict(zip(_STATES, info["states"]))
        return info

    @property
    def positions(self):
        """[n, 3] metres where probes were sampled, float64, in the world of the scene's file."""
        places = numpy.empty((self.info["count"], 3))
        for index, place in enumerate(places):
            lib.alp_probes_position(self.handle.pointer, index, ffi.from_buffer("double[3]", place))
        return places

    @property
    def coefficients(self):
        """[n, coefficients, 3] float32. SH: radiance, in order 1, y, z, x and so on. Cube: E."""
        info = lib.alp_probes_get_info(self.handle.pointer)
        return view(lib.alp_probes_coefficients(self.handle.pointer, 0xFFFFFFFF),
                    (info.count, info.coefficients, 3), numpy.float32, self.handle)
