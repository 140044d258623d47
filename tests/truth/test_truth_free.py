"""Tilted, decentred and freeform surfaces side by side with Optiland and ray-optics.

The peers' figures are in free_rays.json.gz (tools/make_free_rays.py). Where both know a surface, they agree to 1e-12
mm.
"""

from __future__ import annotations

import gzip
import json
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

from ..measurement import Measurement, hold

SECTION = "Other programs"
FILE = Path(__file__).with_name("free_rays.json.gz")
CASES = json.loads(gzip.decompress(FILE.read_bytes()))["lenses"]

# The limits of the peers of centred lenses: a millionth of a wavelength, and the angle that it subtends at 100 mm.
POSITION_MM, DIRECTION = 1e-9, 1e-11


def _arguments(form: dict) -> dict:
    """JSON has text for keys."""
    given = dict(form)
    for name in ("aspheric_coefficients", "radial_terms"):
        if name in given:
            given[name] = {int(power): value for power, value in given[name].items()}
    if "xy_terms" in given:
        given["xy_terms"] = {(i, j): value for i, j, value in given["xy_terms"]}
    return given


def lens_of(rows: list[dict]) -> rc.Lens:
    surfaces = [
        rc.Surface(
            radius_of_curvature_mm=row["radius"],
            thickness_mm=row["thickness"],
            material=None if row["mirror"] else row["index"],
            clear_semi_diameter_mm=row["semi"],
            conic=row["conic"],
            type="mirror" if row["mirror"] else "refracting",
            decentre_mm=row["decentre"],
            tilt_deg=row["tilt"],
            returns=row["returns"],
            **_arguments(row["form"]),
        )
        for row in rows
    ]
    # In front of the rays' origins, and out of their way.
    stop = rc.Surface(type="stop", clear_semi_diameter_mm=1000)
    return rc.Lens(surfaces=[stop, *surfaces], film_distance_mm=1, allow_overlap=True)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case["name"])
def test_rays_end_where_the_peers_say(case):
    lens, rays = lens_of(case["rows"]), np.array(case["rays"])
    traced = lens.trace(rays[:, :3], rays[:, 3:], start="scene")
    for peer, said in case["said"].items():
        said = np.array(said, float)
        passed = np.isfinite(said[:, 0])
        assert passed.sum() >= 20
        assert (traced.status[passed] == rc.RayStatus.OK).all()
        off = np.abs(np.column_stack([traced.origins_mm, traced.directions]) - said)[passed]
        for what, worst, limit, unit in (
            ("points", off[:, :3].max(), POSITION_MM, "mm"),
            ("directions", off[:, 3:].max(), DIRECTION, ""),
        ):
            tried = f"{passed.sum()} rays through {case['name']}"
            hold(Measurement(SECTION, f"{what}, {peer}", tried, "core", "float64", float(worst), limit, unit))


@pytest.mark.parametrize("case", CASES, ids=lambda case: case["name"])
def test_light_goes_back_the_way_it_came(case):
    lens, rays = lens_of(case["rows"]), np.array(case["rays"])
    there = lens.trace(rays[:, :3], rays[:, 3:], start="scene")
    back = lens.trace(there.origins_mm + 2 * there.directions, -there.directions, start="film")
    assert (back.status == rc.RayStatus.OK).all()
    direction = ((rays[:, 2] - back.origins_mm[:, 2]) / back.directions[:, 2])[:, None]
    # Light of a point of the first surface; over 100 mm a rounding of a direction is 1e-14 mm.
    assert np.abs(back.origins_mm + direction * back.directions - rays[:, :3]).max() < 1e-10
    assert np.abs(back.directions + rays[:, 3:]).max() < 1e-12
