"""Scenes of polygons with plain materials, and their views, as the scripts beside this one give them to other renderers."""

import math
from pathlib import Path

import numpy as np

SIDES = 16  # of what is round
SURFACES = ("polygon", "sphere", "bubble", "cylinder", "tube", "cone", "cup", "ring")


def primitives(text):
    """Modifier, type, name and numbers of each primitive of a scene's text without commands."""
    words = " ".join(line.split("#")[0] for line in text.splitlines()).split()
    at = 0
    while at < len(words):
        modifier, kind, name = words[at : at + 3]
        reals_at = at + 5 + int(words[at + 3])
        end = reals_at + 1 + int(words[reals_at])
        yield modifier, kind, name, [float(word) for word in words[reals_at + 1 : end]]
        at = end


def read(scene):
    """Materials as (kind, colour) by name, and polygons as (name, material, corners)."""
    materials, polygons = {}, []
    for modifier, kind, name, reals in primitives(Path(scene).read_text()):
        if kind == "polygon":
            polygons.append((name, modifier, [tuple(reals[i : i + 3]) for i in range(0, len(reals), 3)]))
        else:
            materials[name] = (kind, reals[:3])
    return materials, polygons


def circle(centre, axis, radius, sides):
    axis = axis / np.linalg.norm(axis)
    across = np.cross(axis, np.eye(3)[np.argmin(abs(axis))])
    across /= np.linalg.norm(across)
    turns = 2 * math.pi * (np.arange(sides) + 0.5) / sides
    return centre + radius * (np.outer(np.cos(turns), across) + np.outer(np.sin(turns), np.cross(axis, across)))


def band(low, high):
    """Faces between two circles, turned away from their axis."""
    for i in range(len(low)):
        j = (i + 1) % len(low)
        face = [low[i], low[j], high[j], high[i]]
        yield [corner for k, corner in enumerate(face) if k == 0 or np.any(corner != face[k - 1])]


def convex_parts(corners):
    corners = np.array(corners).reshape(-1, 3)
    sides = np.roll(corners, -1, 0) - corners
    turns = np.cross(sides, np.roll(sides, -1, 0))
    normal = sum(np.cross(a - corners[0], b - corners[0]) for a, b in zip(corners[1:], corners[2:]))
    if np.min(turns @ normal) >= -1e-9 * np.max(turns @ normal):
        return [corners]
    import mapbox_earcut

    flat = np.delete(corners, np.argmax(abs(normal)), 1)
    triangles = corners[mapbox_earcut.triangulate_float64(flat, np.array([len(flat)], np.uint32)).reshape(-1, 3)]
    aligned = [np.cross(b - a, c - a) @ normal > 0 for a, b, c in triangles]
    return [triangle if keeps else triangle[::-1] for triangle, keeps in zip(triangles, aligned)]


def faces(kind, numbers, shines):
    """A surface as convex polygons. A disc that shines becomes a square and a ball a cube of as much area: rpict lets all discs
    and polygons of more than four corners shine from such a square."""
    numbers = np.array(numbers)
    if kind == "polygon":
        return convex_parts(numbers)
    if kind in ("sphere", "bubble"):
        centre, radius, up = numbers[:3], numbers[3], np.array([0.0, 0.0, 1.0])
        if shines:
            half = radius * math.sqrt(math.pi / 6)
            ends = [circle(centre + z * up, up, half * math.sqrt(2), 4) for z in (-half, half)]
            return [*band(*ends), ends[0][::-1], ends[1]]
        rows = [math.pi * i / (SIDES // 2) for i in range(SIDES // 2 + 1)]
        circles = [circle(centre - radius * math.cos(a) * up, up, radius * math.sin(a), SIDES) for a in rows]
        circles[0][:], circles[-1][:] = centre - radius * up, centre + radius * up
        made = [[*face] for low, high in zip(circles, circles[1:]) for face in band(low, high)]
        return [face[:-1] if np.all(face[0] == face[-1]) else face for face in made]
    if kind == "ring":
        centre, axis, (inner, outer) = numbers[:3], numbers[3:6], sorted(numbers[6:8])
        if shines:
            return [circle(centre, axis, outer * math.sqrt(math.pi / 2), 4)]
        rim = circle(centre, axis, outer, SIDES)
        return [rim] if inner == 0 else list(band(rim, circle(centre, axis, inner, SIDES)))
    start, end = numbers[:3], numbers[3:6]
    radii = numbers[6:8] if kind in ("cone", "cup") else [numbers[6]] * 2
    made = list(band(*(circle(at, end - start, radius, SIDES) for at, radius in zip((start, end), radii))))
    return [face[:-1] if np.all(face[0] == face[-1]) else face for face in made]


def matt(text):
    """The text of a scene without commands, in convex polygons, with every surface matt in its own colour; `light`s stay, a `glow` is black."""
    lines, materials = [], {}
    for modifier, kind, name, reals in primitives(text):
        if kind in SURFACES:
            for face in faces(kind, reals, materials[modifier] == "light"):
                numbers = " ".join(f"{x:.9g}" for x in np.ravel(face))
                lines.append(f"{modifier} polygon {name} 0 0 {3 * len(face)} {numbers}")
        else:
            materials[name] = kind
            color = "0 0 0" if kind == "glow" else " ".join(map(str, reals[:3]))
            lines.append(f"void light {name} 0 0 3 {color}" if kind == "light" else f"void plastic {name} 0 0 5 {color} 0 0")
    return "\n".join(lines) + "\n"


def view_numbers(view, flag, count):
    """The numbers behind a flag of a view file."""
    words = Path(view).read_text().split()
    at = words.index(flag) + 1
    return [float(word) for word in words[at : at + count]]
