"""A picture that is stopped is what was taken until then, and says how noisy it is.

A GPU takes these samples before it can be stopped.
"""

from __future__ import annotations

import signal
import subprocess
import time
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest
import realcam as rc

from .. import scenes
from ..programs import EXECUTABLE, PYTHON

DEMO = str(Path(__file__).resolve().parents[3] / "scenes" / "demo.toml")
FILM = rc.Film(36, 24, (48, 32))
# The small plate hides a part of the sky from the wall: alone, the wall would be without noise.
WALL, PLATE = scenes.quad((0, 0, -3), 3, diffuse=0.6), scenes.quad((0, 0.4, -2.6), 0.3, up=(0, 0, 1), diffuse=0.6)
SCENE = scenes.scene_of(WALL, PLATE).with_environment(100)
CAMERA = rc.Camera(rc.Lens.load("tessar-50mm").focused(3.0), film=FILM, exposure_time_s=1 / 30)


@pytest.mark.parametrize("goal", [{"spp": 4096}, {"spp": "auto", "noise_codes": 0.001}], ids=["counted", "by noise"])
def test_what_was_taken_is_the_picture(goal: dict[str, object]) -> None:
    with pytest.warns(UserWarning, match="stopped") as told:
        image = rc.render(
            SCENE,
            CAMERA,
            device="cpu",
            effects=(),
            max_bounces=1,
            layers=("sample_count", "albedo"),
            progress=lambda done: done < 0.02,
            on_stop="keep",
            **goal,
        )
    counts = image.layers["sample_count"]
    assert 0 < counts.min() <= counts.max() <= 2 * counts.min() < 8192  # rounds double the samples
    assert image.spp == pytest.approx(counts.mean(), abs=1)
    assert image.layers["albedo"].shape == (32, 48, 3)
    assert str(told[0].message) == image.shortfall
    # The mean of 48 x 32 pixels of at least 8 samples, whose own deviation is less than their mean.
    whole = rc.render(SCENE, CAMERA, effects=(), max_bounces=1, spp=1024, seed=1)
    assert image.pixels.mean() == pytest.approx(whole.pixels.mean(), rel=0.01)


def test_the_noise_of_a_stopped_picture_is_told() -> None:
    with pytest.warns(UserWarning, match="stopped"):
        image = rc.render(
            SCENE,
            CAMERA,
            device="cpu",
            effects=(),
            max_bounces=1,
            spp=4096,
            progress=lambda done: done < 0.1,
            on_stop="keep",
        )
    words = image.shortfall.split()
    taken, times = int(words[words.index("after") + 1]), float(words[words.index("about") + 1])
    assert taken == image.spp
    assert times == pytest.approx((4096 / taken) ** 0.5, rel=0.05)  # two digits


def test_a_stopped_picture_is_given_up_where_nobody_wants_it() -> None:
    for words in ({}, {"on_stop": "raise"}):
        with pytest.raises(rc.Cancelled):
            rc.render(
                SCENE, CAMERA, device="cpu", effects=(), max_bounces=1, spp=4096, progress=lambda _: False, **words
            )
    with pytest.raises(rc.InputError, match='on_stop must be "raise" or "keep"; it is \'write\''):
        rc.render(SCENE, CAMERA, effects=(), spp=1, on_stop="write")


def interrupted(command: list[str], number: signal.Signals) -> tuple[int, str]:
    """The exit status and what was said. The signal comes after the command has said that it takes samples."""
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        said = process.stderr.readline()
        time.sleep(1.5)
        process.send_signal(number)
        _, errors = process.communicate(timeout=60)
    return process.returncode, said + errors


def read(file: Path) -> np.ndarray:
    return oiio.ImageBuf(str(file)).get_pixels(oiio.FLOAT)


@pytest.mark.picture_files
@pytest.mark.parametrize("program", [PYTHON, EXECUTABLE], ids=["python", "executable"])
def test_ctrl_c_writes_the_picture(program: list[str], tmp_path: Path) -> None:
    if not program:
        pytest.skip("the executable is not built")
    scene = DEMO
    files = [tmp_path / "a.png", tmp_path / "b.exr"]
    words = ["render", scene, "--resolution", "96x64", "--noise-codes", "0.001", "--device", "cpu"]
    code, said = interrupted([*program, *words, *(f"-o{file}" for file in files)], signal.SIGINT)
    assert code == 130
    # On a busy machine the signal may come before the noise can be measured.
    assert "it was stopped; the noise is " in said or "it was stopped; too few samples" in said
    assert said.endswith("realcam: stopped; the picture contains the samples taken so far\n")
    for file in files:
        assert read(file).shape[:2] == (64, 96)


@pytest.mark.slow
@pytest.mark.picture_files
def test_sigterm_and_films_leave_no_unfinished_picture(tmp_path: Path) -> None:
    scene = DEMO
    words = ["render", scene, "--resolution", "96x64", "--noise-codes", "0.001", "--device", "cpu"]
    for number, more, file in (
        (signal.SIGTERM, [], "a.png"),
        (signal.SIGINT, ["--frames", "1-2"], "b.####.png"),
    ):
        code, said = interrupted([*PYTHON, *words, *more, "-o", str(tmp_path / file)], number)
        assert code == 128 + number
        assert said.endswith("realcam: stopped\n")
        assert not list(tmp_path.iterdir())


@pytest.mark.slow
@pytest.mark.picture_files
def test_a_comparison_that_is_stopped_has_the_pictures_that_are_there(tmp_path: Path) -> None:
    sheet = tmp_path / "sheet.png"
    words = ["compare", "demo", "--vary", "f_number=4,8,16", "--size", "64", "--noise-codes", "0.1", "--device", "cpu"]
    process = subprocess.Popen(
        [*PYTHON, *words, "-o", str(sheet)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    with process:
        time.sleep(8)  # within the first picture, or one of the others
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
    assert process.returncode == 130, errors
    assert "f/4: it was stopped" in errors or "the sheet has " in errors
    assert sheet.stat().st_size > 1000
