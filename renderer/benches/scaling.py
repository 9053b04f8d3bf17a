#!/usr/bin/env python3
"""How time and memory grow with threads, pixels, polygons, lights and depth: the tables of docs/scale.md.

    cargo build --release -p renderer
    python3 renderer/benches/scaling.py [--crex target/release/crex] [TABLE...]     threads pixels polygons lights depth memory

Prints Markdown. Scenes are made in a temporary folder. CPU s is user and system time of the process; they stay comparable on a
busy machine, wall seconds do not. "load" is the same scene with one ray: reading, and building the hierarchy.
The largest of polygons and memory take minutes and gigabytes: --most-polygons, --most-pixels bound them.
"""
import argparse
import json
import os
import platform
import subprocess
import sys
import tempfile
import time

ROOM = """void light lamp 0 0 3 20 20 20
void plastic white 0 0 5 .6 .6 .6 .03 .1
void mirror silver 0 0 3 .8 .8 .8
void glass pane 0 0 3 .9 .9 .9
white bubble shell 0 0 4 0 0 1.5 3
silver polygon m 0 0 12 -1 1.5 .5 1 1.5 .5 1 1.5 2 -1 1.5 2
pane polygon p 0 0 12 -1 0 .5 0 0 .5 0 0 2 -1 0 2
lamp polygon l 0 0 12 -.5 -1 3 -.5 0 3 .5 0 3 .5 -1 3
"""
ROOM_VIEW = "-vp 0 -1.9 1.2 -vd 0 1 -.1 -vh 70 -vv 70".split()
ABOVE = "-vp 5 -6 6 -vd 0 1 -.6 -vh 50 -vv 50".split()


class Run:
    """A finished process: CPU and wall seconds, peak memory in MB, and what --stats said."""

    def __init__(self, crex, folder, words):
        stats = os.path.join(folder, "stats.json")
        begun = time.monotonic()
        process = subprocess.Popen([crex, "render", *map(str, words), "--stats", stats], cwd=folder,
                                   stderr=subprocess.PIPE, text=True)
        message = process.stderr.read()
        _, status, used = os.wait4(process.pid, 0)
        if status != 0:
            sys.exit(f"{' '.join(map(str, words))}: {message}")
        self.wall = time.monotonic() - begun
        self.cpu = used.ru_utime + used.ru_stime
        self.megabytes = used.ru_maxrss / 1024
        with open(stats) as file:
            self.stats = json.load(file)
        self.rays = sum(stage["rays"] for stage in self.stats["stages"])


class Bench:
    def __init__(self, options, folder):
        self.options, self.folder, self.crex = options, folder, os.path.abspath(options.crex)

    def scene(self, name, text):
        with open(os.path.join(self.folder, name), "w") as file:
            file.write(text)
        return name

    def run(self, *words):
        return Run(self.crex, self.folder, words)

    def threads(self):
        room = self.scene("room.rad", ROOM)
        head("threads", "CPU s", "wall s", "speed against one", "CPU against one")
        first = None
        counts = [1]
        while counts[-1] * 2 <= os.cpu_count():
            counts.append(counts[-1] * 2)
        for count in counts:
            # One repeats the other; the least is what the machine's other work disturbed least.
            runs = [self.run(room, *ROOM_VIEW, "-x", 512, "-y", 512, "--crex", "(TRSGMD)*", "--spp", 16, "-lr", -12, "-lw", .1,
                             "--threads", count, "-o", "o.hdr") for _ in range(self.options.repeat)]
            cpu, wall = min(run.cpu for run in runs), min(run.wall for run in runs)
            first = first or (cpu, wall)
            row(count, f"{cpu:.2f}", f"{wall:.2f}", f"{first[1] / wall:.2f}", f"{cpu / first[0]:.3f}")

    def pixels(self):
        room = self.scene("room.rad", ROOM)
        head("pixels", "rays", "CPU s", "us a pixel", "rays a CPU us")
        for size in [128, 256, 512, 1024, 2048]:
            run = self.run(room, *ROOM_VIEW, "-x", size, "-y", size, "--crex", "TRSGMD", "-o", "o.hdr")
            row(f"{size} x {size}", run.rays, f"{run.cpu:.2f}", f"{1e6 * run.cpu / size**2:.2f}",
                f"{1e-6 * run.rays / run.cpu:.2f}")

    def polygons(self):
        head("polygons", "load, CPU s", "us a polygon", "peak MB", "bytes a polygon", "rays a CPU us")
        for power in [4, 5, 6, 7]:
            if 10**power > self.options.most_polygons:
                break
            side = round((10**power / 2) ** 0.5)
            scene = self.scene("surface.rad", f"""void plastic white 0 0 5 .6 .6 .6 0 0
void light lamp 0 0 3 2000 2000 2000
lamp sphere sun 0 0 4 5 0 30 1
!gensurf white hill '10*s' '10*t' '.4*sin(31*s)*cos(29*t)+.05*sin(97*s+61*t)' {side} {side}
""")
            # One ray: what reading and building take.
            load = self.run(scene, *ABOVE, "-x", 1, "-y", 1, "--crex", "", "-o", "o.hdr")
            traced = self.run(scene, *ABOVE, "-x", 512, "-y", 512, "--spp", 4, "--crex", "D", "-o", "o.hdr")
            made = 2 * side * side
            row(made, f"{load.cpu:.2f}", f"{1e6 * load.cpu / made:.2f}", f"{load.megabytes:.0f}",
                f"{1e6 * load.megabytes / made:.0f}", f"{1e-6 * traced.rays / max(1e-9, traced.cpu - load.cpu):.2f}")

    def lights(self):
        head("lights", "load, CPU s", "peak MB", "CPU s", "us a ray")
        for power in range(5):
            side = 10 ** (power / 2)
            count = 10**power
            columns = max(1, round(side))
            text = ["void plastic white 0 0 5 .6 .6 .6 0 0", f"void light lamp 0 0 3 {2e3 / count} {2e3 / count} {2e3 / count}",
                    "white polygon floor 0 0 12 0 0 0 10 0 0 10 10 0 0 10 0"]
            for light in range(count):
                x, y = light % columns, light // columns
                step = 10 / columns
                text.append(f"lamp sphere l{light} 0 0 4 {(x + .5) * step:.4f} {(y + .5) * step:.4f} 3 .01")
            scene = self.scene("lights.rad", "\n".join(text) + "\n")
            view = "-vp 5 -6 2.5 -vd 0 1 -.2 -vh 50 -vv 50".split()
            load = self.run(scene, *view, "-x", 1, "-y", 1, "--crex", "", "-o", "o.hdr")
            traced = self.run(scene, *view, "-x", 256, "-y", 256, "--crex", "D", "-o", "o.hdr")
            row(count, f"{load.cpu:.2f}", f"{load.megabytes:.0f}", f"{traced.cpu:.2f}",
                f"{1e6 * (traced.cpu - load.cpu) / traced.rays:.2f}")

    def depth(self):
        # Two mirrors face one another: every ray meets one again and again.
        scene = self.scene("mirrors.rad", """void mirror silver 0 0 3 .99 .99 .99
void light lamp 0 0 3 1 1 1
silver polygon a 0 0 12 -50 2 -50 50 2 -50 50 2 50 -50 2 50
silver polygon b 0 0 12 -50 -2 -50 -50 -2 50 50 -2 50 50 -2 -50
lamp sphere l 0 0 4 0 1 0 .1
""")
        head("reflections", "runs of M", "rays", "CPU s", "us a ray")
        for depth in [1, 4, 16, 64, 256, 1024]:
            run = self.run(scene, *"-vp 0 0 0 -vd .01 1 .02 -vh 10 -vv 10 -x 128 -y 128 -lw 0 --crex M*".split(), "-lr", depth,
                           "-o", "o.hdr")
            runs = len([stage for stage in run.stats["stages"] if stage["rays"] and stage["stage"] == "M"])
            row(depth, runs, run.rays, f"{run.cpu:.2f}", f"{1e6 * run.cpu / run.rays:.3f}")

    def memory(self):
        room = self.scene("room.rad", ROOM)
        head("pixels", "planes", "planes held whole, MB", "peak, MB", "peak with --memory 65536, MB", "EXR, MB", "CPU s")
        for size in [1024, 2048, 4096, 8192]:
            if size > self.options.most_pixels:
                break
            words = (room, *ROOM_VIEW, "-x", size, "-y", size, "--crex", "TRSGM", "-av", .1, .1, .1, "-o", "o.exr")
            run = self.run(*words)
            bytes_written = os.path.getsize(os.path.join(self.folder, "o.exr"))
            # Direct light, T R S or G M, and the ambient estimate.
            planes = 6
            held = planes * 12 * size**2 / 1e6
            whole = f"{self.run(*words, '--memory', 65536).megabytes:.0f}" if held < 2000 else "-"
            row(f"{size} x {size}", planes, f"{held:.0f}", f"{run.megabytes:.0f}", whole, f"{bytes_written / 1e6:.0f}",
                f"{run.cpu:.0f}")


def head(*names):
    row(*names)
    row(*["---"] * len(names))


def row(*cells):
    print("| " + " | ".join(str(cell) for cell in cells) + " |", flush=True)


def main():
    tables = ["threads", "pixels", "polygons", "lights", "depth", "memory"]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tables", nargs="*", default=tables, metavar="TABLE")
    parser.add_argument("--crex", default="target/release/crex")
    parser.add_argument("--repeat", type=int, default=3, help="runs of each row of `threads`")
    parser.add_argument("--most-polygons", type=int, default=10**7)
    parser.add_argument("--most-pixels", type=int, default=8192, help="edge of the largest picture of `memory`")
    options = parser.parse_args()
    if unknown := [table for table in options.tables if table not in tables]:
        parser.error(f"no table {unknown[0]}: there are {' '.join(tables)}")
    version = subprocess.run([options.crex, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True).stdout.strip()
    print(f"{version}, commit {commit}, {platform.machine()}, {os.cpu_count()} processors, {time.strftime('%Y-%m-%d')}")
    with tempfile.TemporaryDirectory() as folder:
        for table in options.tables:
            print(f"\n{table}\n")
            getattr(Bench(options, folder), table)()


main()
