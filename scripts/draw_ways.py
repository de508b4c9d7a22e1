#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws the ways from file to map: docs/pictures/way-*.svg.

    scripts/draw_ways.py [FOLDER]     default: docs/pictures of this tree

Each step is a box, with the file below it that does it. Fails if such a file does not exist.
"""
import html
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
WIDTH, BOX, GAP, HEIGHT, ROW = 150, 40, 22, 70, 134

# way: boxes of a row, and steps in their order: (words, file below src/)
WAYS = {
    "light": (5, [
        ("file to scene", "formats/load.c"),
        ("scene to texels", "bake/bake_atlas.c"),
        ("rays, valid texels", "bake/bake_receivers.c"),
        ("choices", "bake/light/light_settings.c"),
        ("direct light", "bake/light/light_samples.c"),
        ("patches", "maps/radiosity/patches.c"),
        ("bounce passes", "maps/radiosity/bounce_pass.c"),
        ("pilot, next round", "bake/light/light_plan.c"),
        ("final gather", "maps/radiosity/final_gather.c"),
        ("stated error", "bake/light/light_error.c"),
        ("denoiser", "bake/light/light_denoise.c"),
        ("texels to pages", "bake/bake_store.c"),
        ("seams", "bake/bake_seams.c"),
        ("map and asset", "bake/files/outputs.c"),
    ]),
    "occlusion": (4, [
        ("file to scene", "formats/load.c"),
        ("scene to texels", "bake/bake_atlas.c"),
        ("rays, valid texels", "bake/bake_receivers.c"),
        ("objects", "bake/objects.c"),
        ("next round", "bake/occlusion/occlusion_plan.c"),
        ("traced, interpolated", "bake/occlusion/occlusion_lattice.c"),
        ("rays of texels", "bake/occlusion/occlusion_samples.c"),
        ("stated error", "bake/occlusion/occlusion_error.c"),
        ("texels to pages", "bake/bake_store.c"),
        ("seams", "bake/bake_seams.c"),
        ("map and asset", "bake/files/outputs.c"),
    ]),
    "atlas": (5, [
        ("file to scene", "formats/load.c"),
        ("neighbours", "scene/adjacency.c"),
        ("regions", "atlas/regions.c"),
        ("cuts at folds", "atlas/fold.c"),
        ("charts", "atlas/charts.c"),
        ("merged charts", "atlas/merge.c"),
        ("density", "atlas/layout.c"),
        ("packing", "atlas/pack.c"),
        ("texels", "atlas/raster.c"),
        ("the bake", "bake/bake.c"),
    ]),
}
# way: steps of one row from and to which a round goes back, and its file
LOOPS = {
    "light": ("stated error", "pilot, next round", "rounds: light_rounds.c"),
    "occlusion": ("stated error", "next round", "rounds: occlusion_rounds.c"),
}


def box(index, columns, words, file):
    """One step, at its place in rows that are read from the left."""
    x, y = GAP + index % columns * (WIDTH + GAP), 12 + index // columns * ROW
    folder, name = file.rsplit("/", 1)
    parts = [
        f'<rect x="{x}" y="{y}" width="{WIDTH}" height="{BOX}" rx="6"/>',
        f'<text x="{x + WIDTH / 2}" y="{y + 25}">{html.escape(words)}</text>',
        f'<text class="file" x="{x + WIDTH / 2}" y="{y + BOX + 15}">{html.escape(name)}</text>',
        f'<text class="folder" x="{x + WIDTH / 2}" y="{y + BOX + 29}">{html.escape(folder)}/</text>',
    ]
    return parts, (x, y)


def arrow(begin, end):
    """From one step to the next: to the right, or down and back to the left."""
    (x, y), (u, v) = begin, end
    if y == v:
        return f'<path d="M{x + WIDTH} {y + BOX / 2}H{u - 5}"/>'
    low = y + HEIGHT + 12
    return (f'<path d="M{x + WIDTH} {y + BOX / 2}h{GAP / 2}V{low}H{u - GAP / 2}V{v + BOX / 2}'
            f'H{u - 5}"/>')


def loop(begin, end, words):
    """Back to a step before, above the boxes."""
    (x, y), (u, _) = begin, end
    middle = (x + u + WIDTH) / 2
    return (f'<path class="loop" d="M{x + WIDTH / 2} {y}V{y - 14}H{u + WIDTH / 2}V{y - 4}"/>'
            f'<text class="file" x="{middle}" y="{y - 19}">{html.escape(words)}</text>')


def draw(way, columns, steps):
    """The picture of one way."""
    lines, places = [], {}
    for index, (words, file) in enumerate(steps):
        if not (ROOT / "src" / file).exists():
            raise SystemExit(f"draw_ways: {way}: src/{file} does not exist")
        parts, places[words] = box(index, columns, words, file)
        lines += parts
    order = [words for words, _ in steps]
    lines += [arrow(places[a], places[b]) for a, b in zip(order, order[1:])]
    if way in LOOPS:
        begin, end, words = LOOPS[way]
        lines.append(loop(places[begin], places[end], words))
    width = GAP + min(columns, len(steps)) * (WIDTH + GAP)
    height = 12 + (len(steps) - 1) // columns * ROW + HEIGHT + 12
    style = ("text{font:13px sans-serif;text-anchor:middle;fill:#222}"
             ".file{font:11px monospace}.folder{font:10px monospace;fill:#666}"
             "rect{fill:#fff4dc;stroke:#b98a2f}path{fill:none;stroke:#555;stroke-width:1.5;"
             "marker-end:url(#head)}.loop{stroke:#b03a2e;stroke-dasharray:5 3}")
    return "\n".join(
        [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
         f'width="{width}" height="{height}">',
         f"<style>{style}</style>",
         '<defs><marker id="head" markerWidth="7" markerHeight="7" refX="5" refY="3" '
         'orient="auto"><path d="M0 0L6 3L0 6z" style="fill:#555;stroke:none;marker-end:none"/>'
         "</marker></defs>",
         f'<rect width="{width}" height="{height}" style="fill:#fff;stroke:none"/>',
         *lines, "</svg>", ""])


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs" / "pictures"
    for way, (columns, steps) in WAYS.items():
        path = folder / f"way-{way}.svg"
        path.write_text(draw(way, columns, steps), encoding="utf-8")
        print(path)


if __name__ == "__main__":
    main()
