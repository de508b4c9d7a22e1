# SPDX-License-Identifier: MIT
"""Binary glTF 2.0 (.glb): a writer for what a bake needs, and a reader of accessors.

Khronos, glTF 2.0 specification, section 4 "Binary glTF layout"."""

import contextlib
import json
import struct

import numpy

ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963
FORMATS = {5120: numpy.int8, 5121: numpy.uint8, 5122: numpy.int16, 5123: numpy.uint16,
           5125: numpy.uint32, 5126: numpy.float32}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
COMPONENTS = {numpy.dtype(numpy.float32): 5126, numpy.dtype(numpy.uint32): 5125,
              numpy.dtype(numpy.uint8): 5121}


class GlbError(Exception):
    """A .glb that cannot be read. The message names file and fault."""


class Writer:
    """Collects elements of a glTF. Each add_... returns the index of the new element."""

    def __init__(self):
        self.document = {"asset": {"version": "2.0", "generator": "Alpenglow for Blender"},
                         "scene": 0, "scenes": [{"nodes": []}]}
        self.parts = []
        self.size = 0

    def add(self, kind, element):
        """Appends an element to the top-level array `kind`."""
        elements = self.document.setdefault(kind, [])
        elements.append(element)
        return len(elements) - 1

    def use(self, extension):
        used = self.document.setdefault("extensionsUsed", [])
        if extension not in used:
            used.append(extension)

    def add_view(self, data, target=None):
        view = {"buffer": 0, "byteOffset": self.size, "byteLength": len(data)}
        if target is not None:
            view["target"] = target
        data += b"\0" * (-len(data) % 4)
        self.parts.append(data)
        self.size += len(data)
        return self.add("bufferViews", view)

    def add_accessor(self, array, kind, target=ARRAY_BUFFER, bounds=False):
        """array: [n] for SCALAR, [n][k] for VECk; float32, uint32 or uint8."""
        array = numpy.ascontiguousarray(array)
        accessor = {"bufferView": self.add_view(array.tobytes(), target), "count": len(array),
                    "componentType": COMPONENTS[array.dtype], "type": kind}
        if bounds:
            accessor["min"] = array.min(axis=0).tolist()
            accessor["max"] = array.max(axis=0).tolist()
        return self.add("accessors", accessor)

    def write(self, path):
        if self.size:
            self.document["buffers"] = [{"byteLength": self.size}]
        text = json.dumps(self.document, ensure_ascii=False, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        total = 12 + 8 + len(text) + (8 + self.size if self.size else 0)
        if total >= 1 << 32:
            raise GlbError(f"the scene needs {total >> 20} MiB, and a .glb holds 4095 MiB; "
                           "bake a part of it")
        with open(path, "wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, total))
            file.write(struct.pack("<I4s", len(text), b"JSON") + text)
            if self.size:
                file.write(struct.pack("<I4s", self.size, b"BIN\0"))
                for part in self.parts:
                    file.write(part)


def at(number):
    """An index, offset or count of a document."""
    if not isinstance(number, int) or number < 0:
        raise ValueError(f"{number} is no index, offset or count")
    return number


class Reader:
    """The document of a .glb and its binary chunk."""

    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        if len(data) < 20 or data[:4] != b"glTF":
            raise GlbError(f"{path}: not a .glb file")
        self.path = path
        self.document, self.binary = None, b""
        self._read_chunks(data)
        if not isinstance(self.document, dict):
            raise GlbError(f"{path}: has no JSON object; bake again")

    def _read_chunks(self, data):
        start = 12
        while start + 8 <= len(data):
            size, kind = struct.unpack_from("<I4s", data, start)
            chunk = data[start + 8:start + 8 + size]
            if len(chunk) != size:
                raise GlbError(f"{self.path}: ends in the middle of a chunk; bake again")
            if kind == b"JSON":
                try:
                    self.document = json.loads(chunk.decode())
                except ValueError as error:
                    raise GlbError(f"{self.path}: its JSON is broken: {error}; bake again") \
                        from None
            elif kind == b"BIN\0":
                self.binary = chunk
            start += 8 + size

    @contextlib.contextmanager
    def checked(self, part):
        """Gives the name of the file and of a part to faults of what is read inside."""
        try:
            yield
        except (AttributeError, LookupError, TypeError, ValueError) as error:
            fault = f"lacks {error}" if isinstance(error, KeyError) else str(error)
            raise GlbError(f"{self.path}: {part}: {fault}; bake again") from None

    def elements(self, kind):
        return self.document.get(kind, [])

    def view(self, index):
        """The bytes of a buffer view."""
        with self.checked(f"buffer view {index}"):
            view = self.elements("bufferViews")[at(index)]
            start, size = at(view.get("byteOffset", 0)), at(view["byteLength"])
            if start + size > len(self.binary):
                raise ValueError("ends behind the file")
            return self.binary[start:start + size]

    def accessor(self, index):
        """[n][k] numbers; normalized integers come as floats in [0, 1] or [-1, 1]."""
        with self.checked(f"accessor {index}"):
            accessor = self.elements("accessors")[at(index)]
            data = self.view(accessor["bufferView"])
            view = self.elements("bufferViews")[accessor["bufferView"]]
            kind, width = numpy.dtype(FORMATS[accessor["componentType"]]), WIDTHS[accessor["type"]]
            stride = at(view.get("byteStride", width * kind.itemsize))
            array = numpy.ndarray((at(accessor["count"]), width), kind.newbyteorder("<"), data,
                                  at(accessor.get("byteOffset", 0)), (stride, kind.itemsize))
        if accessor.get("normalized", False):
            return numpy.maximum(array / numpy.float32(numpy.iinfo(kind).max), -1)
        return array
