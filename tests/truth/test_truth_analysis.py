"""rc.analysis against CODE V's listing (case A), Optiland 0.6.3, and closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
import realcam as rc

from ..measurement import Measurement, hold

analysis = rc.analysis
CODE_V = rc.Lens.load("double-gauss-100mm")
GAUSS_F8 = rc.Lens.load("double-gauss-50mm").stopped_down(8)


def figure(what: str, tried: str, worst: float, limit: float, unit: str) -> None:
    hold(Measurement("Truth", what, tried, "core", "float64", float(worst), limit, unit))


def perfect_lens(f_number: float) -> rc.Lens:
    """A plane and a hyperboloid of conic -n^2: light along the axis comes to one point."""
    n, focal = 1.5, 100.0
    surfaces = [
        rc.Stop(clear_semi_diameter_mm=30.0),
        rc.Surface(thickness_mm=20.0, material=n, clear_semi_diameter_mm=30.0),
        rc.Surface(radius_of_curvature_mm=-(n - 1) * focal, conic=-(n**2), clear_semi_diameter_mm=30.0),
    ]
    return rc.Lens(surfaces=surfaces, film_distance_mm=focal).stopped_down(f_number)


def test_distortion_of_code_v() -> None:
    """The listing's film lies in front of the paraxial focus, and its figure is the difference of the heights in that
    focus over the paraxial height less the defocus times the real chief ray's slope."""
    printed = {10.0: -0.4976, 14.0000000032: -1.0557}
    focus = CODE_V.first_order().back_focal_distance_mm
    here = analysis.distortion(CODE_V, list(printed))
    there = analysis.distortion(CODE_V, list(printed), film_distance_mm=focus)
    height = there.paraxial_mm - (there.real_mm - here.real_mm)
    found = 100 * (there.real_mm - there.paraxial_mm) / height
    figure(
        "distortion of a double Gauss as CODE V prints it",
        "2 fields",
        np.abs(found - list(printed.values())).max(),
        1e-4,
        "% of the image height",
    )


# Optiland 0.6.3, with its iterative aiming at the real stop, at the design wavelength.
OPTILAND_CHIEF_MM = {10.0: 8.86420680314315, 15.0: 13.427193196661277}
OPTILAND_DISTORTION = {10.0: -0.22144483, 15.0: -0.5399009}
OPTILAND_SEIDEL = [1.73898404e-04, -4.85038353e-05, -5.40736871e-04, 2.25416112e-03, 8.24719225e-03]


def test_distortion_and_seidel_sums_of_optiland() -> None:
    fields = list(OPTILAND_CHIEF_MM)
    found = analysis.distortion(GAUSS_F8, fields)
    figure(
        "distortion as Optiland has it",
        "2 fields",
        np.abs(found.percent - list(OPTILAND_DISTORTION.values())).max(),
        1e-6,  # two units of the digits noted; the aim is 1e-4
        "% of the image height",
    )
    np.testing.assert_allclose(found.real_mm, list(OPTILAND_CHIEF_MM.values()), rtol=0, atol=1e-9)
    sums = analysis.seidel_bars(GAUSS_F8, 15.0).sums_mm.sum(axis=0)[:5]
    figure(
        "Seidel sums as Optiland has them, with the other sign",
        "5 sums",
        np.abs(sums / OPTILAND_SEIDEL - 1).max(),
        1e-6,
        "of each",
    )


FREQUENCIES = [10, 20, 40, 80]
# FFTMTF, 256 rays across the pupil, 1024 points: it takes the pupil's map to direction cosines for affine, which at 15
# degrees is off by 0.026 of contrast for sagittal lines; so these figures are the axis's and the tangential ones.
OPTILAND_FFT_MTF = {
    0.0: [0.9378088, 0.87249043, 0.74129715, 0.50158283],
    10.0: [0.93389839, 0.86181601, 0.71372135, 0.45585949],
    15.0: [0.92876581, 0.84795364, 0.6795229, 0.40612157],
}
# GeometricMTF, 200 rays across, without its scaling: tangential, sagittal.
OPTILAND_GEOMETRIC_MTF = {
    0.0: ([0.9967936, 0.98722428, 0.94967838, 0.81070053], [0.9967936, 0.98722428, 0.94967838, 0.81070053]),
    10.0: ([0.99502638, 0.9801968, 0.92221902, 0.71081147], [0.97873064, 0.91679099, 0.69537272, 0.14230914]),
    15.0: ([0.99266716, 0.97089167, 0.88708117, 0.60285425], [0.9657174, 0.86757335, 0.5391931, 0.0639706]),
}


def test_mtf_of_optiland() -> None:
    waves = analysis.mtf(GAUSS_F8, list(OPTILAND_FFT_MTF), FREQUENCIES, wavelengths_nm=GAUSS_F8.wavelength_nm)
    worst = np.abs(waves.tangential[0] - list(OPTILAND_FFT_MTF.values())).max()
    figure("MTF as Optiland's transform has it", "3 fields, 4 frequencies, f/8", worst, 0.005, "of contrast")
    rays = analysis.mtf(
        GAUSS_F8, list(OPTILAND_GEOMETRIC_MTF), FREQUENCIES, wavelengths_nm=GAUSS_F8.wavelength_nm, method="geometric"
    )
    for k, (tangential, sagittal) in enumerate(OPTILAND_GEOMETRIC_MTF.values()):
        np.testing.assert_allclose(rays.tangential[0, k], tangential, atol=0.005)
        np.testing.assert_allclose(rays.sagittal[0, k], sagittal, atol=0.005)


# ZernikeOPD, Noll's order, coefficients 4 to 12: those that are not zero by symmetry.
OPTILAND_NOLL = {
    0.0: {1: 5.60211415e-02, 4: 3.56995439e-02, 11: 2.55645970e-03},
    10.0: {
        3: 3.87909827e-03,
        4: 7.39835497e-02,
        6: 3.60271270e-02,
        7: 1.43104267e-03,
        9: -6.90938547e-05,
        11: -2.89171709e-04,
        12: 1.13710766e-03,
    },
    15.0: {
        3: 2.93038710e-02,
        4: 9.27141359e-02,
        6: 4.96335052e-02,
        7: 1.04611479e-02,
        9: 6.79415659e-05,
        11: -3.44664495e-03,
        12: 1.91749628e-03,
    },
}


def test_zernike_coefficients_of_optiland() -> None:
    worst = 0.0
    for field, expected in OPTILAND_NOLL.items():
        fit = analysis.zernike_fit(GAUSS_F8, field, terms=22)
        worst = max(worst, *(abs(fit.coefficients_waves[j - 1] - value) for j, value in expected.items()))
    figure("Zernike coefficients as Optiland has them", "3 fields, Noll's order", worst, 1e-4, "waves")


def test_optiland_says_the_same_today() -> None:
    """The figures above are its own, where it is installed."""
    pytest.importorskip("optiland")
    from optiland.materials import IdealMaterial
    from optiland.optic import Optic
    from optiland.physical_apertures import RadialAperture

    lens, nm = GAUSS_F8, GAUSS_F8.wavelength_nm
    optic = Optic()
    optic.surfaces.add(index=0, radius=np.inf, thickness=np.inf)
    for i, surface in enumerate(lens.surfaces):
        before = lens.surfaces[i - 1].material.index(nm) if i else 1.0
        optic.surfaces.add(
            index=i + 1,
            radius=surface.radius_of_curvature_mm,
            thickness=surface.thickness_mm if i + 1 < len(lens.surfaces) else lens.film_distance_mm,
            material=IdealMaterial(surface.material.index(nm) if surface.type == "refracting" else before),
            is_stop=i == lens.stop_index,
            aperture=RadialAperture(r_max=surface.clear_semi_diameter_mm),
        )
    optic.surfaces.add(index=len(lens.surfaces) + 1)
    optic.set_aperture("float_by_stop_size", 2 * lens.stop_semi_diameter_mm)
    optic.fields.set_type("angle")
    for field in (0, 15):
        optic.fields.add(y=field)
    optic.wavelengths.add(value=1e-3 * nm, is_primary=True)
    optic.ray_tracer.set_aiming("iterative", max_iter=50, tol=1e-12)
    chief = optic.trace_generic(0, 1, 0, 0, 1e-3 * nm)
    assert float(np.asarray(chief.y)[0]) == pytest.approx(OPTILAND_CHIEF_MM[15.0], abs=1e-9)
    np.testing.assert_allclose(-np.asarray(optic.aberrations.seidels()), OPTILAND_SEIDEL, rtol=1e-6)


@pytest.mark.parametrize("f_number", [5.6, 11.0])
def test_a_perfect_lens_has_the_mtf_and_the_airy_disc_of_its_pupil(f_number: float) -> None:
    lens = perfect_lens(f_number)
    nm = lens.wavelength_nm
    # A hyperboloid keeps heights, not sines: the numerical aperture is that of its real edge ray.
    aperture = np.abs(lens.bundle().edge_slopes).max()
    spots = analysis.spot_diagram(lens, 0.0)
    assert spots.airy_radii_mm[0] == pytest.approx(0.6098e-6 * nm / aperture, rel=0.002)  # 0.61 rounds 0.6098
    assert spots.rms_radius_mm[0, 0] < 1e-9
    cutoff = 2e6 / nm * aperture
    share = np.linspace(0, 1.05, 22)
    expected = 2 / np.pi * (np.arccos(np.minimum(share, 1)) - share * np.sqrt(np.maximum(1 - share**2, 0)))
    data = analysis.mtf(lens, 0.0, share * cutoff, wavelengths_nm=nm)
    worst = max(np.abs(data.tangential[0, 0] - expected).max(), np.abs(data.limit_sagittal[0] - expected).max())
    figure(f"MTF of a perfect lens at f/{f_number:g} and its limit", "22 frequencies", worst, 0.005, "of contrast")


@pytest.mark.slow
def test_mtf_is_the_transform_of_the_point_spread_function() -> None:
    """Holds with vignetting, obstruction and defocus too; all but 0.3% of the light falls on the PSF array."""
    cases = [
        (rc.Lens.load("double-gauss-50mm").stopped_down(4), 15.0, 0.0),
        (rc.Lens.load("double-gauss-50mm").stopped_down(4), 22.0, 0.05),
        (rc.Lens.load("mirror-telephoto-500mm"), 1.5, -0.1),
        (rc.Lens.load("phone-4mm"), 20.0, 0.0),
        (rc.Lens.load("double-gauss-50mm").with_iris(5).stopped_down(4), 5.0, 0.0),
    ]
    worst = 0.0
    for lens, field, defocus in cases:
        frequencies = analysis.default_frequencies_per_mm(lens)
        found = analysis.mtf(lens, field, frequencies, wavelengths_nm=lens.wavelength_nm, defocus_mm=defocus)
        psf = lens.psf(field, size=512, film_distance_mm=lens.film_distance_mm + defocus, method="fft")
        _, tangential, sagittal = psf.mtf(frequencies)
        worst = max(
            worst, np.abs(found.tangential[0, 0] - tangential).max(), np.abs(found.sagittal[0, 0] - sagittal).max()
        )
    figure("MTF from the pupil against the transform of the PSF", "5 lenses", worst, 0.005, "of contrast")


@pytest.mark.parametrize("name", ["double-gauss-100mm", "tessar-50mm", "cooke-triplet-50mm", "phone-4mm"])
def test_field_curves_begin_as_third_order_says(name: str) -> None:
    lens, field = rc.Lens.load(name), 0.5
    curves = analysis.field_curves(lens, [0.0, field])
    sums = lens.seidel(field)
    slope = sums.marginal_slope[-1]
    for found, blur in (
        (curves.tangential_mm, sums.tangential_astigmatism_mm),
        (curves.sagittal_mm, sums.sagittal_astigmatism_mm),
    ):
        # Fifth order is smaller by the square of the field, 1e-4, times the factor by which the aberrations cancel.
        assert found[0, 1] - found[0, 0] == pytest.approx(-blur.sum() / slope, rel=0.01)
    astigmatism = (curves.tangential_mm - curves.sagittal_mm)[0, 1]
    petzval = curves.petzval_mm[1] - curves.petzval_mm[0]
    # Petzval's surface, the sagittal and the tangential one lie as 0, 1 and 3.
    assert (curves.sagittal_mm[0, 1] - curves.sagittal_mm[0, 0]) - petzval == pytest.approx(
        astigmatism / 2, rel=0.02, abs=1e-8
    )


def test_relative_illumination_is_what_pictures_are_exposed_by() -> None:
    lens = rc.Lens.load("double-gauss-50mm")
    found = analysis.film_pupils(lens, [0.0, 12.0, 20.0])
    film = rc.Film.for_lens(lens, resolution=(72, 48))
    camera = rc.Camera(lens, film=film, position=(0, 0, 0), look_at=(0, 0, -1))
    weights = camera.generate_rays(spp=256).weights.reshape(48, 72, 256).mean(axis=2)
    y, x = np.meshgrid((np.arange(48) - 23.5) * 0.5, (np.arange(72) - 35.5) * 0.5, indexing="ij")
    radius = np.hypot(x, y)
    for height, area in zip(found.film_mm, found.solid_angle_sr, strict=True):
        ring = np.abs(radius - abs(height)) < 0.8
        # The ring is 1.6 mm wide, over which illumination changes by less than a twentieth, evenly.
        assert weights[ring].mean() == pytest.approx(area, rel=0.02)
    sine = np.abs(lens.bundle(0.0, arms=256, nodes=24).directions[:, :2]).max()
    assert found.solid_angle_sr[0] == pytest.approx(math.pi * sine**2, rel=0.01)
