"""The programs of examples/ run, and do what they say."""

from __future__ import annotations

import base64
import importlib.util
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
import realcam as rc

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"


@pytest.fixture
def mitsuba_rays() -> ModuleType:
    """examples/mitsuba_rays.py, where Mitsuba can run it."""
    pytest.importorskip("mitsuba", reason="Mitsuba 3 comes with the bench extra")
    drjit = pytest.importorskip("drjit")
    if not any(map(drjit.has_backend, (drjit.JitBackend.LLVM, drjit.JitBackend.CUDA))):
        pytest.skip("Mitsuba needs LLVM or a GPU")
    path = EXAMPLES / "mitsuba_rays.py"
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_headlights_glow_in_fog(tmp_path: Path) -> None:
    picture = tmp_path / "fog.png"
    command = [sys.executable, EXAMPLES / "headlights.py", picture, "--width", "96", "--spp", "4"]
    subprocess.run([str(part) for part in command], check=True, capture_output=True, timeout=300)
    values = rc.read_environment(picture).sum(axis=2)
    # The beams go from the lamps, at the right edge, to the left; the upper edge is dark.
    assert values.shape == (64, 96)
    assert values[28:40, 60:92].mean() > 3 * values[:8].mean() > 0


def test_every_example_has_a_test() -> None:
    here = Path(__file__).read_text(encoding="utf-8")
    names = [path.stem for path in EXAMPLES.glob("*.py")]
    assert names and all(f"def test_{name}" in here for name in names)


def test_mitsuba_rays_writes_a_picture(mitsuba_rays: ModuleType, tmp_path: Path) -> None:
    picture = tmp_path / "box.png"
    command = [sys.executable, EXAMPLES / "mitsuba_rays.py", picture, "--spp", "1"]
    subprocess.run([str(part) for part in command], check=True, capture_output=True, timeout=300)
    values = np.array(mitsuba_rays.mi.Bitmap(str(picture)))
    assert values.shape == (480, 480, 3)
    # The left wall is red and the right one green, and neither is too dark or too bright to be seen.
    left, right = values[200:300, 20:40].mean(axis=(0, 1)), values[200:300, -40:-20].mean(axis=(0, 1))
    assert 230 > left[0] > 2 * left[1] and left[0] > 40
    assert 230 > right[1] > 1.5 * right[0] and right[1] > 40


def test_mitsuba_rays_exposes_the_film_as_render_does(mitsuba_rays: ModuleType) -> None:
    """An even sky of Mitsuba's and one of realcam's, by the same rays: vignetting, exposure and the factor of pi."""
    mi = mitsuba_rays.mi
    camera = rc.Camera(rc.Lens.load("tessar-50mm"), film=rc.Film(36, 24, (48, 32)), exposure_time_s=1 / 50)
    sky = {"type": "constant", "radiance": {"type": "rgb", "value": [100.0, 200.0, 300.0]}}
    scene = mi.load_dict({"type": "scene", "sky": sky})
    seen = mitsuba_rays.photograph(scene, mi.load_dict({"type": "path"}), camera, spp=4)
    speck = rc.Scene.from_arrays([[0, 0, 1e5], [1e-3, 0, 1e5], [0, 1e-3, 1e5]], [[0, 1, 2]])
    ours = rc.render(
        speck.with_environment((100, 200, 300)), camera, effects=(), spp=4, max_bounces=0, device="cpu"
    ).pixels
    # Four products and sums of float32 a pixel.
    np.testing.assert_allclose(seen, ours, rtol=1e-5)


@pytest.mark.picture_files
def test_dataset_reads_what_the_command_makes(tmp_path: Path) -> None:
    recipe = tmp_path / "recipe.toml"
    recipe.write_text("format = 1\ncount = 3\nsize = [60, 40]\nspp = 2\nshard_size = 2\n")
    make = [sys.executable, "-m", "realcam", "dataset", recipe, "-o", tmp_path / "out", "--workers", "1"]
    read = [sys.executable, EXAMPLES / "dataset.py", tmp_path / "out", "--batch", "2"]
    for command in (make, read):
        done = subprocess.run(
            [str(word) for word in command], check=True, capture_output=True, text=True, timeout=300
        ).stdout
    lines = [line for line in done.splitlines() if line.startswith("(")]
    assert [line.split(", nearest")[0] for line in lines] == ["(2, 3, 40, 60)", "(1, 3, 40, 60)"]
    assert all(0 < int(line.split()[-2].rstrip("%")) < 100 for line in lines)


def test_paper_page_is_made_by_one_command(tmp_path: Path) -> None:
    def run(*words: object) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, EXAMPLES / "paper_page.py", *words]
        return subprocess.run(
            [str(word) for word in command], check=False, capture_output=True, text=True, timeout=300, cwd=tmp_path
        )

    made = run("--only", "snell", "-o", "page.html")
    assert made.returncode == 0 and "wrote page.html" in made.stdout, made.stderr
    assert "degrees traced" in (tmp_path / "page.html").read_text(encoding="utf-8")
    for words, message in ((["--only", "snel"], "snell"), (["--output", "page.pdf"], "expected .html")):
        refused = run(*words)
        assert refused.returncode == 2 and message in refused.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["page.html"]


def test_copies_writes_a_sheet(tmp_path: Path) -> None:
    sheet = tmp_path / "copies.png"
    words = f"{sheet} --copies 2 --columns 2 --pixels 8 --spp 1 --device cpu --grade precision"
    command = [sys.executable, str(EXAMPLES / "copies.py"), *words.split()]
    told = subprocess.run(command, check=True, capture_output=True, text=True, timeout=300).stdout
    assert "has the softest corner" in told
    assert sheet.stat().st_size > 1000


def test_film_goes_from_the_lamps_to_the_chessmen() -> None:
    shot = rc.Shot.load(EXAMPLES / "film.toml", device="cpu")
    begin, end = (shot.camera_at(time_s).lens for time_s in (0, 5))
    assert (begin.focus_distance_m, end.focus_distance_m) == pytest.approx((3.5, 2.0))
    assert end.focused(float("inf")).first_order().effective_focal_length_mm == pytest.approx(135)
    assert shot.shake is not None


GALLERY = EXAMPLES / "gallery"


def stand_in(file: Path) -> None:
    """Writes a small file of the same format in place of one that the gallery's page tells how to get."""
    oiio = pytest.importorskip("OpenImageIO")
    file.parent.mkdir(parents=True, exist_ok=True)
    if file.suffix == ".usd":
        file.write_text('#usda 1.0\n(metersPerUnit = 1)\ndef Cube "Box" {\n double size = 0.05\n}\n')
    elif file.suffix == ".gltf":
        triangle = base64.b64encode(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], "<f4").tobytes()).decode()
        attributes = {"type": "VEC3", "componentType": 5126, "count": 3, "min": [0, 0, 0], "max": [1, 1, 0]}
        model = {
            "asset": {"version": "2.0"},
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "accessors": [{"bufferView": 0, **attributes}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "buffers": [{"byteLength": 36, "uri": f"data:application/octet-stream;base64,{triangle}"}],
        }
        file.write_text(json.dumps(model))
    elif file.suffix == ".glb":
        shutil.copy(EXAMPLES.parent / "scenes" / "demo.glb", file)
    else:
        picture = oiio.ImageBuf(oiio.ImageSpec(4, 2, 3, "half" if file.suffix == ".exr" else "uint8"))
        oiio.ImageBufAlgo.fill(picture, (0.5, 0.5, 0.5))
        assert picture.write(str(file))


@pytest.mark.picture_files
@pytest.mark.parametrize("shot", sorted(GALLERY.glob("*.toml")), ids=lambda shot: shot.stem)
def test_shots_of_the_gallery_can_be_taken(shot: Path, tmp_path: Path) -> None:
    text = shot.read_text(encoding="utf-8")
    for package in ["pxr"] * (".usd" in text) + ["PyOpenColorIO"] * ("ocio" in text):
        pytest.importorskip(package)
    folder = shutil.copytree(GALLERY, tmp_path / "gallery", ignore=shutil.ignore_patterns("assets"))
    for name in re.findall(r'"(assets/[^"]+)"', text):
        stand_in(folder / name)
    image = rc.Shot.load(folder / shot.name, resolution=(12, 8), spp=1, device="cpu").render()
    assert np.isfinite(image.pixels).all() and image.pixels.max() > 0


def test_the_gallery_shows_each_of_its_shots() -> None:
    page = (EXAMPLES.parent / "docs" / "gallery.md").read_text(encoding="utf-8")
    names = [shot.stem for shot in GALLERY.glob("*.toml")]
    assert len(names) == 6
    for name in names:
        assert f"realcam render examples/gallery/{name}.toml -o {name}.jpg --denoise" in page
        assert f"](images/gallery-{name}.jpg)" in page
        assert (EXAMPLES.parent / "docs" / "images" / f"gallery-{name}.jpg").stat().st_size < 150_000


@pytest.mark.slow
def test_torch_focus_finds_both_rings() -> None:
    pytest.importorskip("torch", reason="torch is an extra")
    command = [sys.executable, str(EXAMPLES / "torch_focus.py")]
    printed = subprocess.run(command, check=True, capture_output=True, text=True, timeout=300).stdout
    focus, f_number = re.search(r"focus ([\d.]+) m, f/([\d.]+)\n$", printed).groups()
    # The start is 0.6 m and 0.8 away.
    assert abs(float(focus) - 2.6) < 0.06 and abs(float(f_number) - 3.2) < 0.04


@pytest.mark.slow
def test_camera_from_picture_finds_the_camera() -> None:
    command = [sys.executable, str(EXAMPLES / "camera_from_picture.py"), "--starts", "1"]
    printed = subprocess.run(command, check=True, capture_output=True, text=True, timeout=600).stdout
    # For errors as small as the bound, 8 times the square is a chi-square of 8 degrees of freedom, which exceeds 32
    # once in 10,000 times.
    assert float(re.search(r"error / bound ([\d.]+)", printed)[1]) < 2


@pytest.mark.slow
def test_which_copy_predicts_other_pictures() -> None:
    command = [sys.executable, str(EXAMPLES / "which_copy.py"), "--copies", "1"]
    printed = subprocess.run(command, check=True, capture_output=True, text=True, timeout=900).stdout
    nominal, fitted = (float(found) for found in re.findall(r"held out, .*: ([\d.]+) of the noise", printed))
    assert fitted < 0.2 * nominal
    # Standard deviations within the prior, whose axes they are measured by.
    sizes = [float(found) for found in re.search(r"before: \[(.*)\]", printed)[1].split(",")]
    assert len(sizes) == 28 and max(sizes) < 1.1 and min(sizes) < 0.2
