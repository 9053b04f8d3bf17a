"""Scenes of plain materials and polygons, and their views, as the scripts beside this one give them to other renderers."""

from pathlib import Path


def read(scene):
    """Materials as (kind, colour) by name, and polygons as (name, material, corners)."""
    words = " ".join(line.split("#")[0] for line in Path(scene).read_text().splitlines()).split()
    materials, polygons, at = {}, [], 0
    while at < len(words):
        modifier, kind, name = words[at : at + 3]
        reals_at = at + 5 + int(words[at + 3])
        count = int(words[reals_at])
        reals = [float(word) for word in words[reals_at + 1 : reals_at + 1 + count]]
        at = reals_at + 1 + count
        if kind == "polygon":
            polygons.append((name, modifier, [tuple(reals[i : i + 3]) for i in range(0, count, 3)]))
        else:
            materials[name] = (kind, reals[:3])
    return materials, polygons


def view_numbers(view, flag, count):
    """The numbers behind a flag of a view file."""
    words = Path(view).read_text().split()
    at = words.index(flag) + 1
    return [float(word) for word in words[at : at + count]]
