#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Breaks the law of the rooms in every way, one at a time: each fault must be named."""
import pathlib
import sys
import tempfile

root = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(root / "scripts"))
import check_rooms  # noqa: E402

LAWFUL = {
    "src/base/CMakeLists.txt": "a.c",
    "src/base/a.c": '#include "base/a.h"\n#include <pthread.h>\n#include <stdio.h>\n',
    "src/base/a.h": "#include <alpenglow/result.h>\n",
    "src/trace/CMakeLists.txt": "embree.c",
    "src/trace/embree.c": '#include "trace/embree.h"\n',
    "src/trace/embree.h": '#include "base/a.h"\n#include <embree3/rtcore.h>\n',
    "include/alpenglow/result.h": "#include <stdint.h>\n",
    "include/alpenglow/scene.h": "#include <alpenglow/result.h>\n",
    "src/formats/CMakeLists.txt": "load.c\ngltf/gltf_read.c\ngltf/write/gltf_write.c\n",
    "src/formats/load.c": '#include "formats/gltf/write/gltf_patch.h"\n',
    "src/formats/formats.h": "",
    "src/formats/gltf/gltf_read.c": '#include "formats/gltf/gltf_read.h"\n',
    "src/formats/gltf/gltf_read.h": '#include "formats/images/png.h"\n',
    "src/formats/gltf/write/gltf_write.c": '#include "formats/gltf/gltf_read.h"\n',
    "src/formats/gltf/write/gltf_patch.h": "",
    "src/formats/images/png.h": "",
    "apps/tool/main.c": '#include "own.h"\n#include <alpenglow/scene.h>\n#include <jansson.h>\n',
    "apps/tool/own.h": "",
    "apps/tool/parts/part.c": '#include "parts/part.h"\n#include "own.h"\n',
    "apps/tool/parts/part.h": "",
}
UNLAWFUL = [  # file, its text, words of the fault
    ("src/base/a.c", '#include "trace/embree_none.h"\n', "no header of a room"),
    ("src/base/a.h", "\n#include <alpenglow/scene.h>\n", "base may not include <alpenglow/scene.h>"),
    ("src/base/a.c", "#include <embree3/rtcore.h>\n", "may only be included from"),
    ("src/base/a.c", "#include <png.h>\n", "may only be included from src/formats"),
    ("src/base/a.c", "#include <curl/curl.h>\n", "neither of C17 or POSIX"),
    ("src/base/a.c", "#include HEADER\n", "must name its file"),
    ("src/base/b.c", "", "not listed"),
    ("src/base/a.cpp", "", "not listed"),
    ("src/formats/gltf/gltf_read.c", '#include "formats/gltf/write/gltf_patch.h"\n',
     "formats/gltf may not include"),
    ("src/formats/gltf/gltf_read.c", '#include "formats/formats.h"\n', "may use images, files"),
    ("src/formats/images/png.h", '#include "formats/formats.h"\n',
     "formats/images may not include"),
    ("src/formats/gltf/gltf_mesh.c", "", "not listed"),
    ("src/formats/cellar/own.h", "", "is not a room"),
    ("src/formats/viewers/png.h", "", "has the name of src/formats/images/png.h"),
    ("src/trace/embree.c", "#include <pthread.h>\n", "may only be included from src/base"),
    ("src/trace/embree.c", '#include "base/a.c"\n', "is not a header"),
    ("src/maps/m.h", '#include "trace/embree.h"\n', "only trace may include it"),
    ("src/cellar/own.h", "", "is not a room"),
    ("include/alpenglow/result.h", "#include <stdio.h>\n", "public header may not include"),
    ("include/alpenglow/result.h", '#include "base/a.h"\n', "C headers only"),
    ("include/alpenglow/result.h", "#include <alpenglow/scene.h>\n", "belongs to scene"),
    ("include/alpenglow/news.h", "", "not in the table"),
    ("apps/tool/main.c", '#include "base/a.h"\n', "not its own"),
    ("apps/tool/main.c", "#include <png.h>\n", "may only be included from"),
    ("apps/tool/parts/part.c", '#include "part.h"\n', "not its own"),
]


def faults(files):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            path = pathlib.Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        for room in {name.split("/")[1] for name in files if name.startswith("src/")}:
            (pathlib.Path(folder) / "src" / room / "CMakeLists.txt").touch()
        return check_rooms.check(pathlib.Path(folder))


def main():
    check_rooms.check_table()
    wrong = [f"lawful, but: {line}" for line in faults(LAWFUL)]
    above = faults({**LAWFUL, "src/trace/t.h": "", "src/base/a.h": '#include "trace/t.h"\n'})
    through = faults({**LAWFUL, "src/trace/t.h": '#include "trace/embree.h"\n',
                      "src/maps/m.h": '#include "trace/t.h"\n'})
    for name, text, words in UNLAWFUL:
        found = faults({**LAWFUL, name: text})
        if len(found) != 1 or words not in found[0] or not found[0].startswith(name + ":"):
            wrong.append(f"{name} with {text!r}: expected one fault with {words!r}, got {found}")
    if len(above) != 1 or "base may not include" not in above[0]:
        wrong.append(f"a room above was not refused: {above}")
    if len(through) != 1 or "only trace may include it" not in through[0]:
        wrong.append(f"another project through two headers was not refused: {through}")
    print("\n".join(wrong))
    sys.exit(1 if wrong else 0)


main()
