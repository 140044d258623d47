"""Hard cases of lenses that are not centred or not of revolution. Truth: closed forms."""

from __future__ import annotations

import numpy as np
import pytest
import realcam as rc
from frame_scene import frame_scene

from ...measurement import hold_core

SECTION = "Surfaces"
STOP = rc.Surface(type="stop", clear_semi_diameter_mm=100)


def lens_of(*surfaces: rc.Surface) -> rc.Lens:
    return rc.Lens(surfaces=[STOP, *surfaces], film_distance_mm=1, allow_overlap=True)


def bundle(half_width: float, half_slope: float, count: int = 500) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(1)
    origins = np.column_stack([rng.uniform(-half_width, half_width, (count, 2)), np.full(count, -5.0)])
    directions = np.column_stack([rng.uniform(-half_slope, half_slope, (count, 2)), np.ones(count)])
    return origins, directions / np.linalg.norm(directions, axis=1, keepdims=True)


@pytest.mark.parametrize("wedge_deg", [1e-6, 1.0, 20.0])
def test_a_prism_whose_faces_touch(wedge_deg):
    """Two planes with one vertex, the second one turned: the deviation of a prism."""
    n, angle = 1.5, np.deg2rad(wedge_deg)
    lens = lens_of(
        rc.Surface(clear_semi_diameter_mm=50, material=n),
        rc.Surface(clear_semi_diameter_mm=50, tilt_deg=(wedge_deg, 0, 0), returns=True),
    )
    slopes = np.linspace(-0.2, 0.2, 41)
    # The side on which the second face lies behind the first: y < 0 for a rotation about x that moves its upper half
    # forwards.
    side = 1.0 if lens.surfaces[2].tilt_deg[0] < 0 else -1.0
    directions = np.column_stack([np.zeros(41), np.sin(slopes), np.cos(slopes)])
    origins = np.tile([0, side * 10.0, 0], (41, 1)) - 5 * directions
    traced = lens.trace(origins, directions, start="scene")
    passed = traced.status == rc.RayStatus.OK
    assert passed.all()
    # Angles from the z axis towards y; the second normal is turned by -angle there.
    inside = np.arcsin(np.sin(slopes) / n)
    out = np.arcsin(n * np.sin(inside + angle)) - angle
    found = np.arctan2(traced.directions[:, 1], traced.directions[:, 2])
    # Two refractions and the arc sines of the reference: a dozen roundings of directions.
    worst = np.abs(found - out).max() / np.finfo(float).eps
    hold_core(SECTION, f"prism of {wedge_deg:g} degrees whose faces touch: angle", "41 rays", worst, 16, "ulp")


@pytest.mark.parametrize(
    ("radius", "radius_x"),
    [(20.0, 20.0 + 1e-9), (20.0, 20.0 - 1e-9), (20.0, 1e-2), (1e9, 11.0), (11.0, 1e9), (-15.0, 12.0)],
)
def test_toroids_near_spheres_cylinders_and_points(radius, radius_x):
    """Points of the surface obey the equation of the torus."""
    rim = min(10.0, 0.5 * abs(radius_x), 0.5 * abs(radius))
    toroid = rc.Surface(
        form="toroid", radius_of_curvature_mm=radius, radius_of_curvature_x_mm=radius_x, clear_semi_diameter_mm=rim
    )
    lens = lens_of(toroid.replace(material=1.5))
    traced = lens.trace(*bundle(0.8 * rim, 0.002 * rim), start="scene")
    passed = traced.status == rc.RayStatus.OK
    assert passed.sum() > 200
    x, y, z = traced.origins_mm[passed].T
    # The torus is its yz section, a circle through the vertex, rotated about the line at distance radius_x. `section`
    # is the sag of that circle at a point's distance from the line, written so that a huge distance costs no digits.
    side = np.sign(radius_x)
    section = z - side * x**2 / (np.hypot(x, radius_x - z) + side * (radius_x - z))
    off = section - (y**2 + section**2) / (2 * radius)
    # The intersection search ends at a step of the size of the point's rounding, as for aspheres.
    worst = np.abs(off).max() / rim / np.finfo(float).eps
    tried = f"{passed.sum()} rays"
    hold_core(
        SECTION, f"toroid of {radius:g} and {radius_x:.10g} mm: off the surface", tried, worst, 16, "ulp of the rim"
    )


def test_film_turned_away():
    """Behind a lens that turns its back on the film no light reaches it, and the refusal is one line."""
    lens = rc.Lens.load("double-gauss-50mm")
    film, scene = rc.Film(36, 24, (8, 6)), frame_scene(spheres=1, boxes=1, rows=8)
    # Across the film, some very oblique light still passes.
    oblique = rc.render(scene, rc.Camera(lens.tilted(x_deg=90), film=film), spp=1)
    assert np.isfinite(oblique.developed()).all()
    for tilt in (91.0, 120.0):
        turned = lens.tilted(x_deg=tilt)
        assert (turned.trace(*bundle(10, 0.1), start="scene").status != rc.RayStatus.OK).all()
        with pytest.raises(rc.InputError, match="no light passes lens") as caught:
            rc.render(scene, rc.Camera(turned, film=film), spp=1)
        assert "\n" not in str(caught.value)
