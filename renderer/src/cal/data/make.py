#!/usr/bin/env python3
"""Writes values.txt: expressions with the values that Radiance's own evaluators give them.

Made with the programs of PyPI's pyradiance 1.3.1 ("RADIANCE 6.0a"), whose folder is given as the argument:
    python3 make.py .../site-packages/pyradiance/bin
ev(1) evaluates the plain ones (9 digits), rtrace(1) those of a hit (6 digits, in single precision): the colour of a glowing
plane whose pattern is the expression plus 4, seen from straight above at the points (x, y).
"""
import os
import subprocess
import sys
import tempfile

PLAIN = """\
-2^2
2^3^2
2^-1*3
1-2-3
if(.5-.25, 7, 8)
select(2.4, 5, 6, 7)
min(3, 1, 2)-max(3, 1, 2)
rand(0)
rand(1)
rand(-3.7)
rand(12345.678)
rand(1e9)
floor(-2.5)+ceil(-2.5)
atan2(-1, -2)
log10(1234)
exp(-3)+log(7)
sqrt(2)*sin(1)*cos(2)*tan(3)
asin(.3)+acos(.4)+atan(5)""".splitlines()

HIT = """\
noise3(Px, Py, .3)
noise3(-Px, .25, Py*3)
noise3x(Px, Py, .3)
noise3y(Px, Py, .3)
noise3z(Px, Py, .3)
fnoise3(Px, Py, .3)
fnoise3(-Px, .25, Py)
turbulence(Px, Py, .3, .05)
turbulencex(Px, Py, .3, .25)/100
erf(Px)+erfc(Py)
hermite(1, 2, 3, -1, clip(Px))
bezier(1, 2, 3, -1, clip(Px))
bspline(1, 2, 3, -1, clip(Px))
linterp(.3, Px, Py)
mod(Px, .7)+tri(Py, .4)+frac(Px)
inside(1, Px, 2)+xor(Px-1, Py-1)
fade(.3, .1, Px)
grey(Px, Py, .2)
clipgrey(Px, Py, .2)+clip_r(Px, 0, 0)
unif2norm(frac(Px))
nrand(Px)
Acos(Px)+Asin(Py)+Atan2(Py, Px)+Exp(-Px)+Sqrt(Px)
dot(P, N)+cross(1, P, D)/10
U-V
A1*Px+A2+AC/10+arg(2)
Dz+Nz+Rdot+T/10
Ix+Jy+Kz+Tx+S/10
noise3d(2, Px, Py, .3)
DEGREE*100""".splitlines()

# (file, real arguments, expressions): seen by slanting rays too.
FILES = [
    ("rev.cal", ".5 .25 -2 3", ["rev_dx", "rev_dy", "rev_dz"]),
    ("surf.cal", "2 .1 .2 .3 .4 .5 .6 .7 .8 .9 1 1.1 1.2", ["surf_dx", "surf_dy", "surf_dz"]),
    ("surf.cal", "0 .1 .2 .3 .4 .5 .6 .7 .8 .9 1 1.1 1.2", ["surf_dx/3", "surf_dz"]),
    ("tmesh.cal", "1 .1 .2 .3 .4 .5 .6 .7 .8 .9", ["dx", "dy", "dz", "u", "v"]),
    ("skybright.cal", "1 1.5 .5 .3 .6 0 .8", ["skybr"]),
    ("skybright.cal", "2 1.5 .5", ["skybr"]),
    ("skybright.cal", "3 1.5 .5", ["skybr"]),
    ("skybright.cal", "4 1.5 .5 .3 .6 0 .8", ["skybr"]),
    ("source.cal", "1.5 1 2 .5", ["src_theta/100", "src_phi/100", "src_phi2/100", "src_phi4/100", "flatcorr(.5)"]),
    ("source.cal", "1.5 1 2 .5", ["boxcorr(.5)", "cylcorr(.5)", "srcB_vert/100", "srcB_horiz2/100"]),
    ("illum.cal", "1 0 0 0 .6 .8 0 -.8 .6", ["il_alt", "il_azi", "il_alth", "il_azih"]),
]

DIRECTIONS = [(0, 0, -1), (0.6, 0, -0.8), (-0.48, 0.6, -0.64), (0.48, 0.6, 0.64)]

POINTS = [(0.1, 0.2), (1.37, -2.6), (-0.73, 0.55), (-3.9, 4.4), (7.25, 0.05)]


def run(command, text, folder):
    return subprocess.run(command, input=text, cwd=folder, capture_output=True, check=True, text=True).stdout


def trace(pattern, rays, folder, from_below=False):
    scene = f"void brightfunc f {pattern}\nf glow g 0 0 4 1 1 1 0\n"
    corners = ["-20 -20 0", "20 -20 0", "20 20 0", "-20 20 0"]
    scene += f"g polygon p 0 0 12 {' '.join(corners[::-1] if from_below else corners)}\n"
    with open(os.path.join(folder, "a.rad"), "w") as file:
        file.write(scene)
    octree = subprocess.run(["oconv", "a.rad"], cwd=folder, capture_output=True, check=True).stdout
    with open(os.path.join(folder, "a.oct"), "wb") as file:
        file.write(octree)
    lines = run(["rtrace", "-h", "-ab", "0", "-ov", "a.oct"], rays, folder).splitlines()
    return [float(line.split()[1]) - 4 for line in lines]


def main():
    os.environ["PATH"] = sys.argv[1] + os.pathsep + os.environ["PATH"]
    os.environ["RAYPATH"] = ".:" + os.path.join(os.path.dirname(sys.argv[1].rstrip("/")), "lib")
    here = os.path.dirname(os.path.abspath(__file__))
    with open(os.path.join(here, "values.txt"), "w") as out, tempfile.TemporaryDirectory() as folder:
        out.write("# Written by make.py; do not edit. Expression; x y of the hit, or -; value.\n")
        for expression in PLAIN:
            out.write(f"{expression};-;{run(['ev', expression], '', folder).strip()}\n")
        for expression in HIT:
            rays = "".join(f"{x} {y} 2 0 0 -1\n" for x, y in POINTS)
            found = trace(f'2 "4+({expression})" . 0 2 .5 .25', rays, folder)
            for (x, y), value in zip(POINTS, found):
                out.write(f"{expression};{x} {y};{value:.7g}\n")
    with open(os.path.join(here, "files.txt"), "w") as out, tempfile.TemporaryDirectory() as folder:
        out.write("# Written by make.py; do not edit. File; expression; real arguments; direction; x y of the hit; value.\n")
        for name, reals, expressions in FILES:
            for expression in expressions:
                for direction in DIRECTIONS:
                    dx, dy, dz = direction
                    rays = "".join(f"{x - 2 * dx} {y - 2 * dy} {-2 * dz} {dx} {dy} {dz}\n" for x, y in POINTS)
                    found = trace(f'2 "4+{expression}" {name} 0 {len(reals.split())} {reals}', rays, folder, dz > 0)
                    for (x, y), value in zip(POINTS, found):
                        out.write(f"{name};{expression};{reals};{dx} {dy} {dz};{x} {y};{value:.7g}\n")



main()
