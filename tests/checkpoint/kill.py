#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Kills bakes with a checkpoint at random moments, and compares what the last one wrote.

    kill.py ALPENGLOW KILLS [--every S] [--seed N] -- WORDS...

WORDS are those of `alpenglow bake` without outputs: a scene and options. A bake that was killed is
run again and killed again, until one ends; then another begins. Checked are: work lost is at most
the interval (or 5 s before the first write) and 2 s; the maps have the bytes of an undisturbed bake;
folders hold no temporary file at the end. Exit status: 0 if all of that is so, else 1. Ctrl-C counts
the kills so far.
"""
import argparse
import hashlib
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

SLACK = 2.0  # seconds of work that may be lost beyond the interval
FIRST_WRITE = 5.0  # seconds after the first ray


def hashes(folder):
    """{name: md5} of all files."""
    found = {}
    for name in sorted(os.listdir(folder)):
        with open(os.path.join(folder, name), "rb") as file:
            found[name] = hashlib.md5(file.read()).hexdigest()
    return found


class Bakes:
    def __init__(self, command, words, every, folder):
        self.words = [command, "bake", *words, "-f", "-q", "--progress", "off"]
        self.every, self.folder = every, folder
        self.checkpoint = os.path.join(folder, "checkpoint")
        self.maps = os.path.join(folder, "maps")
        self.kills = self.bakes = 0
        self.lost, self.faults = [], []

    def start(self, checkpointed):
        extra = ["--maps-dir", self.maps]
        if checkpointed:
            extra += ["--checkpoint", self.checkpoint, "--checkpoint-every", str(self.every)]
        return subprocess.Popen(self.words + extra, stdout=subprocess.DEVNULL,
                                stderr=subprocess.PIPE, text=True)

    def undisturbed(self):
        """Hashes and seconds of a bake without a checkpoint."""
        began = time.time()
        errors = self.start(False).communicate()[1]
        seconds = time.time() - began
        if not os.path.isdir(self.maps):
            sys.exit(f"kill.py: the bake itself fails: {errors}")
        found = hashes(self.maps)
        shutil.rmtree(self.maps)
        return found, seconds

    def note_loss(self, began, killed):
        """Seconds between the last write and the kill; of a process that wrote nothing, its age."""
        state = os.path.join(self.checkpoint, "bake.state")
        written = began
        for path in (state, state + ".old"):
            if os.path.exists(path):
                written = max(written, os.stat(path).st_mtime)
        wrote = written > began
        lost = killed - written
        limit = (self.every if wrote else max(self.every, FIRST_WRITE)) + SLACK
        self.lost.append(lost)
        if lost > limit:
            self.faults.append(f"kill {self.kills}: {lost:.1f} s of work lost, more than {limit:g}")

    def run(self, moment):
        """Runs until it ends or the moment. @return whether it ended"""
        began = time.time()
        process = self.start(True)
        try:
            errors = process.communicate(timeout=moment)[1]
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGKILL)
            killed = time.time()
            process.communicate()
            self.kills += 1
            self.note_loss(began, killed)
            return False
        if process.returncode != 0:
            self.faults.append(f"after kill {self.kills}: exit {process.returncode}: {errors}")
        return True

    def check_end(self, expected):
        self.bakes += 1
        found = hashes(self.maps) if os.path.isdir(self.maps) else {}
        for name in sorted(set(found) | set(expected)):
            if name not in expected:
                self.faults.append(f"bake {self.bakes}: {name} is left behind")
            elif found.get(name) != expected[name]:
                self.faults.append(f"bake {self.bakes}: {name} is missing or differs")
        left = sorted(os.listdir(self.checkpoint)) if os.path.isdir(self.checkpoint) else []
        if left != ["bake.state"]:
            self.faults.append(f"bake {self.bakes}: the checkpoint keeps {left}")
        shutil.rmtree(self.checkpoint, ignore_errors=True)
        shutil.rmtree(self.maps, ignore_errors=True)


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("command")
    parser.add_argument("kills", type=int)
    parser.add_argument("--every", type=float, default=10.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("words", nargs="+")
    a = parser.parse_args()
    moments = random.Random(a.seed)
    folder = tempfile.mkdtemp(prefix="alpenglow-kill-")
    try:
        bakes = Bakes(os.path.abspath(a.command), a.words, a.every, folder)
        expected, seconds = bakes.undisturbed()
        ended = True
        while bakes.kills < a.kills or not ended:
            left = bakes.kills < a.kills
            ended = bakes.run(moments.uniform(0.0, seconds) if left else 20 * seconds + 60)
            if ended:
                bakes.check_end(expected)
    except KeyboardInterrupt:
        print("stopped early")
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    for fault in bakes.faults:
        print(fault)
    print(f"{bakes.kills} kills of a bake of {seconds:.1f} s every {a.every:g} s, {bakes.bakes} bakes "
          f"ended; at most {max(bakes.lost, default=0.0):.1f} s of work lost; {len(bakes.faults)} faults")
    return 1 if bakes.faults else 0


if __name__ == "__main__":
    sys.exit(main())
