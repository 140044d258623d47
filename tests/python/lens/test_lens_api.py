"""rc.Lens, Surface and Glass as a user meets them."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
import realcam as rc

STOP = rc.Stop(clear_semi_diameter_mm=5)


def biconvex(**changes: object) -> rc.Lens:
    front: dict[str, object] = {"radius_of_curvature_mm": 50, "thickness_mm": 2, "material": 1.5}
    front |= {"clear_semi_diameter_mm": 6, **changes}
    return rc.Lens(
        surfaces=[STOP, rc.Surface(**front), rc.Surface(radius_of_curvature_mm=-50, clear_semi_diameter_mm=6)]
    )


def test_bundled_lenses_load_by_name() -> None:
    names = rc.lens_names()
    assert names == sorted(names)
    assert {"double-gauss-50mm", "wide-22mm", "fisheye-10mm", "telephoto-250mm", "double-gauss-100mm"} <= set(names)
    for name in names:
        lens = rc.Lens.load(name)
        assert lens.name == name
        assert lens.source
        assert math.isinf(lens.focus_distance_m)
        assert lens.surfaces[lens.stop_index].type == "stop"
        assert len(lens.vertices_mm) == len(lens.surfaces)
        assert lens.film_position_mm == pytest.approx(lens.vertices_mm[-1] + lens.film_distance_mm)


def test_a_lens_file_loads_from_any_kind_of_path(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    biconvex().save(path)
    for form in (path, str(path)):
        # Lensmaker, with 2 mm between the vertices.
        power = 0.5 * (1 / 50 + 1 / 50 - 0.5 * 2 / (1.5 * 50 * 50))
        assert rc.Lens.load(form).first_order().effective_focal_length_mm == pytest.approx(1 / power)


def test_errors_are_value_errors_of_realcam() -> None:
    assert issubclass(rc.InputError, ValueError)
    assert issubclass(rc.InputError, rc.RealcamError)


def test_a_name_with_a_point_is_a_file_where_there_is_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(rc.LensFileError, match=r'unknown lens "tesar-50mm\.5" \(did you mean "tessar-50mm"'):
        rc.Lens.load("tesar-50mm.5")
    for missing in ("tessar-50mm.toml", "mine.ZMX", "./mine"):
        with pytest.raises(rc.LensFileError, match="no such file"):
            rc.Lens.load(missing)
    rc.Lens.load("singlet-100mm").save("own.toml")
    text = Path("own.toml").read_bytes()
    for name in ("own.v2", "own"):  # a file of realcam under any name
        Path(name).write_bytes(text)
        assert rc.Lens.load(name) == rc.Lens.load("own.toml")
    Path("tessar-50mm").write_bytes(text)  # a bundled lens is a bundled lens
    assert rc.Lens.load("tessar-50mm").first_order().effective_focal_length_mm == pytest.approx(49.94, abs=0.01)


def test_glasses_are_called_by_their_numbers() -> None:
    labels = [surface.material.label for name in rc.lens_names() for surface in rc.Lens.load(name).surfaces]
    assert "1.658 / 57" in labels
    assert not [label for label in labels if label.endswith(".") or ". " in label]


def test_lenses_are_values() -> None:
    lens = rc.Lens.load("double-gauss-50mm")
    before = lens.film_distance_mm, lens.stop_semi_diameter_mm, lens.focus_distance_m
    near, dark = lens.focused(1.0), lens.stopped_down(8)
    assert before == (lens.film_distance_mm, lens.stop_semi_diameter_mm, lens.focus_distance_m)
    assert near.focus_distance_m == 1.0
    assert near.film_distance_mm > lens.film_distance_mm
    assert near.stop_semi_diameter_mm == lens.stop_semi_diameter_mm
    # Paraxial: the diaphragm's diameter goes with the reciprocal of the f-number.
    assert dark.first_order().f_number == pytest.approx(8, rel=1e-12)
    assert dark.focused(1.0).stop_semi_diameter_mm == dark.stop_semi_diameter_mm
    for thing, name in ((lens, "name"), (lens.surfaces[0], "conic"), (lens.first_order(), "f_number")):
        with pytest.raises(AttributeError):
            setattr(thing, name, 1)
    lens.surfaces.clear()  # a copy
    assert len(lens.surfaces) == 11


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"surfaces": []}, "no surfaces"),
        ({"surfaces": [STOP, STOP]}, 'surface 2: is a second "stop"'),
        ({"surfaces": [rc.Surface(clear_semi_diameter_mm=5)]}, "exactly one"),
        ({"surfaces": [STOP]}, "film_distance_mm"),
        ({"surfaces": [STOP], "film_distance_mm": -1.0}, "behind the last surface"),
        ({"surfaces": [STOP], "film_distance_mm": math.nan}, "behind the last surface"),
        ({"surfaces": [STOP], "film_distance_mm": 50.0, "iris_blades": 2}, "blades"),
        ({"surfaces": [STOP], "film_distance_mm": 50.0, "focus_group": (0, 3)}, "group"),
        ({"surfaces": [STOP], "film_distance_mm": 50.0, "focus_group": (-1, 0)}, "group"),
        ({"surfaces": [STOP], "film_distance_mm": 50.0, "wavelength_nm": -1.0}, "wavelength"),
        ({"surfaces": [STOP], "film_distance_mm": 50.0, "nearest_focus_m": math.nan}, "nearest focus"),
        ({"surfaces": [STOP], "film_distance_mm": 50.0, "film_mm": (0.0, 24.0)}, "film"),
    ],
)
def test_a_lens_that_cannot_be(arguments: dict[str, object], says: str) -> None:
    with pytest.raises(rc.LensFileError, match=says):
        rc.Lens(**arguments)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"radius_of_curvature_mm": 0}, "inf"),
        ({"radius_of_curvature_mm": math.nan}, "radius"),
        ({"type": "prism"}, "refracting, mirror, stop or aperture"),
        ({"material": "N-BK77"}, "BK7"),
        ({"material": (1.5,)}, r"\(n_d, V_d\)"),
        ({"material": ("a", "b")}, r"\(n_d, V_d\)"),
        ({"material": object()}, "index"),
        ({"aspheric_coefficients": {5: 1.0}}, "even powers"),
        ({"aspheric_coefficients": {2: 1.0}}, "even powers"),
    ],
)
def test_a_surface_says_what_is_wanted(arguments: dict[str, object], says: str) -> None:
    with pytest.raises(rc.InputError, match=says):
        rc.Surface(clear_semi_diameter_mm=5, **arguments)  # type: ignore[arg-type]


def test_surface_keeps_what_it_is_given() -> None:
    s = rc.Surface(radius_of_curvature_mm=20, conic=-1, aspheric_coefficients={6: 1e-6}, clear_semi_diameter_mm=4)
    assert (s.radius_of_curvature_mm, s.conic, s.type) == (20, -1, "refracting")
    assert s.aspheric_coefficients == {6: 1e-6}
    # A paraboloid's sag is r^2 / (2 R).
    assert s.sag_mm(3.0) == pytest.approx(9 / 40 + 1e-6 * 3**6, rel=1e-14)
    assert math.isinf(STOP.radius_of_curvature_mm)
    mirror = rc.Mirror(radius_of_curvature_mm=-100, clear_semi_diameter_mm=10, thickness_mm=-40)
    assert (mirror.type, mirror.curvature_per_mm) == ("mirror", -0.01)


def test_glass_in_every_form() -> None:
    # N-BK7: Schott's data sheet prints n_d = 1.51680, n_F = 1.52238, n_C = 1.51432, V_d = 64.17.
    for glass in (rc.Glass.named("N-BK7"), rc.Surface(clear_semi_diameter_mm=1, material="N-BK7").material):
        assert glass.index(587.5618) == pytest.approx(1.51680, abs=5e-6)
        assert glass.index(486.1327) == pytest.approx(1.52238, abs=5e-6)
        assert glass.index(656.2725) == pytest.approx(1.51432, abs=5e-6)
    pair = rc.Surface(clear_semi_diameter_mm=1, material=(1.5168, 64.17)).material
    dispersion = pair.index(486.1327) - pair.index(656.2725)
    assert (pair.index(587.5618) - 1) / dispersion == pytest.approx(64.17, rel=1e-9)
    assert rc.Surface(clear_semi_diameter_mm=1).material.index(500) == 1
    assert rc.Glass.cauchy([1.5, 0.004]).index(500) == pytest.approx(1.5 + 0.004 / 0.25)
    assert rc.Glass.table([(400, 1.6), (700, 1.5)]).index(700) == pytest.approx(1.5)


def test_first_order_and_best_focus_check_their_arguments() -> None:
    lens = rc.Lens.load("achromat-75mm")
    # Colours have their own focal lengths.
    assert lens.first_order(486.1).effective_focal_length_mm != lens.first_order().effective_focal_length_mm
    assert lens.best_focus_mm(2.0) > lens.best_focus_mm()
    for wrong in (-1.0, math.nan):
        with pytest.raises(rc.InputError, match="wavelength"):
            lens.first_order(wrong)
        with pytest.raises(rc.InputError, match="wavelength"):
            lens.best_focus_mm(wavelength_nm=wrong)
        with pytest.raises(rc.InputError, match="object distance"):
            lens.best_focus_mm(wrong)
