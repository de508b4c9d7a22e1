# SPDX-License-Identifier: MIT
"""blender -b --python unwrap_blender.py -- IN.obj OUT.obj SIZE PADDING: Smart UV Project with its
defaults on one mesh, the margin a share of the page. Prints its seconds."""
import json
import sys
import time

import bpy

source, target, size, padding = sys.argv[sys.argv.index("--") + 1:]
vertices, faces = [], []
with open(source, encoding="ascii") as lines:
    for line in lines:
        words = line.split()
        if words[0] == "v":
            vertices.append(tuple(map(float, words[1:4])))
        elif words[0] == "f":
            faces.append(tuple(int(w) - 1 for w in words[1:4]))
mesh = bpy.data.meshes.new("mesh")
mesh.from_pydata(vertices, [], faces)
thing = bpy.data.objects.new("thing", mesh)
bpy.context.collection.objects.link(thing)
bpy.context.view_layer.objects.active = thing
thing.select_set(True)
bpy.ops.object.mode_set(mode="EDIT")
bpy.ops.mesh.select_all(action="SELECT")
# The margin goes round each island: half of ours leaves as much between two.
started = time.perf_counter()
bpy.ops.uv.smart_project(margin_method="FRACTION", island_margin=int(padding) / 2 / int(size))
seconds = time.perf_counter() - started
bpy.ops.object.mode_set(mode="OBJECT")

layer = thing.data.uv_layers.active.data
with open(target, "w", encoding="ascii") as out:
    for x, y, z in vertices:
        out.write(f"v {x:.9g} {y:.9g} {z:.9g}\n")
    for corner in layer:
        out.write(f"vt {corner.uv[0]:.9g} {corner.uv[1]:.9g}\n")
    for face in thing.data.polygons:
        corners = (f"{v + 1}/{i + 1}" for v, i in zip(face.vertices, face.loop_indices))
        out.write("f " + " ".join(corners) + "\n")
print("unwrapped " + json.dumps({"seconds": seconds}))
