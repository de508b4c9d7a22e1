#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Tables of atlases: figures, growth with triangles, other unwrappers on the same meshes.

    atlas_table.py BENCH [--shared DIR] [--three DIR] [--only figures|growth|peers]
                   [--patience SECONDS] [--document FILE]

BENCH is alpenglow-bench of a release build. Figures are held to what is asked of an atlas, and what
fails is named: exit status 1. Scenes lie below --shared or $ALPENGLOW_SHARED; those that are not
there are skipped, and so are unwrappers that are not installed: three.js is looked for in --three,
else in tests/browser (scripts/setup.sh browser), Blender at /usr/bin/blender. With --document the
tables are written between the markers `<!-- table NAME -->` and `<!-- end NAME -->` of that file,
and the plot of growth and pictures of pages as atlas-growth.svg and atlas-pages.png in docs/pictures.
"""
import argparse
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
PICTURES = HERE.parent.parent / "docs/pictures"
sys.path.insert(0, str(HERE.parent.parent / "scripts"))
from png_rows import read_png, write_png  # noqa: E402
# (name, file below scenes/ or a scene that the bench makes, side of a page, least utilisation)
# The hull of the ship and the building are thousands of separate pieces.
SCENES = [
    ("teapot in its room", "builtin:teapot-room", 1024, 0.75),
    ("sphere on its plane", "builtin:sphere-plane", 1024, 0.75),
    ("torus on its plane", "builtin:torus-plane", 1024, 0.75),
    ("gazebo", "architecture/gazebo.obj", 1024, 0.75),
    ("scallop", "objects/scallop.glb", 1024, 0.75),
    ("dutch_ship", "objects/dutch_ship/dutch_ship_medium_1k.gltf", 1024, 0.60),
    ("zdm2", "architecture/zdm2.glb", 1024, 0.60),
    ("coffee_maker", "objects/coffee_maker.glb", 1024, 0.75),
    ("salle_de_bain", "architecture/salle_de_bain.glb", 2048, 0.75),
    ("a million meshes", "pieces:1000000", 1024, 0.60),
]
GROWTH = [70_000, 140_000, 280_000, 560_000, 1_000_000]
PADDING = 2
MOST_STRETCH, MOST_SECONDS, MOST_BYTES = 2.0, 15.0, 2 * 2**30
MOST_EXPONENT = 1.15  # of seconds over triangles: linear, and a little for caches that overflow


def say(text):
    print(text, flush=True)


# --- running -------------------------------------------------------------------------------------

def measure(bench, scene, size, threads=2, coordinates=None, picture=None):
    words = [bench, "measure-atlas", scene, "--size", size, "--padding", PADDING,
             "--threads", threads]
    words += ["--set", coordinates] if coordinates is not None else []
    words += ["--picture", picture] if picture is not None else []
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip())
    return json.loads(done.stdout)


def find_scenes(shared):
    for name, path, size, least in SCENES:
        if ":" not in path:
            path = shared / "scenes" / path if shared is not None else None
            if path is None or not path.is_file():
                say(f"{name}: absent, skipped (--shared or ALPENGLOW_SHARED)")
                continue
        yield name, path, size, least


# --- figures -------------------------------------------------------------------------------------

def faults_of(figures, hashes, least):
    faults = []
    for name in ("uncovered", "flipped", "overlapping"):
        if figures[name] != 0:
            faults.append(f"{figures[name]} {name}")
    if figures["utilisation"] < least:
        faults.append(f"utilisation {figures['utilisation']:.3f} < {least}")
    if figures["stretch_worst"] > MOST_STRETCH:
        faults.append(f"worst stretch {figures['stretch_worst']:.3g} > {MOST_STRETCH:g}")
    if len(hashes) != 1:
        faults.append("another atlas with other --threads")
    # Others on the machine lengthen the one and not the other; alone, two cores need less time.
    seconds = min(figures["seconds"], figures["cpu_seconds"])
    if seconds > MOST_SECONDS * max(1.0, figures["triangles"] / 1e6):
        faults.append(f"{seconds:.1f} s")
    if figures["peak_bytes"] > MOST_BYTES:
        faults.append(f"{figures['peak_bytes'] / 2**30:.2f} GiB")
    return faults


def table_of_figures(bench, shared):
    rows, failed = [], 0
    for name, path, size, least in find_scenes(shared):
        runs = {threads: measure(bench, path, size, threads) for threads in (1, 2, 4)}
        f = runs[2]
        hashes = {run["hash"] for run in runs.values()}
        faults = faults_of(f, hashes, least)
        failed += bool(faults)
        rows.append([name, size, f"{f['triangles']:,}", f"{f['charts']:,}", f["pages"],
                     f"{f['utilisation']:.3f}", f["uncovered"], f["lines"], f["flipped"],
                     f["overlapping"], f"{f['stretch_mean']:.3f}", f"{f['stretch_worst']:.3f}",
                     f"{f['density_spread']:.3f}", f"{f['slivers']:,}", f"{f['seconds']:.2f}",
                     f"{f['cpu_seconds']:.2f}", f"{f['peak_bytes'] / 2**20:.0f}",
                     f"`{f['hash'][:8]}`", "; ".join(faults) if faults else "good"])
        say(f"{name}: {rows[-1][-1]}")
    header = ["scene", "page", "triangles", "charts", "pages", "utilisation", "not covered",
              "lines", "flipped", "overlaps", "mean stretch", "worst", "density spread", "slivers",
              "seconds", "of processors", "MiB", "hash", "verdict"]
    return markdown(header, rows), failed


# --- growth --------------------------------------------------------------------------------------

def exponent(points):
    """Slope of the line of least squares through the logarithms."""
    logs = [(math.log(x), math.log(y)) for x, y in points]
    mean_x = sum(x for x, _ in logs) / len(logs)
    mean_y = sum(y for _, y in logs) / len(logs)
    return (sum((x - mean_x) * (y - mean_y) for x, y in logs)
            / sum((x - mean_x) ** 2 for x, _ in logs))


def table_of_growth(bench):
    rows, seconds, memory = [], [], []
    for count in GROWTH:
        rounds = 3 if count < 200_000 else 1  # long runs vary less
        f = sorted((measure(bench, f"hills:{count}", 1024) for _ in range(rounds)),
                   key=lambda run: run["cpu_seconds"])[rounds // 2]
        seconds.append((f["triangles"], f["cpu_seconds"]))
        memory.append((f["triangles"], f["peak_bytes"] / 2**20))
        rows.append([f"{f['triangles']:,}", f"{f['seconds']:.2f}", f"{f['cpu_seconds']:.2f}",
                     f"{1e6 * f['cpu_seconds'] / f['triangles']:.2f}",
                     f"{f['peak_bytes'] / 2**20:.0f}", f"{f['charts']:,}"])
        say(f"hills:{count}: {f['cpu_seconds']:.2f} s of processor time")
    slope = exponent(seconds)
    text = markdown(["triangles", "seconds", "processor seconds", "µs a triangle", "MiB",
                     "charts"], rows)
    text += (f"\nProcessor time grows with triangles to the power of {slope:.2f}, memory to that of"
             f" {exponent(memory):.2f}; 1 is linear.\n")
    faults = [f"exponent {slope:.2f}"] if slope > MOST_EXPONENT else []
    last = min(f["seconds"], f["cpu_seconds"])  # as in faults_of
    faults += [f"{last:.1f} s for {f['triangles']:,} triangles"] if last > MOST_SECONDS else []
    say("growth: " + ("; ".join(faults) if faults else "good"))
    return text, int(bool(faults)), plot(seconds, memory)


def plot(seconds, memory):
    """Both over triangles, log-log, with a line of slope 1 through the last point of each."""
    width, height, left, top = 640, 320, 60, 20
    least_x, most_x = 5e4, 2e6

    def place(x, y, low, high, at):
        u = math.log(x / least_x) / math.log(most_x / least_x)
        v = math.log(y / low) / math.log(high / low)
        return at + u * 240, top + (1 - v) * 240

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
           'font-family="sans-serif" font-size="11">',
           f'<rect width="{width}" height="{height}" fill="white"/>']
    for i, (title, points) in enumerate([("processor seconds", seconds), ("MiB", memory)]):
        at = left + i * 300
        low = 10 ** math.floor(math.log10(min(y for _, y in points) / 2))
        high = 10 ** math.ceil(math.log10(max(y for _, y in points) * 1.2))
        out.append(f'<rect x="{at}" y="{top}" width="240" height="240" fill="none" '
                   'stroke="#888"/>')
        for x, label in ((1e5, "100 k"), (1e6, "1 M")):
            px, _ = place(x, low, low, high, at)
            out.append(f'<line x1="{px:.1f}" y1="{top}" x2="{px:.1f}" y2="{top + 240}" '
                       'stroke="#ddd"/>')
            out.append(f'<text x="{px:.1f}" y="{top + 256}" text-anchor="middle">{label}</text>')
        y = low
        while y <= high * 1.001:
            _, py = place(least_x, y, low, high, at)
            out.append(f'<line x1="{at}" y1="{py:.1f}" x2="{at + 240}" y2="{py:.1f}" '
                       'stroke="#ddd"/>')
            out.append(f'<text x="{at - 4}" y="{py + 4:.1f}" text-anchor="end">{y:g}</text>')
            y *= 10
        last_x, last_y = points[-1]
        start = max(least_x, last_x * low / last_y)
        a, b = place(start, last_y * start / last_x, low, high, at)
        c, d = place(last_x, last_y, low, high, at)
        out.append(f'<line x1="{a:.1f}" y1="{b:.1f}" x2="{c:.1f}" y2="{d:.1f}" stroke="#888" '
                   'stroke-dasharray="4 3"/>')
        for x, y in points:
            px, py = place(x, y, low, high, at)
            out.append(f'<circle cx="{px:.1f}" cy="{py:.1f}" r="3.5" fill="#b5482a"/>')
        out.append(f'<text x="{at + 120}" y="{top + 280}" text-anchor="middle">{title} over '
                   'triangles; dashed: linear</text>')
    return "\n".join(out + ["</svg>", ""])


# --- other unwrappers ----------------------------------------------------------------------------

def run_peer(words, patience, environment=None):
    """The JSON it prints, or why there is none."""
    try:
        done = subprocess.run(list(map(str, words)), capture_output=True, text=True, check=False,
                              timeout=patience, env=environment)
    except subprocess.TimeoutExpired:
        return {"refused": f"more than {patience} s"}
    lines = [line for line in done.stdout.splitlines() if "{" in line]
    if done.returncode != 0 or not lines:
        return {"refused": (done.stderr or done.stdout).strip().splitlines()[-1][:60]}
    return json.loads(lines[-1][lines[-1].index("{"):])


def peers_of(three, patience):
    if (three / "examples/jsm/utils/unwrapUVs.js").is_file():
        yield "three.js unwrapUVs", lambda source, target, size: run_peer(
            ["node", "--max-old-space-size=8192", HERE / "unwrappers/unwrap_three.mjs", three,
             source, target, size, PADDING], patience)
    else:
        say(f"three.js: not in {three}, skipped")
    if os.access("/usr/bin/blender", os.X_OK):
        yield "Blender Smart UV Project", lambda source, target, size: run_peer(
            ["/usr/bin/blender", "-b", "--factory-startup", "--python-exit-code", "3", "--python",
             HERE / "unwrappers/unwrap_blender.py", "--", source, target, size, PADDING],
            patience, {**os.environ, "PATH": "/usr/bin:/bin"})
    else:
        say("Blender: not at /usr/bin/blender, skipped")


def peer_row(name, who, f, seconds):
    worst = "∞" if f["stretch_worst"] >= 1e299 else f"{f['stretch_worst']:.3f}"
    mean = "∞" if f["stretch_mean"] >= 1e299 else f"{f['stretch_mean']:.3f}"
    return [name, who, f"{f['charts']:,}", f["pages"], f"{f['utilisation']:.3f}",
            f"{f['texels_per_metre']:.4g}", mean, worst, f"{f['density_spread']:.3f}",
            f"{f['uncovered']:,}", f"{f['flipped']:,}", f"{f['overlapping']:,}", f"{seconds:.2f}"]


def table_of_peers(bench, shared, three, patience):
    rows = []
    peers = list(peers_of(three, patience))
    with tempfile.TemporaryDirectory() as folder:
        source, target = pathlib.Path(folder, "in.obj"), pathlib.Path(folder, "out.obj")
        for name, path, size, _ in find_scenes(shared):
            if str(path).startswith("pieces:"):
                continue  # nothing to unwrap
            ours = measure(bench, path, size)
            rows.append(peer_row(name, "alpenglow", ours, ours["seconds"]))
            subprocess.run([bench, "measure-atlas", str(path), "--obj", str(source)], check=True)
            for who, unwrap in peers:
                target.unlink(missing_ok=True)
                told = unwrap(source, target, size)
                if "refused" in told:
                    rows.append([name, who, told["refused"]] + [""] * 10)
                else:
                    found = measure(bench, target, size, coordinates=0)
                    rows.append(peer_row(name, who, found, told["seconds"]))
                say(f"{name}: {who}: {rows[-1][2]} charts")
    return markdown(["scene", "unwrapper", "charts", "pages", "utilisation", "texels per metre",
                     "mean stretch", "worst", "density spread", "not covered", "flipped",
                     "overlaps", "seconds"], rows)


# --- pictures ------------------------------------------------------------------------------------

def draw_pages(bench, shared, target):
    """The first pages of some scenes at 512, side by side."""
    wanted = ["teapot in its room", "torus on its plane", "dutch_ship"]
    sheet = None
    with tempfile.TemporaryDirectory() as folder:
        picture = pathlib.Path(folder, "page.png")
        for name, path, _, _ in find_scenes(shared):
            if name in wanted:
                measure(bench, path, 512, picture=picture)
                rows = [row + b"\xff" * 24 for row in read_png(picture)]
                sheet = rows if sheet is None else [a + b for a, b in zip(sheet, rows)]
    write_png(target, [row[:-24] for row in sheet])


# --- text ----------------------------------------------------------------------------------------

def markdown(header, rows):
    lines = [header, *([str(cell) for cell in row] for row in rows)]
    widths = [max(len(line[i]) for line in lines) for i in range(len(header))]
    text = []
    for i, line in enumerate(lines):
        text.append("| " + " | ".join(c.ljust(w) for c, w in zip(line, widths)) + " |")
        if i == 0:
            text.append("|" + "|".join("-" * (w + 2) for w in widths) + "|")
    return "\n".join(text) + "\n"


def put(document, name, text):
    """Replaces what stands between the markers of a table."""
    whole = document.read_text(encoding="utf-8")
    begin, end = f"<!-- table {name} -->\n", f"<!-- end {name} -->"
    head, rest = whole.split(begin, 1)
    document.write_text(head + begin + "\n" + text + "\n" + end + rest.split(end, 1)[1],
                        encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("bench")
    parser.add_argument("--shared", type=pathlib.Path, default=os.environ.get("ALPENGLOW_SHARED"))
    parser.add_argument("--three", type=pathlib.Path,
                        default=HERE.parent / "browser/node_modules/three")
    parser.add_argument("--only", choices=["figures", "growth", "peers"])
    parser.add_argument("--patience", type=int, default=600, help="with another unwrapper, seconds")
    parser.add_argument("--document", type=pathlib.Path)
    asked = parser.parse_args()
    shared = pathlib.Path(asked.shared) if asked.shared else None
    failed = 0

    def take(name, text):
        if asked.document is not None:
            put(asked.document, name, text)
        else:
            print(f"\n{text}", flush=True)

    if asked.only in (None, "figures"):
        text, more = table_of_figures(asked.bench, shared)
        failed += more
        take("figures", text)
        if asked.document is not None:
            draw_pages(asked.bench, shared, PICTURES / "atlas-pages.png")
    if asked.only in (None, "growth"):
        text, more, picture = table_of_growth(asked.bench)
        failed += more
        take("growth", text)
        if asked.document is not None:
            (PICTURES / "atlas-growth.svg").write_text(picture, encoding="utf-8")
    if asked.only in (None, "peers"):
        take("peers", table_of_peers(asked.bench, shared, asked.three, asked.patience))
    say(f"{failed} fail" if failed else "all good")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
