"""Parameters of a camera model in a normal form, from which the writers of file formats take their numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NoReturn, TypeVar

import numpy as np

from ..arrays import Array
from ..stated_camera import StatedCamera
from .central import CentralModel
from .distortion import BrownConrady
from .projections import Projection
from .radial import RationalRadius

P = TypeVar("P", bound=Projection)


class Inexpressible(Exception):  # noqa: N818
    """A camera that a file format cannot hold. The message says what it lacks, such as "has no tangential terms"."""


@dataclass(frozen=True)
class Terms:
    """A central model whose matrix is scaled so that the distortion is the identity near the axis.

    matrix: (3, 3), to realcam's pixels. top, bottom: coefficients of the radial factor by ascending powers, from the
    first power on. size: (width, height), pixels.
    """

    projection: Projection
    matrix: Array
    top: tuple[float, ...]
    bottom: tuple[float, ...]
    tangential: tuple[float, float]
    prism: tuple[float, float, float, float]
    is_sequential: bool
    tilt: tuple[float, float] | None
    size: tuple[int, int]
    sees_behind: bool

    def projected_by(self, kind: type[P]) -> P:
        """Returns the projection if it is of a kind. Raises Inexpressible."""
        if not isinstance(self.projection, kind):
            raise Inexpressible(f"has no model of the kind {type(self.projection).__name__}")
        return self.projection

    def without(self, *names: str) -> None:
        """Raises Inexpressible if the distortion has terms of these kinds; see _NAMED."""
        for name in names:
            value: Any = getattr(self, name)
            if np.any(value):
                raise Inexpressible(f"has no {_NAMED[name]}")

    def within_90_degrees(self) -> None:
        """Raises Inexpressible if a pixel of the picture shows a direction 90 degrees or more off the axis."""
        if self.sees_behind:
            raise Inexpressible("ends at 90 degrees off the axis, and the picture shows more")

    def even(self, coefficients: Sequence[float], count: int) -> list[float]:
        """Returns `count` coefficients of even powers, of `top` or `bottom`. Raises Inexpressible."""
        if any(coefficients[0::2]):
            raise Inexpressible("has no odd powers of the distance from the axis")
        stated = [*coefficients[1::2], *[0.0] * count]
        if any(stated[count:]):
            raise Inexpressible(f"has only {count} coefficients of the radial polynomial")
        return stated[:count]

    def pixel_matrix(self, origin: float) -> tuple[float, float, float, float]:
        """Returns fx, fy, cx, cy for pixels whose first centre has this coordinate. Raises Inexpressible for a skew."""
        (fx, skew, cx), (shear, fy, cy) = self.matrix[:2].tolist()
        if skew or shear or fx <= 0 or fy <= 0:
            raise Inexpressible("has no skew of the pixels")
        return fx, fy, cx + (origin - 0.5), cy + (origin - 0.5)


_NAMED = {
    "top": "radial distortion",
    "bottom": "denominator of the radial distortion",
    "tangential": "tangential distortion",
    "prism": "thin-prism distortion",
    "is_sequential": "tangential terms of the radially distorted point",
    "tilt": "tilted sensor",
}


def terms_of(camera: StatedCamera) -> Terms:
    """Returns the terms of a camera's model. Raises Inexpressible for a table and for an inverse polynomial."""
    model = camera.camera_model
    if not isinstance(model, CentralModel):
        _refuse_table()
    distortion = model.distortion
    if not isinstance(distortion, BrownConrady):
        raise Inexpressible("has no polynomial from distorted to undistorted points")
    radius = distortion.radius
    scale = distortion.scale
    if scale != 1 and distortion.is_sequential and not distortion.is_radial:
        _refuse_table()
    return Terms(
        projection=model.projection,
        matrix=model.matrix if scale == 1 else model.matrix @ np.diag([scale, scale, 1.0]),
        top=_normalised(radius.top),
        bottom=_normalised(radius.bottom),
        tangential=(distortion.tangential[0] / scale, distortion.tangential[1] / scale),
        prism=tuple(value / scale for value in distortion.prism),  # type: ignore[arg-type]
        is_sequential=distortion.is_sequential and not distortion.is_radial,
        tilt=model.tilt,
        size=camera.size,
        sees_behind=sees_behind(camera),
    )


def is_undistorted(terms: Terms) -> bool:
    """True if the distortion is the identity."""
    radius = RationalRadius((1.0, *terms.top), (1.0, *terms.bottom))
    return radius.is_identity and not any((*terms.tangential, *terms.prism)) and terms.tilt is None


def _refuse_table() -> NoReturn:
    raise Inexpressible("has no tables of directions")


def _normalised(coefficients: Sequence[float]) -> tuple[float, ...]:
    first, *others = coefficients
    return tuple(value / first for value in others) if first != 1 else tuple(others)


def sees_behind(camera: StatedCamera) -> bool:
    """True if a point of the picture's edge has a ray with z <= 0, or none although the model reaches as far."""
    if camera.camera_model.largest_angle <= np.pi / 2:
        return False
    side = np.linspace(0, 1, 33)
    ends = np.zeros_like(side)
    edge = np.concatenate([np.stack(pair, axis=1) for pair in ((side, ends), (side, ends + 1), (ends, side))])
    edge = np.concatenate([edge, np.stack([ends + 1, side], axis=1)]) * np.array(camera.size, dtype=float)
    rays, _ = camera.camera_model.ray(edge)
    # A pixel without a ray may lie beyond the directions that the model sees, behind 90 degrees.
    return bool((~(rays[:, 2] > 0)).any())
