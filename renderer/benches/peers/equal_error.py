"""CPU seconds to a given error of crex and of other renderers on six scenes, and on what of them all can read.

    pip install pyradiance mitsuba numpy OpenEXR mapbox_earcut      (in a virtual environment outside the project)
    KEEP=folder python renderer/benches/peers/equal_error.py CREX ["SCENE/SCENE.." or all [crex,rpict,mitsuba,cycles]]

SCENES names a folder with Radiance's object library (office, cabin, lib; `.pic` names of pictures that are there as `.hdr`), CORNELL one with
cornell_d.rad and cornell.vf, CYCLES_PYTHON a Python that has bpy (see `blender.py`); what is not named is said to be skipped. What was measured is
kept in KEEP, so that a run that was stopped goes on, and crex's own points go with the program that made them.

Everybody solves the same: direct light, at most 5 diffuse bounces, mirrors, panes and gloss without limit but Russian roulette.
Error: sqrt(mean((x - r)^2 / (r^2 + .01 mean(r)^2))) on luminance, with two independent references by crex, so that their own noise cancels.
Seconds are CPU seconds of one thread without start-up: of crex and rpict, those of a picture of one pixel are taken off; of Mitsuba and
Cycles, rendering alone is counted.

rpict without its cache is read from the difference of two pictures, so a difference from crex is not called an error of it. With its cache,
a first run fills the cache; two more with that cache tell by their difference the noise that more rays lessen, and by the references what stays.
"""

import datetime
import hashlib
import json
import math
import os
import re
import sys
from pathlib import Path

import numpy as np

import programs
from pictures import BRIGHT, squared_error, squared_noise
from scenes import scenes
from times import GOALS, Table, summary

REFERENCE, REFERENCE_OF = 256, {"library": 384, "library, matt": 384}
# Rays along a pixel's side (thrice as many where few bright paths rule the noise); settings.
UNCACHED = ((2, "-ad 1 -lr -12 -lw .2 -ds 0"), (2, "-ad 4 -lr -12 -lw .05 -ds 0"))
UNCACHED_MATT = ((1, "-ad 8 -lr 12 -lw 1e-5 -ds .15"),)
CACHED = ("-aa .2 -ar 64 -ad 256 -as 64", "-aa .1 -ar 256 -ad 1024 -as 256")
LIMIT = 90  # seconds of filling a cache


class Kept:
    """What was measured, by its name, in a file."""

    def __init__(self, path):
        self.path = path
        self.all = json.loads(path.read_text()) if path.exists() else {}

    def get(self, name, measure):
        if name not in self.all:
            self.all[name] = measure()
            self.path.write_text(json.dumps(self.all, indent=1))
        return self.all[name]


def luminance(picture):
    return float((picture @ BRIGHT).mean())


def build_of(program):
    return hashlib.sha256(program.read_bytes()).hexdigest()[:12]


def measure(scene, program, who, keep):
    stem = scene.name.replace(", ", "_")
    kept = Kept(keep / f"{stem}.json")
    build = build_of(program)
    samples = REFERENCE_OF.get(scene.name, REFERENCE)
    paths = [keep / f"{stem}_{i}.npy" for i in (1, 2)]
    for seed, path in enumerate(paths, 1001):
        if not path.exists():
            picture, kept.all[f"crex {build} reference {seed}"] = programs.crex(program, scene, samples, seed)
            np.save(path, picture)
    references = [np.load(path) for path in paths]
    middle = (references[0] + references[1]) / 2
    bright, noise = luminance(middle), squared_noise(*references, middle)
    print(f"\n### {scene.name}, {scene.width} x {scene.height}\n")
    print(f"References of {samples} samples, noise of each {100 * math.sqrt(noise):.2f} %.\n")
    print("| renderer | setting | CPU s | error, % | mean / reference |\n|---|---|---|---|---|")
    table = Table()
    judged = lambda picture: (math.sqrt(max(squared_error(picture, references), 1e-12)), luminance(picture) / bright)
    if "crex" in who:
        start = kept.get(f"crex {build} start", lambda: programs.crex(program, scene, 1, 1, size=(1, 1))[1])

        def point(samples, *more):
            picture, seconds = programs.crex(program, scene, samples, samples, *more)
            return [seconds - start, *judged(picture)]

        for count in (16, 64):
            table.add("crex", f"{count} spp", *kept.get(f"crex {build} {count}", lambda: point(count)))
        times = [kept.all.get(f"crex {build} reference {seed}") for seed in (1001, 1002)]
        if all(times):
            table.add("crex", f"{samples} spp, the references", sum(times) / 2 - start, math.sqrt(noise), 1.0)
        table.read("crex")
        smooth = f"crex --filter {scene.filters}"
        for count in (4, 16, 64, 256):
            row = kept.get(f"crex {build} filter {count}", lambda: point(count, "--filter", scene.filters))
            table.add(smooth, f"{count} spp", *row)
            if row[1] < GOALS[-1]:
                break
        table.read(smooth, is_unbiased=False)
    if "rpict" in who and not scene.name.endswith("matt"):
        by_rpict(scene, kept, table, keep, references, middle, bright)
    if scene.is_matt and "mitsuba" in who:
        counts = (16, 64, 256)
        rows = lambda: [(s, seconds, *judged(picture)) for _, s, picture, seconds in programs.mitsuba_points(scene, counts)]
        for count, *row in kept.get("mitsuba", rows):
            table.add("Mitsuba", f"{count} spp", *row)
        table.read("Mitsuba")
    if scene.is_matt and "cycles" in who:

        def by_cycles(count, *more):
            picture, seconds = programs.cycles(scene, count, *more)
            return [seconds, *judged(picture)]

        for count in (16, 64, 256):
            table.add("Cycles", f"{count} spp", *kept.get(f"cycles {count}", lambda: by_cycles(count)))
        table.read("Cycles")
        for count in (4, 16, 64, 256):
            row = kept.get(f"cycles denoised {count}", lambda: by_cycles(count, "denoised"))
            table.add("Cycles, denoised", f"{count} spp", *row)
        table.read("Cycles, denoised", is_unbiased=False)
    return table.times


def by_rpict(scene, kept, table, keep, references, middle, bright):
    stem = scene.name.replace(", ", "_")
    octree, cache = keep / f"{stem}.oct", keep / f"{stem}.amb"
    if not octree.exists():
        programs.octree(scene, octree)
    start = kept.get("rpict start", lambda: programs.rpict(scene, octree, 1, "-aa", 0, size=(1, 1))[1])

    def pair(over, *options):
        (one, t1), (other, t2) = (programs.rpict(scene, octree, over, *options) for _ in range(2))
        mean = (luminance(one) + luminance(other)) / 2 / bright
        total = (squared_error(one, references) + squared_error(other, references)) / 2
        return (t1 + t2) / 2 - start, squared_noise(one, other, middle), total, mean

    def cached(setting, limit):
        options = [*setting.split(), "-lr", 12, "-lw", 1e-4, "-ds", 0.15, "-af", cache]
        cache.unlink(missing_ok=True)
        picture, fill = programs.rpict(scene, octree, 1, *options, limit=limit)
        return None if picture is None else [fill - start, *pair(2, *options)]

    for over, setting in UNCACHED + (UNCACHED_MATT if scene.is_matt else ()):
        over *= 3 if scene.name.startswith("library") else 1
        seconds, noise, total, mean = kept.get(f"rpict {over} {setting}", lambda: pair(over, "-aa", 0, "-as", 0, *setting.split()))
        table.add("rpict, no cache", f"{over**2} rays, `-aa 0 {setting}`", seconds, math.sqrt(noise), mean)
        table.offer("rpict", [(seconds * noise / goal**2, "~ no cache") for goal in GOALS])
    fill = 0
    for setting in CACHED:
        if fill > LIMIT / 4:
            print(f"| rpict, cache | `{setting}` | not tried, as the coarser cache took {fill:.1f} | | |")
            continue
        found = kept.get(f"rpict {setting}", lambda: cached(setting, LIMIT))
        if found is None:
            print(f"| rpict, cache | `{setting}` | not filled in {LIMIT} | | |")
            continue
        fill, seconds, noise, total, mean = found
        stays = total - noise
        told = f"4 rays, `{setting}`; {100 * math.sqrt(max(stays, 0)):.2f} % stays; the cache took {fill:.1f} of the time"
        table.add("rpict, cache", told, fill + seconds, math.sqrt(total), mean)
        rays = [4 * noise / (goal**2 - stays) if goal**2 > stays else None for goal in GOALS]
        table.offer("rpict", [(fill + n * seconds / 4, "~ cache") if n else (None, "never") for n in rays])


def main():
    program = Path(sys.argv[1]).resolve()
    only = sys.argv[2].split("/") if len(sys.argv) > 2 and sys.argv[2] != "all" else None
    who = (sys.argv[3] if len(sys.argv) > 3 else "crex,rpict,mitsuba,cycles").split(",")
    keep = Path(os.environ["KEEP"]).resolve()
    keep.mkdir(parents=True, exist_ok=True)
    if "cycles" in who and "CYCLES_PYTHON" not in os.environ:
        print("Cycles is skipped: CYCLES_PYTHON names no Python")
        who.remove("cycles")
    processor = re.search("model name.*: (.*)", Path("/proc/cpuinfo").read_text())[1]
    told = programs.run([program, "--version"])[0].decode().strip()
    print(f"{datetime.date.today()}, {processor}; {told}, build {build_of(program)}")
    all_times = {}
    for name, scene in scenes(keep, only):
        if only and name not in only:
            continue
        if scene:
            all_times[name] = measure(scene, program, who, keep)
        else:
            print(f"\n{name} is skipped: its folder is not named")
    for goal in range(len(GOALS)):
        summary(all_times, goal)


main()
