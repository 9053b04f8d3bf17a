"""CPU seconds to a given error of crex and of other renderers on one scene, in one run.

    pip install pyradiance mitsuba numpy OpenEXR      (in a virtual environment outside the project)
    python renderer/benches/peers/equal_error.py CREX SCENE.rad SCENE.vf REFERENCE.exr [crex,rpict,mitsuba,cycles]

For Cycles, CYCLES_PYTHON names a Python that has bpy (see `blender.py`).

The scene must hold polygons of plastic without gloss and `light`s, so that all solve the same problem: direct light and
5 diffuse bounces, box filter. Error: sqrt(mean((x - r)^2 / (r^2 + .01 mean(r)^2))) on luminance. CPU seconds are user and
system time of the process on one thread; crex and rpict with all start-up, Mitsuba's and Cycles' rendering alone. Each setting is run once; times
to 5, 2 and 1 % are read between points by error ~ time^slope, and beyond the last by time^-1/2 (marked ~). What lies on a floor of
bias above the error is marked `never`.
"""

import os
import re
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import OpenEXR

from polygons import read as polygons_of, view_numbers

BRIGHT = np.array([0.265074126, 0.670114631, 0.064811243])
SIZE = 256


def exr(path):
    channels = OpenEXR.File(str(path)).parts[0].channels
    whole = channels.get("RGB") or channels.get("RGBA")
    rgb = whole.pixels[..., :3] if whole else np.stack([channels[c].pixels for c in "RGB"], -1)
    return np.asarray(rgb, float)


def rgbe(data):
    """Radiance's picture format, run-length encoded, row 0 at the top."""
    end = data.index(b"\n\n") + 2
    line = data.index(b"\n", end)
    height, width = map(int, re.match(rb"-Y +(\d+) +\+X +(\d+)", data[end:line]).groups())
    at, rows = line + 1, np.empty((height, width, 4), np.uint8)
    for row in rows:
        at += 4
        for channel in range(4):
            x = 0
            while x < width:
                code = data[at]
                if code > 128:
                    row[x : x + code - 128, channel] = data[at + 1]
                    x, at = x + code - 128, at + 2
                else:
                    row[x : x + code, channel] = np.frombuffer(data, np.uint8, code, at + 1)
                    x, at = x + code, at + 1 + code
    mantissa, exponent = rows[..., :3].astype(float), rows[..., 3:].astype(float)
    return np.where(exponent > 0, (mantissa + 0.5) * np.exp2(exponent - 136), 0.0)


def error(picture, reference):
    x, r = picture @ BRIGHT, reference @ BRIGHT
    return float(np.sqrt(np.mean((x - r) ** 2 / (r**2 + 0.01 * r.mean() ** 2))))


def run(words, **more):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    out = subprocess.run(words, check=True, capture_output=True, **more).stdout
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return out, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def crex(program, scene, view, samples, *more):
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder, "a.exr")
        size = ["-x", str(SIZE), "-y", str(SIZE)]
        words = [program, "render", scene, "-vf", view, *size, "--crex", "D5", "--spp", str(samples), "-n", "1", "-o", out]
        _, seconds = run([*map(str, words), *more])
        return exr(out), seconds


def rpict(scene, view, over, *more):
    import pyradiance

    tools = Path(pyradiance.__file__).parent / "bin"
    env = {**os.environ, "RAYPATH": f".:{Path(pyradiance.__file__).parent / 'lib'}"}
    octree, _ = run([tools / "oconv", scene], env=env)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "a.oct")
        path.write_bytes(octree)
        size = ["-x", str(SIZE * over), "-y", str(SIZE * over)]
        fixed = "-u+ -ps 1 -pt 0 -pj 1 -dj 1 -ds .15 -dt 0 -dc 1 -lr 12 -lw 1e-5 -ab 5".split()
        picture, seconds = run([tools / "rpict", "-vf", view, *size, *fixed, *more, path], env=env)
    picture = rgbe(picture).reshape(SIZE, over, SIZE, over, 3).mean((1, 3))
    return picture, seconds


def mitsuba_scene(scene, view, variant):
    import mitsuba

    mitsuba.set_variant(variant)
    materials, polygons = polygons_of(scene)
    shapes = {}
    for name, modifier, corners in polygons:
        corners = np.array(corners)
        mesh = mitsuba.Mesh(name, len(corners), len(corners) - 2)
        parameters = mitsuba.traverse(mesh)
        parameters["vertex_positions"] = corners.astype(np.float32).ravel()
        parameters["faces"] = np.array([[0, i, i + 1] for i in range(1, len(corners) - 1)], np.uint32).ravel()
        parameters.update()
        path = Path(tempfile.gettempdir(), f"equal_error_{os.getpid()}_{name}.ply")
        mesh.write_ply(str(path))
        kind, color = materials[modifier]
        shapes[name] = {"type": "ply", "filename": str(path), "face_normals": True}
        spectrum = {"type": "rgb", "value": color}
        if kind == "light":
            shapes[name]["emitter"] = {"type": "area", "radiance": spectrum}
            shapes[name]["bsdf"] = {"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.0}}
        else:
            shapes[name]["bsdf"] = {"type": "diffuse", "reflectance": spectrum}
    number = lambda flag, n: view_numbers(view, flag, n)
    origin, way = np.array(number("-vp", 3)), np.array(number("-vd", 3))
    to_world = mitsuba.ScalarTransform4f().look_at(list(origin), list(origin + way), number("-vu", 3))
    film = {"type": "hdrfilm", "width": SIZE, "height": SIZE, "rfilter": {"type": "box"}, "component_format": "float32"}
    camera = {"type": "perspective", "fov": number("-vh", 1)[0], "fov_axis": "x", "to_world": to_world, "film": film}
    integrator = {"type": "path", "max_depth": 7, "rr_depth": 100}
    loaded = mitsuba.load_dict({"type": "scene", "integrator": integrator, "camera": camera, **shapes})
    return mitsuba, loaded


def mitsuba_points(scene, view, counts):
    for variant in ("llvm_ad_rgb", "scalar_rgb"):
        try:
            mitsuba, loaded = mitsuba_scene(scene, view, variant)
            sampler = {"type": "multijitter"}
            for samples in [counts[0], *counts]:
                sampler["sample_count"] = samples
                loaded.sensors()[0].sampler().set_sample_count(samples)
                start = time.process_time()
                picture = np.array(mitsuba.render(loaded, spp=samples, seed=samples))
                yield variant, samples, picture, time.process_time() - start
            return
        except Exception as problem:  # a variant that this machine cannot run
            print(f"mitsuba {variant}: {str(problem).splitlines()[0]}", file=sys.stderr)


def cycles(scene, view, samples, *more):
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder, "a.exr")
        python = os.environ.get("CYCLES_PYTHON", sys.executable)
        words = [python, Path(__file__).with_name("blender.py"), scene, view, SIZE, out, samples, *more]
        told, _ = run([*map(str, words)])
        return exr(out), float(re.search(rb"CPU seconds: (\S+)", told)[1])


def time_to(points, goal):
    points = sorted(points)
    for (t0, e0), (t1, e1) in zip(points, points[1:]):
        if e1 <= goal < e0:
            return f"{t0 * (t1 / t0) ** (np.log(e0 / goal) / np.log(e0 / e1)):.3g}"
    if points[0][1] <= goal:
        return f"< {points[0][0]:.3g}"
    (t0, e0), (t1, e1) = points[-2:]
    slope = np.log(e0 / e1) / np.log(t1 / t0)
    return f"~{t1 * (e1 / goal) ** 2:.3g}" if slope > 0.4 else "never (~)"


def main():
    program, scene, view, reference = sys.argv[1:5]
    who = (sys.argv[5] if len(sys.argv) > 5 else "crex,rpict,mitsuba").split(",")
    reference = exr(reference)
    curves = {}

    def add(name, setting, picture, seconds):
        off = error(picture, reference)
        curves.setdefault(name, []).append((seconds, off))
        mean = picture.mean() / reference.mean()
        print(f"| {name} | {setting} | {seconds:.2f} | {100 * off:.2f} | {mean:.4f} |", flush=True)

    print("| renderer | setting | CPU s | error, % | mean / reference |\n|---|---|---|---|---|")
    if "crex" in who:
        for samples in (4, 16, 64, 128):
            add("crex --filter D", f"{samples} spp", *crex(program, scene, view, samples, "--filter", "D"))
        for samples in (16, 64):
            add("crex", f"{samples} spp", *crex(program, scene, view, samples))
    if "rpict" in who:
        cached = "-aa .1 -ar 256 -ad 1024 -as 256".split()
        for over, more in ((1, "-aa .2 -ar 64 -ad 256 -as 64".split()), (2, cached), (3, cached)):
            add("rpict, cache", f"{over}x{over} spp {' '.join(more)}", *rpict(scene, view, over, *more))
        for over in (1, 2):
            add("rpict, no cache", f"{over}x{over} spp -aa 0 -ad 8", *rpict(scene, view, over, *"-aa 0 -ad 8 -as 0".split()))
    if "mitsuba" in who:
        for index, (variant, samples, picture, seconds) in enumerate(mitsuba_points(scene, view, (16, 64))):
            if index > 0:  # the first compiles
                add(f"Mitsuba {variant}", f"{samples} spp", picture, seconds)
    if "cycles" in who:
        for samples in (16, 64):
            add("Cycles", f"{samples} spp", *cycles(scene, view, samples))
        for samples in (4, 16):
            add("Cycles, denoised", f"{samples} spp", *cycles(scene, view, samples, "denoised"))
    print("\n| renderer | CPU s to 5 % | to 2 % | to 1 % |\n|---|---|---|---|")
    for name, points in curves.items():
        print(f"| {name} | " + " | ".join(time_to(points, goal) for goal in (0.05, 0.02, 0.01)) + " |")


main()
