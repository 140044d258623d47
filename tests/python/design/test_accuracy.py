"""Cost of the accuracy levels: the levels, their errors, and how they are reported."""

from __future__ import annotations

import json
import math
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from realcam.accuracy import AccuracyCost, Measured
from realcam.accuracy.error_plot import _spread
from realcam.accuracy.image_space_blur import diffused, gathered

from .. import scenes

LENS = rc.Lens.load("tessar-50mm").focused(1.0).with_coating("bare")


def scene() -> rc.Scene:
    """In front of a far board with a bright middle a near one, both in the light of a sky."""
    far, near = scenes.quad((0, 0, -20), 8, diffuse=0.2), scenes.quad((0.1, 0, -1), 0.12, diffuse=0.8)
    return scenes.scene_of(far, near, scenes.quad((0, 0, -19.9), 1.5, diffuse=0.9)).with_environment(100.0)


def camera(lens: rc.Lens = LENS) -> rc.Camera:
    return rc.Camera(lens, film=rc.Film(24, 16, (96, 64)), exposure_time_s=0.02, iso=100)


@pytest.fixture(scope="module")
def cost() -> AccuracyCost:
    return rc.accuracy_cost(scene(), camera(), device="cpu", size=24, max_spp=16, reference_spp=256)


def test_all_levels_are_there(cost: AccuracyCost) -> None:
    assert [level.name for level in cost.levels] == [
        "pinhole, gather filter",
        "pinhole, heat diffusion",
        "pinhole",
        "thin lens",
        "thin lens, distortion and vignetting",
        "thick lens",
        "polynomial lens",
        "full lens",
        "full lens, double precision",
        "+ dispersion",
        "+ diffraction",
        "+ coatings",
        "+ ghosts",
        "planned",
    ]
    assert [level.name for level in cost.samplings] == [
        "rear element, random",
        "rear element",
        "exit pupil",
        "pixel pupil",
        "fitted outline, random",
        "fitted outline",
        "fitted outline, lights traced",
    ]
    assert cost.size == (24, 16)
    assert not cost.missing
    assert not cost.impossible
    for level in (*cost.levels, *cost.samplings):
        assert [picture.spp for picture in level.pictures] == [1, 4, 16]
        assert all(picture.seconds > 0 for picture in level.pictures)
        assert level.lens_share + level.scene_share + level.other_share == pytest.approx(1)
        assert level.difference.shape == (16, 24)


def test_what_a_level_leaves_out_is_bias_and_no_noise(cost: AccuracyCost) -> None:
    levels = {level.name: level for level in cost.levels}
    # Everything sharp, and the board behind is to be out of focus.
    assert levels["pinhole"].bias_codes > 5
    assert levels["+ ghosts"].bias_codes < 2
    assert levels["full lens"].bias_codes < levels["thin lens"].bias_codes
    assert levels["pinhole, gather filter"].bias_codes < levels["pinhole"].bias_codes
    assert levels["pinhole, heat diffusion"].bias_codes < levels["pinhole"].bias_codes
    assert levels["full lens"].bias_codes == pytest.approx(levels["full lens, double precision"].bias_codes, abs=0.5)


def test_stratified_samples_are_better_than_random_ones(cost: AccuracyCost) -> None:
    samplings = {level.name: level for level in cost.samplings}
    assert samplings["fitted outline"].noise_codes < samplings["fitted outline, random"].noise_codes
    assert samplings["fitted outline, random"].noise_codes < samplings["rear element, random"].noise_codes


def test_time_to_an_error(cost: AccuracyCost) -> None:
    pictures = (Measured(1, 1.0, 8.0, None), Measured(4, 4.0, 4.0, None), Measured(16, 16.0, 2.0, None))
    level = replace(cost.levels[0], pictures=pictures, bias_codes=0.0)
    assert level.seconds_to(10) == 1
    assert level.seconds_to(4) == pytest.approx(4)
    assert level.seconds_to(math.sqrt(8)) == pytest.approx(8)  # between two pictures, on logarithmic scales
    assert level.seconds_to(1) == pytest.approx(64)  # noise falls with the square root of the time
    assert replace(level, bias_codes=1.5).seconds_to(1) == math.inf
    # A bias of 1.2 leaves a noise of 1.6, which four times the time halves.
    assert level.error_after(64.0) == pytest.approx(1.0)
    assert replace(level, bias_codes=1.2).error_after(64.0) == pytest.approx(math.hypot(1.2, 0.8))


def test_it_is_told_as_tables_and_json(cost: AccuracyCost) -> None:
    text = str(cost)
    for level in (*cost.levels, *cost.samplings):
        assert f"| {level.name} " in text
    assert "24 x 16 pixels on CPU" in text
    told = json.loads(cost.json())
    assert told["levels"][0]["pictures"][0]["spp"] == 1
    assert "difference" not in told["levels"][0]


@pytest.mark.slow
def test_the_figure_is_one_file(cost: AccuracyCost, tmp_path: Path) -> None:
    cost.figure(tmp_path / "a.svg")
    drawing = ElementTree.parse(tmp_path / "a.svg").getroot()
    text = "".join(drawing.itertext())
    assert "seconds of samples" in text
    assert "polynomial lens" in text
    for level in (*cost.levels, *cost.samplings):
        assert (f"Recommended: {level.name}." in text) == level.is_recommended
    cost.figure(tmp_path / "a.html")
    page = (tmp_path / "a.html").read_text()
    assert "<svg" in page
    assert "<table>" in page
    assert "http" not in page.replace("http://www.w3.org", "").replace("http://purl.org", "").replace(
        "http://creativecommons.org", ""
    ).replace("https://matplotlib.org", "")
    with pytest.raises(rc.ImageFileError, match=r"unknown suffix; expected \.svg or \.html"):
        cost.figure(tmp_path / "a.png")


@pytest.mark.parametrize("places", [[0.1, 0.11, 0.12, 0.9], [0.5] * 6, [0.9, 0.99, 1.0], [0.2, 0.8]])
def test_names_of_lines_keep_apart(places: list[float]) -> None:
    moved = _spread(np.array(places), 0.05)
    assert np.diff(moved).min() >= 0.05 - 1e-12
    assert moved[-1] <= 1
    # Alone, a name stays where its line ends.
    assert all(m == p for m, p in zip(moved, places, strict=True) if sum(abs(p - q) < 0.3 for q in places) == 1)


def test_an_interrupted_measurement_keeps_what_is_done() -> None:
    calls = 0

    def interrupt(_: float) -> None:
        nonlocal calls
        calls += 1
        if calls == 5:  # before the first, and before each of four levels
            raise KeyboardInterrupt

    cost = rc.accuracy_cost(
        scene(), camera(), device="cpu", size=12, max_spp=1, reference_spp=16, effects=(), progress=interrupt
    )
    assert [level.name for level in cost.levels] == ["pinhole, gather filter", "pinhole, heat diffusion", "pinhole"]
    assert cost.missing[:2] == ("thin lens", "thin lens, distortion and vignetting")
    assert cost.missing[-1] == "fitted outline, lights traced"
    assert "Interrupted; not measured: thin lens, " in str(cost)


def test_what_an_ideal_lens_cannot_show_is_named() -> None:
    lens = rc.Lens.load("fisheye-6mm-220deg")
    view = rc.Camera(lens, film=rc.Film(*lens.film_mm, (16, 16)), exposure_time_s=0.02)
    cost = rc.accuracy_cost(
        scene(), view, device="cpu", size=16, max_spp=1, reference_spp=16, effects=(), samplings=False
    )
    assert "full lens" in {level.name for level in cost.levels}
    assert set(cost.impossible).isdisjoint(level.name for level in cost.levels)
    assert not cost.samplings


# A pixel of light that spreads by an even disc has a variance of d^2 / 16 along each axis.
@pytest.mark.parametrize("filter_", ["gather", "diffuse"])
def test_blur_after_the_fact_has_the_size_of_the_disc(filter_: str) -> None:
    side, diameter = 65, 8.0
    point = np.zeros((side, side, 3), np.float32)
    point[side // 2, side // 2] = 1
    diameters, depth = np.full((side, side), diameter, np.float32), np.full((side, side), 5, np.float32)
    blurred = gathered(point, diameters, depth) if filter_ == "gather" else diffused(point, diameters)
    light = blurred[..., 0].astype(np.float64)
    assert light.sum() == pytest.approx(1, rel=1e-3)
    x = np.arange(side) - side // 2
    for axis in (0, 1):
        assert (light.sum(axis=axis) * x**2).sum() == pytest.approx(diameter**2 / 16, rel=0.02)


def test_what_is_sharp_is_not_blurred_by_what_lies_behind() -> None:
    """Both filters hold it: the gather filter by its rule, and diffusion because a sharp pixel conducts no heat."""
    picture, diameters, depth = np.zeros((32, 32, 3), np.float32), np.zeros((32, 32)), np.ones((32, 32))
    picture[:, 16:], diameters[:, 16:], depth[:, 16:] = 1, 6, 10
    for blurred in (gathered(picture, diameters.astype(np.float32), depth), diffused(picture, diameters)):
        assert blurred[:, :15].max() < 0.02
