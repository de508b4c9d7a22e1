# SPDX-License-Identifier: MIT
"""Reads baked probes, by docs/manual/probe-format.md alone: read_probes("OUT.probes.json")."""
import json
import pathlib
import struct
import subprocess


def texture(folder, named):
    """(width, height, depth, floats) of a texture that the JSON names."""
    data, checksum = (folder / named["file"]).read_bytes(), 0xCBF29CE484222325
    for byte in data:
        checksum = (checksum ^ byte) * 0x100000001B3 % 2**64
    assert (len(data), f"{checksum:016x}") == (named["bytes"], named["fnv1a64"]), "another bake"
    kind, _, width, height, depth, _, _, _, scheme = struct.unpack_from("<9I", data, 12)
    offset, size, _ = struct.unpack_from("<3Q", data, 80)
    texels = data[offset:offset + size]
    if scheme == 2:
        texels = subprocess.run(["zstd", "-dc"], input=texels, stdout=-1, check=True).stdout
    count = width * height * depth * {97: 4, 83: 2}[kind]
    return width, height, depth, struct.unpack(f"<{count}e", texels)


def read_probes(path):
    """The JSON with "probes": dicts of place, move, state, sets (light, layers, gradients), moments."""
    path = pathlib.Path(path)
    volume = json.loads(path.read_text(encoding="utf-8"))
    assert volume["format"] == "alpenglow-probes" and volume["version"] == 1
    width, height, depth, values = texture(path.parent, volume["textures"]["coefficients"])
    floats = 3 * {"sh9": 9, "sh4": 4, "ambient-cube": 6}[volume["basis"]]
    slabs, scale = -(-floats // 4), volume["scale"]
    sets = 1 + len(volume["layers"]) + (3 if volume["gradients"] else 0)
    nz = depth // (slabs * sets + 1)
    far = volume["textures"].get("moments")
    tiles = texture(path.parent, far)[3] if far else None
    volume["probes"] = []
    for i in range(volume["count"]):
        x, y, z = i % width, i // width % height, i // width // height
        texel = [values[4 * (i + width * height * nz * s):][:4] for s in range(slabs * sets + 1)]
        flat = sum((texel[s] for s in range(len(texel)) if s != slabs), ())
        parts = [flat[4 * slabs * k:][:floats] for k in range(sets)]
        place = volume["positions"][i] if volume["layout"] == "list" else [
            o + s * k for o, s, k in zip(volume["origin"], volume["spacing"], (x, y, z))]
        probe = {"place": place, "move": texel[slabs][:3], "state": int(texel[slabs][3]),
                 "sets": [[scale * v for v in part] for part in parts]}
        if far:
            first = [((z * 8 * height + 8 * y + j) * width + x) * 16 for j in range(8)]
            rows = [tiles[k:k + 16] for k in first]
            probe["moments"] = [(row[2 * k] * far["reach"], row[2 * k + 1] * far["reach"]**2)
                                for row in rows for k in range(8)]
        volume["probes"].append(probe)
    return volume
