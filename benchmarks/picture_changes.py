"""Differences between two pictures: shift and blur in pixels, brightness in 8-bit codes.

For each part and channel of a picture, the change from A to B is the least-squares solution of
B - A = shift . grad A + (s^2 / 2) laplacian A + gain A + constant; a blur of variance s^2 is that of a disc of diameter
4 s. Diffraction has no variance, because its point spread function falls off too slowly: its blur is measured by the
loss of contrast. All pictures are linear, so that blurs are convolutions.
The noise of A is on both sides of the equation and would look like a blur. Therefore the normal equations use the terms
of a third picture of the same scene with independent noise (instrumental variables).

The noise of each size is measured on two pictures that differ only in noise.
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
    """Linear values of the developed picture, (H, W, 3); 1 is white."""
    return 0.018 * image.camera.iso * image.pixels.astype(np.float64)


@dataclass(frozen=True)
class Size:
    """Size of a change in the part of the picture where it is largest.

    The part is the one whose size exceeds its noise by most: by four standard deviations, because the largest of many
    parts lies two above their mean by noise alone.
    """

    likely: float  # estimate
    at_least: float  # four standard deviations of the noise below and above it
    at_most: float

    def __or__(self, other: Size) -> Size:
        """The larger one."""
        return max(self, other, key=lambda size: (size.at_least, size.likely))


def smooth(picture: Picture) -> Picture:
    """Applies a binomial filter of 5 x 5 pixels, which leaves the fitted quantities unchanged if all pictures have
    it."""
    for axis in (0, 1):
        for _ in range(2):
            ends = [np.take(picture, [i], axis=axis) for i in (0, -1)]
            padded = np.concatenate([ends[0], picture, ends[1]], axis=axis)
            length = picture.shape[axis]
            low, middle, high = (np.take(padded, np.arange(k, k + length), axis=axis) for k in range(3))
            picture = (low + 2 * middle + high) / 4
    return picture


def parts_of(picture: Picture, rows: int, columns: int) -> list[tuple[np.ndarray, ...]]:
    """Index arrays of rows x columns parts of a picture without its border of two pixels."""
    down = np.array_split(np.arange(2, picture.shape[0] - 2), rows)
    across = np.array_split(np.arange(2, picture.shape[1] - 2), columns)
    return [np.ix_(r, c) for r in down for c in across]


def laplacian(picture: Picture) -> Picture:
    down, across = np.gradient(picture, axis=(0, 1))
    return np.gradient(down, axis=0) + np.gradient(across, axis=1)


def diffracted(picture: Picture) -> Picture:
    """Derivative of a diffraction-blurred picture by wavelength x f-number, in pixels.

    At low frequencies the transfer function of a circular aperture is 1 - (4 / pi) wavelength f-number frequency
    (Goodman, "Introduction to Fourier Optics", section 6.3).
    """
    height, width = picture.shape[:2]
    mirrored = np.pad(picture, ((0, height), (0, width), (0, 0)), mode="symmetric")
    frequency = np.hypot(np.fft.fftfreq(2 * height)[:, None], np.fft.rfftfreq(2 * width)[None, :])
    spectrum = np.fft.rfft2(mirrored, axes=(0, 1)) * (-4 / np.pi * frequency)[..., None]
    return np.asarray(np.fft.irfft2(spectrum, s=mirrored.shape[:2], axes=(0, 1))[:height, :width])


def terms_of(picture: Picture, blur: Callable[[Picture], Picture]) -> Picture:
    """(5, H, W, 3): terms of the equation: gradient across and down, blur, picture, and ones."""
    down, across = np.gradient(picture, axis=(0, 1))
    return np.stack([across, down, blur(picture), picture, np.ones_like(picture)])


MIN_SLOPE = 0.004  # smallest RMS gradient of a part, in white per pixel
ACROSS, DOWN, BLUR, LIGHT = range(4)  # columns of Comparison.found and noise
# Change of a wide disc, relative to its diameter, that is as visible as half a pixel in a sharp picture.
WIDE_DISC_FRACTION = 0.05


class Comparison:
    """Fits the change between two pictures, by parts.

    before, after: the pictures. detail: the same as `before` with other random numbers. noise: two pictures that differ
    by noise like that of `after`. All are (H, W, 3), linear. parts: number of rows and columns of parts.
    is_diffraction: the blur is that of diffraction, and measured as wavelength x f-number, px; otherwise it is measured
    by its variance, px^2. sharp: a picture without blur, in relation to which the blur of a part that is blurred in
    `before` counts less, as in the planner (blur_between in cpp/plan/lens_errors.hpp); None: all blur counts equally.

    found, noise: (parts, 3 channels, 4), for the change and for noise alone: shift across and down, px, blur, and
    light, 8-bit codes. Parts with too few edges are omitted.
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
        noise_change = smooth(noise[1]) - smooth(noise[0])
        if sharp is not None:
            sharp = smooth(sharp)
            sharp_terms, blurring = terms_of(sharp, blur), before - sharp
        answers = []
        for part in parts_of(before, *parts):
            across, down = instruments[ACROSS][part].ravel(), instruments[DOWN][part].ravel()
            # A shift along edges of a single direction would be undetermined.
            if np.linalg.eigvalsh(np.cov(across, down, ddof=0))[0] < MIN_SLOPE**2:
                continue
            answer = np.array([self._solve(terms, instruments, (change, noise_change), part, c) for c in range(3)])
            if sharp is not None:
                base = [self._solve(sharp_terms, sharp_terms, (blurring,), part, c)[0, BLUR] for c in range(3)]
                answer[..., BLUR] /= 1 + 8 * WIDE_DISC_FRACTION * 16 * max(0.0, float(np.mean(base)))
            if np.isfinite(answer).all():
                answers.append(answer)
        self.found, self.noise = np.moveaxis(np.array(answers).reshape(-1, 3, 2, 4), 2, 0)

    @staticmethod
    def _solve(
        terms: Picture,
        instruments: Picture,
        changes: tuple[Picture, ...],
        part: tuple[np.ndarray, ...],
        channel: int,
    ) -> NDArray[np.float64]:
        """(changes, 4): shift across and down, blur and light of each change in a part; nan if they are
        undetermined."""
        x = np.stack([term[part][..., channel].ravel() for term in terms])
        z = np.stack([term[part][..., channel].ravel() for term in instruments])
        y = np.stack([picture[part][..., channel].ravel() for picture in changes], axis=1)
        try:
            answers = np.linalg.solve(z @ x.T, z @ y).T
        except np.linalg.LinAlgError:
            return np.full((len(changes), 4), np.nan)
        mean = x[3].mean()
        brighter = mean + answers[:, 3] * mean + answers[:, 4]
        return np.column_stack([answers[:, :3], srgb_codes(brighter) - srgb_codes(mean)])

    def moved_px(self) -> Size:
        """Length of the shift."""
        shift, noise = (np.hypot(*values[..., :2].mean(axis=1).T) for values in (self.found, self.noise))
        return _largest(shift, noise)

    def blurred_px(self) -> Size:
        """Diameter of the disc by which either picture is blurred relative to the other."""
        return _as_disc(*(np.abs(values[..., BLUR].mean(axis=1)) for values in (self.found, self.noise)))

    def colours_px(self) -> Size:
        """Lateral or axial colour: shift, or difference of the blurs, of the blue channel against the red one."""
        found, noise = (values[:, 2] - values[:, 0] for values in (self.found, self.noise))
        shift = _largest(*(np.hypot(*values[:, :2].T) for values in (found, noise)))
        return shift | _as_disc(*(np.abs(values[:, BLUR]) for values in (found, noise)))

    def airy_diameter_px(self) -> Size:
        """Diameter of the Airy disc, if is_diffraction."""
        found, noise = (np.abs(values[..., BLUR].mean(axis=1)) for values in (self.found, self.noise))
        return _largest(2.44 * found, 2.44 * noise)

    def light_codes(self) -> Size:
        """Change of brightness."""
        return _largest(*(np.abs(values[..., LIGHT].mean(axis=1)) for values in (self.found, self.noise)))


def _largest(values: NDArray[np.float64], noise: NDArray[np.float64]) -> Size:
    """Largest of the parts' sizes, see Size.

    noise: one sample of each part's noise, too few for its standard deviation: at least that of the median is assumed.
    """
    if not len(values):
        return Size(0, 0, np.inf)  # no part has enough detail
    deviation = np.maximum(noise, 1.48 * np.median(noise))
    part = int(np.argmax(values - 4 * deviation))
    likely, margin = float(values[part]), 4 * float(deviation[part])
    return Size(likely, likely - margin, likely + margin)


def _as_disc(variance: NDArray[np.float64], noise: NDArray[np.float64]) -> Size:
    """Diameter of the disc with the largest of these variances."""
    largest = _largest(variance, noise)
    return Size(*(4 * float(np.sqrt(max(0.0, v))) for v in (largest.likely, largest.at_least, largest.at_most)))


def added_codes(before: Picture, after: Picture, noise: tuple[Picture, Picture]) -> Size:
    """Change of brightness of pictures in 8-bit codes, in the channel where it is largest.

    The largest of: the mean change of the darkest and of the brightest unclipped tenth of the squares of 8 x 8 pixels,
    and the 99th percentile of the change of squares of 4 x 4 and of 16 x 16 pixels. noise: as for Comparison.
    """
    light = square_means(after.mean(axis=2, keepdims=True), 8)[..., 0]
    dark = light <= np.quantile(light, 0.1)
    bright = (light >= np.quantile(light[light < 250], 0.9)) & (light < 250) if (light < 250).any() else dark
    size = _mean_change(dark, before, after, noise) | _mean_change(bright, before, after, noise)
    return size | _largest_of_squares(before, after, noise, 4) | _largest_of_squares(before, after, noise, 16)


def _mean_change(chosen: NDArray[np.bool_], before: Picture, after: Picture, noise: tuple[Picture, Picture]) -> Size:
    """Mean change over the chosen squares of 8 x 8 pixels, with bounds of two standard errors."""
    margin = 2 * float(square_means(noise[1] - noise[0], 8)[chosen].std() / np.sqrt(chosen.sum()))
    likely = float(np.abs(square_means(after - before, 8)[chosen].mean(axis=0)).max())
    return Size(likely, likely - margin, likely + margin)


def _largest_of_squares(before: Picture, after: Picture, noise: tuple[Picture, Picture], side: int) -> Size:
    """99th percentile of the change of squares of side x side pixels, without that of the noise."""
    change, noises = (np.abs(square_means(picture, side)) for picture in (after - before, noise[1] - noise[0]))
    by_noise, by_change = float(np.quantile(noises, 0.99)), float(np.quantile(change, 0.99))
    likely = float(np.sqrt(max(0, by_change**2 - by_noise**2)))
    return Size(likely, by_change - 2 * by_noise, by_change + 2 * by_noise)


def square_means(picture: Picture, side: int = 8) -> Picture:
    """Means over squares of side x side pixels, (H // side, W // side, channels)."""
    height, width = (length // side for length in picture.shape[:2])
    cut = picture[: height * side, : width * side]
    return np.asarray(cut.reshape(height, side, width, side, -1).mean(axis=(1, 3)))
