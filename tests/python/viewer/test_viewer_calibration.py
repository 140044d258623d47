"""The lens bench with a shot whose camera is calibrated: its geometry stays, or a change is refused in one line."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

pytest.importorskip("nicegui")
tomlkit = pytest.importorskip("tomlkit")

from realcam.viewer.bench_state import restored, state_of  # noqa: E402
from realcam.viewer.camera_controls import CameraControls, of_width  # noqa: E402
from realcam.viewer.lens_bench import LensBench  # noqa: E402
from realcam.viewer.saving import shot_contents  # noqa: E402
from realcam.viewer.shot_source import ShotSource  # noqa: E402

from .bench_shots import write_panels_shot  # noqa: E402

pytestmark = pytest.mark.picture_files

SIZE = (120, 80)


def calibration() -> rc.Calibration:
    """The pixels are wider than high by 2%."""
    K = [[168.0, 0, 57.0], [0, 171.4, 41.0], [0, 0, 1]]
    return rc.Calibration.opencv(K, [-0.2, 0.05, 0.001, -0.0005, 0], SIZE)


@pytest.fixture
def shot_file(tmp_path: Path) -> Path:
    calibration().save(tmp_path / "camera.yml")
    path = write_panels_shot(tmp_path)
    lines = [line for line in path.read_text().splitlines() if not line.startswith(("film_mm", "resolution"))]
    path.write_text("\n".join([*lines, "[calibration]", 'file = "camera.yml"', ""]))
    return path


def error_px(camera: rc.Camera) -> float:
    return calibration().resized(camera.film.resolution).geometry_error(camera).everywhere_px


def test_controls_keep_the_geometry(shot_file: Path) -> None:
    controls = CameraControls.of(rc.Shot.load(shot_file).camera)
    changed = replace(controls, f_number=8.0, focus_m=3.0, pose=controls.pose.orbited(0.2, 0.1), iso=400.0)
    assert changed.camera.geometry == controls.geometry is not None
    assert error_px(changed.camera) < 0.05
    # Through another lens, too.
    other = controls.with_lens(rc.Lens.load("tessar-50mm")).focused_within_reach()
    assert error_px(other.camera) < 0.05


@pytest.mark.parametrize("width", [7, 60, 121, 480])
def test_another_resolution_keeps_the_shape_of_the_pixels(shot_file: Path, width: int) -> None:
    controls = CameraControls.of(rc.Shot.load(shot_file).camera)
    resized = replace(controls, film=of_width(controls.film, width, controls.pixel_aspect))
    assert resized.film.resolution == (width, round(width * SIZE[1] / SIZE[0]))
    again = of_width(resized.film, SIZE[0], resized.pixel_aspect)
    assert again == controls.film


def test_a_state_is_restored_with_the_geometry(shot_file: Path) -> None:
    controls = CameraControls.of(rc.Shot.load(shot_file).camera)
    changed = replace(controls, f_number=5.6, film=of_width(controls.film, 60, controls.pixel_aspect))
    assert restored(controls, state_of(changed, {})).camera == changed.camera


def test_another_film_is_refused_in_one_line_and_another_lens_keeps_the_film(shot_file: Path) -> None:
    shot = rc.Shot.load(shot_file)
    bench = LensBench(shot, device="cpu")
    try:
        assert not bench.set_film_mm(24.0, 16.0)
        assert bench.problem is not None
        assert "that of a calibration" in bench.problem.message
        assert "\n" not in bench.problem.message
        assert bench.set_lens(rc.Lens.load("tessar-50mm"))
        assert bench.controls.film == shot.camera.film
        assert error_px(bench.controls.camera) < 0.05
        assert bench.undo()
        assert bench.controls.camera.geometry == shot.camera.geometry
    finally:
        bench.close()


@pytest.mark.parametrize("is_option", [False, True])
@pytest.mark.parametrize("is_table", [False, True])
def test_a_saved_shot_has_the_geometry(
    shot_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, is_option: bool, is_table: bool
) -> None:
    """The calibration may come from the command line, and the shot be saved in another folder."""
    monkeypatch.chdir(tmp_path)
    text = shot_file.read_text()
    if not is_table:
        text = 'calibration = "camera.yml"\n' + text.partition("[calibration]")[0]
    if is_option:
        text = text.partition("[calibration]")[0].replace('calibration = "camera.yml"\n', "")
    shot_file.write_text(text)
    words = {"calibration": "camera.yml"} if is_option else {}
    source, shot = ShotSource.opened(Path(shot_file.name), "cpu", words)
    controls = replace(CameraControls.of(shot.camera), f_number=8.0)
    target = tmp_path / "saved" / "again.toml"
    target.parent.mkdir()
    for path, content in shot_contents(source, controls, [], target).items():
        path.write_bytes(content)
    again = rc.Shot.load(target).camera
    assert error_px(again) < 0.05
    points = np.array([[0.1, 0.05, -1.5], [-0.3, 0.2, -2.0]])
    np.testing.assert_allclose(again.project(points), controls.camera.project(points), atol=1e-3)
    assert again.lens.f_number == pytest.approx(8.0, rel=0.05)
