"""Makes maps.csv: saliency of twelve synthetic pictures by a transcription of Itti, Koch and Niebur (1998) that shares
nothing with the Rust code but the published formulas and the choices that they leave open (stated there): binomial
pyramid, Gabor of wavelength 4 px and deviation 2 px, double opponency with the sign of the text, not of equation 2, bilinear reading. float64, full
two-dimensional convolutions.

usage: make.py   (numpy 2, scipy 1)
"""

import csv
import pathlib

import numpy as np
from scipy.ndimage import convolve, convolve1d, map_coordinates

WIDTH, HEIGHT, PICTURES, STEP = 256, 192, 12, 8
BINOMIAL = np.array([1, 4, 6, 4, 1]) / 16


def reduce(plane):
    for axis in (0, 1):
        plane = convolve1d(plane, BINOMIAL, axis=axis, mode="mirror")
    return plane[::2, ::2]


def pyramid(plane):
    scales = [plane]
    for _ in range(8):
        scales.append(reduce(scales[-1]))
    return scales


def read_at(plane, octaves, shape):
    rows = np.minimum(np.arange(shape[0]) / 2**octaves, plane.shape[0] - 1)
    columns = np.minimum(np.arange(shape[1]) / 2**octaves, plane.shape[1] - 1)
    return map_coordinates(plane, np.meshgrid(rows, columns, indexing="ij"), order=1, mode="nearest")


def gabor_energy(plane, angle, wavelength=4.0, deviation=2.0, reach=4):
    y, x = np.mgrid[-reach : reach + 1, -reach : reach + 1].astype(float)
    envelope = np.exp(-(x * x + y * y) / (2 * deviation**2))
    phase = 2 * np.pi * (x * np.cos(angle) - y * np.sin(angle)) / wavelength
    even = envelope * np.cos(phase)
    even -= envelope * even.sum() / envelope.sum()
    odd = envelope * np.sin(phase)
    return np.hypot(*(convolve(plane, kernel / envelope.sum(), mode="mirror") for kernel in (even, odd)))


def centre_surround(scales):
    for c in (2, 3, 4):
        for delta in (3, 4):
            yield c, np.abs(scales[c] - read_at(scales[c + delta], delta, scales[c].shape))


def normalise(feature):
    low, high = feature.min(), feature.max()
    if high - low <= 1e-4:
        return np.zeros_like(feature)
    feature = (feature - low) / (high - low)
    height, width = feature.shape
    rim = np.pad(feature, 1, constant_values=-1)
    around = [rim[1 + j : 1 + j + height, 1 + i : 1 + i + width] for j in (-1, 0, 1) for i in (-1, 0, 1) if i or j]
    peaks = np.sort(feature[feature > np.max(around, axis=0)])
    return feature * (1 - (peaks[:-1].mean() if len(peaks) > 1 else 0)) ** 2


def add_across_scales(maps):
    total = 0
    for c, feature in maps:
        feature = normalise(feature)
        for _ in range(c, 4):
            feature = reduce(feature)
        total = total + feature
    return total


def saliency(picture):
    intensity = picture.mean(axis=2)
    seen = intensity > 0.1 * intensity.max()
    r, g, b = np.moveaxis(np.where(seen[..., None], picture / np.maximum(intensity, 1e-9)[..., None], 0), 2, 0)
    red = np.maximum(r - (g + b) / 2, 0)
    green = np.maximum(g - (r + b) / 2, 0)
    blue = np.maximum(b - (r + g) / 2, 0)
    yellow = np.maximum((r + g) / 2 - np.abs(r - g) / 2 - b, 0)
    scales = pyramid(intensity)
    light = add_across_scales(centre_surround(scales))
    hue = sum(add_across_scales(centre_surround(pyramid(plane))) for plane in (red - green, blue - yellow))
    lines = 0
    for angle in np.radians([0, 45, 90, 135]):
        energies = [gabor_energy(plane, angle) for plane in scales]
        lines = lines + normalise(add_across_scales(centre_surround(energies)))
    total = normalise(light) + normalise(hue) + normalise(lines)
    return read_at(total, 4, picture.shape[:2])


class Numbers:
    """A linear congruential generator that any language repeats exactly: numbers in [0, 1)."""

    def __init__(self, seed):
        self.state = seed

    def next(self):
        self.state = (self.state * 1103515245 + 12345) % 2**31
        return self.state / 2**31


def picture(index):
    """Eight soft spots of random place, size and colour on grey, with a grating of random angle over all."""
    numbers = Numbers(index + 1)
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH].astype(float)
    out = np.full((HEIGHT, WIDTH, 3), 0.4)
    for _ in range(8):
        cx, cy, size = numbers.next() * WIDTH, numbers.next() * HEIGHT, 4 + 20 * numbers.next()
        spot = np.exp(-((x - cx) ** 2 + (y - cy) ** 2) / (2 * size * size))
        for channel in range(3):
            out[..., channel] += (numbers.next() - 0.5) * spot
    angle, period = np.pi * numbers.next(), 8 + 40 * numbers.next()
    out += (0.05 * np.cos(2 * np.pi * (x * np.cos(angle) + y * np.sin(angle)) / period))[..., None]
    return np.clip(out, 0, 1)


with open(pathlib.Path(__file__).parent / "maps.csv", "w", newline="") as file:
    rows = csv.writer(file, lineterminator="\n")
    for index in range(PICTURES):
        found = saliency(picture(index))
        rows.writerow(f"{value:.5g}" for value in (found / found.max())[::STEP, ::STEP].ravel())
