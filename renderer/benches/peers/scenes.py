"""The scenes of `equal_error.py`."""

import math
import os
from pathlib import Path

import programs
from polygons import matt
from programs import Scene

STIMULI = Path(__file__).resolve().parents[3] / "stimuli"


def scenes(keep, only):
    """Names and scenes, no scene where its files are not there; matt ones are made if they are among `only`."""
    corridor, library = (STIMULI / name for name in ("corridor", "library"))
    corridor_files = ["materials.rad", "shell.rad", "layout_a.rad"]
    yield "cornell_d", "CORNELL" in os.environ and Scene(
        "cornell_d", Path(os.environ["CORNELL"]), ["cornell_d.rad"], ["-vf", "cornell.vf"], 96, 96, "D", True
    )
    yield "corridor", Scene("corridor", corridor, corridor_files, ["-vf", "corridor.vf"], 100, 80, "D,G")
    yield "library", Scene("library", library, ["library.rad"], ["-vf", "library.vf"], 80, 57, "D,G")
    radiance = Path(os.environ["SCENES"]) if "SCENES" in os.environ else None
    desk = "-vp 8 36 -27 -vd -0.560723 -0.233635 0.794358 -vu 0 1 0 -vh 39.9 -vv 27.5".split()
    office = "model.b90 desk misc window blinds lights lamp picture".split()
    yield "office", radiance and Scene("office", radiance / "office", office, desk, 108, 73, "D,G")
    living = "-vp 15 9 5 -vd 0.986588 0.0507496 -0.155139 -vu 0 0 1 -vh 60 -vv 45".split()
    cabin = "pattmats cabin bathroom winpanes.rad furniture lights mirrors.rad".split()
    for name, view in (("living", living), ("bed", ["-vf", "vf/bed"])):
        yield f"cabin by night, {name}", radiance and Scene(name, radiance / "cabin", cabin, view, 96, 69, "D,G")
    yield "cornell, all components", Scene(
        "cornell, all components", STIMULI / "cornell", ["cornell.rad"], ["-vf", "cornell.vf"], 80, 80, "D,G"
    )
    for folder, files, width, height in ((corridor, corridor_files, 100, 80), (library, ["library.rad"], 80, 57)):
        name = f"{folder.name}, matt"
        if not only or name in only:
            yield name, matt_scene(name, folder, files, width, height, keep)


def matt_scene(name, folder, files, width, height, keep):
    text, _ = programs.run([programs.RADIANCE / "bin/xform", *files], cwd=folder)
    stem = name.replace(", ", "_")
    (keep / f"{stem}.rad").write_text(matt(text.decode()))
    words = (folder / f"{folder.name}.vf").read_text().split()
    # Square pixels, as all renderers have them.
    wide = math.tan(math.radians(float(words[words.index("-vh") + 1]) / 2))
    words[words.index("-vv") + 1] = f"{2 * math.degrees(math.atan(wide * height / width)):.9g}"
    (keep / f"{stem}.vf").write_text(" ".join(words) + "\n")
    return Scene(name, keep, [f"{stem}.rad"], ["-vf", f"{stem}.vf"], width, height, "D", True)
