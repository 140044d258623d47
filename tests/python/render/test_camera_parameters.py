"""rc.CameraParameters: cameras of values, and derivatives by these values. Differences have common random numbers; see
test_picture_gradient.py."""

from __future__ import annotations

import numpy as np
import pytest
import realcam as rc
from numpy.typing import NDArray

from ..device_memory import needs_gpu
from .test_picture_gradient import ADJOINT, ERRORS, corner_camera, estimate, stripes

POSE = ["right_m", "up_m", "backward_m", "pitch_deg", "yaw_deg", "roll_deg"]
RADIUS, GAP = rc.Variable.radius(0), rc.Variable.thickness(1)


def axes_of(camera: rc.Camera) -> NDArray[np.float64]:
    """Right, up and backward of a camera as columns, (3, 3)."""
    position, look_at, up = (np.array(part) for part in camera.pose_at(0))
    backward = (position - look_at) / np.linalg.norm(position - look_at)
    right = np.cross(up, backward) / np.linalg.norm(np.cross(up, backward))
    return np.stack([right, np.cross(backward, right), backward], axis=1)


def test_own_values_are_those_of_the_camera() -> None:
    camera = corner_camera()
    family = rc.CameraParameters(camera, [*POSE, "film_shift_right_mm", "focus_distance_m", "f_number", GAP])
    np.testing.assert_allclose(family.values, [0, 0, 0, 0, 0, 0, 10, 2, 4, 0.12])
    same = family.camera_at(family.values)
    np.testing.assert_allclose(axes_of(same), axes_of(camera), atol=1e-12)
    assert same.film == camera.film and same.lens.film_distance_mm == camera.lens.film_distance_mm
    np.testing.assert_allclose(same.lens.surfaces[1].thickness_mm, 0.12)


def test_pose_is_a_translation_and_a_rotation_vector_along_the_axes_of_the_camera() -> None:
    camera = corner_camera().replace(position=(1, 2, 3), look_at=(0, 2, 3), up=(0, 0, 1))
    family = rc.CameraParameters(camera, POSE)
    moved = family.camera_at([0.1, 0.2, 0.3, 0, 90, 0])
    # It looks to -x and up is z: right is y, and backward x. Yaw by 90 degrees turns it to the left.
    np.testing.assert_allclose(moved.position, (1.3, 2.1, 3.2), atol=1e-12)
    np.testing.assert_allclose(axes_of(moved), np.array([[-1, 0, 0], [0, 0, 1], [0, 1, 0]]).T, atol=1e-12)


def test_pose_derivatives_are_those_of_the_axes() -> None:
    camera = corner_camera().replace(position=(1, 2, 3), look_at=(0.3, 1, -2), up=(0.1, 1, 0.2))
    family, step = rc.CameraParameters(camera, POSE), 1e-4
    values = np.array([0.3, -0.2, 0.1, 12.0, -7.0, 25.0])
    directions = family.directions(values)
    axes = axes_of(family.camera_at(values))
    for column in range(6):
        up, down = (family.camera_at(values + sign * step * np.eye(6)[column]) for sign in (1, -1))
        moved = axes.T @ (np.array(up.position) - down.position) / (2 * step)
        turned = np.degrees(axes.T @ (axes_of(up) - axes_of(down)) / (2 * step))
        found = directions[column]
        # Differences of second order: the rotation's third derivative is 1 rad^-2, and a step 1.7e-6 rad.
        np.testing.assert_allclose([found.get(name, 0) for name in POSE[:3]], moved, atol=1e-9)
        wanted = [turned[2, 1], turned[0, 2], turned[1, 0]]
        np.testing.assert_allclose([found.get(name, 0) for name in POSE[3:]], wanted, atol=1e-8)


def test_rims_are_scaled_but_for_the_stop() -> None:
    camera = corner_camera()
    family = rc.CameraParameters(camera, ["rim_scale", "f_number"])
    assert family.values[0] == 1
    there, here = family.camera_at([0.9, 5.6]).lens, camera.lens
    radii = [[s.clear_semi_diameter_mm for s in lens.surfaces] for lens in (there, here)]
    factors = np.divide(*radii)
    assert factors[here.stop_index] == 1 and there.f_number == pytest.approx(5.6)
    np.testing.assert_allclose(np.delete(factors, here.stop_index), 0.9, rtol=1e-14)


@pytest.mark.slow
def test_derivatives_by_values_equal_differences() -> None:
    scene, base = stripes(), corner_camera()
    family = rc.CameraParameters(base, ["right_m", "yaw_deg", "roll_deg", "focus_distance_m", "f_number", GAP])
    at = np.array([0.01, -0.5, 3.0, 2.2, 4.2, 0.15])
    steps = np.array([2e-4, 0.01, 0.05, 0.05, 0.05, 0.02])
    found, error = estimate(
        lambda seed: family.gradient(scene, at, ADJOINT, spp=64, seed=seed, max_bounces=0).astype(float)
    )
    for i, step in enumerate(steps * np.eye(len(at))):

        def difference(seed: int, step: NDArray[np.float64] = step) -> NDArray[np.float64]:
            pictures = (
                family.render(scene, at + sign * step, spp=128, seed=1000 + seed, max_bounces=0).astype(float)
                for sign in (1, -1)
            )
            above, below = pictures
            return np.asarray(((above - below) * ADJOINT).sum() / (2 * step.sum()))

        wanted, wanted_error = estimate(difference)
        assert abs(wanted) > 0 and abs(found[i] - wanted) < ERRORS * np.hypot(error[i], wanted_error), (
            i,
            found[i],
            wanted,
        )


def test_focus_and_a_distance_that_it_moves_are_added() -> None:
    lens = rc.Lens.load("macro-105mm").focused(1.0).stopped_down(5.6)
    family = rc.CameraParameters(rc.Camera(lens), ["focus_distance_m"])
    moved = [v for v in family.directions([0.8])[0] if isinstance(v, rc.Variable) and v.quantity == "thickness"]
    gap = rc.Variable.thickness(moved[0].surface)
    both = rc.CameraParameters(family.camera, ["focus_distance_m", gap])
    thickness = both.camera_at(both.values + np.array((-0.2, 0.01))).lens.surfaces[gap.surface].thickness_mm
    assert thickness == pytest.approx(lens.focused(0.8).surfaces[gap.surface].thickness_mm + 0.01, abs=1e-12)


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        (["film_tilt_x_deg"], "film_tilt_x_deg cannot be set"),
        (["zoom"], "unknown parameter 'zoom'"),
        ([rc.Variable.film_distance()], "the film distance cannot be set"),
        (["up_m", "up_m"], "must be distinct"),
        ([], "at least one"),
        ([rc.Variable.radius(99)], "no surface 99"),
    ],
)
def test_parameters_that_cannot_be_set_are_refused(parameters: list[rc.Variable | str], message: str) -> None:
    with pytest.raises(rc.InputError, match=message):
        rc.CameraParameters(corner_camera(), parameters)


def test_values_that_are_no_camera_are_refused() -> None:
    family = rc.CameraParameters(corner_camera(), ["f_number", RADIUS])
    for values in ([4.0], [np.nan, 0.03], [0.5, 0.03]):
        with pytest.raises(rc.InputError):
            family.camera_at(values)


def test_pictures_and_gradients_run_on_the_device_that_is_named() -> None:
    family = rc.CameraParameters(corner_camera(), "up_m")
    for run in (family.render, lambda *arguments, **named: family.gradient(*arguments, ADJOINT, **named)):
        with pytest.raises(rc.InputError, match="tpu"):
            run(stripes(), [0], spp=1, device="tpu")


@needs_gpu
def test_pictures_of_a_gpu_are_those_of_the_cpu() -> None:
    family, scene = rc.CameraParameters(corner_camera(), "up_m"), stripes()
    on_gpu, on_cpu = (family.render(scene, [0], spp=64, max_bounces=0, device=device) for device in ("cuda", "cpu"))
    # Roundings move single samples over edges of the scene; each is at most 1 / 64 of a pixel's light.
    np.testing.assert_allclose(on_gpu, on_cpu, atol=on_cpu.max() / 64)


def test_rates_of_rings_are_those_of_distances_and_stop_at_changed_variables() -> None:
    lens = rc.Lens.load("macro-105mm").focused(1.0).stopped_down(5.6)
    family = rc.CameraParameters(rc.Camera(lens), ["focus_distance_m", "f_number", rc.Variable.thickness(0)])
    at, step = family.values + np.array((-0.1, 0.5, 0.2)), 1e-4
    there = family.camera_at(at).lens
    wider, narrower = (there.stopped_down(there.f_number + sign * step) for sign in (-1, 1))
    by_f_number = (narrower.stop_semi_diameter_mm - wider.stop_semi_diameter_mm) / (2 * step)
    for column, direction in enumerate(family.directions(at)[:2]):
        above, below = (family.camera_at(at + sign * step * np.eye(3)[column]).lens for sign in (1, -1))
        gaps = np.array([[s.thickness_mm for s in lens.surfaces[:-1]] for lens in (above, below)])
        rates = [direction.get(rc.Variable.thickness(i), 0.0) for i in range(len(gaps[0]))]
        # The differences' error is of the order of step^2 of the rates, which are some 10 mm.
        np.testing.assert_allclose(rates, (gaps[0] - gaps[1]) / (2 * step), atol=1e-5)
        of_stop = (above.stop_semi_diameter_mm - below.stop_semi_diameter_mm) / (2 * step)
        assert direction.get("f_number", 0.0) * by_f_number == pytest.approx(of_stop, abs=1e-6)
