#!/usr/bin/env python3
"""Whether quality falls anywhere as the bound grows: pictures under bounds from 0.3 s to 20 s against a long reference.

    python3 renderer/benches/quality.py --crex target/release/crex --out quality [--width 320] [--spp 256] [--samples 4]

For each scene and bound: JOD of ColorVideoVDP on the display of the 2005 experiment, filled by the picture, and the mean squared
relative error (`crex compare`), each the mean over --seeds pictures. A fall is a JOD lower by more than 0.05 than the best at a
smaller bound. What is in the folder already is not rendered again. --costs gives each run the profile of the ones before, as an
animation would have it.
"""
import argparse
import csv
import json
import os
import statistics
import subprocess
import sys

SCENES = {
    "corridor": (["stimuli/corridor/materials.rad", "stimuli/corridor/shell.rad", "stimuli/corridor/layout_a.rad"],
                 "stimuli/corridor/corridor.vf", "T[RS](GM)D"),
    "cornell": (["stimuli/cornell/cornell.rad"], "stimuli/cornell/cornell.vf", "(TRSMGD)*"),
    "library": (["stimuli/library/library.rad"], "stimuli/library/library.vf", "(TT[RS]G)*D"),
}
BOUNDS = [0.3, 0.55, 1.0, 1.8, 3.3, 6.0, 11.0, 20.0]
LIMITS = ["-lr", "-12", "-lw", "0.2"]
DISPLAY = """peak_cd_m2 = 250
black_cd_m2 = 0.5
width_px = {width}
height_px = {height}
width_m = 0.3372
distance_m = 0.6
"""


def run(words):
    done = subprocess.run(words, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(words)}\n{done.stderr}")
    return done.stdout


def picture(args, scene, name, more):
    path = os.path.join(args.out, f"{scene}_{name}.hdr")
    if not os.path.exists(path):
        files, view, crex = SCENES[scene]
        run([args.crex, "render", *files, "-vf", view, "-x", str(args.width), "-y", str(args.width), "--crex", crex, *LIMITS,
             "-o", path, *more])
    return path


def exposure(args, scene):
    """The one that pfilt would choose: mean luminance at half of white."""
    path = os.path.join(args.out, f"{scene}.exposure")
    if not os.path.exists(path):
        files, view, _ = SCENES[scene]
        words = [args.crex, "auto", *files, "-vf", view, "-x", str(args.width), "-y", str(args.width), *LIMITS, "--json"]
        found = json.loads(run(words))["exposure"]
        with open(path, "w") as file:
            file.write(str(found))
    with open(path) as file:
        return file.read()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--crex", default="target/release/crex")
    parser.add_argument("--out", default="quality")
    parser.add_argument("--width", type=int, default=320)
    parser.add_argument("--spp", type=int, default=256, help="samples of the reference")
    parser.add_argument("--samples", type=int, default=4, help="samples asked for under a bound: what the rounds have at most")
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--bounds", type=float, nargs="+", default=BOUNDS)
    parser.add_argument("--scenes", nargs="+", default=list(SCENES), choices=list(SCENES))
    parser.add_argument("--costs", action="store_true")
    args = parser.parse_args()
    os.makedirs(args.out, exist_ok=True)
    rows = []
    print("| scene | bound s | JOD | relative MSE |\n|---|---|---|---|")
    falls = 0
    for scene in args.scenes:
        reference = picture(args, scene, "reference", ["--spp", str(args.spp), "--seed", "7777"])
        with open(reference, "rb") as file:
            height = next(int(line.split()[1]) for line in file if line.startswith(b"-Y "))
        display = os.path.join(args.out, f"{scene}.toml")
        with open(display, "w") as file:
            file.write(DISPLAY.format(width=args.width, height=height))
        shown = exposure(args, scene)
        best = 0.0
        for bound in args.bounds:
            found = []
            for seed in range(args.seeds):
                more = ["--time", str(bound), "--spp", str(args.samples), "--seed", str(seed)]
                if args.costs:
                    more += ["--profile", os.path.join(args.out, f"{scene}.json")]
                made = picture(args, scene, f"{bound}_{seed}", more)
                found.append(json.loads(run([args.crex, "compare", reference, made, "--display", display, "--exposure", shown,
                                             "--json"])))
            jod = statistics.mean(row["jod"] for row in found)
            error = statistics.mean(row["rel_mse"] for row in found)
            fell = jod < best - 0.05
            falls += fell
            best = max(best, jod)
            rows.append(dict(scene=scene, bound_s=bound, jod=f"{jod:.3f}", rel_mse=f"{error:.5f}"))
            print(f"| {scene} | {bound} | {jod:.3f}{' (falls)' if fell else ''} | {error:.5f} |", flush=True)
    with open(os.path.join(args.out, "quality.csv"), "w", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    print(f"\n{falls} falls by more than 0.05 JOD in {len(rows)} steps")


if __name__ == "__main__":
    main()
