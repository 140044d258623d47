"""Rigid transforms as (4, 4) matrices."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .arrays import Array


def rigid(quaternion: Sequence[float], translation: Sequence[float]) -> Array:
    """Returns the transform of a quaternion (w, x, y, z), of any length but 0, and a translation."""
    w, x, y, z = np.asarray(quaternion, dtype=float) / np.linalg.norm(quaternion)
    transform = np.eye(4)
    transform[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    transform[:3, 3] = translation
    return transform


def inverse_of(transform: Array) -> Array:
    """Returns the inverse of a rigid transform."""
    inverse = np.eye(4)
    inverse[:3, :3] = transform[:3, :3].T
    inverse[:3, 3] = -transform[:3, :3].T @ transform[:3, 3]
    return inverse


def turned(rotation: Array, translation: Array) -> Array:
    """Returns the transform of a (3, 3) rotation and a translation."""
    transform = np.eye(4)
    transform[:3, :3], transform[:3, 3] = rotation, translation
    return transform


def quaternion(transform: Array) -> list[float]:
    """Returns the unit quaternion (w, x, y, z) of a rigid transform, with w >= 0."""
    from scipy.spatial.transform import Rotation  # slow to load

    x, y, z, w = Rotation.from_matrix(transform[:3, :3]).as_quat(canonical=True).tolist()
    return [w, x, y, z]
