"""Copies of lenses with errors. Truth: lensmaker's equation, prisms, third-order theory, and the same numbers twice."""

import dataclasses
import json

import numpy as np
import pytest
import realcam as rc
from realcam import Lens, Stop, Surface, Tolerances, analysis, tolerance_study

N = 1.5
PLATE = [
    Surface(thickness_mm=4, material=(N, 60.0), clear_semi_diameter_mm=10),
    Surface(thickness_mm=2, clear_semi_diameter_mm=10),
]


def singlet(radius=100.0, thickness=0.01, semi_diameter=2.5, **options):
    """A thin equiconvex lens right behind its stop."""
    surfaces = [
        Stop(clear_semi_diameter_mm=semi_diameter),
        Surface(
            radius_of_curvature_mm=radius,
            thickness_mm=thickness,
            material=(N, 60.0),
            clear_semi_diameter_mm=4 * semi_diameter,
        ),
        Surface(radius_of_curvature_mm=-radius, clear_semi_diameter_mm=4 * semi_diameter),
    ]
    return Lens(
        surfaces=surfaces,
        film_distance_mm=radius / (2 * (N - 1)),
        allow_overlap=True,
        wavelength_nm=587.5618,
        **options,
    )


def study_of(lens, copies=5, **options):
    limits = {name: options.pop(name) for name in list(options) if name in Tolerances.__dataclass_fields__}
    options = {"fields_deg": [0.0], "wavelengths_nm": [587.5618], "compensators": (), **options}
    return tolerance_study(lens, Tolerances(**limits), copies, **options)


def focal_length(r1, r2, n, d):
    return 1 / ((n - 1) * (1 / r1 - 1 / r2 + (n - 1) * d / (n * r1 * r2)))


def test_the_focal_length_is_the_lensmakers():
    lens = singlet(60, 5)
    study = study_of(lens, radius_mm={1: 0.5}, thickness_mm={1: 0.2}, index={1: 0.001})
    for sizes, found in zip(study.sizes, study.figures.focal_length_mm, strict=True):
        radius, thickness, index = sizes
        # Rays at a thousandth of the pupil: their aberration is 1e-6 of what f/24 has, 1e-3 of f.
        assert found == pytest.approx(focal_length(60 + radius, -60, N + index, 5 + thickness), rel=1e-8)


def test_a_wedge_deviates_as_a_prism_does():
    lens = singlet().inserted(0, PLATE)
    study = study_of(lens, copies=8, wedge_arcmin={1: 30.0})
    f = lens.first_order().effective_focal_length_mm
    wedge = np.deg2rad(study.sizes)  # about x and y
    for (about_x, about_y), at in zip(wedge, study.figures.chief_ray_mm[:, 0], strict=True):
        angle = np.hypot(about_x, about_y)
        deviation = np.arcsin(N * np.sin(angle)) - angle
        assert deviation == pytest.approx((N - 1) * angle, rel=1e-3)
        # A lens that is thin to 1e-4 of its focal length.
        assert np.hypot(*at) == pytest.approx(f * np.tan(deviation), rel=1e-3)
        # The rear face turned about x looks up with its glass, which is thickest below.
        turn = np.array([about_y, -about_x]) / angle
        assert abs(turn @ at) == pytest.approx(np.hypot(*at), rel=1e-6)


def test_the_picture_moves_with_a_lens_that_is_decentred():
    study = study_of(singlet(), element_decentre_mm={(1, 2): 0.5})
    assert np.abs(study.figures.chief_ray_mm[:, 0] - study.sizes).max() < 2e-3  # its aberration at f/20


def thin_lens_w040(height, f, n, bending, conjugate=-1.0):
    """Wavefront spherical aberration of a thin lens, mm (W. T. Welford, "Aberrations of Optical Systems", 1986)."""
    shape = bending + 2 * (n * n - 1) / (n + 2) * conjugate
    terms = (n / (n - 1)) ** 2 + (n + 2) / (n * (n - 1) ** 2) * shape**2 - n / (n + 2) * conjugate**2
    return height**4 / f**3 / 32 * terms


def test_the_coma_of_a_decentred_singlet_is_that_of_the_third_order():
    lens = singlet()
    study = study_of(lens, copies=6, element_decentre_mm={(1, 2): 0.4})
    a, f = 2.5, lens.first_order().effective_focal_length_mm
    w040 = thin_lens_w040(a, f, N, 0.0)
    for number in range(len(study)):
        decentre = study.sizes[number]
        along = decentre / np.hypot(*decentre)
        copy = study.copy(number)
        starts = np.array([[*(0.9 * k * a * along), -1.0] for k in (-1, 0, 1)])
        rays = copy.trace(starts, np.tile([0.0, 0.0, 1.0], (3, 1)), start="scene")
        to_film = (copy.film_position_mm - rays.origins_mm[:, 2]) / rays.directions[:, 2]
        on_film = (rays.origins_mm + to_film[:, None] * rays.directions)[:, :2] @ along
        coma = 0.5 * (on_film[0] + on_film[2]) - on_film[1]
        # W = W040 (rho - delta / a)^4: its odd part is -4 W040 delta / a rho^3, and a ray is off by -f / a dW/drho.
        # The fifth order is (a / f)^2 of the third, the lens thin to 1e-4.
        assert coma == pytest.approx(0.9**2 * 12 * w040 * np.hypot(*decentre) * f / a**2, rel=0.01)


def test_a_melt_has_the_index_and_the_abbe_number_asked_for():
    for name in ("double-gauss-50mm", "tessar"):
        lens = next(Lens.load(bundled) for bundled in rc.lens_names() if name in bundled)
        surface = next(k for k, s in enumerate(lens.surfaces) if s.material.index(486.1) > s.material.index(656.3))
        study = study_of(lens, copies=3, index={surface: 0.002}, abbe_percent={surface: 2.0})
        before = lens.surfaces[surface].material
        for number, (index, percent) in enumerate(study.sizes):
            d, f, c = (study.copy(number).surfaces[surface].material.index(nm) for nm in (587.5618, 486.1327, 656.2725))
            d0, f0, c0 = (before.index(nm) for nm in (587.5618, 486.1327, 656.2725))
            assert d == pytest.approx(d0 + index, abs=1e-12)
            assert (d - 1) / (f - c) == pytest.approx((d0 - 1) / (f0 - c0) * (1 + percent / 100), rel=1e-9)


def test_the_film_tilts_with_a_lens_that_is_tilted():
    """All glass turned as one piece: the plane of infinity turns with it."""
    lens = Lens.load("double-gauss-50mm").stopped_down(8)
    last = len(lens.surfaces) - 1
    study = tolerance_study(
        lens,
        Tolerances(element_tilt_arcmin={(0, last): 30.0}),
        4,
        compensators=("refocus", "film_tilt"),
        sharpest_by="spot",
        fields_deg=[(0, 0), (4, 4), (-4, 4), (4, -4), (-4, -4)],
        object_distance_m=np.inf,
    )
    slope = np.tan(np.deg2rad(study.sizes))
    # To the curvature of the field, whose parts on the two sides differ by a share of the tilt.
    assert np.abs(study.figures.film_slope[:, 1] - slope[:, 0]).max() < 0.1 * np.abs(slope).max()
    assert np.abs(study.figures.film_slope[:, 0] + slope[:, 1]).max() < 0.1 * np.abs(slope).max()


def test_the_lens_as_drawn_has_the_mtf_of_the_analysis():
    lens = Lens.load("double-gauss-50mm").stopped_down(4)
    study = study_of(lens, 1, radius_percent=0.01, fields_deg=[0, 8], frequencies_per_mm=[10, 20])
    true = analysis.mtf(lens, [0, 8], [10, 20], wavelengths_nm=[587.5618])
    for direction, name in enumerate(("tangential", "sagittal")):
        # Rays and the limit of a pupil that is taken for an ellipse stand for waves.
        assert np.abs(study.nominal.mtf[0, :, direction] - getattr(true, name)[0]).max() < 0.03


def test_the_same_seed_makes_the_same_copies():
    lens = Lens.load("double-gauss-50mm")
    few, many = (tolerance_study(lens, "precision", copies, rings=4, seed=3) for copies in (5, 70))
    assert np.array_equal(few.sizes, many.sizes[:5])
    assert np.array_equal(few.figures.mtf, many.figures.mtf[:5])
    assert not np.array_equal(few.sizes, tolerance_study(lens, "precision", 5, rings=4, seed=4).sizes)


def test_errors_keep_within_their_limits():
    tolerances = Tolerances(radius_percent={1: 1.0}, element_decentre_mm={(1, 2): 0.3})
    for distribution, share in (("uniform", 0.5), ("normal", 0.6827 / 0.9545)):
        study = tolerance_study(
            singlet(), dataclasses.replace(tolerances, distribution=distribution), 4000, rings=2, fields_deg=[0]
        )
        radius, decentre = study.sizes[:, 0], np.hypot(*study.sizes[:, 1:].T)
        assert np.abs(radius).max() <= 1 and decentre.max() <= 0.3
        # 4000 draws: a standard deviation of 0.8%.
        assert (np.abs(radius) < 0.5).mean() == pytest.approx(share, abs=0.03)
    assert (decentre < 0.15).mean() == pytest.approx((1 - np.exp(-0.5)) / (1 - np.exp(-2)), abs=0.03)


def test_a_tolerance_may_be_as_large_as_its_loss_allows():
    lens = Lens.load("double-gauss-50mm").stopped_down(2.8)
    study = tolerance_study(lens, Tolerances(radius_percent=0.1, wedge_arcmin=1.0), 1, rings=6)
    limits = study.inverse_sensitivities(0.02)
    assert len(limits) == len(study.items)
    some = [item for item in limits if np.isfinite(item.limit)]
    again = tolerance_study(
        lens,
        Tolerances(
            radius_percent={t.first: t.limit for t in some if t.kind == "radius_percent"},
            wedge_arcmin={t.first: t.limit for t in some if t.kind == "wedge_arcmin"},
        ),
        1,
        rings=6,
    )
    # The search ends within 1e-3 of the loss.
    for sensitivity in again.sensitivities():
        assert sensitivity.loss == pytest.approx(0.02, rel=1.01e-3)
    losses = [s.loss for s in study.sensitivities()]
    assert losses == sorted(losses, reverse=True)


def test_a_copy_photographs():
    study = tolerance_study(Lens.load("double-gauss-50mm"), "commercial", 3, rings=4)
    copy = study.copy(2)
    assert not copy.is_rotational
    rays = rc.Camera(copy, film=rc.Film(36, 24, (6, 4))).generate_rays(spp=16)
    assert (rays.weights > 0).mean() > 0.9
    assert np.isfinite(study.figures.mtf).all()


def test_a_study_that_is_ended_has_what_is_done():
    lens = Lens.load("double-gauss-50mm")
    told = []

    def end(share):
        told.append(share)
        return len(told) < 2

    study = tolerance_study(lens, Tolerances(radius_percent=0.1), 1000, rings=4, progress=end)
    assert 0 < len(study) < 1000 and not study.is_whole
    assert study.sizes.shape[0] == len(study) == len(study.measure("mtf"))

    def interrupt(share):
        raise KeyboardInterrupt

    study = tolerance_study(lens, Tolerances(radius_percent=0.1), 1000, rings=4, progress=interrupt)
    assert 0 < len(study) < 1000 and not study.is_whole


@pytest.mark.parametrize(
    ("limits", "options", "message"),
    [
        ({"radius_mm": float("nan")}, {}, "radius_mm is nan; expected a number of 0 or more"),
        ({"radius_mm": {99: 0.1}}, {}, "no surface 99; the lens has 11, counted from 0"),
        ({"radius_mm": {5: 0.1}}, {}, "radius_mm: surface 6 is a stop, which does not refract"),
        ({"thickness_mm": {10: 0.1}}, {}, "surface 11 is the last; the distance to the film"),
        ({"index": {1: 0.1}}, {}, "no glass behind surface 2"),
        ({"wedge_arcmin": {0: 1}}, {}, "no glass in front of surface 1, and no wedge; use surface_tilt_arcmin"),
        ({"element_tilt_arcmin": {(3, 3): 1}}, {}, "behind its first one, surface 4"),
        ({"wedge_arcmin": 700.0}, {}, "wedge_arcmin is 700; expected at most 600"),
        ({}, {}, "at least one tolerance must be above 0"),
        ({"radius_mm": 0.1}, {"copies": 0}, "copies is 0; expected a whole number from 1"),
        ({"radius_mm": 0.1}, {"seed": -1}, "seed is -1; expected a whole number of 0 or more"),
        ({"radius_mm": 0.1}, {"compensators": ("tilt",)}, 'unknown compensator "tilt"; expected refocus, film_tilt'),
        ({"radius_mm": 0.1}, {"compensators": ("film_tilt",), "fields_deg": [0, 5]}, "the fields lie on one line"),
        ({"radius_mm": 0.1}, {"compensators": (rc.ElementShift(4, 4),)}, "behind its first one, surface 5"),
        (
            {"radius_mm": 0.1},
            {"compensators": (rc.ElementShift(0, 1, range_mm=0),)},
            "range_mm is 0; expected a positive",
        ),
        ({"radius_mm": 0.1}, {"fields_deg": [np.nan]}, "fields_deg must be angles"),
        ({"radius_mm": 0.1}, {"frequencies_per_mm": [-1]}, "frequencies_per_mm must be positive"),
    ],
)
def test_bad_input_has_one_message(limits, options, message):
    lens = Lens.load("double-gauss-50mm")
    with pytest.raises(rc.InputError, match=message) as caught:
        tolerance_study(lens, Tolerances(**limits), **options)
    assert "\n" not in str(caught.value)


def test_names_that_are_none():
    lens = Lens.load("double-gauss-50mm")
    with pytest.raises(rc.InputError, match="unknown grade"):
        tolerance_study(lens, "cheap")
    with pytest.raises(rc.InputError, match="unknown distribution"):
        tolerance_study(lens, Tolerances(radius_mm=0.1, distribution="even"))
    study = tolerance_study(lens, Tolerances(radius_mm=0.1), 2, rings=4)
    with pytest.raises(rc.InputError, match="no copy 2; there are 2"):
        study.copy(2)
    with pytest.raises(rc.InputError, match="unknown measure"):
        study.yield_of(contrast=1.0)
    with pytest.raises(rc.InputError, match=r"loss is 2\.0"):
        study.inverse_sensitivities(2.0)
    with pytest.raises(rc.InputError, match="surfaces 1 to 2 cannot compensate: they are planes"):
        study_of(singlet().inserted(0, PLATE), radius_mm=0.1, compensators=(rc.ElementShift(0, 1),))


@pytest.mark.parametrize("name", ["commercial", "precision", "high"])
def test_better_grades_make_better_lenses(name):
    lens = Lens.load("double-gauss-50mm").stopped_down(4)
    study = tolerance_study(lens, name, 40, rings=4)
    spread = np.ptp(study.quantiles("focal_length_mm", [0.1, 0.9]))
    assert {"commercial": 0.4, "precision": 0.1, "high": 0.01}[name] < spread
    assert spread < {"commercial": 3.0, "precision": 0.6, "high": 0.1}[name]


def test_the_command_writes_a_report_and_json(tmp_path, command):
    report = tmp_path / "report.html"
    words = ("singlet-100mm", "--copies", 8, "--grade", "precision", "--seed", 4, "-o", report, "--json")
    asked = command("lens", "tolerance", *words)
    assert asked.returncode == 0, asked.stderr
    told = json.loads(asked.stdout)
    assert (told["copies"], told["grade"], told["is_whole"]) == (8, "precision", True)
    study = tolerance_study(Lens.load("singlet-100mm"), "precision", 8, seed=4)
    assert told["quantiles"]["mtf"]["0.5"] == pytest.approx(study.quantiles("mtf", [0.5])[0])
    page = report.read_text()
    assert "Worst offenders" in page and page.count("<tr>") > len(study.items)


def test_a_curved_film_is_refused() -> None:
    curved = rc.Lens.load("double-gauss-50mm").with_film_radius(-60)
    with pytest.raises(rc.InputError, match=r"tolerances need a flat film.*is curved"):
        tolerance_study(curved, "precision", copies=1)


@pytest.mark.parametrize("name", ["schmidt-225mm", "view-camera-210mm"])
def test_lenses_that_are_not_of_revolution_are_refused(name):
    """Their film is curved or tilted: a study that took it for flat would be wrong by hundreds of micrometres."""
    with pytest.raises(rc.InputError, match=f'tolerances need a rotationally symmetric lens.*"{name}" is not'):
        tolerance_study(Lens.load(name), "high", 2)


def test_the_command_prints_what_it_found(command):
    asked = command("lens", "tolerance", "tessar-50mm", "--copies", 8, "--grade", "high")
    assert asked.returncode == 0, asked.stderr
    assert "worst offenders" in asked.stdout and "yield" in asked.stdout
    spaced = ("--compensate", "refocus, film_tilt")
    assert command("lens", "tolerance", "tessar-50mm", "--copies", 8, "--quiet", *spaced).stdout == ""
