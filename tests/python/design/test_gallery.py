"""The contact sheet of lenses."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
import realcam as rc
from realcam.cli import app as cli
from realcam.drawing.gallery import save_gallery
from realcam.drawing.themes import theme_named
from realcam.number_text import optics_text
from typer.testing import CliRunner


def words_of(svg: Path) -> set[str]:
    """All texts of a drawing."""
    return {text.strip() for text in ElementTree.parse(svg).getroot().itertext()}


def test_a_sheet_names_each_lens_with_focal_length_and_f_number(tmp_path: Path) -> None:
    names = ["tessar-50mm", "mirror-telephoto-500mm", "fisheye-6mm-220deg", "phone-4mm"]
    lenses = [rc.Lens.load(name) for name in names]
    save_gallery(tmp_path / "sheet.svg", lenses, columns=3)
    words = words_of(tmp_path / "sheet.svg")
    for lens in lenses:
        assert lens.name in words
        assert optics_text(lens) in words


def test_mistakes_are_named_and_write_nothing(tmp_path: Path) -> None:
    lens = rc.Lens.load("singlet-100mm")
    with pytest.raises(rc.ImageFileError, match="unknown suffix"):
        save_gallery(tmp_path / "sheet.bmp", [lens])
    with pytest.raises(rc.InputError, match="at least one lens"):
        save_gallery(tmp_path / "sheet.png", [])
    with pytest.raises(rc.InputError, match="columns: 0 is too few"):
        save_gallery(tmp_path / "sheet.png", [lens], columns=0)
    with pytest.raises(rc.ImageFileError, match="does not exist"):
        save_gallery(tmp_path / "nowhere" / "sheet.png", [lens])
    assert not list(tmp_path.iterdir())


def test_the_command_draws_those_named(tmp_path: Path) -> None:
    target = tmp_path / "two.svg"
    result = CliRunner().invoke(cli.app, ["lens", "gallery", "tessar-50mm", "sonnar-50mm", "-o", str(target)])
    assert result.exit_code == 0, result.output
    assert {"tessar-50mm", "sonnar-50mm"} <= words_of(target)
    assert "singlet-100mm" not in words_of(target)


def test_a_sheet_for_a_dark_page(tmp_path: Path) -> None:
    target = tmp_path / "dark.svg"
    result = CliRunner().invoke(cli.app, ["lens", "gallery", "tessar-50mm", "--theme", "dark", "-o", str(target)])
    assert result.exit_code == 0, result.output
    drawn = target.read_text(encoding="utf-8")
    assert theme_named("dark").page in drawn
    assert theme_named("dark").text in drawn
    assert "fill: #ffffff" not in drawn
