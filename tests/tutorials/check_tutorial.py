#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Runs every command of a tutorial, in order, and compares what it prints.

    check_tutorial.py TUTORIAL.md PREFIX [WRAPPER ...]

PREFIX holds an installed alpenglow. WRAPPER runs the shell, such as a script that starts Slurm.
A tutorial is Markdown. A fence of `sh` holds commands. A fence of `text` after it holds lines that
these commands print, in this order; … stands for anything, and alone in a line for any lines. Any
other fence after a line of the form `NAME`: is the file NAME.

The commands see an empty folder, a HOME with the clone as ~/alpenglow, and the installed command.
Exit status: 0 good, 1 not, 77 skipped by WRAPPER.
"""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]


def read(path):
    """Steps of a tutorial: (kind, line, name, text), kind one of "sh", "text" and "file"."""
    steps, fence, name = [], None, None
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if fence is not None:
            if line == "```":
                steps.append((*fence, "".join(body)))
                fence, name = None, None
            else:
                body.append(line + "\n")
        elif line.startswith("```"):
            kind = line[3:]
            if kind not in ("sh", "text"):
                if name is None:
                    raise ValueError(f"{path.name}:{number}: no `NAME`: before a fence of {kind!r}")
                kind = "file"
            fence, body = (kind, number, name), []
        elif re.fullmatch(r"`[\w.-]+`:", line):
            name = line[1:-2]
    if fence is not None:
        raise ValueError(f"{path.name}:{fence[1]}: this fence has no end")
    return steps


def write_script(steps, folder):
    """The commands as one shell script. The output of step N goes to the file N.out."""
    script = ["set -euo pipefail"]
    for number, (kind, _, name, text) in enumerate(steps):
        if kind == "sh":
            script += [f"exec >{folder}/{number}.out 2>&1", f"echo {number} >{folder}/reached", text]
        elif kind == "file":
            content = folder / f"{number}.file"
            content.write_text(text, encoding="utf-8")
            script.append(f"cp {content} {name}")
    path = folder / "script"
    path.write_text("\n".join(script), encoding="utf-8")
    return path


def find_missing(expected, printed):
    """The first expected line that `printed` lacks, or None."""
    lines, at, strict = printed.splitlines(), 0, False
    for wanted in expected.splitlines():
        if wanted == "…":
            strict = False
            continue
        pattern = re.compile(".*".join(re.escape(part) for part in wanted.split("…")))
        found = next((i for i in range(at, len(lines)) if pattern.fullmatch(lines[i])), None)
        if found is None or (strict and found != at):
            return wanted
        at, strict = found + 1, True
    return None


def main():
    tutorial, prefix, wrapper = Path(sys.argv[1]), Path(sys.argv[2]).resolve(), sys.argv[3:]
    steps = read(tutorial)
    if not any(kind == "sh" for kind, *_ in steps):
        print(f"{tutorial.name}: no commands")
        return 1
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for sub in ("home", "work", "steps"):
            (folder / sub).mkdir()
        (folder / "home/alpenglow").symlink_to(SOURCE)
        script = write_script(steps, folder / "steps")
        libraries = next(prefix.glob("lib*/**/pkgconfig")).parent
        environment = {**os.environ, "HOME": str(folder / "home"), "LC_ALL": "C.UTF-8",
                       "PATH": f"{prefix}/bin:{os.environ['PATH']}",
                       "LD_LIBRARY_PATH": str(libraries),
                       "PKG_CONFIG_PATH": f"{libraries}/pkgconfig"}
        status = subprocess.run([*wrapper, "bash", str(script)], cwd=folder / "work", check=False,
                                env=environment).returncode
        if status == 77:
            return 77
        printed = ""
        for number, (kind, line, _, text) in enumerate(steps):
            place = f"{tutorial.name}:{line}"
            if kind == "sh":
                output = folder / f"steps/{number}.out"
                printed = output.read_text(encoding="utf-8") if output.exists() else ""
                reached = int((folder / "steps/reached").read_text())
                if status != 0 and reached == number:
                    print(f"{place}: the commands end with {status}:\n{text}{printed}")
                    return 1
            elif kind == "text":
                missing = find_missing(text, printed)
                if missing is not None:
                    print(f"{place}: no such line, or not here: {missing}\nbut:\n{printed}")
                    return 1
    print(f"{tutorial.name}: good")
    return 0


if __name__ == "__main__":
    sys.exit(main())
