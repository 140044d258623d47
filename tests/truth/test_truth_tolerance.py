"""Copies of a triplet with the same errors, judged by Optiland (tools/make_tolerance_peer.py)."""

from __future__ import annotations

import gzip
import json
from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from realcam._core import _ToleranceEvaluator

PEER = json.loads(gzip.decompress((Path(__file__).parent / "tolerance_peer.json.gz").read_bytes()))


@pytest.fixture(scope="module")
def mtf_of_copies() -> np.ndarray:
    """(copies, fields, 2): tangential and sagittal."""
    surfaces, place = [], {}
    for row, (radius, thickness, index) in enumerate(PEER["rows"]):
        if row == PEER["stop"]:
            surfaces.append(rc.Stop(clear_semi_diameter_mm=10))
        place[row] = len(surfaces)
        surfaces.append(
            rc.Surface(
                radius_of_curvature_mm=radius,
                thickness_mm=thickness if row + 1 < len(PEER["rows"]) else 0,
                material=None if index == 1 else index,
                clear_semi_diameter_mm=12,
            )
        )
    lens = rc.Lens(
        surfaces=surfaces,
        film_distance_mm=PEER["rows"][-1][1],
        wavelength_nm=PEER["wavelength_nm"],
        allow_overlap=True,
    )
    lens = lens.stopped_down(lens.first_order().effective_focal_length_mm / PEER["aperture_mm"])
    fields = np.column_stack([np.zeros(3), np.deg2rad(PEER["fields_deg"])])
    colours = np.array([[PEER["wavelength_nm"], 1.0]])
    judge = _ToleranceEvaluator(lens, fields, np.inf, colours, [PEER["frequency_per_mm"]], 16, True, False, None, None)
    errors = [(kind, place[row], place[row]) for kind, row in PEER["errors"]]
    mtf: np.ndarray = judge.judge(errors, np.array(PEER["sizes"]))["mtf"][..., 0]
    return mtf


def test_quantiles_of_mtf_are_optilands(mtf_of_copies: np.ndarray) -> None:
    shares = (0.1, 0.25, 0.5, 0.75, 0.9)
    ours, theirs = (np.quantile(mtf.mean((1, 2)), shares) for mtf in (mtf_of_copies, np.array(PEER["mtf"])))
    np.testing.assert_allclose(ours, theirs, rtol=0.02)


def test_each_copy_is_good_or_bad_to_optiland_too(mtf_of_copies: np.ndarray) -> None:
    """Optiland aims at the pupil of close rays, scales all fields by the limit of the axis, and ends its search for the
    focus at a tolerance of 1e-5 of the merit: copies differ by some hundredths, and which are bad does not."""
    theirs = np.array(PEER["mtf"])
    assert np.abs(mtf_of_copies - theirs).max() < 0.08
    for field, direction in np.ndindex(theirs.shape[1:]):
        assert np.corrcoef(mtf_of_copies[:, field, direction], theirs[:, field, direction])[0, 1] > 0.95
