"""Makes the tables beside this file from converged pictures: a 16 x 16 grid of mean luminances a picture.

usage: make.py REFERENCE_DIRECTORY   (numpy, OpenEXR)

pictures.csv  pictures by Radiance's rpict ("RADIANCE 6.0a"), 256 x 256, mean of two runs; commands and noise in
              that directory's README.md, from which the noise column is read: the RMS over 8x8 pixel blocks of half
              the relative difference of the two runs.
words_*.csv   pictures by an independent tracer, one a path word (the letters of the scattering events from the eye;
              `_` is the empty word; t, g, d are the smooth, rough and diffuse transmission of `trans`); in the D2
              tables words of more than three letters are pooled as first two letters ~ number of D.
Luminance is .265074126 R + .670114631 G + .064811243 B, blocks are numbered in rows from the top left.
"""

import csv
import pathlib
import re
import sys

import numpy as np
import OpenEXR

GRID = 16
WEIGHTS = np.array([0.265074126, 0.670114631, 0.064811243])


def blocks(picture):
    light = picture.astype(np.float64) @ WEIGHTS
    size = light.shape[0] // GRID
    assert light.shape == (GRID * size, GRID * size)
    return light.reshape(GRID, size, GRID, size).mean(axis=(1, 3)).ravel()


def main(source):
    here = pathlib.Path(__file__).parent
    noise = {}
    for line in (source / "README.md").read_text().splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) == 9 and cells[7].endswith("%"):
            noise[cells[0]] = float(cells[7].rstrip("%")) / 100
    with open(here / "pictures.csv", "w", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["name", "block_noise"] + [f"b{i}" for i in range(GRID * GRID)])
        for name in sorted(noise):
            picture = OpenEXR.File(str(source / f"{name}.exr")).channels()["RGB"].pixels
            rows.writerow([name, noise[name]] + [f"{value:.6g}" for value in blocks(picture)])
    for table in ["room_a", "room_a_D2", "trans_c", "trans_c_D2", "cornell", "cornell_D2"]:
        words = np.load(source / f"words_{table}.npz")
        with open(here / f"words_{table}.csv", "w", newline="") as file:
            rows = csv.writer(file, lineterminator="\n")
            rows.writerow(["word"] + [f"b{i}" for i in range(GRID * GRID)])
            for word in sorted(words.files, key=lambda w: (len(w), w)):
                rows.writerow([word] + [f"{value:.5g}" for value in blocks(words[word])])


main(pathlib.Path(sys.argv[1]))
