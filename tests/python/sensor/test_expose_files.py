"""`realcam expose` on films whose metadata or pixels make no sense: one line, and no file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from realcam.cli import app as cli
from typer.testing import CliRunner

from ..sky_files import write_exr

GOOD = {"realcam:film_mm": b"36x24", "realcam:exposure_time_s": b"0.01", "realcam:iso": b"100"}
PIXELS = np.full((4, 6, 3), 0.05)


def expose(folder: Path, pixels: np.ndarray, texts: dict[str, bytes], output: str) -> BaseException | None:
    write_exr(folder / "film.exr", pixels, texts={**GOOD, **texts})
    arguments = ["expose", str(folder / "film.exr"), "--sensor", "ideal", "-o", str(folder / output)]
    return CliRunner().invoke(cli.app, arguments).exception


@pytest.mark.parametrize("output", ["raw.npy", "raw.dng", "raw.png"])
@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("realcam:lens", b"\xff\xfe"),
        *[("realcam:exposure_time_s", text) for text in (b"0", b"-1", b"nan", b"inf", b"1e300", b"", b"x")],
        *[("realcam:iso", text) for text in (b"0", b"-1", b"nan", b"inf", b"1e300", b"x")],
        *[("realcam:film_mm", text) for text in (b"0x0", b"nanxnan", b"36", b"x")],
    ],
)
def test_metadata_that_makes_no_sense(tmp_path: Path, name: str, text: bytes, output: str) -> None:
    error = expose(tmp_path, PIXELS, {name: text}, output)
    assert isinstance(error, (rc.InputError, rc.ImageFileError)), error
    assert "\n" not in str(error)
    assert not (tmp_path / output).exists()


@pytest.mark.parametrize("output", ["raw.npy", "raw.dng"])
def test_names_and_exposure_times_that_a_dng_cannot_hold(tmp_path: Path, output: str) -> None:
    """Its texts are ASCII, and its numbers quotients of 32 bits."""
    texts = {"realcam:lens": "Zeiß Sonnar".encode(), "realcam:exposure_time_s": b"1e20", "realcam:f_number": b"2.8"}
    assert expose(tmp_path, PIXELS, texts, output) is None
    assert (tmp_path / output).stat().st_size > 0


def test_a_film_of_nan(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    error = expose(tmp_path, np.full_like(PIXELS, np.nan), {}, "raw.npy")
    assert isinstance(error, rc.InputError)
    assert "all of its pixels are NaN" in str(error)
    some = PIXELS.copy()
    some[1, 2] = np.nan
    with pytest.warns(UserWarning, match="1 pixels of the film are NaN"):
        from realcam.raw_image import exposed_film

        raw = exposed_film(
            rc.Sensor.load("ideal"), some.astype(np.float32), rc.Film(36, 24, (6, 4)), exposure_time_s=0.01, iso=100
        )
    assert raw.mosaic[1, 2] == raw.black_level_dn
