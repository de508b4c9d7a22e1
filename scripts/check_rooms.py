#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks the law of the rooms: who may include what.

    scripts/check_rooms.py [FOLDER]     the tree to check; default: this one

Prints one line per fault, "file:line: what is wrong", and exits with 1 if there is any. The table
below is the law; CONTRIBUTING.md says it in words. A room is a folder of src/. Rooms stand in the
order in which they build on each other, so the law has no cycles.
"""
import pathlib
import re
import sys

# room: rooms whose headers it may include besides its own
ROOMS = {
    "base": [],
    "sh": ["base"],
    "film": ["base"],
    "scene": ["sh", "base"],
    "formats": ["scene", "sh", "base"],
    "trace": ["scene", "base"],
    "atlas": ["scene", "base"],
    "transport": ["trace", "scene", "sh", "base"],
    "maps": ["transport", "atlas", "trace", "scene", "sh", "base"],
    "fields": ["transport", "maps", "trace", "scene", "sh", "base"],
    "render": ["fields", "maps", "transport", "trace", "scene", "film", "sh", "base"],
    "doctor": ["render", "maps", "transport", "atlas", "trace", "formats", "scene", "film", "sh",
               "base"],
    "bake": ["doctor", "render", "fields", "maps", "transport", "atlas", "trace", "formats", "scene",
             "film", "sh", "base"],
    "ranks": ["base"],
    "report": ["bake", "doctor", "render", "fields", "maps", "transport", "atlas", "trace", "formats",
               "scene", "film", "sh", "base"],
}

# room: its sub-rooms and the sub-rooms of the same room whose headers each may include. "." stands
# for the headers that lie in the room itself. Sources that lie in the room itself may include all of
# its headers: they put the sub-rooms together. Where "." stands last, its headers collect those of
# the sub-rooms for other rooms.
SUB_ROOMS = {
    "base": {".": [], "tiles": ["."]},
    "formats": {
        "text": [],
        "polygon": [],
        "files": ["text"],
        "images": [],
        "gltf": ["images", "files", "text"],
        "gltf/write": ["gltf", "images", "files", "text"],
        "collada": ["images", "files", "polygon", "text"],
        "collada/write": ["collada", "files", "text"],
        "obj": ["images", "files", "polygon", "text"],
        "viewers": ["images", "files", "text"],
        "probes": ["images", "text"],
        ".": ["probes", "viewers", "obj", "collada/write", "collada", "gltf/write", "gltf", "images"],
    },
    "scene": {".": [], "sky": ["."], "lights": ["sky", "."], "builtin": ["."]},
    "transport": {
        ".": [],
        "paths": ["."],
        "occlusion": ["."],
        "direct": ["occlusion", "paths", "."],
        "gather": ["paths", "."],
        "sphere": ["gather", "paths", "."],
    },
    "maps": {
        "texels": [],
        ".": ["texels"],
        "radiosity": ["texels", "."],
        "seams": ["texels", "."],
        "vertex": ["."],
    },
    "fields": {".": [], "ambient": ["."], "probes": ["."], "ambience": ["."],
               "propagation": ["."]},
    "bake": {".": [], "occlusion": ["."], "light": ["."], "files": ["."],
             "estimate": ["files", "light", "."]},
}

# public header: the lowest room that may include it, which stands for it in the law
PUBLIC = {
    "export": "base", "version": "base", "result": "base", "context": "base", "image": "base",
    "ranks": "base", "checkpoint": "base",
    "sh": "sh", "shared_constants": "base", "display": "film", "film": "film", "geometry": "scene",
    "light": "scene", "scene": "scene", "atlas": "atlas", "occlusion": "transport", "lightmap": "maps",
    "field": "fields", "probes": "fields", "ambience": "fields", "lpv": "fields", "render": "render",
    "doctor": "doctor", "bake": "bake", "report": "report", "compare": "report", "alpenglow": "report",
}

# header of another project: where it may be included (a folder below src/, "apps", or one file)
THIRD_PARTY = {
    r"embree3/.*": ["src/trace/embree.h", "bench"],
    r"jansson\.h": ["src/formats", "src/bake/files", "apps"],
    r"png\.h": ["src/formats"],
    r"jpeglib\.h|jerror\.h": ["src/formats"],
    r"(OpenEXR/)?openexr.*\.h": ["src/formats"],
    r"zlib\.h": ["src/formats"],
    r"libxml/.*\.h": ["src/formats"],
    r"zstd\.h": ["src/formats"],
    # It decodes files, and simplifies scenes for samplers, which may not include formats.
    r"meshoptimizer\.h": ["src/formats", "src/scene/simplify.c"],
    r"webp/.*": ["src/formats"],
    # The one file of C++, and what that language brings.
    r"draco/.*|cstdio|exception|memory|new": ["src/formats/gltf/draco_mesh.cpp"],
    # The viewer is a host, whose threads look fields up.
    r"pthread\.h": ["src/base", "apps/viewer/field_points.c"],
    r"epoxy/.*": ["apps/viewer"],
    r"mpi\.h": ["src/ranks", "apps/ranks"],
}

# of C17 and POSIX
SYSTEM = set(
    "assert ctype dlfcn errno fcntl float inttypes limits locale math setjmp signal stdalign stdarg "
    "stdatomic stdbool stddef stdint stdio stdlib string strings time unistd dirent getopt sched "
    "sys/file sys/ioctl sys/mman sys/resource sys/stat sys/time sys/types sys/wait termios".split())
SYSTEM_OF_PUBLIC_HEADERS = {"stdbool", "stddef", "stdint"}

INCLUDE = re.compile(r"\s*#\s*include\b\s*(.*)")
TARGET = re.compile(r'(?:<([^>]+)>|"([^"]+)")')


def includes(path):
    """(line number, angled target or None, quoted target or None) of each include of a file."""
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if match:
            target = TARGET.match(match[1])
            yield number, target[1] if target else None, target[2] if target else None


def may_use(room, other):
    return other == room or other in ROOMS[room]


def sub_room(room, parts):
    """The sub-room of a file below src/ROOM, "." for the room itself; None where it is not listed."""
    sub = "/".join(parts) or "."
    return sub if sub == "." or sub in SUB_ROOMS.get(room, {}) else None


def fault_of_sub_room(place, room, target):
    """Fault of including "target" of the same room from another of its sub-rooms."""
    mine = sub_room(room, place.split("/")[2:-1])
    other = sub_room(room, target.split("/")[1:-1])
    if other is None:
        return f'"{target}" lies in a folder that is no sub-room of {room}'
    if mine == other or (mine == "." and not place.endswith(".h")):
        return None
    allowed = SUB_ROOMS[room][mine]
    if other in allowed:
        return None
    return f'{room}/{mine} may not include "{target}": it may use {", ".join(allowed) or "none"}'


def fault_of_public(name, room):
    """Fault of including <alpenglow/name.h> from a room (None: from an app, which may)."""
    if name not in PUBLIC:
        return f"<alpenglow/{name}.h> is not in the table of public headers"
    if room and not may_use(room, PUBLIC[name]):
        return f"{room} may not include <alpenglow/{name}.h>, which belongs to {PUBLIC[name]}"
    return None


def fault_of_system(target, place):
    """Fault of including <target>, which is not ours, from a file (path from the root)."""
    for pattern, places in THIRD_PARTY.items():
        if re.fullmatch(pattern, target):
            if any(place == allowed or place.startswith(allowed + "/") for allowed in places):
                return None
            return f"<{target}> may only be included from {', '.join(places)}"
    if target.removesuffix(".h") not in SYSTEM:
        return f"<{target}> is neither of C17 or POSIX nor in the table of third parties"
    return None


def brings_third_party(root, target):
    """Whether a header of a room includes one of another project, or another header that does."""
    waiting, seen = [target], set()
    while waiting:
        header = waiting.pop()
        if header in seen or not (root / "src" / header).is_file():
            continue
        seen.add(header)
        for _, angled, quoted in includes(root / "src" / header):
            if angled and any(re.fullmatch(pattern, angled) for pattern in THIRD_PARTY):
                return True
            waiting += [quoted] if quoted else []
    return False


def fault_of_quoted(root, place, room, target):
    """Fault of including "target" from a file of a room (None: of an app)."""
    if place.startswith("bench/"): # any header of ours
        known = (root / place).parent / target, root / "src" / target
        return None if any(p.is_file() for p in known) else f'there is no "{target}"'
    if room is None:
        own = root / "/".join(place.split("/")[:2]) / target # written from the app's folder
        parts = root / "apps/alpenglow" / target # of the command, which other programs have too
        ranks = place.startswith("apps/ranks/") and target.startswith("ranks/")
        known = own.is_file() or parts.is_file() or (ranks and (root / "src" / target).is_file())
        return None if known else f'an app may not include "{target}": it is not its own'
    other = target.split("/")[0]
    if not target.endswith(".h"):
        return f'"{target}" is not a header'
    if other not in ROOMS or not (root / "src" / target).is_file():
        return f'"{target}" is no header of a room (write it from src/, as "room/name.h")'
    if not may_use(room, other):
        return f'{room} may not include "{target}": it may use {", ".join(ROOMS[room]) or "none"}'
    if other == room and room in SUB_ROOMS:
        return fault_of_sub_room(place, room, target)
    if other != room and brings_third_party(root, target):
        return f'"{target}" brings in another project: only {other} may include it'
    return None


def faults_of_file(root, path):
    place = path.relative_to(root).as_posix()
    parts = place.split("/")
    if parts[0] == "src" and (parts[1] not in ROOMS or sub_room(parts[1], parts[2:-1]) is None):
        yield 1, f"{'/'.join(parts[1:-1]) or 'src'} is not a room"
        return
    room = parts[1] if parts[0] == "src" else None
    if parts[0] == "include":
        room = PUBLIC.get(path.name.removesuffix(".in").removesuffix(".h"))
        if room is None:
            yield 1, "this public header is not in the table"
            return
    for number, angled, quoted in includes(path):
        if angled is None and quoted is None:
            fault = "an include must name its file"
        elif quoted is not None:
            fault = (fault_of_quoted(root, place, room, quoted) if parts[0] != "include"
                     else "a public header includes <alpenglow/...> and C headers only")
        elif angled.startswith("alpenglow/"):
            fault = fault_of_public(angled[len("alpenglow/"):].removesuffix(".h"), room)
        elif parts[0] == "include":
            known = angled.removesuffix(".h") in SYSTEM_OF_PUBLIC_HEADERS
            fault = None if known else f"a public header may not include <{angled}>"
        else:
            fault = fault_of_system(angled, place)
        if fault:
            yield number, fault


def unlisted_files(root):
    """Sources that their room's CMakeLists.txt does not name, and so nobody compiles."""
    for room in ROOMS:
        folder = root / "src" / room
        sources = sorted([*folder.rglob("*.c"), *folder.rglob("*.cpp")])
        text = (folder / "CMakeLists.txt").read_text(encoding="utf-8") if sources else ""
        listed = set(re.findall(r"[\w./]+\.(?:cpp|c)\b", text))
        for path in sources:
            if path.relative_to(folder).as_posix() not in listed:
                yield path, 1, "is not listed in its room's CMakeLists.txt"


def repeated_names(root):
    """Files of the library whose name another file of it has too."""
    first = {}
    for path in sorted((root / "src").rglob("*")):
        if path.suffix in (".c", ".h", ".cpp") and first.setdefault(path.name, path) != path:
            yield path, 1, f"has the name of {first[path.name].relative_to(root)}"


def check(root):
    """All faults of a tree, as lines."""
    lines = []
    for folder in ("src", "include", "apps", "bench", "examples"):
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in (".c", ".h", ".cpp") or path.name.endswith(".h.in"):
                for number, fault in faults_of_file(root, path):
                    lines.append(f"{path.relative_to(root)}:{number}: {fault}")
    for path, number, fault in [*unlisted_files(root), *repeated_names(root)]:
        lines.append(f"{path.relative_to(root)}:{number}: {fault}")
    return lines


def check_table():
    """The law itself: every room, and every sub-room, builds on those that stand before it."""
    for table in (ROOMS, *SUB_ROOMS.values()):
        seen = set()
        for room, allowed in table.items():
            assert set(allowed) <= seen, f"{room} may include a room above it"
            seen.add(room)


def main():
    here = pathlib.Path(__file__).resolve().parent.parent
    root = pathlib.Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else here
    check_table()
    lines = check(root)
    print("\n".join(lines) if lines else "rooms: every include is lawful")
    sys.exit(1 if lines else 0)


if __name__ == "__main__":
    main()
