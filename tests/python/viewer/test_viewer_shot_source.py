"""Files with which a lens bench is opened."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
import realcam as rc

pytest.importorskip("simplejpeg")
pytest.importorskip("tomlkit")

from realcam.viewer import saving
from realcam.viewer.camera_controls import CameraControls
from realcam.viewer.shot_source import ShotSource

from . import bench_shots

pytestmark = pytest.mark.picture_files


def test_a_scene_file_is_seen_as_render_sees_it(tmp_path: Path) -> None:
    bench_shots.write_panels_shot(tmp_path)
    scene, picture = tmp_path / "panels.obj", tmp_path / "picture.exr"
    source, shot = ShotSource.opened(scene, "cpu")
    assert (source.name, source.folder) == ("panels.obj", tmp_path)
    command = [sys.executable, "-m", "realcam", "render", str(scene), "-o", str(picture), "--spp", "1"]
    subprocess.run([*command, "--effects", "none", "--device", "cpu"], check=True)
    oiio = pytest.importorskip("OpenImageIO")
    said = {entry.name: entry.value for entry in oiio.ImageBuf(str(picture)).spec().extra_attribs}
    mine = rc.render(shot.scene, shot.camera, spp=1, effects=(), device="cpu").metadata()
    assert {name: said.get(name) for name in mine} == mine
    # The scene is saved as a shot that shows the same picture.
    for file, content in saving.shot_contents(
        source, CameraControls.of(shot.camera), ["auto"], tmp_path / "saved.toml"
    ).items():
        file.write_bytes(content)
    again = rc.Shot.load(tmp_path / "saved.toml", device="cpu").camera
    assert (again.position, again.look_at) == (shot.camera.position, shot.camera.look_at)
    assert again.exposure_time_s == pytest.approx(shot.camera.exposure_time_s, rel=1e-9)


@pytest.mark.parametrize("name", ["nowhere.glb", "nonsense.glb", "nonsense.obj", "nonsense.xyz", "nowhere.toml"])
def test_what_is_no_scene_is_named_as_the_user_names_it(tmp_path: Path, name: str) -> None:
    if "nonsense" in name:
        (tmp_path / name).write_bytes(b"\0nonsense")
    with pytest.raises(rc.RealcamError) as error:
        ShotSource.opened(tmp_path / name, "cpu")
    assert str(tmp_path / name) in str(error.value)
    assert f"{name}.toml" not in str(error.value)


def test_a_saved_shot_has_the_options_of_the_scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The bench has no controls for these: they are options of the command, and keys of the saved shot, which may be in
    another folder."""
    path = bench_shots.write_panels_shot(tmp_path)
    path.write_text(f"{path.read_text()}\n[air]\nvisibility_m = 3\n")
    monkeypatch.chdir(tmp_path)
    words = {"scale": "0.5", "environment": "250", "air": "40"}
    source, shot = ShotSource.opened(Path(path.name), "cpu", words)
    (tmp_path / "folder").mkdir()
    target = tmp_path / "folder" / "saved.toml"
    contents = saving.shot_contents(source, CameraControls.of(shot.camera), ["none"], target)
    target.write_bytes(contents[target])
    saved = rc.Shot.load(target, device="cpu").scene
    assert saved.bounds_m == shot.scene.bounds_m != rc.Scene.load(tmp_path / "panels.obj").bounds_m
    pixels = [rc.render(scene, shot.camera, spp=1, effects=(), device="cpu").pixels for scene in (saved, shot.scene)]
    assert (pixels[0] == pixels[1]).all()


def test_the_command_takes_the_options_that_its_page_names(tmp_path: Path) -> None:
    """An error of the configuration is reported before the server starts."""
    path = bench_shots.write_panels_shot(tmp_path)
    options = ["--visibility", "40", "--variants", "/A{b=c}", "--scene-name", "0", "--ocio", "ocio://nowhere"]
    command = [sys.executable, "-m", "realcam", "view", str(path), "--no-browser", *options]
    found = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
    assert found.returncode != 0
    assert "unknown option" not in found.stderr
    assert "ocio://nowhere" in found.stderr
