"""Cameras with the geometry of a calibration: against the calibration itself, and the light against the lens's."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest
import realcam as rc
from realcam.calibration.camera import lens_choice
from realcam.calibration.models import opencv_models

from .. import scenes

LENS = rc.Lens.load("double-gauss-50mm").focused(2.0)
SIZE = (192, 128)


def calibration(focal: float = 270.0, skewed: float = 1.0) -> rc.Calibration:
    """A camera with barrel distortion whose axis is not in the middle and whose pixels are not square."""
    K = [[focal, 0, 93.0], [0, focal * (1 + 0.01 * skewed), 66.0], [0, 0, 1]]
    return rc.Calibration.opencv(K, [-0.15, 0.04, 0.0005, -0.0003, 0], SIZE)


def fisheye(angle_deg: float = 95.0) -> rc.Calibration:
    """An equidistant fisheye (Kannala and Brandt) whose image circle lies in the picture, as Kalibr writes them."""
    focal = 62.0 / np.radians(angle_deg)
    model = opencv_models.fisheye_model(
        np.array([[focal, 0, 96.0], [0, focal, 64.0], [0, 0, 1]]),
        [0.02, -0.004, 0.001, 0.0],
        np.radians(angle_deg),
    )
    return rc.Calibration(model, SIZE, "kb4")


@pytest.mark.parametrize("model", ["full", "thick", "mapped", "thin", "pinhole"])
def test_chief_rays_have_the_directions_of_the_calibration(model: str) -> None:
    made_from = calibration()
    camera = made_from.camera(LENS, model=model)
    error = made_from.geometry_error(camera)
    # The aims for all kinds; the table is refined until measured errors are below 0.004.
    assert error.middle_px < 0.01
    assert error.everywhere_px < 0.05
    assert error.rotation_deg < 3
    np.testing.assert_allclose(camera.camera_matrix, made_from.camera_matrix, rtol=1e-9)


def test_rays_that_were_traced_before_are_moved_like_those_that_are_traced_now() -> None:
    pose = {"position": (1, 2, 3), "look_at": (2, 2, 1)}
    camera = calibration().camera(LENS, **pose)
    pixels = np.random.default_rng(4).random((50, 2)) * SIZE
    lens_rays = rc._core.traced_chief_rays(rc.Camera(LENS, film=camera.film, **pose), pixels)
    for moved, traced in zip(
        rc._core.traced_chief_rays(camera, pixels, lens_rays), rc._core.traced_chief_rays(camera, pixels), strict=True
    ):
        np.testing.assert_allclose(moved, traced, rtol=0, atol=1e-12)  # metres and cosines, in doubles
    with pytest.raises(rc.InputError, match="a ray for each pixel"):
        rc._core.traced_chief_rays(camera, pixels[1:], lens_rays)


def test_a_fisheye_of_190_degrees() -> None:
    made_from = fisheye()
    camera = made_from.camera("fisheye-6mm-220deg", film_width_mm=31.0)
    error = made_from.geometry_error(camera)
    assert error.middle_px < 0.01
    assert error.everywhere_px < 0.05
    assert camera.field_of_view_deg.vertical > 180
    picture = rc.render(scenes.sky(), camera, effects=(), spp=4, device="cpu").pixels
    _, status = made_from.ray([[96.0, 64.0], [2.0, 2.0]])
    assert (status == [rc.PointStatus.OK, rc.PointStatus.NO_PROJECTION]).all()
    assert picture[64, 96].min() > 0
    assert (picture[2, 2] == 0).all()  # beyond the model's largest angle


@pytest.mark.slow
def test_pixels_beside_a_fold_are_precise_or_black() -> None:
    """At a fold the angle grows with the square root of the distance, which no grid resolves."""
    focal, fold = 500.0, np.radians(112.0)
    model = opencv_models.fisheye_model(
        np.array([[focal, 0, 700.0], [0, focal, 690.0], [0, 0, 1]]), [-1 / (3 * fold**2), 0, 0, 0], np.radians(180)
    )
    made_from = rc.Calibration(model, (1400, 1400), "kb4")
    assert made_from.largest_angle_deg == pytest.approx(112)
    camera = made_from.camera("fisheye-6mm-220deg")
    error = made_from.geometry_error(camera)
    assert error.everywhere_px < 0.05
    # The circle of the fold has a radius of 2/3 fold focal = 652 pixels. Linear interpolation of a square root between
    # nodes h = 2.2 pixels apart, at a distance s from the end, is off by h^2 / (16 s): by 0.02 pixels at s = 15.
    columns = np.array([[700 + 652 - s, 690.0] for s in (24.0, 40.0, 100.0)])
    lit = camera.ray(columns, return_light=True)[2]
    assert (lit > 0).all()


def test_a_lens_without_rotational_symmetry() -> None:
    made_from = calibration(skewed=0)
    camera = made_from.camera(LENS.tilted(3, 2))
    assert made_from.geometry_error(camera).everywhere_px < 0.05


@pytest.mark.parametrize("distance_m", [0.6, 5.0])
def test_pixels_see_the_points_that_the_calibration_projects_there(distance_m: float, device: str) -> None:
    """The layer of positions, Camera.project and Camera.ray agree with the calibration."""
    made_from = calibration()
    camera = made_from.camera(LENS.stopped_down(16), position=(0.2, 0.1, 0.5), look_at=(0.3, 0.1, -5))
    rotation, translation = camera.world_to_camera
    wall = scenes.scene_of(scenes.quad((0, 0, 0.5 - distance_m), 50, diffuse=0.5)).with_environment(1.0)
    seen = rc.render(wall, camera, effects=(), spp=1, layers=("position_middle",), device=device)
    points = seen.layers["position_middle"].reshape(-1, 3).astype(float)
    pixels, status = made_from.project(points @ rotation.T + translation)
    assert (status == rc.PointStatus.OK).all()
    columns, rows = np.meshgrid(np.arange(SIZE[0]) + 0.5, np.arange(SIZE[1]) + 0.5)
    middles = np.column_stack([columns.ravel(), rows.ravel()])
    # The ray through the middle of the pupil's bounds is not quite the chief ray: by less than a tenth of the pupil of
    # 3 mm, which out of focus, 0.6 m away, is 6 um on the film. Pixels have 186 um.
    assert np.abs(pixels - middles).max() < 0.03
    inside = rc.Calibration.ray(made_from, middles[::97])[0] @ rotation  # to the scene's axes
    origins, directions = camera.ray(middles[::97], through="chief")
    np.testing.assert_allclose(directions, inside, atol=2e-6)
    again = camera.project(origins + 3.0 * directions, through="chief")
    np.testing.assert_allclose(again, middles[::97], atol=2e-3)


def test_blur_is_that_of_the_lens() -> None:
    """Samples of one pixel come from the whole pupil, and meet where the lens is focused."""
    camera = calibration().camera(LENS, exposure_time_s=1)
    rays = camera.generate_rays(spp=256)
    passed = (rays.weights > 0) & (rays.pixels == 64 * SIZE[0] + 93)
    own = rc.Camera(LENS, film=camera.film, exposure_time_s=1).generate_rays(spp=256)
    own_passed = (own.weights > 0) & (own.pixels == 64 * SIZE[0] + 93)
    spread, own_spread = rays.origins_m[passed].std(axis=0), own.origins_m[own_passed].std(axis=0)
    np.testing.assert_allclose(spread[:2], own_spread[:2], rtol=0.01)
    np.testing.assert_allclose(rays.weights[passed].mean(), own.weights[own_passed].mean(), rtol=1e-4)


@pytest.mark.parametrize("focal", [270.0, 240.0])
@pytest.mark.parametrize("effects", [(), ("dispersion",)])
def test_lamps_have_the_same_image_by_light_tracing(focal: float, effects: tuple[str, ...], device: str) -> None:
    """A small lamp out of focus, off the axis: samples that start at it find the disc that samples of pixels find."""
    camera = calibration(focal).camera(LENS, film_width_mm=36.0, exposure_time_s=1, iso=1)
    lamp = scenes.scene_of(scenes.quad((0.14, 0.09, -0.8), 0.004, emission=1000.0), scenes.quad((0, 0, 9), 1))
    common = {"effects": effects, "spp": 256, "max_bounces": 0, "device": device}
    off, alone = (
        rc.render(lamp, camera, light_tracing=how, **common).pixels.astype(float).sum(axis=2)  # type: ignore[arg-type]
        for how in ("off", "alone")
    )
    columns, rows = np.meshgrid(np.arange(SIZE[0]), np.arange(SIZE[1]))

    def moments(picture: np.ndarray) -> np.ndarray:
        mean = [(picture * at).sum() / picture.sum() for at in (columns, rows)]
        width = [
            np.sqrt((picture * (at - m) ** 2).sum() / picture.sum())
            for at, m in zip((columns, rows), mean, strict=True)
        ]
        return np.array([*mean, *width])

    # The disc has about 100 pixels. One in twenty of the 256 samples of each hits the lamp, so its noise is 3%, and
    # that of the sum is 0.3%. The displacement within the disc is linear; the quadratic part is below a tenth of a
    # pixel.
    np.testing.assert_allclose(alone.sum(), off.sum(), rtol=0.02)
    np.testing.assert_allclose(moments(alone), moments(off), atol=0.1)


def test_effects_are_planned(device: str) -> None:
    """The planner probes the scene with films of its own."""
    lamp = scenes.quad((0.3, 0.2, -2), 0.05, emission=1000.0)
    scene = scenes.scene_of(scenes.quad((0, 0, -3), 5, diffuse=0.5), lamp).with_environment(1.0)
    picture = rc.render(scene, calibration().camera(LENS), spp=4, device=device)
    assert picture.plan
    # Coloured light may lie outside the primaries, so that single values are negative.
    assert picture.pixels.sum(axis=2).min() > 0


def test_measured_vignetting_replaces_that_of_the_lens() -> None:
    made_from = calibration()

    def cosine(pixels: np.ndarray, size: tuple[int, int]) -> np.ndarray:
        return 1 / (1 + ((pixels - (93.5, 66.5)) ** 2).sum(axis=-1) / 200.0**2)

    lens = LENS.stopped_down(5.6)
    measured = rc.Vignetting(cosine, f_number=5.6)
    settings = {"effects": (), "spp": 64, "device": "cpu"}
    taken, plain = (
        rc.render(scenes.sky(), made_from.camera(lens, exposure_time_s=1, vignetting=v), **settings).pixels[..., 1]
        for v in (measured, None)
    )
    columns, rows = np.meshgrid(np.arange(SIZE[0]) + 0.5, np.arange(SIZE[1]) + 0.5)
    expected = cosine(np.stack([columns, rows], axis=-1), SIZE)
    middle = np.s_[60:72, 88:100]
    # Irradiance is constant over a pixel's samples but for those that rims stop: the noise of 64 samples, averaged over
    # blocks of 8 x 8 pixels, is below 1% at the corners.
    blocks = (taken / expected).reshape(16, 8, 24, 8).mean(axis=(1, 3))
    np.testing.assert_allclose(blocks, blocks[8, 11], rtol=0.02)
    np.testing.assert_allclose(taken[middle].mean(), plain[middle].mean(), rtol=0.005)
    with pytest.raises(rc.InputError, match=r"times as bright as lens .* degrees from the axis"):
        made_from.camera(lens, vignetting=rc.Vignetting(lambda pixels, size: 1 / cosine(pixels, size) ** 9))
    dark = rc.Lens.load("landscape-100mm").stopped_down(64)  # sees 30 degrees to the side
    with pytest.raises(
        rc.InputError, match=r"has light where lens landscape-100mm transmits none, at pixel .* degrees"
    ):
        calibration(150.0).camera(dark, vignetting=rc.Vignetting(cosine))


def test_a_lens_is_chosen_and_named() -> None:
    camera = calibration(skewed=0).camera("auto", f_number=4, focus_m=3)
    assert calibration(skewed=0).geometry_error(camera).rotation_deg < 10
    assert camera.lens.f_number == pytest.approx(4, rel=1e-3)
    with pytest.raises(rc.InputError, match=r"a lens of f = .* mm that sees .* opens to f/0.4; the nearest is"):
        calibration(skewed=0).camera("auto", f_number=0.4)


def test_an_automatic_lens_lights_the_picture_at_every_aperture(monkeypatch: pytest.MonkeyPatch) -> None:
    """The rims of a landscape lens pass light of 35 degrees only wide open: its stop lies in front of it."""
    made_from = rc.Calibration.opencv([[200, 0, 119.5], [0, 200, 79.5], [0, 0, 1]], [-0.1, 0, 0, 0], (240, 160))
    monkeypatch.setattr(lens_choice, "lens_names", lambda: ["landscape-100mm"])
    with pytest.raises(rc.InputError, match=r"the nearest is landscape-100mm, .* no light .* at f/64; give one as"):
        made_from.camera("auto")
    monkeypatch.setattr(lens_choice, "lens_names", lambda: ["landscape-100mm", "angulon-210mm"])
    camera = made_from.camera("auto")
    assert camera.lens.name == "angulon-210mm"
    corners = [[0.5, 0.5], [239.5, 0.5], [0.5, 159.5], [239.5, 159.5]]
    for f_number in (camera.lens.f_number, 16, 64):
        light = camera.replace(lens=camera.lens.stopped_down(f_number)).ray(corners, return_light=True)[2]
        assert light.min() > 0.02


def test_the_pose_is_that_of_the_centre_of_projection() -> None:
    pose = np.eye(4)
    pose[:3, :3] = [[0, 0, 1], [1, 0, 0], [0, 1, 0]]
    pose[:3, 3] = 1, 2, 3
    camera = calibration().camera(LENS, scene_from_camera=pose)
    np.testing.assert_allclose(camera.entrance_pupil_position_m, (1, 2, 3), atol=1e-9)
    rotation, _ = camera.world_to_camera
    np.testing.assert_allclose(rotation, pose[:3, :3].T, atol=1e-9)
    with pytest.raises(rc.InputError, match="rotation"):
        calibration().camera(LENS, scene_from_camera=2 * np.eye(4) - np.diag([0, 0, 0, 1]))


def test_cameras_are_values() -> None:
    camera = calibration().camera(LENS)
    assert copy.deepcopy(camera) == camera
    restored = pickle.loads(pickle.dumps(camera))
    assert restored == camera
    assert hash(restored) == hash(camera)
    assert camera != rc.Camera(LENS, film=camera.film)
    with pytest.raises(rc.InputError, match="another size or shift"):
        camera.replace(film=rc.Film(36, 24))
    # Another resolution sees the same.
    half = camera.replace(film=camera.film.replace(resolution=(SIZE[0] // 2, SIZE[1] // 2)))
    np.testing.assert_allclose(half.ray([[30.0, 20.0]])[1], camera.ray([[60.0, 40.0]])[1], atol=1e-12)


def test_a_lens_that_does_not_see_the_picture_is_refused() -> None:
    with pytest.raises(rc.InputError, match=r"pixel \(.*\) is more than 45 degrees from that of lens"):
        fisheye().camera(LENS, film_width_mm=36)
