# SPDX-License-Identifier: MIT
"""Seconds of Cycles for the occlusion of all objects of a .glb, each left as it is, in one call.

    blender -b --factory-startup --python scripts/bake_objects_blender.py -- \
        SCENE.glb SIZE SAMPLES DISTANCE REPORT.json

Every object keeps its TEXCOORD_1, all share one image: what somebody does who selects a level and
bakes it. For scripts/peer_speed.py.
"""
import json
import sys
import time

import addon_utils
import bpy
import numpy as np

if not hasattr(np, "bool"):
    np.bool = bool  # what the importer of Blender 3.4 still says


def prepare(mesh_object, image):
    mesh = mesh_object.data
    mesh.uv_layers.active = mesh.uv_layers[1]
    mesh.uv_layers[1].active_render = True
    if not mesh.materials:
        mesh.materials.append(bpy.data.materials.new("default"))
    for material in mesh.materials:
        material.use_nodes = True
        node = material.node_tree.nodes.new("ShaderNodeTexImage")
        node.image = image
        material.node_tree.nodes.active = node


def main(scene_path, size, samples, distance, report):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable("io_scene_gltf2")
    addon_utils.enable("cycles")
    bpy.ops.import_scene.gltf(filepath=scene_path, merge_vertices=False)
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("world")
    scene.world.light_settings.distance = float(distance)
    scene.render.engine = "CYCLES"
    scene.cycles.samples = int(samples)
    scene.cycles.use_adaptive_sampling = False
    scene.cycles.use_denoising = False
    image = bpy.data.images.new("bake", int(size), int(size), float_buffer=True, is_data=True)
    objects = [o for o in scene.objects if o.type == "MESH"]
    for o in objects:
        prepare(o, image)
        o.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]
    start = time.time()
    if bpy.ops.object.bake(type="AO", margin=0, use_clear=True) != {"FINISHED"}:
        sys.exit("Cycles did not bake")
    pixels = np.array(image.pixels[:], dtype=np.float32).reshape(-1, 4)
    with open(report, "w") as file:
        json.dump({"seconds": time.time() - start, "objects": len(objects),
                   "mean": float(pixels[:, 0].mean())}, file)


main(*sys.argv[sys.argv.index("--") + 1 :])
