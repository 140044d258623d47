"""Lenses as OSL shaders, run as C++, against the rays of realcam's own trace."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from realcam import _core
from realcam.cli import app as cli
from scipy.stats import qmc
from typer.testing import CliRunner

from . import osl_in_cpp
from .osl_in_cpp import Rays, program_of

needs_compiler = pytest.mark.skipif(osl_in_cpp.COMPILER is None, reason="runs OSL as C++, and there is no compiler c++")

# Spheres; an asphere; mirrors with a hole; a group that moves.
LENSES = ("double-gauss-50mm", "wide-24mm", "mirror-telephoto-500mm", "zoom-80-200mm")
# Strong aspheres; a mirror that no bundled lens has.
ASPHERIC = ("phone-4mm-three-elements", "aspheric mirror")


def lens_of(name: str) -> rc.Lens:
    if name == "aspheric mirror":
        return rc.Lens.load("mirror-telephoto-500mm").with_surface(5, conic=-0.3, aspheric_coefficients={6: 2e-13})
    return rc.Lens.load(name)


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Callable[..., Rays]]:
    @cache
    def of(name: str) -> Callable[..., Rays]:
        path = tmp_path_factory.mktemp("osl") / "lens.osl"
        lens_of(name).save(path)
        return program_of(path.read_text(), path.parent)

    return of


def even_points(exponent: int) -> np.ndarray:
    """(2^exponent, 2) points over the unit square, evenly also in each coordinate alone."""
    return qmc.Sobol(2, scramble=False).random_base2(exponent) + 0.5**exponent / 2


def film_points_mm(raster: np.ndarray, film_mm: tuple[float, float]) -> np.ndarray:
    """The picture is upside down on the film."""
    return (0.5 - raster) * film_mm


def light_at(run: Callable[..., Rays], raster: np.ndarray, lens: rc.Lens, **given: float) -> float:
    """Mean throughput at a point of the picture: the irradiance of its film point in a field of radiance 1."""
    chance = even_points(16)
    raster = np.full_like(chance, raster)
    return float(run(raster, chance, lens.film_mm, dispersion=0, keep_brightness=0, **given).throughput[:, 1].mean())


def landing_mm(lens: rc.Lens, rays: Rays, wavelength_nm: float | None = None) -> np.ndarray:
    """(N, 2): where light that comes the other way along the rays meets the film; NaN: it does not."""
    turned = np.array([1, 1, -1])
    origins_mm = 1e3 * turned * rays.position.astype(float) + [0, 0, lens.film_position_mm]
    back = lens.trace(origins_mm, -turned * rays.direction.astype(float), start="scene", wavelength_nm=wavelength_nm)
    to_film = (lens.film_position_mm - back.origins_mm[:, 2]) / back.directions[:, 2]
    places = (back.origins_mm + to_film[:, None] * back.directions)[:, :2]
    places[back.status != 0] = np.nan
    return places


@needs_compiler
@pytest.mark.parametrize(
    ("focus_m", "f_number"), [(math.inf, 0.0), (3.0, 8.0)], ids=["infinity, wide open", "3 m, f/8"]
)
@pytest.mark.parametrize("name", [*LENSES, *ASPHERIC])
@pytest.mark.slow
def test_light_that_comes_back_along_a_ray_meets_its_film_point(
    program: Callable[[str], Callable[..., Rays]], name: str, focus_m: float, f_number: float
) -> None:
    lens = lens_of(name)
    if "mirror" in name and math.isfinite(focus_m):
        focus_m = 20.0
    random = np.random.default_rng(1)
    raster, chance = random.random((2, 4000, 2), dtype=np.float32)
    rings = {"focus_m": focus_m if math.isfinite(focus_m) else 0, "f_number": f_number}
    rays = program(name)(raster, chance, lens.film_mm, dispersion=0, **rings)
    passed = rays.throughput[:, 1] > 0
    lens = lens.focused(focus_m)
    # At a rim, rounding decides whether a ray passes.
    back = landing_mm(lens, Rays(*(part[passed] for part in rays)))
    assert np.isnan(back).mean() < 1e-3
    miss_mm = np.linalg.norm(back - film_points_mm(raster, lens.film_mm)[passed], axis=1)
    # A tenth of the pixels of 6 um of a large sensor; the film of the shortest lens here is as large. The focus is a
    # polynomial within 1e-5 of the film's diagonal, over which a cone of f/1.4 spreads by 1.4 times less.
    assert np.nanpercentile(miss_mm, 99) < 0.6e-3


@pytest.mark.slow
@needs_compiler
@pytest.mark.parametrize("name", [*LENSES, "fisheye-6mm-220deg", "zoom-11-24mm"])
def test_the_film_gets_as_much_light(program: Callable[[str], Callable[..., Rays]], name: str) -> None:
    lens = rc.Lens.load(name).focused(math.inf)
    # The image of the fisheye ends 0.05 mm after 0.55.
    for share in (0.0, 0.35, 0.55, 0.7, 0.95):
        raster = np.array([0.5 + 0.5 * share, 0.5 + 0.25 * share])
        expected = lens.film_pupil(tuple(film_points_mm(raster, lens.film_mm))).irradiance
        # About 800 of 65536 cells lie on an edge, and half of each is counted by chance: 4e-4. The remaining tolerance
        # is three times that.
        if expected > 0.02 * lens.film_pupil().irradiance:
            assert light_at(program(name), raster, lens) == pytest.approx(expected, rel=2e-3), share


@needs_compiler
def test_a_diaphragm_nearly_as_small_as_the_blocked_middle(program: Callable[[str], Callable[..., Rays]]) -> None:
    name = "mirror-telephoto-500mm"
    lens = rc.Lens.load(name).focused(math.inf)
    f_number = lens.first_order().f_number / 0.65
    raster = np.array([0.75, 0.75])
    expected = lens.stopped_down(f_number).film_pupil(tuple(film_points_mm(raster, lens.film_mm))).irradiance
    # Some 3900 points fall into the crescent that is left, and some 150 lie on its edge: the half by chance.
    assert light_at(program(name), raster, lens, f_number=f_number) == pytest.approx(expected, rel=1e-2)


@needs_compiler
@pytest.mark.parametrize("name", [name for name in LENSES if "mirror" not in name])
@pytest.mark.parametrize(("focus", "stops"), [(0.0, 0.0), (0.3, 1.3), (1.0, 4.5)])
@pytest.mark.slow
def test_most_rays_pass(program: Callable[[str], Callable[..., Rays]], name: str, focus: float, stops: float) -> None:
    from realcam.osl import focus_range

    lens = rc.Lens.load(name)
    distance_m = focus_range(lens).distance_m(focus)
    random = np.random.default_rng(2)
    raster, chance = random.random((2, 40000, 2), dtype=np.float32)
    rings = {"focus_m": distance_m if focus else 0, "f_number": lens.wide_open().f_number * 2 ** (stops / 2)}
    rays = program(name)(raster, chance, lens.film_mm, dispersion=0, **rings)
    radius_mm = np.linalg.norm(film_points_mm(raster, lens.film_mm), axis=1)
    # Beyond the image there are slivers of stray light, which no ellipse fits.
    radii_mm = np.linspace(0, radius_mm.max(), 60)
    light = np.array([lens.film_pupil((radius, 0.0)).irradiance for radius in radii_mm])
    lit = np.interp(radius_mm, radii_mm, light) > 0.1 * light[0]
    assert (rays.throughput[lit, 1] > 0).mean() > 0.9


@needs_compiler
@pytest.mark.parametrize(("blades", "rounding"), [(5, 0.0), (7, 0.4), (6, 1.0)])
@pytest.mark.parametrize("stops", [0.2, 2.0])
def test_blades_leave_as_much_open_as_a_circle(
    program: Callable[[str], Callable[..., Rays]], blades: int, rounding: float, stops: float
) -> None:
    lens = rc.Lens.load("double-gauss-50mm")
    f_number = lens.first_order().f_number * 2 ** (stops / 2)
    iris = {"blades": blades, "rounding": rounding, "rotation_deg": 20}
    light = light_at(program("double-gauss-50mm"), np.array([0.5, 0.5]), lens, f_number=f_number, **iris)
    closed = lens.focused(math.inf).stopped_down(f_number).with_iris(blades, rounding, 20)
    assert light == pytest.approx(closed.film_pupil().irradiance, rel=3e-3)


@needs_compiler
@pytest.mark.slow
def test_each_wavelength_takes_its_own_way_and_all_together_are_white(
    program: Callable[[str], Callable[..., Rays]],
) -> None:
    lens = rc.Lens.load("tessar-50mm").focused(math.inf)
    run = program("tessar-50mm")
    cells_nm = _core._film_of_white("D65")
    random = np.random.default_rng(3)
    for cell in (4, 30, 60):
        raster, chance = random.random((2, 2000, 2), dtype=np.float32)
        chance[:, 0] = (cell + chance[:, 0]) / 64
        rays = run(raster, chance, lens.film_mm)
        # A hash of one half is the middle of the second of three parts.
        wavelength_nm = cells_nm[3 * cell + 1, :2].mean()
        passed = rays.throughput[:, 1] != 0
        back = landing_mm(lens, Rays(*(part[passed] for part in rays)), wavelength_nm)
        miss_mm = np.linalg.norm(back - film_points_mm(raster, lens.film_mm)[passed], axis=1)
        # The lens's lateral colour is 20 um from 420 to 650 nm. Polynomials of the indices are right to 1e-6 of it.
        assert np.nanpercentile(miss_mm, 99) < 1e-3
    chance = even_points(18)
    rays = run(np.full_like(chance, 0.5), chance, lens.film_mm, keep_brightness=0)
    mean = rays.throughput.mean(axis=0)
    # The pupil is the same for all wavelengths to a hundredth; the cells' colours add up to white.
    assert mean == pytest.approx(lens.film_pupil().irradiance, rel=0.01)


def test_a_lens_that_osl_cannot_express_is_refused_by_its_surface(tmp_path: Path) -> None:
    lens = rc.Lens.load("tessar-50mm")
    for changed, words in (
        (lens.with_surface(2, tilt_deg=(1, 0, 0), returns=True), "surface 3 is tilted"),
        (lens.with_surface(1, form="biconic", radius_of_curvature_x_mm=90.0), "surface 2 is a biconic"),
        (lens.with_surface(1, form="toroid", radius_of_curvature_x_mm=90.0), "surface 2 is a toroid"),
        (lens.with_surface(0, xy_terms={(1, 1): 1e-6}), "surface 1 has freeform terms"),
        (lens.with_surface(0, radial_terms={3: 1e-6}), "surface 1 has radial_terms"),
        (lens.with_surface(4, aperture={"rectangle_mm": [3, 2]}), "surface 5 has an aperture"),
        (lens.with_film_radius(-80.0), "film is curved"),
        (rc.Lens.load("view-camera-210mm"), "film is tilted or shifted"),
        (lens.shifted(x_mm=2.0), "surface 1 is tilted or decentred"),
    ):
        with pytest.raises(rc.InputError, match=words) as error:
            changed.save(tmp_path / "lens.osl")
        assert "\n" not in str(error.value)
    assert not list(tmp_path.iterdir())


def test_a_lens_as_it_stands_and_the_command(tmp_path: Path) -> None:
    lens = rc.Lens.load("singlet-100mm").focused(2.0).stopped_down(8).with_iris(6, 0.5, 10)
    lens.save(tmp_path / "set.OSL")
    text = (tmp_path / "set.OSL").read_text()
    for words in ("float focus_m = 2 ", "float f_number = 8 ", "float blades = 6 ", "float rounding = 0.5 "):
        assert words in text
    target = tmp_path / "lens.osl"
    result = CliRunner().invoke(cli.app, ["lens", "convert", "singlet-100mm", "-o", str(target)])
    assert result.exit_code == 0, result.output
    assert "shader realcam_singlet_100mm(" in target.read_text()
