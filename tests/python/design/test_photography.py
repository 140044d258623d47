"""Photographers' figures against closed forms, of a lens so weak and thin that they hold."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
import realcam as rc
import typer
from matplotlib.figure import Figure
from realcam.analysis import DepthOverFocus, depth_over_focus, plot_depth_over_focus
from realcam.cli import app as cli
from realcam.photography import (
    angle_of_view_deg,
    blur_diameter_mm,
    breathing,
    depth_of_field,
    exposure_value,
    lens_summary,
    magnification,
    photographic_figures,
    working_f_number,
)
from realcam.photography.formulas import ThinLens
from typer.testing import CliRunner

GAUSS = rc.Lens.load("double-gauss-50mm")


def thin_lens(f_number: float = 20.0, focal_length_mm: float = 100.0) -> rc.Lens:
    """Equiconvex, as thin as its rims allow, its stop in contact: so without distortion, and with little spherical
    aberration."""
    radius, stop = focal_length_mm, 0.5 * focal_length_mm / f_number  # 1/f = (1.5 - 1) 2 / R
    rim = 1.1 * stop
    thickness = 1.05 * rim**2 / radius  # a little more than both sags
    return rc.Lens(
        surfaces=[
            rc.Surface(radius_of_curvature_mm=radius, thickness_mm=thickness, material=1.5, clear_semi_diameter_mm=rim),
            rc.Surface(radius_of_curvature_mm=-radius, thickness_mm=0.0, clear_semi_diameter_mm=rim),
            rc.Stop(clear_semi_diameter_mm=stop),
        ],
        name="thin",
    )


@pytest.mark.parametrize("distance_m", [0.5, 2.0, 5.0])
@pytest.mark.parametrize("circle_mm", [0.03, 0.1])
def test_depth_of_field_of_a_thin_lens_is_the_formulas(distance_m: float, circle_mm: float) -> None:
    """Compared in inverse distances, in which blur is uniform.

    The formulas leave out spherical aberration, whose blur of s < 2 um adds to the circle c as s^2 / (2 c^2), below
    0.3%, and the stop's distance of 0.06 mm from the principal plane, below 0.1% of the cone.
    """
    lens = thin_lens().focused(distance_m)
    assert blur_diameter_mm(lens) < 0.002
    dof = depth_of_field(lens, circle_mm)
    for real, formula in ((dof.real.near_m, dof.formula.near_m), (dof.real.far_m, dof.formula.far_m)):
        assert 1 / real - 1 / distance_m == pytest.approx(1 / formula - 1 / distance_m, rel=5e-3)
    assert dof.focus_distance_m == distance_m


def test_infinity_is_sharp_from_the_hyperfocal_distance_on() -> None:
    dof = depth_of_field(thin_lens().focused(30), 0.03)
    data = thin_lens().first_order()
    hyperfocal_mm = data.effective_focal_length_mm**2 / (data.f_number * 0.03) + data.effective_focal_length_mm
    # Distances count from the film, which is one focal length behind the lens.
    assert dof.formula_hyperfocal_m == pytest.approx((hyperfocal_mm + 100) / 1000, abs=1e-3)
    assert dof.real_hyperfocal_m == pytest.approx(dof.formula_hyperfocal_m, rel=5e-3)
    assert dof.real.far_m == dof.formula.far_m == math.inf
    assert dof.real.near_m == pytest.approx(dof.formula.near_m, rel=5e-3)
    at_infinity = depth_of_field(thin_lens(), 0.03)
    assert at_infinity.real.far_m == at_infinity.approximate_depth_m == math.inf
    assert at_infinity.real.near_m == pytest.approx(at_infinity.real_hyperfocal_m, rel=0.02)


def test_equation_8_is_the_exact_depth_less_one_factor() -> None:
    """far - near = 2 N c (m + 1) / m^2 / (1 - (N c / (f m))^2), by algebra of the thin-lens limits."""
    lens, circle = thin_lens().focused(2.0), 0.05
    thin, dof = ThinLens.of(lens), depth_of_field(lens, circle)
    m, f, n = thin.magnification, thin.focal_length_mm, thin.f_number
    assert dof.approximate_depth_m == pytest.approx(2 * n * circle * (m + 1) / m**2 / 1000, rel=1e-12)
    assert dof.formula.depth_m == pytest.approx(dof.approximate_depth_m / (1 - (n * circle / (f * m)) ** 2), rel=1e-9)
    assert magnification(lens) == pytest.approx(m, rel=2e-3)  # real rays focus at another plane by their aberration


def test_blur_of_a_defocused_lens_is_its_disc() -> None:
    """A uniform disc's diameter is sqrt(8) times its RMS radius. Here it is A |s'' - s'| / s'' by similar triangles."""
    lens = thin_lens()
    expected = 5.0 * 100 / 10_000  # stop of 5 mm; an object at 10 m is imaged f^2 / (s - f) behind the film
    assert blur_diameter_mm(lens, 10.0) == pytest.approx(expected, rel=3e-3)


def test_a_lens_that_is_never_sharp_says_so() -> None:
    lens = rc.Lens.load("singlet-100mm")
    dof = depth_of_field(lens, 0.001)
    assert dof.blur_in_focus_mm > 0.001
    assert math.isnan(dof.real.near_m)
    assert math.isnan(dof.real.far_m)
    assert math.isnan(dof.real_hyperfocal_m)
    assert math.isfinite(dof.formula.near_m)
    for circle in (0.0, -1.0, math.inf, math.nan):
        with pytest.raises(rc.InputError, match="circle of confusion"):
            depth_of_field(lens, circle)


def test_the_film_tells_the_circle_of_confusion() -> None:
    assert depth_of_field(thin_lens()).circle_of_confusion_mm == pytest.approx(math.hypot(36, 24) / 1500)


def test_the_limits_are_where_the_blur_is_the_circle() -> None:
    lens = GAUSS.focused(2).stopped_down(8)
    dof = depth_of_field(lens)
    for limit in (dof.real.near_m, dof.real.far_m):
        blur = blur_diameter_mm(lens, limit - lens.film_position_mm / 1000)
        assert blur == pytest.approx(dof.circle_of_confusion_mm, rel=1e-5)
    focused = lens.focused(dof.real_hyperfocal_m)
    assert blur_diameter_mm(focused, math.inf) == pytest.approx(dof.circle_of_confusion_mm, rel=1e-5)


@pytest.mark.parametrize("focal_length_mm", [50.0, 100.0])
def test_angle_of_view_without_distortion(focal_length_mm: float) -> None:
    """2 atan(w / 2 f): a thin lens with the stop in contact has no distortion, its thickness leaves 1e-4."""
    lens = thin_lens(30, focal_length_mm)
    f = lens.film_distance_mm
    for angle, size in zip(angle_of_view_deg(lens), (36, 24, math.hypot(36, 24)), strict=True):
        assert angle == pytest.approx(math.degrees(2 * math.atan(size / (2 * f))), rel=2e-3)
    figures = photographic_figures(lens)
    assert figures.angle_of_view_by_formula_deg == pytest.approx(angle_of_view_deg(lens), rel=2e-3)


def test_a_lens_that_moves_as_a_whole_gets_narrower_as_it_comes_nearer() -> None:
    """2 atan(w / (2 f (1 + m))) with m = 1/10."""
    breath = breathing(thin_lens())
    assert breath.is_assumed
    near, far = (math.atan(0.5 * math.hypot(36, 24) / (100 * k)) for k in (1.1, 1))
    assert breath.change_percent == pytest.approx(100 * (near / far - 1), abs=0.1)
    # f (2 + m + 1 / m) from object to film.
    assert breath.nearest_focus_m == pytest.approx(0.1 * 12.1, rel=1e-3)
    telephoto = breathing(rc.Lens.load("telephoto-200mm-inner-focus"))
    assert not telephoto.is_assumed
    assert telephoto.nearest_focus_m == 2.5


def test_working_f_number_is_n_times_1_plus_m() -> None:
    lens = thin_lens().focused(0.5)
    m = magnification(lens)
    assert working_f_number(lens) == pytest.approx(20 * (1 + m), rel=2e-3)
    assert photographic_figures(lens).working_f_number_by_formula == pytest.approx(20 * (1 + m), rel=2e-3)


def test_exposure_values() -> None:
    """f/16 and 1/125 s are EV 15 as engraved, 14.97 by log2; ISO 400 is right for a quarter of the light."""
    lens = GAUSS.stopped_down(16)
    value = exposure_value(lens, 1 / 125)
    assert value.ev == pytest.approx(math.log2(16**2 * 125), rel=1e-12)
    assert value.ev100 == value.ev
    assert exposure_value(lens, 1 / 125, 400).ev100 == pytest.approx(value.ev - 2)
    assert value.ev100_at_film == pytest.approx(math.log2(lens.t_stop**2 * 125), rel=1e-9)
    near = lens.focused(0.5)
    extension = working_f_number(near) / working_f_number(lens)
    assert exposure_value(near, 1 / 125).ev100_at_film == pytest.approx(
        value.ev100_at_film + 2 * math.log2(extension), abs=1e-9
    )
    for time_s, iso in ((0, 100), (-1, 100), (math.nan, 100), (1, 0), (1, math.inf)):
        with pytest.raises(rc.InputError):
            exposure_value(lens, time_s, iso)


def test_an_engraved_f_number_stays_while_a_group_moves() -> None:
    lens = rc.Lens.load("telephoto-200mm-inner-focus").stopped_down(4)
    assert photographic_figures(lens.focused(2.5)).f_number == pytest.approx(4, rel=1e-9)


def test_a_summary_has_the_spots_of_its_fields() -> None:
    summary = lens_summary(GAUSS.stopped_down(8), mtf_frequencies_per_mm=(20,))
    assert summary.element_count == 6
    assert summary.length_mm == GAUSS.film_position_mm
    for place in summary.fields:
        spot = GAUSS.stopped_down(8).spot(place.field.angle_deg, pattern="rings", samples=12)
        assert place.rms_spot_radius_um == 1000 * spot.rms_radius_mm
        assert place.mtf_tangential is not None
        assert 0 < place.mtf_tangential[0] < 1


def test_the_commands_print_figures(tmp_path: Path) -> None:
    run = CliRunner().invoke
    result = run(cli.app, ["lens", "photo", "double-gauss-50mm", "--focus", "3", "--f-number", "8"])
    assert result.exit_code == 0, result.output
    assert "depth of field" in result.output
    result = run(cli.app, ["lens", "photo", "double-gauss-50mm", "--json", "--exposure-time", "1/125"])
    figures = json.loads(result.output)
    assert figures["depth_of_field"]["formula"]["far_m"] is None
    assert figures["exposure"]["exposure_time_s"] == 0.008
    target = tmp_path / "both.svg"
    result = run(cli.app, ["lens", "compare", "tessar-50mm", "sonnar-50mm", "--f-number", "4", "-o", str(target)])
    assert result.exit_code == 0, result.output
    assert all(lens in result.output for lens in ("Tessar", "Sonnar"))
    assert "Sonnar 50 mm" in target.read_text(encoding="utf-8")
    result = run(cli.app, ["lens", "compare", "tessar-50mm", "sonnar-50mm", "--json"])
    assert [lens["lens"] for lens in json.loads(result.output)] == ["tessar-50mm", "sonnar-50mm"]


def test_depth_of_field_over_distance_of_a_thin_lens_is_the_formulas() -> None:
    """The lens is focused with its stop open. Its longitudinal spherical aberration, 1.7 h^2 / f or 4 um at f/100,
    shifts the focus of the closed stop by half of that at most, while N c = 5 mm makes the blur: within 0.1%."""
    lens, stops, places_m = thin_lens(100), np.array([100.0, 200.0, 400.0]), np.array([0.5, 1.0, 3.0])
    data = depth_over_focus(lens, stops, places_m, circle_of_confusion_mm=0.05)
    f = lens.first_order().effective_focal_length_mm
    hyperfocal = f * f / (stops[:, None] * 0.05) + f
    # From the principal plane, which lies in the lens; the image is s f / (s - f) behind it.
    image = np.array([lens.focused(place).film_position_mm for place in places_m])
    s = 1000 * places_m - image
    near, far = s * (hyperfocal - f) / (hyperfocal + s - 2 * f), s * (hyperfocal - f) / (hyperfocal - s)
    np.testing.assert_allclose(1000 * data.near_m - image, near, rtol=1e-3)
    np.testing.assert_allclose(1 / (1000 * data.far_m - image), np.maximum(1 / far, 0), atol=1e-3 / s.min())
    assert np.isinf(data.far_m[far < 0]).all()


def test_the_plot_of_depth_of_field_says_where_and_why_a_curve_is_missing() -> None:
    """At f/2 the blur exceeds the limit of 0.03 mm in two intervals, at f/4 no light passes, f/8 has a curve."""
    focus_m, nan = np.array([1.0, 2.0, 4.0, 8.0, 16.0]), np.nan
    formula = np.stack([[nan, 1.9, 3.8, 7.6, 15.0]] * 3)
    near = np.array([[nan, nan, 3.9, nan, nan], [nan] * 5, [nan, 1.9, 3.8, 7.6, 15.0]])
    blur = np.array([[nan, 0.05, 0.02, 0.05, 0.05], [nan] * 5, [nan, 0.01, 0.01, 0.01, 0.01]])
    data = DepthOverFocus(focus_m, np.array([2.0, 4.0, 8.0]), near, 1.2 * near, formula, 1.2 * formula, blur, 0.03)
    axes = Figure().subplots()
    plot_depth_over_focus(data, axes)
    legend = axes.get_legend()
    assert legend is not None
    assert [" ".join(text.get_text().split()) for text in legend.get_texts()] == [
        "f/8 no curve at 1 m: cannot be focused",
        "f/4 no curve at 1 m: cannot be focused no curve at 2 to 16 m: no light passes",
        "f/2 no curve at 1 m: cannot be focused no curve at 2 m and 8 to 16 m: blurred by aberrations",
        "in focus",
        "by formula",
    ]


def test_the_blur_of_an_anamorphic_lens_is_that_of_all_its_planes() -> None:
    """The planes yz and xz have foci 2 mm apart, and yz alone blurs 29% more than the whole pupil. Rays of both planes
    give defocus and astigmatism exactly. The other aberrations blur by 0.12 mm, as a far object shows, and all by
    0.76 mm, so they are a fortieth of the mean square: within 5%."""
    lens = rc.Lens.load("anamorphic-65mm").focused(5.0)
    whole = lens.spot(0.0, pattern="rings", samples=40)
    assert blur_diameter_mm(lens) == pytest.approx(math.sqrt(8) * whole.rms_radius_mm, rel=0.05)


def test_depth_of_field_over_distance_tells_what_it_misses() -> None:
    """Wide open the Biotar blurs more than 1 um however it is focused, and no lens is focused at its own front."""
    data = depth_over_focus(rc.Lens.load("biotar-50mm"), focus_m=[0.01, 2.0], circle_of_confusion_mm=1e-3)
    assert np.isnan(data.blur_in_focus_mm[:, 0]).all() and np.isnan(data.formula_near_m[:, 0]).all()
    assert data.blur_in_focus_mm[0, 1] > 1e-3 and np.isnan(data.near_m[0, 1])


def test_depth_of_field_over_distance_asks_for_a_lens_that_focuses() -> None:
    with pytest.raises(rc.InputError, match="at any of these distances"):
        depth_over_focus(GAUSS, focus_m=[0.01])


@pytest.mark.parametrize(
    ("options", "why"),
    [
        (["--exposure-time", "1/0"], "divides by 0"),
        (["--exposure-time", "x"], '--exposure-time: "x" is not a number'),
        (["--exposure-time", "-1"], "positive number of seconds"),
        (["--exposure-time", "1", "--iso", "0"], "--iso: expected a positive number"),
        (["--circle-of-confusion", "0"], "circle of confusion must be a positive length"),
    ],
)
def test_a_mistake_is_named(options: list[str], why: str) -> None:
    result = CliRunner().invoke(cli.app, ["lens", "photo", "tessar-50mm", *options], standalone_mode=False)
    assert isinstance(result.exception, (rc.InputError, typer.BadParameter))
    assert why in str(result.exception)
