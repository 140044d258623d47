"""Pictures are traced in float32: what that costs with each bundled lens, against the same lens in float64."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
import realcam as rc

from ..float32_error import BEYOND_UM, IMAGE_RADIUS_MM, LIMIT_UM, Rays, image_point_errors, rays_over_film_and_pupil
from ..measurement import Measurement, hold
from ..ray_decisions import EDGE_LIMIT, SHARE_LIMIT, decided_otherwise, distance_to_edge, rays_at_edges


def half_ball() -> rc.Lens:
    """Loses rays at a critical angle, where the pupils of the bundled lenses end at rims."""
    surfaces = [
        rc.Surface(radius_of_curvature_mm=10.0, thickness_mm=9.0, material=1.6, clear_semi_diameter_mm=9.9),
        rc.Surface(clear_semi_diameter_mm=40.0),
        rc.Stop(clear_semi_diameter_mm=50.0),
    ]
    return rc.Lens(surfaces=surfaces, name="a half ball", film_distance_mm=8.0, film_mm=(4.0, 3.0))


@dataclass(frozen=True)
class Sampled:
    lens: rc.Lens
    rays: Rays


@pytest.fixture(scope="module", params=rc.lens_names())
def sampled(request: pytest.FixtureRequest) -> Sampled:
    lens = rc.Lens.load(request.param)
    return Sampled(lens, rays_over_film_and_pupil(lens))


def hold_figure(what: str, tried: str, worst: float, limit: float, unit: str) -> None:
    hold(Measurement("Bundled lenses", what, tried, "Embree", "float32", float(worst), limit, unit))


def test_image_points(sampled: Sampled) -> None:
    errors = image_point_errors(sampled.lens, sampled.rays)
    assert errors.film_radius_mm.max() > 0.99 * 0.5 * min(sampled.lens.film_mm)
    assert errors.stop_height.max() > 0.99
    assert errors.lost <= SHARE_LIMIT * len(errors.error_um)
    name = sampled.lens.name
    inside = errors.film_radius_mm <= IMAGE_RADIUS_MM.get(name, np.inf)
    tried = f"{inside.sum():,} rays over film and pupil"
    hold_figure(f"image points of {name}", tried, errors.error_um[inside].max(), LIMIT_UM, "µm")
    if not inside.all():
        tried = f"{(~inside).sum():,} rays over film and pupil"
        hold_figure(f"{name}, beyond its image circle", tried, errors.error_um[~inside].max(), BEYOND_UM, "µm")


def test_passed_or_blocked(sampled: Sampled) -> None:
    otherwise = decided_otherwise(sampled.lens, sampled.rays)
    tried = f"{len(otherwise):,} rays over film and pupil of each lens"
    hold_figure("rays that float64 decides otherwise", tried, otherwise.mean(), SHARE_LIMIT, "of all rays")
    if otherwise.any():
        distance = distance_to_edge(sampled.lens, sampled.rays[otherwise])
        assert distance.max() <= EDGE_LIMIT, (sampled.lens.name, distance.max())


@pytest.mark.parametrize("lens", [*map(rc.Lens.load, rc.lens_names()), half_ball()], ids=lambda lens: lens.name)
def test_only_rays_at_an_edge_are_decided_otherwise(lens: rc.Lens) -> None:
    rays = rays_at_edges(lens)
    distance = distance_to_edge(lens, rays[decided_otherwise(lens, rays)])
    # So near to the edges some are: else these rays were not at edges.
    assert len(distance) > 10
    tried = f"{len(rays.directions):,} rays within 0.001 of an edge, of each lens"
    hold_figure(
        "distance from an edge of rays that float64 decides otherwise", tried, distance.max(), EDGE_LIMIT, "relative"
    )
