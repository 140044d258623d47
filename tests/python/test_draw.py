"""Cross-sections of lenses: what they show of lenses at their limits, and which file they go to."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import matplotlib.figure
import numpy as np
import pytest
import realcam as rc
from realcam import cli
from realcam.draw import RAYS, draw_cross_section, save_cross_section
from typer.testing import CliRunner

GAUSS = rc.Lens.load("double-gauss-50mm")
LENS_FILE = """format = 1
name = "{name}"
title = "{title}"
[[surface]]
radius_of_curvature_mm = 50.0
thickness_mm = 5.0
material = 1.5
clear_semi_diameter_mm = 10.0
[[surface]]
radius_of_curvature_mm = -50.0
thickness_mm = 1.0
clear_semi_diameter_mm = 10.0
[[surface]]
type = "stop"
clear_semi_diameter_mm = 5.0
"""


def lens_file(path: Path, name: str = "mine", title: str = "") -> Path:
    path.write_text(LENS_FILE.format(name=name, title=title))
    return path


@pytest.mark.parametrize("f_number", [4.0, 22.0, 1e3, 1e5])
def test_rays_pass_however_far_the_diaphragm_is_closed(f_number: float) -> None:
    axes = matplotlib.figure.Figure().add_subplot()
    draw_cross_section(GAUSS.stopped_down(f_number), axes, rays=7)
    rays = [line for line in axes.lines if line.get_color() in RAYS]
    assert len(rays) == 21
    stop = GAUSS.vertices_mm[GAUSS.stop_index]
    radius = GAUSS.stopped_down(f_number).stop_semi_diameter_mm
    for line in rays:
        z, y = np.asarray(line.get_xdata()), np.asarray(line.get_ydata())
        at_stop = np.flatnonzero(np.abs(z - stop) < 1e-9)
        assert len(at_stop) == 1
        assert abs(y[at_stop[0]]) <= radius


@pytest.mark.parametrize("title", ["$\\\\foo$", "$x", "a_b^c"])
def test_a_title_is_no_formula(tmp_path: Path, title: str) -> None:
    lens = rc.Lens.load(lens_file(tmp_path / "mine.toml", title=title))
    save_cross_section(lens, tmp_path / "out.svg")
    save_cross_section(lens, tmp_path / "out.png")
    axes = matplotlib.figure.Figure().add_subplot()
    draw_cross_section(lens, axes)
    assert axes.get_title().startswith(title.replace("\\\\", "\\"))


def test_a_name_with_control_characters_is_drawn_without_them(tmp_path: Path) -> None:
    lens = rc.Lens(surfaces=GAUSS.surfaces, name="a\0b\x1b[31m")
    save_cross_section(lens, tmp_path / "out.svg")
    assert "\0" not in (tmp_path / "out.svg").read_text()


def test_the_drawing_goes_where_the_user_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    here = tmp_path / "here"
    here.mkdir()
    monkeypatch.chdir(here)
    file = lens_file(tmp_path / "trav.toml", name="../victim")
    result = CliRunner().invoke(cli.app, ["lens", "draw", str(file)])
    assert result.exit_code == 0, result.output
    assert [path.name for path in here.iterdir()] == ["trav.svg"]
    assert {path.name for path in tmp_path.iterdir()} == {"here", "trav.toml"}
    assert CliRunner().invoke(cli.app, ["lens", "draw", "tessar-50mm"]).exit_code == 0
    assert (here / "tessar-50mm.svg").is_file()


def test_an_image_that_is_lit_in_a_ring_alone_is_drawn(tmp_path: Path) -> None:
    save_cross_section(rc.Lens.load("mirror-telephoto-500mm"), tmp_path / "mirror.svg")


def test_a_drawing_follows_links_and_is_no_file_until_it_is_whole(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "link.svg").symlink_to("file.svg")
    draw = matplotlib.figure.Figure.savefig
    there: list[str] = []

    def watched(figure: matplotlib.figure.Figure, *to: object, **settings: object) -> None:
        draw(figure, *to, **settings)
        there.extend(path.name for path in tmp_path.iterdir())

    monkeypatch.setattr(matplotlib.figure.Figure, "savefig", watched)
    save_cross_section(GAUSS, tmp_path / "link.svg")
    assert there == ["link.svg"]
    assert (tmp_path / "link.svg").is_symlink()
    assert "<svg" in (tmp_path / "file.svg").read_text()
    assert {path.name for path in tmp_path.iterdir()} == {"link.svg", "file.svg"}


def test_what_cannot_be_written_is_named_as_the_user_does(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    os.mkfifo("pipe.svg")
    long = "x" * 300 + ".svg"
    for name, why in {
        "gone/a.svg": "the folder gone does not exist",
        "pipe.svg": "is a pipe or a device",
        long: "cannot be written: File name too long",
        "a\0b.svg": None,
    }.items():
        with pytest.raises(rc.InputError if why is None else rc.ImageFileError, match=why and f"^{name}: {why}"):
            save_cross_section(GAUSS, name)

    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device", "/temporary")

    monkeypatch.setattr(Path, "replace", full)
    with pytest.raises(rc.ImageFileError, match=r"^a\.svg: cannot be written: No space left on device$"):
        save_cross_section(GAUSS, "a.svg")
    assert [path.name for path in tmp_path.iterdir()] == ["pipe.svg"]


def test_a_lens_file_is_not_drawn_over(tmp_path: Path) -> None:
    file = lens_file(tmp_path / "mine.svg")
    before = file.read_text()
    (tmp_path / "link.svg").symlink_to(file)
    for output in (file, tmp_path / "link.svg"):
        result = CliRunner().invoke(cli.app, ["lens", "draw", str(file), "-o", str(output)])
        assert isinstance(result.exception, rc.InputError)
        assert "is the lens file itself" in str(result.exception)
    assert file.read_text() == before
