"""Saved calibrations: pixels after loading again, numbers that keep their last bit, refusals, and poses."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

SIZE = (640, 480)
K = np.array([[500.123456789012345, 0, 320.7], [0, 510.987654321, 241.3], [0, 0, 1]])
CENTRED = np.array([[500.1, 0, 319.5], [0, 500.1, 239.5], [0, 0, 1]])
RADIAL = rc.Calibration.opencv(K, [-0.11, 0.031, 0.0007, -0.0004], SIZE)
CAMERAS = {
    "pinhole": rc.Calibration.opencv(CENTRED, [], SIZE),
    "poly": rc.Calibration.opencv(CENTRED, [-0.09, 0.021, 0, 0], SIZE),
    "opencv4": RADIAL,
    "opencv5": rc.Calibration.opencv(K, [-0.11, 0.031, 0.0007, -0.0004, -0.002], SIZE),
    "opencv8": rc.Calibration.opencv(K, [0.31, -0.12, 0.0003, -0.0002, 0.011, 0.52, -0.08, 0.003], SIZE),
    "opencv14": rc.Calibration.opencv(
        K, [-0.2, 0.05, 3e-4, 5e-4, -0.006, 0.01, 0.002, -4e-4, 1e-3, -4e-4, -9e-4, 3e-4, 0.02, -0.015], SIZE
    ),
    "fisheye": rc.Calibration.opencv_fisheye(K, [-0.021, 0.0098, -0.0087, 0.0016], SIZE),
}
# Formats, file names, and the cameras above that they hold.
HELD = {
    "opencv": (("a.yml", "a.xml", "a.json"), "pinhole poly opencv4 opencv5 opencv8 opencv14 fisheye"),
    "ros": (("camera_info.yaml",), "pinhole poly opencv4 opencv5 opencv8 opencv14 fisheye"),
    "kalibr": (("camchain.yaml",), "pinhole poly opencv4 fisheye"),
    "basalt": (("calibration.json",), "pinhole poly opencv4 opencv5 opencv8 fisheye"),
    "colmap": (("cameras.txt",), "pinhole poly opencv4 opencv5 opencv8 fisheye"),
    "colmap-binary": (("cameras.bin",), "pinhole poly opencv4 opencv5 opencv8 fisheye"),
    "nerfstudio": (("transforms.json",), "pinhole poly opencv4 opencv5 fisheye"),
    "metashape": (("metashape.xml",), "pinhole poly opencv4 opencv5 fisheye"),
    "matlab": (("cameraParameters.json",), "pinhole poly opencv4 opencv5"),
    "kitti": (("calib.txt",), "pinhole poly opencv4 opencv5"),
    "nuscenes": (("calibrated_sensor.json",), "pinhole"),
    "carla": (("carla.json",), "pinhole"),
    "ncore": (("ncore.json",), "fisheye"),
    "rig": (("rig.json",), "fisheye"),
    "camodocal": (("camodocal.yaml",), "pinhole poly opencv4 fisheye"),
    "lensfun": (("lensfun.xml",), "pinhole poly"),
    "lcp": (("a.lcp",), "pinhole poly opencv4 opencv5"),
    "3de4": (("a.nk",), "pinhole"),
    "omniverse": (("a.usda",), "pinhole poly opencv4 opencv5 opencv8 fisheye"),
}
WITHOUT_SIZE = ("lensfun", "nuscenes", "3de4")


def rays(camera: rc.Calibration) -> np.ndarray:
    pixels = np.random.default_rng(5).random((200, 2)) * camera.size
    return camera.ray(pixels)[0]


@pytest.mark.parametrize("name", HELD)
def test_a_saved_camera_projects_the_same(tmp_path: Path, name: str) -> None:
    """Numbers are written with all digits, so that only the pixel's origin is rounded: 1e-9 pixels is far above it."""
    files, held = HELD[name]
    for kind in held.split():
        for file in files:
            camera = CAMERAS[kind]
            camera.save(tmp_path / file, name)
            size = {"size": SIZE} if name in WITHOUT_SIZE else {}
            found = rc.Calibration.load(tmp_path / file, **size)
            assert found.format == name.removesuffix("-binary")
            points = rays(camera)
            pixels, status = found.project(points)
            assert np.abs(pixels - camera.project(points)[0]).max() < 1e-9
            assert (status == rc.PointStatus.OK).all()


@pytest.mark.parametrize("name", HELD)
def test_what_a_format_cannot_hold_is_refused_with_formats_that_can(tmp_path: Path, name: str) -> None:
    for kind in set(CAMERAS) - set(HELD[name][1].split()) - ({"opencv14"} if name == "omniverse" else set()):
        file = tmp_path / HELD[name][0][0]
        with pytest.raises(rc.InputError, match=f"the format {name} .*formats that hold this camera: .*opencv"):
            CAMERAS[kind].save(file, name)
        assert not file.exists()


FILES = {
    "camera_info.yaml": """image_width: 640
image_height: 480
camera_name: left
camera_matrix: {rows: 3, cols: 3, data: [500.12345678901234, 0, 320.70000000000005, 0, 510.1, 0.1, 0, 0, 1]}
distortion_model: plumb_bob
distortion_coefficients: {rows: 1, cols: 5, data: [-0.1, 1.0e-05, 0, 0, 0.30000000000000004]}
projection_matrix: {rows: 3, cols: 4, data: [480.1, 0, 320, -53.1, 0, 480.1, 240, 0, 0, 0, 1, 0]}
""",
    "chain.yaml": """cam0: {camera_model: ds, distortion_coeffs: [], distortion_model: none, resolution: [640, 480],
  intrinsics: [-0.20000000000000004, 0.6, 300.1, 300.30000000000007, 511.7, 0.1]}
""",
    "transforms.json": json.dumps(
        {"fl_x": 500.1, "fl_y": 1e3 / 3, "cx": 511.7, "cy": 0.1, "w": 640, "h": 480, "k4": 0.1}
    ),
    "survey.xml": """<calibration><projection>frame</projection><width>640</width><height>480</height>
<f>510.30000000000007</f><cx>0.1</cx><cy>-0.7</cy><b1>-0.30000000000000004</b1><k1>-0.1</k1></calibration>""",
    "cameras.txt": "3 OPENCV 640 480 500.12345678901234 510 320.1 0.1 -0.1 0.30000000000000004 0 0\n",
    "calib.txt": "S_02: 640 480\nK_02: 500.1 0 511.7 0 510 0.1 0 0 1\nD_02: -0.1 0.2 0 0 1e-3\n",
    "rig.json": json.dumps(
        {
            "rig": {
                "sensors": [
                    {
                        "name": "camera:front",
                        "protocol": "camera.gmsl",
                        "nominalSensor2Rig_FLU": {"roll-pitch-yaw": [0.1, 1.2, -3.3], "t": [1.9, 0.1, 1.4]},
                        "properties": {
                            "Model": "ftheta",
                            "width": "640",
                            "height": "480",
                            "cx": "319.7",
                            "cy": "0.1",
                            "polynomial": "0 0.0030000000000000005 1e-8",
                            "polynomial-type": "pixeldistance-to-angle",
                        },
                    }
                ]
            }
        }
    ),
}


@pytest.mark.parametrize("name", FILES)
def test_an_unchanged_camera_keeps_its_numbers_to_the_last_bit(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text(FILES[name])
    first = rc.Calibration.load(tmp_path / name)
    (tmp_path / "again").mkdir()
    first.save(tmp_path / "again" / name)
    again = rc.Calibration.load(tmp_path / "again" / name)
    assert first.format == again.format
    assert first.file_values == again.file_values
    pixels = first.project(rays(first))[0], again.project(rays(first))[0]
    assert np.array_equal(*pixels, equal_nan=True)  # a corner may have no ray
    for key, transform in first.extrinsics.items():
        assert np.array_equal(transform, again.extrinsics[key])


def test_an_attribute_of_another_model_is_not_written_again(tmp_path: Path) -> None:
    """The fisheye model has k1 to k4. It took the empty value of k5 for one of its numbers."""
    model = "omni:lensdistortion:opencvFisheye"
    numbers = "".join(f"float {model}:{key} = 500\n" for key in ("fx", "fy", "cx", "cy"))
    (tmp_path / "a.usda").write_text(
        f'#usda 1.0\ndef Camera "a"\n{{\ntoken omni:lensdistortion:model = "opencvFisheye"\n'
        f'{numbers}int2 {model}:imageSize = (640, 480)\nstring {model}:k5 = ""\n}}\n'
    )
    rc.Calibration.load(tmp_path / "a.usda").save(tmp_path / "b.usda")
    assert "k5" not in (tmp_path / "b.usda").read_text()


def test_a_changed_camera_is_not_written_with_the_numbers_of_its_file(tmp_path: Path) -> None:
    (tmp_path / "a.yaml").write_text(FILES["camera_info.yaml"])
    half = rc.Calibration.load(tmp_path / "a.yaml").resized((320, 240))
    half.save(tmp_path / "half.yaml")
    found = rc.Calibration.load(tmp_path / "half.yaml")
    assert found.size == (320, 240)
    assert np.abs(found.project(rays(half))[0] - half.project(rays(half))[0]).max() < 1e-9


def transform(angle: float, translation: list[float]) -> np.ndarray:
    found = np.eye(4)
    found[:3, :3] = [[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]]
    found[:3, 3] = translation
    return found


@pytest.mark.parametrize(
    ("file", "format"),
    [("camchain.yaml", "kalibr"), ("calibration.json", "basalt"), ("a.yml", "opencv"), ("stereoParams.json", "matlab"),
     ("calib.txt", "kitti")],
)  # fmt: skip
def test_cameras_are_saved_with_their_relative_pose(tmp_path: Path, file: str, format: str) -> None:
    from dataclasses import replace

    pose = transform(0.1, [-0.12, 0.01, 0.02])
    pair = {"cam0": RADIAL, "cam1": replace(RADIAL, extrinsics={"camera_from_previous": pose})}
    rc.Calibration.save_all(tmp_path / file, pair, format)
    first, second = rc.Calibration.load_all(tmp_path / file).values()
    key = next((k for k in second.extrinsics if k in first.extrinsics), None)
    found = (
        second.extrinsics[key] @ np.linalg.inv(first.extrinsics[key])
        if key
        else second.extrinsics["camera_from_previous"]
    )
    assert np.abs(found - pose).max() < 1e-15 * 16
    with pytest.raises(rc.InputError, match="states no pose"):
        rc.Calibration.save_all(tmp_path / file, {"cam0": RADIAL, "cam1": RADIAL}, format)


def test_the_vehicle_pose_of_rig_json_is_forward_left_up(tmp_path: Path) -> None:
    """A camera that looks along the vehicle's x axis from (1.9, 0, 1.4) sees a point ahead on its axis."""
    rig = json.loads(FILES["rig.json"])
    rig["rig"]["sensors"][0]["nominalSensor2Rig_FLU"] = {"roll-pitch-yaw": [0, 0, 90], "t": [1.9, 0, 1.4]}
    (tmp_path / "rig.json").write_text(json.dumps(rig))
    found = rc.Calibration.load(tmp_path / "rig.json").extrinsics["camera_from_rig"]
    assert found @ [1.9, 5, 1.4, 1] == pytest.approx([0, 0, 5, 1])  # yaw 90 degrees: towards the vehicle's left
    assert found @ [2.9, 5, 2.4, 1] == pytest.approx([1, -1, 5, 1])  # forwards is right, up is up


def test_poses_of_pictures_move_between_programs(tmp_path: Path) -> None:
    """nerfstudio's camera looks along -z with y up; COLMAP states the world in camera axes."""
    pose = transform(0.3, [0.31, 1.42, 2.05])
    frames = [{"file_path": "images/a.png", "transform_matrix": pose.tolist()}]
    values = {"fl_x": 500, "fl_y": 510, "cx": 320.5, "cy": 240.5, "w": 640, "h": 480, "frames": frames}
    (tmp_path / "transforms.json").write_text(json.dumps(values))
    camera = rc.Calibration.load(tmp_path / "transforms.json")
    ahead = camera.poses["images/a.png"] @ [0, 0, 1, 1]
    assert ahead == pytest.approx(pose @ [0, 0, -1, 1])
    for name in ("cameras.txt", "cameras.bin", "cameras.xml", "again.json"):
        format = {"again.json": "nerfstudio", "cameras.xml": "metashape"}.get(name)
        camera.save(tmp_path / name, format)
        found = rc.Calibration.load(tmp_path / name).poses
        assert list(found) == ["images/a.png"]
        assert found["images/a.png"] == pytest.approx(camera.poses["images/a.png"], abs=1e-15)


def test_the_format_follows_from_the_name(tmp_path: Path) -> None:
    for name, format in {
        "camera_info.yaml": "ros",
        "camchain.yaml": "kalibr",
        "b.yml": "opencv",
        "c.txt": "colmap",
    }.items():
        RADIAL.save(tmp_path / name)
        assert rc.Calibration.load(tmp_path / name).format == format
    with pytest.raises(rc.InputError, match="no format has such names"):
        RADIAL.save(tmp_path / "a.pdf")
    with pytest.raises(rc.InputError, match='the format "magic" is unknown'):
        RADIAL.save(tmp_path / "a.yaml", "magic")
    with pytest.raises(rc.InputError, match="holds one camera"):
        rc.Calibration.save_all(tmp_path / "camera_info.yaml", {"a": RADIAL, "b": RADIAL})


def test_opencv_reads_the_files(tmp_path: Path) -> None:
    cv2 = pytest.importorskip("cv2")
    for name in ("a.yml", "a.xml", "a.json"):
        RADIAL.save(tmp_path / name)
        storage = cv2.FileStorage(str(tmp_path / name), cv2.FILE_STORAGE_READ)
        matrix, D = storage.getNode("camera_matrix").mat(), storage.getNode("distortion_coefficients").mat()
        storage.release()
        points = rays(RADIAL)
        expected = cv2.projectPoints(points.reshape(-1, 1, 3), np.zeros(3), np.zeros(3), matrix, D)[0].reshape(-1, 2)
        assert np.abs(RADIAL.project(points)[0] - 0.5 - expected).max() < 1e-9


def test_a_lens_becomes_a_calibration(tmp_path: Path) -> None:
    found = rc.Lens.load("tessar-50mm").with_rings(focus_m=2.0, f_number=5.6).calibration(resolution=(300, 200))
    assert found.size == (300, 200)
    assert found.film_mm == (36, 24)
    assert 0 < found.rms_px <= found.max_px < 0.05
    points = rays(found)
    camera = found.fit.camera
    rotation, translation = camera.world_to_camera
    pixels = camera.project((points * found.fit.distance_m - translation) @ rotation)
    assert np.nanmax(np.linalg.norm(found.project(points)[0] - pixels, axis=1)) < 0.05
    assert found.resized((150, 100)).max_px == pytest.approx(found.max_px / 2)
    found.save(tmp_path / "camera_info.yaml")
    again = rc.Calibration.load(tmp_path / "camera_info.yaml")
    assert np.abs(again.project(points)[0] - found.project(points)[0]).max() < 1e-9


def test_commands_show_and_convert(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from realcam.cli.calibration import convert, show

    RADIAL.save(tmp_path / "a.yml")
    convert(tmp_path / "a.yml", tmp_path / "camera_info.yaml", quiet=True)
    show(tmp_path / "camera_info.yaml")
    printed = capsys.readouterr().out
    assert "plumb_bob" in printed and "640 x 480 pixels" in printed


def test_names_of_usd_prims_are_unique(tmp_path: Path) -> None:
    cameras = dict.fromkeys(("a__2", "a-", "a.", "a_", "2"), CAMERAS["pinhole"])
    rc.Calibration.save_all(tmp_path / "a.usda", cameras)
    assert len(rc.Calibration.load_all(tmp_path / "a.usda")) == 5


def test_binary_usd_files_are_read(tmp_path: Path) -> None:
    """Their attributes are of 32 bits, which move pixels by some 1e-5 of them."""
    sdf = pytest.importorskip("pxr.Sdf")
    CAMERAS["opencv8"].save(tmp_path / "a.usda")
    assert sdf.Layer.FindOrOpen(str(tmp_path / "a.usda")).Export(str(tmp_path / "a.usdc"))
    found = rc.Calibration.load(tmp_path / "a.usdc")
    points = rays(found)
    assert np.abs(found.project(points)[0] - CAMERAS["opencv8"].project(points)[0]).max() < 2e-4
    (tmp_path / "bad.usdc").write_bytes(b"PXR-USDC" + bytes(200))
    with pytest.raises(rc.CalibrationFileError, match="is a damaged USD file"):
        rc.Calibration.load(tmp_path / "bad.usdc")
