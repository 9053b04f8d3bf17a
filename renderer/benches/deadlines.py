#!/usr/bin/env python3
"""Deadline runs: bounds drawn log-uniformly over several scenes, each run timed from outside beside a recorder of stalls.

    python3 renderer/benches/deadlines.py --crex target/release/crex --runs 500 --out deadlines

Writes deadlines/runs.csv, one row a run, and deadlines/deadlines.svg. A run that is in the CSV is not repeated, so the
program may be stopped and started again. --busy keeps one core occupied meanwhile. --plot only draws.

Columns: run, scene, bound_s, outside_s (from before exec to after exit), wall_s (by the program itself), used (outside_s /
bound_s), late_s (outside_s - bound_s), stall_s (the longest time for which a thread that asks for nothing but the clock was
not scheduled during the run), rounds, units, busy.
"""
import argparse
import csv
import json
import math
import os
import random
import subprocess
import sys
import threading
import time

# A gap that counts as a stall of the machine.
STALL_S = 0.02

SCENES = {
    "cornell": (["stimuli/cornell/cornell.rad"], "stimuli/cornell/cornell.vf", "(TRSMGD)*"),
    "corridor": (["stimuli/corridor/materials.rad", "stimuli/corridor/shell.rad", "stimuli/corridor/layout_a.rad"],
                 "stimuli/corridor/corridor.vf", "T[RS](GM)D"),
    "library": (["stimuli/library/library.rad"], "stimuli/library/library.vf", "(TT[RS]G)*D"),
    "desk": (["stimuli/desk/desk.rad"], "stimuli/desk/desk.vf", "(<MRSGD>T*)*"),
    "cornell-short": (["stimuli/cornell/cornell.rad"], "stimuli/cornell/cornell.vf", "T[RSGM]D"),
}


class Stalls(threading.Thread):
    """Notes the longest gap between two looks at the clock, 1 ms apart."""

    def __init__(self):
        super().__init__(daemon=True)
        self.longest = 0.0
        self.start()

    def run(self):
        last = time.monotonic()
        while True:
            time.sleep(0.001)
            now = time.monotonic()
            self.longest = max(self.longest, now - last - 0.001)
            last = now


def one(crex, scene, bound, size, profile, folder, seed):
    files, view, expression = SCENES[scene]
    stats = os.path.join(folder, "stats.json")
    words = [crex, "render", *files, "-vf", view, "-x", str(size), "-y", str(size), "--crex", expression, "--time",
             f"{bound:.4f}", "--seed", str(seed), "--stats", stats, "-o", os.path.join(folder, "picture.exr")]
    if profile:
        words += ["--profile", os.path.join(folder, f"{scene}.json")]
    begun = time.monotonic()
    done = subprocess.run(words, capture_output=True, text=True)
    outside = time.monotonic() - begun
    if done.returncode != 0:
        sys.exit(f"{' '.join(words)}\n{done.stderr}")
    with open(stats) as file:
        return outside, json.load(file)


def plot(path, rows):
    """Lateness over the bound, one dot a run, and the line that may not be crossed."""
    width, height, margin = 900, 420, 60
    bounds = [float(row["bound_s"]) for row in rows]
    low, high = math.log(min(bounds)), math.log(max(bounds) + 1e-9)
    span = max(0.1, max(abs(float(row["late_s"])) for row in rows) * 1.05)
    x = lambda b: margin + (math.log(b) - low) / max(high - low, 1e-9) * (width - 2 * margin)
    y = lambda late: height / 2 - late / span * (height / 2 - 30)
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" '
             f'font-size="12"><rect width="100%" height="100%" fill="white"/>']
    for late, name in ((0.0, "the bound"), (span, f"{1000 * span:.0f} ms late"), (-span, f"{1000 * span:.0f} ms early")):
        parts.append(f'<line x1="{margin}" x2="{width - margin}" y1="{y(late):.1f}" y2="{y(late):.1f}" stroke="#999"/>'
                     f'<text x="4" y="{y(late) - 4:.1f}">{name}</text>')
    steps = [math.exp(low + (high - low) * i / 60) for i in range(61)]
    line = " ".join(f"{x(b):.1f},{y(max(0.01 * b, 0.02)):.1f}" for b in steps)
    parts.append(f'<polyline points="{line}" fill="none" stroke="#c00" stroke-dasharray="4 3"/>')
    colours = dict(zip(SCENES, ("#1b6ca8", "#c2571a", "#3a7d34", "#7a3f9d", "#555")))
    for row in rows:
        parts.append(f'<circle cx="{x(float(row["bound_s"])):.1f}" cy="{y(float(row["late_s"])):.1f}" r="2.2" '
                     f'fill="{colours[row["scene"]]}" fill-opacity=".6"/>')
    for i, (scene, colour) in enumerate(colours.items()):
        parts.append(f'<text x="{margin + 120 * i}" y="16" fill="{colour}">{scene}</text>')
    for b in (0.3, 1, 3, 10, 20):
        if low <= math.log(b) <= high:
            parts.append(f'<text x="{x(b) - 8:.1f}" y="{height - 6}">{b} s</text>')
    parts.append("</svg>\n")
    with open(path, "w") as file:
        file.write("\n".join(parts))


def summary(rows):
    """All runs, and those during which the machine did not stand still."""
    still = [row for row in rows if float(row["stall_s"]) < STALL_S]
    for name, some in (("all runs", rows), (f"runs without a stall of {1000 * STALL_S:.0f} ms", still)):
        if not some:
            continue
        late = sorted(float(row["late_s"]) for row in some)
        missed = sum(float(row["late_s"]) > max(0.01 * float(row["bound_s"]), 0.02) for row in some)
        used = sum(float(row["used"]) >= 0.95 for row in some) / len(some)
        print(f"{name}: {len(some)}; missed by more than max(1 %, 20 ms): {missed} ({100 * missed / len(some):.1f} %); 95 % of "
              f"the bound used in {100 * used:.1f} %; lateness median {1000 * late[len(late) // 2]:.1f} ms, 99 % below "
              f"{1000 * late[math.ceil(0.99 * len(late)) - 1]:.1f} ms, worst {1000 * late[-1]:.1f} ms")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--crex", default="target/release/crex")
    parser.add_argument("--runs", type=int, default=500)
    parser.add_argument("--first", type=int, default=0, help="number of the first run: two programs can share the work")
    parser.add_argument("--bounds", type=float, nargs=2, default=(0.3, 20.0))
    parser.add_argument("--scenes", nargs="+", default=list(SCENES), choices=list(SCENES))
    parser.add_argument("--size", type=int, default=400)
    parser.add_argument("--out", default="deadlines")
    parser.add_argument("--no-profile", action="store_true", help="begin every run with an empty cache")
    parser.add_argument("--busy", action="store_true", help="keep one core occupied")
    parser.add_argument("--plot", action="store_true", help="only draw what there is")
    args = parser.parse_args()
    os.makedirs(args.out, exist_ok=True)
    path = os.path.join(args.out, "runs.csv")
    rows = list(csv.DictReader(open(path))) if os.path.exists(path) else []
    columns = ["run", "scene", "bound_s", "outside_s", "wall_s", "used", "late_s", "stall_s", "rounds", "units", "busy"]
    if not args.plot:
        stalls = Stalls()
        busy = subprocess.Popen([sys.executable, "-c", "while True: pass"]) if args.busy else None
        try:
            with open(path, "a", newline="") as file:
                writer = csv.DictWriter(file, columns)
                if not rows:
                    writer.writeheader()
                for run in range(args.first + len(rows), args.first + args.runs):
                    dice = random.Random(f"2005 {run}")
                    scene = args.scenes[run % len(args.scenes)]
                    bound = math.exp(dice.uniform(*map(math.log, args.bounds)))
                    stalls.longest = 0.0
                    outside, stats = one(args.crex, scene, bound, args.size, not args.no_profile, args.out, run)
                    row = dict(run=run, scene=scene, bound_s=f"{bound:.4f}", outside_s=f"{outside:.4f}",
                               wall_s=f"{stats['wall_s']:.4f}", used=f"{outside / bound:.4f}",
                               late_s=f"{outside - bound:.4f}", stall_s=f"{stalls.longest:.4f}",
                               rounds=len(stats["timed"]["rounds"]), units=stats["timed"]["units"], busy=int(args.busy))
                    writer.writerow(row)
                    file.flush()
                    rows.append({key: str(value) for key, value in row.items()})
        finally:
            if busy:
                busy.terminate()
    if rows:
        plot(os.path.join(args.out, "deadlines.svg"), rows)
        summary(rows)


if __name__ == "__main__":
    main()
