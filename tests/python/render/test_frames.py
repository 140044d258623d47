"""Films: frames of a shot in which things move, as shots of a job, and as .mp4."""

from __future__ import annotations

import json
import re
import signal
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from realcam.image_file import read_film
from realcam.video import write_video

from .. import scenes
from ..programs import EXECUTABLE, PROGRAM, PYTHON, Command, wants_executable

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
    """A folder with a shot whose camera moves at 1 m/s past a wall that begins at x = 0."""
    (tmp_path / "wall.obj").write_text("v 0 -5 0\nv 5 -5 0\nv 5 5 0\nv 0 5 0\nf 1 2 3 4\n")
    (tmp_path / "pan.toml").write_text(SHOT)
    monkeypatch.chdir(tmp_path)
    return tmp_path


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


def test_the_noise_of_frames_has_nothing_in_common() -> None:
    """15 frames of one shot and 15 of a shot with the next seed are as uncorrelated as independent noise."""
    scene = scenes.scene_of(scenes.quad((0, 0, -3), 5, diffuse=0.7)).with_environment((900, 500, 100))
    camera = rc.Camera(rc.Lens.load("tessar-50mm").focused(1), film=rc.Film(36, 24, (24, 16)))
    shots = [rc.Shot(scene, camera, rc.RenderSettings(spp=2, seed=seed, effects=())) for seed in (0, 1)]
    frames = [frame for shot in shots for frame in shot.frames(range(15)).values()]
    assert len({frame.seed for frame in frames}) == 30
    pictures = np.array([frame.render(device="cpu").pixels[..., 1] for frame in frames], dtype=float)
    noise = pictures - pictures.mean(axis=0)
    assert noise.std() > 0.01 * pictures.mean()
    noise /= noise.std(axis=0)  # some pixels have more of it, which would count for all others
    flat = noise.reshape(30, -1)
    correlation = np.corrcoef(flat)[~np.eye(30, dtype=bool)]
    # Subtracting the mean of the 30 frames correlates any two by -1 / 29. The remainder is chance, over 384 pixels.
    assert np.abs(correlation + 1 / 29).max() < 5 / np.sqrt(384)
    # The noise must not move over the picture either: each frame is compared with the previous one, shifted by a pixel.
    for shift in ((0, 1), (1, 0), (1, 1)):
        moved = np.roll(noise[:-1], shift, axis=(1, 2)).reshape(29, -1)
        alike = [np.corrcoef(a, b)[0, 1] for a, b in zip(moved, flat[1:], strict=True)]
        assert abs(np.mean(alike)) < 5 / np.sqrt(384 * 29)
    again = shots[0].frames([7])["frame.0007"].render(device="cpu").pixels
    np.testing.assert_array_equal(again[..., 1], pictures[7].astype(np.float32))


def test_the_iso_number_follows_the_meter_smoothly(folder: Path) -> None:
    """The exposure time falls to a quarter at once; the ISO number goes up by two stops, as the stated mean does."""
    shot = rc.Shot.load("pan.toml", device="cpu")
    keys = (rc.CameraKey(0, exposure_time_s=0.01, interpolation="step"), rc.CameraKey(0.2, exposure_time_s=0.0025))
    wall = shot.camera.replace(position=(2, 0, 2), look_at=(2, 0, 0))
    following = rc.Shot(shot.scene, wall, shot.settings, keys=keys, iso_follows_s=0.1)
    numbers = range(1, 31)
    isos = [f.camera.iso for f in following.frames(numbers, frames_per_second=20, device="cpu").values()]
    target = np.log2([isos[0] if (n - 1) / 20 < 0.2 - 1e-9 else 4 * isos[0] for n in numbers])
    expected = []
    for n in numbers:
        ages = np.arange(min(n, 11))  # five times the smoothing, and the frame itself; no frame before the first
        weights = np.exp(-ages / 20 / 0.1)
        expected.append((weights * target[n - 1 - ages]).sum() / weights.sum())
    # Float32 pictures of the same samples, scaled by the exposure, agree to some digits.
    np.testing.assert_allclose(np.log2(isos), expected, atol=1e-5)
    # A frame by itself has the same.
    assert following.frames([7], frames_per_second=20, device="cpu")["frame.0007"].camera.iso == isos[6]


@pytest.mark.slow
def test_render_takes_numbered_frames_and_goes_on(folder: Path) -> None:
    words = ["render", "pan.toml", "-o", "pan.##.exr", "--frames", "1-25x8", "--fps", "24", "--device", "cpu"]
    done = subprocess.run([*PROGRAM, *words], capture_output=True, text=True, check=True)
    names = [f"pan.{n:02d}.exr" for n in (1, 9, 17, 25)]
    assert sorted(path.name for path in folder.glob("pan.*.exr")) == names
    assert [line.split(":")[0] for line in done.stdout.splitlines()] == ["frame 1", "frame 9", "frame 17", "frame 25"]
    frames = rc.Shot.load("pan.toml", device="cpu").frames((1, 9, 17, 25))
    for name, frame in zip(names, frames.values(), strict=True):
        found = read_film(name)[0]
        # Half floats in the file: 11 bits.
        np.testing.assert_allclose(found, frame.render(device="cpu").pixels, rtol=1e-3)
    (folder / names[1]).unlink()
    before = {name: (folder / name).stat().st_mtime_ns for name in names if (folder / name).exists()}
    done = subprocess.run([*PROGRAM, *words], capture_output=True, text=True, check=True)
    assert "3 of 4 frames exist already; --again takes them again" in done.stderr
    assert {name: (folder / name).stat().st_mtime_ns for name in before} == before
    assert (folder / names[1]).exists()
    subprocess.run([*PROGRAM, *words, "--again", "--quiet"], capture_output=True, check=True)
    assert all((folder / name).stat().st_mtime_ns != time for name, time in before.items())


def test_render_makes_a_film(folder: Path) -> None:
    av = pytest.importorskip("av", reason="realcam[video] is missing")
    # An option is written in any way that the command has.
    words = ["render", "pan.toml", "-opan.mp4", "--output=pan.png", "--frames=1-3", "--fps", "12", "--device", "cpu"]
    done = subprocess.run([*PYTHON, *words], capture_output=True, text=True, check=True)
    assert done.stdout.endswith("wrote pan.mp4\n")
    with av.open("pan.mp4") as film:
        assert float(film.streams.video[0].average_rate) == 12
        shown = [frame.to_ndarray(format="rgb24") for frame in film.decode(film.streams.video[0])]
    assert len(shown) == 3
    with av.open("pan.0002.png") as picture:
        still = next(picture.decode(video=0)).to_ndarray(format="rgb24")
    assert np.abs(shown[1][:21, :31].astype(int) - still.astype(int)).mean() < 6
    assert not (folder / "pan.mp4.frames").exists()
    done = subprocess.run([*PYTHON, *words, "--json"], capture_output=True, text=True, check=True)
    assert len(json.loads(done.stdout)) == 3


def test_a_film_that_was_stopped_goes_on(folder: Path) -> None:
    pytest.importorskip("av", reason="realcam[video] is missing")
    words = ["render", "pan.toml", "-o", "pan.mp4", "--frames", "1-400", "--device", "cpu"]
    running = subprocess.Popen([*PYTHON, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert [running.stdout.readline().split(":")[0] for _ in range(2)] == ["frame 1", "frame 2"]
    running.send_signal(signal.SIGINT)
    _, said = running.communicate()
    assert running.returncode == 130
    assert said.endswith("realcam: stopped\n")
    there = sorted(path.name for path in (folder / "pan.mp4.frames").iterdir())
    assert there[0] == "000001.png" and 1 < len(there) < 400
    assert not (folder / "pan.mp4").exists()
    words[words.index("1-400")] = "1-1"
    done = subprocess.run([*PYTHON, *words], capture_output=True, text=True, check=True)
    assert "1 of 1 frames exist already" in done.stderr
    assert (folder / "pan.mp4").exists()
    # Other frames are not lost.
    assert sorted(path.name for path in (folder / "pan.mp4.frames").iterdir()) == there[1:]


@wants_executable
def test_the_executable_says_what_makes_films(folder: Path) -> None:
    words = [*EXECUTABLE, "render", "pan.toml", "-o", "pan.mp4", "--frames", "1-3"]
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == 2
    assert "this program writes no videos; the command of the Python package realcam[video] does" in done.stderr


@pytest.mark.parametrize(
    ("words", "required"),
    [
        ("render -oa.png --fps 0 --frames 1-2", "--fps must be more than 0 frames per second"),
        ("render -onowhere/a.png --frames 1-2", "nowhere"),
        ("render -oa.mp4 -oa.mp4 --frames 1-2", '"a.mp4" is specified twice'),
        ("render -oa.mp4", "--frames is missing"),
        ("render -onowhere/a.mp4 --frames 1-2", "nowhere"),
        *(
            (f"{what} --frames={frames}", f'--frames: "{frames}": expected a number')
            for what in ("render -oa.png", "job make -oa.job")
            for frames in ("9-1", "a-b", "1-2x0.5", "1-9x0", "-3")
        ),
        ("job make -oa.job --frames=", '--frames: "": expected a number, 1-240 or 1-240x2'),
    ],
)
def test_films_that_cannot_be_are_refused(folder: Path, command: Command, words: str, required: str) -> None:
    if ".mp4" in words:
        pytest.importorskip("av", reason="realcam[video] is missing")
    done = command(*words.split(), "pan.toml")
    assert done.returncode == 2
    assert done.stderr.startswith("realcam: error: ") and required in done.stderr
    assert done.stderr.count("\n") == 1
    assert not list(folder.glob("a*"))
    with pytest.raises(rc.InputError, match="frame numbers must be 0 or more"):
        rc.Shot.load("pan.toml", device="cpu").frames([-1])


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


def test_an_effect_that_one_lens_cannot_show_is_left_out_of_the_film() -> None:
    """Diffraction wants a lens of revolution: of a film that has an anamorphic lens, no frame has it."""
    lamp = scenes.quad((0.1, 0.1, -2), 0.02, emission=1e6)
    scene = scenes.scene_of(scenes.quad((0, 0, -3), 3, diffuse=0.6), lamp).with_environment(50.0)
    lens = rc.Lens.load("tessar-50mm").stopped_down(16).focused(2)
    shot = rc.Shot(scene, rc.Camera(lens, film=rc.Film(21, 14, (36, 24)), exposure_time_s=0.01))
    assert "diffraction" in shot.frames([1, 2], device="cpu")["frame.0001"].effects
    keys = (rc.CameraKey(0.04, lens=rc.Lens.load("anamorphic-65mm")),)
    frames = replace(shot, keys=keys).frames([1, 2], device="cpu").values()
    assert [frame.camera.lens.name for frame in frames] == ["tessar-50mm", "anamorphic-65mm"]
    for frame in frames:
        assert "diffraction" not in frame.effects
        frame.render(device="cpu")


def test_a_job_makes_numbered_pictures_and_a_film(folder: Path, command: Command) -> None:
    av = pytest.importorskip("av", reason="realcam[video] is missing")
    for words in (
        "make pan.toml -o pan.job --frames 1-25x8 --device cpu",
        "work pan.job --here",
        "finish pan.job -o frames",
        "finish pan.job -o pan.mp4 --fps 12.5",
    ):
        assert command("job", *words.split(), "--quiet").returncode == 0
    assert sorted(path.name for path in Path("frames").iterdir()) == [f"pan.{n:04d}.exr" for n in (1, 9, 17, 25)]
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
    with pytest.raises(rc.InputError, match="the frames of a video must have the same size"):
        write_video(tmp_path / "film.mp4", sizes, 24)
    with pytest.raises(rc.ImageFileError, match=r"the folder .* does not exist"):
        write_video(tmp_path / "nowhere" / "film.mp4", sizes[:1], 24)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
@pytest.mark.parametrize("suffix", [".png", ".exr"])
def test_only_whole_frames_of_the_same_film_count_as_done(folder: Path, suffix: str) -> None:
    words = ["render", "pan.toml", "-o", f"f.#{suffix}", "--frames", "1-7", "--device", "cpu"]
    subprocess.run([*PROGRAM, *words, "--quiet"], check=True)
    files = [folder / f"f.{n}{suffix}" for n in range(1, 8)]
    good = [path.read_bytes() for path in files]
    files[0].write_bytes(b"")
    files[1].write_bytes(good[1][:-1])
    files[2].write_bytes(good[2][: len(good[2]) // 2])
    middle = good[3].rindex(b"IDAT") + 20 if suffix == ".png" else len(good[3]) - 200
    files[3].write_bytes(good[3][:middle] + bytes(20) + good[3][middle + 20 :])
    files[4].write_bytes(good[5])  # another frame
    subprocess.run([*PROGRAM, "render", "wall.obj", "-o", f"f.6{suffix}", "--resolution", "31x21", "--spp", "1",
                    "--device", "cpu", "--quiet"], check=True)  # fmt: skip
    before = files[6].stat().st_mtime_ns
    done = subprocess.run([*PROGRAM, *words], capture_output=True, text=True, check=True)
    assert "1 of 7 frames exist already" in done.stderr
    assert "6 of 7 frames existed, but were damaged or taken with other settings" in done.stderr
    undated = [re.sub(rb"(?s)capDate.{12}.{19}", b"", content) for content in good]
    assert [re.sub(rb"(?s)capDate.{12}.{19}", b"", path.read_bytes()) for path in files] == undated
    assert files[6].stat().st_mtime_ns == before
    # Other settings, and another scene under the same name, make another film.
    for more, change in ((["--max-bounces", "3"], ""), ([], "v 9 9 9\n")):
        (folder / "wall.obj").write_text((folder / "wall.obj").read_text() + change)
        done = subprocess.run([*PROGRAM, *words, *more], capture_output=True, text=True, check=True)
        assert "7 of 7 frames existed, but were damaged" in done.stderr


@pytest.mark.slow
def test_no_frame_replaces_a_file_that_the_film_is_made_from(folder: Path) -> None:
    subprocess.run([*PROGRAM, "render", "pan.toml", "-o", "sky.0002.png", "--device", "cpu", "--quiet"], check=True)
    (folder / "lit.toml").write_text(SHOT.replace("environment_cd_m2 = 2000", 'environment = "sky.0002.png"'))
    before = (folder / "sky.0002.png").read_bytes()
    words = ["render", "lit.toml", "-o", "sky.png", "--frames", "1-3", "--again", "--device", "cpu"]
    done = subprocess.run([*PROGRAM, *words], capture_output=True, text=True)
    assert done.returncode == 2
    assert '"sky.0002.png" is also an input of this command' in done.stderr
    assert (folder / "sky.0002.png").read_bytes() == before
