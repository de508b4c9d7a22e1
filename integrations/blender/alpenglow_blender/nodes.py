# SPDX-License-Identifier: MIT
"""Node groups that show baked maps in a material, and their way in and out of it.

"Alpenglow Light" shows, as emission that no other light changes,

    L = min(rho, 0.95) x intensity x (E / pi) + Le      [W/sr/m2]

as `alpenglow render --with lightmap` does. Its factor Baked fades to the original shader, which
stays linked. "Alpenglow Occlusion" multiplies a colour by the occlusion, as is usual in Blender. It
gives the occlusion as a number too."""

import bpy

LIGHT, OCCLUSION = "Alpenglow Light", "Alpenglow Occlusion"
VERSION = 1  # of the groups: a file with older ones gets new groups
MARK = "alpenglow"
SOURCE, TARGET = "alpenglow_source_socket", "alpenglow_target_socket"  # [node, identifier]
UV_MAP = "Alpenglow"
BRIGHTEST_ALBEDO = 0.95


def output_of(tree):
    """The output node that Cycles shows, else EEVEE's; None without any."""
    return tree.get_output_node("CYCLES") or tree.get_output_node("EEVEE")


def is_group(node, name):
    return node.type == "GROUP" and node.node_tree is not None and \
        node.node_tree.get(MARK) == f"{name} {VERSION}"


def add_socket(tree, direction, kind, name, value=None, limits=None):
    if hasattr(tree, "interface"):  # Blender 4
        socket = tree.interface.new_socket(name=name, in_out=direction, socket_type=kind)
    else:
        socket = (tree.inputs if direction == "INPUT" else tree.outputs).new(kind, name)
    if value is not None:
        socket.default_value = value
    if limits is not None:
        socket.min_value, socket.max_value = limits


def group(name, build):
    """The node group of that name in this file; `build` fills a new one."""
    for tree in bpy.data.node_groups:
        if tree.get(MARK) == f"{name} {VERSION}" and tree.library is None:
            return tree
    tree = bpy.data.node_groups.new(name, "ShaderNodeTree")
    tree[MARK] = f"{name} {VERSION}"
    build(tree)
    for place, node in enumerate(tree.nodes):
        node.location = (200 * place, 0)
    return tree


def ends(tree):
    return tree.nodes.new("NodeGroupInput").outputs, tree.nodes.new("NodeGroupOutput").inputs


def vector_math(tree, operation, *inputs):
    """The output of a node of vector arithmetic. Inputs are sockets or numbers."""
    node = tree.nodes.new("ShaderNodeVectorMath")
    node.operation = operation
    sockets = [s for s in node.inputs if s.enabled]
    for socket, value in zip(sockets, inputs):
        if isinstance(value, bpy.types.NodeSocket):
            tree.links.new(value, socket)
        else:
            socket.default_value = value
    return next(s for s in node.outputs if s.enabled)


def mix_shaders(tree, factor, first, second):
    node = tree.nodes.new("ShaderNodeMixShader")
    for socket, value in zip(node.inputs, (factor, first, second)):
        tree.links.new(value, socket)
    return node.outputs[0]


def build_light(tree):
    white = (1.0, 1.0, 1.0, 1.0)
    add_socket(tree, "INPUT", "NodeSocketShader", "Original")
    add_socket(tree, "INPUT", "NodeSocketColor", "Light", (0.0, 0.0, 0.0, 1.0))
    add_socket(tree, "INPUT", "NodeSocketFloat", "Intensity", 1.0, (0.0, 1e9))
    add_socket(tree, "INPUT", "NodeSocketColor", "Base Color", white)
    add_socket(tree, "INPUT", "NodeSocketVector", "Base Factor", (1.0, 1.0, 1.0))
    add_socket(tree, "INPUT", "NodeSocketColor", "Emission", white)
    add_socket(tree, "INPUT", "NodeSocketVector", "Emission Factor", (0.0, 0.0, 0.0))
    add_socket(tree, "INPUT", "NodeSocketFloat", "Alpha", 1.0, (0.0, 1.0))
    add_socket(tree, "INPUT", "NodeSocketFloat", "Baked", 1.0, (0.0, 1.0))
    add_socket(tree, "OUTPUT", "NodeSocketShader", "Surface")
    given, result = ends(tree)
    base = vector_math(tree, "MULTIPLY", given["Base Color"], given["Base Factor"])
    albedo = vector_math(tree, "MINIMUM", base, (BRIGHTEST_ALBEDO,) * 3)
    light = vector_math(tree, "SCALE", given["Light"], given["Intensity"])
    emitted = vector_math(tree, "MULTIPLY", given["Emission"], given["Emission Factor"])
    radiance = vector_math(tree, "MULTIPLY_ADD", albedo, light, emitted)
    emission = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(radiance, emission.inputs["Color"])
    clear = tree.nodes.new("ShaderNodeBsdfTransparent")
    shown = mix_shaders(tree, given["Alpha"], clear.outputs[0], emission.outputs[0])
    mixed = mix_shaders(tree, given["Baked"], given["Original"], shown)
    tree.links.new(mixed, result["Surface"])


def build_occlusion(tree):
    add_socket(tree, "INPUT", "NodeSocketColor", "Color", (0.8, 0.8, 0.8, 1.0))
    add_socket(tree, "INPUT", "NodeSocketFloat", "Occlusion", 1.0, (0.0, 1.0))
    add_socket(tree, "INPUT", "NodeSocketFloat", "Strength", 1.0, (0.0, 1.0))
    add_socket(tree, "OUTPUT", "NodeSocketColor", "Color")
    add_socket(tree, "OUTPUT", "NodeSocketFloat", "Occlusion")
    given, result = ends(tree)
    shadow = tree.nodes.new("ShaderNodeMath")  # 1 + strength (occlusion - 1)
    less = tree.nodes.new("ShaderNodeMath")
    less.operation, shadow.operation = "SUBTRACT", "MULTIPLY_ADD"
    tree.links.new(given["Occlusion"], less.inputs[0])
    less.inputs[1].default_value = 1.0
    tree.links.new(less.outputs[0], shadow.inputs[0])
    tree.links.new(given["Strength"], shadow.inputs[1])
    shadow.inputs[2].default_value = 1.0
    product = vector_math(tree, "SCALE", given["Color"], shadow.outputs[0])
    tree.links.new(product, result["Color"])
    tree.links.new(shadow.outputs[0], result["Occlusion"])


def add_group(tree, name, build, place):
    node = tree.nodes.new("ShaderNodeGroup")
    node.node_tree = group(name, build)
    node.label, node.width, node.location = name, 200, place
    return node


def add_image(tree, image, uv_map, place):
    """An image node that reads the map by the UV map of the bake."""
    picture = tree.nodes.new("ShaderNodeTexImage")
    picture.image, picture.extension, picture.interpolation = image, "EXTEND", "Linear"
    picture.location, picture[MARK] = place, 1
    coordinates = tree.nodes.new("ShaderNodeUVMap")
    coordinates.uv_map, coordinates[MARK] = uv_map, 1
    coordinates.location = (place[0] - 200, place[1])
    tree.links.new(coordinates.outputs["UV"], picture.inputs["Vector"])
    return picture.outputs["Color"]


def set_colour(tree, socket, factor_socket, colour):
    """Gives two inputs of the group a Colour of surface.py."""
    if colour.source is not None:
        tree.links.new(colour.source, socket)
        factor_socket.default_value = colour.weight
    else:
        socket.default_value = (1.0, 1.0, 1.0, 1.0)
        factor_socket.default_value = colour.factor


def pass_on(tree, link, socket):
    """Links the source of a link to another socket. A muted link stays muted."""
    is_muted, source = link.is_muted, link.from_socket
    tree.links.new(source, socket).is_muted = is_muted


def remember(node, target):
    """Notes at a new group node which sockets it connects, for repair.py. target: the
    input before which the node goes."""
    node[TARGET] = [target.node.name, target.identifier]
    if target.links and not target.links[0].is_muted:
        source = target.links[0].from_socket
        node[SOURCE] = [source.node.name, source.identifier]


def show_light(tree, surface, image, intensity, uv_map):
    """Puts the group of light before the output. surface: of this material, read before."""
    target = output_of(tree).inputs["Surface"]
    x, y = target.node.location
    node = add_group(tree, LIGHT, build_light, (x, y + 250))
    remember(node, target)
    if target.links:
        pass_on(tree, target.links[0], node.inputs["Original"])
    tree.links.new(add_image(tree, image, uv_map, (x - 300, y + 350)), node.inputs["Light"])
    node.inputs["Intensity"].default_value = intensity
    set_colour(tree, node.inputs["Base Color"], node.inputs["Base Factor"], surface.base)
    set_colour(tree, node.inputs["Emission"], node.inputs["Emission Factor"], surface.emission)
    node.inputs["Alpha"].default_value = surface.alpha
    if surface.alpha_source is not None:
        tree.links.new(surface.alpha_source, node.inputs["Alpha"])
    tree.links.new(node.outputs["Surface"], target)


def show_occlusion(tree, surface, image, uv_map):
    """Puts the group of occlusion before the colour of each shader."""
    picture = None
    for target in dict.fromkeys(surface.tinted):
        x, y = target.node.location
        if picture is None:
            picture = add_image(tree, image, uv_map, (x - 500, y + 250))
        node = add_group(tree, OCCLUSION, build_occlusion, (x - 220, y + 100))
        remember(node, target)
        node.inputs["Color"].default_value = target.default_value
        if target.links:
            pass_on(tree, target.links[0], node.inputs["Color"])
        tree.links.new(picture, node.inputs["Occlusion"])
        tree.links.new(node.outputs["Color"], target)


def remove(tree):
    """Removes our nodes. The links and values of the others are then as before the bake. Returns
    whether there were any."""
    ours = [n for n in tree.nodes if n.get(MARK)]
    count = len(tree.nodes)
    for node in list(tree.nodes):
        light = is_group(node, LIGHT)
        if not light and not is_group(node, OCCLUSION):
            continue
        given = node.inputs["Original" if light else "Color"]
        for link in list(node.outputs[0].links):
            target = link.to_socket
            tree.links.remove(link)
            if given.links:
                pass_on(tree, given.links[0], target)
            elif not light:
                target.default_value = given.default_value
        tree.nodes.remove(node)
    for node in ours:
        tree.nodes.remove(node)
    return len(tree.nodes) < count
