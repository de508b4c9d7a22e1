# SPDX-License-Identifier: MIT
"""A bake in a Blender that test_command.py kills. Arguments: the command, and a file that gets the
number of its process."""

import os
import sys
import time

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support  # noqa: E402

addon = support.install()
settings = support.empty_scene()
support.add_mesh("monkey", "monkey")
support.add_lamp("POINT", "lamp", 100, (2, 0, 3))
bake = addon.bake.Bake(bpy.context, settings, sys.argv[-2])
path = sys.argv[-1]
with open(f"{path}.part", "w", encoding="utf-8") as file:
    file.write(str(bake.job.process.pid))
os.rename(f"{path}.part", path)
time.sleep(600)
