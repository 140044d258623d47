"""Dual pixels: both halves of the pupil in one pass, against rays; and the autofocus that lives of them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import realcam as rc

from .. import scenes

HALVES = ("dual_pixel_left", "dual_pixel_right")
FOCUS_M = 1.0


def camera(model: str = "full", focus_m: float = FOCUS_M, film: rc.Film | None = None) -> rc.Camera:
    """On the z axis, with its film at 0, looking along -z."""
    lens = rc.Lens.load("double-gauss-50mm").stopped_down(2.8).focused(focus_m)
    return rc.Camera(lens, film=film or rc.Film(4, 3, (64, 48)), exposure_time_s=0.01, model=model)


def lamp(distance_m: float) -> rc.Scene:
    """A square that shines, on the axis; its image is about 0.7 mm wide."""
    return scenes.scene_of(scenes.quad((0, 0, -distance_m), 0.007 * distance_m, emission=1000))


def photograph(scene: rc.Scene, seen_by: rc.Camera, **changes: Any) -> rc.Image:
    expected = {"spp": 64, "effects": (), "layers": HALVES, "max_bounces": 0, "device": "cpu"}
    return rc.render(scene, seen_by, **(expected | changes))


def column_of(light: np.ndarray) -> float:
    """Centroid."""
    over_columns = light.sum(axis=(0, 2), dtype=float)
    return float(over_columns @ (np.arange(len(over_columns)) + 0.5) / over_columns.sum())


def disparity_mm(image: rc.Image) -> float:
    left, right = (column_of(image.layers[name]) for name in HALVES)
    return (right - left) * image.camera.film.width_mm / image.camera.film.resolution[0]


def disparity_of_rays_mm(lens: rc.Lens, distance_m: float) -> float:
    """Disparity of rays from a point on the axis, traced in double, sorted by where they cross the exit pupil."""
    data = lens.first_order()
    source_z = lens.film_position_mm - 1000 * distance_m
    # Points all over the entrance pupil. They receive the same light from the point but for the cosines, 1e-3.
    side = np.linspace(-0.55, 0.55, 201) * data.entrance_pupil_diameter_mm
    x, y = (values.ravel() for values in np.meshgrid(side, side))
    to_pupil = np.stack([x, y, np.full_like(x, data.entrance_pupil_position_mm - source_z)], axis=1)
    directions = to_pupil / np.linalg.norm(to_pupil, axis=1, keepdims=True)
    origins = np.broadcast_to((0, 0, source_z), directions.shape)
    out = lens.trace(origins, directions, start="scene")
    passed = out.status == rc.RayStatus.OK
    last, slope = out.origins_mm[passed], (out.directions[:, 0] / out.directions[:, 2])[passed]
    at_pupil, at_film = (
        last[:, 0] + (z - last[:, 2]) * slope for z in (data.exit_pupil_position_mm, lens.film_position_mm)
    )
    # The picture's columns go against x of the lens, because the image is upside down.
    return float(at_film[at_pupil < 0].mean() - at_film[at_pupil > 0].mean())


@pytest.mark.parametrize("distance_m", [0.7, 2.5])
def test_disparity_over_defocus_is_that_of_ray_centroids(distance_m: float, device: str) -> None:
    seen_by = camera()
    expected = disparity_of_rays_mm(seen_by.lens, distance_m)
    # For an object beyond the focus distance, the image in the layer dual_pixel_right lies further to the right.
    assert (expected > 0) == (distance_m > FOCUS_M)
    found = disparity_mm(photograph(lamp(distance_m), seen_by, spp=256, device=device))
    # 1e5 samples, of an image some tenths of a millimetre wide, leave 1e-3 mm or less of 0.2 mm.
    assert found == pytest.approx(expected, rel=0.02)


@pytest.mark.parametrize("model", ["thin", "thick", "mapped", "polynomial", "full_double"])
def test_all_models_of_a_camera_have_halves(model: str) -> None:
    scene = lamp(2.5)
    full, other = (disparity_mm(photograph(scene, camera(each))) for each in ("full", model))
    # A thin lens has the blur of first-order optics: 5% of spherical aberration and noise.
    assert other == pytest.approx(full, rel=0.05)


@pytest.mark.parametrize("effects", [(), ("coatings",), ("diffraction",), ("dispersion", "ghosts")])
def test_left_and_right_are_the_whole(effects: tuple[str, ...], device: str) -> None:
    scene, seen_by = lamp(2.5), camera()
    image = photograph(scene, seen_by, effects=effects, device=device)
    left, right = (image.layers[name].astype(float) for name in HALVES)
    assert left + right == pytest.approx(image.pixels.astype(float), rel=1e-6)
    # A quarter of the samples of the test above. Dispersion shifts colours by different amounts, which blurs little.
    assert disparity_mm(image) == pytest.approx(disparity_of_rays_mm(seen_by.lens, 2.5), rel=0.05)
    # The picture equals that with another layer for which dispersion shares no samples among pixels.
    without = photograph(scene, seen_by, effects=effects, layers=("variance",), light_tracing="off", device=device)
    if device == "cpu":
        assert np.array_equal(image.pixels, without.pixels)
    else:  # another kernel, whose roundings may send single samples elsewhere
        assert np.abs(image.pixels - without.pixels).sum() < 1e-3 * without.pixels.sum()


def test_where_rims_cut_the_pupil_one_half_has_less_light_and_the_other_side_mirrors_it(device: str) -> None:
    lens = rc.Lens.load("double-gauss-50mm")
    seen_by = rc.Camera(lens, film=rc.Film(36, 2, (36, 2)), exposure_time_s=0.01)
    image = photograph(scenes.sky(100), seen_by, spp=1024, device=device)
    left, right = (image.layers[name].sum(axis=(0, 2)) for name in HALVES)
    share = left / (left + right)
    # 2048 samples of each column, evenly spread: half a percent.
    assert share == pytest.approx(1 - share[::-1], abs=0.01)
    assert share[18] == pytest.approx(0.5, abs=0.01)
    assert abs(share[0] - 0.5) > 0.03
    # The left side of the picture lies on the right side of the film. Seen from there, the rim of the front, which is
    # far from the film, is shifted to the right over the exit pupil, and cuts its left part.
    assert share[0] < 0.5 < share[-1]


def test_parts_of_a_film_have_halves() -> None:
    scene, seen_by = lamp(2.5), camera(film=rc.Film(4, 3, (16, 12)))
    session = rc.Session(scene, seen_by, effects=(), layers=HALVES, max_bounces=0, device="cpu")
    session.add(300)
    image = session.image()
    parts = [session.expose((0, 0, 16, 12), first, count) for first, count in ((0, 256), (256, 44))]
    summed = session.image_of(parts)
    for name in HALVES:
        assert np.array_equal(summed.layers[name], image.layers[name])


def test_halves_that_are_asked_for_later_begin_a_picture() -> None:
    session = rc.Session(lamp(2.5), camera(), effects=(), max_bounces=0, device="cpu")
    session.add(2)
    session.set(settings=session.settings.with_(layers=HALVES))
    assert session.samples.max() == 0
    session.add(2)
    assert session.image().layers[HALVES[0]].any()


@pytest.mark.parametrize(
    ("changes", "model", "message"),
    [
        ({"layers": (*HALVES, "variance")}, "full", "variance and dual-pixel halves exclude each other"),
        ({"light_tracing": "alone"}, "full", "light_tracing must not be alone"),
        ({"pupil_sampling": "pixel"}, "full", "pixel excludes the layers of dual-pixel halves"),
        ({}, "pinhole", "a pinhole has no dual-pixel halves"),
    ],
)
def test_what_has_no_halves_says_so(changes: dict[str, Any], model: str, message: str) -> None:
    with pytest.raises(rc.InputError, match=message):
        photograph(lamp(2.5), camera(model), **changes)


def wall(distance_m: float, period_m: float = 0.02) -> rc.Scene:
    """Upright stripes, white and black, before the camera."""
    edges = np.arange(-0.5, 0.5, period_m)
    # The stripes are not periodic; otherwise a match one period off would be equally good.
    halves = period_m * (0.15 + 0.2 * (np.arange(len(edges)) * 7 % 11) / 11)
    stripes = [scenes.quad((x + w, 0, -distance_m), w, 1, emission=500) for x, w in zip(edges, halves, strict=True)]
    return scenes.scene_of(*stripes)


@pytest.mark.parametrize(("distance_m", "from_m"), [(3.0, 1.5), (0.9, 4.0), (2.0, np.inf)])
def test_autofocus_finds_the_wall(distance_m: float, from_m: float, device: str) -> None:
    seen_by = camera(focus_m=from_m, film=rc.Film(6, 2, (192, 64)))
    found = rc.autofocus(wall(distance_m), seen_by, window_px=(96, 16), device=device)
    assert abs(found.disparities_px[-1]) <= 0.1 < abs(found.disparities_px[0])
    assert (found.disparities_px[0] > 0) == (distance_m > from_m)
    # A tenth of a pixel is 0.003 mm: halves of f/2.8 meet within 0.02 mm of the film, which is 0.02 mm d^2 / f^2 at the
    # object. As much again because pictures match where most of their light is, not at their centroids; and 2 mm.
    depth_m = 2 * 0.02e-3 * (distance_m / 0.05) ** 2 + 0.002
    assert found.camera.lens.focus_distance_m == pytest.approx(distance_m, abs=depth_m)
    assert len(found.disparities_px) <= 6
    assert found.focus_distances_m[-1] == found.camera.lens.focus_distance_m


def test_autofocus_without_contrast_says_so() -> None:
    with pytest.raises(rc.InputError, match="too little contrast"):
        rc.autofocus(scenes.sky(100), camera(), device="cpu")


def test_autofocus_on_what_is_too_near_says_so() -> None:
    lens = rc.Lens.load("macro-105mm").stopped_down(8)
    assert lens.nearest_focus_m == 0.41
    near = camera(film=rc.Film(6, 2, (192, 64))).replace(lens=lens.focused(0.45))
    with pytest.raises(rc.InputError, match=r"cannot be brought into focus: at 0.41 m"):
        rc.autofocus(wall(0.385, 0.01), near, window_px=(128, 16), device="cpu")
