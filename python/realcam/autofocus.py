"""Phase-detection autofocus with dual pixels, from the disparity of the images through the exit pupil's two halves."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ._core import Camera, InputError, Lens, RayStatus, Scene
from .rec709 import LUMINANCE
from .session import Session

Array = NDArray[np.float64]

TRACED_MODELS = ("full", "full_double", "polynomial")  # camera models with the aberrations of the lens
MAX_STEPS = 12
MAX_MAGNIFICATION = 0.9  # focus limit of lenses whose file does not specify a nearest focus
MIN_CORRELATION = 0.2  # the correlation of two images of pure noise is some hundredths


@dataclass(frozen=True)
class Autofocus:
    """Result of autofocus().

    camera: the focused camera. focus_distances_m, disparities_px: focus distance and disparity at each step. The
    disparity is the shift, in columns to the right, of the right pupil half's image relative to the left half's, minus
    its value in focus; it is positive if the scene is farther away than the focus distance.
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
    """Focuses a camera on the content of a window of its picture, by dual pixels alone, without the depth layer.

    at: column and row of the window's centre; None: the centre of the picture. window_px: width and height of the
    window; None: a quarter of the picture's. tolerance_px: disparity at which the search ends. spp: samples per pixel
    and step, 1 to 256.
    Each step moves the lens by the first-order defocus of the disparity; a secant estimate corrects later steps.
    Aberrations cause a disparity even in focus; it is calibrated with rays through the lens (docs/dual-pixels.md).
    Effects are off. Raises InputError, also if the window has no horizontal contrast or shows nothing within the
    focus range of the lens.
    """
    columns, rows = camera.film.resolution
    centre = at or (columns / 2, rows / 2)
    width, height = window_px or (max(16, columns // 4), max(8, rows // 4))
    region = (
        _window_start(centre[0], width, columns),
        _window_start(centre[1], height, rows),
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
        if len(disparities) == MAX_STEPS:
            raise InputError(
                f"no focus was found in {MAX_STEPS} steps; the disparity is still {disparity:.3g} pixels (use a "
                "window with one depth in it, or more samples)"
            )
        if len(disparities) > 1 and disparity != disparities[-2]:
            # Secant slope of the last step, clamped because the first images may be matched wrongly.
            per_mm = (disparities[-2] - disparity) / (extension - extensions[-2])
            factor = float(np.clip(-1 / (per_mm * _defocus_mm_per_px(camera)), 0.25, 2)) if per_mm < 0 else 1.0
        focused = _refocused(camera, extension - factor * disparity * _defocus_mm_per_px(camera))
        if focused.lens.focus_distance_m == camera.lens.focus_distance_m:
            raise InputError(
                f"the content of the window cannot be brought into focus: at {camera.lens.focus_distance_m:.4g} m, "
                f"where the focus range of the lens ends, its disparity is {disparity:.3g} pixels"
            )
        camera = focused
        extension = _extension_mm(camera)
        session.set(camera=camera)


def _window_start(centre: float, size: int, film_size: int) -> int:
    """Returns the first column or row of a window, which is moved to lie on the film."""
    return int(np.clip(round(centre - size / 2), 0, max(0, film_size - size)))


def _disparity_px(session: Session, region: tuple[int, int, int, int], spp: int) -> float:
    """Returns the shift of the right pupil half's image relative to the left half's, in columns to the right.

    It is the position of the maximum of their cross-correlation, interpolated by a parabola. Raises InputError if the
    correlation is below MIN_CORRELATION.
    """
    sums = session.expose(region, 0, spp).pixels
    assert sums is not None
    right = sums["auxiliary"] @ LUMINANCE
    left = sums["irradiance"] @ LUMINANCE - right
    width = left.shape[1]
    max_shift = width // 2
    shifts = np.arange(-max_shift, max_shift + 1)
    correlations = np.array(
        [_correlation(left[:, max(0, -s) : width - max(0, s)], right[:, max(0, s) : width + min(0, s)]) for s in shifts]
    )
    best = int(correlations.argmax())
    if correlations[best] < MIN_CORRELATION:
        raise InputError(
            "the window has too little contrast across its columns to be focused on; choose another window"
        )
    if best in (0, 2 * max_shift):
        return float(shifts[best])
    left_value, peak, right_value = correlations[best - 1 : best + 2]
    curvature = left_value - 2 * peak + right_value
    return float(shifts[best] + (0.5 * (left_value - right_value) / curvature if curvature < 0 else 0.0))


def _correlation(one: Array, other: Array) -> float:
    """Returns the normalised correlation of two images without their row means, -1 to 1; 0 if one is uniform."""
    a, b = one - one.mean(axis=1, keepdims=True), other - other.mean(axis=1, keepdims=True)
    norm = math.sqrt(float((a * a).sum() * (b * b).sum()))
    return float((a * b).sum()) / norm if norm > 0 else 0.0


def _disparity_in_focus_px(camera: Camera) -> float:
    """Returns the disparity, in columns, of the axial point in the plane in focus, from ray centroids of the exit
    pupil's halves.

    Returns 0 for camera models without aberrations and for focus at infinity.
    """
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
    # The column index increases towards -x of the lens frame.
    disparity_mm = at_film[~is_right].mean() - at_film[is_right].mean()
    return float(disparity_mm * camera.film.resolution[0] / camera.film.width_mm)


def _defocus_mm_per_px(camera: Camera) -> float:
    """Returns the distance of the image in front of the film per column of disparity, in mm, to first order.

    The centroid of half a disc of radius r is 4 r / (3 pi) from the disc's centre, so the centroids of the exit pupil's
    halves are 8 r / (3 pi) apart.
    """
    data = camera.lens.first_order()
    distance = abs(camera.lens.film_position_mm - data.exit_pupil_position_mm)
    slope = 8 / (3 * math.pi) * 0.5 * data.exit_pupil_diameter_mm / distance if math.isfinite(distance) else math.nan
    if not slope > 0 or not math.isfinite(slope):
        slope = 8 / (3 * math.pi) * 0.5 / data.f_number  # exit pupil at infinity
    return camera.film.width_mm / camera.film.resolution[0] / slope


def _between_foci_mm(lens: Lens) -> float:
    """Returns the distance from the front focal point to the rear one, in mm."""
    data = lens.first_order()
    back = lens.film_position_mm - lens.film_distance_mm + data.back_focal_distance_mm
    return float(back - data.front_focal_distance_mm)


def _focal_length_product_mm2(lens: Lens) -> float:
    """Returns the product of the front and the rear focal length, n' f^2, in mm^2."""
    data = lens.first_order()
    return float(data.image_index * data.effective_focal_length_mm**2)


def _extension_mm(camera: Camera) -> float:
    """Returns the distance from the rear focal point to the film, in mm, for the camera's focus distance.

    It follows from Newton's equation x x' = n' f^2; of its two solutions, the one with the smaller image.
    """
    lens = camera.lens
    if math.isinf(lens.focus_distance_m):
        return 0.0
    sum_mm = 1000 * lens.focus_distance_m - _between_foci_mm(lens)  # x + x'
    return 0.5 * (sum_mm - math.sqrt(max(0.0, sum_mm * sum_mm - 4 * _focal_length_product_mm2(lens))))


def _refocused(camera: Camera, extension_mm: float) -> Camera:
    """Returns the camera focused on the object whose image lies extension_mm behind the rear focal point, clamped to
    the focus range."""
    lens, focal = camera.lens, camera.lens.first_order().effective_focal_length_mm
    if extension_mm <= 0:
        return camera.replace(lens=lens.focused(math.inf))
    extension_mm = min(extension_mm, MAX_MAGNIFICATION * focal)
    distance_m = 0.001 * (_between_foci_mm(lens) + extension_mm + _focal_length_product_mm2(lens) / extension_mm)
    return camera.replace(lens=lens.focused(max(distance_m, lens.nearest_focus_m)))
