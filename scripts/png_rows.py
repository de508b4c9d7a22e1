# SPDX-License-Identifier: MIT
"""PNG files as lists of rows of RGB bytes, for the scripts that put pictures side by side."""
import struct
import zlib


def read_png(path):
    """Rows of an 8-bit RGB or RGBA picture, as RGB."""
    data = open(path, "rb").read()
    at, packed, width, height, kind = 8, b"", 0, 0, 0
    while at < len(data):
        length, name = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + length]
        if name == b"IHDR":
            width, height, _, kind = struct.unpack(">IIBB", body[:10])
        elif name == b"IDAT":
            packed += body
        at += 12 + length
    channels = {0: 1, 2: 3, 4: 2, 6: 4}[kind]
    raw, stride, rows = zlib.decompress(packed), width * channels, []
    above = bytes(stride)
    for y in range(height):
        line = bytearray(raw[y * (stride + 1) + 1 : (y + 1) * (stride + 1)])
        unfilter(raw[y * (stride + 1)], line, above, channels)
        above = bytes(line)
        color = channels > 2
        rows.append(b"".join(
            line[i : i + 3] if color else line[i : i + 1] * 3 for i in range(0, stride, channels)))
    return rows


def unfilter(kind, line, above, step):
    """PNG's five filters, in place."""
    for i in range(len(line)):
        left = line[i - step] if i >= step else 0
        up, corner = above[i], above[i - step] if i >= step else 0
        guess = left + up - corner
        near = min((abs(guess - left), 0, left), (abs(guess - up), 1, up),
                   (abs(guess - corner), 2, corner))[2]
        line[i] = (line[i] + (0, left, up, (left + up) // 2, near)[kind]) & 255


def filtered(row, above):
    """A row by the one of PNG's first three filters that leaves the smallest differences."""
    left = bytes((a - b) & 255 for a, b in zip(row, b"\0\0\0" + row))
    up = bytes((a - b) & 255 for a, b in zip(row, above))
    kinds = enumerate((row, left, up))
    kind, best = min(kinds, key=lambda one: sum(min(b, 256 - b) for b in one[1]))
    return bytes([kind]) + best


def write_png(path, rows):
    def chunk(name, body):
        return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))

    above = bytes(len(rows[0]))
    raw = b"".join(filtered(row, before) for row, before in zip(rows, [above, *rows]))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        file.write(chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]) // 3, len(rows), 8, 2, 0, 0, 0)))
        file.write(chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))
