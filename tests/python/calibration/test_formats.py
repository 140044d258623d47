"""Files of each format, with numbers of their own and pixels from closed forms; and files with mistakes."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

POINT = np.array([[0.3, -0.2, 1.0]])
r2 = 0.13
CAMERA_INFO = """image_width: 640
image_height: 480
camera_matrix: {rows: 3, cols: 3, data: [500, 0, 320, 0, 510, 240, 0, 0, 1]}
distortion_model: plumb_bob
distortion_coefficients: {rows: 1, cols: 5, data: [-0.1, 0.02, 0, 0, 0]}
"""
OPENCV_YML = """%YAML:1.0
---
image_width: 640
image_height: 480
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 500., 0., 320., 0., 510., 240., 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ -1.0e-01, 0.02, 0., 0., 0. ]
"""
OPENCV_XML = """<?xml version="1.0"?><opencv_storage><image_width>640</image_width><image_height>480</image_height>
<camera_matrix type_id="opencv-matrix"><rows>3</rows><cols>3</cols><dt>d</dt><data>500. 0. 320. 0. 510. 240. 0. 0. 1.
</data></camera_matrix><distortion_coefficients type_id="opencv-matrix"><rows>5</rows><cols>1</cols><dt>d</dt>
<data>-0.1 0.02 0. 0. 0.</data></distortion_coefficients></opencv_storage>"""
KALIBR = """cam0:
  camera_model: pinhole
  distortion_coeffs: [-0.1, 0.02, 0, 0]
  distortion_model: radtan
  intrinsics: [500, 510, 320, 240]
  resolution: [640, 480]
cam1:
  T_cn_cnm1: [[1, 0, 0, -0.1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
  camera_model: ds
  distortion_coeffs: []
  distortion_model: none
  intrinsics: [-0.2, 0.6, 300, 300, 320, 240]
  resolution: [640, 480]
"""
MATLAB = json.dumps(
    {
        "RadialDistortion": [-0.1, 0.02],
        "TangentialDistortion": [0, 0],
        "ImageSize": [480, 640],
        "IntrinsicMatrix": [[500, 0, 0], [0, 510, 0], [321, 241, 1]],
    }
)
NERF = json.dumps(
    {"fl_x": 500, "fl_y": 510, "cx": 320.5, "cy": 240.5, "w": 640, "h": 480, "k1": -0.1, "k2": 0.02, "frames": []}
)
METASHAPE = """<calibration><projection>frame</projection><width>640</width><height>480</height><f>510</f><cx>0.5</cx>
<cy>0.5</cy><b1>-10</b1><k1>-0.1</k1><k2>0.02</k2></calibration>"""
LCP = """<x:xmpmeta xmlns:x="adobe:ns:meta/" xmlns:rdf="rdf" xmlns:stCamera="c" xmlns:photoshop="p"><rdf:RDF>
<photoshop:CameraProfiles><rdf:Seq><rdf:li><stCamera:Lens>L</stCamera:Lens><stCamera:ImageWidth>640</stCamera:ImageWidth>
<stCamera:ImageLength>480</stCamera:ImageLength><stCamera:PerspectiveModel>
<stCamera:FocalLengthX>0.78125</stCamera:FocalLengthX><stCamera:FocalLengthY>0.796875</stCamera:FocalLengthY>
<stCamera:ImageXCenter>0.50078125</stCamera:ImageXCenter><stCamera:ImageYCenter>0.501041666666666667</stCamera:ImageYCenter>
<stCamera:RadialDistortParam1>-0.1</stCamera:RadialDistortParam1>
<stCamera:RadialDistortParam2>0.02</stCamera:RadialDistortParam2></stCamera:PerspectiveModel></rdf:li></rdf:Seq>
</photoshop:CameraProfiles></rdf:RDF></x:xmpmeta>"""
COLMAP = "# Camera list\n1 OPENCV 640 480 500 510 320.5 240.5 -0.1 0.02 0 0\n"
KITTI = """S_02: 640 480
K_02: 500 0 320 0 510 240 0 0 1
D_02: -0.1 0.02 0 0 0
"""
CAMODOCAL = """%YAML:1.0
---
model_type: PINHOLE
camera_name: front
image_width: 640
image_height: 480
distortion_parameters: {k1: -0.1, k2: 0.02, p1: 0, p2: 0}
projection_parameters: {fx: 500, fy: 510, cx: 320, cy: 240}
"""
USDA = """#usda 1.0
def Camera "Front"
{
    token omni:lensdistortion:model = "opencvPinhole"
    float omni:lensdistortion:opencvPinhole:fx = 500
    float omni:lensdistortion:opencvPinhole:fy = 510
    float omni:lensdistortion:opencvPinhole:cx = 320.5
    float omni:lensdistortion:opencvPinhole:cy = 240.5
    float omni:lensdistortion:opencvPinhole:k1 = -0.1
    float omni:lensdistortion:opencvPinhole:k2 = 0.02
    int2 omni:lensdistortion:opencvPinhole:imageSize = (640, 480)
}
"""
# The same camera in each format, and its name in the file.
SAME = {
    "camera_info.yaml": (CAMERA_INFO, None, "ros"),
    "camera.yml": (OPENCV_YML, None, "opencv"),
    "camera.xml": (OPENCV_XML, None, "opencv"),
    "camchain.yaml": (KALIBR, "cam0", "kalibr"),
    "matlab.json": (MATLAB, None, "matlab"),
    "transforms.json": (NERF, None, "nerfstudio"),
    "metashape.xml": (METASHAPE, None, "metashape"),
    "profile.lcp": (LCP, None, "lcp"),
    "cameras.txt": (COLMAP, "1", "colmap"),
    "calib.txt": (KITTI, "02", "kitti"),
    "camodocal.yaml": (CAMODOCAL, None, "camodocal"),
    "camera.usda": (USDA, "Front", "omniverse"),
}


def written(folder: Path, name: str, text: str | bytes) -> Path:
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


@pytest.mark.parametrize("name", SAME)
def test_one_camera_is_the_same_in_all_formats(tmp_path: Path, name: str) -> None:
    text, camera, format_name = SAME[name]
    found = rc.Calibration.load(written(tmp_path, name, text), camera)
    factor = 1 - 0.1 * r2 + 0.02 * r2**2
    assert found.format == format_name
    assert found.size == (640, 480)
    assert found.project(POINT)[0][0] == pytest.approx([320.5 + 150 * factor, 240.5 - 102 * factor], abs=1e-9)
    assert found.ray(found.project(POINT)[0])[0] * np.linalg.norm(POINT) == pytest.approx(POINT, abs=1e-9)


def test_colmap_binary(tmp_path: Path) -> None:
    content = struct.pack("<QiiQQ4d", 1, 7, 1, 640, 480, 500, 510, 320, 240)
    found = rc.Calibration.load(written(tmp_path, "cameras.bin", content))
    assert found.name == "7"
    assert found.project(POINT)[0][0] == pytest.approx([470, 138])
    with pytest.raises(rc.CalibrationFileError, match="ends before"):
        rc.Calibration.load(written(tmp_path, "cameras.bin", content[:-8]))


def test_blank_lines_between_images_of_colmap(tmp_path: Path) -> None:
    """An image without points is followed by an empty line; further blank lines and comments do not count."""
    images = "# IMAGE_ID ...\n\n1 1 0 0 0 0 0 3 1 a.png\n\n\n# next\n2 1 0 0 0 0 0 4 1 my b.png\n5 6 -1\n\n"
    written(tmp_path, "images.txt", images)
    found = rc.Calibration.load(written(tmp_path, "cameras.txt", COLMAP))
    assert [(name, pose[2, 3]) for name, pose in found.poses.items()] == [("a.png", -3), ("my b.png", -4)]
    found.save(tmp_path / "cameras.bin")
    assert list(rc.Calibration.load(tmp_path / "cameras.bin").poses) == ["a.png", "my b.png"]
    with (tmp_path / "images.bin").open("ab") as file:
        file.write(b"rest")
    with pytest.raises(rc.CalibrationFileError, match="bytes for its images"):
        rc.Calibration.load(tmp_path / "cameras.bin")


def test_double_sphere_and_extrinsics_of_kalibr(tmp_path: Path) -> None:
    found = rc.Calibration.load(written(tmp_path, "chain.yaml", KALIBR), "cam1")
    d1 = np.linalg.norm(POINT)
    z = 1 - 0.2 * d1
    scale = 300 / (0.6 * np.sqrt(r2 + z**2) + 0.4 * z)
    assert found.project(POINT)[0][0] == pytest.approx([320.5 + 0.3 * scale, 240.5 - 0.2 * scale], abs=1e-9)
    assert found.extrinsics["camera_from_previous"][0, 3] == -0.1


def test_f_theta_uses_the_reference_polynomial(tmp_path: Path) -> None:
    values = {
        "resolution": [640, 480],
        "principal_point": [320, 240],
        "reference_poly": "PIXELDIST_TO_ANGLE",
        "pixeldist_to_angle_poly": [0, 0.003, 1e-7],
        "angle_to_pixeldist_poly": [0, 1.0],
        "max_angle": 1.2,
    }
    found = rc.Calibration.load(written(tmp_path, "camera.json", json.dumps(values)))
    angle = 0.003 * 200 + 1e-7 * 200**2
    pixels, status = found.project([[np.sin(angle), 0, np.cos(angle)], [1, 0, 0]])
    assert pixels[0] == pytest.approx([520.5, 240.5], abs=1e-9)
    assert status[1] == rc.PointStatus.NO_PROJECTION


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.yaml", CAMERA_INFO.replace("image_width: 640", ""), "image_width: expected"),
        ("a.yaml", CAMERA_INFO.replace("640", "0"), "image_width: expected whole numbers"),
        ("a.yaml", CAMERA_INFO.replace("510", ".nan"), "camera_matrix: expected 9 finite numbers"),
        ("a.yaml", CAMERA_INFO.replace("plumb_bob", "magic"), "distortion_model: expected one of plumb_bob"),
        ("a.yaml", CAMERA_INFO.replace("-0.1, ", ""), "distortion_coefficients: expected"),
        ("a.yaml", "a: &a [1]\nb: *a\ncamera_matrix: *a\n", "line 2: an alias"),
        ("a.yaml", KALIBR, 'holds 2 cameras; camera must be one of "cam0", "cam1"'),
        ("a.json", "{", "line 1"),
        ("a.json", "[" * 100000, "nested too deeply"),
        ("a.json", '{"hello": 1}', "no known calibration format"),
        ("a.xml", '<!DOCTYPE a [<!ENTITY e "x">]><opencv_storage>&e;</opencv_storage>', "declares an entity"),
        ("a.xml", "<a>" * 100, "nested elements"),
        ("cameras.txt", "1 MAGIC 640 480 500 1 1\n", "line 1: unknown model"),
        ("cameras.txt", "1 PINHOLE 640 480 500 320 240\n", "expected 4 finite numbers"),
        ("a.json", json.dumps({"image_size_x": 64, "image_size_y": 48, "fov": 90}), "lens_k: expected 0"),
        ("a.yml", "", "is empty"),
        ("mark.yml", "\ufeff", "is empty"),
    ],
)
def test_mistakes_are_told_in_one_line(tmp_path: Path, name: str, text: str, message: str) -> None:
    path = written(tmp_path, name, text)
    with pytest.raises(rc.CalibrationFileError) as error:
        rc.Calibration.load(path)
    assert message in str(error.value)
    assert str(error.value).startswith(str(path))
    assert "\n" not in str(error.value)


def test_huge_files_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "huge.json"
    with path.open("wb") as file:
        file.truncate(65 << 20)
    with pytest.raises(rc.CalibrationFileError, match="larger than 64 MiB"):
        rc.Calibration.load(path)


def test_textures_outside_the_folder_are_refused(tmp_path: Path) -> None:
    prefix = "omni:lensdistortion:"
    lines = ['#usda 1.0\ndef Camera "C"\n{', f'token {prefix}model = "lut"', f"float {prefix}lut:nominalWidth = 64"]
    lines += [f"float {prefix}lut:nominalHeight = 48", f"asset {prefix}lut:rayEnterDirectionTexture = @../a.exr@"]
    lines += [f"asset {prefix}lut:rayExitPositionTexture = @b.exr@", "}"]
    with pytest.raises(rc.CalibrationFileError, match="must lie in the folder"):
        rc.Calibration.load(written(tmp_path, "camera.usda", "\n".join(lines)))


def test_a_size_that_the_file_contradicts_is_refused(tmp_path: Path) -> None:
    with pytest.raises(rc.InputError, match="resized"):
        rc.Calibration.load(written(tmp_path, "a.yaml", CAMERA_INFO), size=(320, 240))


def test_3de4_distorts_by_the_inverse_of_its_polynomial(tmp_path: Path) -> None:
    text = """LD_3DE4_Radial_Standard_Degree_4 {
 tde4_focal_length_cm 2
 tde4_filmback_width_cm 2.4
 tde4_filmback_height_cm 1.8
 Distortion_Degree_2 0.1
 name Lens1
}
"""
    found = rc.Calibration.load(written(tmp_path, "lens.nk", text), size=(640, 480))
    distorted = 0.5 * (1 + 0.1 * 0.25)  # of a point at half of the half diagonal, 1.5 cm
    pixels, _ = found.project([[0, -distorted * 1.5 / 2, 1]])
    assert pixels[0] == pytest.approx([320, 240 - 0.75 / 1.8 * 480], abs=1e-9)
