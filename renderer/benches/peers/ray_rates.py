"""Rays per second of crex and of Embree on the same mesh and the same rays, interleaved, one thread.

    pip install embreex numpy        (in a virtual environment outside the project)
    cargo build --release -p renderer --example ray_rates
    python renderer/benches/peers/ray_rates.py target/release/examples/ray_rates [RUNS [SIDE]]

Embree is called through embreex, whose copies in and out of numpy arrays are in its time (a C program calling Embree
is some 1.1 to 1.8 times faster on such rays). Prints a Markdown table of medians: of rates, and of the ratios of the two in each
run, these with the interval of 95 % or more that the order of the runs gives (with fewer than 6 runs, all).
"""

import json
import math
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from embreex import rtcore_scene
from embreex.mesh_construction import TriangleMesh


def interval(values):
    """The least and greatest of the values that hold their median with 95 % confidence (binomial)."""
    count, out, below = len(values), 0, 0.5 ** len(values)
    while 2 * (below + math.comb(count, out + 1) * 0.5**count) <= 0.05:
        out += 1
        below += math.comb(count, out) * 0.5**count
    values = sorted(values)
    return values[out], values[count - 1 - out]


def main():
    program = sys.argv[1]
    runs = int(sys.argv[2]) if len(sys.argv) > 2 else 9
    side = sys.argv[3] if len(sys.argv) > 3 else "400"
    ours, theirs = {}, {}
    with tempfile.TemporaryDirectory() as folder:
        scene = None
        for _ in range(runs):
            told = json.loads(subprocess.check_output([program, folder, side]))
            if scene is None:
                scene = rtcore_scene.EmbreeScene()
                TriangleMesh(scene, np.fromfile(Path(folder, "triangles.f32"), np.float32).reshape(-1, 3, 3))
            for name, row in told.items():
                rays = np.fromfile(Path(folder, f"{name}.f32"), np.float32).reshape(-1, 7)
                origins, directions = (np.ascontiguousarray(rays[:, i:j]) for i, j in ((0, 3), (3, 6)))
                query = "OCCLUDED" if name == "shadow" else "INTERSECT"
                ends = np.ascontiguousarray(rays[:, 6])
                start = time.process_time()
                found = scene.run(origins, directions, dists=ends.copy(), query=query)
                seconds = time.process_time() - start
                hits = int(np.sum(found == 0 if name == "shadow" else found >= 0))
                ours.setdefault(name, []).append((row["mrays_per_cpu_s"], row["hits"], row["rays"]))
                theirs.setdefault(name, []).append((len(rays) / seconds / 1e6, hits))
    print("| rays | crex, M/CPU s | Embree by embreex | ratio | hits | Embree's hits |\n|---|---|---|---|---|---|")
    for name in ours:
        a, b = (statistics.median(row[0] for row in rows[name]) for rows in (ours, theirs))
        ratios = [one[0] / other[0] for one, other in zip(ours[name], theirs[name])]
        low, high = interval(ratios)
        ratio = f"{statistics.median(ratios):.2f} ({low:.2f} to {high:.2f})"
        print(f"| {name} | {a:.2f} | {b:.2f} | {ratio} | {ours[name][0][1]} of {ours[name][0][2]} | {theirs[name][0][1]} |")


main()
