"""Tilts, decentres, forms and apertures in Zemax files, read as Zemax means them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import realcam as rc

from .test_lens_round_trips import assert_same_rays, rays

pytestmark = pytest.mark.filterwarnings("ignore")

HEAD = """VERS 180000 0 0
MODE SEQ
UNIT MM X W X CM MR CPMM
FLOA
FTYP 3 0 2 1 0 0 0
XFLN 0 0
YFLN 0 10
WAVM 1 0.5875618 1
PWAV 1
SURF 0
  TYPE STANDARD
  CURV 0
  DISZ INFINITY
"""


def zemax(tmp_path: Path, *surfaces: str) -> rc.Lens:
    """The rows between object and image, each as "thickness; line; line"."""
    text = HEAD
    for number, row in enumerate(surfaces, 1):
        thickness, *lines = row.split("; ")
        body = [f"DISZ {thickness}", *lines]
        text += f"SURF {number}\n" + "".join(f"  {line}\n" for line in body)
    text += f"SURF {len(surfaces) + 1}\n  TYPE STANDARD\n  CURV 0\n  DISZ 0\n"
    path = tmp_path / "lens.zmx"
    path.write_text(text)
    return rc.Lens.load(path)


RAYS = rays(3, 0.05, -5)
STOP = "5; STOP; DIAM 4"
GLASS = "GLAS ___BLANK 1 0 1.6 40 0 0 0 0 0 0"
FRONT = f"4; TYPE STANDARD; CURV 0.02; {GLASS}; DIAM 10"
BACK = "40; TYPE STANDARD; CURV -0.02; DIAM 10"


def test_a_coordinate_break_moves_all_that_follows(tmp_path):
    lens = zemax(
        tmp_path, STOP, "0; TYPE COORDBRK; PARM 1 0.5; PARM 2 -0.3; PARM 3 4; PARM 4 -3; PARM 5 20", FRONT, BACK
    )
    moved = lens.surfaces[1]
    assert moved.decentre_mm == pytest.approx((0.5, -0.3, 0)) and moved.tilt_deg == pytest.approx((4, -3, 20))
    assert not moved.returns
    assert lens.surfaces[2].tilt_deg == (0, 0, 0)


def test_a_break_with_order_1_undoes_one_with_order_0(tmp_path):
    there = "TYPE COORDBRK; PARM 1 0.5; PARM 2 -0.3; PARM 3 4; PARM 4 -3; PARM 5 20"
    back = "TYPE COORDBRK; PARM 1 -0.5; PARM 2 0.3; PARM 3 -4; PARM 4 3; PARM 5 -20; PARM 6 1"
    plain = zemax(tmp_path, STOP, FRONT, BACK)
    undone = zemax(tmp_path, STOP, f"0; {there}", f"0; {back}", FRONT, BACK)
    assert undone.is_rotational
    assert undone.surfaces == plain.surfaces
    tilted = zemax(tmp_path, STOP, f"0; {there}", f"0; CURV 0.02; {GLASS}; DIAM 10", f"4; {back}", BACK)
    alone = plain.with_surface(1, decentre_mm=(0.5, -0.3, 0), tilt_deg=(4, -3, 20), returns=True)
    assert_same_rays(tilted, alone, RAYS)


def test_tilts_of_a_surface_itself(tmp_path):
    """SCBD: before the surface, and behind it as stated, repeated or undone."""
    row = f"4; CURV 0.02; {GLASS}; DIAM 10"
    place = "0.5 -0.3 4 -3 20"
    alone = zemax(tmp_path, STOP, f"{row}; SCBD 1 0 0 {place}; SCBD 2 1 2 0 0 0 0 0", BACK)
    assert alone.surfaces[1].tilt_deg == pytest.approx((4, -3, 20)) and alone.surfaces[1].returns
    there = "TYPE COORDBRK; PARM 1 0.5; PARM 2 -0.3; PARM 3 4; PARM 4 -3; PARM 5 20"
    onward = zemax(tmp_path, STOP, f"{row}; SCBD 1 0 0 {place}", BACK)
    assert onward.surfaces == zemax(tmp_path, STOP, f"0; {there}", row, BACK).surfaces
    # Order 1 undoes order 0, here stated in figures.
    stated = zemax(tmp_path, STOP, f"{row}; SCBD 1 0 0 {place}; SCBD 2 1 0 -0.5 0.3 -4 3 -20", BACK)
    assert_same_rays(stated, alone, RAYS)


def test_forms_of_zemax(tmp_path):
    def first(*lines: str) -> rc.Surface:
        shaped = f"4; CURV 0.02; {GLASS}; DIAM 10; " + "; ".join(lines)
        return zemax(tmp_path, STOP, shaped, BACK).surfaces[1]

    toroid = first("TYPE TOROIDAL", "PARM 1 30", "PARM 3 1e-5")
    assert (toroid.form, toroid.radius_of_curvature_x_mm) == ("toroid", 30)
    assert toroid.aspheric_coefficients == {4: 1e-5}
    biconic = first("TYPE BICONICX", "PARM 1 -60", "PARM 2 -0.5")
    assert (biconic.form, biconic.radius_of_curvature_x_mm, biconic.conic_x) == ("biconic", -60, -0.5)
    odd = first("TYPE ODDASPHE", "PARM 3 1e-4", "PARM 4 1e-6")
    assert odd.radial_terms == {3: 1e-4} and odd.aspheric_coefficients == {4: 1e-6}
    # x, y, x^2, x y, y^2 of x and y over 10 mm.
    xy = first("TYPE XPOLYNOM", "XDAT 1 5", "XDAT 2 10", "XDAT 3 0.1", "XDAT 6 0.2", "XDAT 7 0.3")
    assert xy.xy_terms == pytest.approx({(1, 0): 0.01, (1, 1): 0.002, (0, 2): 0.003})
    noll = first("TYPE SZERNSAG", "XDAT 1 4", "XDAT 2 12", "XDAT 6 0.05")
    assert noll.zernike == {"order": "noll", "radius_mm": 12, "coefficients_mm": [0, 0, 0, 0.05]}
    assert first("TYPE FZERNSAG", "XDAT 1 1", "XDAT 2 12", "XDAT 3 0.05").zernike["order"] == "fringe"


def test_apertures_of_zemax(tmp_path):
    def first(*lines: str) -> rc.Surface:
        return zemax(tmp_path, STOP, f"4; CURV 0.02; {GLASS}; DIAM 10; " + "; ".join(lines), BACK).surfaces[1]

    rectangle = first("SQAP 5 3", "OBDC 1 -1")
    assert rectangle.aperture == {"rectangle_mm": (5, 3), "offset_mm": (1, -1)}
    assert rectangle.clear_semi_diameter_mm == pytest.approx(np.hypot(6, 4))
    assert first("ELAP 5 3").aperture == {"ellipse_mm": (5, 3)}
    assert len(first("SPID 0.5 3").obscurations) == 3
