"""Lens.psf: against another program's propagation, its own two other methods, and what is known of spikes and limits.

tests/cpp/optics/analysis/test_psf.cpp has the closed forms.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
import realcam as rc

from ...measurement import hold_core

FAR = math.inf


def perfect(f_number: float, f_mm: float = 100.0) -> rc.Lens:
    """A hyperbola of conic -n^2 behind a plane images infinity without aberration on its axis."""
    radius, n = f_mm / (2 * f_number), 1.5
    return rc.Lens(
        surfaces=[
            rc.Stop(clear_semi_diameter_mm=radius),
            rc.Surface(thickness_mm=2 + radius**2 / f_mm, material=n, clear_semi_diameter_mm=1.01 * radius),
            rc.Surface(radius_of_curvature_mm=-f_mm * (n - 1), conic=-n * n, clear_semi_diameter_mm=1.01 * radius),
        ],
        film_distance_mm=f_mm,
    )


# Propagation by another program. The wavefront is handed over on a grid of the exit pupil: rays are aimed at points on
# the stop; their optical path differences and their points on the reference sphere are fitted by polynomials, whose
# residuals are negligible, and these are evaluated on the grid.


def polynomials(places: np.ndarray, order: int = 22) -> np.ndarray:
    powers = [(i, k) for i in range(order + 1) for k in range(order + 1 - i)]
    x, y = (np.polynomial.chebyshev.chebvander(places[:, axis], order) for axis in (0, 1))
    return x[:, [i for i, _ in powers]] * y[:, [k for _, k in powers]]


def stop_rays(lens: rc.Lens, field: float) -> tuple[np.ndarray, np.ndarray]:
    """For the same rays: direction cosines (N, 2) on the reference sphere; and the position in the bundle before the
    lens (whose area is the light's energy), the optical path difference and the point on the stop, (N, 5)."""
    k = np.arange(2000)
    radius, angle = np.sqrt((k + 0.5) / k.size), k * math.pi * (3 - math.sqrt(5))
    pupil = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    aimed = lens.aim(pupil, field, object_distance_m=FAR)
    wavefront = lens.wavefront(field, object_distance_m=FAR, pupil=pupil)
    rays = lens.trace(aimed.origins_mm, aimed.directions, start="scene")
    assert (np.asarray(rays.status) == rc.RayStatus.OK).all()  # the polynomials know of no rims
    sphere_mm = wavefront.reference_radius_mm
    from_centre = np.asarray(rays.origins_mm) - np.array(wavefront.centre_mm)
    along = (from_centre * rays.directions).sum(axis=1)
    root = np.sqrt(sphere_mm**2 - (from_centre**2).sum(axis=1) + along**2)
    on_sphere = from_centre - (along + math.copysign(1, sphere_mm) * root)[:, None] * rays.directions
    across = np.cross(aimed.directions[0], [1.0, 0.0, 0.0])
    before = np.stack([aimed.origins_mm[:, 0], aimed.origins_mm @ across], axis=1)
    return -on_sphere[:, :2] / sphere_mm, np.column_stack([before, wavefront.opd_waves, pupil])


def psf_of_prysm(lens: rc.Lens, field: float, psf: rc.PSF, cells: int = 256) -> np.ndarray:
    propagation = pytest.importorskip("prysm.propagation", reason="prysm comes with the dev extra")
    cosines, expected = stop_rays(lens, field)
    middle = (cosines.max(axis=0) + cosines.min(axis=0)) / 2
    half = 1.03 * np.ptp(cosines, axis=0).max() / 2
    basis = polynomials((cosines - middle) / half)
    fit = np.linalg.lstsq(basis, expected, rcond=None)[0]
    assert np.abs(basis @ fit - expected).max() < 1e-5
    step = 2 / cells
    axis = (np.arange(cells) - cells // 2) * step
    x, y = np.meshgrid(axis, axis)
    grid = np.stack([x.ravel(), y.ravel()], axis=1)
    values = np.concatenate([polynomials(part) @ fit for part in np.array_split(grid, 32)])
    before_x, before_y, opd, stop_x, stop_y = values.T.reshape(5, cells, cells)
    (x_by_y, x_by_x), (y_by_y, y_by_x) = (np.gradient(v, step * half) for v in (before_x, before_y))
    density = np.abs(x_by_x * y_by_y - x_by_y * y_by_x)
    radius = np.hypot(stop_x, stop_y)
    share = np.clip((1 - radius) / np.hypot(*np.gradient(radius)) + 0.5, 0, 1)  # of the cell inside the stop
    share[np.hypot(x, y) > 1.02] = 0  # in the corners the polynomials mean nothing
    inside = share > 0
    # prysm's transforms have exp(-2 pi i ...) where ours have exp(+ ...): the conjugate of the field.
    amplitude = np.where(inside, share * np.sqrt(density), 0)
    pupil = amplitude * np.exp(2j * np.pi * np.where(inside, opd, 0))
    f_mm = 100.0
    wave = propagation.Wavefront(pupil, psf.wavelength_nm / 1000, f_mm * step * half, "pupil")
    values = np.abs(wave.focus_fixed_sampling(f_mm, psf.pitch_um, psf.values.shape[0]).data) ** 2
    return values * (values * psf.values).sum() / (values**2).sum()  # in units of its own


@pytest.mark.parametrize(
    ("name", "f_number"), [("double-gauss-50mm", 5.6), ("tessar-50mm", 8.0), ("cooke-triplet-50mm", 8.0)]
)
def test_real_lenses_agree_with_prysm(name: str, f_number: float) -> None:
    lens, worst = rc.Lens.load(name).stopped_down(f_number), 0.0
    for field in (0.0, 14.0):
        psf = lens.psf(field, object_distance_m=FAR)
        error = np.abs(psf_of_prysm(lens, field, psf) - psf.values).max() / psf.values.max()
        worst = max(worst, float(error))
    what = f"PSF of {name} at f/{f_number:g} against prysm's propagation"
    hold_core("Truth", what, "0 and 14 degrees", worst, 1e-3, "of the peak")


@pytest.mark.slow
def test_both_sums_agree() -> None:
    cases: list[tuple[str, float, float | None, float | None]] = [
        # Two rims let 0.6 of it pass. Its spot is wide: in infrared light a quarter of the rays follow its waves.
        ("tessar-50mm", 18, None, 1500),
        ("double-gauss-50mm", 15, 8, None),
        ("mirror-telephoto-500mm", 1.5, None, None),  # obstructed
        ("phone-4mm", 20, None, None),  # aspheres, open up to their rims
        ("fisheye-6mm-220deg", 80, None, None),
        ("wide-22mm", 30, 5.6, None),
    ]
    worst = 0.0
    for name, field, f_number, nm in cases:
        lens = rc.Lens.load(name)
        lens = lens if f_number is None else lens.stopped_down(f_number)
        direct = lens.psf(field, nm, object_distance_m=FAR, size=64)
        fft = lens.psf(field, nm, object_distance_m=FAR, method="fft", pitch_um=direct.pitch_um, size=64)
        worst = max(worst, float(np.abs(direct.values - fft.values).max() / direct.values.max()))
        assert fft.energy == pytest.approx(direct.energy, abs=1e-3)
        assert fft.centre_mm == direct.centre_mm
    hold_core("Truth", "PSF by direct sum against FFT", f"{len(cases)} lenses and fields", worst, 1e-3, "of the peak")


@pytest.mark.parametrize("blades", [5, 6])
def test_blades_make_spikes(blades: int) -> None:
    """Each straight edge diffracts light to both sides, and opposite edges into the same two spikes."""
    lens = perfect(4).with_iris(blades, rotation_deg=10).stopped_down(8)
    psf = lens.psf(object_distance_m=FAR, size=128, pitch_um=8 * 0.5876)
    x, y = np.meshgrid(psf.x_um, psf.y_um)
    radius, angle = np.hypot(x, y) / (8 * 0.5876), np.arctan2(y, x)
    ring = (radius > 15) & (radius < 60)
    weights = (psf.values * radius**2)[ring]
    harmonics = [abs((weights * np.exp(1j * m * angle[ring])).sum()) / weights.sum() for m in range(1, 31)]
    spikes = blades if blades % 2 == 0 else 2 * blades
    assert 1 + int(np.argmax(harmonics)) == spikes
    # A spike lies across an edge: the first blade's middle is at the angle of rotation.
    phase = np.angle((weights * np.exp(1j * spikes * angle[ring])).sum())
    assert abs(np.angle(np.exp(1j * (phase - spikes * math.radians(10))))) < 0.1


def test_short_waves_go_where_rays_go() -> None:
    lens = rc.Lens.load("wide-22mm")  # of a constant index at all wavelengths
    there = lens.film_distance_mm + 0.1
    rays = lens.psf(10, method="geometric", object_distance_m=FAR, film_distance_mm=there, pitch_um=0.25)
    radii = np.arange(1, 14, 0.5)
    worst = []
    for wavelength in (1000.0, 100.0):
        psf = lens.psf(10, wavelength, object_distance_m=FAR, film_distance_mm=there, pitch_um=0.25)
        errors = [abs(psf.energy_inside(r) - rays.energy_inside(r)) for r in radii]
        worst.append(max(errors))
    what = "encircled energy of waves of 100 nm against rays"
    hold_core("Truth", what, "wide-22mm, out of focus", worst[1], 0.03, "of the light")
    assert worst[1] < 0.5 * worst[0]


def test_light_is_conserved_and_described() -> None:
    lens = rc.Lens.load("double-gauss-50mm").stopped_down(5.6)
    psf = lens.psf(10, 500, object_distance_m=FAR, size=65, pitch_um=0.7)
    assert psf.values.shape == (65, 65)
    assert psf.energy == pytest.approx(psf.values.sum() * 0.7**2)
    assert psf.energy_inside(1000) == pytest.approx(psf.energy)
    assert psf.x_um[32] == psf.y_um[32] == 0
    assert psf.x_um[33] == pytest.approx(0.7)
    assert psf.wavelength_nm == 500
    np.testing.assert_allclose(psf.values, psf.values[:, ::-1], rtol=1e-9, atol=1e-15)
    chief = lens.spot(10, object_distance_m=FAR, wavelength_nm=500).chief_ray_mm
    assert psf.centre_mm == pytest.approx(chief, abs=1e-9)
    frequencies, tangential, sagittal = psf.mtf([0, 50, 100])
    assert list(frequencies) == [0, 50, 100]
    assert tangential[0] == sagittal[0] == 1
    assert 1 > tangential[1] > tangential[2] > 0
    # Blur along y lowers the contrast of lines across y: for a pinhole far off the axis, by its elliptical aperture.
    pinhole = rc.Lens(
        surfaces=[rc.Stop(clear_semi_diameter_mm=0.05), rc.Surface(clear_semi_diameter_mm=9)], film_distance_mm=500.0
    )
    _, tangential, sagittal = pinhole.psf(50, object_distance_m=FAR).mtf([0.06])
    assert sagittal[0] > 2 * tangential[0] > 0
    centred = lens.psf(10, 500, object_distance_m=FAR, centre="centroid")
    spot = lens.spot(10, object_distance_m=FAR, wavelength_nm=500, samples=40)
    assert centred.centre_mm == pytest.approx(spot.centroid_mm, abs=1e-3)


def test_rays_alone_are_the_spot() -> None:
    lens = rc.Lens.load("double-gauss-50mm").stopped_down(4)
    for changed in (lens, lens.with_iris(6, rotation_deg=10)):  # of which the second is not its own mirror image
        psf = changed.psf(10, method="geometric", object_distance_m=FAR, size=256, pitch_um=0.5, centre="centroid")
        assert psf.energy == pytest.approx(1, abs=1e-9)
        assert math.isnan(psf.strehl)
        spot = changed.spot(10, object_distance_m=FAR, pattern="grid", samples=300)
        points = 1000 * (spot.points_mm[~np.isnan(spot.points_mm[:, 0])] - psf.centre_mm)
        light = psf.values / psf.values.sum()
        for axis, places in ((0, psf.x_um[None, :]), (1, psf.y_um[:, None])):
            mean = float((light * places).sum())
            assert mean == pytest.approx(points[:, axis].mean(), abs=0.02)
            width = math.sqrt(float((light * (places - mean) ** 2).sum()))
            assert width == pytest.approx(points[:, axis].std(), rel=0.01)


def test_a_wavefront_and_its_psf_have_one_strehl_ratio() -> None:
    """For a small aberration on the axis, where the PSF peaks at its centre and the stop is uniformly illuminated."""
    lens = rc.Lens.load("cooke-triplet-50mm").stopped_down(8)
    wavefront = lens.wavefront(object_distance_m=FAR, pattern="rings", samples=20)
    assert lens.psf(object_distance_m=FAR).strehl == pytest.approx(wavefront.strehl, abs=2e-3)


def test_hard_lenses_have_psfs() -> None:
    for lens, field in (
        (perfect(64), 0.0),
        (rc.Lens.load("fisheye-6mm-220deg"), 105.0),
        (rc.Lens.load("mirror-telephoto-500mm"), 2.0),
        (rc.Lens.load("double-gauss-50mm").with_iris(7).stopped_down(16), 20.0),
    ):
        psf = lens.psf(field, object_distance_m=FAR)
        assert 0.7 < psf.energy <= 1, lens.name
        assert 0 < psf.strehl < 1 + 1e-9, lens.name
    assert perfect(64).psf(object_distance_m=FAR).strehl == pytest.approx(1, abs=1e-9)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"method": "huygens"}, "expected direct, fft or geometric"),
        ({"centre": "peak"}, "expected chief or centroid"),
        ({"size": 1}, "size must lie between 2 and 4096"),
        ({"pitch_um": 0}, "pitch_um must be a positive length"),
        ({"rays": -5}, "rays must be a positive number"),
        ({"rays": 10**12}, "at most 16777216"),
        ({"rays": 10**12, "method": "geometric"}, "at most 16777216"),
        ({"rays": 50}, "50 rays cannot follow the wavefront over the array: at least"),
        ({"wavelength_nm": []}, "psf: expected at least one wavelength"),
        ({"wavelength_nm": [500, 600], "weights": [1]}, "1 weights for 2 wavelengths"),
        ({"wavelength_nm": [500, 600], "weights": [1, 0]}, "weights must be positive"),
        ({"wavelength_nm": 50}, "between 100 and 20000 nm"),
        ({"wavelength_nm": 110}, r"\(N-BK7\) of achromat-75mm lets no light pass below its resonance"),
        ({"field_deg": 88}, "88 deg"),
        ({"film_distance_mm": math.nan}, "film_distance_mm must be a finite length"),
        ({"film_distance_mm": 1e7}, "too many for a sum of rays"),
        ({"film_distance_mm": 60, "method": "fft"}, 'too steep for the method "fft"'),
    ],
)
def test_what_cannot_be_is_said(arguments: dict[str, object], message: str) -> None:
    lens = rc.Lens.load("achromat-75mm" if arguments.get("wavelength_nm") == 110 else "double-gauss-50mm")
    with pytest.raises(rc.InputError, match=message):
        lens.psf(**{"object_distance_m": FAR, **arguments})
