"""By how much one picture differs from another: moved and blurred in pixels, brighter or darker in 8-bit codes.

What moves and blurs a picture A into B is found by parts, in each channel, as the least squares of
B - A = shift . grad A + (s^2 / 2) laplacian A + gain A + constant; a blur of variance s^2 is that of a disc of 4 s.
Diffraction has no variance, because its light falls off too slowly: its blur is told by what it does to contrast. All
of it in linear light, in which blurs are sums.
Noise of A stands on both sides of this equation and would look like blur, so that the sums of the normal equations are
taken with the terms of a third picture of the same things, whose noise is its own (instrumental variables).

How much noise is in each size is told by two pictures that differ in noise alone.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import realcam as rc
from numpy.typing import NDArray
from srgb import srgb_codes

Picture = NDArray[np.float64]


def values(image: rc.Image) -> Picture:
    """Of the developed picture, linear; 1: white."""
    return 0.018 * image.camera.iso * image.pixels.astype(np.float64)


@dataclass(frozen=True)
class Size:
    """Of a change: in the part that has most of it even after four standard deviations of its noise, the most likely
    size, and the sizes within those four (the most of many parts lies two above their mean by noise alone)."""

    likely: float
    at_least: float
    at_most: float

    def __or__(self, other: Size) -> Size:
        """The larger one."""
        return max(self, other, key=lambda size: (size.at_least, size.likely))


def smooth(picture: Picture) -> Picture:
    """By a binomial filter of five by five pixels: of all pictures, it changes none of what is fitted."""
    for axis in (0, 1):
        for _ in range(2):
            ends = [np.take(picture, [i], axis=axis) for i in (0, -1)]
            padded = np.concatenate([ends[0], picture, ends[1]], axis=axis)
            length = picture.shape[axis]
            low, middle, high = (np.take(padded, np.arange(k, k + length), axis=axis) for k in range(3))
            picture = (low + 2 * middle + high) / 4
    return picture


def parts_of(picture: Picture, rows: int, columns: int) -> list[tuple[np.ndarray, ...]]:
    down = np.array_split(np.arange(2, picture.shape[0] - 2), rows)
    across = np.array_split(np.arange(2, picture.shape[1] - 2), columns)
    return [np.ix_(r, c) for r in down for c in across]


def laplacian(picture: Picture) -> Picture:
    down, across = np.gradient(picture, axis=(0, 1))
    return np.gradient(down, axis=0) + np.gradient(across, axis=1)


def diffracted(picture: Picture) -> Picture:
    """What diffraction adds to a picture for each pixel of wavelength times f-number, where that is small: the transfer
    function of a round aperture is 1 - (4 / pi) wavelength f-number frequency there (Goodman, "Introduction to Fourier
    Optics", section 6.3)."""
    height, width = picture.shape[:2]
    mirrored = np.pad(picture, ((0, height), (0, width), (0, 0)), mode="symmetric")
    frequency = np.hypot(np.fft.fftfreq(2 * height)[:, None], np.fft.rfftfreq(2 * width)[None, :])
    spectrum = np.fft.rfft2(mirrored, axes=(0, 1)) * (-4 / np.pi * frequency)[..., None]
    return np.asarray(np.fft.irfft2(spectrum, s=mirrored.shape[:2], axes=(0, 1))[:height, :width])


def terms_of(picture: Picture, blur: Callable[[Picture], Picture]) -> Picture:
    """(5, H, W, 3)."""
    down, across = np.gradient(picture, axis=(0, 1))
    return np.stack([across, down, blur(picture), picture, np.ones_like(picture)])


LEAST_SLOPE = 0.004  # a pixel, of white
ACROSS, DOWN, BLUR, LIGHT = range(4)
WIDE_SHARE = 0.05  # of the diameter of a wide disc: as much as half a pixel where all is sharp


class Comparison:
    """of `before` and `after`. detail: a picture of the same with other random numbers; noise: two pictures that differ
    in noise like that of `after` (all (H, W, 3), linear).

    found, noise: (parts, 3 channels, 4), of the change and of noise alone: shift in px, strength of the blur, and light
    in 8-bit codes. What diffraction alone blurs is told so; else the blur is told by its variance, px^2: less of parts
    that are soft already, against a `sharp` picture, as the planner has it (blur_between in cpp/plan/lens_errors.hpp).
    """

    def __init__(
        self,
        before: Picture,
        after: Picture,
        detail: Picture,
        noise: tuple[Picture, Picture],
        parts: tuple[int, int] = (4, 6),
        is_diffraction: bool = False,
        sharp: Picture | None = None,
    ) -> None:
        before, after, detail = smooth(before), smooth(after), smooth(detail)
        blur = diffracted if is_diffraction else (lambda picture: laplacian(picture) / 2)
        terms, instruments, change = terms_of(before, blur), terms_of(detail, blur), after - before
        noises = smooth(noise[1]) - smooth(noise[0])
        if sharp is not None:
            sharp = smooth(sharp)
            sharp_terms, softer = terms_of(sharp, blur), before - sharp
        answers = []
        for part in parts_of(before, *parts):
            across, down = instruments[ACROSS][part].ravel(), instruments[DOWN][part].ravel()
            # Enough edges in both directions, or a shift along the edges could be any.
            if np.linalg.eigvalsh(np.cov(across, down, ddof=0))[0] < LEAST_SLOPE**2:
                continue
            answer = np.array([self._solve(terms, instruments, (change, noises), part, c) for c in range(3)])
            if sharp is not None:
                base = [self._solve(sharp_terms, sharp_terms, (softer,), part, c)[0, BLUR] for c in range(3)]
                answer[..., BLUR] /= 1 + 8 * WIDE_SHARE * 16 * max(0.0, float(np.mean(base)))
            if np.isfinite(answer).all():
                answers.append(answer)
        self.found, self.noise = np.moveaxis(np.array(answers).reshape(-1, 3, 2, 4), 2, 0)

    @staticmethod
    def _solve(
        terms: Picture,
        instruments: Picture,
        wanted: tuple[Picture, ...],
        part: tuple[np.ndarray, ...],
        channel: int,
    ) -> NDArray[np.float64]:
        x = np.stack([term[part][..., channel].ravel() for term in terms])
        z = np.stack([term[part][..., channel].ravel() for term in instruments])
        y = np.stack([picture[part][..., channel].ravel() for picture in wanted], axis=1)
        try:
            answers = np.linalg.solve(z @ x.T, z @ y).T
        except np.linalg.LinAlgError:
            return np.full((len(wanted), 4), np.nan)
        mean = x[3].mean()
        brighter = mean + answers[:, 3] * mean + answers[:, 4]
        return np.column_stack([answers[:, :3], srgb_codes(brighter) - srgb_codes(mean)])

    def moved_px(self) -> Size:
        shift, noise = (np.hypot(*values[..., :2].mean(axis=1).T) for values in (self.found, self.noise))
        return _most(shift, noise)

    def blurred_px(self) -> Size:
        """Diameter of the disc, by which either picture is less sharp than the other."""
        return _as_disc(*(np.abs(values[..., BLUR].mean(axis=1)) for values in (self.found, self.noise)))

    def colours_px(self) -> Size:
        """Blue against red: shift, or difference of the blurs."""
        found, noise = (values[:, 2] - values[:, 0] for values in (self.found, self.noise))
        shift = _most(*(np.hypot(*values[:, :2].T) for values in (found, noise)))
        return shift | _as_disc(*(np.abs(values[:, BLUR]) for values in (found, noise)))

    def airy_diameter_px(self) -> Size:
        """Where the blur is diffraction's."""
        found, noise = (np.abs(values[..., BLUR].mean(axis=1)) for values in (self.found, self.noise))
        return _most(2.44 * found, 2.44 * noise)

    def light_codes(self) -> Size:
        return _most(*(np.abs(values[..., LIGHT].mean(axis=1)) for values in (self.found, self.noise)))


def _most(values: NDArray[np.float64], noise: NDArray[np.float64]) -> Size:
    """Of all parts. noise: one draw of each, which says little of it: at least what the median part has."""
    if not len(values):
        return Size(0, 0, np.inf)  # without any detail nothing is known
    deviation = np.maximum(noise, 1.48 * np.median(noise))
    at = int(np.argmax(values - 4 * deviation))
    likely, doubt = float(values[at]), 4 * float(deviation[at])
    return Size(likely, likely - doubt, likely + doubt)


def _as_disc(variance: NDArray[np.float64], noise: NDArray[np.float64]) -> Size:
    most = _most(variance, noise)
    return Size(*(4 * float(np.sqrt(max(0.0, v))) for v in (most.likely, most.at_least, most.at_most)))


def added_codes(before: Picture, after: Picture, noise: tuple[Picture, Picture]) -> Size:
    """By how much light changes, all pictures in codes: as the mean of the darkest or of the brightest tenth of all
    squares of 8 by 8 pixels (what is clipped aside), or in the single squares of 4 by 4 and of 16 by 16 pixels that
    change most (99th percentile), in the channel that changes most."""
    light = square_means(after.mean(axis=2, keepdims=True), 8)[..., 0]
    dark = light <= np.quantile(light, 0.1)
    bright = (light >= np.quantile(light[light < 250], 0.9)) & (light < 250) if (light < 250).any() else dark
    size = _mean_of(dark, before, after, noise) | _mean_of(bright, before, after, noise)
    return size | _most_of_squares(before, after, noise, 4) | _most_of_squares(before, after, noise, 16)


def _mean_of(chosen: NDArray[np.bool_], before: Picture, after: Picture, noise: tuple[Picture, Picture]) -> Size:
    doubt = 2 * float(square_means(noise[1] - noise[0], 8)[chosen].std() / np.sqrt(chosen.sum()))
    likely = float(np.abs(square_means(after - before, 8)[chosen].mean(axis=0)).max())
    return Size(likely, likely - doubt, likely + doubt)


def _most_of_squares(before: Picture, after: Picture, noise: tuple[Picture, Picture], side: int) -> Size:
    change, noises = (np.abs(square_means(picture, side)) for picture in (after - before, noise[1] - noise[0]))
    least, most = float(np.quantile(noises, 0.99)), float(np.quantile(change, 0.99))
    return Size(float(np.sqrt(max(0, most**2 - least**2))), most - 2 * least, most + 2 * least)


def square_means(picture: Picture, side: int = 8) -> Picture:
    height, width = (length // side for length in picture.shape[:2])
    cut = picture[: height * side, : width * side]
    return np.asarray(cut.reshape(height, side, width, side, -1).mean(axis=(1, 3)))
