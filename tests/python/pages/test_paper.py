"""The source paper's experiments: their numbers against closed forms, and the page."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from paper import EXPERIMENTS, save_page
from paper.depth_of_field import CIRCLE_MM, magnification_for, measured_blur_mm
from paper.snell import refracted


@pytest.mark.parametrize("angle", [10.0, 40.0, 80.0])
def test_the_square_makes_snells_law(angle: float) -> None:
    n = 1.5168
    ray = np.array([math.sin(math.radians(angle)), 0.0, math.cos(math.radians(angle))])
    right, printed = (refracted(ray, 1 / n, is_printed) for is_printed in (False, True))
    assert np.linalg.norm(right) == pytest.approx(1, abs=1e-14)
    assert right[0] == pytest.approx(ray[0] / n, abs=1e-14)
    assert abs(np.linalg.norm(printed) - 1) > 1e-3


@pytest.mark.parametrize("f_number", [1.4, 5.6, 22.0])
def test_equation_8_holds_for_what_is_said(f_number: float) -> None:
    m = magnification_for(7.86, f_number, CIRCLE_MM)
    assert 2 * f_number * CIRCLE_MM * (m + 1) / m**2 == pytest.approx(7.86, rel=1e-12)


def test_blur_in_the_picture_is_that_of_the_thin_lens() -> None:
    lens = rc.Lens.load("double-gauss-50mm").stopped_down(5.6).focused(0.5)
    offsets, diameters = measured_blur_mm(lens, "thin", "cpu")
    data = lens.first_order()
    # Distances from the front principal plane; the blur of a thin lens is its aperture times the magnification times
    # the distance out of focus over that of the object.
    f = data.effective_focal_length_mm
    principal = data.front_focal_distance_mm + f
    focus = 1000 * lens.focus_distance_m - lens.film_position_mm + principal
    expected = data.entrance_pupil_diameter_mm * f / (focus - f) * np.abs(offsets) / (focus + offsets)
    far = np.abs(offsets) > 4  # elsewhere pixels and lights are as wide as the blur
    # The stop of the thin model stands in the entrance pupil, millimetres from the principal plane of this formula.
    np.testing.assert_allclose(diameters[far], expected[far], rtol=0.06)


def test_the_page_has_numbers_beside_numbers(tmp_path: Path) -> None:
    names: list[str] = []
    save_page(tmp_path / "paper.html", device="cpu", only=["lens-table", "snell"], progress=names.append)
    assert names == ["lens-table", "snell"]
    text = (tmp_path / "paper.html").read_text(encoding="utf-8")
    cells = re.findall(r"<t[dh][^>]*>([^<]*)", text)
    assert "paper" in cells
    assert any("50.358 mm, f/2.03" in cell for cell in cells)
    assert any("degrees traced" in cell for cell in cells)
    assert "<svg" in text
    assert "src=" not in text.replace('src="data:', "")


def test_mistakes_are_said(tmp_path: Path) -> None:
    with pytest.raises(rc.ImageFileError, match=r"expected \.html"):
        save_page(tmp_path / "paper.pdf")
    with pytest.raises(rc.InputError, match="unknown experiment"):
        save_page(tmp_path / "paper.html", only=["figure-1"])
    assert set(EXPERIMENTS) >= {"aberrations", "distortion", "depth-of-field", "speed", "pixel-pupil"}
    assert not list(tmp_path.iterdir())
