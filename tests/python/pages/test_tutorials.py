"""The tutorials of examples/tutorials run in the repository's folder, and show what optics says."""

from __future__ import annotations

import dataclasses
import os
import runpy
import shutil
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import pytest
import realcam as rc

ROOT = Path(__file__).resolve().parents[3]
TUTORIALS = ROOT / "examples" / "tutorials"


def run(name: str, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """The names that a tutorial leaves."""
    import matplotlib.pyplot as plt

    matplotlib.use("Agg")
    monkeypatch.chdir(ROOT)
    try:
        return runpy.run_path(str(TUTORIALS / f"{name}.py"))
    finally:
        plt.close("all")


def test_every_tutorial_has_a_test() -> None:
    here = Path(__file__).read_text(encoding="utf-8")
    names = [path.stem for path in TUTORIALS.glob("*.py")]
    assert len(names) == 6 and all(f"def test_{name}" in here for name in names)


def middle(image: np.ndarray) -> np.ndarray:
    """The third of the picture about its middle, in both directions."""
    rows, columns = image.shape[0] // 3, image.shape[1] // 3
    return image[rows : 2 * rows, columns : 2 * columns]


def test_photographer(monkeypatch: pytest.MonkeyPatch) -> None:
    render = rc.render
    monkeypatch.setattr(rc, "render", lambda *of, spp, **words: render(*of, spp=spp // 4, **words))
    seen = run("photographer", monkeypatch)
    # Four times the time at half the aperture is the same exposure, within 0.5% on the axis. What is out of focus
    # brings light across the edge of the region, a few pixels of its 80. The noise of 4000 pixels of 12 samples is
    # below 2%.
    means = [middle(image.pixels).mean() for image in seen["images"].values()]
    assert means == pytest.approx([means[0]] * 3, rel=0.05)
    # In front of the focus and behind it, each stop makes more of the world sharp.
    depths = [rc.depth_of_field(seen["stopped_down"](n).lens).real for n in seen["f_numbers"]]
    assert depths[0].near_m > depths[1].near_m > depths[2].near_m
    assert depths[0].far_m < depths[1].far_m < depths[2].far_m
    # The other lens has the same f-number. So near, its light is that of its working f-number. At the edge of the
    # region rims take 3% of the one's light and 1% of the other's.
    gauss, sonnar = (
        rc.photographic_figures(lens).working_f_number for lens in (seen["stopped_down"](2.1).lens, seen["sonnar"])
    )
    assert middle(seen["other"].pixels).mean() == pytest.approx(means[0] * (gauss / sonnar) ** 2, rel=0.05)
    # The meter's exposure is middle grey: 10 / ISO lux seconds on the average, here with 4 times the ISO.
    assert seen["metered"].iso == 400


def test_lens_designer(monkeypatch: pytest.MonkeyPatch) -> None:
    seen = run("lens_designer", monkeypatch)
    # The source of the lens prints 50 mm, and two digits of f/4.
    assert seen["data"].effective_focal_length_mm == pytest.approx(50, abs=0.05)
    assert seen["data"].f_number == pytest.approx(4.0, abs=0.05)

    def spot(lens: rc.Lens) -> float:
        return float(np.sqrt(np.mean([lens.spot(field).rms_radius_mm ** 2 for field in seen["fields_deg"]])))

    assert spot(seen["bent"]) > 2 * spot(seen["lens"])
    assert spot(seen["found"].lens) < 0.5 * spot(seen["bent"])
    # An error of the focal length counts as much as spots of that radius: it is smaller than they were.
    found = seen["found"].lens.first_order().effective_focal_length_mm
    assert found == pytest.approx(50, abs=spot(seen["bent"]))


def test_vision_engineer(monkeypatch: pytest.MonkeyPatch) -> None:
    seen = run("vision_engineer", monkeypatch)
    # The intersection of a pixel's ray with the board z = 0 gives the square, and so whether it is light or dark. Blur
    # does not reach the middle half of a square: it is some hundredths of a square wide.
    columns, rows = seen["camera"].film.resolution
    pixels = np.stack(np.meshgrid(np.arange(columns) + 0.5, np.arange(rows) + 0.5), axis=-1).reshape(-1, 2)
    origins, directions = seen["camera"].ray(pixels)
    places = (origins - directions * (origins[:, 2:] / directions[:, 2:]))[:, :2] / seen["square"]
    inside = np.all(np.abs(places - np.floor(places) - 0.5) < 0.25, axis=1)
    parity = np.floor(places).sum(axis=1) % 2 == 0
    light = seen["image"].pixels.reshape(-1, 3).mean(axis=1)
    dark, bright = sorted((light[inside & parity], light[inside & ~parity]), key=np.mean)
    # The corners get half of the light of the middle, and a dark square reflects less than a tenth of a light one.
    assert dark.max() < bright.min()
    assert seen["fit"].rms_px < 0.1
    np.testing.assert_allclose(seen["depth_m"], 1.1, rtol=1e-6)  # float32 of a board across the axis


@pytest.mark.picture_files
def test_calibrated_stereo(monkeypatch: pytest.MonkeyPatch) -> None:
    from realcam import dataset

    make = dataset.make
    monkeypatch.setattr(dataset, "make", lambda recipe, *of: make(dataclasses.replace(recipe, count=4), *of))
    seen = run("calibrated_stereo", monkeypatch)
    try:
        assert seen["error"].everywhere_px < 0.05
        assert {"right.png", "right.depth.npy", "flow.npy", "right.flow.npy"} <= seen["first"].keys()
        assert seen["first"]["right.png"].shape == (240, 320, 3)
        # A corner is symmetrical about its middle, so blur and tone leave its saddle. Perspective and other edges
        # within 3 pixels displace it by some tenths, each to another side.
        distances = seen["distances"]
        assert len(distances) > 40
        assert np.abs(np.median(distances, axis=0)).max() < 0.1
        assert np.median(np.linalg.norm(distances, axis=1)) < 0.25
    finally:
        shutil.rmtree(seen["folder"])


def test_renderer(monkeypatch: pytest.MonkeyPatch) -> None:
    seen = run("renderer", monkeypatch)
    # The exposure of every lens is that of its outermost ray within 0.5%. 25 pixels of 64 rays add little, because
    # weights in the middle differ by few per cent.
    assert seen["by_rays"] == pytest.approx(seen["by_formula"], rel=0.02)
    # Other rays show the same. A sample's light spreads about its mean by less than that mean, so the mean of n samples
    # by less than 1 / sqrt(n) of it, and that of the first picture by less; 4 of these are enough.
    again = seen["photograph"](seen["camera"], spp=24, seed=7)
    assert again.mean() == pytest.approx(seen["exposure"].mean(), rel=4 / np.sqrt(24 * again.size / 3))


def test_cpp_developer(monkeypatch: pytest.MonkeyPatch) -> None:
    is_built = (ROOT / "build" / "dev" / "librealcam_lens_io.a").is_file()
    if not is_built or not shutil.which(os.environ.get("CXX", "c++")):
        pytest.skip("wants a compiler, and the libraries of ./run setup in build/dev")
    points = run("cpp_developer", monkeypatch)["points_mm"]
    lens = rc.Lens.load("tessar-50mm")
    radius = lens.first_order().entrance_pupil_diameter_mm / 2
    x, y = np.meshgrid(np.linspace(-radius, radius, 31), np.linspace(-radius, radius, 31), indexing="ij")
    origins = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    out = lens.trace(origins, np.tile([0.0, 0.0, 1.0], (x.size, 1)), start="scene")
    on_film = (
        out.origins_mm
        + out.directions * ((lens.film_position_mm - out.origins_mm[:, 2]) / out.directions[:, 2])[:, None]
    )
    # The program prints nine decimals, so half of the last one is open.
    np.testing.assert_allclose(points, on_film[out.status == rc.RayStatus.OK][:, :2], atol=1e-9)
