"""Focusing as a camera with dual pixels does: by the disparity of the light from both halves of its pupil."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ._core import Camera, InputError, Lens, RayStatus, Scene
from .session import Session

Array = NDArray[np.float64]

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # of linear Rec. 709
TRACED_MODELS = ("full", "full_double", "polynomial")  # which have the aberrations of the lens
MOST_STEPS = 12
MOST_MAGNIFICATION = 0.9  # of lenses that do not say how near they can be focused
LEAST_CORRELATION = 0.2  # of two pictures of noise it is some hundredths


@dataclass(frozen=True)
class Autofocus:
    """How a camera has found its focus.

    camera: focused. focus_distances_m, disparities_px: of each step, where it was focused, and by how many columns the
    light of the right half of the pupil lay to the right of that of the left one, less what it is in focus: more than 0
    where the scene is farther away.
    """

    camera: Camera
    focus_distances_m: tuple[float, ...]
    disparities_px: tuple[float, ...]


def autofocus(
    scene: Scene,
    camera: Camera,
    *,
    at: tuple[float, float] | None = None,
    window_px: tuple[int, int] | None = None,
    tolerance_px: float = 0.1,
    spp: int = 64,
    seed: int = 0,
    device: str = "auto",
) -> Autofocus:
    """Focuses a camera on what it sees in a window of its picture, by dual pixels alone: depths are not looked at.

    at: column and row of the middle of the window; None: of the picture. window_px: its columns and rows; None: a
    quarter of the picture's. tolerance_px: disparity at which it ends. spp: samples of a pixel, 1 to 256.
    The lens is moved by what the disparity means to first order, and the step is corrected by the next disparity.
    Aberrations leave a disparity in focus, for which rays through the lens are the calibration (docs/dual-pixels.md).
    Effects are left out. Raises InputError, also where the window has no contrast across its
    columns, or nothing at a distance to which the lens can be focused.
    """
    columns, rows = camera.film.resolution
    middle = at or (columns / 2, rows / 2)
    width, height = window_px or (max(16, columns // 4), max(8, rows // 4))
    region = (
        _first(middle[0], width, columns),
        _first(middle[1], height, rows),
        min(width, columns),
        min(height, rows),
    )
    layers = ("dual_pixel_left", "dual_pixel_right")
    session = Session(scene, camera, effects=(), layers=layers, seed=seed, device=device)
    extension, factor = _extension_mm(camera), 1.0
    distances: list[float] = []
    disparities: list[float] = []
    extensions: list[float] = []
    while True:
        disparity = _disparity_px(session, region, spp) - _disparity_in_focus_px(camera)
        distances.append(float(camera.lens.focus_distance_m))
        disparities.append(disparity)
        extensions.append(extension)
        if abs(disparity) <= tolerance_px:
            return Autofocus(camera, tuple(distances), tuple(disparities))
        if len(disparities) == MOST_STEPS:
            raise InputError(
                f"no focus was found in {MOST_STEPS} steps; the disparity is still {disparity:.3g} pixels (a window "
                "with one depth in it, or more samples are wanted)"
            )
        if len(disparities) > 1 and disparity != disparities[-2]:
            # What the last step has done, within reason: at first the images may be matched wrongly.
            per_mm = (disparities[-2] - disparity) / (extension - extensions[-2])
            factor = float(np.clip(-1 / (per_mm * _defocus_mm_per_px(camera)), 0.25, 2)) if per_mm < 0 else 1.0
        focused = _refocused(camera, extension - factor * disparity * _defocus_mm_per_px(camera))
        if focused.lens.focus_distance_m == camera.lens.focus_distance_m:
            raise InputError(
                f"the window shows what cannot be brought into focus: at {camera.lens.focus_distance_m:.4g} m, where "
                f"the range of the lens ends, its disparity is {disparity:.3g} pixels"
            )
        camera = focused
        extension = _extension_mm(camera)
        session.set(camera=camera)


def _first(middle: float, size: int, of: int) -> int:
    return int(np.clip(round(middle - size / 2), 0, max(0, of - size)))


def _disparity_px(session: Session, region: tuple[int, int, int, int], spp: int) -> float:
    """By how much the right half's picture lies to the right, from the largest correlation of both."""
    sums = session.expose(region, 0, spp).pixels
    assert sums is not None
    right = sums["besides"] @ LUMINANCE
    left = sums["irradiance"] @ LUMINANCE - right
    width = left.shape[1]
    most = width // 2
    shifts = np.arange(-most, most + 1)
    matches = np.array(
        [_correlation(left[:, max(0, -s) : width - max(0, s)], right[:, max(0, s) : width + min(0, s)]) for s in shifts]
    )
    best = int(matches.argmax())
    if matches[best] < LEAST_CORRELATION:
        raise InputError(
            "the window has too little contrast across its columns to be focused on; another place is wanted"
        )
    if best in (0, 2 * most):
        return float(shifts[best])
    before, here, after = matches[best - 1 : best + 2]
    bend = before - 2 * here + after
    return float(shifts[best] + (0.5 * (before - after) / bend if bend < 0 else 0.0))


def _correlation(one: Array, other: Array) -> float:
    """Of all pixels, -1 to 1; that of even light is 0."""
    a, b = one - one.mean(axis=1, keepdims=True), other - other.mean(axis=1, keepdims=True)
    norm = math.sqrt(float((a * a).sum() * (b * b).sum()))
    return float((a * b).sum()) / norm if norm > 0 else 0.0


def _disparity_in_focus_px(camera: Camera) -> float:
    """Of a point on the axis in the plane in focus, by the centroids of rays through both halves of the exit pupil."""
    lens = camera.lens
    if camera.model not in TRACED_MODELS or math.isinf(lens.focus_distance_m):
        return 0.0
    data = lens.first_order()
    source_z, film_z = lens.film_position_mm - 1000 * lens.focus_distance_m, lens.film_position_mm
    side = np.linspace(-0.55, 0.55, 64) * data.entrance_pupil_diameter_mm
    x, y = (values.ravel() for values in np.meshgrid(side, side))
    directions = np.stack([x, y, np.full_like(x, data.entrance_pupil_position_mm - source_z)], axis=1)
    origins = np.broadcast_to((0, 0, source_z), directions.shape)
    out = lens.trace(origins, directions, start="scene")
    passed = out.status == RayStatus.OK
    last, slope = out.origins_mm[passed], (out.directions[:, 0] / out.directions[:, 2])[passed]
    at_film = last[:, 0] + (film_z - last[:, 2]) * slope
    is_right = at_film / (film_z - data.exit_pupil_position_mm) > slope
    if is_right.all() or not is_right.any():
        return 0.0
    # Columns go against x of the lens.
    disparity_mm = at_film[~is_right].mean() - at_film[is_right].mean()
    return float(disparity_mm * camera.film.resolution[0] / camera.film.width_mm)


def _defocus_mm_per_px(camera: Camera) -> float:
    """How far before the film the image lies for a disparity of a column, to first order.

    The centroid of half a disc of radius r is 4 r / (3 pi) from its middle, so that light of both halves of the exit
    pupil comes from points 8 r / (3 pi) apart.
    """
    data = camera.lens.first_order()
    distance = abs(camera.lens.film_position_mm - data.exit_pupil_position_mm)
    slope = 8 / (3 * math.pi) * 0.5 * data.exit_pupil_diameter_mm / distance if math.isfinite(distance) else math.nan
    if not slope > 0 or not math.isfinite(slope):
        slope = 8 / (3 * math.pi) * 0.5 / data.f_number  # of a pupil at infinity
    return camera.film.width_mm / camera.film.resolution[0] / slope


def _between_foci_mm(lens: Lens) -> float:
    """From the front focal point to the back one."""
    data = lens.first_order()
    back = lens.film_position_mm - lens.film_distance_mm + data.back_focal_distance_mm
    return float(back - data.front_focal_distance_mm)


def _square_mm2(lens: Lens) -> float:
    """Front times rear focal length, n' f^2."""
    data = lens.first_order()
    return float(data.image_index * data.effective_focal_length_mm**2)


def _extension_mm(camera: Camera) -> float:
    """From the back focal point to the film, for which object and film are as far apart as the focus says.

    By Newton's x x' = n' f^2; of the two solutions that of the smaller image.
    """
    lens = camera.lens
    if math.isinf(lens.focus_distance_m):
        return 0.0
    both = 1000 * lens.focus_distance_m - _between_foci_mm(lens)
    return 0.5 * (both - math.sqrt(max(0.0, both * both - 4 * _square_mm2(lens))))


def _refocused(camera: Camera, extension_mm: float) -> Camera:
    """Focused on what has its image so far behind the back focal point; at an end of the lens's range, there."""
    lens, focal = camera.lens, camera.lens.first_order().effective_focal_length_mm
    if extension_mm <= 0:
        return camera.replace(lens=lens.focused(math.inf))
    extension_mm = min(extension_mm, MOST_MAGNIFICATION * focal)
    distance_m = 0.001 * (_between_foci_mm(lens) + extension_mm + _square_mm2(lens) / extension_mm)
    return camera.replace(lens=lens.focused(max(distance_m, lens.nearest_focus_m)))
