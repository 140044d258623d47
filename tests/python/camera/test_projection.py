"""Camera.project and Camera.ray: against each other, closed forms, other ways through the lens, and pictures."""

from __future__ import annotations

import time

import numpy as np
import pytest
import realcam as rc

from ...centred_lenses import CENTRED
from ...measurement import Measurement, hold
from .. import scenes

FISHEYE = "fisheye-6mm-220deg"


def camera_of(name: str, *, model: str = "full", size: tuple[int, int] = (960, 640), **pose: object) -> rc.Camera:
    lens = rc.Lens.load(name)
    return rc.Camera(lens, film=rc.Film.for_lens(lens, resolution=size), model=model, **pose)


def grid(camera: rc.Camera, places: int = 31) -> np.ndarray:
    columns, rows = camera.film.resolution
    x, y = np.meshgrid(np.linspace(1e-3, columns - 1e-3, places), np.linspace(1e-3, rows - 1e-3, places))
    return np.column_stack([x.ravel(), y.ravel()])


def test_a_point_on_a_pixels_ray_shows_in_the_pixel() -> None:
    worst, tried = {"light": 0.0, "chief": 0.0}, 0
    # A table of lines of sight is made for each state of a lens, in up to a second: lenses take turns, and of every
    # fifth both kinds are tried, the other one stopped down.
    for number, name in enumerate([FISHEYE, *CENTRED[::4]]):
        wide_open = rc.Lens.load(name)
        through, other = ("light", "chief") if number % 2 else ("chief", "light")
        states = [(wide_open, through)]
        if number % 5 == 0:
            states.append((wide_open.stopped_down(1.3 * wide_open.first_order().f_number), other))
        for lens, through in states:
            camera = rc.Camera(
                lens, film=rc.Film.for_lens(lens), position=(3, 1, -2), look_at=(1, 1.5, 4), up=(1, 3, 0)
            )
            focus = camera.lens.focus_distance_m
            pixels = grid(camera)
            origins, directions = camera.ray(pixels, through=through)
            lit = ~np.isnan(directions[:, 0])
            assert lit.mean() > 0.3, name  # the fisheye's image is a circle in the film
            assert np.linalg.norm(directions[lit], axis=1) == pytest.approx(1, abs=1e-14)
            for distance in (focus if np.isfinite(focus) else 1e4, 3.0, 100.0):
                seen, status = camera.project(origins + distance * directions, through=through, return_status=True)
                assert (status[lit] == rc.ProjectionStatus.OK).all(), name
                assert (status[~lit] == rc.ProjectionStatus.BAD_INPUT).all()
                worst[through] = max(worst[through], float(np.abs(seen[lit] - pixels[lit]).max()))
                tried += int(lit.sum())
    # The remaining error is the rounding of coordinates in metres: 1e-16 m over a pixel of 1e-6 m or more.
    for through, error in worst.items():
        hold(Measurement("Computer vision", f"`project` of a point on the line of `ray`, through {through}",
                         f"every fourth bundled lens and a fisheye, some stopped down, of {tried} pixels and distances",
                         "core", "float64", error, 1e-6, "pixels"))  # fmt: skip


@pytest.mark.parametrize("name", ["double-gauss-50mm", "tessar-50mm", "phone-4mm", FISHEYE])
def test_chief_rays_are_those_of_the_analysis(name: str) -> None:
    """Lens.spot aims at the middle of the stop from the object's side, by another search."""
    camera = camera_of(name)
    mm_per_pixel = camera.film.width_mm / camera.film.resolution[0]
    widest = 0.45 * camera.field_of_view_deg.horizontal
    for angle in np.linspace(1, widest, 7):
        chief = camera.lens.spot(angle, object_distance_m=np.inf).chief_ray_mm
        radians = np.radians(angle)
        # The point is as far away as the sun, so that its direction is the same from every point of the lens.
        point = 1.5e11 * np.array([np.sin(radians), 0, -np.cos(radians)])
        (pixel,) = camera.project([point], through="chief")
        # The table of lines is interpolated by cubics between 128 radii.
        assert (pixel[0] - 480) * mm_per_pixel == pytest.approx(np.hypot(*chief), abs=2e-4 * mm_per_pixel), angle
        assert pixel[1] == pytest.approx(camera.film.resolution[1] / 2, abs=1e-6)


def shown_and_projected(
    camera: rc.Camera, pixel: tuple[float, float], distance: float, spp: int
) -> tuple[np.ndarray, np.ndarray]:
    """Centroid of the picture of a bright square, two pixels across, that faces the camera where a pixel looks; and the
    mean of what points all over it are projected to."""
    origin, direction = (array[0] for array in camera.ray([pixel]))
    beside = camera.ray([(pixel[0] + 2, pixel[1])])[1][0]
    size = distance * np.linalg.norm(beside - direction)
    right = np.cross(direction, (0.2, 1, 0.1))
    right /= np.linalg.norm(right)
    up = np.cross(right, direction)
    middle = origin + distance * direction
    scene = scenes.scene_of(scenes.quad(middle, size / 2, right=right, up=up, emission=1e4))
    u, v = np.meshgrid(*[(np.arange(9) - 4) / 9] * 2)
    points = middle + size * (u.reshape(-1, 1) * right + v.reshape(-1, 1) * up)
    light = rc.render(scene, camera, spp=spp, effects=(), max_bounces=0, device="cpu").pixels[..., 1].astype(float)
    rows, columns = np.indices(light.shape) + 0.5
    shown = np.array([(columns * light).sum(), (rows * light).sum()]) / light.sum()
    return shown, camera.project(points).mean(axis=0)


SHOTS = {
    "double gauss, in focus": ("double-gauss-50mm", "full", (71.3, 42.8), 1.0),
    "double gauss, the corner, in front of the focus": ("double-gauss-50mm", "full", (20.4, 14.9), 0.9),
    "tessar": ("tessar-50mm", "full", (150.2, 90.1), 1.0),
    "phone": ("phone-4mm", "full", (30.7, 100.3), 1.0),
    "220 degree fisheye": (FISHEYE, "full", (100.6, 18.2), 1.0),
    "220 degree fisheye, behind the camera": (FISHEYE, "full", (96.2, 10.7), 1.0),
    "mirror telephoto": ("mirror-telephoto-500mm", "full", (60.2, 40.5), 1.0),
    "mapped": ("double-gauss-50mm", "mapped", (30.1, 25.7), 1.0),
    "thick": ("double-gauss-50mm", "thick", (160.4, 100.2), 1.0),
    "thin": ("double-gauss-50mm", "thin", (160.4, 100.2), 1.0),
    "pinhole": ("double-gauss-50mm", "pinhole", (30.4, 20.2), 1.3),
    "polynomial": ("double-gauss-50mm", "polynomial", (50.4, 40.2), 1.0),
}


@pytest.mark.parametrize("what", SHOTS)
def test_a_picture_shows_a_lamp_where_it_is_projected(what: str) -> None:
    name, model, pixel, share = SHOTS[what]
    camera = camera_of(name, model=model, size=(192, 128))
    focus = camera.lens.focus_distance_m
    distance = share * (focus if np.isfinite(focus) else 1000 * camera.lens.first_order().effective_focal_length_mm)
    camera = camera.replace(position=(2, -1, 4), look_at=(-1, 0.5, 2), up=(0.3, 1, 0.2))
    shown, projected = shown_and_projected(camera, pixel, distance, 256)
    # Light that changes by a tenth in a pixel, as at the fisheye's edge, moves the middle of a lamp of two pixels by a
    # tenth of its variance, 0.33, and out of focus that of the spot likewise. Noise: of the 1000 samples that meet the
    # lamp some seventy at its edges could as well not, so that it is a sixtieth of a pixel.
    assert shown == pytest.approx(projected, abs=0.06)


@pytest.mark.parametrize("model", ["pinhole", "thin", "thick"])
def test_ideal_cameras_are_the_matrix(model: str) -> None:
    camera = camera_of("double-gauss-50mm", model=model, position=(2, -1, 4), look_at=(-1, 0.5, 2), up=(0.3, 1, 0.2))
    rotation, translation = camera.world_to_camera
    assert rotation @ rotation.T == pytest.approx(np.eye(3), abs=1e-14)
    assert np.linalg.det(rotation) == pytest.approx(1)
    assert -rotation.T @ translation == pytest.approx(camera.entrance_pupil_position_m, abs=1e-14)
    origins, directions = camera.ray(grid(camera))
    points = origins + np.linspace(0.5, 50, len(origins))[:, None] * directions
    homogeneous = (camera.camera_matrix @ (rotation @ points.T + translation[:, None])).T
    # The thick lens's matrix is float32: 1e-7 of 480 pixels.
    limit = 1e-3 if model == "thick" else 1e-7
    assert camera.project(points) == pytest.approx(homogeneous[:, :2] / homogeneous[:, 2:], abs=limit)
    assert camera.camera_matrix[:, 2].tolist() == [480, 320, 1]
    if model == "thick":  # its film is the real one's, which lies beside the paraxial focus
        return
    wide = camera.replace(lens=camera.lens.focused(np.inf))
    pitch = wide.film.width_mm / wide.film.resolution[0]
    expected = wide.lens.first_order().effective_focal_length_mm / pitch
    assert wide.camera_matrix[0, 0] == pytest.approx(expected, rel=1e-13)


@pytest.mark.parametrize("tilt_deg", [0.0, 0.3])
def test_what_is_not_imaged_says_why(tilt_deg: float) -> None:
    camera = camera_of("double-gauss-50mm")
    if tilt_deg:  # a tilted lens has another table of projection rays
        lens = camera.lens.with_element_tilted(2, 3, x_deg=tilt_deg)
        camera = camera.replace(lens=lens, film=rc.Film(22, 16, (880, 640)))
    points = [(0, 0, -2), (0, 0, 3), (9, 0, -10), (0, 5, -0.5), (np.nan, 0, -1), (0, np.inf, -1), (0, 0, -0.03)]
    pixels, status = camera.project(points, return_status=True)
    S = rc.ProjectionStatus
    assert status.tolist() == [S.OK, S.BEHIND, S.OUTSIDE_PICTURE, S.OUTSIDE_PICTURE, S.BAD_INPUT, S.BAD_INPUT, S.BEHIND]
    assert np.isnan(pixels[[1, 3, 4, 5, 6]]).all()
    # A film larger than the image circle: the lens passes no light from a point so far off the axis.
    large = camera.replace(film=rc.Film(200, 200, (100, 100)))
    assert large.project([(0, 3, -1)], return_status=True)[1].tolist() == [S.BLOCKED]
    assert np.isnan(large.ray([(0, 0)])[1]).all()
    if tilt_deg:
        return
    assert pixels[0] == pytest.approx([480, 320], abs=1e-9)
    # Outside of the picture, but closer to its centre than the corners: pixel coordinates, with a status that says so.
    origin, direction = camera.ray([(480, -20)])
    pixels, status = camera.project(origin + 3 * direction, return_status=True)
    assert pixels[0] == pytest.approx([480, -20], abs=1e-6) and status[0] == S.OUTSIDE_PICTURE


def test_the_fisheye_sees_behind_itself() -> None:
    camera = camera_of(FISHEYE)
    origins, directions = camera.ray([(480, 60), (480, 320)])
    assert directions[0][2] > 0 > directions[1][2]
    assert camera.project(origins + 2 * directions) == pytest.approx(np.array([(480, 60), (480, 320)]), abs=1e-6)


def test_a_rolling_shutter_sees_each_row_at_its_time() -> None:
    camera = camera_of("double-gauss-50mm").replace(
        exposure_time_s=0.002,
        readout_time_s=0.02,
        motion=[(0, (0, 0, 0), (0, 0, -1)), (0.03, (0.3, 0, 0), (0.3, 0, -1))],
    )
    pixels = grid(camera)
    origins, directions = camera.ray(pixels)
    # At 10 m/s row r lies where the camera is 0.02 r / 640 + 0.001 s after the start.
    rows = np.clip(pixels[:, 1], 0, 639).astype(int)
    still, _ = camera.replace(motion=[], position=(0, 0, 0), look_at=(0, 0, -1)).ray(pixels)
    lit = ~np.isnan(origins[:, 0])
    assert origins[lit, 0] == pytest.approx(still[lit, 0] + 10 * (0.02 * rows / 640 + 0.001)[lit], abs=1e-12)
    # Each row of pixels is exposed at one time, so that a point on the border of two rows may be assigned to either.
    middles = np.floor(pixels) + 0.5
    origins, directions = camera.ray(middles)
    seen = camera.project(origins + 2 * directions)
    assert np.nanmax(np.abs(seen - middles)) < 1e-6


def test_a_hundred_thousand_points_take_well_under_a_second() -> None:
    camera = camera_of("double-gauss-50mm")
    points = np.random.default_rng(1).uniform([-0.25, -0.15, -3], [0.25, 0.15, -1], (100_000, 3))
    seconds = []
    for _ in range(6):  # the first finds the lens's lines too, and others may be at work on the machine
        start = time.perf_counter()
        pixels = camera.project(points)
        seconds.append(time.perf_counter() - start)
    assert min(seconds) < 0.5
    assert np.isfinite(pixels).all()


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda c: c.project([(0, 0)]), r"points_m must be an array of shape \(N, 3\)"),
        (lambda c: c.ray([(0, 0, 0)]), r"pixels must be an array of shape \(N, 2\)"),
        (lambda c: c.project([(0, 0, 1)], through="rim"), 'unknown ray "rim"; expected light or chief'),
    ],
)
def test_mistakes_are_explained(call: object, says: str) -> None:
    with pytest.raises(rc.InputError, match=says):
        call(camera_of("double-gauss-50mm"))
