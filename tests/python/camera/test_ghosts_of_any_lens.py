"""Ghosts and film reflections through lenses that are not of revolution, against sums over rays and centred lenses."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
import realcam as rc

from .. import scenes
from ..lens.test_first_order_of_any_lens import anamorphic
from ..lens.test_unusual_lenses import UNUSUAL
from .test_ghost_pictures import FILM, SequentialTrace, far_lamp, ghosts, ghosts_of_boards

INDEX = 1.6


def singlet(*, tilt_deg: float = 0.0, stop_mm: float = 4.0) -> rc.Lens:
    """A cylinder with its power in the xz plane, and a sphere that is turned about x: one ghost of two bare faces."""
    surfaces = [
        rc.Stop(clear_semi_diameter_mm=stop_mm, thickness_mm=0),
        rc.Surface(
            form="toroid", radius_of_curvature_x_mm=60, thickness_mm=6, material=INDEX, clear_semi_diameter_mm=15
        ),
        rc.Surface(radius_of_curvature_mm=-80, clear_semi_diameter_mm=15, tilt_deg=(tilt_deg, 0, 0), returns=True),
    ]
    return rc.Lens(surfaces=surfaces, film_distance_mm=60.0).with_coating("bare")


def on_film(
    trace: SequentialTrace, pair: tuple[int, int], tangents: tuple[float, float], grid: int = 512
) -> np.ndarray:
    """(24, 24): lux mm^2 of a lamp of 1 lux on squares of the picture of FILM, by rays through the stop in front."""
    d = np.array([-tangents[0], -tangents[1], 1.0])
    d /= np.linalg.norm(d)
    edge = ((np.arange(grid) + 0.5) / grid * 2 - 1) * trace.stop_mm
    x, y = (a.ravel() for a in np.meshgrid(edge, edge))
    start = np.stack([x, y, np.zeros(grid * grid)], axis=1)[np.hypot(x, y) <= trace.stop_mm]
    place, share = trace.to_film(start, np.broadcast_to(d, start.shape), trace.path_of(*pair))
    bins = np.linspace(-12, 12, 25)
    # The picture is turned.
    light, _, _ = np.histogram2d(place[:, 1], -place[:, 0], bins=(bins, bins), weights=share)
    return light * (2 * trace.stop_mm / grid) ** 2 * d[2]


def squares_of(picture: np.ndarray) -> np.ndarray:
    """(24, 24): lux mm^2."""
    return picture.mean(axis=2).reshape(24, 4, 24, 4).mean(axis=(1, 3))


@pytest.mark.parametrize(
    ("tangents", "pairs", "effect", "spp"),
    [
        *((tangents, [(2, 1)], "ghosts=0", 128) for tangents in ((0.0, 0.0), (0.08, -0.05), (-0.2, 0.1))),
        ((0.05, 0.03), [(3, 1), (3, 2)], "film_reflection=0.2", 512),  # the film is the third surface
    ],
)
def test_the_ghosts_of_a_cylinder_and_a_tilted_face_are_those_of_an_independent_sum(
    tangents: tuple[float, float], pairs: list[tuple[int, int]], effect: str, spp: int
) -> None:
    lens = singlet(tilt_deg=1.5)
    camera = rc.Camera(lens, film=FILM, exposure_time_s=1)
    found = squares_of(ghosts(far_lamp(*tangents), camera, spp=spp, effect=effect))
    trace = SequentialTrace(lens, 0.2, math.hypot(12, 12))
    expected = np.sum([on_film(trace, pair, tangents) for pair in pairs], axis=0)
    assert expected.sum() > 0.001
    assert found.sum() == pytest.approx(expected.sum(), rel=0.01 if effect == "ghosts=0" else 0.02)
    if effect == "ghosts=0":
        # Ghosts are smoothed by a pixel, which a square of four by four hardly shows but at the edges.
        assert np.abs(found - expected).sum() < 0.1 * expected.sum()


@pytest.mark.parametrize("effect", ["ghosts=0", "film_reflection=0.1"])
def test_ghosts_go_over_into_those_of_a_lens_of_revolution(effect: str) -> None:
    """Tilted by so little that no ghost changes: found by other tables and kernels, they bring the same light."""
    lens = rc.Lens.load("double-gauss-50mm").with_coating("bare").focused(5.0)
    nearly = lens.with_element_tilted(2, 3, x_deg=1e-7)
    scene = far_lamp(0.15, 0.1)
    there, here = (
        ghosts(scene, rc.Camera(one, film=FILM, exposure_time_s=1), spp=256, effect=effect) for one in (lens, nearly)
    )
    assert here.sum() == pytest.approx(there.sum(), rel=0.01)
    assert np.abs(squares_of(here) - squares_of(there)).sum() < 0.05 * squares_of(there).sum()


def test_an_anamorphic_lens_that_is_turned_turns_its_ghosts() -> None:
    """By 90 degrees: what was along x is along y. The ghosts are streaks, not discs."""
    lens = anamorphic().with_coating("bare")
    turned = rc.Lens(
        surfaces=[
            s.replace(tilt_deg=(0, 0, 90), returns=True) if s.form == "toroid" else s for s in anamorphic().surfaces
        ],
        film_distance_mm=lens.film_distance_mm,
    ).with_coating("bare")
    upright = ghosts(far_lamp(0.1, 0.04), rc.Camera(lens, film=FILM, exposure_time_s=1), spp=64)
    across = ghosts(far_lamp(-0.04, 0.1), rc.Camera(turned, film=FILM, exposure_time_s=1), spp=64)
    quarter = squares_of(np.rot90(upright))
    assert across.sum() == pytest.approx(upright.sum(), rel=0.03)
    assert np.abs(squares_of(across) - quarter).sum() < 0.1 * quarter.sum()


@pytest.mark.parametrize("film_radius_mm", [-150, -22])
def test_what_reflects_light_has_the_ghosts_of_what_emits_it(film_radius_mm: float) -> None:
    """Those are traced from the film, these from the light. The film is tilted and curved, at most by 50 degrees."""
    lens = singlet(tilt_deg=1.5, stop_mm=6.0).tilted(x_deg=2, y_deg=-1).with_film_radius(film_radius_mm)
    camera = rc.Camera(lens, film=FILM, exposure_time_s=1)
    emitted, reflected = ghosts_of_boards(camera, (0.1, 0.1, -3.0), 256, set())
    assert emitted.sum() > 0
    assert reflected.sum() == pytest.approx(emitted.sum(), rel=0.02)


@pytest.mark.parametrize("name", UNUSUAL)
@pytest.mark.slow
def test_lamps_anywhere_give_numbers(name: str) -> None:
    lens = rc.Lens.load(name)
    if any(surface.type == "refracting" for surface in lens.surfaces):
        lens = lens.with_coating("bare")
    camera = rc.Camera(lens, film=rc.Film(*lens.film_mm, (30, 20)), exposure_time_s=1)
    # Without those that bring less than 1e-4 of the lens's light: of a lens of many faces the others take long to find.
    light = ghosts(far_lamp(0.1, 0.05), camera, spp=4, effect="ghosts=1e-4")
    assert np.isfinite(light).all()
    assert (light >= 0).all()


def out_of_focus() -> tuple[rc.Camera, np.ndarray]:
    """Through an anamorphic lens with a tilted, curved film; and where a lamp is."""
    lens = anamorphic().tilted(x_deg=2).with_film_radius(-200)
    return rc.Camera(lens, film=FILM, exposure_time_s=1), np.array([0.02, 0.03, -0.8])


def steep() -> tuple[rc.Camera, np.ndarray]:
    """The normal of the film is turned by 42 to 49 degrees from the axis. Samples of pixels know the irradiance of the
    tangent plane, which another test has from the lens's pupil."""
    lens = rc.Lens.load("double-gauss-50mm").stopped_down(4).focused(0.6).with_film_radius(-22)
    camera = rc.Camera(lens, film=rc.Film(3, 3, (12, 12), shift_mm=(-13, -8)), exposure_time_s=1)
    (origin,), (direction,) = camera.ray([[6.0, 6.0]])
    return camera, origin + 2.0 * direction


@pytest.mark.parametrize(("what", "spp"), [(out_of_focus, 256), (steep, 2048)])
def test_lamps_are_traced_from_their_own_side_too(what: Callable[[], tuple[rc.Camera, np.ndarray]], spp: int) -> None:
    """Samples from a lamp and samples of pixels bring the same light to the same points."""
    camera, place = what()
    scene = scenes.scene_of(scenes.quad(place, 0.02, emission=1.0))
    common = {"effects": (), "spp": spp, "max_bounces": 0, "device": "cpu"}
    by_pixels, by_lamp = (
        rc.render(scene, camera, light_tracing=how, **common).pixels.astype(float) for how in ("off", "alone")
    )
    assert by_pixels.sum() > 0
    assert by_lamp.sum() == pytest.approx(by_pixels.sum(), rel=0.02)
    if what is out_of_focus:
        assert np.abs(squares_of(by_lamp) - squares_of(by_pixels)).sum() < 0.1 * squares_of(by_pixels).sum()
