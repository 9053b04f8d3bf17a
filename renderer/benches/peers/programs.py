"""One picture of a scene by each of the renderers, and the CPU seconds (user and system, one thread) that it took, start-up left out."""

import dataclasses
import os
import re
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pyradiance

from pictures import exr, rgbe
from polygons import read as polygons_of, view_numbers

RADIANCE = Path(pyradiance.__file__).parent
BOUNCES = 5


@dataclasses.dataclass
class Scene:
    """`files` and `view` as rpict and crex have them, in `folder`; `is_matt` if it is polygons without gloss, and so for all renderers."""

    name: str
    folder: Path
    files: list
    view: list
    width: int
    height: int
    filters: str
    is_matt: bool = False

    @property
    def crex(self):
        return "D*" if self.is_matt else "(TRSGMD)*"


def environment():
    library = [str(Path(os.environ["SCENES"], "lib"))] if "SCENES" in os.environ else []
    path = f"{RADIANCE / 'bin'}:{os.environ['PATH']}"
    return {**os.environ, "PATH": path, "RAYPATH": ":".join([".", *library, str(RADIANCE / "lib")])}


def run(words, **more):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([str(word) for word in words], capture_output=True, env=environment(), **more)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode > 0:
        raise RuntimeError(f"{' '.join(map(str, words))}: {done.stderr.decode(errors='replace').strip()}")
    # A negative code: stopped at its limit of CPU seconds.
    output = done.stdout if done.returncode == 0 else None
    return output, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def crex(program, scene, samples, seed, *more, size=None):
    width, height = size or (scene.width, scene.height)
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder, "a.exr")
        words = [program, "render", *scene.files, *scene.view, "-pa", 0, "-x", width, "-y", height, "--crex", scene.crex]
        words += ["-ab", BOUNCES, "-lr", -12, "-lw", 0.2, "--spp", samples, "--seed", seed, "-n", 1, *more, "-o", out]
        _, seconds = run(words, cwd=scene.folder)
        return exr(out), seconds


def octree(scene, path):
    path.write_bytes(run([RADIANCE / "bin/oconv", *scene.files], cwd=scene.folder)[0])


def rpict(scene, octree, over, *more, size=None, limit=1000):
    """Of `over` x `over` rays a pixel; None if it took more CPU seconds than `limit`. Its random numbers come from the clock's second."""
    time.sleep(1.05)
    width, height = size or (scene.width, scene.height)
    fixed = f"-u+ -ps 1 -pt 0 -pj 1 -dj 1 -dt 0 -dc 1 -dr 1 -dp 4096 -st 0 -ss 1 -pa 0 -ab {BOUNCES}".split()
    words = ["prlimit", f"--cpu={limit}", RADIANCE / "bin/rpict", *scene.view, "-x", width * over, "-y", height * over]
    picture, seconds = run([*words, *fixed, *more, octree], cwd=scene.folder)
    if picture is None or size:
        return None, seconds
    return rgbe(picture).reshape(scene.height, over, scene.width, over, 3).mean((1, 3)), seconds


def mitsuba_scene(scene, variant):
    import mitsuba

    mitsuba.set_variant(variant)
    view = scene.folder / scene.view[1]
    materials, polygons = polygons_of(scene.folder / scene.files[0])
    shapes = {}
    for name, (kind, color) in materials.items():
        corners, triangles = [], []
        for _, modifier, face in polygons:
            if modifier == name:
                triangles += [[len(corners), len(corners) + i, len(corners) + i + 1] for i in range(1, len(face) - 1)]
                corners += face
        if not corners:
            continue
        mesh = mitsuba.Mesh(name, len(corners), len(triangles))
        parameters = mitsuba.traverse(mesh)
        parameters["vertex_positions"] = np.array(corners, np.float32).ravel()
        parameters["faces"] = np.array(triangles, np.uint32).ravel()
        parameters.update()
        path = Path(tempfile.gettempdir(), f"equal_error_{os.getpid()}_{name}.ply")
        mesh.write_ply(str(path))
        shapes[name] = {"type": "ply", "filename": str(path), "face_normals": True}
        spectrum = {"type": "rgb", "value": color}
        if kind == "light":
            shapes[name]["emitter"] = {"type": "area", "radiance": spectrum}
            shapes[name]["bsdf"] = {"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.0}}
        else:
            shapes[name]["bsdf"] = {"type": "twosided", "matt": {"type": "diffuse", "reflectance": spectrum}}
    number = lambda flag, n: view_numbers(view, flag, n)
    origin, way = np.array(number("-vp", 3)), np.array(number("-vd", 3))
    to_world = mitsuba.ScalarTransform4f().look_at(list(origin), list(origin + way), number("-vu", 3))
    film = {"type": "hdrfilm", "width": scene.width, "height": scene.height, "rfilter": {"type": "box"}, "component_format": "float32"}
    camera = {"type": "perspective", "fov": number("-vh", 1)[0], "fov_axis": "x", "to_world": to_world, "film": film}
    camera["sampler"] = {"type": "multijitter"}
    integrator = {"type": "path", "max_depth": BOUNCES + 2, "rr_depth": 100}
    loaded = mitsuba.load_dict({"type": "scene", "integrator": integrator, "camera": camera, **shapes})
    for path in Path(tempfile.gettempdir()).glob(f"equal_error_{os.getpid()}_*.ply"):
        path.unlink()
    return mitsuba, loaded


def mitsuba_points(scene, counts):
    """Variant, samples, picture and seconds of each count, the first of which also compiles beforehand."""
    for variant in ("llvm_ad_rgb", "scalar_rgb"):
        try:
            mitsuba, loaded = mitsuba_scene(scene, variant)
            mitsuba.render(loaded, spp=counts[0]).numpy()
            for samples in counts:
                loaded.sensors()[0].sampler().set_sample_count(samples)
                start = time.process_time()
                picture = np.array(mitsuba.render(loaded, spp=samples, seed=samples))
                yield variant, samples, picture, time.process_time() - start
            return
        except Exception as problem:  # a variant that this machine cannot run
            print(f"mitsuba {variant}: {str(problem).splitlines()[0]}", file=sys.stderr)


def cycles(scene, samples, *more):
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder, "a.exr")
        python = os.environ.get("CYCLES_PYTHON", sys.executable)
        words = [python, Path(__file__).with_name("blender.py"), scene.files[0], scene.view[1]]
        told, _ = run([*words, f"{scene.width}x{scene.height}", out, samples, *more], cwd=scene.folder)
        return exr(out), float(re.search(rb"CPU seconds: (\S+)", told)[1])
