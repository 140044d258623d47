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
