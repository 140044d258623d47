"""rc.analysis against ray-optics 0.9.8: Seidel sums by surface, ray fans, spots and wavefronts of 41 bundled lenses.

Its figures are in ray_optics_analysis.json.gz; where it is installed, it is asked again.
"""

from __future__ import annotations

import numpy as np
import pytest
import realcam as rc

from ..centred_lenses import CENTRED
from ..measurement import Measurement, hold
from . import backends, peers
from . import ray_optics_analysis as peer

OPINIONS = peer.read()
OBJECT_M = 1e-3 * peer.OBJECT_MM


def hold_worst(what: str, worst: float, limit: float, unit: str) -> None:
    tried = f"{len(OPINIONS)} bundled lenses"
    hold(Measurement("Other programs", f"{what}, as ray-optics has them", tried, "core", "float64", worst, limit, unit))


def test_the_file_holds_what_it_should() -> None:
    # A bundled lens that is new or changes wants tools/make_ray_optics_analysis.py again.
    assert set(OPINIONS) == set(CENTRED) - peer.ABSENT


def test_seidel_sums_surface_by_surface() -> None:
    worst = 0.0
    for name, (field, said) in OPINIONS.items():
        found = rc.analysis.seidel_bars(rc.Lens.load(name), field, object_distance_m=OBJECT_M).sums_mm[:, :5]
        scale = np.abs(said.seidel).max(axis=0)  # largest surface contribution to each sum: single ones may vanish
        worst = max(worst, float((np.abs(found - said.seidel) / scale).max()))
    # The aim is 1e-6. Both programs compute the same few products; at a fisheye's last surfaces three digits are lost.
    hold_worst("Seidel sums by surface", worst, 1e-11, "of the largest surface's")


def test_ray_fans() -> None:
    worst, compared = 0.0, 0
    for name, (field, said) in OPINIONS.items():
        lens = rc.Lens.load(name)
        fan = rc.analysis.ray_fan(lens, field, lens.wavelength_nm, samples=5, object_distance_m=OBJECT_M)
        beside = said.points[:4] - said.chief_point
        found = np.concatenate([fan.tangential_mm[0, 0, [1, 3]], fan.sagittal_mm[0, 0, [1, 3]]])
        off = np.abs(found - [*beside[:2, 1], *beside[2:, 0]])
        worst, compared = max(worst, float(np.nanmax(off))), compared + int(np.isfinite(off).sum())
    assert compared > 3.8 * len(OPINIONS), "all but what rims and a mirror's hole block"
    # Rays are aimed at the stop within 1e-10 of its radius here and 1e-11 mm there: 4e-9 mm for a stop of 40 mm, of
    # which strong aberrations carry a tenth to the film.
    hold_worst("transverse ray aberrations", worst, 1e-9, "mm")


def test_spots() -> None:
    worst, compared = 0.0, 0
    for name, (field, said) in OPINIONS.items():
        spot = rc.Lens.load(name).spot(field, object_distance_m=OBJECT_M, pupil=peer.STOP_POINTS)
        passed = spot.status == rc.RayStatus.OK
        if np.isnan(said.points[passed]).any():
            continue
        points = said.points[passed]
        radius = np.sqrt(((points - points.mean(axis=0)) ** 2).sum(axis=1).mean())
        worst = max(worst, abs(spot.rms_radius_mm - float(radius)))
        compared += 1
        assert spot.chief_ray_mm == pytest.approx(said.chief_point, abs=1e-9)
    assert compared > 0.9 * len(OPINIONS)
    hold_worst("RMS radii of spots", worst, 1e-9, "mm")


def test_wavefronts() -> None:
    worst = 0.0
    for name, (field, said) in OPINIONS.items():
        lens = rc.Lens.load(name)
        front = lens.wavefront(field, object_distance_m=OBJECT_M, pupil=peer.STOP_POINTS)
        off = np.abs(front.opd_waves - said.opd / (1e-6 * lens.wavelength_nm))
        worst = max(worst, float(np.nanmax(off)))
    # Paths of 3 to 5 m from the object, with 53 bits: 1e-12 mm a piece, 2e-9 waves, over twenty surfaces.
    hold_worst("optical path differences", worst, 1e-7, "waves")


@pytest.mark.skipif(peers.version("ray-optics") is None, reason="ray-optics is not installed")
@pytest.mark.parametrize("name", ["double-gauss-50mm", "phone-4mm", "mirror-telephoto-500mm"])
def test_ray_optics_says_the_same_today(name: str) -> None:
    field, said = OPINIONS[name]
    again = peer.analysed(backends.of_bundled_lens(name), rc.Lens.load(name).film_distance_mm, field)
    for key, value in vars(said).items():
        np.testing.assert_allclose(getattr(again, key), value, rtol=1e-9, atol=1e-9, err_msg=key)
