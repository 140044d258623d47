"""Rays of a lens in mpmath's digits, by Newton's method on the sags and Snell's law. It shares no code with realcam."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import mpmath
import numpy as np
from mpmath import mpf

ENOUGH = mpf(10) ** -25  # the last step of Newton's method, mm: the next one would be 1e-20 of it or less


def dot(a: list[Any], b: list[Any]) -> Any:
    return sum(p * q for p, q in zip(a, b, strict=True))


def plus(a: list[Any], factor: Any, b: list[Any]) -> list[Any]:
    return [p + factor * q for p, q in zip(a, b, strict=True)]


def unit(a: list[Any]) -> list[Any]:
    size = mpmath.sqrt(dot(a, a))
    return [p / size for p in a]


def cross(a: list[Any], b: list[Any]) -> list[Any]:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def by_differences(
    function: Callable[[dict[str, Any]], dict[str, Any]], numbers: dict[str, Any], names: Iterable[str], share: Any
) -> dict[str, list[float]]:
    """Central differences of each quantity of `function(changed numbers)` by the numbers of these names. share: the
    step over the number."""
    slopes: dict[str, list[float]] = {}
    for name in names:
        step = share * (abs(numbers[name]) or 1)
        above, below = (function({name: numbers[name] + side}) for side in (step, -step))
        for quantity, value in above.items():
            slopes.setdefault(quantity, []).append(float((value - below[quantity]) / (2 * step)))
    return slopes


@dataclass
class Face:
    """z = c r^2 / (1 + sqrt(1 - (1 + k) c^2 r^2)) + a4 r^4, with y for r where it is a cylinder. thickness: to the next
    one. tilt_deg: about x, then about the y that is turned."""

    before: Any
    behind: Any
    thickness: Any
    c: Any = 0
    k: Any = 0
    a4: Any = 0
    is_cylinder: bool = False
    tilt_deg: tuple[Any, Any] = (0, 0)
    decentre: tuple[Any, Any] = (0, 0)

    def met(self, o: list[Any], d: list[Any]) -> tuple[Any, list[Any]]:
        """The parameter of a ray that meets it, and the normal there."""
        t = -o[2] / d[2]
        for _ in range(9):
            x, y, z = plus(o, t, d)
            r2 = y * y if self.is_cylinder else x * x + y * y
            root = mpmath.sqrt(1 - (1 + self.k) * self.c * self.c * r2)
            slope = self.c / root + 4 * self.a4 * r2  # d sag / dr over r
            normal = [mpf(0) if self.is_cylinder else -slope * x, -slope * y, mpf(1)]
            change = (z - self.c * r2 / (1 + root) - self.a4 * r2 * r2) / dot(normal, d)
            t -= change
            if abs(change) < ENOUGH:
                break
        return t, unit(normal)

    def turned(self, v: list[Any], sign: int) -> list[Any]:
        """From its frame to the axis's (1), or back (-1)."""
        if self.tilt_deg == (0, 0):
            return v
        tilt = (mpmath.radians(angle) for angle in self.tilt_deg)
        (cos_a, sin_a), (cos_b, sin_b) = ((mpmath.cos(a), mpmath.sin(a)) for a in tilt)

        def about_x(w: list[Any], sin: Any) -> list[Any]:
            return [w[0], cos_a * w[1] - sin * w[2], sin * w[1] + cos_a * w[2]]

        def about_y(w: list[Any], sin: Any) -> list[Any]:
            return [cos_b * w[0] + sin * w[2], w[1], -sin * w[0] + cos_b * w[2]]

        return about_x(about_y(v, sin_b), sin_a) if sign > 0 else about_y(about_x(v, -sin_a), -sin_b)


def refracted(d: list[Any], normal: list[Any], mu: Any) -> list[Any]:
    cosine = dot(d, normal)
    return plus([mu * a for a in d], mpmath.sqrt(1 - mu * mu * (1 - cosine * cosine)) - mu * cosine, normal)


def traced(faces: list[Face], stop: int, o: list[Any], d: list[Any]) -> tuple[list[Any], list[Any], list[Any], Any]:
    """Point on the stop; point and direction on the last face, whose vertex is the origin then; optical path."""
    path, z, on_stop = mpf(0), mpf(0), []
    for number, face in enumerate(faces):
        vertex = [*face.decentre, z]
        o, d = face.turned(plus(o, -1, vertex), -1), face.turned(d, -1)
        t, normal = face.met(o, d)
        o, path = plus(o, t, d), path + face.before * t
        d = refracted(d, normal, mpf(face.before) / face.behind)
        if number == stop:
            on_stop = o[:2]
        o, d = plus(face.turned(o, 1), 1, vertex), face.turned(d, 1)
        z += face.thickness
    return on_stop, plus(o, -1, vertex), d, path


class ObjectRays:
    """The rays of one object point through given places on the stop. from_, x, y: a point in front of the lens and the
    axes of a plane there. towards: the direction of the chief ray; point: the object's, None for infinity. `near`: the
    same for nearly the same lens, from which they are looked for."""

    def __init__(
        self,
        faces: list[Face],
        stop: int,
        stop_mm: float,
        start: tuple[list[Any], list[Any], list[Any]],
        towards: list[Any],
        point: list[Any] | None,
        pupil: np.ndarray,
        near: ObjectRays | None = None,
    ) -> None:
        self.faces, self.stop, self.towards, self.point = faces, stop, towards, point
        self.from_, self.x, self.y = start
        # Rays at the edge are aimed at 5e-11 inside of it.
        places = [[stop_mm * (1 - mpf(5e-11)) * mpf(v) for v in place] for place in (*pupil, (0, 0))]
        starts = near.entries if near else [(mpf(0), mpf(0))] * len(places)
        self.entries = [self._entry(place, start) for place, start in zip(places, starts, strict=True)]
        *self.rays, self.chief = (self._ray(*entry)[1] for entry in self.entries)
        self.start = self._ray(*self.entries[-1])[0]

    def _ray(self, x: Any, y: Any) -> tuple[Any, Any]:
        """By where it crosses the plane, with the path from the wavefront through from_, or the object."""
        at = plus(plus(self.from_, x, self.x), y, self.y)
        if self.point is None:
            d, before = self.towards, dot(plus(at, -1, self.from_), self.towards)
        else:
            off = plus(at, -1, self.point)
            d, before = unit(off), mpmath.sqrt(dot(off, off))
        stop, o, p, path = traced(self.faces, self.stop, at, d)
        return (at, d), (stop, o, p, path + before)

    def _entry(self, place: list[Any], start: tuple[Any, Any]) -> tuple[Any, Any]:
        (x, y), h = start, mpf(10) ** -20
        for _ in range(7):
            s, sx, sy = (self._ray(*at)[1][0] for at in ((x, y), (x + h, y), (x, y + h)))
            slope = mpmath.matrix([[(sx[i] - s[i]) / h, (sy[i] - s[i]) / h] for i in (0, 1)])
            change = mpmath.lu_solve(slope, mpmath.matrix([place[i] - s[i] for i in (0, 1)]))
            x, y = x + change[0], y + change[1]
            if mpmath.norm(change) < ENOUGH:
                break
        return x, y

    def spot_mm(self) -> Any:
        at = [o for _, o, _, _ in self.rays]
        middle = [sum(p[i] for p in at) / len(at) for i in (0, 1)]
        return mpmath.sqrt(sum((p[0] - middle[0]) ** 2 + (p[1] - middle[1]) ** 2 for p in at) / len(at))

    def chief_ray_height_mm(self) -> Any:
        return self.chief[1][1]

    def contrast(self, along: list[Any], frequency_per_mm: int = 15) -> Any:
        waves = [mpmath.expjpi(2 * frequency_per_mm * dot(o[:2], along)) for _, o, _, _ in self.rays]
        return abs(sum(waves)) / len(waves)

    def rms_waves(self, radius: Any, wavelength_nm: float) -> Any:
        """RMS of the path lengths to the sphere of this radius about the chief ray's film point, in wavelengths."""
        paths = []
        for _, o, d, path in self.rays:
            b = plus(o, -1, self.chief[1])
            along = dot(b, d)
            paths.append(path - along - mpmath.sqrt(along**2 - dot(b, b) + radius**2))
        mean = sum(paths) / len(paths)
        return mpmath.sqrt(sum((p - mean) ** 2 for p in paths) / len(paths)) * 1e6 / mpf(wavelength_nm)
