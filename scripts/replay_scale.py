#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Replays recorded costs of tiles over many ranks, and prints the efficiency.

    alpenglow-bench record-tiles builtin:atrium costs.csv --light --error 1
    scripts/replay_scale.py costs.csv [--texels 1e8] [--ranks 1,2,4] [--building 3]

The tiles of each loop are dealt as src/base/tiles/tiles.c deals them: a rank claims blocks of its
own part, then of the parts 1, 2, 4 ... further on. A claim is a round trip to rank 0, which serves
one claim at a time. A loop ends with an exchange: a ring passes the bytes of all ranks to all. A
rank has one worker.

The recorded map is smaller than the level. Each recorded tile stands for as many tiles in a row, so
that blocks differ as regions of the map do; bytes grow alike. Efficiency is the time of one rank
over N times that of N ranks, of the loops that trace rays, with their exchanges. The last column
adds the steps between loops, which every rank repeats. --building N counts those before the first N
loops (atlas, ray tracer, patches) as building, which is left out.
"""
import argparse
import csv
import heapq
import itertools
from collections import defaultdict

LATENCY, BANDWIDTH = 5e-6, 10e9  # seconds one way; bytes per second
SERVICE = 1e-6                   # of rank 0 for a claim
BLOCKS = 128                     # of a part, as in tiles.c


def read(path):
    """(first line, loops); a loop has the seconds of its tiles, its bytes, and seconds before it."""
    tiles, ends = defaultdict(list), {}
    with open(path, encoding="utf-8") as file:
        title = file.readline().strip("# \n")
        for row in csv.DictReader(file):
            if row["block"]:
                tiles[int(row["loop"])].append((int(row["block"]), float(row["seconds"])))
            else:
                ends[int(row["loop"])] = (float(row["seconds"]), int(row["bytes"]))
    loops = []
    for loop, (before, size) in sorted(ends.items()):
        seconds = [cost for _, cost in sorted(tiles[loop], key=lambda tile: tile[0])]
        loops.append((seconds, size, before))
    return title, loops


class Costs:
    """Sums of costs of tiles. Each recorded tile stands for `times` tiles in a row."""

    def __init__(self, seconds, times):
        self.sums, self.seconds, self.times = [0.0, *itertools.accumulate(seconds)], seconds, times

    def before(self, tile):
        at = tile / self.times
        whole = min(int(at), len(self.seconds) - 1)
        return self.times * (self.sums[whole] + (at - whole) * self.seconds[whole])


def mix(x):
    """alpi_hash32 of src/base/random.h."""
    x = (x ^ x >> 16) * 0x7FEB352D & 0xFFFFFFFF
    x = (x ^ x >> 15) * 0x846CA68B & 0xFFFFFFFF
    return x ^ x >> 16


def deal(costs, count, ranks):
    """Seconds from the begin of a loop to the end of its last tile, and the number of claims."""
    latency, service = (LATENCY, SERVICE) if ranks > 1 else (0.0, 0.0)
    steps = [0] + [1 << i for i in range(16) if 1 << i < ranks]
    most = min(BLOCKS, BLOCKS * ranks // count + 1)
    done = [0] * ranks                       # blocks of each part that are claimed
    ready = [(0.0, rank, 0) for rank in range(ranks)]  # time, rank, parts that it found empty
    free, ended, claims = 0.0, 0.0, 0        # free: when rank 0 can serve the next claim
    while ready:
        now, rank, visited = heapq.heappop(ready)
        part = (rank + steps[visited]) % ranks
        free = max(now + latency, free) + service
        now = free + latency
        claims += 1
        if done[part] < BLOCKS:
            for block in range(done[part], min(done[part] + most, BLOCKS)):
                at = block * ranks + (part + (mix(block) * ranks >> 32)) % ranks
                now += costs.before(count * (at + 1) // (BLOCKS * ranks))
                now -= costs.before(count * at // (BLOCKS * ranks))
            done[part] += most
        else:
            visited += 1
        if visited < len(steps):
            heapq.heappush(ready, (now, rank, visited))
        ended = max(ended, now)
    return ended, claims


def exchange(size, ranks):
    """A ring: each rank sends what it has to the next, N − 1 times."""
    return 0.0 if ranks == 1 else (ranks - 1) * (LATENCY + size / ranks / BANDWIDTH)


def replay(loops, factor, ranks):
    """Seconds: of tracing without a wait, of waits in loops, of exchanges; and claims."""
    work = wait = sent = 0.0
    claims = 0
    for seconds, size, _ in loops:
        count = max(1, round(len(seconds) * factor))
        costs = Costs(seconds, count / len(seconds))
        span, calls = deal(costs, count, ranks)
        work += costs.before(count) / ranks
        wait += span - costs.before(count) / ranks
        sent += exchange(size * factor, ranks)
        claims += calls
    return work, wait, sent, claims


def main():
    parser = argparse.ArgumentParser(description="Replays recorded costs of tiles over ranks.")
    parser.add_argument("costs")
    parser.add_argument("--texels", type=float, default=1e8)
    parser.add_argument("--building", type=int, default=3)
    parser.add_argument("--ranks", default="1,2,4,8,16,32,64,128,256,512,1024")
    arguments = parser.parse_args()
    title, loops = read(arguments.costs)
    texels = float(title.split("texels ")[1].split(",")[0])
    factor = arguments.texels / texels
    tiles = sum(len(loop[0]) for loop in loops)
    before = [loop[2] for loop in loops]
    print(f"{title}; {len(loops)} loops, {tiles} tiles, {sum(sum(l[0]) for l in loops):.1f} s in "
          f"loops; {sum(before[:arguments.building]):.2f} s of building, "
          f"{sum(before[arguments.building:]):.2f} s in steps between loops; "
          f"{sum(l[1] for l in loops) / texels:.0f} bytes per texel sent")
    print(f"replayed for {arguments.texels:.3g} texels\n")
    print("| ranks | tracing, s | waiting, s | exchange, s | claims | efficiency | with steps |")
    print("|--:|--:|--:|--:|--:|--:|--:|")
    steps = factor * sum(loop[2] for loop in loops[arguments.building:])
    alone = None
    for ranks in map(int, arguments.ranks.split(",")):
        work, wait, sent, claims = replay(loops, factor, ranks)
        alone = work + wait if alone is None else alone
        print(f"| {ranks} | {work:.1f} | {wait:.2f} | {sent:.2f} | {claims} "
              f"| {alone / ranks / (work + wait + sent):.3f} "
              f"| {(alone + steps) / ranks / (work + wait + sent + steps):.3f} |", flush=True)


if __name__ == "__main__":
    main()
