"""Pictures of all the renderers as arrays of radiance, and how far one lies from what it should be."""

import re

import numpy as np
import OpenEXR

BRIGHT = np.array([0.265074126, 0.670114631, 0.064811243])


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


def product(one, other, reference):
    """Mean of the products of two deviations of luminance, pixel by pixel, relative to a reference's luminance squared."""
    r = reference @ BRIGHT
    return float(np.mean((one @ BRIGHT) * (other @ BRIGHT) / (r**2 + 0.01 * r.mean() ** 2)))


def squared_error(picture, references):
    """Squared relative error, free of the references' own noise: they are two, and independent."""
    first, second = references
    return product(picture - first, picture - second, (first + second) / 2)


def squared_noise(one, other, reference):
    """Squared relative noise of each of two pictures that differ in their random numbers alone."""
    return product(one - other, one - other, reference) / 2
