"""rc.photograph does what the command does, and values take the place of those of a shot file."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from realcam import denoiser

from .. import scenes
from ..programs import Command

ROOT = Path(__file__).resolve().parents[3]
ROOM = scenes.scene_of(scenes.quad((0, 0, -3), 3, diffuse=0.6)).with_environment(100)
SHOT = """
format = 1
scene = "wall.obj"
lens = "tessar-50mm"
noise_codes = 8
camera = "none"
environment_cd_m2 = 50

[[key]]
time_s = 0
f_number = 4
iso = 200

[[key]]
time_s = 1
f_number = 8
iso = 400
"""


@pytest.fixture
def shot_file(tmp_path: Path) -> Path:
    (tmp_path / "wall.obj").write_text("v -3 -3 -3\nv 3 -3 -3\nv 3 3 -3\nv -3 3 -3\nf 1 2 3 4\n")
    (tmp_path / "shot.toml").write_text(SHOT)
    return tmp_path / "shot.toml"


@pytest.mark.picture_files
def test_it_is_the_picture_of_the_command(shot_file: Path, command: Command, tmp_path: Path) -> None:
    """The same words for the same things; the film's exposure has the same bits."""
    out = tmp_path / "a.exr"
    words = {"lens": "double-gauss-50mm", "f_number": 5.6, "focus_m": 2.5, "resolution": (30, 20), "spp": 3, "seed": 4}
    options = {"focus": 2.5, "resolution": "30x20"} | {
        k: v for k, v in words.items() if k not in ("focus_m", "resolution")
    }
    typed = [word for name, value in options.items() for word in (f"--{name.replace('_', '-')}", str(value))]
    done = command("render", str(shot_file), "-o", str(out), *typed)
    assert done.returncode == 0, done.stderr
    image = rc.photograph(shot_file, **words)
    image.save(tmp_path / "b.exr")
    assert image.spp == 3
    assert image.camera.lens.name == "double-gauss-50mm"
    assert (tmp_path / "a.exr").stat().st_size == (tmp_path / "b.exr").stat().st_size
    one, other = (read(tmp_path / name) for name in ("a.exr", "b.exr"))
    np.testing.assert_array_equal(one, other)


def read(file: Path) -> np.ndarray:
    import OpenImageIO as oiio

    return oiio.ImageBuf(str(file)).get_pixels(oiio.FLOAT)


def test_values_take_the_place_of_those_of_the_file_and_of_what_they_exclude(shot_file: Path) -> None:
    as_written = rc.Shot.load(shot_file)
    assert as_written.camera.lens.first_order().f_number == pytest.approx(4, rel=0.02)
    assert len(as_written.keys) == 2
    assert as_written.noise_codes == 8
    shot = rc.Shot.load(shot_file, f_number=11, iso=100, spp=2, position_m=[0, 0, 1], environment_cd_m2=math.pi)
    assert shot.camera.lens.first_order().f_number == pytest.approx(11, rel=0.02)
    assert shot.camera.iso == 100
    assert not shot.keys  # nothing is left of them
    assert shot.spp == 2  # and not the noise of the file
    assert shot.camera.position == (0, 0, 1)
    by_noise = rc.Shot.load(shot_file, noise=0.1)
    assert (by_noise.noise, by_noise.noise_codes) == (0.1, None)


def test_scenes_and_lenses_may_be_in_memory() -> None:
    lens = rc.Lens.load("tessar-50mm").stopped_down(8)
    shot = rc.Shot.load(ROOM, lens=lens, focus_m=math.inf, film_mm=np.array([12, 8]), resolution=(np.int64(24), 16))
    assert shot.camera.lens.name == "tessar-50mm"
    assert shot.camera.lens.focus_distance_m == math.inf
    assert shot.camera.film.resolution == (24, 16)
    assert rc.photograph(ROOM, lens=lens, resolution=(24, 16), spp=1).pixels.shape == (16, 24, 3)


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"fnumber": 4}, 'unknown key "fnumber" (did you mean "f_number"?)'),
        ({"f_number": "wide"}, '"f_number" must be a number; it is "wide"'),
        ({"focus_m": math.nan}, '"focus_m" must be a number of metres, inf or auto'),
        ({"iso": {1}}, "iso must be a value of a shot file (a number, a text or a list); it is {1}"),
        ({"noise": 0.1, "noise_codes": 2}, "noise (a fraction of the light) and noise_codes"),
        ({'tone = "film"\nspp': 3}, "unknown key"),
    ],
    ids=lambda value: next(iter(value)) if isinstance(value, dict) else "",
)
def test_what_is_wrong_is_told_in_a_sentence(values: dict[str, object], told: str) -> None:
    with pytest.raises(rc.InputError) as error:
        rc.Shot.load(ROOM, **values)
    assert told in str(error.value)
    assert "\n" not in str(error.value)


def test_noise_that_is_left_is_taken_where_nobody_says_how_much(monkeypatch: pytest.MonkeyPatch) -> None:
    """By a stand-in for the denoiser, which needs no library: what it got, and what the picture keeps."""
    seen: list[set[str]] = []

    def stand_in(pixels: np.ndarray, layers: dict[str, np.ndarray], _: str) -> tuple[np.ndarray, str]:
        seen.append(set(layers))
        return pixels, "stand-in 1"

    monkeypatch.setattr(denoiser, "denoised", stand_in)
    monkeypatch.setattr(denoiser, "is_installed", lambda: True)
    few = {"resolution": (24, 16), "max_spp": 2}
    with pytest.warns(UserWarning, match="noise"):
        image = rc.photograph(ROOM, **few)
    assert image.denoiser == "stand-in 1"
    assert seen == [set(denoiser.GUIDES)]
    assert not image.layers
    with pytest.warns(UserWarning, match="noise"):
        assert not rc.photograph(ROOM, denoise=False, **few).denoiser
    assert not rc.photograph(ROOM, resolution=(24, 16), spp=1).denoiser
    assert rc.photograph(ROOM, resolution=(24, 16), spp=1, denoise=True).denoiser == "stand-in 1"
