"""Lens.gradient and ray_derivatives: against central differences in 50 digits, and closed forms."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
import pytest
import realcam as rc
from mpmath import mpf

from .fifty_digits import Face, ObjectRays, by_differences

WAVELENGTH_NM = 587.5618
NUMBERS = {"c0": 1 / 30, "k": -0.6, "a4": 2e-6, "t0": 4.0, "n": 1.6, "c1": -1 / 80, "t1": 6.0, "film": 41.0}
VARIABLES = {
    "c0": rc.Variable.radius(0),
    "k": rc.Variable.conic(0),
    "a4": rc.Variable.aspheric(0, 4),
    "t0": rc.Variable.thickness(0),
    "n": rc.Variable.index(0),
    "c1": rc.Variable.radius(1),
    "t1": rc.Variable.thickness(1),
    "film": rc.Variable.film_distance(),
}
STOP = 4.0


def singlet() -> rc.Lens:
    """An aspheric singlet with its stop behind: rays have to be aimed, and the pupil moves with the lens."""
    of = NUMBERS
    return rc.Lens(
        surfaces=[
            rc.Surface(
                radius_of_curvature_mm=1 / of["c0"],
                conic=of["k"],
                aspheric_coefficients={4: of["a4"]},
                material=of["n"],
                thickness_mm=of["t0"],
                clear_semi_diameter_mm=12,
            ),
            rc.Surface(radius_of_curvature_mm=1 / of["c1"], thickness_mm=of["t1"], clear_semi_diameter_mm=12),
            rc.Stop(clear_semi_diameter_mm=STOP),
        ],
        film_distance_mm=of["film"],
        wavelength_nm=WAVELENGTH_NM,
    )


def faces_of(of: dict[str, Any]) -> list[Face]:
    """The last one is the film's plane."""
    return [
        Face(1, of["n"], of["t0"], of["c0"], of["k"], of["a4"]),
        Face(of["n"], 1, of["t1"], of["c1"]),
        Face(1, 1, of["film"]),
        Face(1, 1, 0),
    ]


def exact_numbers(lens: rc.Lens) -> dict[str, Any]:
    """NUMBERS, with the curvatures that the lens keeps in double precision."""
    curvatures = {f"c{i}": lens.surfaces[i].curvature_per_mm for i in (0, 1)}
    return {name: mpf(value) for name, value in (NUMBERS | curvatures).items()}


class Truth(ObjectRays):
    """The rays of one object point through given points on the stop. `near`: the same for a slightly changed lens."""

    def __init__(
        self,
        of: dict[str, Any],
        field_deg: float,
        object_mm: float | None,
        pupil: np.ndarray,
        near: Truth | None = None,
    ) -> None:
        self.of, field = of, mpmath.radians(mpf(field_deg))

        # The middle of the paraxial entrance pupil: a ray from there with slope 1 meets the middle of the stop.
        def at_stop(y: Any, u: Any) -> Any:
            n = of["n"]
            u = (u - y * of["c0"] * (n - 1)) / n
            y += of["t0"] * u
            u = n * u - y * of["c1"] * (1 - n)
            return y + of["t1"] * u

        pupil_z = at_stop(mpf(0), mpf(1)) / at_stop(mpf(1), mpf(0))
        point = None
        if object_mm is not None:
            distance = object_mm + pupil_z
            point = [mpf(0), -distance * mpmath.tan(field), pupil_z - distance]
        zero, one = mpf(0), mpf(1)
        start = [zero] * 3, [one, zero, zero], [zero, one, zero]
        towards = [zero, mpmath.sin(field), mpmath.cos(field)]
        super().__init__(faces_of(of), 2, STOP, start, towards, point, pupil, near)

    def mtf_tangential(self) -> Any:
        return self.contrast([0, 1])

    def wavefront_waves(self) -> Any:
        """The sphere goes through the middle of the exit pupil, which is the stop itself."""
        x, y, _ = self.chief[1]
        return self.rms_waves(mpmath.sqrt(x * x + y * y + self.of["film"] ** 2), WAVELENGTH_NM)


@pytest.mark.parametrize(("field_deg", "object_m"), [(6.0, np.inf), (4.0, 0.3)])
def test_gradients_are_central_differences_in_fifty_digits(field_deg: float, object_m: float) -> None:
    lens = singlet()
    object_mm = None if np.isinf(object_m) else 1000 * object_m
    options: dict[str, Any] = {"field_deg": field_deg, "object_distance_m": object_m, "samples": 1}
    pupil = lens.spot(field_deg, object_distance_m=object_m, samples=1).pupil
    quantities = ("spot_mm", "chief_ray_height_mm", "mtf_tangential", "wavefront_waves")
    found = {q: lens.gradient(q, list(VARIABLES.values()), frequency_per_mm=15, **options) for q in quantities}
    with mpmath.workdps(50):
        numbers = exact_numbers(lens)
        drawn = Truth(numbers, field_deg, object_mm, pupil)

        def truth(change: dict[str, Any]) -> dict[str, Any]:
            rays = Truth(numbers | change, field_deg, object_mm, pupil, drawn)
            return {q: getattr(rays, q)() for q in quantities}

        expected = by_differences(truth, numbers, VARIABLES, mpf(10) ** -16)
        for q in quantities:
            # Rays are aimed within 2.5e-11 of the stop's radius.
            assert found[q].value == pytest.approx(float(getattr(drawn, q)()), rel=1e-9)
            assert found[q].by == pytest.approx(np.array(expected[q]), rel=1e-9), q


def test_first_order_is_that_of_a_thick_lens() -> None:
    """1/f = (n - 1) (c1 - c2 + (n - 1) d c1 c2 / n), and its derivatives by hand."""
    n, d, c1, c2 = 1.6, 4.0, NUMBERS["c0"], NUMBERS["c1"]
    variables = [VARIABLES[name] for name in ("c0", "c1", "t0", "n")]
    found = singlet().gradient("effective_focal_length_mm", variables)
    power = (n - 1) * (c1 - c2 + (n - 1) * d * c1 * c2 / n)
    by_power = [
        (n - 1) * (1 + (n - 1) * d * c2 / n),
        (n - 1) * (-1 + (n - 1) * d * c1 / n),
        (n - 1) ** 2 * c1 * c2 / n,
        c1 - c2 + d * c1 * c2 * (1 - 1 / n**2),
    ]
    assert found.value == pytest.approx(1 / power, rel=1e-14)
    assert found.by == pytest.approx(-np.array(by_power) / power**2, rel=1e-12)


def test_values_are_those_of_the_analyses() -> None:
    lens = rc.Lens.load("double-gauss-50mm").focused(1.5)
    some = [rc.Variable.radius(0)]
    for field in (0.0, 12.0):
        spot = lens.spot(field)
        of = lens.gradient("spot_mm", some, field_deg=field)
        assert of.value == pytest.approx(spot.rms_radius_mm, rel=1e-10)
        for remove in (None, "tilt", "focus"):
            wavefront = lens.wavefront(field, remove=remove, pattern="hexapolar", samples=6)
            waves = lens.gradient("wavefront_waves", some, field_deg=field, remove=remove)
            assert waves.value == pytest.approx(wavefront.rms_waves, rel=1e-8)
    percent = rc.analysis.distortion(lens, [12.0], projection="tangent").percent[0]
    assert lens.gradient("distortion_percent", some, field_deg=12.0).value == pytest.approx(percent, rel=1e-9)
    data = lens.first_order()
    for quantity in ("f_number", "back_focal_distance_mm", "front_focal_distance_mm", "entrance_pupil_position_mm"):
        assert lens.gradient(quantity, some).value == pytest.approx(getattr(data, quantity), rel=1e-12)


def test_rays_keep_their_length_and_say_where_they_end() -> None:
    lens = singlet()
    origins = [[0, 1.0, -5], [0, 30.0, -5], [1, -2.0, -400]]
    found = rc.ray_derivatives(
        lens, origins, [[0, 0, 2.0], [0, 0, 1.0], [0, 0.01, 1.0]], [*VARIABLES.values()][:7], start="scene"
    )
    traced_rays = lens.trace(np.array(origins), np.array([[0, 0, 2.0], [0, 0, 1.0], [0, 0.01, 1.0]]), start="scene")
    assert list(found.status) == list(traced_rays.status) == [0, 2, 0]
    passes = found.status == 0
    for name in ("origins_mm", "directions", "optical_path_mm"):
        assert np.allclose(getattr(found, name)[passes], getattr(traced_rays, name)[passes], rtol=1e-13, atol=1e-13)
    assert np.isnan(found.origins_by[1]).all()
    # A unit vector changes across itself.
    along = np.einsum("ni,niv->nv", found.directions, found.directions_by)[passes]
    assert np.abs(along).max() < 1e-15
    # A direction twice as long is the same ray.
    assert np.abs(found.directions_by_start[0] @ np.array([0, 0, 0, 0, 0, 2.0])).max() < 1e-15
    assert found.optical_path_by_start[0] @ np.array([0, 0, 1, 0, 0, 0]) == pytest.approx(-1, rel=1e-12)


def test_a_function_of_rays_has_the_gradient_that_forward_derivatives_give() -> None:
    """The function is a sum of all that Lens.trace returns, with these weights. The second ray does not pass. Forward
    derivatives are held to differences in 50 digits by tests/cpp."""
    lens = singlet()
    variables = [VARIABLES[name] for name in ("c0", "k", "a4", "t0", "n", "c1", "t1")]
    rays = [[0.5, 1, -5], [0, 30, -5], [1, -2, -9]], [[0, 0.1, 2], [0, 0, 1], [0.05, 0.01, 0.5]]
    of_at, of_way = [[0.3, -1, 2], [np.nan] * 3, [1, 0.2, 0.1]], [[5, 20, 9], [np.nan] * 3, [-7, 8, 30]]
    parts: list[dict[str, Any]] = [
        {"of_origins": of_at},
        {"of_directions": of_way},
        {"of_optical_paths": [0.7, np.nan, -0.4]},
    ]
    found = rc.backpropagate_rays(lens, *rays, variables, **parts[0], **parts[1], **parts[2], start="scene")
    forward = rc.ray_derivatives(lens, *rays, variables, start="scene")

    def contracted(by: str) -> np.ndarray:
        at, way, path = (getattr(forward, f"{of}_{by}")[[0, 2]] for of in ("origins", "directions", "optical_path"))
        weights = (np.array(of)[[0, 2]] for of in (of_at, of_way))
        return (
            np.stack([np.einsum("ni,niv->nv", w, d) for w, d in zip(weights, (at, way), strict=True)]).sum(axis=0)
            + np.array([[0.7], [-0.4]]) * path
        )

    assert found.by == pytest.approx(contracted("by").sum(axis=0), rel=1e-12)
    by_start = np.concatenate([found.by_origins, found.by_directions], axis=1)
    assert by_start[[0, 2]] == pytest.approx(contracted("by_start"), rel=1e-12)
    assert not by_start[1].any()
    # An omitted gradient means that the function does not depend on that output; the gradient is linear in them.
    by = [rc.backpropagate_rays(lens, *rays, variables, **part, start="scene").by for part in parts]
    assert np.sum(by, axis=0) == pytest.approx(found.by, rel=1e-12)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda lens: lens.gradient("blur", [rc.Variable.radius(0)]),
            'unknown quantity "blur"; expected one of spot_mm',
        ),
        (lambda lens: lens.gradient("spot_mm", []), "at least one Variable"),
        (lambda lens: lens.gradient("spot_mm", [rc.Variable("colour", 0)]), 'unknown quantity "colour"'),
        (lambda lens: lens.gradient("f_number", [rc.Variable.radius(7)]), "there is no surface 7; the lens has 3"),
        (lambda lens: lens.gradient("spot_mm", [rc.Variable.radius(2)]), "only blocks light"),
        (lambda lens: lens.gradient("spot_mm", [rc.Variable.radius(0)] * 2), "variables must be distinct"),
        (lambda lens: lens.gradient("mtf_tangential", [rc.Variable.radius(0)]), "needs a frequency_per_mm"),
        (
            lambda lens: lens.gradient("distortion_percent", [rc.Variable.radius(0)]),
            "distortion is not defined on the axis",
        ),
        (
            lambda lens: lens.gradient("wavefront_waves", [rc.Variable.radius(0)], remove="coma"),
            "tilt, focus or None",
        ),
        (lambda lens: rc.Variable.tilt(0, "w"), "expected x, y or z"),
        (
            lambda lens: lens.with_surface(1, radius_of_curvature_mm=np.inf).gradient(
                "spot_mm", [rc.Variable.conic(1)]
            ),
            "surface 2 is a plane: its conic has no effect",
        ),
        (
            lambda lens: rc.backpropagate_rays(
                lens, np.zeros((2, 3)), np.ones((2, 3)), [rc.Variable.radius(0)], of_origins=np.zeros((1, 3))
            ),
            r"must be arrays of shape \(N, 3\), like origins_mm",
        ),
        (
            lambda lens: rc.backpropagate_rays(
                lens, np.zeros((2, 3)), np.ones((2, 3)), [rc.Variable.radius(0)], of_optical_paths=1.0
            ),
            r"of_optical_paths must be an array of shape \(N,\)",
        ),
    ],
)
def test_what_makes_no_sense_is_said_in_one_line(call: Callable[[rc.Lens], Any], message: str) -> None:
    with pytest.raises(rc.InputError, match=message) as error:
        call(singlet())
    assert "\n" not in str(error.value)


def test_a_curved_film_is_refused() -> None:
    curved = rc.Lens.load("double-gauss-50mm").with_film_radius(-60)
    with pytest.raises(rc.InputError, match=r"need a flat film.*is curved"):
        curved.gradient("spot_mm", [rc.Variable.radius(0)], field_deg=15)
