"""Tilts and forms in what realcam writes: Optiland and ray-optics read the same lens."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

TOLERANCE_MM = 1e-9  # as for centred lenses

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


def written(form: dict, path: Path) -> rc.Lens:
    # Indices without dispersion, because the programs have different formulas for n_d and V_d.
    front = rc.Surface(radius_of_curvature_mm=40, thickness_mm=6, material=1.6, clear_semi_diameter_mm=12)
    lens = rc.Lens(
        surfaces=[
            rc.Surface(type="stop", clear_semi_diameter_mm=6, thickness_mm=2),
            front.replace(**form),
            rc.Surface(radius_of_curvature_mm=-90, clear_semi_diameter_mm=12, tilt_deg=(1, 0, 0), returns=True),
        ],
        film_distance_mm=50,
        film_mm=(24, 16),
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        lens.save(path)
    return lens


def rays_and_ends(lens: rc.Lens) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Origins and directions, (N, 3), and x and y on the film."""
    rng = np.random.default_rng(1)
    origins = np.column_stack([rng.uniform(-4, 4, (40, 2)), np.full(40, -10.0)])
    directions = np.column_stack([rng.uniform(-0.05, 0.05, (40, 2)), np.ones(40)])
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    out = lens.trace(origins, directions, start="scene")
    passed = out.status == rc.RayStatus.OK
    assert passed.sum() > 20
    at, to = out.origins_mm[passed], out.directions[passed]
    return (
        origins[passed],
        directions[passed],
        (at + to * ((lens.film_position_mm - at[:, 2]) / to[:, 2])[:, None])[:, :2],
    )


@pytest.mark.parametrize("name", [*FORMS, *POLYNOMIALS])
def test_optiland_reads_the_same_lens(name, tmp_path):
    fileio = pytest.importorskip("optiland.fileio")
    from optiland.rays import RealRays

    lens = written({**FORMS, **POLYNOMIALS}[name], tmp_path / "lens.json")
    optic = fileio.load_optiland_file(str(tmp_path / "lens.json"))
    for surface in optic.surfaces:
        if hasattr(surface.geometry, "tol"):
            surface.geometry.tol = 1e-13  # Optiland ends its search on an asphere at 1e-6 mm
    origins, directions, ends = rays_and_ends(lens)
    ones = np.ones(len(origins))
    rays = RealRays(*origins.T, *directions.T, ones, ones * lens.wavelength_nm / 1000)
    optic.surfaces.trace(rays)
    assert np.abs(np.column_stack([rays.x, rays.y]) - ends).max() < TOLERANCE_MM


@pytest.mark.parametrize("name", FORMS)
def test_ray_optics_reads_the_same_lens(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # where it leaves a log
    appcmds = pytest.importorskip("rayoptics.gui.appcmds")
    from rayoptics.raytr import raytrace

    lens = written(FORMS[name], tmp_path / "lens.roa")
    sequence = appcmds.open_model(tmp_path / "lens.roa")["seq_model"]
    sequence.gaps[0].thi = 10.0  # an object 1e10 mm away leaves doubles steps of 1e-6 mm
    sequence.update_model()
    for origin, direction, expected in zip(*rays_and_ends(lens), strict=True):
        segments, _, _ = raytrace.trace_raw(
            sequence.path(lens.wavelength_nm),
            origin + np.array([0, 0, 10.0]),
            direction,
            lens.wavelength_nm,
            intersect_obj=False,
            eps=1e-13,
        )
        assert np.abs(segments[-1][0][:2] - expected).max() < TOLERANCE_MM
