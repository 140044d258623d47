"""ST maps and tables of cv2.remap: their convention, both directions, and OpenCV where it is installed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import realcam as rc

pytestmark = pytest.mark.picture_files
SIZE = (96, 64)
K = np.array([[70.0, 0, 48.3], [0, 71.0, 31.2], [0, 0, 1]])
CAMERA = rc.Calibration.opencv(K, [-0.2, 0.05, 0.001, -0.0005], SIZE)


def channels(path: Path) -> np.ndarray:
    import OpenImageIO as oiio

    return np.asarray(oiio.ImageInput.open(str(path)).read_image())


def test_an_st_map_reads_s_rightwards_and_t_upwards(tmp_path: Path) -> None:
    CAMERA.save(tmp_path / "stmap.exr")
    found = channels(tmp_path / "stmap.exr")
    assert found.shape == (64, 96, 3)
    matrix = CAMERA.camera_matrix
    ray = [(10.5 - matrix[0, 2]) / matrix[0, 0], (7.5 - matrix[1, 2]) / matrix[1, 1], 1]
    x, y = CAMERA.project([ray])[0][0]
    # A float32 of about 1 has steps of 6e-8.
    assert found[7, 10] == pytest.approx([x / 96, 1 - y / 64, 0], abs=1e-7)


@pytest.mark.parametrize("name", ["stmap.exr", "redistort.exr", "remap.npz"])
def test_maps_are_cameras(tmp_path: Path, name: str) -> None:
    """Cubic splines over pixels, whose error is the fourth difference of the distortion: some 1e-4 pixels here."""
    CAMERA.save(tmp_path / name)
    found = rc.Calibration.load(tmp_path / name)
    pixels = np.random.default_rng(2).random((200, 2)) * [80, 50] + [8, 7]
    directions = CAMERA.ray(pixels)[0]
    assert np.abs(found.project(directions)[0] - pixels).max() < 1e-3
    assert np.abs(found.ray(pixels)[0] - directions).max() < 1e-5
    found.save(tmp_path / f"again{name[-4:]}", found.format)
    again = rc.Calibration.load(tmp_path / f"again{name[-4:]}", format=found.format)
    assert np.array_equal(again.camera_model.positions, found.camera_model.positions, equal_nan=True)


@pytest.mark.parametrize(
    ("camera", "largest_px"),
    [
        # Cubic splines of a direction that changes by 1/40 a pixel: their error is below 1/40^4 of its fourth
        # derivative, which near 90 degrees is of the order of 1 in stereographic coordinates; 32-bit positions cost
        # more, 1e-7 of the tangent at 45 degrees.
        (rc.Calibration.opencv_fisheye([[40, 0, 69.5], [0, 40, 59.5], [0, 0, 1]], [0, 0, 0, 0], (140, 120)), 1e-3),
        # The angle goes like a square root of the distance to the fold, which no spline over pixels follows.
        (rc.Calibration.opencv([[150, 0, 159.5], [0, 150, 119.5], [0, 0, 1]], [-0.35, 0, 0, 0], (320, 240)), 0.1),
    ],
    ids=["90 degrees", "fold"],
)
def test_a_redistorting_map_is_a_camera_to_its_end(tmp_path: Path, camera: rc.Calibration, largest_px: float) -> None:
    camera.save(tmp_path / "redistort.exr")
    found = rc.Calibration.load(tmp_path / "redistort.exr")
    pixels = np.random.default_rng(3).random((4000, 2)) * camera.size
    directions, _ = camera.ray(pixels)
    seen = np.isfinite(directions[:, 0])
    assert 0.2 < seen.mean() < 0.95  # the picture shows the end all around
    projected, status = found.project(directions[seen])
    # A point less than two pixels from the end is refused if it lies beside a pixel without a ray.
    refused_px = 2 * 2 * np.pi * np.sqrt(seen.mean() * np.prod(camera.size) / np.pi)
    assert (status == rc.PointStatus.NO_PROJECTION).sum() < refused_px / np.prod(camera.size) * len(pixels)
    assert np.nanmax(np.linalg.norm(projected - pixels[seen], axis=1)) < largest_px


def test_pixels_without_a_ray_are_marked_in_a_redistorting_map(tmp_path: Path) -> None:
    """(-1, -1) of an ST map lies beside every picture, and cv2.remap shows its border value at NaN."""
    camera = rc.Calibration.opencv_fisheye([[40, 0, 69.5], [0, 40, 59.5], [0, 0, 1]], [0, 0, 0, 0], (140, 120))
    camera.save(tmp_path / "redistort.exr")
    camera.save(tmp_path / "remap.npz")
    values, tables = channels(tmp_path / "redistort.exr"), np.load(tmp_path / "remap.npz")
    rows, columns = np.mgrid[0:120, 0:140]
    is_beyond = np.hypot(columns - 69.5, rows - 59.5) > 40 * np.pi / 2
    assert (values[is_beyond][:, :2] == -1).all()
    assert np.isnan(tables["redistort_map_x"][is_beyond]).all()
    # The distance from the centre of a pixel's direction in the pinhole camera's picture: f tan(r / f).
    distance = np.hypot(30 - 69.5, 20 - 59.5)
    expected = 69.5 + (30 - 69.5) * 40 * np.tan(distance / 40) / distance
    assert tables["redistort_map_x"][20, 30] == pytest.approx(expected, rel=1e-6)


def test_a_map_of_another_program_needs_its_pinhole_camera(tmp_path: Path) -> None:
    x, y = np.meshgrid(np.arange(96.0), np.arange(64.0))
    np.savez(tmp_path / "remap.npz", map_x=x.astype(np.float32), map_y=y.astype(np.float32))
    with pytest.raises(rc.CalibrationFileError, match="expected camera_matrix"):
        rc.Calibration.load(tmp_path / "remap.npz")
    matrix = [[70, 0, 48], [0, 70, 32], [0, 0, 1]]
    found = rc.Calibration.load(tmp_path / "remap.npz", camera_matrix=matrix)
    assert found.project([[0.1, -0.2, 1]])[0][0] == pytest.approx([55, 18], abs=1e-9)
    np.savez(tmp_path / "bad.npz", map_x=np.array([object()], dtype=object))
    with pytest.raises(rc.CalibrationFileError, match=r"is not an .npz file of numbers"):
        rc.Calibration.load(tmp_path / "bad.npz")


def test_redistort_inverts_undistort() -> None:
    rows, columns = np.mgrid[0:64, 0:96] + 0.5
    image = np.sin(columns / 9) + np.cos(rows / 7)
    flat = CAMERA.undistort(image, interpolation="bicubic")
    back = CAMERA.redistort(np.nan_to_num(flat), interpolation="bicubic")
    inside = np.s_[16:48, 24:72]  # away from the edges, beside which the flat picture shows nothing
    assert np.abs(back - image)[inside].max() < 1e-3


def test_opencv_remaps_by_the_tables(tmp_path: Path) -> None:
    cv2 = pytest.importorskip("cv2")
    CAMERA.save(tmp_path / "remap.npz")
    tables = np.load(tmp_path / "remap.npz")
    x, y = cv2.initUndistortRectifyMap(K, np.array([-0.2, 0.05, 0.001, -0.0005]), None, K, SIZE, cv2.CV_32FC1)
    assert np.nanmax(np.abs(tables["undistort_map_x"] - x)) < 1e-4
    assert np.nanmax(np.abs(tables["undistort_map_y"] - y)) < 1e-4
    rows, columns = np.mgrid[0:64, 0:96] + 0.5
    image = np.sin(columns / 9) + np.cos(rows / 7)
    expected = cv2.remap(image, tables["undistort_map_x"], tables["undistort_map_y"], cv2.INTER_LINEAR)
    flat = CAMERA.undistort(image)
    inside = np.s_[4:60, 4:92]
    # cv2.remap rounds positions to 1/32 of a pixel, over which the picture changes by at most 0.004.
    assert np.abs(flat - expected)[inside].max() < 0.005


def test_what_lies_behind_has_no_map(tmp_path: Path) -> None:
    camera = rc.Lens.load("fisheye-6mm-220deg").calibration(resolution=(60, 60), model="fisheye")
    with pytest.raises(rc.InputError, match="ends at 90 degrees"):
        camera.save(tmp_path / "stmap.exr")


def test_a_picture_is_turned_by_rotations_only() -> None:
    with pytest.raises(rc.InputError, match="rotation must be a rotation: orthonormal, with determinant 1"):
        CAMERA.undistort(np.zeros((CAMERA.size[1], CAMERA.size[0])), rotation=2 * np.eye(3))
    with pytest.raises(rc.InputError, match="camera_matrix must be an invertible matrix"):
        CAMERA.undistort(np.zeros((CAMERA.size[1], CAMERA.size[0])), camera_matrix=np.zeros((3, 3)))
