"""Rectification of stereo pairs, after J.-Y. Bouguet's method as in OpenCV's stereoRectify."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .._core import InputError
from .arrays import Array


class StereoRectification(NamedTuple):
    """R1, R2: (3, 3) rotations from each camera's axes to the rectified ones. P1, P2: (3, 4) projection matrices of
    rectified points of the first camera, in realcam's pixel coordinates; rows of both pictures agree, or columns if
    one camera is above the other."""

    R1: Array
    P1: Array
    R2: Array
    P2: Array


def rectified(K1: Array, K2: Array, size: tuple[int, int], T: Array) -> StereoRectification:
    """T: (4, 4), from the first camera to the second. Both rectified cameras have one focal length, the smaller one of
    the originals, and their principal point in the centre of the picture. Raises InputError."""
    rotation, translation = _rigid(T)
    half = _half_turn(rotation)
    # Both cameras are turned by half of the rotation; the baseline is then expressed in the common axes.
    baseline = half @ translation
    axis = int(abs(baseline[1]) > abs(baseline[0]))
    align = _shortest_rotation(baseline, np.sign(baseline[axis]) * np.eye(3)[axis])
    focal = min(K1[0, 0], K1[1, 1], K2[0, 0], K2[1, 1])
    P1 = np.array([[focal, 0, size[0] / 2, 0], [0, focal, size[1] / 2, 0], [0, 0, 1, 0]])
    P2 = P1.copy()
    P2[axis, 3] = focal * np.sign(baseline[axis]) * np.linalg.norm(translation)
    return StereoRectification(align @ half.T, P1, align @ half, P2)


def rotation_of(matrix: Array, name: str) -> Array:
    """Returns the rotation (3, 3) next to a matrix that is one within the precision of printed digits.

    name: in the InputError for any other matrix.
    """
    if matrix.shape != (3, 3) or not np.isfinite(matrix).all():
        raise InputError(f"{name} must be a matrix of (3, 3) finite numbers")
    if np.abs(matrix @ matrix.T - np.eye(3)).max() > 1e-3 or np.linalg.det(matrix) < 0:
        raise InputError(f"{name} must be a rotation: orthonormal, with determinant 1")
    u, _, v = np.linalg.svd(matrix)
    rotation: Array = u @ v
    return rotation


def _rigid(T: Array) -> tuple[Array, Array]:
    if T.shape != (4, 4) or not np.isfinite(T).all():
        raise InputError("T must be a matrix of (4, 4) finite numbers")
    translation = T[:3, 3]
    if not np.linalg.norm(translation):
        raise InputError("the cameras of a stereo pair must be apart; T has no translation")
    return rotation_of(T[:3, :3], "the upper left part of T"), translation


def _half_turn(rotation: Array) -> Array:
    """Returns the rotation from the second camera's axes to the common ones: the inverse of half the rotation."""
    from scipy.spatial.transform import Rotation  # slow to load

    half: Array = Rotation.from_rotvec(-0.5 * Rotation.from_matrix(rotation).as_rotvec()).as_matrix()
    return half


def _shortest_rotation(start: Array, end: Array) -> Array:
    """Returns the rotation by the smallest angle from one direction to another."""
    from scipy.spatial.transform import Rotation  # slow to load

    a, b = start / np.linalg.norm(start), end / np.linalg.norm(end)
    normal = np.cross(a, b)
    sine = np.linalg.norm(normal)
    if not sine:
        return np.eye(3)
    turned: Array = Rotation.from_rotvec(normal / sine * np.arctan2(sine, a @ b)).as_matrix()
    return turned
