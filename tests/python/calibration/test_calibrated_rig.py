"""Rigs of calibrated cameras: poses and projections against the transforms that a camchain states."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import realcam as rc

LENS = rc.Lens.load("double-gauss-50mm").focused(2.0)

# The second camera lies 0.11 m to the right of the first and is rotated by atan(3/4) / 10 about its vertical axis.
ANGLE = np.arctan(0.75) / 10
ROTATION = np.array([[np.cos(ANGLE), 0, np.sin(ANGLE)], [0, 1, 0], [-np.sin(ANGLE), 0, np.cos(ANGLE)]])
TRANSLATION = -ROTATION @ (0.11, 0.0, 0.0)


def camchain(folder: Path) -> Path:
    """Writes Kalibr's description of two cameras of 96 x 64 pixels, as YAML that is JSON, too."""
    camera = (
        '"camera_model": "pinhole", "distortion_model": "radtan", "resolution": [96, 64], '
        '"distortion_coeffs": [-0.12, 0.03, 0.0004, -0.0002], "intrinsics": '
    )
    rows = [[*row, x] for row, x in zip(ROTATION.tolist(), TRANSLATION.tolist(), strict=True)] + [[0, 0, 0, 1]]
    path = folder / "camchain.yaml"
    path.write_text(
        f'{{"cam0": {{{camera}[130.0, 131.0, 47.0, 32.5]}},\n'
        f' "cam1": {{{camera}[128.0, 127.0, 48.5, 31.0], "T_cn_cnm1": {rows}}}}}\n'
    )
    return path


def test_a_camchain_is_a_rig(tmp_path: Path) -> None:
    pytest.importorskip("yaml")
    calibrations = rc.Calibration.load_all(camchain(tmp_path))
    rig = rc.Rig.of_calibrations(calibrations, lens=LENS, exposure_time_s=0.01)
    rotation, translation = rig.relative_pose("cam1", "cam0")
    np.testing.assert_allclose(rotation, ROTATION, atol=1e-9)
    np.testing.assert_allclose(translation, TRANSLATION, atol=1e-9)
    # The rig somewhere in a scene: each camera projects a point where its calibration has it.
    pose = np.eye(4)
    pose[:3, :3] = [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]
    pose[:3, 3] = 1, 2, 3
    point_in_rig = np.array([0.2, 0.1, -2.0])
    point = pose[:3, :3] @ point_in_rig + pose[:3, 3]
    in_first = point_in_rig * (1, -1, -1)
    expected = {"cam0": in_first, "cam1": ROTATION @ in_first + TRANSLATION}
    for name, camera in rig.moved(pose).cameras.items():
        pixels, _ = calibrations[name].project([expected[name]])
        # Camera.project inverts a grid of positions, which is within some thousandths of a pixel.
        np.testing.assert_allclose(camera.project([point], through="chief"), pixels, atol=5e-3)
        assert camera.exposure_time_s == 0.01


def test_calibrations_without_poses_are_no_rig() -> None:
    K = [[130.0, 0, 48], [0, 130, 32], [0, 0, 1]]
    alone = rc.Calibration.opencv(K, [], (96, 64))
    with pytest.raises(rc.InputError, match="states no pose relative to the others"):
        rc.Rig.of_calibrations({"left": alone, "right": alone}, lens=LENS)
    with pytest.raises(rc.InputError, match="with one at least"):
        rc.Rig.of_calibrations({})
    with pytest.raises(rc.InputError, match=r"moved\(matrix\) poses the rig"):
        rc.Rig.of_calibrations({"left": alone}, lens=LENS, scene_from_camera=np.eye(4))
