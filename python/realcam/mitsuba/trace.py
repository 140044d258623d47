"""Sequential ray tracing through a lens in Dr.Jit, with the formulas of realcam's own tracer.

Rays carry optical directions, which are unit vectors times the refractive index, as in Hamilton's optics. Snell's law
then changes a direction along the surface's normal alone: p' = p + (s' - s) N, with s = p.N and s'^2 = n'^2 - n^2 +
s^2.
"""

from __future__ import annotations

from typing import Any

import drjit as dr
import mitsuba as mi

from .crossings import Asphere, Crossing

# Maximum number of safeguarded Newton steps on an asphere: enough for bisection alone to reach float32's last digit.
ASPHERE_STEPS = 24


def opaque(value: float) -> Any:
    """Makes a number a variable of the compiled kernel, not a constant, so that changing it needs no recompilation."""
    return dr.opaque(mi.Float, value) if dr.is_jit_v(mi.Float) else float(value)


class LensTrace:
    """Traces rays through a list of surfaces in the order of the ray; rays start relative to the vertex of the first
    one."""

    def __init__(self, crossings: list[Crossing]) -> None:
        self.crossings = crossings
        vertices = [crossing.vertex_mm for crossing in crossings]
        self.shifts = [
            opaque(vertex - previous) for previous, vertex in zip(vertices[:1] + vertices, vertices, strict=False)
        ]
        self.rims = [opaque(crossing.rim_mm) for crossing in crossings]

    def __call__(self, o: Any, p: Any, variable: Any) -> tuple[Any, Any, Any, Any, Any]:
        """Returns point (mm, relative to the last vertex) and optical direction after the last surface; the point on
        the first surface, relative to its vertex; whether the ray passes; and whether it would pass without rims.

        o, p: point in mm and optical direction. variable: value of VARIABLE for each ray, or None for the design
        wavelength.
        """
        is_unblocked = exists = mi.Bool(True)
        first = None
        for crossing, shift, rim in zip(self.crossings, self.shifts, self.rims, strict=True):
            o = mi.Point3f(o.x, o.y, o.z - shift)
            o, normal, hits = intersect(crossing, o, p)
            first = o if first is None else first
            along = dr.dot(p, normal)
            radicand = dr.fma(squared_index_change(crossing, variable), dr.squared_norm(p), along * along)
            p = dr.fma(normal, crossing.sign_out * dr.sqrt(dr.maximum(radicand, 0)) - along, p)
            exists = exists & hits & (radicand >= 0)
            is_unblocked = is_unblocked & lets_through(crossing, rim, o)
        return o, p, first, exists & is_unblocked, exists


def squared_index_change(crossing: Crossing, variable: Any) -> Any:
    """n'^2 / n^2 - 1 at a surface. variable: value of VARIABLE; None: the design wavelength."""
    if variable is None or not crossing.index_terms:
        return mi.Float(crossing.index_change)
    return horner(crossing.index_terms, variable)


def horner(terms: tuple[float, ...], x: Any) -> Any:
    """Polynomial with the constant first."""
    value = mi.Float(terms[-1])
    for term in reversed(terms[:-1]):
        value = dr.fma(value, x, term)
    return value


def lets_through(crossing: Crossing, rim: Any, at: Any) -> Any:
    """True if a point of the surface, mm from its vertex, lies within rim and iris, and outside of a hole."""
    squared = at.x * at.x + at.y * at.y
    is_open = squared <= rim * rim
    if crossing.hole_mm > 0:
        is_open = is_open & (squared >= crossing.hole_mm**2)
    if iris := crossing.iris:
        # A point inside the circle of the blade nearest to it lies inside the circles of all blades.
        extent = mi.Float(-dr.inf)
        for azimuth in iris.azimuths_rad:
            extent = dr.maximum(extent, at.x * dr.cos(azimuth) + at.y * dr.sin(azimuth))
        h, q = iris.apothem_mm, iris.curvature_per_mm
        is_open = is_open & (q * (squared + h * h) + 2 * (1 - q * h) * extent - 2 * h <= 0)
    return is_open


def intersect(crossing: Crossing, o: Any, p: Any) -> tuple[Any, Any, Any]:
    """Intersects rays with a surface. o, p: point in mm from its vertex, and optical direction.

    Returns point, unit normal (z positive near the vertex), and true if the ray hits the surface.
    """
    if crossing.asphere:
        return intersect_asphere(crossing, crossing.asphere, o, p)
    if crossing.curvature_per_mm == 0:
        at = dr.fma(p, -o.z / p.z, o)
        return at, mi.Normal3f(0, 0, 1), p.z * crossing.sign_in > 0
    t, normal, hits = intersect_conic(crossing, o, p)
    return dr.fma(p, t, o), normal, hits


def intersect_conic(crossing: Crossing, o: Any, p: Any) -> tuple[Any, Any, Any]:
    """Returns ray parameter, unit normal, and whether the ray hits the conic. The root of A t^2 - 2 G t + F = 0 is
    computed in the form without cancellation; it is selected by the required sign of the crossing, also beyond 90
    degrees."""
    c, k = crossing.curvature_per_mm, crossing.conic
    po, pp, oo = dr.dot(o, p), dr.squared_norm(p), dr.squared_norm(o)
    if k != 0:
        # Start from the vertex plane: otherwise a large k loses the sag in squares of the distance travelled.
        approach = dr.select(p.z * p.z < 0.01 * pp, -po / pp, -o.z / p.z)
        o = dr.fma(p, approach, o)
        po = dr.dot(o, p) + k * o.z * p.z
        pp, oo = pp + k * p.z * p.z, dr.squared_norm(o) + k * o.z * o.z
    F, G, A = c * oo - 2 * o.z, p.z - c * po, c * pp
    discriminant = G * G - A * F
    s = crossing.sign_in * dr.sqrt(dr.maximum(discriminant, 0))
    near = G * crossing.sign_in >= 0
    t = dr.select(near, F, G - s) / dr.select(near, G + s, A)
    at = dr.fma(p, t, o)
    gradient = mi.Vector3f(-c * at.x, -c * at.y, 1 - c * (1 + k) * at.z)
    normal = gradient if k == 0 else dr.normalize(gradient)
    hits = (discriminant > 0) & (normal.z > 0) & dr.isfinite(t)
    return (t if k == 0 else t + approach), normal, hits


def intersect_asphere(crossing: Crossing, shape: Asphere, o: Any, p: Any) -> tuple[Any, Any, Any]:
    """Intersects by Newton's method for f(t) = z(t) - sag, in a bracket that starts at the planes of the sag's
    bounds."""
    per_z = dr.rcp(dr.select(p.z == 0, 1.0, p.z))
    below, above = (shape.lowest_mm - o.z) * per_z, (shape.highest_mm - o.z) * per_z
    start, _, conic_hits = intersect_conic(crossing, o, p) if crossing.curvature_per_mm else (-o.z * per_z, None, True)
    inside = (start - below) * (above - start) >= 0
    t = dr.select(conic_hits & inside, start, 0.5 * (below + above))
    # Rounding errors of a height are a few millionths of the lengths involved.
    tolerance = 2e-6 * (shape.highest_mm - shape.lowest_mm + dr.abs(o.z))

    def is_open(step: Any, t: Any, below: Any, above: Any, residual: Any) -> Any:
        return (step < ASPHERE_STEPS) & (residual > tolerance)

    def improve(step: Any, t: Any, below: Any, above: Any, residual: Any) -> tuple[Any, ...]:
        at = dr.fma(p, t, o)
        sag, derivative = sag_of(crossing, shape, at)
        f, slope = at.z - sag, p.z - 2 * derivative * (at.x * p.x + at.y * p.y)
        below, above = dr.select(f <= 0, t, below), dr.select(f > 0, t, above)
        newton = t - f / slope
        is_right = slope * crossing.sign_in > 0
        is_good = ((newton - below) * (above - newton) >= 0) & is_right
        # One more step after the last residual costs nothing and squares the remaining error.
        t = dr.select(is_good, newton, 0.5 * (below + above))
        return step + 1, t, below, above, dr.select(is_right, dr.abs(f), dr.inf)

    # A symbolic loop, because unrolled code for all steps of all surfaces would take minutes to compile.
    state = (mi.UInt32(0), mi.Float(t), mi.Float(below), mi.Float(above), mi.Float(dr.inf))
    _, t, _, _, residual = dr.while_loop(state, is_open, improve)
    at = dr.fma(p, t, o)
    _, derivative = sag_of(crossing, shape, at)
    normal = dr.normalize(mi.Vector3f(-2 * derivative * at.x, -2 * derivative * at.y, 1))
    hits = (residual <= tolerance) & (dr.dot(p, normal) * crossing.sign_in > 0)
    return at, normal, hits


def sag_of(crossing: Crossing, shape: Asphere, at: Any) -> tuple[Any, Any]:
    """Returns sag in mm and its derivative with respect to r^2."""
    c, inverse = crossing.curvature_per_mm, 1 / shape.reach_mm**2
    squared = at.x * at.x + at.y * at.y
    r2 = dr.minimum(squared, shape.reach_mm**2)
    u = r2 * inverse
    root = dr.sqrt(dr.maximum(1 - (1 + crossing.conic) * c * c * r2, 1e-12))
    value, slope = mi.Float(0), mi.Float(0)
    for term in reversed(shape.terms):
        slope = dr.fma(slope, u - 0.5, value)
        value = dr.fma(value, u - 0.5, term)
    sag = c * r2 / (1 + root) + u * u * value
    derivative = c / (2 * root) + inverse * u * (2 * value + u * slope)
    return sag, dr.select(squared <= shape.reach_mm**2, derivative, 0.0)
