"""Lens.gradient of lenses that are not of revolution: against central differences in 50 digits, by another trace."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np
import pytest
import realcam as rc
from mpmath import mpf

from .fifty_digits import Face, ObjectRays, by_differences, cross, dot, plus, traced, unit

WAVELENGTH_NM = 587.5618
STOP = 3.0
NUMBERS = {
    "c0": 1 / 40, "t0": 4.0, "n0": 1.6, "c1": -1 / 200, "tilt_x": 2.0, "tilt_y": -1.5, "dx": 0.2, "dy": -0.1,
    "t1": 5.0, "t2": 3.0, "cylinder": 1 / 300, "t3": 3.0, "c4": -1 / 55, "film": 47.0,
}  # fmt: skip
VARIABLES = {
    "c0": rc.Variable.radius(0),
    "t0": rc.Variable.thickness(0),
    "n0": rc.Variable.index(0),
    "c1": rc.Variable.radius(1),
    "tilt_x": rc.Variable.tilt(1, "x"),
    "tilt_y": rc.Variable.tilt(1, "y"),
    "dx": rc.Variable.decentre(1, "x"),
    "dy": rc.Variable.decentre(1, "y"),
    "t2": rc.Variable.thickness(2),
    "cylinder": rc.Variable.radius(3),
    "c4": rc.Variable.radius(4),
    "film": rc.Variable.film_distance(),
}
N3 = 1.5


def tilted_anamorphic() -> rc.Lens:
    """A singlet whose rear face is tilted and decentred, a stop, and a singlet with a cylinder in front."""
    of = NUMBERS
    return rc.Lens(
        surfaces=[
            rc.Surface(radius_of_curvature_mm=1 / of["c0"], material=of["n0"], thickness_mm=of["t0"],
                       clear_semi_diameter_mm=12),
            rc.Surface(radius_of_curvature_mm=1 / of["c1"], thickness_mm=of["t1"], clear_semi_diameter_mm=12,
                       tilt_deg=(of["tilt_x"], of["tilt_y"], 0), decentre_mm=(of["dx"], of["dy"], 0), returns=True),
            rc.Stop(clear_semi_diameter_mm=STOP, thickness_mm=of["t2"]),
            rc.Surface(form="toroid", radius_of_curvature_mm=1 / of["cylinder"], radius_of_curvature_x_mm=np.inf,
                       material=N3, thickness_mm=of["t3"], clear_semi_diameter_mm=12),
            rc.Surface(radius_of_curvature_mm=1 / of["c4"], clear_semi_diameter_mm=12),
        ],
        film_distance_mm=of["film"],
        wavelength_nm=WAVELENGTH_NM,
    )  # fmt: skip


def faces_of(of: dict[str, Any]) -> list[Face]:
    """The last one is the film's plane."""
    tilt, decentre = (of["tilt_x"], of["tilt_y"]), (of["dx"], of["dy"])
    return [
        Face(1, of["n0"], of["t0"], of["c0"]),
        Face(of["n0"], 1, of["t1"], of["c1"], tilt_deg=tilt, decentre=decentre),
        Face(1, 1, of["t2"]),
        Face(1, mpf(N3), of["t3"], of["cylinder"], is_cylinder=True),
        Face(mpf(N3), 1, of["film"], of["c4"]),
        Face(1, 1, 0),
    ]


def exact_numbers(lens: rc.Lens) -> dict[str, Any]:
    """NUMBERS, with the curvatures that the lens keeps in double precision."""
    curvatures = {
        name: lens.surfaces[i].curvature_per_mm for name, i in (("c0", 0), ("c1", 1), ("cylinder", 3), ("c4", 4))
    }
    return {name: mpf(value) for name, value in (NUMBERS | curvatures).items()}


class Truth(ObjectRays):
    """The rays of one fixed object point through given points on the stop. `near`: the same for a slightly changed
    lens."""

    def __init__(
        self, of: dict[str, Any], chief: rc.AimedRays, object_mm: float, pupil: np.ndarray, near: Truth | None = None
    ) -> None:
        at, towards = [mpf(v) for v in chief.origins_mm[0]], unit([mpf(v) for v in chief.directions[0]])
        x = unit(cross([mpf(0), mpf(1), mpf(0)], towards))
        point = plus(at, (-object_mm - at[2]) / towards[2], towards) if np.isfinite(object_mm) else None
        super().__init__(faces_of(of), 2, STOP, (at, x, cross(towards, x)), towards, point, pupil, near)

    def mtf_tangential(self) -> Any:
        return self.contrast(unit([mpf(v) for v in FILM_MM]))

    def mtf_sagittal(self) -> Any:
        return self.contrast(unit([mpf(FILM_MM[1]), -mpf(FILM_MM[0])]))

    def exit_pupil_distance(self) -> Any:
        """Rays near the chief ray, with positions q and direction offsets p on the film, hit the stop at A q + B p.
        Returns the mean of -A^-1 B over both meridians."""
        z = self.chief[2]
        x = unit(cross([mpf(0), mpf(1), mpf(0)], z))
        axes, h = (x, cross(z, x)), mpf(10) ** -18
        columns = []
        for k in range(4):
            at, d = self.start
            step = (self.x, self.y)[k % 2]
            stop, o, p, _ = traced(
                self.faces, 2, plus(at, h if k < 2 else 0, step), unit(plus(d, 0 if k < 2 else h, step))
            )
            off = plus(o, -1, self.chief[1])
            off = plus(off, -dot(off, z) / dot(p, z), p)
            columns.append([v / h for v in (*stop, *(dot(off, a) for a in axes), *(dot(p, a) for a in axes))])
        all_of = mpmath.matrix(columns).T
        on_stop, on_film = all_of[:2, :], all_of[2:, :]
        by_film = on_stop * on_film**-1
        quotient = by_film[:, :2] ** -1 * by_film[:, 2:]
        return -(quotient[0, 0] + quotient[1, 1]) / 2

    def wavefront_waves(self) -> Any:
        return self.rms_waves(self.exit_pupil_distance(), WAVELENGTH_NM)


FILM_MM = (5.0, -4.0)


@pytest.mark.slow
@pytest.mark.parametrize("object_m", [np.inf, 0.4])
def test_gradients_are_central_differences_in_fifty_digits(object_m: float) -> None:
    lens = tilted_anamorphic()
    named: dict[str, Any] = {"film_mm": FILM_MM, "object_distance_m": object_m}
    pupil = lens.spot(samples=1, **named).pupil
    chief = lens.aim([[0.0, 0.0]], **named)
    quantities = ("spot_mm", "chief_ray_height_mm", "mtf_tangential", "mtf_sagittal", "wavefront_waves")
    found = {q: lens.gradient(q, list(VARIABLES.values()), frequency_per_mm=15, samples=1, **named) for q in quantities}
    with mpmath.workdps(50):
        numbers = exact_numbers(lens)
        drawn = Truth(numbers, chief, 1000 * object_m, pupil)

        def truth(change: dict[str, Any]) -> dict[str, Any]:
            rays = Truth(numbers | change, chief, 1000 * object_m, pupil, drawn)
            return {q: getattr(rays, q)() for q in quantities}

        expected = by_differences(truth, numbers, VARIABLES, mpf(10) ** -14)
        for q in quantities:
            assert found[q].value == pytest.approx(float(getattr(drawn, q)()), rel=1e-9), q
            assert found[q].by == pytest.approx(np.array(expected[q]), rel=1e-9), q


def focal_length_and_f_number(of: dict[str, Any], near: rc.AimedRays) -> tuple[Any, Any]:
    """Focal length and f-number of both meridians together, about the ray from the film centre to the stop centre,
    which is found by iteration from the nearby ray `near`. They follow from the determinants of two matrices: the
    derivatives of the direction behind the lens, and of the point on the stop, by the position of parallel rays in
    front of the lens. The derivatives are finite differences."""
    h, faces = mpf(10) ** -18, faces_of(of)
    at, d = [mpf(v) for v in near.origins_mm[0]], unit([mpf(v) for v in near.directions[0]])

    def beside(k: int, step: Any) -> tuple[list[Any], list[Any]]:
        x = unit(cross([mpf(0), mpf(1), mpf(0)], d))
        axis = (x, cross(d, x))[k % 2]
        return (plus(at, step, axis), d) if k < 2 else (at, unit(plus(d, step, axis)))

    for _ in range(6):
        stop, place, _, _ = traced(faces, 2, at, d)
        here = mpmath.matrix([*stop, *place[:2]])
        slopes = mpmath.matrix(4, 4)
        for k in range(4):
            stop, place, _, _ = traced(faces, 2, *beside(k, h))
            slopes[:, k] = (mpmath.matrix([*stop, *place[:2]]) - here) / h
        steps = mpmath.lu_solve(slopes, -here)
        for k in range(4):
            at, d = beside(k, steps[k])
    stop, _, behind, _ = traced(faces, 2, at, d)
    x = unit(cross([mpf(0), mpf(1), mpf(0)], behind))
    axes, power, pupil = (x, cross(behind, x)), mpmath.matrix(2, 2), mpmath.matrix(2, 2)
    for k in range(2):
        stop_beside, _, direction, _ = traced(faces, 2, *beside(k, h))
        for i in range(2):
            power[i, k], pupil[i, k] = dot(axes[i], direction) / h, (stop_beside[i] - stop[i]) / h
    length = 1 / mpmath.sqrt(abs(mpmath.det(power)))
    return length, length * mpmath.sqrt(abs(mpmath.det(pupil))) / (2 * STOP)


def test_first_order_is_a_central_difference_in_fifty_digits() -> None:
    lens = tilted_anamorphic()
    near = lens.aim([[0.0, 0.0]], film_mm=(0.0, 0.0))
    quantities = ("effective_focal_length_mm", "f_number")
    found = {q: lens.gradient(q, list(VARIABLES.values())) for q in quantities}
    for q in quantities:
        # First-order data are found by differences of rays in double.
        assert found[q].value == pytest.approx(getattr(lens.first_order(), q), rel=1e-8)
    with mpmath.workdps(50):
        numbers = exact_numbers(lens)

        def truth(change: dict[str, Any]) -> dict[str, Any]:
            return dict(zip(quantities, focal_length_and_f_number(numbers | change, near), strict=True))

        assert found[quantities[0]].value == pytest.approx(float(truth({})[quantities[0]]), rel=1e-10)
        expected = by_differences(truth, numbers, VARIABLES, mpf(10) ** -14)
    for q in quantities:
        # The second derivatives of rays are differences of first ones in double.
        assert found[q].by == pytest.approx(np.array(expected[q]), rel=1e-7, abs=1e-9 * found[q].value), q


def test_the_first_order_of_a_lens_that_is_moved_before_its_film_is_asked_for_before() -> None:
    moved = rc.Lens.load("view-camera-210mm")
    with pytest.raises(rc.InputError, match="differentiate the lens without them"):
        moved.gradient("effective_focal_length_mm", [rc.Variable.radius(0)])


def test_a_length_is_a_sum() -> None:
    variables = [rc.Variable.radius(0), rc.Variable.thickness(2), rc.Variable.film_distance()]
    found = tilted_anamorphic().gradient("length_mm", variables)
    assert found.value == pytest.approx(sum(NUMBERS[name] for name in ("t0", "t1", "t2", "t3", "film")), rel=1e-15)
    assert list(found.by) == [0, 1, 1]


def test_values_are_those_of_the_analyses() -> None:
    """The lenses include tilted axes and tilted films."""
    some = [rc.Variable.radius(0)]
    leaning = rc.Lens.load("double-gauss-50mm").focused(1.5).stopped_down(4).tilted(x_deg=4)
    for lens in (tilted_anamorphic(), leaning):
        for named in ({"film_mm": FILM_MM}, {"field_deg": 3.0}, {"field_deg": 0.0}):
            spot, wavefront = lens.spot(**named), lens.wavefront(pattern="hexapolar", samples=6, **named)
            assert lens.gradient("spot_mm", some, **named).value == pytest.approx(spot.rms_radius_mm, rel=1e-9)
            height = lens.gradient("chief_ray_height_mm", some, **named).value
            assert height == pytest.approx(spot.chief_ray_mm[1], rel=1e-9, abs=1e-9)
            # The exit pupils are found by finite differences of rays, hence the wider tolerance.
            waves = lens.gradient("wavefront_waves", some, **named).value
            assert waves == pytest.approx(wavefront.rms_waves, rel=1e-6)


def test_a_lens_that_leans_before_its_film() -> None:
    """Differences of double: of a spot of 0.01 mm that is found to 1e-14 mm, by steps that change it by a share of
    1e-3 or less."""
    lens = rc.Lens.load("double-gauss-50mm").stopped_down(4).tilted(x_deg=3, y_deg=-2)
    drawn: dict[str, Any] = {"field_deg": 5.0, "object_distance_m": np.inf}
    variables = [rc.Variable.thickness(2), rc.Variable.radius(3), rc.Variable.film_distance()]
    found = lens.gradient("spot_mm", variables, **drawn)

    def by_surface(variable: rc.Variable, step: float) -> float:
        surface = lens.surfaces[variable.surface]
        changed = lens.with_surfaces({variable.surface: variable.set(surface, variable.of(surface) + step)})
        return changed.spot(**drawn).rms_radius_mm

    for k, step in enumerate((1e-4, 1e-7)):
        slope = (by_surface(variables[k], step) - by_surface(variables[k], -step)) / (2 * step)
        assert found.by[k] == pytest.approx(slope, rel=1e-5)
    # A spot moves along the film's normal, and the film along the lens's axis.
    spots = [lens.spot(film_distance_mm=lens.film_distance_mm + step, **drawn) for step in (1e-4, -1e-4)]
    slope = (spots[0].rms_radius_mm - spots[1].rms_radius_mm) / 2e-4
    cosine = np.cos(np.radians(3)) * np.cos(np.radians(2))
    assert found.by[2] == pytest.approx(slope * cosine, rel=1e-5)


def test_a_film_point_names_the_field_of_a_lens_of_revolution_too() -> None:
    lens = rc.Lens.load("double-gauss-50mm")
    variables = [rc.Variable.radius(0), rc.Variable.tilt(2, "x")]
    for quantity in ("spot_mm", "mtf_tangential", "mtf_sagittal"):
        by_angle = lens.gradient(quantity, variables, field_deg=10, object_distance_m=np.inf, frequency_per_mm=10)
        at = (0.0, float(lens.spot(10.0, object_distance_m=np.inf).chief_ray_mm[1]))
        by_place = lens.gradient(quantity, variables, film_mm=at, object_distance_m=np.inf, frequency_per_mm=10)
        assert by_place.value == pytest.approx(by_angle.value, rel=1e-8)
        assert by_place.by == pytest.approx(by_angle.by, rel=1e-7)


@pytest.mark.parametrize("quantity", ["distortion_percent", "chief_ray_angle_deg", "back_focal_distance_mm"])
def test_what_needs_a_lens_of_revolution_says_so(quantity: str) -> None:
    with pytest.raises(rc.InputError, match="need a rotationally symmetric lens"):
        tilted_anamorphic().gradient(quantity, [rc.Variable.radius(0)], field_deg=3)
