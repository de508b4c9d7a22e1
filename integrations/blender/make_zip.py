#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""make_zip.py OUT.zip: the add-on as Blender installs it. Equal files give equal bytes."""
import os
import pathlib
import sys
import zipfile

FOLDER = pathlib.Path(__file__).resolve().parent


def main(out):
    part = f"{out}.part"
    with zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED) as archive:
        folder = FOLDER / "alpenglow_blender"
        for path in sorted([*folder.glob("*.py"), folder / "blender_manifest.toml"]):
            entry = zipfile.ZipInfo(f"alpenglow_blender/{path.name}", (1980, 1, 1, 0, 0, 0))
            entry.external_attr = 0o644 << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, path.read_bytes())
        licence = zipfile.ZipInfo("alpenglow_blender/LICENSE", (1980, 1, 1, 0, 0, 0))
        licence.external_attr = 0o644 << 16
        archive.writestr(licence, (FOLDER.parent.parent / "LICENSE").read_bytes())
    os.replace(part, out)


if len(sys.argv) != 2:
    sys.exit("usage: make_zip.py OUT.zip")
main(sys.argv[1])
