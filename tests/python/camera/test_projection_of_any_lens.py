"""Camera.project and Camera.ray through lenses that are not of revolution, by rays the other way and by pictures."""

from __future__ import annotations

import math

import numpy as np
import pytest
import realcam as rc

from ..lens.test_first_order_of_any_lens import anamorphic
from ..lens.test_unusual_lenses import chief_ray_scale
from .test_projection import FISHEYE, grid, shown_and_projected

DOUBLE_GAUSS = rc.Lens.load("double-gauss-50mm")


CASES = {
    "anamorphic": rc.Lens.load("anamorphic-65mm"),
    "tilted and shifted": DOUBLE_GAUSS.tilted(x_deg=4, y_deg=-2).shifted(x_mm=1, y_mm=2),
    "an element tilted": DOUBLE_GAUSS.with_element_tilted(2, 3, x_deg=0.3, y_deg=0.2),
    "a curved film": DOUBLE_GAUSS.with_film_radius(-120),
    "a periscope": rc.Lens.load("periscope-50mm"),
}


def camera_of(lens: rc.Lens, **others: object) -> rc.Camera:
    return rc.Camera(lens, film=rc.Film(22, 16, (880, 640)), **others)  # type: ignore[arg-type]


def in_lens(lens: rc.Lens, points_m: np.ndarray) -> np.ndarray:
    """Points in the lens frame, in mm, for a camera with the default pose, whose position is the film centre."""
    return 1000 * points_m + np.asarray(lens.film_frame[3])


def landing(camera: rc.Camera, origins_mm: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """Pixel coordinates at which rays behind the lens hit the film."""
    lens, pixels = camera.lens, np.array(camera.film.resolution)
    axes, vertex = np.asarray(lens.film_frame[:3]), np.asarray(lens.film_frame[3])
    o, d = (origins_mm - vertex) @ axes.T, directions @ axes.T
    c = 1 / lens.film_radius_of_curvature_mm
    # o + t d on the sphere c r^2 = 2 z, on the cap that the light reaches.
    f = c * np.sum(o * o, axis=1) - 2 * o[:, 2]
    g = d[:, 2] - c * np.sum(o * d, axis=1)
    film = (o + (f / (g + np.sqrt(g * g - c * f)))[:, None] * d)[:, :2]
    at: np.ndarray = pixels / 2 + film * [-1, 1] * pixels / (camera.film.width_mm, camera.film.height_mm)
    return at


@pytest.mark.parametrize("what", CASES)
def test_the_chief_ray_of_a_pixel_comes_back_to_it(what: str) -> None:
    """Traced from the scene it goes through the middle of the stop and lands in the pixel."""
    lens = CASES[what]
    camera = camera_of(lens)
    pixels = grid(camera, 9)
    origins, directions = camera.ray(pixels, through="chief")
    points = in_lens(lens, origins + 0.02 * directions)
    wide = lens.trace(points, -directions, start="scene")
    passed = wide.status == 0  # a chief ray may meet a rim
    assert passed.mean() > 0.5
    # Bicubics over cells of a twenty-fourth of the film leave an error of the fourth order.
    error = np.abs(landing(camera, wide.origins_mm, wide.directions) - pixels)[passed].max() / 40
    assert error < 2e-5  # mm
    # A hole of 20 um lets them pass.
    tiny = lens.stopped_down(lens.first_order().effective_focal_length_mm / 0.02)
    assert (tiny.trace(points, -directions, start="scene").status[passed] == 0).all()


@pytest.mark.parametrize("through", ["light", "chief"])
@pytest.mark.parametrize("what", CASES)
def test_a_point_on_a_pixels_ray_shows_in_the_pixel(what: str, through: str) -> None:
    camera = camera_of(CASES[what], position=(3, 1, -2), look_at=(1, 1.5, 4), up=(1, 3, 0))
    pixels = grid(camera)
    origins, directions, light = camera.ray(pixels, through=through, return_light=True)
    lit = ~np.isnan(directions[:, 0])
    assert lit.mean() > 0.8
    assert np.linalg.norm(directions[lit], axis=1) == pytest.approx(1, abs=1e-14)
    assert (light[lit] > 0).all()
    for distance in (1.5, 3.0, 1e4):
        seen, status = camera.project(origins + distance * directions, through=through, return_status=True)
        assert (status[lit] == rc.ProjectionStatus.OK).all()
        # The remaining error is the rounding of coordinates: a relative 1e-16 over a pixel of 2.5e-5 m.
        assert np.abs(seen[lit] - pixels[lit]).max() < 1e-6


def test_lines_go_over_into_those_of_a_lens_of_revolution() -> None:
    nearly = DOUBLE_GAUSS.with_element_tilted(2, 3, x_deg=1e-7)
    there, here = camera_of(DOUBLE_GAUSS), camera_of(nearly)
    pixels = grid(there)
    for through, limit_mm in (("chief", 2e-6), ("light", 1e-3)):
        # The centroid ray changes slope where rims begin to vignette; the coarser table smooths this.
        origins, directions = there.ray(pixels, through=through)
        found = here.project(origins + 5 * directions, through=through)
        assert np.abs(found - pixels).max() / 40 < limit_mm
    assert here.camera_matrix == pytest.approx(there.camera_matrix, abs=1e-4)
    for a, b in zip(here.world_to_camera, there.world_to_camera, strict=True):
        assert a == pytest.approx(b, abs=1e-9)
    assert here.entrance_pupil_position_m == pytest.approx(there.entrance_pupil_position_m, abs=1e-9)


@pytest.mark.parametrize("what", ["anamorphic", "an element tilted", "double-gauss-50mm", "phone-4mm", FISHEYE])
def test_light_has_its_middle_where_it_is_projected(what: str) -> None:
    """Parallel light all over the front, traced to the film: the mean of what arrives, by random rays."""
    lens = (CASES.get(what) or rc.Lens.load(what)).focused(math.inf)
    camera = camera_of(lens)
    if lens.is_rotational:
        camera = camera.replace(film=rc.Film.for_lens(lens, resolution=(960, 640)))
    half = 1.3 * lens.first_order().entrance_pupil_diameter_mm
    # The fisheye sees the second of its pixels behind itself.
    for pixel in ((480.0, 400.0), (480.0, 60.0)) if what == FISHEYE else ((300.0, 420.0), (700.0, 150.0)):
        (origin,), (ahead,) = camera.ray([pixel])
        across = np.cross(ahead, [0, 1, 0])
        across /= np.linalg.norm(across)
        u = half * np.random.default_rng(7).uniform(-1, 1, (100_000, 2))
        places = in_lens(lens, origin) + u @ np.array([across, np.cross(across, ahead)]) + 20 * ahead
        out = lens.trace(places, np.tile(-ahead, (len(places), 1)), start="scene")
        passed = out.status == 0
        assert passed.mean() > 0.02
        assert (np.abs(u[passed]) < 0.98 * half).all()  # the square holds all that passes
        at = landing(camera, out.origins_mm[passed], out.directions[passed])
        # Four deviations of the mean, and what the table may be off.
        limit = 4 * at.std(axis=0) / np.sqrt(len(at)) + (0.01 if lens.is_rotational else 0.03)
        assert (np.abs(at.mean(axis=0) - pixel) < limit).all()


@pytest.mark.parametrize("what", CASES)
def test_a_picture_shows_a_lamp_where_it_is_projected(what: str) -> None:
    lens = CASES[what].focused(2.0) if what != "tilted and shifted" else CASES[what]
    camera = rc.Camera(lens, film=rc.Film(22, 16, (176, 128)), position=(2, -1, 4), look_at=(-1, 0.5, 2), up=(0, 1, 0))
    focus = lens.focus_distance_m if math.isfinite(lens.focus_distance_m) else 50.0
    shown, projected = shown_and_projected(camera, (60.3, 90.7), focus, 128)
    # The centroid of a defocused spot is off by up to 2% of its width; the noise is a fiftieth of a pixel.
    assert shown == pytest.approx(projected, abs=0.15)


def test_the_matrix_of_an_anamorphic_lens_is_that_of_its_two_sections() -> None:
    lens = rc.Lens.load("anamorphic-31mm").stopped_down(16).focused(100.0)
    K = rc.Camera(lens, film=rc.Film(16, 10, (1600, 1000))).camera_matrix
    # By paraxial chief rays, by hand; differences over film points have errors of the fourth order.
    assert K[0, 0] / 100 == pytest.approx(chief_ray_scale(lens, 0), rel=1e-6)
    assert K[1, 1] / 100 == pytest.approx(chief_ray_scale(lens, 1), rel=1e-6)
    assert K[:2, 2] == pytest.approx([800, 500], abs=1e-6)
    assert (K[0, 1], K[1, 0]) == pytest.approx((0, 0), abs=1e-6)


def test_a_shifted_lens_moves_the_principal_point_alone() -> None:
    shifted = camera_of(DOUBLE_GAUSS.shifted(x_mm=2, y_mm=-3))
    plain = camera_of(DOUBLE_GAUSS)
    # To first order about the middle of the film, where the lens now has some distortion: 0.1%.
    assert np.diag(shifted.camera_matrix) == pytest.approx(np.diag(plain.camera_matrix), rel=2e-3)
    # The film shows the axis on its right and lower side, and the picture, which is turned, on its left and upper one.
    moved = shifted.camera_matrix[:2, 2] - plain.camera_matrix[:2, 2]
    assert moved == pytest.approx([-80, -120], rel=2e-3)
    (axis,) = shifted.project([shifted.entrance_pupil_position_m + np.array([0, 0, -1e6])])
    assert axis - [440, 320] == pytest.approx([-80, -120], abs=0.02)
    fit, before = (rc.fit_camera_model(camera, "opencv8") for camera in (shifted, plain))
    assert fit.rms_px < 3 * before.rms_px + 0.01
    assert fit.camera_matrix[:2, 2] - [440, 320] == pytest.approx([-80, -120], abs=1)


def test_an_anamorphic_lens_fits_a_camera_with_two_focal_lengths() -> None:
    fit = rc.fit_camera_model(camera_of(anamorphic().stopped_down(8)), "opencv4")
    across, upright = np.diag(fit.camera_matrix)[:2]
    one, other = anamorphic().meridians()
    assert upright / across == pytest.approx(other.focal_length_mm / one.focal_length_mm, rel=0.02)
    assert fit.rms_px < 2
