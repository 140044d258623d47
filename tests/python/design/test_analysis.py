"""rc.analysis: arrays, plots of these arrays, and the commands."""

from __future__ import annotations

import dataclasses
import json
import re
from collections.abc import Callable
from functools import partial
from importlib import import_module
from pathlib import Path

import matplotlib.figure
import numpy as np
import pytest
import realcam as rc
import scipy.special
from matplotlib.backends.backend_agg import FigureCanvasAgg
from realcam.analysis import kinds
from realcam.analysis.report_plots import ReportPlots
from realcam.drawing.themes import LIGHT
from realcam.photography.comparison import lens_summary

from ..commands.test_command_line import said

analysis = rc.analysis
LENS = rc.Lens.load("double-gauss-50mm").stopped_down(4)
REPORT_PAGES = ReportPlots.pages
SMALL = {"spot-through-focus": {"fields_deg": np.array([0.0, 10.0])}}


def asked(lens: rc.Lens = LENS, **given: object) -> kinds.PlotArguments:
    return kinds.PlotArguments(lens, analysis.Bundles(lens), **given)  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def computed() -> dict[str, object]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(kinds, "field_map", partial(kinds.field_map, points=(5, 3)))
        return {kind: kinds.compute(kind, asked(**SMALL.get(kind, {}))) for kind in kinds.KINDS}


@pytest.mark.pictures
@pytest.mark.parametrize(("number", "kind"), enumerate(kinds.KINDS))
def test_every_plot_has_labels_and_units(computed: dict[str, object], number: int, kind: str) -> None:
    # A figure takes a second to draw, so sizes and themes take turns.
    size, theme = [("small", "dark"), ("large", "light")][number % 2]
    figure = analysis.plot_figure(kind, computed[kind], theme=theme, size=size)
    drawn = [axes for axes in figure.axes if axes.get_label() != "<colorbar>"]
    assert drawn
    lowest = [axes for axes in drawn if axes.get_subplotspec().is_last_row()]
    without_unit = {"contrast", "surface", "direction cosine y", "side by side, at the scale of direction cosine y"}
    for axes in drawn:
        for label in (axes.get_ylabel(), *([axes.get_xlabel()] if axes in lowest else [])):
            assert label, kind
            assert any(mark in label for mark in (" / ", "per mm", "index")) or label in without_unit, label
        assert axes.get_title()
    page = matplotlib.colors.to_rgb(figure.get_facecolor())
    ink = matplotlib.colors.to_rgb(drawn[0].yaxis.label.get_color())
    assert abs(sum(page) - sum(ink)) > 1.8, "the text stands out from the page"


# For each plot: index of the axes, index of the line, coordinate (0: x, 1: y), and the values that the line shows.
LINES: dict[str, tuple[int, int, int, Callable[..., np.ndarray]]] = {
    "ray-fan": (1, 2, 1, lambda fan: 1e3 * fan.tangential_mm[1, 2]),
    "spot": (2, 0, 1, lambda spots: 1e3 * spots.points_mm[0, 2, 0, :, 1]),
    "longitudinal": (0, 1, 0, lambda along: along.focus_mm[1]),
    "field-curves": (0, 1, 0, lambda curves: curves.sagittal_mm[0]),
    "distortion": (0, 0, 0, lambda bent: bent.percent),
    "lateral-colour": (0, 2, 0, lambda colour: 1e3 * colour.shift_mm[2]),
    "mtf": (0, 3, 1, lambda contrast: contrast.sagittal[0, 1]),
    "mtf-field": (0, 0, 1, lambda contrast: contrast.tangential[0, :, 0]),
    "mtf-focus": (0, 0, 1, lambda contrast: contrast.tangential[:, 0, 0]),
    "relative-illumination": (0, 0, 1, lambda light: 100 * light.relative_illumination),
}


@pytest.mark.pictures
@pytest.mark.parametrize("kind", LINES)
def test_lines_show_the_arrays(computed: dict[str, object], kind: str) -> None:
    axes, line, axis, shown = LINES[kind]
    drawn = analysis.plot_figure(kind, computed[kind]).axes[axes].get_lines()[line].get_data()[axis]
    np.testing.assert_array_equal(drawn, shown(computed[kind]))


@pytest.mark.pictures
def test_images_and_bars_show_the_arrays(computed: dict[str, object]) -> None:
    front, bars = computed["wavefront"], computed["seidel"]
    shown = analysis.plot_figure("wavefront", front).axes[0].get_images()[0].get_array()
    np.testing.assert_array_equal(np.ma.filled(shown, np.nan), front.map_waves)
    heights = [bar.get_height() for bar in analysis.plot_figure("seidel", bars).axes[0].patches]
    np.testing.assert_array_equal(np.reshape(heights, (7, -1))[:, :-1].T, bars.waves)


@pytest.mark.pictures
def test_colours_and_surfaces_are_named(computed: dict[str, object]) -> None:
    for kind in ("ray-fan", "spot", "longitudinal", "lateral-colour"):
        legends = [legend for axes in analysis.plot_figure(kind, computed[kind]).axes if (legend := axes.get_legend())]
        assert "486.1 nm" in [text.get_text() for legend in legends for text in legend.get_texts()], kind
    ticks = analysis.plot_figure("seidel", computed["seidel"]).axes[0].get_xticklabels()
    # Surface numbers are those of `lens info` and of lens files.
    assert [tick.get_text() for tick in ticks] == [*map(str, range(1, 1 + len(LENS.surfaces))), "sum"]
    assert "0°" in analysis.plot_figure("zernike", computed["zernike"]).axes[0].get_title()


@pytest.mark.slow
def test_curves_over_the_field_have_no_corners() -> None:
    """Straight lines between their points leave the curve by less than a line of the plot is wide: 1 in 100 of its
    range. Points halfway between theirs show it. The phone lens's distortion has three turns, its field curves two."""
    lens = rc.Lens.load("phone-4mm")
    light = analysis.Bundles(lens)
    for compute, name in (
        (analysis.distortion, "percent"),
        (analysis.field_curves, "tangential_mm"),
        (analysis.lateral_colour, "shift_mm"),
        (analysis.film_pupils, "relative_illumination"),
    ):
        drawn = compute(lens, bundles=light)
        many = compute(lens, bundles=light, samples=2 * len(drawn.fields_deg) - 1)
        curve, fine = (np.atleast_2d(getattr(data, name))[0] for data in (drawn, many))
        between = np.interp(many.fields_deg, drawn.fields_deg, curve)
        assert np.abs(between - fine).max() < 0.01 * np.ptp(fine), name


def test_contrast_has_no_corners() -> None:
    """Between its points the contrast over frequency bends the most at its zeros."""
    lens = rc.Lens.load("tessar-50mm")
    light = analysis.Bundles(lens)
    drawn = analysis.mtf_over_frequency(lens, 0.0, bundles=light)
    many = analysis.mtf_over_frequency(lens, 0.0, samples=2 * (len(drawn.frequencies_per_mm) - 1) + 1, bundles=light)
    between = [np.interp(many.frequencies_per_mm, drawn.frequencies_per_mm, curve) for curve in drawn.tangential[0]]
    assert np.abs(between - many.tangential[0]).max() < 0.01


def test_the_object_is_in_the_plane_in_focus() -> None:
    near = rc.Lens.load("double-gauss-50mm").focused(1.2).stopped_down(8)
    front_m = near.focus_distance_m - 1e-3 * near.film_position_mm
    for by_default, by_name in (
        (near.spot(10).points_mm, near.spot(10, object_distance_m=front_m).points_mm),
        (near.wavefront(10).opd_waves, near.wavefront(10, object_distance_m=front_m).opd_waves),
        (near.seidel(10).seidel_mm, near.seidel(10, object_distance_m=front_m).seidel_mm),
        (near.bundle(10).points_mm, near.bundle(10, object_distance_m=front_m).points_mm),
        (near.psf(10, size=16).values, near.psf(10, size=16, object_distance_m=front_m).values),
        (
            analysis.ray_fan(near, 10.0).tangential_mm,
            analysis.ray_fan(near, 10.0, object_distance_m=front_m).tangential_mm,
        ),
    ):
        np.testing.assert_allclose(by_default, by_name, rtol=1e-9, atol=1e-9, equal_nan=True)
    # In focus the spot is a hundredth of what the same lens makes of infinity.
    assert near.spot(0).rms_radius_mm < 0.1 * near.spot(0, object_distance_m=float("inf")).rms_radius_mm


def test_spots_are_those_of_the_lens() -> None:
    data = analysis.spot_diagram(LENS, [0.0, 15.0], [587.5618], rings=6)
    for f, field in enumerate((0.0, 15.0)):
        spot = LENS.spot(field, wavelength_nm=587.5618, samples=6)
        np.testing.assert_allclose(data.points_mm[0, f, 0] + spot.chief_ray_mm, spot.points_mm, atol=1e-9)
    moved = analysis.spot_diagram(LENS, [15.0], [587.5618], rings=6, defocus_mm=[0.2])
    there = LENS.spot(15.0, wavelength_nm=587.5618, samples=6, film_distance_mm=LENS.film_distance_mm + 0.2)
    np.testing.assert_allclose(moved.points_mm[0, 0, 0] + there.chief_ray_mm, there.points_mm, atol=1e-9)


def test_one_rule_gives_the_rms_radius_of_all_spots() -> None:
    """The plots, whatever their number of points, the tables of `compare` and the maps; by 300 000 rays of a grid."""
    for share, field in zip((0.0, 0.7), lens_summary(LENS, shares=(0.0, 0.7)).fields, strict=True):
        angle = field.field.angle_deg
        truth = 1e3 * LENS.spot(angle, pattern="grid", samples=600).rms_radius_mm
        # The cells at the edge of a round stop are cut: a hundredth of the light is off by half a cell.
        assert field.rms_spot_radius_um == pytest.approx(truth, rel=2e-3), share
        for rings in (7, 10):
            spots = analysis.spot_diagram(LENS, [angle], [LENS.wavelength_nm], rings=rings)
            assert 1e3 * spots.rms_radius_mm[0, 0] == pytest.approx(field.rms_spot_radius_um, rel=1e-9)


def test_the_spot_of_several_wavelengths_is_that_of_all_their_rays() -> None:
    colours = [486.1327, 587.5618, 656.2725]
    spots = [LENS.spot(15.0, wavelength_nm=nm, pattern="rings", samples=12) for nm in colours]
    points = np.concatenate([spot.points_mm for spot in spots])
    weights = np.concatenate([spot.weights / np.nansum(np.where(spot.status == 0, spot.weights, 0)) for spot in spots])
    passes = np.isfinite(points).all(axis=1)
    centre = np.average(points[passes], axis=0, weights=weights[passes])
    square = np.average(((points[passes] - centre) ** 2).sum(axis=1), weights=weights[passes])
    data = analysis.spot_diagram(LENS, [15.0], colours)
    assert data.rms_radius_mm[0, 0] == pytest.approx(np.sqrt(square), rel=1e-9)
    np.testing.assert_allclose(data.centroid_mm[0, 0] + spots[1].chief_ray_mm, centre, atol=1e-9)


def test_film_points_are_the_spot_of_very_many_rays() -> None:
    for lens, field in ((LENS, 15.0), (rc.Lens.load("phone-4mm"), 25.0), (LENS.with_iris(5), 0.0)):
        bundle = lens.bundle(field, arms=128, nodes=12)
        middle = bundle.energy @ bundle.points_mm
        size = np.sqrt(bundle.energy @ ((bundle.points_mm - middle) ** 2).sum(axis=1))
        for pattern in ("even", "grid"):
            for dtype in ("float32", "float64"):
                points = lens.film_points(field, 200_000, pattern=pattern, dtype=dtype).astype(float)
                assert 100_000 < len(points) <= 200_000
                # An edge's grid of 450 cells across is right within a thousandth; float32 within 0.3 um.
                np.testing.assert_allclose(points.mean(axis=0), middle, atol=2e-3 * size + 3e-4)
                found = np.sqrt(((points - points.mean(axis=0)) ** 2).sum(axis=1).mean())
                assert found == pytest.approx(size, rel=5e-3, abs=3e-4)
    with pytest.raises(rc.InputError, match="even or grid"):
        LENS.film_points(pattern="random")


@pytest.mark.parametrize(
    ("name", "field"),
    [("double-gauss-50mm", 5.0), ("double-gauss-50mm", 18.0), ("double-gauss-50mm", 21.0), ("tessar-50mm", 18.0),
     ("tessar-50mm", 21.0), ("fast-50mm", 20.0), ("zoom-70-200mm", 8.0), ("wide-24mm", 38.0), ("phone-4mm", 33.0)],
)  # fmt: skip
def test_film_points_miss_nothing_that_passes(name: str, field: float) -> None:
    """The reference is rays between the pupil's edges, which are searched with real rays. Contrast is sensitive to
    light missing at the edge, whose rays land farthest from the centre."""
    lens = rc.Lens.load(name)
    bundle = lens.bundle(field, arms=512, nodes=32)
    points = lens.film_points(field, 400_000, dtype="float64").astype(float)
    for axis in (0, 1):
        for frequency in (10.0, 20.0):
            turns = 2j * np.pi * frequency
            expected = abs(bundle.energy @ np.exp(turns * bundle.points_mm[:, axis]))
            found = abs(np.exp(turns * points[:, axis]).mean())
            # A sequence of 4e5 evenly spread points, cut by the edge of the light, is right within 1e-3.
            assert found == pytest.approx(expected, abs=1.5e-3)
    reach = np.abs(bundle.points_mm - points.mean(axis=0)).max(axis=0)
    assert (np.abs(points - points.mean(axis=0)).max(axis=0) > 0.97 * reach).all()


@pytest.mark.parametrize(("defocus_mm", "frequency"), [(0.0, 40.0), (0.5, 40.0), (1.0, 40.0), (3.0, 80.0)])
def test_geometric_mtf_has_as_many_rays_as_the_frequency_asks_for(defocus_mm: float, frequency: float) -> None:
    """Out of the focus of a hyperboloid that has no aberrations: light from the left, parallel in the glass, meets in
    one point behind it. A ray at the height h crosses the axis with the tangent h / (f - z), z the sag there."""
    n, radius_mm, stop_mm = 1.5, -50.0, 10.0
    f = radius_mm / (1 - n)
    surfaces = [
        rc.Stop(clear_semi_diameter_mm=stop_mm, thickness_mm=0),
        rc.Surface(thickness_mm=5, material=n, clear_semi_diameter_mm=12),
        rc.Surface(radius_of_curvature_mm=radius_mm, conic=-(n**2), clear_semi_diameter_mm=12),
    ]
    lens = rc.Lens(surfaces=surfaces, film_distance_mm=f)
    light = {"wavelengths_nm": [587.5618], "object_distance_m": np.inf, "method": "geometric"}
    mtf = analysis.mtf(lens, [0.0], [frequency], defocus_mm=[defocus_mm], **light)
    nodes, weights = np.polynomial.legendre.leggauss(400)
    h = stop_mm * np.sqrt((nodes + 1) / 2)  # evenly over the area
    sag = h**2 / radius_mm / (1 + np.sqrt(1 - (1 - n**2) * h**2 / radius_mm**2))
    at = defocus_mm * h / (f - sag)
    expected = abs(weights @ scipy.special.j0(2 * np.pi * frequency * at)) / 2
    assert mtf.tangential[0, 0, 0] == pytest.approx(expected, abs=2e-4)
    assert mtf.sagittal[0, 0, 0] == pytest.approx(expected, abs=2e-4)


def test_contrast_that_rays_cannot_tell_is_none() -> None:
    mtf = analysis.mtf(LENS, [10.0], [40.0, 4e5], method="geometric")
    assert np.isfinite(mtf.tangential[0, 0, 0])
    assert np.isnan(mtf.tangential[0, 0, 1])


def test_bundles_carry_all_the_light() -> None:
    bundle = LENS.bundle(20.0)
    assert bundle.energy.sum() == pytest.approx(1)
    half = len(bundle.energy) // 2
    assert bundle.mirrored
    np.testing.assert_array_equal(bundle.points_mm[:half] * (-1, 1), bundle.points_mm[half:])

    def area(of: object) -> float:
        start, end = of.edge_entry_mm[:, 0].T, of.edge_entry_mm[:, 1].T  # type: ignore[attr-defined]
        return 0.5 * abs(np.sum(start[0] * end[1] - start[1] * end[0]))

    assert area(bundle) == pytest.approx(area(LENS.bundle(20.0, arms=256)), rel=2e-3)


NOLL = [(0, 0), (1, 1), (1, -1), (2, 0), (2, -2), (2, 2), (3, -1), (3, 1), (3, -3), (3, 3), (4, 0), (4, 2), (4, -2),
        (4, 4), (4, -4)]  # fmt: skip
FRINGE = [(0, 0), (1, 1), (1, -1), (2, 0), (2, 2), (2, -2), (3, 1), (3, -1), (4, 0), (3, 3), (3, -3), (4, 2), (4, -2),
          (5, 1), (5, -1), (6, 0)]  # fmt: skip


@pytest.mark.parametrize(("order", "table"), [("noll", NOLL), ("fringe", FRINGE)])
def test_zernike_orders_and_norm(order: str, table: list[tuple[int, int]]) -> None:
    radius2, angle = np.meshgrid((np.arange(64) + 0.5) / 64, 2 * np.pi * np.arange(64) / 64)
    x, y = (np.sqrt(radius2) * f(angle) for f in (np.cos, np.sin))
    places = np.column_stack([x.ravel(), y.ravel()])
    required = np.linspace(-1, 1, 16)
    fit = analysis.fit_zernike(places, np.zeros(len(places)), order=order, terms=16)
    assert list(fit.nm)[: len(table)] == table
    value = dataclasses.replace(fit, coefficients_waves=required).at(places)
    again = analysis.fit_zernike(places, value, order=order, terms=16)
    np.testing.assert_allclose(again.coefficients_waves, required, atol=1e-12)
    assert again.residual_waves < 1e-12
    # Orthonormal: the mean square is the sum of squares, within the midpoint rule's error for 64 rings.
    assert np.mean(value**2) == pytest.approx(np.sum(required**2), rel=2e-3)
    with pytest.raises(rc.InputError, match="noll or fringe"):
        analysis.fit_zernike(places, value, order="ansi")


def test_zernike_polynomials_have_their_names() -> None:
    """Names as listed by J. C. Wyant and K. Creath (Applied Optics and Optical Engineering XI, 1992, table III)."""
    fit = analysis.zernike_fit(LENS, order="fringe", terms=25)
    names = dict(zip(fit.indices.tolist(), fit.names, strict=True))
    assert names[4] == "defocus"
    assert (names[5], names[6]) == ("astigmatism 0°", "astigmatism 45°")
    assert (names[7], names[9]) == ("coma x", "spherical")
    assert (names[12], names[14], names[16]) == ("secondary astigmatism 0°", "secondary coma x", "secondary spherical")
    assert (names[23], names[25]) == ("tertiary coma x", "tertiary spherical")


def test_lateral_and_axial_colour_are_the_lens_s_own() -> None:
    data = analysis.lateral_colour(LENS, [20.0])
    for shift, nm in zip(data.shift_mm[:, 0], data.wavelengths_nm, strict=True):
        difference = LENS.spot(20, wavelength_nm=nm).chief_ray_mm[1] - LENS.spot(20).chief_ray_mm[1]
        assert shift == pytest.approx(difference, abs=1e-9)
    along = analysis.longitudinal_aberration(LENS)
    first = [LENS.first_order(nm).back_focal_distance_mm - LENS.film_distance_mm for nm in along.wavelengths_nm]
    np.testing.assert_allclose(along.focus_mm[:, 0], first, atol=1e-5)


def test_cats_eyes_close_towards_the_corner() -> None:
    data = analysis.film_pupils(rc.Lens.load("double-gauss-50mm"), [0.0, 20.0])
    tall = [np.ptp(outline[..., 1]) for outline in data.outlines]
    wide = [np.ptp(outline[..., 0]) for outline in data.outlines]
    assert tall[0] == pytest.approx(wide[0], rel=1e-3)
    assert tall[1] < 0.75 * wide[1]
    ring = analysis.film_pupils(rc.Lens.load("mirror-telephoto-500mm"), [0.0])
    outer = np.ptp(ring.outlines[0][..., 0])
    assert ring.solid_angle_sr[0] < 0.9 * np.pi / 4 * outer**2, "the obstruction is left out"


def test_numbers_are_written(tmp_path: Path) -> None:
    data = analysis.distortion(LENS, [0.0, 10.0])
    assert json.loads(analysis.as_json(data))["percent"] == data.percent.tolist()
    analysis.save_numbers(data, tmp_path / "d.csv")
    lines = (tmp_path / "d.csv").read_text(encoding="utf-8").splitlines()
    assert lines[0] == "name,index_0,value"
    assert f"percent,1,{data.percent[1].item()!r}" in lines
    with pytest.raises(rc.ImageFileError, match=r"\.json or \.csv"):
        analysis.save_numbers(data, tmp_path / "d.txt")


@pytest.mark.slow
@pytest.mark.pictures
@pytest.mark.parametrize("name", ["fisheye-6mm-220deg", "mirror-telephoto-500mm"])
def test_reports_of_unlike_lenses(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[tuple[str, matplotlib.figure.Figure]] = []

    def pages_of(plots: ReportPlots) -> list[tuple[str, matplotlib.figure.Figure]]:
        made.extend(REPORT_PAGES(plots))
        return made

    monkeypatch.setattr(ReportPlots, "pages", pages_of)
    # The values of the fisheye's curves do not matter here. import_module, because the attribute realcam.analysis.mtf
    # is the function, not the module.
    monkeypatch.setattr(import_module("realcam.analysis.mtf"), "_MAX_DOUBLINGS", 2)
    analysis.save_report(rc.Lens.load(name), tmp_path / "r.html", wavelengths_nm=[546.0], theme="dark")
    text = (tmp_path / "r.html").read_text(encoding="utf-8")
    assert text.count("<svg") == 4
    assert "http://" not in text.replace("http://www.w3.org", "").replace("http://purl.org", "").replace(
        "http://creativecommons.org", ""
    ), "all that it shows is in it"
    pages = [page for _, page in made]
    assert [len(page.axes) > 4 for page in pages] == [True] * 3
    if name != "fisheye-6mm-220deg":
        return
    # The edge of its pupil is too uneven for a transfer function; texts with the reason stay within their plots.
    titles = [axes.get_title() for axes in pages[1].axes]
    assert "MTF, geometric" in titles
    assert "MTF over the field, geometric" in titles
    renderer = FigureCanvasAgg(pages[2]).get_renderer()
    reasons = [(axes, text) for axes in pages[2].axes for text in axes.texts if "a plane grid" in text.get_text()]
    assert len(reasons) == 1
    axes, text = reasons[0]
    assert text.get_window_extent(renderer).width < 1.3 * axes.bbox.width


@pytest.mark.pictures
@pytest.mark.slow
def test_a_report_begins_with_the_lens(tmp_path: Path) -> None:
    lens = rc.Lens.load("tessar-50mm")
    analysis.save_report(lens, tmp_path / "r.html")
    text = (tmp_path / "r.html").read_text(encoding="utf-8")
    before = text[: text.index("<h2>Rays")]
    table = re.search(r'<table class="surfaces">.*?<tbody>(.*)</tbody>', before, re.DOTALL)
    assert table
    rows = [re.findall("<td[^>]*>(.*?)</td>", row) for row in table[1].strip().splitlines()]
    assert len(rows) == len(lens.surfaces) + 1
    assert [row[2] for row in rows[:3]] == ["19.655", "plane", "-35.52"]  # of the patent, halved
    third = lens.seidel(analysis.field_angles_deg(lens, 1.0)[0])
    sums = 1e3 * np.concatenate([third.seidel_mm.sum(axis=0), third.colour_mm.sum(axis=0)])
    np.testing.assert_allclose([float(cell) for cell in rows[-1][6:]], sums, atol=0.0501)  # one digit
    assert "angle of view" in before
    assert lens.source in before


@pytest.mark.slow
@pytest.mark.pictures
def test_a_report_follows_the_browser_and_prints_light(tmp_path: Path) -> None:
    analysis.save_report(LENS, tmp_path / "r.html")
    analysis.save_report(LENS, tmp_path / "dark.html", theme="dark")
    both, dark = ((tmp_path / name).read_text(encoding="utf-8") for name in ("r.html", "dark.html"))
    assert "prefers-color-scheme: dark" in both
    assert "prefers-color-scheme" not in dark
    for page in (both, dark):
        assert f"--page: {LIGHT.page}" in page[page.index("@media print") :]
        drawn = page[page.index("<h1>") :]
        for colour in (LIGHT.text, LIGHT.page, LIGHT.glass, LIGHT.grid):
            assert colour not in drawn, "a dark page would show it as it is"
    with pytest.raises(rc.InputError, match="theme"):
        analysis.save_report(LENS, tmp_path / "r.html", theme="pink")


@pytest.fixture
def realcam(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Callable[..., tuple[int, str, str]]:
    """Exit code, stdout and stderr of `realcam lens ...` in `tmp_path`."""
    monkeypatch.chdir(tmp_path)
    return lambda *words: said(["lens", *words], monkeypatch, capsys)


@pytest.mark.slow
@pytest.mark.pictures
def test_commands(tmp_path: Path, realcam: Callable[..., tuple[int, str, str]]) -> None:
    code, _, errors = realcam("report", "tessar-50mm", "--focus", "2", "--f-number", "5.6", "-o", "r.pdf")
    assert code == 0, errors
    assert (tmp_path / "r.pdf").read_bytes().startswith(b"%PDF")
    code, text, errors = realcam("plot", "distortion", "tessar-50mm", "-o", "d.svg", "-o", "d.csv", "--json")
    assert code == 0, errors
    assert "percent" in json.loads(text)
    assert (tmp_path / "d.svg").is_file()
    assert (tmp_path / "d.csv").is_file()
    fisheye = ("fisheye-6mm-220deg", "--method", "geometric", "--fields-deg", "0,100", "--wavelengths", "546")
    code, text, errors = realcam("plot", "mtf", *fisheye, "--json")
    assert code == 0, errors
    assert json.loads(text)["method"] == "geometric"
    _, text, errors = realcam("plot", "psf", "tessar-50mm", "--f-number", "8", "--method", "fft", "--json")
    assert json.loads(text)["method"] == "fft", errors
