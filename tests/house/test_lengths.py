#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Files of at most 600 lines, functions of at most 60 with their head (CONTRIBUTING, "Names and form")."""
import pathlib
import re
import sys

FILE_LINES, FUNCTION_LINES = 600, 60
root = pathlib.Path(__file__).resolve().parent.parent.parent


def functions(lines):
    """(first line from 1, name, lines) of every function of a formatted file: braces in column 0."""
    head = start = None
    for number, line in enumerate(lines, 1):
        if start is None and line[:1].isalpha() and not line.startswith(("typedef", "#")):
            head = head or number  # a head of several lines is indented from the second on
        if line == "{" and head:
            start = head
        elif line in ("}", "} // namespace") and start:
            name = re.sub(r"^TEST\w*\((\w+).*", r"\1", lines[start - 1])
            name = name.split("(")[0].split()[-1].lstrip("*")
            yield start, name, number - start + 1
            head = start = None
        elif line.endswith(";") and start is None:
            head = None


def faults(name, text):
    lines = text.splitlines()
    if len(lines) > FILE_LINES:
        yield f"{name}: {len(lines)} lines, of at most {FILE_LINES}; part it by ideas"
    for first, function, count in functions(lines):
        if count > FUNCTION_LINES:
            yield (f"{name}:{first}: {function}: {count} lines, of at most {FUNCTION_LINES}; "
                   "give a part of it a name")


def function_of(lines):
    return "static void\nf(\n    int a)\n{\n" + "    g();\n" * (lines - 5) + "}\n"


def check_itself():
    table = "static const int t[] = {\n" + "    1,\n" * 100 + "};\n"
    struct = "typedef struct s {\n" + "    int a;\n" * 100 + "} s;\n"
    declared = "int g(void);\n\n/// words\n"
    assert not list(faults("a.c", table + struct + declared + function_of(60)))
    assert len(list(faults("a.c", table + struct + declared + function_of(61)))) == 1
    assert not list(faults("a.c", "\n" * 600)) and len(list(faults("a.c", "\n" * 601))) == 1


check_itself()
found, seen = [], 0
for folder in ("src", "include", "apps", "bench", "examples", "tests"):
    for path in sorted((root / folder).rglob("*")):
        if path.suffix in (".c", ".h", ".cpp") and "node_modules" not in path.parts:
            text = path.read_text(encoding="utf-8")
            seen += len(list(functions(text.splitlines())))
            found += faults(path.relative_to(root), text)
if seen < 1000:  # there are thousands: it would look past all of them otherwise
    found.append(f"only {seen} functions seen; is the law of the format another?")
print("\n".join(found))
sys.exit(1 if found else 0)
