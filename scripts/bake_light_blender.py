# SPDX-License-Identifier: MIT
"""Runs the peer's script with what it has no option for: a picture of the sky, and emission from the
front alone of materials that are single-sided, as glTF has it.

    blender -b --factory-startup --python scripts/bake_light_blender.py -- \
        BAKE_PEER.py SKY.hdr|none OPTIONS OF BAKE_PEER.py ...

The picture's middle looks at glTF's +X, as Blender has it; ours looks at -Z, so that ours is turned
by --sky-turn (scripts/peer_speed.py).
"""
import sys

import bpy

MAIN = "\nmain()\n"


def add_sky(path):
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    nodes = world.node_tree.nodes
    picture = nodes.new("ShaderNodeTexEnvironment")
    picture.image = bpy.data.images.load(path)
    background = next(n for n in nodes if n.type == "BACKGROUND")
    world.node_tree.links.new(picture.outputs["Color"], background.inputs["Color"])
    bpy.context.scene.world = world  # a linked colour stays when a constant one is set


def shine_from_front(material):
    nodes, links = material.node_tree.nodes, material.node_tree.links
    for emission in [n for n in nodes if n.type == "EMISSION"]:
        strength = emission.inputs["Strength"]
        front = nodes.new("ShaderNodeMath")
        front.operation = "MULTIPLY_ADD"  # strength - backfacing * strength
        links.new(nodes.new("ShaderNodeNewGeometry").outputs["Backfacing"], front.inputs[0])
        front.inputs[1].default_value = -strength.default_value
        front.inputs[2].default_value = strength.default_value
        links.new(front.outputs[0], strength)


def main(script, sky):
    source = open(script).read()
    if not source.endswith(MAIN):
        sys.exit(f"{script}: does not end in main()")
    peer = {"__name__": "peer"}
    exec(compile(source[: -len(MAIN)], script, "exec"), peer)
    import_scene, setup_materials = peer["import_scene"], peer["setup_materials"]

    def import_with_sky(path):
        imported = import_scene(path)
        if sky != "none":
            add_sky(sky)
        return imported

    def setup_single_sided(joined, *others):
        found = setup_materials(joined, *others)
        for material in joined.data.materials:
            if material.use_backface_culling:
                shine_from_front(material)
        return found

    peer["import_scene"] = import_with_sky
    peer["setup_materials"] = setup_single_sided
    peer["main"]()


arguments = sys.argv.index("--") + 1
script_path, sky_path = sys.argv[arguments : arguments + 2]
del sys.argv[arguments : arguments + 2]
main(script_path, sky_path)
