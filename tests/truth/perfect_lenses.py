"""Lenses with closed forms: of their images, or of their aberrations."""

from __future__ import annotations

import math

import realcam as rc


def folded_paraboloid(defocus_mm: float = 0.0, semi_diameter_mm: float = 80.0) -> rc.Lens:
    """Images infinity perfectly. Focal length 100; a flat mirror folds the light back to the film's side."""
    return rc.Lens(
        surfaces=[
            rc.Stop(clear_semi_diameter_mm=semi_diameter_mm, thickness_mm=50),
            rc.Mirror(radius_of_curvature_mm=-200, conic=-1, thickness_mm=-40, clear_semi_diameter_mm=90),
            rc.Mirror(clear_semi_diameter_mm=90),
        ],
        film_distance_mm=60.0 + defocus_mm,
    )


def ellipsoid(n: float) -> rc.Lens:
    """Conic -1 / n^2: infinity is imaged perfectly n R / (n - 1) behind the vertex, in the glass."""
    return rc.Lens(
        surfaces=[
            rc.Stop(clear_semi_diameter_mm=29),
            rc.Surface(radius_of_curvature_mm=40, material=n, conic=-1 / n**2, clear_semi_diameter_mm=30),
        ],
        film_distance_mm=n * 40 / (n - 1),
    )


def thin_lens(bending: float, material: float | tuple[float, float]) -> rc.Lens:
    """Focal length 100, without thickness, the stop on it; bending = (c1 + c2) / (c1 - c2)."""
    n = material[0] if isinstance(material, tuple) else material
    difference = 1 / ((n - 1) * 100)
    curvatures = 0.5 * difference * (bending + 1), 0.5 * difference * (bending - 1)
    front, back = (math.inf if c == 0 else 1 / c for c in curvatures)
    return rc.Lens(
        surfaces=[
            rc.Stop(clear_semi_diameter_mm=5),
            rc.Surface(radius_of_curvature_mm=front, material=material, clear_semi_diameter_mm=6),
            rc.Surface(radius_of_curvature_mm=back, clear_semi_diameter_mm=6),
        ],
        film_distance_mm=100,
        allow_overlap=True,  # a thin lens has no thickness for its curved faces
    )


def thin_lens_aberration(bending: float, n: float) -> float:
    """(1 / s' at height h less 1 / f) / h^2, mm^-3: Jenkins and White, Fundamentals of Optics, equation 9l, for an
    object at infinity (p = -1)."""
    bracket = (n + 2) / (n - 1) * bending**2 - 4 * (n + 1) * bending + (3 * n + 2) * (n - 1) + n**3 / (n - 1)
    return bracket / (8 * 100**3 * n * (n - 1))
