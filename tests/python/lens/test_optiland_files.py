"""Optiland's files beyond a row of spheres."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

pytestmark = pytest.mark.filterwarnings("ignore")

AIR = {"type": "IdealMaterial", "index": 1.0}


def frame(z: float, **more: float) -> dict:
    return {"x": 0.0, "y": 0.0, "z": z, "rx": 0.0, "ry": 0.0, "rz": 0.0, "reference_cs": None} | more


def surface(kind: str, z: float, radius: float, material: dict = AIR, **more) -> dict:
    geometry = {"type": kind, "cs": frame(z), "radius": radius} | more.pop("geometry", {})
    return {"geometry": geometry, "material_post": material} | more


def written(tmp_path: Path, *surfaces: dict, field_deg: float = 5) -> Path:
    first = {"geometry": {"type": "Plane", "cs": frame(-np.inf), "radius": np.inf}, "material_post": AIR}
    lens = {
        "name": "x",
        "aperture": {"type": "EPD", "value": 4},
        "fields": {"fields": [{"x": 0, "y": field_deg}], "field_definition": {"field_type": "AngleField"}},
        "wavelengths": {"wavelengths": [{"value": 0.5876, "is_primary": True, "unit": "um"}]},
        "surface_group": {"surfaces": [first, *surfaces]},
    }
    path = tmp_path / "lens.json"
    path.write_text(json.dumps(lens))
    return path


GLASS = {"type": "IdealMaterial", "index": 1.5}
BACK = surface("StandardGeometry", 4.0, -50.0)
IMAGE = surface("Plane", 50.0, np.inf)


def test_a_glass_that_another_maker_has_is_taken_with_a_warning(tmp_path):
    """Optiland's database has Schott's SK16 in Hikari's folder too."""
    sk16 = {"type": "Material", "name": "SK16", "filename": "/data-nk/glass/hikari/SK16.yml"}
    path = written(tmp_path, surface("StandardGeometry", 0.0, 50.0, sk16, is_stop=True), BACK, IMAGE)
    with pytest.warns(UserWarning, match='the catalogue of "hikari" has no glass "SK16"'):
        lens = rc.Lens.load(path)
    assert lens.surfaces[1].material.index(587.56) == pytest.approx(1.62041, abs=2e-5)


def test_forbes_terms(tmp_path):
    config = {"radius": 40.0, "conic": 0.0, "norm_radius": 12.0, "terms": {"0": 0.05, "2": 0.01}}
    front = surface("ForbesQNormalSlopeGeometry", 0.0, 40.0, GLASS, is_stop=True, geometry={"surface_config": config})
    lens = rc.Lens.load(written(tmp_path, front, BACK, IMAGE))
    assert lens.surfaces[1].forbes == {"kind": "bfs", "radius_mm": 12, "coefficients_mm": [0.05, 0, 0.01]}


def test_apertures(tmp_path):
    def aperture(**shape) -> rc.Surface:
        front = surface("StandardGeometry", 0.0, 40.0, GLASS, is_stop=True)
        back = surface("StandardGeometry", 4.0, -50.0, aperture=shape)
        return rc.Lens.load(written(tmp_path, front, back, IMAGE)).surfaces[2]

    disc = {"type": "RadialAperture", "r_max": 9.0, "r_min": 1.0}
    box = {"type": "RectangularAperture", "x_min": -3.0, "x_max": 5.0, "y_min": -2.0, "y_max": 2.0}
    both = aperture(type="IntersectionAperture", a=disc, b=box)
    assert both.aperture == {"rectangle_mm": (4, 2), "offset_mm": (1, 0)}
    assert (both.clear_semi_diameter_mm, both.inner_semi_diameter_mm) == (pytest.approx(np.hypot(5, 2)), 1)
    without = aperture(type="DifferenceAperture", a=disc, b=box)
    assert without.obscurations[0]["rectangle_mm"] == (4, 2)
    assert aperture(type="PolygonAperture", x=[0, 5, 0], y=[0, 0, 5]).aperture["polygon_mm"][1] == (5, 0)
    with pytest.raises(rc.LensFileError, match=r"surface 2.*not a circle \(UnionAperture\)"):
        aperture(type="UnionAperture", a=disc, b=box)


def test_fields_beyond_a_curved_image_end_at_its_edge(tmp_path):
    """A curved image, such as an eye's retina, holds no image circle wider than its own sphere."""
    image = surface("StandardGeometry", 45.0, -12.0)
    front = surface("StandardGeometry", 0.0, 40.0, GLASS, is_stop=True)
    with pytest.warns(UserWarning, match="fields beyond the edge of its curved image"):
        lens = rc.Lens.load(written(tmp_path, front, BACK, image, field_deg=40))
    assert lens.film_radius_of_curvature_mm == pytest.approx(-12)
    assert 0.5 * np.hypot(*lens.film_mm) < 12


def test_a_mirror_that_folds_the_axis(tmp_path):
    """A plane at 45 degrees before a lens that looks along y."""
    mirror = surface("Plane", 20.0, np.inf, is_stop=True, interaction_model={"is_reflective": True})
    mirror["geometry"]["cs"] = frame(20.0, rx=np.pi / 4)
    aside = []
    for y, radius, material in ((20.0, 40.0, GLASS), (24.0, -50.0, AIR), (70.0, np.inf, AIR)):
        one = surface("StandardGeometry", 20.0, radius, material)
        one["geometry"]["cs"] = frame(20.0, y=y, rx=-np.pi / 2)  # its z axis is y
        aside.append(one)
    lens = rc.Lens.load(written(tmp_path, mirror, *aside))
    straight = rc.Lens.load(
        written(
            tmp_path,
            surface("Plane", 0.0, np.inf, is_stop=True),
            surface("StandardGeometry", 20.0, 40.0, GLASS),
            surface("StandardGeometry", 24.0, -50.0),
            surface("Plane", 70.0, np.inf),
        )
    )
    heights = np.linspace(-1, 1, 7)
    for axis in (0, 1):
        origins = np.zeros((7, 3))
        origins[:, axis], origins[:, 2] = heights, -5
        direction = np.tile([0.0, 0, 1], (7, 1))
        folded, plain = (each.trace(origins, direction, start="scene") for each in (lens, straight))
        assert (folded.status == rc.RayStatus.OK).all()
        # Rays are given in the frame in front of the lens. The fold has turned the axis into y, and y into z.
        np.testing.assert_allclose(folded.directions[:, 1], plain.directions[:, 2], atol=1e-12)
        across = np.abs(folded.directions[:, 2 * axis]), np.abs(plain.directions[:, axis])
        np.testing.assert_allclose(*across, atol=1e-12)
