"""Projections against equations in 40 digits, folds against closed forms, and OpenCV where it is installed."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
import realcam as rc

K = np.array([[900.0, 0, 610.2], [0, 905.0, 402.7], [0, 0, 1]])
SIZE = (1200, 800)
D14 = [-0.21, 0.06, -0.0004, 0.0006, -0.007, 0.012, 0.003, -0.0005, 0.0013, -0.0004, -0.0009, 0.0003, 0.02, -0.015]


def directions(count: int = 200, largest_deg: float = 35.0) -> np.ndarray:
    rng = np.random.default_rng(7)
    angle, azimuth = np.radians(largest_deg) * np.sqrt(rng.random(count)), 2 * np.pi * rng.random(count)
    unit = np.column_stack([np.sin(angle) * np.cos(azimuth), np.sin(angle) * np.sin(azimuth), np.cos(angle)])
    return unit * rng.uniform(0.4, 9, (count, 1))


def opencv_pixel(point: np.ndarray, D: list[float]) -> list[float]:
    """The equations of OpenCV's documentation with 40 digits."""
    with mpmath.workdps(40):
        X, Y, Z = (mpmath.mpf(float(v)) for v in point)
        k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4, tx, ty = (mpmath.mpf(v) for v in [*D, *[0] * 14][:14])
        x, y = X / Z, Y / Z
        r2 = x * x + y * y
        f = (1 + k1 * r2 + k2 * r2**2 + k3 * r2**3) / (1 + k4 * r2 + k5 * r2**2 + k6 * r2**3)
        u = x * f + 2 * p1 * x * y + p2 * (r2 + 2 * x * x) + s1 * r2 + s2 * r2**2
        v = y * f + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y + s3 * r2 + s4 * r2**2
        cx, sx, cy, sy = mpmath.cos(tx), mpmath.sin(tx), mpmath.cos(ty), mpmath.sin(ty)
        R = mpmath.matrix([[cy, 0, -sy], [0, 1, 0], [sy, 0, cy]]) * mpmath.matrix(
            [[1, 0, 0], [0, cx, sx], [0, -sx, cx]]
        )
        upright = mpmath.matrix([[R[2, 2], 0, -R[0, 2]], [0, R[2, 2], -R[1, 2]], [0, 0, 1]])
        a, b, c = upright * R * mpmath.matrix([u, v, 1])
        return [float(900 * a / c + mpmath.mpf("610.7")), float(905 * b / c + mpmath.mpf("403.2"))]


@pytest.mark.parametrize("count", [0, 4, 5, 8, 12, 14])
def test_opencv_models_follow_the_documented_equations(count: int) -> None:
    points = directions()
    pixels, status = rc.Calibration.opencv(K, D14[:count], SIZE).project(points)
    assert (status <= rc.PointStatus.OUTSIDE_PICTURE).all()
    expected = np.array([opencv_pixel(point, D14[:count]) for point in points])
    assert np.abs(pixels - expected).max() < 1e-9


@pytest.mark.parametrize("count", [4, 8, 14])
def test_opencv_itself_projects_to_the_same_pixels(count: int) -> None:
    cv2 = pytest.importorskip("cv2")
    points = directions()
    expected = cv2.projectPoints(points.reshape(-1, 1, 3), np.zeros(3), np.zeros(3), K, np.array(D14[:count]))[0]
    pixels, _ = rc.Calibration.opencv(K, D14[:count], SIZE).project(points)
    assert np.abs(pixels - expected.reshape(-1, 2) - 0.5).max() < 1e-9


def test_fisheye_follows_its_polynomial_and_ends_at_90_degrees() -> None:
    camera = rc.Calibration.opencv_fisheye(K, [-0.02, 0.01, -0.008, 0.0015], SIZE)
    t = 1.2
    r = 900 * t * (1 - 0.02 * t**2 + 0.01 * t**4 - 0.008 * t**6 + 0.0015 * t**8)
    pixels, status = camera.project([[np.sin(t), 0, np.cos(t)], [1, 0, 0], [0, 1, -0.1]])
    assert pixels[0] == pytest.approx([610.7 + r, 403.2], abs=1e-9)
    assert list(status[1:]) == [rc.PointStatus.NO_PROJECTION] * 2


@pytest.mark.parametrize("count", [0, 4, 5, 8, 12, 14])
def test_rays_invert_projections(count: int) -> None:
    points = directions()
    camera = rc.Calibration.opencv(K, D14[:count], SIZE)
    rays, status = camera.ray(camera.project(points)[0])
    assert (status <= rc.PointStatus.OUTSIDE_PICTURE).all()
    assert np.linalg.norm(rays - points / np.linalg.norm(points, axis=1)[:, None], axis=1).max() < 1e-12


def test_points_beyond_the_fold_are_refused() -> None:
    """x (1 - k r^2) is largest at r = 1 / sqrt(3 k)."""
    camera = rc.Calibration.opencv(K, [-0.25, 0, 0, 0], SIZE)
    fold = 1 / np.sqrt(0.75)
    assert camera.largest_angle_deg == pytest.approx(np.degrees(np.arctan(fold)), abs=1e-9)
    pixels, status = camera.project([[fold * 0.999, 0, 1], [0, fold * 1.001, 1], [3, 0, 1], [0.1, 0, -1]])
    beyond, behind = rc.PointStatus.BEYOND_FOLD, rc.PointStatus.BEHIND
    assert list(status[1:]) == [beyond, beyond, behind]
    assert np.isfinite(pixels[0]).all()
    assert np.isnan(pixels[1:]).all()
    assert camera.ray([[610.7 + 900 * fold, 403.2]])[1][0] == beyond


def test_a_pole_of_the_denominator_is_a_fold() -> None:
    camera = rc.Calibration.opencv(K, [0, 0, 0, 0, 0, -1.0, 0, 0], SIZE)  # 1 / (1 - r^2)
    assert camera.project([[0.9, 0, 1], [1.1, 0, 1]])[1][1] == rc.PointStatus.BEYOND_FOLD


def test_the_tangential_fold_depends_on_the_azimuth() -> None:
    camera = rc.Calibration.opencv(K, [-0.25, 0, 0.02, -0.03], SIZE)
    azimuths = np.linspace(0, 2 * np.pi, 37)
    r = np.linspace(0.2, 2, 400)
    for azimuth in azimuths:
        points = np.column_stack([r * np.cos(azimuth), r * np.sin(azimuth), np.ones_like(r)])
        pixels, status = camera.project(points)
        is_refused = status == rc.PointStatus.BEYOND_FOLD
        assert is_refused.any()
        assert not np.diff(is_refused.astype(int)).min() < 0  # never seen again behind the fold
        distance = np.hypot(*(pixels[~is_refused] - camera.camera_matrix[:2, 2]).T / [[900], [905]])
        assert (np.diff(distance) > 0).all()


def test_a_model_without_a_fold_ends_a_diagonal_beyond_the_picture() -> None:
    camera = rc.Calibration.opencv(K, [0.2, 0, 0, 0], SIZE)
    _, status = camera.project([[0.2, 0, 1], [0.9, 0, 1], [4, 0, 1]])
    assert list(status) == [rc.PointStatus.OK, rc.PointStatus.OUTSIDE_PICTURE, rc.PointStatus.NO_PROJECTION]


def test_scaling_and_cropping_move_pixels() -> None:
    points = directions(50, 20)
    camera = rc.Calibration.opencv(K, D14[:5], SIZE)
    pixels = camera.project(points)[0]
    assert np.allclose(camera.resized((600, 400)).project(points)[0], pixels / 2, atol=1e-9)
    part = camera.cropped(100, 50, 900, 600)
    assert part.size == (900, 600)
    assert np.allclose(part.project(points)[0], pixels - [100, 50], atol=1e-9)
    with pytest.raises(rc.InputError, match="exceeds"):
        camera.cropped(400, 0, 900, 600)


def test_undistorted_pictures_have_the_colours_of_the_distorted_pixels() -> None:
    camera = rc.Calibration.opencv(K, D14[:5], SIZE).resized((120, 80))
    rows, columns = np.mgrid[0:80, 0:120] + 0.5
    image = np.stack([columns, rows], axis=2)  # each pixel holds its own position
    flat = camera.undistort(image)
    centres = np.stack([columns, rows, np.ones_like(rows)], axis=2).reshape(-1, 3)
    expected = camera.project(centres @ np.linalg.inv(camera.camera_matrix).T)[0].reshape(80, 120, 2)
    inside = ((expected > 1) & (expected < [119, 79])).all(axis=2)
    assert inside.mean() > 0.9
    assert np.abs(flat - expected)[inside].max() < 1e-9


def test_rectified_rows_agree() -> None:
    left, right = rc.Calibration.opencv(K, D14[:5], SIZE), rc.Calibration.opencv(K, D14[:4], SIZE)
    angle = 0.03
    T = np.eye(4)
    T[:3, :3] = [[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]]
    T[:3, 3] = [-0.12, 0.004, 0.01]
    found = left.stereo_rectification(right, T)
    points = np.column_stack([directions(40, 25), np.ones(40)])
    first = np.column_stack([points[:, :3] @ found.R1.T, np.ones(40)]) @ found.P1.T
    second = np.column_stack([points[:, :3] @ found.R1.T, np.ones(40)]) @ found.P2.T
    direct = np.column_stack([(points @ T.T)[:, :3] @ found.R2.T, np.ones(40)]) @ found.P1.T
    first, second, direct = (p[:, :2] / p[:, 2:] for p in (first, second, direct))
    assert np.abs(second - direct).max() < 1e-9
    assert np.abs(first[:, 1] - second[:, 1]).max() < 1e-9
    assert (first[:, 0] > second[:, 0]).all()
