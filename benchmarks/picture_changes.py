"""By how much one picture differs from another: moved and blurred in pixels, brighter or darker in 8-bit codes.

A change of light in codes is that of the mean of some square of 8 by 8 pixels (the 99th percentile over them). A change
in pixels is what moves and blurs the one picture into the other: in each of 24 parts,
B = A + shift . grad A + (s^2 / 2) laplacian A + gain A + constant is fitted to each channel of both, smoothed alike,
and a blur of variance s^2 is that of a disc of 4 s.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import realcam as rc
from srgb import srgb_codes


def codes(image: rc.Image) -> np.ndarray:
    return srgb_codes(0.018 * image.camera.iso * image.pixels.astype(np.float64))


def smooth(picture: np.ndarray) -> np.ndarray:
    """By a binomial filter of five by five pixels: of both pictures, it changes none of what is fitted."""
    for axis in (0, 1):
        for _ in range(2):
            ends = [np.take(picture, [i], axis=axis) for i in (0, -1)]
            padded = np.concatenate([ends[0], picture, ends[1]], axis=axis)
            length = picture.shape[axis]
            low, middle, high = (np.take(padded, np.arange(k, k + length), axis=axis) for k in range(3))
            picture = (low + 2 * middle + high) / 4
    return picture


def parts_of(picture: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """24."""
    rows = np.array_split(np.arange(2, picture.shape[0] - 2), 4)
    columns = np.array_split(np.arange(2, picture.shape[1] - 2), 6)
    return [np.ix_(r, c) for r in rows for c in columns]


def change_in_codes(a: np.ndarray, b: np.ndarray) -> float:
    height, width = (8 * (side // 8) for side in a.shape[:2])
    squares = (a - b)[:height, :width].reshape(height // 8, 8, width // 8, 8, 3).mean(axis=(1, 3))
    return float(np.quantile(np.abs(squares), 0.99))


@dataclass
class Change:
    moved_px: float = 0.0
    colours_px: float = 0.0  # between blue and red
    blur_px: float = 0.0
    light_codes: float = 0.0


def change_in_pixels(a: np.ndarray, b: np.ndarray) -> Change:
    """The most of all parts. `a`: the sharper one."""
    a, b = smooth(a), smooth(b)
    down, across = np.gradient(a, axis=(0, 1))
    laplacian = np.gradient(down, axis=0) + np.gradient(across, axis=1)
    most = Change()
    for part in parts_of(a):
        # Enough edges in both directions, or a shift along the edges could be any.
        slopes = np.stack([t[part].ravel() for t in (across, down)])
        if np.linalg.eigvalsh(slopes @ slopes.T / slopes.shape[1])[0] < 1:
            continue
        shifts, blurs = [], []
        for channel in range(3):
            terms = [t[part][..., channel].ravel() for t in (across, down, laplacian / 2, a, np.ones_like(a))]
            found, *_ = np.linalg.lstsq(np.stack(terms, axis=1), (b - a)[part][..., channel].ravel(), rcond=None)
            shifts.append(found[:2])
            blurs.append(4 * np.sqrt(abs(found[2])))
            light = found[3] * a[part][..., channel].mean() + found[4]
            most.light_codes = max(most.light_codes, abs(float(light)))
        most.moved_px = max(most.moved_px, *(float(np.hypot(*shift)) for shift in shifts))
        most.colours_px = max(most.colours_px, float(np.hypot(*(shifts[2] - shifts[0]))))
        most.blur_px = max(most.blur_px, *(float(blur) for blur in blurs))
    return most
