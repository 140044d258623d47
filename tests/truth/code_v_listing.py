"""Figures of case A: CODE V 10.8, listing of "Double Gauss F/2 - Available Glasses" (29-Jun-17), lengths in
mm.

The few that the tests need are copied here; the listing itself lies in ../shared/truth, where it is at hand.
"""

from __future__ import annotations

import re
from pathlib import Path

import realcam as rc

LISTING = Path(__file__).resolve().parents[3] / "shared" / "truth" / "ag_dblgauss.lis"

FIRST_ORDER = {
    "effective_focal_length_mm": 100.0038,
    "back_focal_distance_mm": 61.4875,
    "front_focal_distance_mm": -29.3208,
    "f_number": 2.0001,
    "entrance_pupil_diameter_mm": 50.0000,
    "entrance_pupil_position_mm": 57.9120,
    "exit_pupil_diameter_mm": 57.3201,
}
EXIT_PUPIL_FROM_LAST_VERTEX = -53.1569
FOCUS = 0.400269  # the film's distance in front of the paraxial focus
SPHERICAL_SUM = -0.306954  # third-order transverse sums: SA, and DST at 14 degrees
DISTORTION_SUM = -0.232420

# Surface by surface: X, Y, Z (from the surface's own vertex), TAN X, TAN Y behind it.
Row = tuple[float, float, float, float, float]

AXIAL_MARGINAL: list[Row] = [
    (25.000000, 0.000000, 5.866433, -0.185302, 0.000000),
    (24.109772, 0.000000, 1.920632, -0.200953, 0.000000),
    (22.844992, 0.000000, 7.714534, -0.394267, 0.000000),
    (20.958242, 0.000000, 0.000000, -0.395393, 0.000000),
    (16.784894, 0.000000, 6.754936, -0.112583, 0.000000),
    (15.702464, 0.000000, 0.000000, -0.112583, 0.000000),
    (14.610682, 0.000000, -4.050377, 0.153430, 0.000000),
    (15.815163, 0.000000, 0.000000, 0.151784, 0.000000),
    (16.882946, 0.000000, -3.965091, -0.057039, 0.000000),
    (16.583956, 0.000000, 0.776812, -0.071127, 0.000000),
    (16.261006, 0.000000, -1.682704, -0.258832, 0.000000),
]
SKEW_AT_14_DEGREES: list[Row] = [
    (25.000000, -12.986720, 7.570573, -0.191290, 0.255919),
    (24.308178, -12.061158, 2.437190, -0.211138, 0.375690),
    (22.783140, -9.347566, 9.160149, -0.415726, 0.358991),
    (21.394677, -8.148589, 0.000000, -0.417065, 0.360147),
    (16.783147, -4.166402, 7.257112, -0.112921, 0.421165),
    (15.754175, -0.328604, 0.000000, -0.112921, 0.421165),
    (14.695540, 3.619826, -4.372943, 0.171784, 0.315011),
    (16.099525, 6.194395, 0.000000, 0.169755, 0.311290),
    (17.109703, 8.046817, -5.049217, -0.048037, 0.352610),
    (16.790182, 10.392211, 1.102304, -0.067266, 0.184927),
    (16.563765, 11.014676, -2.531694, -0.258613, 0.213120),
]


def rays_of_the_listing() -> list[tuple[float, list[Row]]]:
    """All rays of the analysis "ssp": the tangent of the field angle, and the rows of surfaces 1 to 11."""
    rays: list[tuple[float, list[Row]]] = []
    for line in LISTING.read_text(encoding="latin-1").split("CODE V> ana")[-1].splitlines():
        numbers = [float(x) for x in re.findall(r"[-+]?\d+\.\d+(?:E[-+]\d+)?", line)]
        if line.startswith(" OBJ"):
            rays.append((numbers[-1], []))
        elif rays and re.match(r"^ {2,3}\d{1,2} ", line) and len(numbers) == 8:
            x, y, z, tan_x, tan_y = numbers[:5]
            rays[-1][1].append((x, y, z, tan_x, tan_y))
    return rays


# The lens file has the six decimals of the indices that the listing prints, which leave 3e-5 mm in real rays.
# Schott's own formulas give those decimals and more.
GLASSES = {1: ("N-SSK2", 1.622292), 3: ("N-SK2", 1.607379), 4: ("F5", 1.603417)}
GLASSES |= {7: ("F5", 1.603417), 8: ("N-SK16", 1.620408), 10: ("N-SK16", 1.620408)}


def listed_lens() -> rc.Lens:
    """The bundled lens with Schott's glasses, and room for rays that the listing's vignetting leaves out."""
    surfaces = []
    for number, s in enumerate(rc.Lens.load("double-gauss-100mm").surfaces, start=1):
        material = None
        if number in GLASSES:
            material = rc.Glass.named("schott:" + GLASSES[number][0])
        surfaces.append(
            rc.Surface(
                radius_of_curvature_mm=s.radius_of_curvature_mm,
                thickness_mm=s.thickness_mm,
                material=material,
                clear_semi_diameter_mm=s.clear_semi_diameter_mm * (1.0 if s.type == "stop" else 1.06),
                type=s.type,
            )
        )
    return rc.Lens(surfaces=surfaces, film_distance_mm=61.087268, wavelength_nm=587.6)
