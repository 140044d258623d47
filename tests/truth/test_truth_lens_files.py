"""Lens files through other programs: what realcam writes, Optiland and ray-optics read as the same lens."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

# Refracting spheres and aspheres, with a stop in the middle, in front, and behind.
# Lenses with catalogue glasses are left out: their indices differ by 1e-7 between the programs' catalogues, and
# ray-optics takes F4 from CDGM where Schott is listed.
CENTRED = ["double-gauss-50mm", "tessar-50mm", "sonnar-50mm", "phone-4mm", "wide-22mm"]

FORMS: dict[str, dict] = {
    "conic": {"conic": -0.7},
    "even terms": {"aspheric_coefficients": {4: 1e-6, 6: -2e-9}},
    "odd terms": {"radial_terms": {3: 1e-5, 5: 1e-9}},
    "toroid": {
        "form": "toroid",
        "radius_of_curvature_x_mm": 60.0,
        "conic": 0.2,
        "aspheric_coefficients": {4: 1e-6},
    },
    "Forbes terms of a conic": {"forbes": {"kind": "con", "radius_mm": 15.0, "coefficients_mm": [0.05, -0.02]}},
    "tilt": {"tilt_deg": (2, -3, 10), "decentre_mm": (0.2, -0.3, 0.1), "returns": True},
}
# Forms that ray-optics lacks.
POLYNOMIALS: dict[str, dict] = {
    "terms of x and y": {"xy_terms": {(1, 1): 1e-4, (3, 0): 1e-6}, "aspheric_coefficients": {4: 1e-6}},
    "Zernike terms": {"zernike": {"order": "noll", "radius_mm": 14.0, "coefficients_mm": [0, 0.02, -0.01, 0.02, 0.01]}},
}

TOLERANCE_MM = 1e-9  # doubles at 100 mm have 1e-14


def lens_of(name: str) -> rc.Lens:
    if name in CENTRED:
        return rc.Lens.load(name)
    # Indices without dispersion, because the programs have different formulas for n_d and V_d.
    front = rc.Surface(radius_of_curvature_mm=40, thickness_mm=6, material=1.6, clear_semi_diameter_mm=12)
    return rc.Lens(
        surfaces=[
            rc.Surface(type="stop", clear_semi_diameter_mm=6, thickness_mm=2),
            front.replace(**{**FORMS, **POLYNOMIALS}[name]),
            rc.Surface(radius_of_curvature_mm=-90, clear_semi_diameter_mm=12, tilt_deg=(1, 0, 0), returns=True),
        ],
        film_distance_mm=50,
        film_mm=(24, 16),
    )


def save(lens: rc.Lens, path: Path) -> Path:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        lens.save(path)
    return path


def rays_of(lens: rc.Lens) -> tuple[np.ndarray, np.ndarray]:
    """Origins 10 mm in front of the lens and directions, (N, 3), of rays at up to 3 degrees through half the pupil."""
    first = lens.first_order()
    rng = np.random.default_rng(1)
    directions = np.column_stack([rng.uniform(-0.05, 0.05, (40, 2)), np.ones(40)])
    aims = 0.25 * first.entrance_pupil_diameter_mm * rng.uniform(-0.7, 0.7, (40, 2))
    origins = np.column_stack([aims, np.full(40, first.entrance_pupil_position_mm)])
    origins -= (first.entrance_pupil_position_mm + 10) * directions
    return origins, directions / np.linalg.norm(directions, axis=1, keepdims=True)


def on_film(lens: rc.Lens, origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
    out = lens.trace(origins, directions, start="scene")
    assert (out.status == rc.RayStatus.OK).all()
    distance = (lens.film_position_mm - out.origins_mm[:, 2]) / out.directions[:, 2]
    return (out.origins_mm + distance[:, None] * out.directions)[:, :2]


def on_film_of_optiland(optic, wavelength_nm: float, origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
    from optiland.rays import RealRays

    for surface in optic.surfaces:
        if hasattr(surface.geometry, "tol"):
            surface.geometry.tol = 1e-13  # Optiland ends its search on an asphere at 1e-6 mm
    ones = np.ones(len(origins))
    rays = RealRays(*origins.T, *directions.T, ones, ones * wavelength_nm / 1000)
    optic.surfaces.trace(rays)
    return np.column_stack([rays.x, rays.y])


# Optiland has no glass without dispersion in a .zmx file: V_d = 0 becomes NaN there.
@pytest.mark.parametrize("name", [*(name for name in CENTRED if name != "wide-22mm"), *FORMS, *POLYNOMIALS])
def test_optiland_reads_the_same_lens(name, tmp_path):
    fileio = pytest.importorskip("optiland.fileio")
    suffix, read = (".zmx", fileio.load_zemax_file) if name in CENTRED else (".json", fileio.load_optiland_file)
    lens = lens_of(name)
    path = save(lens, tmp_path / f"lens{suffix}")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        optic = read(str(path))
    rays = rays_of(lens)
    found = on_film_of_optiland(optic, lens.wavelength_nm, *rays)
    assert np.abs(found - on_film(lens, *rays)).max() < TOLERANCE_MM


@pytest.mark.parametrize("name", [*CENTRED, *FORMS])
def test_ray_optics_reads_the_same_lens(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # where it leaves a log
    pytest.importorskip("rayoptics")
    from rayoptics.gui import appcmds
    from rayoptics.raytr import raytrace
    from rayoptics.zemax import zmxread

    lens = lens_of(name)
    if name in CENTRED:
        model, _ = zmxread.read_lens_file(save(lens, tmp_path / "lens.zmx"))
    else:
        model = appcmds.open_model(save(lens, tmp_path / "lens.roa"))
    sequence = model["seq_model"]
    sequence.gaps[0].thi = 10.0  # an object 1e10 mm away leaves doubles steps of 1e-6 mm
    sequence.update_model()
    rays = rays_of(lens)
    for origin, direction, expected in zip(*rays, on_film(lens, *rays), strict=True):
        segments, _, _ = raytrace.trace_raw(
            sequence.path(lens.wavelength_nm),
            origin + np.array([0, 0, 10.0]),
            direction,
            lens.wavelength_nm,
            intersect_obj=False,
            eps=1e-13,
        )
        assert np.abs(segments[-1][0][:2] - expected).max() < TOLERANCE_MM


def test_optiland_files_are_read(tmp_path):
    fileio = pytest.importorskip("optiland.fileio")
    from optiland.samples import objectives, simple

    for made in (objectives.DoubleGauss, objectives.TessarLens, objectives.Telephoto, simple.AsphericSinglet):
        optic = made()
        path = tmp_path / "lens.json"
        fileio.save_optiland_file(optic, str(path))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            lens = rc.Lens.load(path)
        rays = rays_of(lens)
        found = on_film_of_optiland(optic, lens.wavelength_nm, *rays)
        # The indices of the two programs' catalogues agree to some 1e-7, which moves rays by as much of the path.
        assert np.abs(found - on_film(lens, *rays)).max() < 1e-5, made.__name__
