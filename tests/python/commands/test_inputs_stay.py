"""No output of a command replaces a file that it is made from, whichever option names it."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from ..programs import PYTHON

pytestmark = pytest.mark.picture_files

SHOT = """
format = 1
scene = "quad.obj"
environment = "sky.png"
resolution = [16, 12]
exposure_time_s = 0.005
position_m = [0, 0, 2]
look_at_m = [0, 0, 0]
spp = 1
"""
WRITERS = {
    "sbatch": ("job", "make", "shot.toml", "-o", "new.job", "--sbatch"),
    "openjd": ("job", "make", "shot.toml", "-o", "new.job", "--openjd"),
    "compare": ("compare", "shot.toml", "--vary", "f_number=4,8", "--size", "16", "-o"),
    "render": ("render", "shot.toml", "--device", "cpu", "-o"),
    "convert": ("calibration", "convert", "camera.yml", "--to", "opencv"),
    "of a map": ("calibration", "convert", "stmap.exr", "--to", "stmap"),
    "calibrated": ("render", "calibrated.toml", "--lens", "wide-24mm", "--resolution", "8x4", "--device", "cpu", "-o"),
    "fit": ("lens", "fit", "rays.npz", "-o"),
    "undistort": ("calibration", "undistort", "camera.yml", "sky.png", "-o"),
}
CAMERA = """%YAML:1.0
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 20., 0., 8., 0., 20., 4., 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 1
   cols: 4
   dt: d
   data: [ -0.1, 0., 0., 0. ]
image_width: 16
image_height: 8
"""


@pytest.fixture(scope="module")
def inputs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("inputs")
    (folder / "quad.obj").write_text("mtllib quad.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nusemtl a\nf 1 2 3 4\n")
    (folder / "quad.mtl").write_text("newmtl a\nKd 0.5 0.5 0.5\n")
    words = ["render", "quad.obj", "-o", "sky.png", "--resolution", "16x8", "--spp", "1", "--quiet"]
    subprocess.run([*PYTHON, *words], cwd=folder, check=True)
    (folder / "shot.toml").write_text(SHOT)
    (folder / "camera.yml").write_text(CAMERA)
    made = ["calibration", "convert", "camera.yml", "stmap.exr", "--quiet"]
    subprocess.run([*PYTHON, *made], cwd=folder, check=True)
    (folder / "calibrated.toml").write_text(f'{SHOT}[calibration]\nfile = "camera.yml"\nvignetting = "flat.png"\n')
    shutil.copy(folder / "sky.png", folder / "flat.png")
    (folder / "rays.npz").write_bytes(b"refused before it is read")
    return folder


@pytest.mark.parametrize(
    ("writer", "target"),
    [(w, t) for w in ("sbatch", "openjd") for t in ("shot.toml", "./quad.obj", "quad.mtl", "link")]
    + [(w, t) for w in ("compare", "render", "undistort") for t in ("sky.png", "link.png")]
    + [("convert", "camera.yml"), ("of a map", "stmap.exr"), ("calibrated", "flat.png"), ("fit", "rays.npz")],
)
def test_inputs_stay(inputs: Path, tmp_path: Path, writer: str, target: str) -> None:
    folder = tmp_path / "work"
    shutil.copytree(inputs, folder)
    (folder / "link").symlink_to("quad.mtl")
    (folder / "link.png").symlink_to("sky.png")
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    done = subprocess.run([*PYTHON, *WRITERS[writer], target], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 2
    (line,) = (line for line in done.stderr.splitlines() if "error" in line)
    assert "is also an input of this command" in line
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before
