#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Puts texts and measured tables together, for scripts/make_docs.sh.

    make_tables.py text NAME          prints the text `# NAME` of scripts/captions.md
    make_tables.py captions           copies a bench's Markdown, each table with its caption
    make_tables.py goals WALL         a table of the goals of ambience, met or missed, from its bench's
                                      Markdown and the figure behind a thin wall
    make_tables.py peers              copies the tables of scripts/peer_speed.py, each with its caption
    make_tables.py readme PEERS DOC   writes the table of DOC between its markers, from that page

Captions stand below `### TITLE of the table`. A table without one keeps the bench's own text.
"""
import pathlib
import re
import sys

CAPTIONS = pathlib.Path(__file__).resolve().parent / "captions.md"
README_LIGHT = ["cornell", "sphere_plane", "teapot-room", "living_room"]
README_OCCLUSION = "builtin:teapot-room"


def texts():
    """Texts of captions.md by their headings, without them."""
    found, name = {}, None
    for line in CAPTIONS.read_text(encoding="utf-8").splitlines():
        if re.match(r"(#|###) ", line):
            name = line.lstrip("# ")
            found[name] = []
        elif name:
            found[name].append(line)
    return {name: "\n".join(lines).strip() for name, lines in found.items()}


def add_captions(lines):
    captions, skipping, blank = texts(), False, True
    for line in lines:
        line = line.rstrip()
        if line.startswith("### "):
            caption = captions.get(line[4:])
            print(f"{line}\n\n{caption}\n" if caption else line)
            skipping, blank = caption is not None, caption is not None
            continue
        skipping = skipping and not line.startswith("|")
        if not skipping and not (blank and not line):
            print(line)
            blank = not line


def add_peer_captions(lines):
    captions = texts()
    for line in lines:
        line = line.rstrip()
        title = {"| scene |": "Occlusion", "| light |": "Light"}.get(line[:9])
        if title:
            print(f"\n## {title}\n\n{captions[title]}\n")
        if line.startswith("|"):
            print(line)


def cells(line):
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def readme_rows(page):
    light, occlusion = {}, {}
    table = None
    for line in page.splitlines():
        if line.startswith("| scene |"):
            table = occlusion
        elif line.startswith("| light |"):
            table = light
        elif line.startswith("| ") and table is not None:
            table[cells(line)[0]] = cells(line)
    for name in README_LIGHT:
        if name in light:
            c = light[name]
            yield [f"`{name}`, light", c[2].replace("%", " %"), c[6] + " s", c[5] + " s", c[7]]
    if README_OCCLUSION in occlusion:
        c = occlusion[README_OCCLUSION]
        yield ["`teapot-room`, occlusion", c[1], c[6] + " s", c[2] + " s", c[7]]


def write_readme(page, document):
    rows = list(readme_rows(page.read_text(encoding="utf-8")))
    table = "".join(f"| {' | '.join(row)} |\n" for row in rows)
    begin, end = "<!-- table peers -->\n", "<!-- end peers -->"
    whole = document.read_text(encoding="utf-8")
    head, rest = whole.split(begin, 1)
    header = "| scene | error of the mean | ours | Cycles | times |\n|---|--:|--:|--:|--:|\n"
    document.write_text(head + begin + "\n" + header + table + "\n" + end + rest.split(end, 1)[1],
                        encoding="utf-8")


def rows_of(lines):
    """The rows of all tables of a bench, by title: each a dictionary by column."""
    tables, title, names = {}, None, None
    for line in lines:
        if line.startswith("### "):
            title, names = line[4:].strip(), None
        elif line.startswith("|") and title:
            if names is None:
                names = cells(line)
            elif not line.startswith(("|:", "|-")):
                tables.setdefault(title, []).append(dict(zip(names, cells(line))))
    return tables


def number(text):
    return float(text.replace(",", ""))


def goals(tables, wall):
    """Each goal, the least or most that it wants, and each figure that it is held against."""
    anchors = tables["Anchors, one worker, anchors/s"]
    lookups = tables["Look-ups, one thread, µs a point"]
    kept = {r["way"]: r for r in tables["Anchors kept current, one worker, ms a frame"]}
    ours = next(r for r in tables["Models along three flights, error in %"] if r["model"] == "ours")
    ended = tables["Bytes an anchor after a flight"]
    jumps = tables["Changes from frame to frame"][0]
    steps = tables["Steps along a line of 20 m"][0]
    upkeep = "Kept current in 2 ms a frame: ms for 1,000 anchors, "
    for row in anchors:
        yield f"Sampled, of the raw packets, {row['scene']}", "≥", .6, [row["ratio"]]
    for row in anchors:
        two = f"{2 * number(row['traced']):.0f}"
        yield f"Sampled, anchors/s, twice one worker, {row['scene']}", "≥", 6000, [two]
    for row in anchors:
        yield f"Relit, of sampled, {row['scene']}", "≥", 2, [row["traced / relit"]]
    for way in kept:
        yield upkeep + way, "≤", 2, [kept[way]["per 1,000"]]
    yield "Look-up, µs, the slowest", "≤", .5, [max((r["ours"] for r in lookups), key=number)]
    yield "Bytes an anchor, at the end of each flight", "≤", 1000, [r["bytes then"] for r in ended]
    yield "Bytes an anchor, after 5 s of rest", "≤", 1000, [r["bytes"] for r in ended]
    yield "Error at 30 m/s, %, each flight", "≤", 10, [ours[f"flying {k}"] for k in "123"]
    yield "Error after 5 s of rest, %, each flight", "≤", 5, [ours[f"after {k}"] for k in "123"]
    yield "Largest change in a frame of a flight, % of the mean", "≤", 1, [jumps["largest, %"]]
    yield "Largest change in 1 mm of a line, % of the mean", "≤", .1, [steps["largest step, %"]]
    yield "Largest change in 1 mm behind a thin wall, % of the mean", "≤", .1, [wall]


def print_goals(lines, wall):
    print("| figure | goal | measured | |\n|:---|---:|---:|:---|")
    for name, sign, bound, figures in goals(rows_of(lines), wall):
        held = all(number(f) >= bound if sign == "≥" else number(f) <= bound for f in figures)
        print(f"| {name} | {sign} {bound:,} | {', '.join(figures)} | {'met' if held else 'missed'} |")


def main():
    if sys.argv[1:2] == ["text"] and len(sys.argv) == 3:
        print(texts()[sys.argv[2]])
    elif sys.argv[1:] == ["captions"]:
        add_captions(sys.stdin)
    elif sys.argv[1:2] == ["goals"] and len(sys.argv) == 3:
        print_goals(sys.stdin, sys.argv[2])
    elif sys.argv[1:] == ["peers"]:
        add_peer_captions(sys.stdin)
    elif sys.argv[1:2] == ["readme"] and len(sys.argv) == 4:
        write_readme(pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]))
    else:
        sys.exit(__doc__)


main()
