"""Camera pose, and its changes by mouse."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Vector = NDArray[np.float64]

_STEEPEST = 0.995  # largest cosine between view and up: closer to the pole the picture would spin


@dataclass(frozen=True)
class Pose:
    """Camera pose in scene coordinates, metres. look_at_m: centre of orbits."""

    position_m: tuple[float, float, float]
    look_at_m: tuple[float, float, float]
    up: tuple[float, float, float] = (0.0, 1.0, 0.0)

    @property
    def distance_m(self) -> float:
        return float(np.linalg.norm(np.subtract(self.look_at_m, self.position_m)))

    def orbited(self, right_rad: float, up_rad: float) -> Pose:
        """Orbits around the look-at point, to the right and up in the camera's frame."""
        back = np.subtract(self.position_m, self.look_at_m)
        up = _unit(np.array(self.up))
        back = Rotation.from_rotvec(right_rad * up).apply(back)
        right = _unit(np.cross(up, back))
        raised = Rotation.from_rotvec(-up_rad * right).apply(back)
        if abs(_unit(raised) @ up) < _STEEPEST:
            back = raised
        return replace(self, position_m=_triple(np.add(self.look_at_m, back)))

    def panned(self, right_m: float, up_m: float) -> Pose:
        """Moves camera and look-at point sideways."""
        view = _unit(np.subtract(self.look_at_m, self.position_m))
        right = _unit(np.cross(view, self.up))
        move = right_m * right + up_m * np.cross(right, view)
        return replace(
            self,
            position_m=_triple(np.add(self.position_m, move)),
            look_at_m=_triple(np.add(self.look_at_m, move)),
        )

    def dollied(self, factor: float) -> Pose:
        """Scales the distance from the look-at point."""
        back = np.subtract(self.position_m, self.look_at_m)
        return replace(self, position_m=_triple(np.add(self.look_at_m, factor * back)))


def _unit(vector: Vector) -> Vector:
    return np.asarray(vector / np.linalg.norm(vector))


def _triple(vector: Vector) -> tuple[float, float, float]:
    x, y, z = (float(v) for v in vector)
    return x, y, z
