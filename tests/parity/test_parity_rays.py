"""Both backends make and trace the same rays, ray by ray."""

from __future__ import annotations

import numpy as np
import pytest
import realcam as rc

from ..centred_lenses import CENTRED
from ..float32_error import IMAGE_RADIUS_MM, rays_over_film_and_pupil
from ..measurement import Measurement, hold

pytestmark = [
    pytest.mark.gpu,
    pytest.mark.skipif(
        not any(device.name.startswith("cuda:") for device in rc.devices()),
        reason=f"no GPU: {rc.devices()} is all there is",
    ),
]

ULP = 2.0**-23
LIMIT_ULP = 4.0  # of the ideal models, a handful of operations
# The pupil's table has edges, as rims have: beside one of them a rounding decides which ray is taken.
ASTRAY_SHARE = 1e-4
# Thousands of roundings; grazing rays and fisheyes make ten times as much of each as others.
DOUBLE = 1e-12


def held(what: str, tried: str, number_type: str, worst: float, limit: float, unit: str) -> None:
    hold(Measurement("Parity", what, tried, "CUDA", number_type, float(worst), limit, unit))


def magnification(lens: rc.Lens, origins_mm: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, ...]:
    """Factors (at least 1) by which the lens magnifies a small change at the film, for rays that have left the lens:
    change of their origins, in units of the film position, and of their directions, per change of the film point (in
    units of the film position) or of the direction there.

    Also returns the rays' film radii (mm), and which rays could be traced back to the film and out again."""
    film = lens.film_position_mm
    back = lens.trace(origins_mm, -directions, start="scene")
    ways = -back.directions
    with np.errstate(divide="ignore", invalid="ignore"):
        points = back.origins_mm + ways * ((film - back.origins_mm[:, 2:]) / ways[:, 2:])
    followed = (back.status == rc.RayStatus.OK) & np.isfinite(points).all(axis=1)
    points[~followed], ways[~followed] = (0, 0, film), (0, 0, -1)
    base = lens.trace(points, ways)
    followed &= base.status == rc.RayStatus.OK
    of_origin, of_direction = np.ones(len(points)), np.ones(len(points))
    step = 1e-5
    for change in step * np.eye(3):
        for near in (lens.trace(points + film * change, ways), lens.trace(points, ways + change)):
            passed = near.status == rc.RayStatus.OK
            moved = np.abs(near.origins_mm - base.origins_mm).max(axis=1) / (step * film)
            turned = np.abs(near.directions - base.directions).max(axis=1) / step
            of_origin = np.maximum(of_origin, np.where(passed, moved, 1))
            of_direction = np.maximum(of_direction, np.where(passed, turned, 1))
    return of_origin, of_direction, np.hypot(points[:, 0], points[:, 1]), followed


@pytest.mark.parametrize("name", CENTRED)
def test_generated_rays(name: str) -> None:
    """Errors are relative to the film's distance for origins and to 1 for directions, times the lens's magnification of
    small changes: a rounding at its last surfaces leaves a fisheye as a change of direction fourteen times as large."""
    lens = rc.Lens.load(name)
    camera = rc.Camera(lens, film=rc.Film(*lens.film_mm, (96, 64)))
    cpu, gpu = camera.generate_rays(spp=16, seed=5), camera.generate_rays(spp=16, seed=5, device="cuda")
    np.testing.assert_array_equal(gpu.pixels.numpy(), cpu.pixels)
    origins, directions, weights = gpu.origins_m.numpy(), gpu.directions.numpy(), gpu.weights.numpy()
    both = (cpu.weights > 0) & (weights > 0)
    close = np.zeros(len(both), bool)
    close[both] = np.abs(weights[both] / cpu.weights[both] - 1) < 1e-4
    tried = f"{len(both):,} rays of each lens"
    lit = (cpu.weights > 0) | (weights > 0)
    held("rays that take another way through the pupil", tried, "float32", (lit & ~close).mean(), ASTRAY_SHARE, "rays")

    film = lens.film_position_mm
    in_lens = 1000 * cpu.origins_m[close] + (0, 0, film)
    ways = cpu.directions[close].astype(float)
    of_origin, of_direction, film_radius, followed = magnification(lens, in_lens, ways)
    assert followed.mean() > 0.999
    used = followed & (film_radius <= IMAGE_RADIUS_MM.get(name, np.inf))
    assert used.mean() > 0.4
    moved = 1000 * np.abs(origins - cpu.origins_m)[close].max(axis=1) / (of_origin * film * ULP)
    turned = np.abs(directions.astype(float) - cpu.directions)[close].max(axis=1) / (of_direction * ULP)
    # Each refraction, and the film point before them, rounds by up to half an ulp here and half an ulp there.
    limit = 1.0 + sum(surface.type in ("refracting", "mirror") for surface in lens.surfaces)
    held(f"origins of camera rays, {name}", tried, "float32", moved[used].max(), limit, "ulp of scale")
    held(f"directions of camera rays, {name}", tried, "float32", turned[used].max(), limit, "ulp of scale")


@pytest.mark.parametrize("model", ["pinhole", "thin", "thick"])
def test_generated_rays_of_ideal_models(model: str) -> None:
    for name in CENTRED:
        lens = rc.Lens.load(name)
        camera = rc.Camera(lens, film=rc.Film(*lens.film_mm, (96, 64)), model=model)
        cpu, gpu = camera.generate_rays(spp=16, seed=5), camera.generate_rays(spp=16, seed=5, device="cuda")
        scale = lens.film_position_mm / 1000
        moved = np.abs(gpu.origins_m.numpy() - cpu.origins_m).max() / (scale * ULP)
        turned = np.abs(gpu.directions.numpy().astype(float) - cpu.directions).max() / ULP
        tried = f"{len(cpu.weights):,} rays of each lens"
        held(f"origins of camera rays, {model}", tried, "float32", moved, LIMIT_ULP, "ulp of film distance")
        held(f"directions of camera rays, {model}", tried, "float32", turned, LIMIT_ULP, "ulp of 1")
        weights = gpu.weights.numpy()
        # A fourth power of a cosine, and ten roundings before it.
        held(
            f"weights of camera rays, {model}",
            tried,
            "float32",
            np.abs(weights / cpu.weights - 1).max() / ULP,
            16,
            "ulp",
        )


@pytest.mark.parametrize("name", CENTRED)
def test_traced_rays(name: str) -> None:
    lens = rc.Lens.load(name)
    rays = rays_over_film_and_pupil(lens)
    origins, directions = rays.origins_mm, rays.directions
    tried = f"{len(origins):,} rays of each lens"
    for start, direction in (("film", "to the scene"), ("scene", "back")):
        cpu = lens.trace(origins, directions, start=start)
        gpu = lens.trace(origins, directions, start=start, device="cuda")
        np.testing.assert_array_equal(gpu.status, cpu.status)
        np.testing.assert_array_equal(gpu.surface_index, cpu.surface_index)
        ok = cpu.status == rc.RayStatus.OK
        assert ok.mean() > 0.3
        place = np.abs(gpu.origins_mm - cpu.origins_mm)[ok].max() / lens.film_position_mm
        turn = np.abs(gpu.directions - cpu.directions)[ok].max()
        path = np.abs(gpu.optical_path_mm / cpu.optical_path_mm - 1)[ok].max()
        for what, worst in (("places", place), ("directions", turn), ("optical paths", path)):
            held(f"{what} of traced rays {direction}", tried, "float64", worst, DOUBLE, "relative")
        origins, directions = cpu.origins_mm[ok] + cpu.directions[ok], -cpu.directions[ok]
