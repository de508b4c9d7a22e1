# SPDX-License-Identifier: MIT
"""Bakes, and the maps that they make."""
import numpy

from . import light
from .arrays import put, view
from .native import as_dict, chars, ffi, lib

_MAPS = {"ao": lib.ALP_MAP_AO, "light": lib.ALP_MAP_LIGHT, "bent": lib.ALP_MAP_BENT,
         "obscurance": lib.ALP_MAP_OBSCURANCE, "direction": lib.ALP_MAP_DIRECTION}
_ATLASES = {"auto": lib.ALP_ATLAS_AUTO, "keep": lib.ALP_ATLAS_KEEP, "charts": lib.ALP_ATLAS_CHARTS}
_FORMS = {"none": lib.ALP_LIGHTMAP_AS_NONE, "emissive": lib.ALP_LIGHTMAP_AS_EMISSIVE,
          "moz": lib.ALP_LIGHTMAP_AS_MOZ, "extras": lib.ALP_LIGHTMAP_AS_EXTRAS,
          "three": lib.ALP_LIGHTMAP_AS_THREE, "babylon": lib.ALP_LIGHTMAP_AS_BABYLON}
MOST_SAMPLES = 65536


def choose(choices, value, name):
    """The library's number of a word."""
    if value not in choices:
        raise ValueError(f"{name}: {value!r}; give one of {', '.join(choices)}")
    return choices[value]


class Lightmap:
    """Maps of a bake, over the pages of an atlas. Arrays are read-only views, not copies.

    report: figures of the bake, as a dict: "ao_mean", "light_mean" [W/m2], "ao_relative_error",
    "light_relative_error", "rays", "seconds_total", "atlas" and others.
    """

    def __init__(self, handle, report, maps):
        self.handle, self.report, self.maps = handle, report, tuple(maps)

    @property
    def page_count(self):
        """Number of pages; 1, unless texels_per_metre was given."""
        return lib.alp_lightmap_page_count(self.handle.pointer)

    def map(self, name, page=0):
        """[height, width, 4] float32 of a page: three values, and coverage (1 or 0)."""
        width, height = ffi.new("uint32_t *"), ffi.new("uint32_t *")
        address = lib.alp_lightmap_map_page(self.handle.pointer, choose(_MAPS, name, "map"), page, width,
                                            height)
        if address == ffi.NULL:
            raise KeyError(f"no page {page} of {name}: this bake made {self.page_count} page"
                           f"{'' if self.page_count == 1 else 's'} of {', '.join(self.maps)}")
        return view(address, (height[0], width[0], 4), numpy.float32, self.handle)

    @property
    def ao(self):
        """[height, width] accessibility of page 0: 1 is open, 0 is closed."""
        return self.map("ao")[:, :, 0]

    @property
    def irradiance(self):
        """[height, width, 3] irradiance of page 0, W/m2 per channel, without albedo."""
        return self.map("light")[:, :, :3]

    @property
    def coverage(self):
        """[height, width] of page 0: 1 if a surface covers the texel. Others hold near values."""
        return self.map(self.maps[0])[:, :, 3]

    @property
    def uvs(self):
        """[triangles, 3, 2] texture coordinates of the corners in [0, 1]; v = 0 is row 0."""
        atlas = lib.alp_lightmap_atlas(self.handle.pointer)
        count = self.report["scene"]["triangles"]
        return view(lib.alp_atlas_corner_uvs(atlas), (count, 3, 2), numpy.float32, self.handle)

    @property
    def triangle_pages(self):
        """[triangles] page of each, uint32; 4294967295 for triangles without a map."""
        atlas = lib.alp_lightmap_atlas(self.handle.pointer)
        count = self.report["scene"]["triangles"]
        return view(lib.alp_atlas_triangle_pages(atlas), (count,), numpy.uint32, self.handle)


def bake(scene, *, maps=("ao",), size=1024, samples=None, error=None, bounces=None, ao_distance=0.0,
         sky=None, sun=None, sun_size=None, lamps=None, atlas="auto", texels_per_metre=0.0,
         only=None, output=None, lightmap_as=None, maps_folder=None, overwrite=False, seed=0,
         progress=None):
    """Bakes maps of a scene and returns a Lightmap. Writes files if a place for them is given.

    maps: words of "ao", "light", "bent", "obscurance" and "direction" (needs "light").
    size: side of a page in texels. texels_per_metre: 0 fits everything on one page.
    samples: rays of each texel; or error: wanted relative error of each map, such as 0.01. Without
        both: 512 rays for occlusion, and light to 1 %, as the command does.
    bounces: reflections of light at most, 0 for direct light; None: until more add nothing.
    ao_distance: limit of occlusion in metres; 0: 20 % of the scene's diagonal.
    sky: radiance as one number, (r, g, b) or ((r, g, b) up, (r, g, b) down); "clear", with a sun; or
        an equirectangular image: a path of an .hdr or .exr, or [height, 2 height, 3 or 4] floats.
    sun: (azimuth from +Z towards +X, elevation, lux), the angles in degrees.
    sun_size: full angle of the disks of all suns, degrees.
    lamps: points of light (x, y, z, candela) or (x, y, z, candela, r, g, b), metres.
    atlas: "charts" unwraps; "keep" takes the mesh's uvs, or TEXCOORD_1; "auto" keeps if it can.
    only: names of the surfaces that get maps, such as "wall*,floor".
    output: asset to write (.glb, .gltf, .obj, .dae, .json for three.js, .babylon).
    lightmap_as: form of light in output: "none", "emissive", "moz", "extras", "three", "babylon".
        None: by the ending; else "emissive", unless a maps_folder holds light and output has "ao".
    maps_folder: folder of .exr and .png files, made if missing.
    progress: called with a Progress; if it returns False, the bake raises Cancelled.
    Raises Error with the library's message, and KeyboardInterrupt after Ctrl-C.
    """
    maps = (maps,) if isinstance(maps, str) else tuple(maps)
    options = lib.alp_bake_options_default()
    options.maps = sum(choose(_MAPS, name, "maps") for name in set(maps))
    options.atlas.mode = choose(_ATLASES, atlas, "atlas")
    put(options.atlas, "size", size, "size")
    put(options.atlas, "texels_per_metre", texels_per_metre, "texels_per_metre")
    put(options.occlusion, "distance", ao_distance, "ao_distance")
    put(options.occlusion, "seed", seed, "seed")
    put(options.light, "bounces", lib.ALP_BOUNCES_CONVERGE if bounces is None else bounces, "bounces")
    _set_samples(options, samples, error, bounces)
    kept = light.fill(options.light.lighting, scene.context, sky, sun, sun_size, lamps)
    kept += _set_outputs(options, maps, only, output, lightmap_as, maps_folder)
    options.overwrite, options.progress = overwrite, lib.alpenglow_progress
    report = ffi.new("alp_bake_report *")
    made = scene.context.make("alp_lightmap", lib.alp_lightmap_destroy, (scene.handle,),
                              lib.alp_bake, scene.handle, ffi.addressof(options), ..., report,
                              progress=progress)
    return Lightmap(made, as_dict(report[0]), maps)


def _set_samples(options, samples, error, bounces):
    if samples is not None and error is not None:
        raise ValueError("samples and error: give one of them")
    if samples is not None:
        put(options.occlusion, "samples", samples, "samples")
        options.light.samples = samples
        return
    if error is not None:
        put(options.sampling, "error", error, "error")
        if not error > 0.0:
            raise ValueError(f"error: {error!r}; give a relative error, such as 0.01")
        options.occlusion.samples = MOST_SAMPLES
    if bounces != 0:
        options.light.error = 0.01 if error is None else error
        options.light.bounded = error is None # the scene may need too many rays for 1 %


def _set_outputs(options, maps, only, output, lightmap_as, maps_folder):
    kept = []
    for name, value in (("only", only), ("output", output), ("maps_folder", maps_folder)):
        if value is not None:
            kept.append(chars(value))
            setattr(options, name, kept[-1])
    if output is not None and "light" in maps:
        ending = str(output).rpartition(".")[2]
        form = {"json": "three", "babylon": "babylon"}.get(ending, "emissive")
        form = "none" if form == "emissive" and maps_folder and "ao" in maps else form
        options.lightmap_as = choose(_FORMS, lightmap_as or form, "lightmap_as")
    elif lightmap_as not in (None, "none"):
        raise ValueError("lightmap_as: needs an output, and maps with light")
    return kept
