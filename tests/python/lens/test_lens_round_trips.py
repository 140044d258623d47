"""Lenses saved to other programs' formats and loaded again trace the same rays, or saving warns and names the loss."""

from __future__ import annotations

import pickle
import warnings
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

pytestmark = pytest.mark.filterwarnings("ignore")

FORMATS = (".toml", ".zmx", ".seq", ".json", ".roa")
# Tolerances for rays through ten surfaces; multiplied-out coefficients lose some digits.
POSITION_MM, DIRECTION = 1e-9, 1e-11

EVEN = {4: 1e-6, 6: -2e-9}
NOLL = {"order": "noll", "radius_mm": 14.0, "coefficients_mm": [0, 0.02, -0.01, 0.02, 0.01, 0.0, 0.004]}
FRINGE = {"order": "fringe", "radius_mm": 14.0, "coefficients_mm": [0, 0.01, 0.02, 0.01, -0.01, 0.004]}
CON = {"kind": "con", "radius_mm": 15.0, "coefficients_mm": [0.05, -0.02, 0.01]}
BFS = {"kind": "bfs", "radius_mm": 15.0, "coefficients_mm": [0.05, -0.02, 0.01]}

# Features of a surface, and the formats that lack them.
FEATURES: dict[str, tuple[dict, tuple[str, ...]]] = {
    "conic": ({"conic": -0.7}, ()),
    "even terms": ({"conic": 0.3, "aspheric_coefficients": EVEN}, ()),
    "cylinder": ({"form": "toroid"}, ()),
    "toroid": (
        {"form": "toroid", "radius_of_curvature_x_mm": 60.0, "conic": 0.2, "aspheric_coefficients": EVEN},
        (),
    ),
    "biconic": ({"form": "biconic", "radius_of_curvature_x_mm": 60.0, "conic_x": -0.4}, (".json", ".roa")),
    "biconic with terms": (
        {"form": "biconic", "radius_of_curvature_x_mm": 60.0, "aspheric_coefficients": EVEN},
        (".zmx", ".json", ".roa"),
    ),
    "odd terms": ({"radial_terms": {2: 1e-4, 3: 1e-5, 5: 1e-9}, "aspheric_coefficients": EVEN}, ()),
    "terms of x and y": ({"xy_terms": {(1, 1): 1e-4, (3, 0): 1e-6, (2, 4): 1e-9}}, (".roa",)),
    "terms of x and y, and even ones": (
        {"xy_terms": {(1, 1): 1e-4}, "aspheric_coefficients": EVEN},
        (".zmx", ".roa"),
    ),
    "Zernike terms by Noll": ({"zernike": NOLL}, (".roa",)),
    "fringe Zernike terms": ({"zernike": FRINGE, "conic": -0.2}, (".roa",)),
    "Zernike and even terms": ({"zernike": NOLL, "aspheric_coefficients": EVEN}, (".roa",)),
    "Forbes terms of a conic": ({"forbes": CON}, ()),
    "Forbes terms of a sphere": ({"forbes": BFS}, (".zmx", ".seq", ".json", ".roa")),
    "ellipse": ({"aperture": {"ellipse_mm": (12, 9), "offset_mm": (1, -0.5)}}, ()),
    "rectangle": ({"aperture": {"rectangle_mm": (9, 7)}}, ()),
    "decentred circle": ({"aperture": {"circle_mm": 9.0, "offset_mm": (0.0, 2.0)}}, ()),
    "polygon": ({"aperture": {"polygon_mm": [(9, -6), (0, 9), (-9, -6)]}}, (".zmx", ".seq", ".roa")),
    "obscuration": ({"obscurations": [{"rectangle_mm": (2, 3), "offset_mm": (1, 1)}]}, ()),
    "spider": ({"obscurations": [{"spider_arms": 3, "width_mm": 0.8, "length_mm": 16.0}]}, (".zmx", ".roa")),
    "rectangle and disc": (
        {"aperture": {"rectangle_mm": (9, 7)}, "inner_semi_diameter_mm": 2.0},
        (".zmx",),
    ),
    "a place of its own": (
        {"tilt_deg": (2, -3, 10), "decentre_mm": (0.2, -0.3, 0.1), "returns": True},
        (),
    ),
    "a place that moves all that follow": ({"tilt_deg": (2, -3, 10), "decentre_mm": (0.2, -0.3, 0.1)}, ()),
}


def double_gauss() -> rc.Lens:
    return rc.Lens.load("double-gauss-50mm")


def rays(half_width: float, half_slope: float, start_z: float) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(1)
    origins = np.column_stack([rng.uniform(-half_width, half_width, (400, 2)), np.full(400, start_z)])
    return origins, np.column_stack([rng.uniform(-half_slope, half_slope, (400, 2)), np.ones(400)])


def there_and_back(lens: rc.Lens, path: Path) -> tuple[rc.Lens, str]:
    """Saves and loads the lens. Returns the loaded lens and the warnings raised while saving."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        lens.save(path)
    said = " ".join(str(warning.message) for warning in caught)
    return rc.Lens.load(path), said


def assert_same_rays(
    lens: rc.Lens,
    again: rc.Lens,
    sent: tuple[np.ndarray, np.ndarray] | None = None,
    shift_z: float = 0.0,  # of the other's frame
) -> None:
    origins, directions = sent or rays(13, 0.1, -20)
    one = lens.trace(origins, directions, start="scene")
    other = again.trace(origins - (0, 0, shift_z), directions, start="scene")
    passed = one.status == rc.RayStatus.OK
    assert passed.sum() > 40
    np.testing.assert_array_equal(passed, other.status == rc.RayStatus.OK)
    # The distance between lines: rays end on the last surface, which may be a plane that was put before the film.
    apart = np.cross(one.origins_mm - other.origins_mm - (0, 0, shift_z), one.directions)[passed]
    assert np.abs(apart).max() < POSITION_MM
    assert np.abs(one.directions - other.directions)[passed].max() < DIRECTION


def check(lens: rc.Lens, surface: int, path: Path, lacking: tuple[str, ...]) -> None:
    again, said = there_and_back(lens, path)
    if path.suffix in lacking:
        assert f"surface {surface + 1} " in said
    else:
        assert "surface " not in said
        assert_same_rays(lens, again)
    if path.suffix == ".toml":
        assert again.surfaces == lens.surfaces
        assert pickle.loads(pickle.dumps(lens)) == lens


@pytest.mark.parametrize("suffix", FORMATS)
@pytest.mark.parametrize("name", FEATURES)
def test_features_of_a_surface(tmp_path, suffix, name):
    feature, lacking = FEATURES[name]
    check(double_gauss().with_surface(2, **feature), 2, tmp_path / f"lens{suffix}", lacking)


@pytest.mark.parametrize("suffix", FORMATS)
def test_a_tilted_element_with_forms(tmp_path, suffix):
    lens = double_gauss().with_surface(8, form="toroid", radius_of_curvature_x_mm=-70.0)
    check(lens.with_element_tilted(6, 7, x_deg=1, decentre_y_mm=0.1), 6, tmp_path / f"lens{suffix}", ())


@pytest.mark.parametrize("suffix", FORMATS)
def test_the_film_keeps_its_place_and_curvature(tmp_path, suffix):
    lens = double_gauss().tilted(x_deg=4, y_deg=-2).shifted(y_mm=3).with_film_radius(-150)
    again, said = there_and_back(lens, tmp_path / f"lens{suffix}")
    assert "surface " not in said
    assert again.film_radius_of_curvature_mm == pytest.approx(-150, rel=1e-12)
    # The frame begins where the front vertex would stand without its placement, which files may state by a thickness.
    assert_same_rays(lens, again, shift_z=lens.surfaces[0].decentre_mm[2] - again.surfaces[0].decentre_mm[2])


@pytest.mark.parametrize("suffix", FORMATS)
def test_a_fold_and_a_mirror(tmp_path, suffix):
    glass = rc.Surface(radius_of_curvature_mm=60, thickness_mm=6, material=1.62, clear_semi_diameter_mm=14)
    rows = [
        rc.Surface(type="stop", clear_semi_diameter_mm=6, thickness_mm=2),
        glass,
        rc.Surface(radius_of_curvature_mm=-90, thickness_mm=20, clear_semi_diameter_mm=14),
        rc.Surface(type="mirror", clear_semi_diameter_mm=25, tilt_deg=(45, 0, 0)),
        rc.Surface(
            radius_of_curvature_mm=-70, thickness_mm=-4, material=1.5, clear_semi_diameter_mm=14, tilt_deg=(45, 0, 0)
        ),
        rc.Surface(radius_of_curvature_mm=90, clear_semi_diameter_mm=14),
    ]
    lens = rc.Lens(surfaces=rows, film_distance_mm=-40, film_mm=(24, 16))
    again, said = there_and_back(lens, tmp_path / f"lens{suffix}")
    assert "surface " not in said
    assert_same_rays(lens, again, rays(6, 0.05, -5))
