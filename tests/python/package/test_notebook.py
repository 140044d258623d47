"""Output in notebooks: PNG files and tables, by the methods that IPython calls; and texts without arrays."""

from __future__ import annotations

import dataclasses
import io
import subprocess
import sys
from html.parser import HTMLParser
from typing import Any

import matplotlib
import matplotlib.image
import numpy as np
import pytest
import realcam as rc
from realcam.analysis import KINDS, Bundles, notebook
from realcam.analysis.kinds import PlotArguments
from realcam.drawing import lens_drawings

from .picklable_values import image, plan

LENS = rc.Lens.load("double-gauss-50mm")


def picture_of(png: bytes) -> np.ndarray:
    """The codes of a PNG file, without transparency."""
    codes: np.ndarray = np.round(255 * matplotlib.image.imread(io.BytesIO(png), format="png"))
    return codes[:, :, :3]


class Cells(HTMLParser):
    """The texts between tags."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.texts: list[str] = []
        self.open: list[str] = []
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: Any) -> None:
        self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.texts.append(data)


def test_a_picture_is_shown_developed() -> None:
    rng = np.random.default_rng(1)
    picture = dataclasses.replace(
        image(), pixels=rng.random((20, 30, 3), dtype=np.float32), depth=np.ones((20, 30), np.float32), layers={}
    )
    np.testing.assert_array_equal(picture_of(picture._repr_png_()), picture.developed())


def test_a_large_picture_is_shown_smaller_with_the_same_light() -> None:
    columns, rows = 2403, 7  # every third column and row is kept, and 7 rows are no multiple of 3
    exposure = np.zeros((rows, columns, 3), np.float32)
    exposure[:, ::3] = 0.3  # the mean of three is 0.1
    picture = dataclasses.replace(image(), pixels=exposure, depth=np.ones((rows, columns), np.float32), layers={})
    even = dataclasses.replace(
        picture, pixels=np.full((1, 1, 3), 0.1, np.float32), depth=np.ones((1, 1), np.float32)
    ).developed()
    shown = picture_of(picture._repr_png_())
    assert shown.shape == (2, 801, 3)
    np.testing.assert_allclose(shown - even, 0, atol=1)  # a code, for the rounding of means


def test_a_lens_is_shown_as_its_drawing_and_drawn_with_options() -> None:
    shown = picture_of(LENS._repr_png_())  # type: ignore[attr-defined]  # what IPython calls
    marked, dark = (
        picture_of(figure._repr_png_())  # type: ignore[attr-defined]
        for figure in (LENS.draw(marks=True), LENS.draw(theme="dark"))
    )
    assert shown.shape[1] == marked.shape[1] == 1000  # ten inches at 100 pixels each
    assert not np.array_equal(shown, marked)
    assert shown[0, 0].mean() > 200  # the page
    assert dark[0, 0].mean() < 60
    with pytest.raises(rc.InputError, match="theme"):
        LENS.draw(theme="blue")


def test_a_lens_that_cannot_be_drawn_is_shown_as_text(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*words: Any, **options: Any) -> None:
        raise rc.InputError("no light passes the lens")

    monkeypatch.setattr(lens_drawings, "cross_section", refuse)
    assert LENS._repr_png_() is None  # type: ignore[attr-defined]


def test_a_plan_is_shown_as_a_table() -> None:
    decided = plan()
    texts = Cells(decided._repr_html_()).texts  # type: ignore[attr-defined]  # what IPython calls
    for decision in decided.decisions:
        assert decision.effect in texts
        assert decision.reason in texts


def test_a_fit_is_shown_as_a_table() -> None:
    fit = rc.fit_camera_model(rc.Camera(LENS), "opencv5")
    texts = Cells(fit._repr_html_()).texts
    assert f"{fit.coefficients[1]:.6g}" in texts
    assert texts[texts.index("k2") + 1] == f"{fit.coefficients[1]:.6g}"
    assert repr(fit).startswith("<realcam.CameraModelFit opencv5 of <realcam.Camera with double-gauss-50mm")


@pytest.mark.parametrize("kind", ["ray-fan", "mtf", "mtf-field", "mtf-focus", "distortion", "seidel", "zernike"])
def test_an_analysis_is_shown_as_its_plot(kind: str) -> None:
    data = KINDS[kind].compute(PlotArguments(LENS, Bundles(LENS)))
    assert notebook.kind_of(data) == kind
    shown = picture_of(data._repr_png_())
    assert min(shown.shape[:2]) > 100
    assert len(np.unique(shown.reshape(-1, 3), axis=0)) > 20  # lines and text


def test_a_point_spread_function_is_shown_in_decades() -> None:
    """White is the peak and black a ten-thousandth of it, by the ends of matplotlib's "inferno"."""
    psf = LENS.psf(10.0, [486.1, 656.3], size=32)
    shown = picture_of(psf._repr_png_())  # type: ignore[attr-defined]  # what IPython calls
    assert shown.shape == (300, 420, 3)
    colours = {tuple(colour) for colour in shown.reshape(-1, 3)}
    assert {tuple(np.round(255 * np.array(matplotlib.colormaps["inferno"](end)[:3]))) for end in (0.0, 1.0)} <= colours
    assert repr(psf).startswith("<realcam.PSF") and len(repr(psf)) < 200


def test_every_analysis_has_a_plot() -> None:
    data = {thing for thing in vars(rc.analysis).values() if dataclasses.is_dataclass(thing)}
    assert set(notebook.KIND_OF) == data - {Bundles}


@pytest.mark.parametrize(
    "make",
    [
        lambda: rc.analysis.spot_diagram(LENS),
        lambda: rc.analysis.wavefront_map(LENS),
        lambda: rc.analysis.zernike_fit(LENS),
        lambda: rc.cross_section(LENS),
        lambda: rc.cross_section(LENS).bundles[0],
        lambda: rc.cross_section(LENS).elements[0],
        lambda: rc.fit_camera_model(rc.Camera(LENS)),
        image,
        plan,
    ],
)
def test_texts_are_short_and_hold_no_arrays(make: Any) -> None:
    text = repr(make())
    assert text.startswith("<realcam.")
    assert "array(" not in text
    assert "\n" not in text
    assert len(text) < 400


def test_realcam_alone_loads_neither_matplotlib_nor_readers_of_files() -> None:
    """Importing one of them takes longer than importing everything else."""
    others = {"matplotlib", "OpenImageIO", "PIL", "pxr", "PyOpenColorIO"}
    code = f"import sys, realcam; sys.exit(bool({others} & set(sys.modules)))"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
