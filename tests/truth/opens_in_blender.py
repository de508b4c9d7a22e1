# SPDX-License-Identifier: MIT
"""Inside Blender, by opens_in_blender.sh: opens a baked .dae or .glb, follows its light from the
emission of each material back to the image and to the coordinates that it is read with, and looks
whether what it reads at the faces is the light of that place.

blender -b --factory-startup --python-exit-code 3 --python opens_in_blender.py -- FILE"""

import sys
import warnings

import bpy
import mathutils
import numpy

warnings.simplefilter("ignore")
numpy.bool = bool  # Blender 3.4's importer of glTF needs a name that numpy 1.24 lacks


def load(path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if path.endswith(".dae"):
        bpy.ops.wm.collada_import(filepath=path)
    else:
        bpy.ops.import_scene.gltf(filepath=path)
    return [o for o in bpy.context.scene.objects if o.type == "MESH"]


def upstream(socket, kind):
    """The node of a kind that a socket's value comes from, over others between; or None."""
    waiting = [link.from_node for link in socket.links]
    while waiting:
        node = waiting.pop()
        if node.type == kind:
            return node
        waiting += [link.from_node for i in node.inputs for link in i.links]
    return None


def light_node(material):
    """The image node behind the emission."""
    shaders = [n for n in material.node_tree.nodes if n.type == "BSDF_PRINCIPLED"]
    assert len(shaders) == 1, f"{material.name}: {len(shaders)} Principled nodes"
    node = upstream(shaders[0].inputs["Emission"], "TEX_IMAGE")
    assert node is not None, f"{material.name}: no image leads to its emission"
    assert node.image is not None and tuple(node.image.size) == (128, 128), \
        f"{material.name}: its image is not there, or not the map"
    return node


def layer_of(node, mesh, is_dae):
    """Our coordinates, which the node must read: glTF's importer names them, COLLADA's leaves the
    node to take the first ones."""
    named = upstream(node.inputs["Vector"], "UVMAP")
    if is_dae:
        layer = next(u for u in mesh.uv_layers if u.active_render)
        assert named is None and layer.name == mesh.uv_layers[0].name == "alpenglow-uv-0", \
            f"{mesh.name}: the first coordinates are {layer.name}"
        return layer
    assert named is not None and named.uv_map == mesh.uv_layers[-1].name, \
        f"{mesh.name}: the map is not read with the last coordinates"
    return mesh.uv_layers[-1]


def read(image, layer, polygons):
    """Linear light at the centre of each face: the nearest texel."""
    width, height = image.size
    pixels = numpy.array(image.pixels[:]).reshape(height, width, image.channels)[:, :, :3]
    pixels = numpy.where(pixels <= 0.04045, pixels / 12.92, ((pixels + 0.055) / 1.055) ** 2.4)
    uv = numpy.array([numpy.mean([layer.data[i].uv for i in p.loop_indices], axis=0)
                      for p in polygons])
    assert uv.min() >= 0 and uv.max() <= 1, "coordinates lie outside the map"
    x = numpy.minimum((uv[:, 0] * width).astype(int), width - 1)
    y = numpy.minimum((uv[:, 1] * height).astype(int), height - 1)
    return pixels[y, x]


def follows_sun(mesh_object, light):
    """How the light of the faces goes with the cosine to the file's sun: the correlation."""
    sun = next(o for o in bpy.context.scene.objects if o.type == "LIGHT")
    towards = sun.matrix_world.to_3x3().normalized() @ mathutils.Vector((0, 0, 1))
    turn = mesh_object.matrix_world.to_3x3().normalized()
    cosines = [max(0.0, (turn @ p.normal).dot(towards)) for p in mesh_object.data.polygons]
    return numpy.corrcoef(light.mean(axis=1), cosines)[0, 1]


def check_dae(shown):
    """One duck under a white sky and a sun. Shadows and what the sky adds by place leave .9 of the
    correlation; the texture's own coordinates, which read the map anywhere, about 0."""
    assert len(shown) == 1, f"{len(shown)} meshes"
    mesh = shown[0].data
    node = light_node(mesh.materials[0])
    light = read(node.image, layer_of(node, mesh, True), mesh.polygons)
    assert (light.min(axis=1) > 0.1).mean() > 0.99, "black faces under a white sky"
    right = follows_sun(shown[0], light)
    wrong = follows_sun(shown[0], read(node.image, mesh.uv_layers[1], mesh.polygons))
    print(f"light against the sun's cosine: correlation {right:.3f}, by other coordinates "
          f"{wrong:.3f}")
    assert right > 0.8 > 0.4 > wrong, "the light is not that of the place"


def check_glb(shown):
    """A red wall is red, a green one green; the lamp shines."""
    seen = {}
    for o in shown:
        for slot, material in enumerate(o.data.materials):
            node = light_node(material)
            faces = [p for p in o.data.polygons if p.material_index == slot]
            light = read(node.image, layer_of(node, o.data, False), faces)
            for word in ("red", "green", "Light"):
                if word in material.name:
                    seen[word] = light
    print({word: light.mean(axis=0).round(3).tolist() for word, light in seen.items()})
    assert (seen["red"][:, 0] > 3 * seen["red"][:, 1]).all(), "the red wall"
    assert (seen["green"][:, 1] > 3 * seen["green"][:, 0]).all(), "the green wall"
    assert (seen["Light"] > 0.9).all(), "the lamp"


path = sys.argv[sys.argv.index("--") + 1]
(check_dae if path.endswith(".dae") else check_glb)(load(path))
