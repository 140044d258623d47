"""Patents' lenses beside products that photographers have measured (docs/photographs.md).

The bounds were fixed before the lenses were traced. Products beyond a bound stay here by name, and their tests have to
fail: an entry that comes within the bound is to be removed from the list and from the page.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import numpy as np
import photographs
import pytest

TABLE = photographs.load_table()

DISTORTION_MISFITS = {
    "Canon EF 11-24mm f/4L USM, 11 mm",
    "Carl Zeiss Jena Flektogon 20mm f/4",
    "FE 24mm f/2.8 G",
    "Laowa 15mm f/4 Wide Angle Macro",
}
RED_MISFITS: set[str] = set()
FALLOFF_MISFITS = {
    "Nikon AI 80-200mm f/4.5 Zoom New, 200 mm",
    "Sigma 180mm f/2.8 EX DG OS HSM APO Macro",
    "Sigma 28mm F1.4 DG HSM | A",
    "Nikon AF-S Nikkor 20mm f/1.8G ED",
    "Nikon AI-S Nikkor 135mm f/2.8",
    "Nikkor Z 50mm f/1.2 S",
    "FE 28mm f/2",
    "FE 20mm f/1.8 G",
    "Nikkor Z 40mm f/2",
    "Laowa 15mm f/4 Wide Angle Macro",
    "Laowa 12mm f/2.8 Zero-D",
}


def products(misfits: Collection[str], key: str) -> list[Any]:
    """Parameters for the products that have the measurement `key`; a misfit's test has to fail."""
    found = []
    for entry in TABLE["product"]:
        if key in entry:
            name = photographs.name_of(entry)
            marks = [pytest.mark.xfail(strict=True, raises=AssertionError)] if name in misfits else []
            found.append(pytest.param(entry, id=name, marks=marks))
    return found


def test_bounds_are_the_contributors_differences_and_the_tolerances() -> None:
    found = photographs.scatter(TABLE["repeated"])
    for values, limit, digits in (
        (found.distortion_um, photographs.SCATTER_UM, 1),
        (found.colour_um, photographs.SCATTER_COLOUR_UM, 1),
        (found.falloff_stops, photographs.SCATTER_STOPS, 3),
    ):
        assert round(float(np.quantile(values, 0.9)), digits) == limit


@pytest.mark.parametrize(
    "model",
    [{"model": "ptlens", "a": 0.01, "b": -0.03, "c": 0.02}, {"model": "poly3", "k1": 0.01}],
    ids=["ptlens", "poly3"],
)
def test_lensfun_keeps_the_unit_radius(model: dict[str, Any]) -> None:
    assert photographs.distorted(np.array([1.0]), model) == pytest.approx(1.0, rel=1e-15)


@pytest.mark.parametrize("entry", products(DISTORTION_MISFITS, "distortion"))
def test_distortion_is_the_products(entry: dict[str, Any]) -> None:
    found = photographs.compare(entry, with_falloff=False)
    assert found.covered_mm > 21.5  # the whole frame of 36 mm x 24 mm, whose half diagonal is 21.63 mm
    assert found.distortion_um <= photographs.DISTORTION_BOUND_UM


@pytest.mark.parametrize("entry", products(RED_MISFITS, "colour"))
def test_lateral_colour_of_red_is_the_products(entry: dict[str, Any]) -> None:
    found = photographs.compare(entry, with_falloff=False)
    assert found.red_um is not None
    assert found.red_um <= photographs.COLOUR_BOUND_UM


@pytest.mark.slow
@pytest.mark.parametrize("entry", products(FALLOFF_MISFITS, "falloff"))
def test_falloff_is_the_products(entry: dict[str, Any]) -> None:
    lens = photographs.load_lens(entry)
    assert max(f.rms_stops for f in photographs.compare_falloff(lens, entry)) <= photographs.FALLOFF_BOUND_STOPS
