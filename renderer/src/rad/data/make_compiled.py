#!/usr/bin/env python3
"""Writes compiled.oct (compiled.rad frozen), named.oct (not frozen) and compiled.rtm (a wavy grid of 19 x 19 vertices).

Made with the programs of PyPI's pyradiance 1.3.1 ("RADIANCE 6.0a"), whose folder is given as the argument:
    python3 make_compiled.py .../site-packages/pyradiance/bin
"""
import math
import os
import subprocess
import sys
import tempfile

N = 18


def grid():
    """Wavefront text: x, y in 0..1, z = sin(3x) cos(2y) / 4, normals, texture coordinates x and y."""
    lines = []
    for j in range(N + 1):
        for i in range(N + 1):
            x, y = i / N, j / N
            z = math.sin(3 * x) * math.cos(2 * y) / 4
            dx, dy = 3 * math.cos(3 * x) * math.cos(2 * y) / 4, -2 * math.sin(3 * x) * math.sin(2 * y) / 4
            length = math.sqrt(dx * dx + dy * dy + 1)
            lines.append(f"v {x:.12g} {y:.12g} {z:.12g}")
            lines.append(f"vt {x:.12g} {y:.12g}")
            lines.append(f"vn {-dx / length:.12g} {-dy / length:.12g} {1 / length:.12g}")
    for j in range(N):
        lines.append(f"usemtl {'gold' if j % 2 else 'red'}")
        for i in range(N):
            a = j * (N + 1) + i + 1
            for face in ([a, a + 1, a + N + 2], [a, a + N + 2, a + N + 1]):
                lines.append("f " + " ".join(f"{v}/{v}/{v}" for v in face))
    return "\n".join(lines) + "\n"


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    os.environ["PATH"] = os.path.abspath(sys.argv[1]) + os.pathsep + os.environ["PATH"]
    os.chdir(here)
    for name, options in [("compiled.oct", ["-f"]), ("named.oct", [])]:
        made = subprocess.run(["oconv", *options, "compiled.rad"], capture_output=True, check=True).stdout
        with open(name, "wb") as out:
            out.write(made)
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "a.obj"), "w") as out:
            out.write(grid())
        surfaces = ("same sphere", "clean polygon", "red ring", "gold cylinder")
        with open("compiled.rad") as scene, open(os.path.join(folder, "a.mat"), "w") as out:
            out.writelines(line for line in scene if not line.startswith(surfaces))
        subprocess.run(["obj2mesh", "-a", "a.mat", "a.obj", "a.rtm"], cwd=folder, check=True)
        with open(os.path.join(folder, "a.rtm"), "rb") as mesh, open("compiled.rtm", "wb") as out:
            out.write(mesh.read())


main()
