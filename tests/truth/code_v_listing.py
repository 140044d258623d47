"""Figures of case A: CODE V 10.8, listing of "Double Gauss F/2 - Available Glasses" (29-Jun-17), lengths in
mm.

What the tests need of it is here and, of all its rays, in code_v_rays.csv.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

import realcam as rc

RAYS = Path(__file__).with_name("code_v_rays.csv")

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

# Surface by surface: X, Y, Z (from the surface's own vertex), TAN X, TAN Y behind it, RAY LENGTH from the surface
# before (of the first: from its vertex plane), ANG INC and ANG REF in degrees.
Row = tuple[float, float, float, float, float, float, float, float]


def rays_of_the_listing() -> list[tuple[float, list[Row]]]:
    """All rays of the analysis "ssp": the tangent of the field angle, and the rows of surfaces 1 to 11."""
    rays: dict[str, tuple[float, list[Row]]] = {}
    with RAYS.open(newline="") as file:
        for ray, tangent, _surface, *numbers in list(csv.reader(file))[1:]:
            x, y, z, tan_x, tan_y, length, incidence, refraction = map(float, numbers)
            rays.setdefault(ray, (float(tangent), []))[1].append((x, y, z, tan_x, tan_y, length, incidence, refraction))
    return list(rays.values())


# The indices that the listing prints at 656.3, 587.6 and 486.1 nm.
INDICES = {
    "schott:N-SSK2": (1.618769, 1.622292, 1.630455),
    "schott:N-SK2": (1.604134, 1.607379, 1.614860),
    "schott:F5": (1.598744, 1.603417, 1.614617),
    "schott:N-SK16": (1.617271, 1.620408, 1.627559),
}
GLASSES = {1: "schott:N-SSK2", 3: "schott:N-SK2", 4: "schott:F5"}
GLASSES |= {7: "schott:F5", 8: "schott:N-SK16", 10: "schott:N-SK16"}

# Command FIO: HMY, UMY, N * IMY, HCY, UCY, N * ICY; heights at the surface, slopes behind it.
PARAXIAL_RAYS = [
    (25.000000, -0.170628, 0.444821, -14.439084, 0.252237, -0.007584),
    (23.507005, -0.180751, -0.026390, -12.232008, 0.359218, 0.278896),
    (23.416630, -0.347265, 0.440667, -12.052399, 0.344338, 0.039378),
    (19.075817, -0.348123, -0.558186, -7.748170, 0.345189, 0.553482),
    (17.752950, -0.116096, 0.616549, -6.436452, 0.393199, 0.127574),
    (15.852527, -0.116096, -0.116096, 0.000000, 0.393199, 0.393199),
    (14.256448, 0.116660, -0.618485, 5.405685, 0.316914, 0.202706),
    (14.699756, 0.115437, 0.187054, 6.609960, 0.313591, 0.508146),
    (15.969559, -0.074185, -0.495263, 10.059465, 0.343587, 0.078344),
    (15.932466, -0.080166, 0.015620, 10.231259, 0.189957, 0.401257),
    (15.371307, -0.249991, -0.443556, 11.560961, 0.217488, 0.071905),
]
# Command THO, at 14 degrees: SA, TCO, TAS, SAS, PTB, DST, AX, LAT (mm), PTZ (1/mm) by surface, and their sums.
THIRD_ORDER = [
    (-1.040587, 0.053227, -0.531277, -0.530672, -0.530370, 0.009048, -0.320428, 0.005463, -0.006825),
    (-0.002474, 0.078453, -0.633384, -0.080636, 0.195737, 0.852194, -0.017875, 0.188905, 0.002519),
    (-0.320986, -0.086051, -0.786925, -0.781799, -0.779236, -0.069862, -0.275440, -0.024614, -0.010028),
    (-0.012707, 0.037799, -0.037480, -0.012493, 0.000000, 0.012388, 0.137441, -0.136283, 0.000000),
    (1.363481, 0.846376, 1.382005, 1.265253, 1.206876, 0.261800, 0.433452, 0.089688, 0.015531),
    (0.000000, 0.000000, 0.000000, 0.000000, 0.000000, 0.000000, 0.000000, 0.000000, 0.000000),
    (2.059866, -2.025339, 1.694345, 1.251814, 1.030548, -0.410277, 0.349174, -0.114441, 0.013262),
    (-0.001561, -0.012725, -0.034567, -0.011522, 0.000000, -0.031301, 0.039049, 0.106081, 0.000000),
    (-1.139327, 0.540680, -0.870024, -0.813005, -0.784496, 0.128607, -0.200884, 0.031777, -0.010095),
    (0.000192, 0.014807, 0.212677, -0.040909, -0.167702, -1.050920, -0.006321, -0.162376, -0.002158),
    (-1.212851, 0.589843, -0.470280, -0.406534, -0.374661, 0.065903, -0.173172, 0.028073, -0.004821),
]
THIRD_ORDER_SUM = (-0.306954, 0.037071, -0.074910, -0.160505, -0.203302, -0.232420, -0.035003, 0.012274, -0.002616)


@dataclass(frozen=True)
class FieldAberrations:
    """Analysis "ssp" of one field: its figures of the chief ray and of rays across the pupil."""

    field_deg: float
    pupil_distance: float  # EP DIST: the real entrance pupil behind the first vertex
    height: float  # of the chief ray on the film
    foci: tuple[float, float]  # X-FOCUS and Y-FOCUS of the chief ray, from the film; on the axis FOCUS
    # For each ray: its point in the real entrance pupil (x, y), DELTA X, DELTA Y and OPD (waves). The listing has only
    # two decimals of the points on the stop; the points in the entrance pupil are equal steps of its radius of 25, less
    # the vignetting.
    rays: list[tuple[float, float, float, float, float]]


FIELD_ABERRATIONS = [
    FieldAberrations(
        0.0,
        57.9120,
        0.0,
        (0.400269, 0.400269),
        [
            (25, 0, 0.014138, 0.0, -3.137),
            (20, 0, -0.012851, 0.0, -3.775),
            (15, 0, 0.007971, 0.0, -4.052),
            (10, 0, 0.022285, 0.0, -2.636),
        ],
    ),
    FieldAberrations(
        10.0000000023,
        58.7753,
        17.485856,
        (0.107608, 0.235739),
        [
            (0, 20, 0.0, 0.031363, -3.972),
            (0, 16, 0.0, 0.011892, -2.746),
            (0, 12, 0.0, 0.012639, -1.969),
            (0, 8, 0.0, 0.013509, -1.076),
            (0, -7.5, 0.0, -0.011619, -0.899),
            (0, -11.25, 0.0, -0.008997, -1.569),
            (0, -15, 0.0, -0.003534, -1.949),
            (0, -18.75, 0.0, -0.010062, -2.241),
            (25, 0, 0.054750, 0.001022, 1.889),
            (20, 0, -0.021610, 0.000410, 2.286),
            (15, 0, -0.017175, 0.000054, 0.415),
            (10, 0, -0.001819, -0.000047, -0.351),
        ],
    ),
    FieldAberrations(
        14.0000000032,
        59.6575,
        24.588739,
        (-0.131303, 0.034567),
        [
            (0, 15, 0.0, -0.011679, 0.894),
            (0, 12, 0.0, -0.008925, 0.370),
            (0, 9, 0.0, -0.003905, 0.060),
            (0, 6, 0.0, -0.000406, -0.035),
            (0, -6, 0.0, -0.000522, -0.066),
            (0, -9, 0.0, 0.001803, -0.042),
            (0, -12, 0.0, 0.004843, 0.122),
            (0, -15, 0.0, 0.003625, 0.361),
            (25, 0, 0.111063, -0.015573, 3.840),
            (20, 0, -0.018776, -0.008981, 6.398),
            (15, 0, -0.034048, -0.004865, 3.787),
            (10, 0, -0.020576, -0.002149, 1.447),
        ],
    ),
]


def listed_lens() -> rc.Lens:
    """The bundled lens, with room for rays that the listing's vignetting leaves out."""
    bundled = rc.Lens.load("double-gauss-100mm")
    surfaces = [
        rc.Surface(
            radius_of_curvature_mm=s.radius_of_curvature_mm,
            thickness_mm=s.thickness_mm,
            material=s.material if s.material.label else None,
            clear_semi_diameter_mm=s.clear_semi_diameter_mm * (1.0 if s.type == "stop" else 1.06),
            type=s.type,
        )
        for s in bundled.surfaces
    ]
    return rc.Lens(surfaces=surfaces, film_distance_mm=bundled.film_distance_mm, wavelength_nm=bundled.wavelength_nm)
