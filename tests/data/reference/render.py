"""Makes rendered.csv beside this file: 16 x 16 block means of luminance of rpict's pictures of scenes of this project.

usage: RADIANCE_BIN=folder RADIANCE_LIB=folder render.py [NAME..]      (numpy; RADIANCE 6.0a: rpict, oconv, genbox, xform)

Each picture is rendered twice with random numbers of its own, WIDTH pixels wide, and averaged; block_noise is the RMS
over the blocks that are not dark of half the relative difference of the two. Rows of other names stay as they are.
Luminance is .265074126 R + .670114631 G + .064811243 B, blocks are numbered in rows from the top left.
"""

import csv
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np

GRID = 16
WEIGHTS = np.array([0.265074126, 0.670114631, 0.064811243])
OPTIONS = (
    "-u+ -ps 1 -pt 0 -pj 1 -dj 1 -ds .15 -dt 0 -dc 1 -dp 4096 -st 0 -ss 1 -aa 0 -as 0 -ar 0 -av 0 0 0 -aw 0"
    " -lr 12 -lw 1e-5"
)
# name, scene, pixels on a side, options
PICTURES = [
    ("glow_b_ab0", "glow_b", 1024, "-ab 0 -dr 1"),
    ("relay_e_dr1", "relay_e", 1024, "-ab 0 -dr 1"),
    ("relay_e_dr2", "relay_e", 1024, "-ab 0 -dr 2"),
    ("mist_f_ab0", "mist_f", 1024, "-ab 0 -dr 1"),
    ("fabric_g_ab0", "fabric_g", 1024, "-ab 0 -dr 1"),
    ("fabric_g_ab1", "fabric_g", 512, "-ab 1 -ad 16 -dr 1"),
]


def pixels(picture):
    """Decodes an RGBE picture as rpict writes it."""
    header, rest = picture.split(b"\n\n", 1)
    size, data = rest.split(b"\n", 1)
    _, height, _, width = size.split()
    height, width = int(height), int(width)
    found = np.zeros((height, 4, width), np.uint8)
    at = 0
    for row in range(height):
        assert data[at : at + 2] == b"\x02\x02", "rows are run length encoded"
        at += 4
        for channel in range(4):
            column = 0
            while column < width:
                count = data[at]
                if count > 128:
                    found[row, channel, column : column + count - 128] = data[at + 1]
                    column += count - 128
                    at += 2
                else:
                    found[row, channel, column : column + count] = np.frombuffer(data[at + 1 : at + 1 + count], np.uint8)
                    column += count
                    at += 1 + count
    found = found.transpose(0, 2, 1).astype(np.float64)
    exponent = found[..., 3:]
    return np.where(exponent > 0, (found[..., :3] + 0.5) * 2.0 ** (exponent - 136), 0.0)


def blocks(picture):
    light = picture @ WEIGHTS
    size = light.shape[0] // GRID
    assert light.shape == (GRID * size, GRID * size)
    return light.reshape(GRID, size, GRID, size).mean(axis=(1, 3)).ravel()


def main(names):
    here = pathlib.Path(__file__).resolve().parent
    table = here / "rendered.csv"
    rows = {row[0]: row for row in csv.reader(open(table))} if table.exists() else {}
    folders = [os.environ["RADIANCE_BIN"], os.environ["RADIANCE_LIB"]]
    environment = dict(os.environ, PATH=folders[0] + ":" + os.environ["PATH"], RAYPATH=".:" + folders[1])
    scenes = here.parent / "scenes"
    for name, scene, width, options in PICTURES:
        if names and name not in names:
            continue
        with tempfile.NamedTemporaryFile(suffix=".oct") as octree:
            octree.write(subprocess.run(["oconv", f"{scene}.rad"], cwd=scenes, env=environment, check=True, stdout=subprocess.PIPE).stdout)
            octree.flush()
            command = f"rpict -vf {scene}.vf -x {width} -y {width} {OPTIONS} {options} {octree.name}"
            runs = []
            for _ in range(2):
                made = subprocess.run(command.split(), cwd=scenes, env=environment, check=True, stdout=subprocess.PIPE)
                runs.append(blocks(pixels(made.stdout)))
                # rpict takes its seed from the clock's seconds.
                time.sleep(1.1)
        mean = (runs[0] + runs[1]) / 2
        bright = mean >= 1e-3 * mean.mean()
        noise = np.sqrt(np.mean((np.abs(runs[0] - runs[1])[bright] / 2 / mean[bright]) ** 2))
        print(name, "mean", mean.mean(), "noise", noise, flush=True)
        rows[name] = [name, f"{noise:.3g}"] + [f"{value:.6g}" for value in mean]
    rows.pop("name", None)
    with open(table, "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["name", "block_noise"] + [f"b{i}" for i in range(GRID * GRID)])
        out.writerows(rows[name] for name in sorted(rows))


main(sys.argv[1:])
