"""Pictures are traced in float32: what that costs with each bundled lens, against the same lens in float64."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest
import realcam as rc

from ..centred_lenses import CENTRED
from ..float32_error import BEYOND_UM, IMAGE_RADIUS_MM, Rays, image_point_errors, limit_um, rays_over_film_and_pupil
from ..measurement import Measurement, hold
from ..ray_decisions import EDGE_LIMIT, SHARE_LIMIT, decided_otherwise, distance_to_edge, rays_at_edges
from .backends import BACKENDS


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
    backend: str


@pytest.fixture(scope="module", params=CENTRED)
def rays_of_a_lens(request: pytest.FixtureRequest) -> tuple[rc.Lens, Rays]:
    lens = rc.Lens.load(request.param)
    return lens, rays_over_film_and_pupil(lens)


@pytest.fixture
def sampled(rays_of_a_lens: tuple[rc.Lens, Rays], backend: str) -> Sampled:
    lens, rays = rays_of_a_lens
    return Sampled(lens, replace(rays, **BACKENDS[backend]), backend)


def hold_figure(backend: str, what: str, tried: str, worst: float, limit: float, unit: str) -> None:
    hold(Measurement("Bundled lenses", what, tried, backend, "float32", float(worst), limit, unit))


def test_image_points(sampled: Sampled) -> None:
    errors = image_point_errors(sampled.lens, sampled.rays)
    assert errors.film_radius_mm.max() > 0.99 * 0.5 * min(sampled.lens.film_mm)
    assert errors.stop_height.max() > 0.99
    assert errors.lost <= max(1, SHARE_LIMIT * len(errors.error_um))  # of 1e5 rays, one
    name = sampled.lens.name
    inside = errors.film_radius_mm <= IMAGE_RADIUS_MM.get(name, np.inf)
    tried = f"{inside.sum():,} rays over film and pupil"
    worst = errors.error_um[inside].max()
    hold_figure(sampled.backend, f"image points of {name}", tried, worst, limit_um(sampled.lens), "µm")
    if not inside.all():
        tried = f"{(~inside).sum():,} rays over film and pupil"
        worst = errors.error_um[~inside].max()
        hold_figure(sampled.backend, f"{name}, beyond its image circle", tried, worst, BEYOND_UM, "µm")


def test_passed_or_blocked(sampled: Sampled) -> None:
    otherwise = decided_otherwise(sampled.lens, sampled.rays)
    tried = f"{len(otherwise):,} rays over film and pupil of each lens"
    what = "rays that float64 decides otherwise"
    hold_figure(sampled.backend, what, tried, otherwise.mean(), SHARE_LIMIT, "of all rays")
    if otherwise.any():
        distance = distance_to_edge(sampled.lens, sampled.rays[otherwise])
        assert distance.max() <= EDGE_LIMIT, (sampled.lens.name, distance.max())


@pytest.mark.parametrize("lens", [*map(rc.Lens.load, CENTRED), half_ball()], ids=lambda lens: lens.name)
def test_only_rays_at_an_edge_are_decided_otherwise(lens: rc.Lens, backend: str) -> None:
    rays = replace(rays_at_edges(lens), **BACKENDS[backend])
    distance = distance_to_edge(lens, rays[decided_otherwise(lens, rays)])
    # So near to the edges some are: else these rays were not at edges.
    assert len(distance) > 5
    tried = f"{len(rays.directions):,} rays within 0.001 of an edge, of each lens"
    what = "distance from an edge of rays that float64 decides otherwise"
    hold_figure(backend, what, tried, distance.max(), EDGE_LIMIT, "relative")
