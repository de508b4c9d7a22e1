#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""check_reader.py PROGRAM: lets it write probes and what they hold, and compares what the reader of
docs/manual/probe-format.md in Python, read_probes.py, finds there. 77 = skipped."""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

from read_probes import read_probes


def compare(found, expected, name):
    """Every number that was written, exactly: the made-up values are half floats."""
    assert found["layout"] == expected["layout"] and found["count"] == expected["count"] > 0, name
    assert [layer["name"] for layer in found["layers"]] == expected["layers"], name
    for i, (probe, wanted) in enumerate(zip(found["probes"], expected["probes"], strict=True)):
        for key in ("move", "state", "sets", "moments"):
            value, truth = json.loads(json.dumps(probe.get(key))), wanted.get(key)
            assert value == truth, f"{name}: probe {i}: {key}: {value}, not {truth}"
        for value, truth in zip(probe["place"], wanted["place"], strict=True):
            assert abs(value - truth) <= 1e-7 * max(1.0, abs(truth)), f"{name}: probe {i}: place"
    return len(found["probes"])


def main():
    if shutil.which("zstd") is None:
        print("zstd is absent: skipped")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.argv[1], folder], check=True)
        files = sorted(pathlib.Path(folder).glob("*.probes.json"))
        probes = sum(compare(read_probes(path), json.loads(
            path.with_name(path.name.replace(".probes.", ".expected.")).read_text("utf-8")),
            path.name) for path in files)
    print(f"{len(files)} volumes, {probes} probes, every number as it was written")
    assert len(files) == 6


main()
