"""A calibration sampled for rendering: directions over the picture, their inverse, and where there are none."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.ndimage import binary_erosion, distance_transform_edt, map_coordinates

from ..._core import CalibratedGeometry, Film, InputError
from ..arrays import Array
from ..status import PointStatus
from .calibrated_picture import CalibratedPicture

MARGIN = 0.1  # of the picture's size, on every side: defocused light beside the picture falls into it
_INVERSE_SIDE = 257  # nodes along a side of the grid of positions
_MAX_MASK_SIDE = 1024  # cells along the longer side of the mask


def sampled_geometry(
    calibration: CalibratedPicture,
    film: Film,
    columns: int,
    mask: np.ndarray | None,
    gain: Callable[[Array], Array] | None = None,
) -> CalibratedGeometry:
    """Samples a calibration for a film, at the nodes of a grid with this number of columns of cells.

    mask: see defined_mask. gain: function of pixels (..., 2) that returns factors of the irradiance. Raises InputError
    if no pixel has a ray.
    """
    width, height = calibration.size
    pixels = node_pixels(calibration, columns, max(1, round(columns * height / width)))
    directions = _rays(calibration, pixels)
    is_defined = np.isfinite(directions[..., 0])
    if not is_defined.any():
        raise InputError("the calibration has no ray for any pixel of its picture")
    max_angle = float(np.arccos(np.clip(-directions[is_defined][:, 2], -1, 1)).max())
    (focal_x, skew, centre_x), (_, focal_y, centre_y) = calibration.camera_matrix[:2]
    return CalibratedGeometry(
        film=film,
        margin=MARGIN,
        directions=directions,
        gain=None if gain is None else gain(pixels).astype(np.float32),
        defined=mask,
        max_angle_deg=float(np.degrees(max_angle)),
        positions=_positions(calibration, max_angle),
        pinhole=(focal_x / width, focal_y / height, skew / width, centre_x / width, centre_y / height),
    )


def node_pixels(calibration: CalibratedPicture, columns: int, rows: int) -> Array:
    """Returns the pixels (rows + 1, columns + 1, 2) of the nodes of a grid over the picture with its margin."""
    width, height = calibration.size
    x, y = np.linspace(-MARGIN, 1 + MARGIN, columns + 1), np.linspace(-MARGIN, 1 + MARGIN, rows + 1)
    return np.stack(np.meshgrid(x * width, y * height), axis=-1)


def _rays(calibration: CalibratedPicture, pixels: Array) -> Array:
    """Returns the directions of pixels (..., 2) in the camera's axes (x right, y up, z backward); NaN for none."""
    directions, _ = calibration.ray(pixels.reshape(-1, 2))
    return (directions * (1, -1, -1)).reshape(*pixels.shape[:-1], 3)


def defined_mask(calibration: CalibratedPicture) -> np.ndarray | None:
    """Returns (rows, columns) booleans, True in the cells of the picture that have a ray; None if all have one."""
    centres = _mask_centres(calibration)
    _, status = calibration.ray(centres.reshape(-1, 2))
    defined = (status == PointStatus.OK).reshape(centres.shape[:2])
    return None if defined.all() else defined


def precise_mask(
    calibration: CalibratedPicture, mask: np.ndarray | None, columns: int, largest_px: float
) -> np.ndarray:
    """Returns a defined_mask without the cells about which the grid with this number of columns is off by more pixels.

    At a fold, where the angle per pixel has no limit, no grid is fine enough.
    """
    width, height = calibration.size
    rows = max(1, round(columns * height / width))
    directions = _rays(calibration, node_pixels(calibration, columns, rows))
    centres = _mask_centres(calibration)
    at = [
        (centres[..., axis] / size + MARGIN) / (1 + 2 * MARGIN) * cells
        for axis, size, cells in ((1, height, rows), (0, width, columns))
    ]
    seen = np.stack([map_coordinates(directions[..., axis], at, order=1) for axis in range(3)], axis=-1)
    pixels, _ = calibration.project((seen * (1, -1, -1)).reshape(-1, 3))
    with np.errstate(invalid="ignore"):
        is_precise = np.linalg.norm(pixels - centres.reshape(-1, 2), axis=1) <= largest_px
    defined = is_precise.reshape(centres.shape[:2])
    if mask is not None:
        defined &= mask
    # The error varies within a cell of the grid, which may be larger than those of the mask.
    across = -(-centres.shape[1] // columns) + 1
    precise: np.ndarray = binary_erosion(defined, iterations=across, border_value=True)
    return precise


def _mask_centres(calibration: CalibratedPicture) -> Array:
    """Returns the pixels (rows, columns, 2) of the centres of the mask's cells."""
    width, height = calibration.size
    scale = min(1.0, _MAX_MASK_SIDE / max(width, height))
    columns, rows = max(1, round(width * scale)), max(1, round(height * scale))
    x, y = (np.arange(columns) + 0.5) * width / columns, (np.arange(rows) + 0.5) * height / rows
    return np.stack(np.meshgrid(x, y), axis=-1)


def _positions(calibration: CalibratedPicture, max_angle: float) -> Array:
    """Returns the picture coordinates of directions, see CalibratedGeometry; beyond its margin those of its border."""
    x, y = np.meshgrid(*2 * [np.linspace(-1, 1, _INVERSE_SIDE)])
    radius = np.hypot(x, y)
    angle = np.minimum(radius * max_angle, np.pi)
    across = np.sin(angle) / np.where(radius > 0, radius, 1)
    # Computer vision's axes have y down and z forward.
    pixels, _ = calibration.project(np.stack([x * across, -y * across, np.cos(angle)], axis=-1).reshape(-1, 3))
    positions: Array = (pixels / calibration.size).reshape(_INVERSE_SIDE, _INVERSE_SIDE, 2)
    unknown = ~np.isfinite(positions).all(axis=-1)
    if unknown.any():
        nearest = distance_transform_edt(unknown, return_distances=False, return_indices=True)
        positions = positions[tuple(nearest)]
    return np.clip(positions, -MARGIN, 1 + MARGIN)
