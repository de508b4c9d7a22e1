#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Every test file is listed in a CMakeLists.txt, or it would never run; and every test of the house."""
import pathlib
import re
import sys

root = pathlib.Path(__file__).resolve().parent.parent
listed = {}
for cmake in root.rglob("CMakeLists.txt"):
    for name in re.findall(r"^alp_add_test\(([\w/]+)", cmake.read_text(encoding="utf-8"), re.M):
        listed[cmake.parent / f"{name}.c"] = cmake
house = (root / "house" / "CMakeLists.txt").read_text(encoding="utf-8")

faults, seen = [], 0
for path in sorted(root.rglob("*.c")):
    if path.parent == root / "support" or "node_modules" in path.parts:
        continue
    if re.search(r"^TEST[A-Z_]*\(", path.read_text(encoding="utf-8"), re.M):
        seen += 1
        if path not in listed:
            faults.append(f"{path.relative_to(root)}: no alp_add_test in a CMakeLists.txt names it")
for path in sorted((root / "house").glob("test_*.py")):
    if path.stem not in re.split(r"[\s()]+", house):
        faults.append(f"{path.relative_to(root)}: house/CMakeLists.txt does not name it")
if seen < 150:  # there are about 200
    faults.append(f"only {seen} test files seen; does the macro have another name?")
print("\n".join(faults))
sys.exit(1 if faults else 0)
