#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""opens_in_pycollada.py FILE: the map of a baked .dae is an effect's emission, its image is there,
and each primitive that it is bound to has the set of coordinates that the binding names."""

import os
import sys

import collada

path = sys.argv[1]
document = collada.Collada(path, ignore=[collada.DaeUnsupportedError])
bound = 0
for shown in document.scene.objects("geometry"):
    for primitive in shown.original.primitives:
        binding = shown.materialnodebysymbol[primitive.material]
        number = [int(i[2]) for i in binding.inputs if i[0] == "ALPENGLOW"]
        light = binding.target.effect.emission
        assert isinstance(light, collada.material.Map), "emission is no texture"
        assert light.texcoord == "ALPENGLOW", light.texcoord
        image = os.path.join(os.path.dirname(path), light.sampler.surface.image.path)
        assert os.path.isfile(image), image
        there = [int(i[3] or 0) for i in primitive.sources["TEXCOORD"]]
        assert len(number) == 1 and number[0] in there, f"bound to {number}, there are {there}"
        ours = primitive.sources["TEXCOORD"][there.index(number[0])]
        assert ours[2] == "#alpenglow-uv-0", ours[2]
        bound += 1
assert bound > 0, "nothing is shown"
print(f"pycollada: {bound} primitives read the map with a set that they have")
