# SPDX-License-Identifier: MIT
"""Repairs materials whose node group of a bake the user has deleted.

Blender then cuts the links of the group's node, at the latest when it loads the file. Each node of
a group names the ends of the chain that it was put into, so that the chain can be closed again."""

import bpy

from . import nodes
from .nodes import SOURCE, TARGET


def is_dead(node):
    """Whether the group of one of our nodes was deleted."""
    return node.type == "GROUP" and node.node_tree is None and \
        (TARGET in node or node.label in (nodes.LIGHT, nodes.OCCLUSION))


def socket_of(tree, ends, direction):
    """The socket that SOURCE or TARGET names; None if its node was renamed or has gone."""
    node = tree.nodes.get(ends[0]) if ends is not None else None
    sockets = getattr(node, direction, ())
    return next((s for s in sockets if s.identifier == ends[1]), None)


def close(tree, node):
    """Removes a dead node and links what it connected. Returns whether the chain is whole."""
    source = socket_of(tree, node.get(SOURCE), "outputs")
    target = socket_of(tree, node.get(TARGET), "inputs")
    is_whole = target is not None and (source is not None or SOURCE not in node)
    is_free = target is not None and all(link.from_node == node for link in target.links)
    tree.nodes.remove(node)
    if is_free and source is not None:
        tree.links.new(source, target)
    return is_whole


def repair():
    """Repairs all materials of this file. Returns a note for each that had a dead node."""
    notes = []
    for material in bpy.data.materials:
        tree = material.node_tree
        if material.library is not None or tree is None:
            continue
        for node in [n for n in tree.nodes if is_dead(n)]:
            label = node.label
            remedy = "the links are as before" if close(tree, node) else \
                "link the nodes that it connected again"
            notes.append(f"material {material.name}: the node group {label} was deleted; {remedy}")
    return list(dict.fromkeys(notes))
