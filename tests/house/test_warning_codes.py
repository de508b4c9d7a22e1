#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What a reader warns of has words in the doctor's table: what is seen, what to do."""
import pathlib
import re
import sys

root = pathlib.Path(__file__).resolve().parent.parent.parent
CALL = re.compile(r'alpi_warn\(\s*[^,"]+,\s*("([a-z0-9-]+)")?')
# Told while something is written or a sky is set, long after the doctor's look; their text says what
# to do.
NOT_READERS = {
    "baked-twice", "compression", "conversion", "copies", "extras", "hdr-range", "images", "lightmap-metal",
    "missing-file", "no-uv-set", "outside-file", "sky-image", "sun-below-horizon", "texture-lost",
    "uv-sets", "variants",
}


def codes_of(name, text):
    """Codes of the calls; a code that is no literal is a fault."""
    for match in CALL.finditer(text):
        line = text.count("\n", 0, match.start()) + 1
        yield match.group(2), f"{name}:{line}"


def main():
    assert list(codes_of("a", 'alpi_warn(\n  c->d, "e-f", g, "h")')) == [("e-f", "a:1")]
    assert list(codes_of("a", "alpi_warn(c, code, g)")) == [(None, "a:1")]
    words = set(re.findall(r'ALP_SEVERITY_\w+,\s*"([a-z0-9-]+)"',
                           (root / "src/doctor/doctor_words.c").read_text(encoding="utf-8")))
    found, used = [], set()
    for room in ("formats", "scene"):
        for path in sorted((root / "src" / room).rglob("*.c*")):
            for code, place in codes_of(path.relative_to(root),
                                        path.read_text(encoding="utf-8")):
                used.add(code)
                if code is None:
                    found.append(f"{place}: the code is no literal, so that nobody can look for it")
                elif code not in words and code not in NOT_READERS:
                    found.append(f"{place}: \"{code}\" has no words in src/doctor/doctor_words.c")
    found += [f"\"{code}\" of this test is told nowhere" for code in sorted(NOT_READERS - used)]
    found += [f"\"{code}\" has words, and is no writer's" for code in sorted(NOT_READERS & words)]
    if len(used) < 30:
        found.append(f"only {len(used)} codes seen")
    print("\n".join(found))
    sys.exit(1 if found else 0)


main()
