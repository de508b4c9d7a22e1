#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The manual pages: nothing that roff warns of, nothing lost on the way, examples that run.

    check_manual.py warnings ALPENGLOW   groff and mandoc, as far as they are here, find no fault
    check_manual.py text ALPENGLOW       what --help all says of options stands in the page, letter by letter
    check_manual.py examples ALPENGLOW   every example runs, made small

Exit status: 0 good, 1 not, 77 no program that shows pages is there.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

SECTIONS = ["NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "EXIT STATUS", "FILES", "ENVIRONMENT",
            "EXAMPLES", "SEE ALSO"]
# Every line is long enough for a paragraph, so that nothing is hyphenated.
SHOW = {
    "groff": ["groff", "-man", "-Tutf8", "-ww", "-rLL=9999n", "-P-cbou"],
    "mandoc": ["mandoc", "-Tutf8", "-Owidth=900"],
}
# An example that runs is an example; how fine it bakes is not what is tested.
SMALL = {"bake": "--size 32 --ao-samples 4 -q -f", "render": "--resolution 32x18 --samples 1 -q -f",
         "ambience": "--fps 1 --budget 8 --time 2 --errors off -q -f", "bench": "--quick",
         "lpv": "--grid 8 -q -f", "merge": "-q -f",
         "view": "--size 32 --texel-samples 4 --resolution 32x18 -q -f"}


def run(command, **options):
    return subprocess.run(command, capture_output=True, text=True, check=False,
                          env={**os.environ, "LC_ALL": "C.UTF-8"}, **options)


def pages(command):
    """(name, roff) of every page."""
    yield "alpenglow", run([command, "--man"]).stdout
    for name in run([command, "--commands"]).stdout.split():
        yield f"alpenglow-{name}", run([command, "--man", name]).stdout


def programs():
    found = [name for name in SHOW if shutil.which(name)]
    if not found:
        print("neither groff nor mandoc is here")
        sys.exit(77)
    return found


def check_warnings(command):
    for name, page in pages(command):
        if not page.isascii():
            yield f"{name}: not ASCII, which a plain roff does not take; write it in letters"
        for program in programs():
            asked = ["mandoc", "-Tlint", "-Wwarning"] if program == "mandoc" else SHOW[program]
            said = run(asked, input=page)
            lines = (said.stdout if program == "mandoc" else said.stderr).splitlines()
            # Pages have no date, so that a build on another day is the same build.
            lines = [line for line in lines if "missing date" not in line]
            if lines or (program != "mandoc" and said.returncode != 0):
                yield f"{name}: {program}: {lines}"


def flat(text):
    """Text without fonts and line breaks, all blanks alike."""
    text = re.sub(r".\x08", "", text).replace("\u2010", "-").replace("\u2212", "-")
    return re.sub(r"\s+", " ", text)


def paragraphs(text):
    """What --help all says: each line that begins an option, and each paragraph under one."""
    paragraph = ""
    for line in text.split("\nNot built yet")[0].splitlines():
        if re.match(r" {8}\S", line) and not line.lstrip().startswith(("Range ", "Default ")):
            paragraph += " " + line.strip()
            continue
        if paragraph:
            yield paragraph.strip()
        paragraph = ""
        if line.strip() and not line.startswith("  builtin:"):
            yield line.strip()
    if paragraph:
        yield paragraph.strip()


def check_text(command):
    for name, page in pages(command):
        titles = re.findall(r"^\.SH (.*)$", page, re.MULTILINE)
        if [title for title in titles if title != "COMMANDS"] != SECTIONS:
            yield f"{name}: has the sections {titles}"
        if name == "alpenglow":
            continue
        said = run([command, name.split("-")[1], "--help", "all"]).stdout
        options = said[re.search(r"\n[A-Z][a-z ]+:\n", said).start():].split("\nSCENE is")[0]
        options = options.split("\nExit status")[0]
        for program in programs():
            shown = flat(run(SHOW[program], input=page).stdout)
            for wanted in paragraphs(options):
                if flat(wanted).rstrip(":") not in shown:
                    yield f"{name}: {program} does not show {wanted!r}"


def check_examples(command):
    count = 0
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.dirname(command) + os.pathsep + os.environ["PATH"]
        script = 'PATH=$1; alpenglow bake builtin:cornell -o scene.glb --maps-dir maps --size 32 -q'
        script += '; alpenglow bake builtin:cornell -o part.glb --size 32 -q --checkpoint work --shard 1/1'
        script += '; alpenglow render builtin:cornell --with albedo --resolution 8x4 -q -o sky.hdr'
        run(["bash", "-c", script, "bash", path], cwd=folder)
        for name, page in [*list(pages(command))[1:], next(pages(command))]:
            for text in re.findall(r"^\.nf\n(.*)\n\.fi$", page, re.MULTILINE):
                line = text.replace("\\-", "-").replace("\\(aq", "'").replace("\\(dq", '"')
                if line.startswith("alpenglow bench") and "--scene" not in line:
                    continue  # it measures for minutes; small: cli/bench/quick.sh
                words = line.split()
                small = SMALL.get(words[1], "") if words[0] == "alpenglow" else ""
                said = run(["bash", "-c", f"PATH=$1; {line} {small}", "bash", path], cwd=folder)
                if "built without it" in said.stderr:
                    continue  # no three.js was there, so there is no page
                count += 1
                # A busy machine shows the progress of what is quick elsewhere.
                errors = re.sub(r"^\w+ +\d+ %.*\n", "", said.stderr, flags=re.MULTILINE)
                if said.returncode != 0 or errors:
                    yield f"{name}: {line}: exit status {said.returncode}: {errors}"
    if count < 8:
        yield f"only {count} examples were found"


def main():
    check = {"warnings": check_warnings, "text": check_text, "examples": check_examples}
    faults = list(check[sys.argv[1]](os.path.abspath(sys.argv[2])))
    print("\n".join(faults) if faults else f"{sys.argv[1]}: good")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
