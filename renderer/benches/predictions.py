#!/usr/bin/env python3
"""The paper's Table 3 and Figures 6 to 8 on our scenes.

    python3 renderer/benches/predictions.py table3 --crex target/release/crex --out table3 [--frames 180]
    python3 renderer/benches/predictions.py figures --crex target/release/crex --out figures [--size 1200]

table3: for each component the error of the predicted seconds, |predicted - true| / true, of its runs in a picture together,
averaged over pictures. By the paper's rules: Cornell box and corridor from an empty cache, the library over a walk of frames
with the cache of ten frames of 256 x 179, which is kept as it is. Then of all tasks (single components, or [ ] with all its
members) the part that ended within the bound that they were admitted by, which is to be 95 %. What has less than 1000
rays is left out.
figures: the time of the whole crex first, then bounds that are parts of it: what ran, how long it took, and what was
predicted. Both skip what they have already in their folder.
"""
import argparse
import json
import os
import shutil
import statistics
import subprocess
import sys
import time

CORNELL = (["stimuli/cornell/cornell.rad"], ["-vf", "stimuli/cornell/cornell.vf"])
CORRIDOR = (["stimuli/corridor/materials.rad", "stimuli/corridor/shell.rad", "stimuli/corridor/layout_a.rad"],
            ["-vf", "stimuli/corridor/corridor.vf"])
LIBRARY = (["stimuli/library/library.rad"], ["-vf", "stimuli/library/library.vf"])
# Per cent, from Table 3: Cornell box, corridor, library.
PAPER = {"S": (None, 40, 17), "D": (8, 2, 20), "G": (2, 13, 20), "T": (2, 16, 19), "R": (1.8, 13, 35), "M": (2.8, 8, None)}
FIGURES = [
    ("figure6", CORNELL, "(TRSMGD)3", (2 / 3, 1 / 3)),
    ("figure7", LIBRARY, "(TT[RS]G)3", (5 / 6, 4 / 6, 3 / 6)),
    ("figure8", CORRIDOR, "TRSMGD", (1 / 2, 1 / 4, 1 / 20)),
]


def render(args, name, scene, crex, more, size):
    stats = os.path.join(args.out, f"{name}.stats.json")
    if not os.path.exists(stats):
        files, view = scene
        words = [args.crex, "render", *files, *view, "-x", str(size[0]), "-y", str(size[1]), "--crex", crex, "--stats", stats,
                 "-o", os.path.join(args.out, f"{name}.exr"), "-o", os.path.join(args.out, f"{name}.png"), *more]
        done = subprocess.run(words, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{' '.join(words)}\n{done.stderr}")
    with open(stats) as file:
        return json.load(file)


def tasks(stats):
    """Rows of the tasks that ran: single components, or all members of a [ ]."""
    last = None
    for row in stats["stages"]:
        if row["predicted_s"] is None or row["skipped"]:
            if last:
                yield last[1]
            last = None
            continue
        key = (row["group"], row["bound_s"])
        if row["group"] and last and last[0] == key:
            last[1].append(row)
        else:
            if last:
                yield last[1]
            last = (key, [row])
    if last:
        yield last[1]


def errors(stats, into, held):
    found = {}
    for task in tasks(stats):
        if sum(row["rays"] for row in task) >= 1000:
            held.append(sum(row["seconds"] for row in task) <= task[0]["bound_s"])
        for row in task:
            if row["rays"] >= 1000:
                predicted, true = found.get(row["stage"], (0.0, 0.0))
                found[row["stage"]] = (predicted + row["predicted_s"], true + row["seconds"])
    for letter, (predicted, true) in found.items():
        into.setdefault(letter, []).append(abs(predicted - true) / true)


def table3(args):
    found, held = [], []
    for name, scene in (("cornell", CORNELL), ("corridor", CORRIDOR)):
        into = {}
        for seed in range(args.repeats):
            more = ["--time", str(args.time), "--spp", str(args.spp), "--seed", str(seed)]
            errors(render(args, f"{name}{seed}", scene, "(TRSMGD)3", more, (args.size, args.size)), into, held)
        found.append(into)
    into = {}
    profile = os.path.join(args.out, "library.profile.json")
    with open("stimuli/library/walk.vf") as file:
        views = [line.split()[1:] for line in file if line.startswith("rvu")]
    for frame in range(10):
        scene = (LIBRARY[0], views[frame * len(views) // 10])
        more = ["--time", str(min(4.0, args.time)), "--profile", profile, "-pa", "0"]
        render(args, f"first{frame}", scene, "(TT[RS]G)3D", more, (256, 179))
    # The paper did not let the frames improve the cache.
    copy = os.path.join(args.out, "copy.profile.json")
    for frame in range(args.frames):
        scene = (LIBRARY[0], views[frame * len(views) // args.frames])
        shutil.copyfile(profile, copy)
        more = ["--time", str(args.time), "--spp", str(args.spp), "--profile", copy]
        errors(render(args, f"frame{frame}", scene, "(TT[RS]G)3D", more, (args.size, args.size)), into, held)
    found.append(into)
    print("| component | Cornell box | corridor | library |\n|---|---|---|---|")
    every = []
    for letter in "SDGTRM":
        cells = []
        for place, into in enumerate(found):
            theirs = PAPER[letter][place]
            ours = into.get(letter)
            if ours:
                every.append(100 * statistics.mean(ours))
            cells.append(f"{f'{every[-1]:.1f} %' if ours else '-'} (paper {theirs if theirs is not None else '-'})")
        print(f"| {letter} | {' | '.join(cells)} |")
    if every:
        print(f"\nmedian {statistics.median(every):.1f} %, worst {max(every):.1f} % (paper 13 %, 40 %)")
    if held:
        print(f"{100 * sum(held) / len(held):.1f} % of {len(held)} tasks ended within their bound of 95 %")


def figures(args):
    print("| figure | bound s | of the whole | wall s | rounds | executed | predicted s | true s |\n|---|---|---|---|---|---|---|---|")
    for name, scene, crex, parts in FIGURES:
        whole = render(args, f"{name}_whole", scene, crex, ["--spp", str(args.spp)], (args.size, args.size))["wall_s"]
        for part in parts:
            bound = part * whole
            more = ["--spp", str(args.spp), "--time", f"{bound:.3f}"]
            stats = render(args, f"{name}_{part:.3f}", scene, crex, more, (args.size, args.size))
            ran = [row for row in stats["stages"] if row["predicted_s"] and not row["skipped"]]
            predicted, true = (sum(row[key] for row in ran) for key in ("predicted_s", "seconds"))
            print(f"| {name} | {bound:.2f} | {part:.3f} | {stats['wall_s']:.2f} | {len(stats['timed']['rounds'])} | "
                  f"`{stats['executed'] or '(primary)'}` | {predicted:.2f} | {true:.2f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["table3", "figures"])
    parser.add_argument("--crex", default="target/release/crex")
    parser.add_argument("--out", required=True)
    parser.add_argument("--size", type=int, default=None)
    parser.add_argument("--frames", type=int, default=180)
    parser.add_argument("--spp", type=int, default=4, help="samples a pixel: tasks of a few milliseconds measure the clock")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--time", type=float, default=10.0, help="seconds for each picture of table3: enough for all tasks")
    args = parser.parse_args()
    args.size = args.size or (1200 if args.what == "figures" else 512)
    os.makedirs(args.out, exist_ok=True)
    begun = time.time()
    (table3 if args.what == "table3" else figures)(args)
    print(f"\n{time.time() - begun:.0f} s", file=sys.stderr)


if __name__ == "__main__":
    main()
