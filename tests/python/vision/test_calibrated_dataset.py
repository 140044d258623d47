"""Data sets of calibrated cameras, stereo pairs and rigs: labels against the equations of the calibrations."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import realcam as rc
from realcam.dataset import Recipe
from realcam.dataset.sample import make_sample
from realcam.dataset.scenes import random_cameras, random_scene

from ..calibration.test_calibrated_rig import ROTATION, TRANSLATION, camchain

pytestmark = pytest.mark.picture_files

SIZE = (96, 64)
LENSES = 'lenses = ["double-gauss-50mm"]\n'


def calibration_beside(folder: Path) -> rc.Calibration:
    """Writes an OpenCV file beside the recipe."""
    K = [[130.0, 0, 47], [0, 131, 32.5], [0, 0, 1]]
    calibration = rc.Calibration.opencv(K, [-0.12, 0.03, 0.0004, -0.0002, 0], SIZE)
    calibration.save(folder / "camera.yml")
    return calibration


def recipe_of(folder: Path, text: str) -> Recipe:
    path = folder / "recipe.toml"
    path.write_text("format = 1\ncount = 2\nspp = 1\nobjects = 3\n" + text)
    return Recipe.load(path)


def arrays_of(files: dict[str, bytes]) -> dict[str, Any]:
    from realcam.dataset.reading import _decoded

    return {name: _decoded(name, content) for name, content in files.items()}


def corners_in(label: dict[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    """Returns the board's corners in the camera's axes, and the pixels of the label, where the camera images them."""
    pose = label["pose"]["world_to_camera"]
    points = np.array(label["board"]["corners_m"]) @ np.array(pose["rotation"]).T + pose["translation_m"]
    pixels = [[np.nan] * 2 if corner is None else corner for corner in label["board"]["corners_px"]]
    return points, np.array(pixels)


@pytest.mark.slow
def test_labels_have_the_geometry_of_the_calibration(tmp_path: Path) -> None:
    calibration = calibration_beside(tmp_path)
    text = 'calibration = "camera.yml"\nboard = [4, 3]\ndepth = "ray"\nstereo_m = 0.1\nlenses = ["auto"]\n'
    recipe = recipe_of(tmp_path, text)
    assert recipe.picture_size() == SIZE
    found = arrays_of(make_sample(recipe, 1, "cpu", 1))
    left, right = found["json"], found["right.json"]
    assert found["png"].shape == found["right.png"].shape == (64, 96, 3)
    assert not np.array_equal(found["png"], found["right.png"])
    np.testing.assert_allclose(left["calibration"]["camera_matrix"], calibration.camera_matrix, rtol=1e-12)
    assert left["fits"] == [] and left["calibration"]["model"] == calibration.model
    for label in (left, right):
        points, pixels = corners_in(label)
        expected, status = calibration.project(points)
        seen = (status == rc.PointStatus.OK) & np.isfinite(pixels).all(axis=1)
        assert seen.any()
        # A point out of focus is imaged at the centroid of its blur, whose position the lens's coma and vignetting
        # displace by a fraction of the blur of a few pixels.
        np.testing.assert_allclose(pixels[seen], expected[seen], atol=0.2)
    # The right camera is 0.1 m along the x axis of the left one.
    poses = [label["pose"]["world_to_camera"] for label in (left, right)]
    np.testing.assert_allclose(poses[0]["rotation"], poses[1]["rotation"], atol=1e-9)
    shift = np.subtract(poses[1]["translation_m"], poses[0]["translation_m"])
    np.testing.assert_allclose(shift, (-0.1, 0, 0), atol=1e-9)
    assert left["exposure_time_s"] == right["exposure_time_s"]
    # Distances along rays of the calibration are those of points on the floor y = 0.
    floor = (found["mask.png"] == 1) & np.isfinite(found["depth.npy"])
    rows, columns = np.nonzero(floor)
    directions, _ = calibration.ray(np.column_stack([columns, rows]) + 0.5)
    in_scene = directions @ np.array(poses[0]["rotation"])
    points = np.array(left["pose"]["entrance_pupil_m"]) + found["depth.npy"][floor][:, None] * in_scene
    assert len(points) > 500
    # Pixels cover 1/130 of the distance. The layer's rays of pixel centres differ from chief rays by 1/40 of that.
    assert (np.abs(points[:, 1]) < 2e-4 * found["depth.npy"][floor]).all()


def test_a_rig_takes_its_pictures_together(tmp_path: Path) -> None:
    pytest.importorskip("yaml")
    camchain(tmp_path)
    recipe = recipe_of(tmp_path, LENSES + 'rig = "camchain.yaml"\ncamera_speed_m_s = 1\ncamera_turn_deg_s = 20\n')
    rng = np.random.default_rng([recipe.seed, 0])
    cameras = random_cameras(recipe, random_scene(recipe, rng), rng)
    assert list(cameras) == ["cam0", "cam1"]
    for time_s in (0.0, 0.5):  # at the times of keys, and between them
        first, second = (camera.replace(shutter_opens_s=time_s) for camera in cameras.values())
        assert len(first.motion) == len(second.motion) == 2
    (R0, t0), (R1, t1) = (camera.replace(motion=[]).world_to_camera for camera in cameras.values())
    np.testing.assert_allclose(R1 @ R0.T, ROTATION, atol=1e-9)
    np.testing.assert_allclose(t1 - R1 @ R0.T @ t0, TRANSLATION, atol=1e-9)
    files = make_sample(recipe, 0, "cpu", 1)
    suffixes = {"png", "depth.npy", "mask.png", "json"}
    assert set(files) == suffixes | {f"cam1.{suffix}" for suffix in suffixes}
    assert files == make_sample(recipe, 0, "cpu", 2)  # whatever the number of threads


def test_the_size_of_a_calibration_may_be_scaled(tmp_path: Path) -> None:
    calibration_beside(tmp_path)
    recipe = recipe_of(tmp_path, LENSES + 'calibration = "camera.yml"\nsize = [48, 32]\n')
    rng = np.random.default_rng(1)
    (camera,) = random_cameras(recipe, random_scene(recipe, rng), rng).values()
    assert camera.film.resolution == (48, 32)
    scaled = recipe.calibrations[""].resized((48, 32))
    # The aim for all cameras; here the lens is stopped down and focused after the geometry was sampled.
    assert scaled.geometry_error(camera).everywhere_px < 0.05


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('calibration = "none.yml"', r"recipe.toml:5: .*none.yml"),
        ('calibration = "camera.yml"\nsize = [64, 64]', r"recipe.toml:6: size must have the aspect .* 96 x 64 pixels"),
        ('calibration = "camera.yml"\ncalibration_camera = "left"', r'recipe.toml:6: .*no camera "left"'),
        ('calibration_camera = "left"', "recipe.toml:5: calibration_camera belongs to a calibration"),
        ('lenses = ["auto"]', 'recipe.toml:5: film_width_mm and the lens "auto" are for a calibration'),
        ("film_width_mm = 7", "recipe.toml:5: film_width_mm and the lens"),
        ('calibration = "camera.yml"\nrig = "camera.yml"', "recipe.toml:6: rig excludes calibration and stereo_m"),
        ('rig = "camera.yml"', "recipe.toml:5: .*expected a rig of two cameras or more"),
        ('depth = "z"', 'recipe.toml:5: depth: "z" is unknown; expected axis, ray'),
        ("lenses = []", "recipe.toml:5: lenses must name at least one"),
        ('lenses = ["no-such-lens"]', "recipe.toml:5: .*no-such-lens"),
        ("iso = [100, 1e300]", "recipe.toml:5: iso must be 10000000 or less"),
        ("readout_time_s = 1", "recipe.toml:5: next_after_s and readout_time_s must be 0.5 s or less"),
        ("square_m = 1" + 400 * "0" + ".0", "recipe.toml:5: "),
        ("stereo_m = -1", "recipe.toml:5: film_width_mm and stereo_m must be 0 or more"),
    ],
)
def test_mistakes_have_one_line(tmp_path: Path, text: str, message: str) -> None:
    calibration_beside(tmp_path)
    with pytest.raises(rc.InputError, match=message) as caught:
        recipe_of(tmp_path, text)
    assert "\n" not in str(caught.value)
