# SPDX-License-Identifier: MIT
"""Alpenglow: bakes ambient occlusion and global illumination; numpy in, numpy out.

    scene = alpenglow.Scene.load("room.glb")
    lightmap = scene.bake(size=512, maps=("ao", "light"), sky=1.0)
    lightmap.irradiance                              # [512, 512, 3] W/m2

Units: metres, right-handed, +Y up. Light is linear, in channels R, G, B of Rec.709. Irradiance is in
W/m2 per channel, radiance in W/(sr m2), angles are in degrees. Texels run from the top row, v = 0.

A scene runs one call at a time: threads that bake at once need a Context each. Long calls release
the interpreter's lock, and end within 100 ms of Ctrl-C. Warnings of the library go to the logger
"alpenglow" of the module logging.
"""
from .native import Cancelled, Context, Error, Progress, version
from .image import load_image, save_image
from .lightmap import Lightmap
from .probes import Probes
from .scene import Mesh, Scene

__all__ = ["Cancelled", "Context", "Error", "Lightmap", "Mesh", "Probes", "Progress", "Scene",
           "load_image", "save_image", "version"]
