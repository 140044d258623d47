"""Transmission of lenses: closed forms, an independent polarisation trace, T-stops, and coatings in lens files."""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from numpy.typing import NDArray

from ...centred_lenses import CENTRED
from ...measurement import hold_core
from .test_first_order_of_any_lens import anamorphic

DOUBLE_GAUSS = "double-gauss-50mm"
Vector = NDArray[np.float64]


def indices_of(lens: rc.Lens, wavelength_nm: float) -> list[float]:
    """Refractive indices of the media before, between and behind the surfaces of a lens without mirrors."""
    media = [1.0]
    for surface in lens.surfaces:
        media.append(surface.material.index(wavelength_nm) if surface.type == "refracting" else media[-1])
    return media


def plates(count: int = 2, index: float = 1.7) -> rc.Lens:
    """Plane-parallel plates behind a stop: every surface has the same plane of incidence."""
    surfaces = [rc.Stop(clear_semi_diameter_mm=5, thickness_mm=1)]
    for i in range(2 * count):
        surfaces.append(rc.Surface(material=None if i % 2 else index, thickness_mm=2, clear_semi_diameter_mm=40))
    return rc.Lens(surfaces=surfaces, film_distance_mm=10)


def fresnel_amplitudes(before: float, behind: float, cosine: float) -> tuple[float, float]:
    """t_s and t_p times sqrt(n' cos' / n cos): squared, shares of the power (Born and Wolf 1.5.2 and 1.5.3)."""
    inner = math.sqrt(1 - (before / behind) ** 2 * (1 - cosine**2))
    scale = math.sqrt(behind * inner / (before * cosine))
    s = 2 * before * cosine / (before * cosine + behind * inner)
    p = 2 * before * cosine / (behind * cosine + before * inner)
    return s * scale, p * scale


def jones_transmission(lens: rc.Lens, origin: Vector, direction: Vector) -> float:
    """Chipman's 3 x 3 matrices, for bare spheres: half the trace of P^T P over the plane across the light."""
    media = indices_of(lens, lens.wavelength_nm)
    total = np.eye(3)
    before = direction / np.linalg.norm(direction)
    first = before
    for i, surface in enumerate(lens.surfaces):
        step = lens.trace([origin], [direction], start="scene", surface_count=i + 1)
        assert step.status[0] == rc.RayStatus.OK
        point, after = step.origins_mm[0] - (0, 0, lens.vertices_mm[i]), step.directions[0]
        if surface.type == "refracting":
            normal = np.array([0, 0, 1.0]) - surface.curvature_per_mm * point
            normal /= np.linalg.norm(normal)
            across = np.cross(before, normal)
            s = across / np.linalg.norm(across) if np.linalg.norm(across) > 1e-9 else np.linalg.svd([before])[2][1]
            t_s, t_p = fresnel_amplitudes(media[i], media[i + 1], float(before @ normal))
            out = np.stack([s, np.cross(s, after), after], axis=1)
            into = np.stack([s, np.cross(s, before), before])
            total = out @ np.diag([t_s, t_p, 1.0]) @ into @ total
        before = after
    transverse = np.eye(3) - np.outer(first, first)
    return 0.5 * float(np.trace(transverse @ total.T @ total @ transverse))


@pytest.mark.parametrize("name", [DOUBLE_GAUSS, "double-gauss-100mm", "sonnar-50mm", "tessar-50mm"])
def test_the_t_stop_is_that_of_fresnels_terms_along_the_axis(name: str) -> None:
    lens = rc.Lens.load(name).with_coating("bare")
    lens = lens.stopped_down(1.1 * lens.first_order().f_number)  # open, rims take some of the beam
    media = indices_of(lens, lens.wavelength_nm)
    product = math.prod(1 - ((a - b) / (a + b)) ** 2 for a, b in itertools.pairwise(media))
    expected = lens.first_order().f_number / math.sqrt(product)
    error = abs(lens.t_stop / expected - 1)
    hold_core("Effects", f"T-stop against Fresnel terms, {name}", "the axial ray", error, 1e-14, "relative")


@pytest.mark.parametrize("angle_deg", [0, 20, 56, 70])
def test_plates_polarise_the_light(angle_deg: float) -> None:
    """Behind 2 n equal faces T = (T_s^2n + T_p^2n) / 2, and not ((T_s + T_p) / 2)^2n."""
    lens, cosine = plates(), math.cos(math.radians(angle_deg))
    t_s, t_p = fresnel_amplitudes(1, 1.7, cosine)  # Stokes: the same share on the way out
    exact, averaged = (t_s**8 + t_p**8) / 2, ((t_s**2 + t_p**2) / 2) ** 4
    assert lens.transmission(angle_deg, object_distance_m=math.inf) == pytest.approx(exact, rel=1e-13)
    found = lens.transmission(angle_deg, object_distance_m=math.inf, polarisation="averaged")
    assert found == pytest.approx(averaged, rel=1e-13)


@pytest.mark.parametrize("name", [DOUBLE_GAUSS, "wide-22mm", "sonnar-50mm", "fisheye-10mm"])
def test_skew_rays_agree_with_an_independent_polarisation_trace(name: str) -> None:
    lens = rc.Lens.load(name)
    rng = np.random.default_rng(7)
    worst, count = 0.0, 0
    for field in (0, 8, 15, 20):
        aimed = lens.aim(rng.uniform(-0.7, 0.7, (12, 2)), field)
        traced = lens.trace(aimed.origins_mm, aimed.directions, start="scene", transmission=True)
        assert traced.transmission is not None
        for i in np.flatnonzero(np.asarray(traced.status) == rc.RayStatus.OK):
            expected = jones_transmission(lens, aimed.origins_mm[i], aimed.directions[i])
            worst = max(worst, abs(traced.transmission[i] - expected))
            count += 1
    assert count > 20
    what = f"polarised rays against 3 x 3 matrices, {name}"
    hold_core("Effects", what, f"{count} skew rays", worst, 1e-12, "of the light")


@pytest.mark.parametrize("name", CENTRED)
@pytest.mark.parametrize("coating", ["bare", "quarter_wave"])
def test_light_passes_a_lens_both_ways_alike(name: str, coating: str) -> None:
    lens = rc.Lens.load(name).with_coating(coating)
    if any(surface.type == "mirror" for surface in lens.surfaces):
        lens = lens.with_coating("aluminium")
    aimed = lens.aim([(0.7, 0.1), (0.2, 0.75), (-0.6, -0.5)], 2, object_distance_m=math.inf)
    there = lens.trace(aimed.origins_mm, aimed.directions, start="scene", transmission=True)
    back = lens.trace(there.origins_mm, -there.directions, start="film", transmission=True)
    passed = np.asarray(there.status) == rc.RayStatus.OK
    assert passed.any()
    assert there.transmission is not None and back.transmission is not None
    # The way back starts from rounded numbers: 1e-13 of the length of a lens, over its radii, in the angles.
    np.testing.assert_allclose(back.transmission[passed], there.transmission[passed], atol=1e-11)


def field_of_the_film(lens: rc.Lens) -> float:
    """Field angle, in degrees, of the film's corner, or of the point nearest to it that receives light."""
    width, height = lens.film_mm
    while True:
        across = rc.Camera(lens, film=rc.Film(width, height)).field_of_view_deg.diagonal
        if math.isfinite(across):
            return across / 2
        width, height = 0.97 * width, 0.97 * height


def test_the_mean_of_s_and_p_at_each_surface_is_near_the_truth() -> None:
    """The usual shortcut, and where it fails: docs/coatings.md states these figures."""
    fisheye = "fisheye-6mm-220deg"
    errors: dict[str, float] = {}
    for name in CENTRED:
        lens = rc.Lens.load(name).with_coating("bare")
        for field in np.linspace(0, field_of_the_film(lens), 5):
            exact, averaged = (
                lens.transmission(field, object_distance_m=math.inf, polarisation=how) for how in ("traced", "averaged")
            )
            errors[name] = max(errors.get(name, 0.0), abs(averaged - exact))
    phone = "phone-4mm-seven-elements"  # its last faces are as steep as the fisheye's first
    others = max(error for name, error in errors.items() if name not in (fisheye, phone))
    for tried, worst, limit in (
        (f"{fisheye}, to 112 degrees", errors[fisheye], 0.05),
        (f"{phone}, to its film's corners", errors[phone], 0.07),
        ("the other bundled lenses", others, 0.025),
    ):
        hold_core("Effects", "mean of s and p at each bare surface", tried, worst, limit, "of the light")
    # Guards against two identical methods, which would pass the limits above.
    assert errors[fisheye] > 0.03


def test_what_is_blocked_transmits_nothing() -> None:
    lens = rc.Lens.load(DOUBLE_GAUSS)
    rays = lens.trace([(0, 0, -5), (0, 30, -5), (0, 0, math.nan)], [(0, 0, 1)] * 3, start="scene", transmission=True)
    assert rays.transmission is not None
    assert rays.transmission[0] > 0.5
    assert list(rays.transmission[1:]) == [0, 0]
    assert lens.trace([(0, 0, -5)], [(0, 0, 1)], start="scene").transmission is None


def test_a_better_coating_lets_more_light_through() -> None:
    bare = rc.Lens.load(DOUBLE_GAUSS)
    coated = bare.with_coating("quarter_wave")
    assert bare.transmission() < coated.transmission() < 1
    assert bare.first_order().f_number < coated.t_stop < bare.t_stop


def test_a_central_obstruction_counts_in_the_t_stop() -> None:
    lens = rc.Lens.load("mirror-telephoto-500mm")
    grid = lens.spot(0, object_distance_m=math.inf, pattern="grid", samples=300)
    share = float(np.mean(np.asarray(grid.status) == rc.RayStatus.OK))
    losses = lens.transmission(0, object_distance_m=math.inf, pupil=[(0.75, 0)])  # next to the axis nothing passes
    expected = lens.first_order().f_number / math.sqrt(share * losses)
    # A grid of 300 knows areas to 1e-3; rays at f/6.7 meet surfaces near enough to the normal for 1e-3.
    assert lens.t_stop == pytest.approx(expected, rel=2e-3)


def test_mirrors_take_what_their_metal_takes() -> None:
    lens = rc.Lens.load("mirror-telephoto-500mm")
    silvered = lens.with_coating("silver")
    r = rc.Coating.named("silver").response(0, lens.wavelength_nm, outside=(1.5168, 64.12)).reflectance_s
    assert lens.t_stop / silvered.t_stop == pytest.approx(float(r), rel=1e-12)  # two of them, under a root
    assert lens.unknown_coatings == [1, 2, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15]
    assert silvered.unknown_coatings == [1, 2, 4, 6, 7, 9, 10, 11, 12, 13, 14, 15]
    assert silvered.with_coating("quarter_wave").unknown_coatings == []


def test_cemented_faces_stay_bare() -> None:
    lens = rc.Lens.load(DOUBLE_GAUSS).with_coating("quarter_wave")
    kinds = [s.coating.kind for s in lens.surfaces]
    assert [i for i, kind in enumerate(kinds) if kind == "unknown"] == [3, 5, 7]  # two cemented faces and the stop
    assert lens.unknown_coatings == []
    assert lens.with_coating("bare", [3]).surfaces[3].coating.kind == "bare"


def test_coatings_are_part_of_the_value_and_stay_with_the_lens() -> None:
    lens = rc.Lens.load(DOUBLE_GAUSS)
    coated = lens.with_coating(rc.Coating([rc.CoatingLayer("N-BK7", thickness_nm=90)], name="mine"))
    assert coated != lens
    assert coated.with_coating("unknown") == lens
    assert hash(coated) != hash(lens)
    for same in (coated.focused(2), coated.stopped_down(8), coated.with_iris(7), coated.with_surface(0, conic=0.1)):
        assert same.surfaces[0].coating == coated.surfaces[0].coating
    assert "mine" in repr(coated.surfaces[0])
    assert rc.Mirror(clear_semi_diameter_mm=3, coating="silver").coating == rc.Coating.named("silver")


@pytest.mark.parametrize(
    ("make", "kind", "message"),
    [
        (lambda lens: lens.with_coating("silver"), rc.InputError, "has no mirror to coat"),
        (lambda lens: lens.with_coating("bare", [99]), rc.InputError, "there is no surface 99"),
        (
            lambda lens: lens.with_coating("silver", [0]),
            rc.LensFileError,
            "surface 1: only a mirror can have a metal or a reflectance",
        ),
        (lambda lens: lens.with_coating("bare", [5]), rc.LensFileError, "surface 6: a stop or an aperture"),
        (lambda lens: lens.with_coating("shiny"), rc.InputError, "a coating must be one of"),
        (lambda lens: lens.transmission(0, polarisation="s"), rc.InputError, "expected traced or averaged"),
        (lambda lens: lens.transmission(80), rc.InputError, "80 deg"),
        (lambda lens: lens.transmission(0, 50), rc.InputError, "between 100 and 20000 nm"),
    ],
)
def test_what_cannot_be_is_said(make: object, kind: type[Exception], message: str) -> None:
    with pytest.raises(kind, match=message):
        make(rc.Lens.load(DOUBLE_GAUSS))  # type: ignore[operator]


def test_a_wavelength_outside_a_glass_is_an_error_that_names_it() -> None:
    table = rc.Glass.table([(450, 1.53), (550, 1.52), (650, 1.51)])
    lens = rc.Lens(
        name="tabulated",
        surfaces=[
            rc.Stop(clear_semi_diameter_mm=5, thickness_mm=1),
            rc.Surface(radius_of_curvature_mm=50, thickness_mm=2, material=table, clear_semi_diameter_mm=6),
            rc.Surface(radius_of_curvature_mm=-50, clear_semi_diameter_mm=6),
        ],
    )
    assert lens.transmission(0, 450) < 1
    for ask in (
        lambda: lens.transmission(0, 700),
        lambda: lens.trace([(0, 0, 0)], [(0, 0, 1)], start="scene", wavelength_nm=700, transmission=True),
    ):
        with pytest.raises(
            rc.InputError, match="the glass of surface 2 of tabulated is known from 450 to 650 nm; 700 nm is requested"
        ):
            ask()
    achromat = rc.Lens.load("achromat-75mm")
    for wavelength, message in (
        (110, r"\(N-BK7\) of achromat-75mm lets no light pass below its resonance at 141"),
        (11000, "above its resonance at 10176"),
    ):
        with pytest.raises(rc.InputError, match=message):
            achromat.transmission(0, wavelength)
    film = lens.with_coating(rc.Coating([rc.CoatingLayer([(500, 1.4, 0), (600, 1.39, 0)], thickness_nm=90)]))
    with pytest.raises(
        rc.InputError,
        match='surface 2 of lens "tabulated": the coating material is known from 500 nm to 600 nm; 450 nm',
    ):
        film.transmission(0, 450)


LENS_FILE = """format = 1
name = "coated"
{top}
[[surface]]
type = "stop"
thickness_mm = 1.0
clear_semi_diameter_mm = 5.0
[[surface]]
radius_of_curvature_mm = 50.0
thickness_mm = 2.0
material = 1.6
clear_semi_diameter_mm = 6.0
{front}
[[surface]]
radius_of_curvature_mm = -50.0
clear_semi_diameter_mm = 6.0
{tables}
"""


def lens_of(tmp_path: Path, top: str = "", front: str = "", tables: str = "") -> rc.Lens:
    path = tmp_path / "coated.toml"
    path.write_text(LENS_FILE.format(top=top, front=front, tables=tables))
    return rc.Lens.load(path)


def test_a_lens_file_says_how_surfaces_are_coated(tmp_path: Path) -> None:
    table = """[glass.film]
cauchy = [1.9, 0.01]
[coating.three_layers]
design_wavelength_nm = 550
layers = [
    { material = 1.38, thickness_waves = 0.25 },
    { material = "film", thickness_waves = 0.5 },
    { complex_index = [1.7, 0.001], thickness_nm = 80.0 },
]"""
    lens = lens_of(tmp_path, 'default_coating = "quarter_wave"', 'coating = "three_layers"', table)
    front, back = lens.surfaces[1].coating, lens.surfaces[2].coating
    assert (front.name, front.kind, len(front.layers)) == ("three_layers", "layers", 3)
    assert front.layers[0].thickness_nm == pytest.approx(550 / 4 / 1.38)
    assert front.layers[1].thickness_nm == pytest.approx(550 / 2 / (1.9 + 0.01 / 0.55**2))
    assert front.layers[2].index(600) == 1.7 + 0.001j
    assert back == rc.Coating.named("quarter_wave")
    assert lens.unknown_coatings == []
    assert lens_of(tmp_path, 'default_coating = "bare"', 'coating = "unknown"').unknown_coatings == [1]
    assert lens_of(tmp_path).unknown_coatings == [1, 2]


def test_a_lens_file_says_what_its_mirrors_are_made_of(tmp_path: Path) -> None:
    tables = """[[surface]]
type = "mirror"
radius_of_curvature_mm = -100.0
thickness_mm = -5.0
clear_semi_diameter_mm = 5.0
coating = "{}"
[[surface]]
type = "mirror"
clear_semi_diameter_mm = 5.0
coating = "half"
[coating.half]
reflectance = 0.5
[coating.enhanced]
metal = [[400, 0.5, 5.0], [700, 1.8, 8.0]]
layers = [{{ material = 1.38, thickness_nm = 100 }}]
[coating.plain]
metal = [1.0, 6.5]
"""
    file = """format = 1
name = "mirrors"
film_distance_mm = 60.0
[[surface]]
type = "stop"
thickness_mm = 6.0
clear_semi_diameter_mm = 5.0
"""
    path = tmp_path / "mirrors.toml"
    for name, kind in (("enhanced", "metal"), ("plain", "metal"), ("aluminium", "metal"), ("half", "reflectance")):
        path.write_text(file + tables.format(name))
        lens = rc.Lens.load(path)
        assert lens.surfaces[1].coating.kind == kind
        expected = lens.surfaces[1].coating.response(0, lens.wavelength_nm).reflectance_s * 0.5
        assert (lens.first_order().f_number / lens.t_stop) ** 2 == pytest.approx(float(expected), rel=1e-12)


@pytest.mark.parametrize(
    ("part", "text", "message"),
    [
        ("front", 'coating = "quarter_wafe"', r':13: surface 2: unknown coating .*did you mean "quarter_wave"'),
        ("front", 'coating = "silver"', r":8: surface 2: only a mirror can have a metal or a reflectance"),
        ("front", "coating = 3", r':13: surface 2: "coating" must be a text'),
        ("top", 'default_coating = "mine"', r':3: unknown coating "mine"'),
        ("top", 'default_coating = "silver"', r":3: .*is for faces between air and glass"),
        ("top", "coating = 'bare'", r':3: "coating" must be a table'),
        (
            "tables",
            "[coating.bare]\nlayers = [{ material = 1.4, thickness_nm = 9 }]",
            r':17: "bare" is the name of a predefined coating',
        ),
        ("coating", "", r':17: a coating needs "layers"'),
        ("coating", "layer = []", r':18: unknown key "layer" \(did you mean "layers"'),
        ("coating", "layers = 3", r':18: "layers" must be an array of tables'),
        ("coating", "reflectance = 1.5", r":17: the reflectance of a mirror must lie"),
        ("coating", 'metal = "silver"\nreflectance = 0.5', r":17: a coating needs"),
        ("coating", "reflectance = 0.9\ndesign_wavelength_nm = 500", r':19: "design_wavelength_nm" is for layers'),
        (
            "coating",
            'layers = [{ material = 1.4, thickness_nm = 9 }]\nmetal_label = "x"',
            r':19: "metal_label" is for a "metal"',
        ),
        ("coating", 'metal = "sliver"', r':18: unknown metal .*did you mean "silver"'),
        (
            "coating",
            "metal = [[500, 1, 1], [400, 1, 1]]",
            r":17: the wavelengths of the metal must be strictly increasing",
        ),
        ("coating", 'metal = [["a", 1, 1]]', r":18: each number of a point must be a finite number"),
        ("layer", "material = 1.4", r':18: a layer needs exactly one of "thickness_nm"'),
        ("layer", "material = 1.4, thickness_nm = nan", r':18: "thickness_nm" must be a finite number'),
        ("layer", "material = 1.4, thickness_nm = -1", r":17: the thickness of layer 1 must lie"),
        ("layer", "material = 1.4, thickness_waves = 1", r':18: "thickness_waves" counts waves'),
        ("layer", "material = -1.4, thickness_nm = 1", r":18: the refractive index .* is less than 1"),
        ("layer", "complex_index = [1.4, -1], thickness_nm = 1", r":17: the refractive index n \+ ik of layer 1"),
        ("layer", 'material = "N-BK8", thickness_nm = 1', r':18: unknown glass "N-BK8" \(did you mean'),
    ],
)
def test_hostile_lens_files_get_one_clear_message(part: str, text: str, message: str, tmp_path: Path) -> None:
    if part == "layer":
        part, text = "coating", f"layers = [{{ {text} }}]"
    if part == "coating":
        part, text = "tables", f"[coating.a]\n{text}"
    with pytest.raises(rc.LensFileError, match=r"coated\.toml" + message):
        lens_of(tmp_path, **{part: text})


def test_a_million_layers_are_refused(tmp_path: Path) -> None:
    layers = ",".join(["{material=1.4,thickness_nm=1}"] * 400_000)
    with pytest.raises(rc.LensFileError, match=r"coated\.toml:18: the coating has 400000 layers; at most 1000"):
        lens_of(tmp_path, tables=f"[coating.a]\nlayers = [{layers}]")
    with pytest.raises(rc.LensFileError, match="larger than 16 MiB"):
        lens_of(tmp_path, tables=f"[coating.a]\nlayers = [{layers},{layers}]")


def test_a_lens_of_any_kind_keeps_the_same_light_both_ways() -> None:
    """Cylinders, and an element that is tilted in between: fields are turned from frame to frame."""
    lens = anamorphic().with_element_tilted(6, 7, x_deg=1.5, y_deg=-0.7).with_coating("quarter_wave")
    places = np.random.default_rng(3).uniform(-9, 9, (200, 2))
    origins = np.column_stack([places, np.full(len(places), -5.0)])
    directions = np.tile([0.05, -0.03, 1.0], (len(places), 1))
    there = lens.trace(origins, directions, start="scene", transmission=True)
    back = lens.trace(there.origins_mm, -there.directions, start="film", transmission=True)
    passed = (there.status == 0) & (back.status == 0)
    assert passed.sum() > 30
    assert there.transmission is not None and back.transmission is not None
    np.testing.assert_allclose(back.transmission[passed], there.transmission[passed], atol=1e-11)
    assert 0.5 < lens.transmission() < 1
    # Tilted by next to nothing, it is the centred lens.
    centred = rc.Lens.load("double-gauss-50mm").with_coating("bare")
    nearly = centred.with_element_tilted(2, 3, x_deg=1e-7)
    kept = [one.trace(origins, directions, start="scene", transmission=True).transmission for one in (centred, nearly)]
    assert kept[0] is not None and kept[1] is not None and kept[0].max() > 0.4
    np.testing.assert_allclose(kept[1], kept[0], atol=1e-8)
