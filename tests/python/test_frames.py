"""Films: frames of a shot in which things move, as shots of a job, and as .mp4."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from realcam import cli
from realcam.video import write_video

from . import scenes

SHOT = """
format = 1
scene = "wall.obj"
environment_cd_m2 = 2000
resolution = [31, 21]
exposure_time_s = 0.005
model = "pinhole"
effects = []
spp = 4
seed = 10
[[pose]]
time_s = 0
position_m = [0, 0, 2]
look_at_m = [0, 0, 0]
[[pose]]
time_s = 1
position_m = [1, 0, 2]
look_at_m = [1, 0, 0]
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """With a shot whose camera moves by a metre in a second, past a wall that begins at x = 0."""
    (tmp_path / "wall.obj").write_text("v 0 -5 0\nv 5 -5 0\nv 5 5 0\nv 0 5 0\nf 1 2 3 4\n")
    (tmp_path / "pan.toml").write_text(SHOT)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def command(monkeypatch: pytest.MonkeyPatch, *words: str) -> None:
    monkeypatch.setattr("sys.argv", ["realcam", "job", *words])
    with pytest.raises(SystemExit) as end:
        cli.run()
    assert end.value.code in (0, None)


def test_frames_open_their_shutters_one_after_the_other(folder: Path) -> None:
    shot = rc.Shot.load("pan.toml", device="cpu")
    frames = shot.frames(range(1, 26, 12), frames_per_second=24, name="pan")
    assert list(frames) == ["pan.0001", "pan.0013", "pan.0025"]
    assert [frame.camera.shutter_opens_s for frame in frames.values()] == pytest.approx([0, 0.5, 1])
    assert len({frame.seed for frame in frames.values()}) == 3
    # The wall's edge is where the camera of that time has it, to a third of a pixel.
    moved = frames["pan.0013"].render(device="cpu").pixels
    still = rc.render(
        shot.scene,
        rc.Camera(shot.camera.lens, film=shot.camera.film, position=(0.5025, 0, 2), look_at=(0.5025, 0, 0),
                  exposure_time_s=0.005, model="pinhole"),
        shot.settings, device="cpu",
    ).pixels  # fmt: skip
    whole_step = np.abs(np.diff(still, axis=1)).max()
    assert np.abs(moved.mean(axis=0) - still.mean(axis=0)).max() < whole_step / 3


def test_effects_of_a_film_are_planned_together(folder: Path) -> None:
    lamp = scenes.quad((0.3, 0.4, -2), 0.05, emission=1e5)
    scene = scenes.scene_of(scenes.quad((0, 0, -3), 3, diffuse=0.6), lamp).with_environment(50.0)
    lens = rc.Lens.load("double-gauss-50mm").focused(3.0).with_coating("bare")
    # The lamp is in the picture at the beginning, and not at the end.
    camera = rc.Camera(
        lens, film=rc.Film(36, 24, (36, 24)), exposure_time_s=0.01,
        motion=[(0, (0, 0, 0), (0, 0, -1)), (1, (0, 0, 0), (3, 0, -1))],
    )  # fmt: skip
    frames = rc.Shot(scene, camera, rc.RenderSettings(spp=4)).frames([1, 25], device="cpu")
    first, last = frames.values()
    assert first.effects == last.effects != ()
    assert "auto" not in first.effects
    assert first.camera.model == last.camera.model


def test_a_job_makes_numbered_pictures_and_a_film(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    av = pytest.importorskip("av", reason="realcam[video] is missing")
    command(monkeypatch, "make", "pan.toml", "-o", "pan.job", "--frames", "1-25x8", "--device", "cpu", "--quiet")
    command(monkeypatch, "work", "pan.job", "--here", "--quiet")
    command(monkeypatch, "finish", "pan.job", "-o", "frames", "--quiet")
    assert sorted(path.name for path in Path("frames").iterdir()) == [f"pan.{n:04d}.exr" for n in (1, 9, 17, 25)]
    command(monkeypatch, "finish", "pan.job", "-o", "pan.mp4", "--fps", "12.5", "--quiet")
    with av.open("pan.mp4") as film:
        stream = film.streams.video[0]
        assert (stream.width, stream.height, float(stream.average_rate)) == (32, 22, 12.5)
        shown = [frame.to_ndarray(format="rgb24") for frame in film.decode(stream)]
    job = rc.Job.load("pan.job")
    assert len(shown) == 4
    for name, frame in zip(job.names, shown, strict=True):
        # H.264 at this quality, with its colours at half the resolution, errs by a few codes in the mean.
        assert np.abs(frame[:21, :31].astype(int) - job.image(name).developed().astype(int)).mean() < 6


def test_a_film_is_written_as_a_whole_or_not_at_all(tmp_path: Path) -> None:
    pytest.importorskip("av", reason="realcam[video] is missing")
    sizes = (np.zeros((16, 16, 3), np.uint8), np.zeros((16, 18, 3), np.uint8))
    with pytest.raises(rc.InputError, match="the frames of a film must have the same size"):
        write_video(tmp_path / "film.mp4", sizes, 24)
    with pytest.raises(rc.ImageFileError, match=r"the folder .* does not exist"):
        write_video(tmp_path / "nowhere" / "film.mp4", sizes[:1], 24)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("frames", ["9-1", "a-b", "1-2x0.5", "-3", ""])
def test_frames_that_are_no_range_are_refused(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], frames: str
) -> None:
    monkeypatch.setattr("sys.argv", ["realcam", "job", "make", "pan.toml", "-o", "pan.job", f"--frames={frames}"])
    with pytest.raises(SystemExit, match="2"):
        cli.run()
    assert capsys.readouterr().err == (
        f'realcam: error: --frames: "{frames}": a number, 1-240 or 1-240x2 is wanted, the smaller one first\n'
    )
    with pytest.raises(rc.InputError, match="a film wants frames with numbers from 0 on"):
        rc.Shot.load("pan.toml", device="cpu").frames([-1])
