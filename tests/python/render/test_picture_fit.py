"""rc.fit_pictures beside the closed forms of linear least squares, and on a camera."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import realcam as rc
from numpy.typing import NDArray
from scipy.optimize import lsq_linear

from .test_picture_gradient import corner_camera, stripes

SHAPE = (2, 4, 8, 1)
Doubles = NDArray[np.float64]


def linear_problem() -> tuple[Doubles, Doubles, Doubles]:
    """Derivatives (3, *SHAPE), observed pictures and the variance of their noise."""
    random = np.random.default_rng(1)
    matrix = random.normal(size=(3, *SHAPE))
    variance = random.uniform(0.5, 2, SHAPE)
    observed = np.tensordot([1.0, -2.0, 0.5], matrix, 1) + np.sqrt(variance) * random.normal(size=SHAPE)
    return matrix, observed, variance


def arguments_of(matrix: Doubles, observed: Doubles, variance: Doubles) -> dict[str, Any]:
    """Arguments of rc.fit_pictures for pictures that are linear in the values."""
    return {
        "pictures_of": lambda values, block: np.tensordot(values, matrix, 1),
        "derivatives_of": lambda values, block, seed: matrix,
        "observed": observed,
        "variance": variance,
        "start": np.zeros(3),
        "scale": np.ones(3),
        "blocks": (2, 1),
    }


@pytest.mark.parametrize("has_prior", [False, True])
def test_a_linear_problem_has_the_solution_of_linear_least_squares(has_prior: bool) -> None:
    matrix, observed, variance = linear_problem()
    mean, deviation = np.array([0.5, 0.0, 0.0]), np.array([0.1, np.inf, 0.2])
    prior = (mean, deviation) if has_prior else None
    fit = rc.fit_pictures(**arguments_of(matrix, observed, variance), prior=prior, steps=30)
    rows = (matrix / np.sqrt(variance)).reshape(3, -1)
    weights = 1 / deviation**2 if has_prior else np.zeros(3)
    information = rows @ rows.T + np.diag(weights)
    wanted = np.linalg.solve(information, rows @ (observed / np.sqrt(variance)).ravel() + weights * mean)
    np.testing.assert_allclose(fit.covariance, np.linalg.inv(information), rtol=1e-9)
    # The search ends when the next step, which leads to the solution of a linear problem, is a tenth of the standard
    # deviation.
    off = fit.values - wanted
    assert fit.remaining_step == pytest.approx(np.sqrt(off @ information @ off), rel=1e-6)
    assert fit.remaining_step < 0.1
    assert fit.converged
    assert fit.message.startswith("The next step is shorter")


@pytest.mark.parametrize("scale", [1.0, 1e-3])
def test_a_fit_whose_steps_do_not_suffice_has_not_converged(scale: float) -> None:
    """A step is at most two scales long, and a weakly determined value must not end the search by its damping."""
    matrix, observed, variance = linear_problem()
    arguments = arguments_of(matrix, observed, variance) | {"start": np.full(3, 9.0), "scale": np.full(3, scale)}
    fit = rc.fit_pictures(**arguments, steps=2)
    rows = (matrix / np.sqrt(variance)).reshape(3, -1)
    off = fit.values - np.linalg.solve(rows @ rows.T, rows @ (observed / np.sqrt(variance)).ravel())
    assert fit.remaining_step == pytest.approx(np.sqrt(off @ rows @ rows.T @ off), rel=1e-6)
    assert fit.remaining_step > 10
    assert not fit.converged
    assert fit.message == "All steps are used up: 2 with blocks of 1 x 1 pixels."


def test_wrong_derivatives_do_not_converge() -> None:
    matrix, observed, variance = linear_problem()
    arguments = arguments_of(matrix, observed, variance)
    fit = rc.fit_pictures(**arguments | {"derivatives_of": lambda values, block, seed: -matrix})
    assert not fit.converged
    assert fit.message.startswith("No step lowers the sum of squares")


def test_a_bound_holds_a_value_as_in_bounded_least_squares() -> None:
    matrix, observed, variance = linear_problem()
    low, high = np.array([-9.0, -1.0, -9.0]), np.array([9.0, 9.0, 0.2])  # the second and the third bound are active
    fit = rc.fit_pictures(**arguments_of(matrix, observed, variance), bounds=(low, high), steps=30)
    rows = (matrix / np.sqrt(variance)).reshape(3, -1)
    wanted = lsq_linear(rows.T, (observed / np.sqrt(variance)).ravel(), (low, high), tol=1e-14).x
    off = fit.values - wanted
    assert fit.values[1:].tolist() == [-1.0, 0.2]
    assert off @ rows @ rows.T @ off < 0.1**2
    assert fit.converged


def test_noise_of_derivatives_does_not_count_as_information() -> None:
    matrix, observed, variance = linear_problem()
    random = np.random.default_rng(2)
    fits = [
        rc.fit_pictures(
            lambda values, block: np.tensordot(values, matrix, 1),
            lambda values, block, seed: matrix + random.normal(size=matrix.shape),
            observed,
            variance,
            np.zeros(3),
            np.ones(3),
            blocks=(1,),
            steps=1,
        )
        for _ in range(200)
    ]
    found = np.array([np.linalg.inv(fit.covariance) for fit in fits])
    rows = (matrix / np.sqrt(variance)).reshape(3, -1)
    error = found.std(0, ddof=1) / np.sqrt(len(found))
    # Squares of one estimate would be too large by the sum of 1 / variance on the diagonal: some 60, and 20 errors.
    assert np.all(np.abs(found.mean(0) - rows @ rows.T) < 4.5 * error)
    assert (1 / variance).sum() > 20 * error.max()


def test_directions_are_sorted_by_what_pictures_leave_open() -> None:
    fit = rc.PictureFit(np.zeros(2), np.array([[4.0, 0.0], [0.0, 9.0]]), 1.0, 1, 0.0, "")
    sizes, axes = fit.directions([4.0, 3.0])
    np.testing.assert_allclose(sizes, [1.0, 0.5])
    np.testing.assert_allclose(np.abs(axes), [[0, 1], [1, 0]])
    np.testing.assert_allclose(fit.errors, [2, 3])


@pytest.mark.slow
def test_focus_and_yaw_are_found() -> None:
    scene, camera = stripes(), corner_camera()
    family = rc.CameraParameters(camera, ["yaw_deg", "focus_distance_m"])
    truth = np.array([0.05, 2.15])
    random = np.random.default_rng(4)
    exact = family.render(scene, truth, spp=16384, seed=9, max_bounces=0)[None].astype(float)
    sigma = 0.02 * exact.mean()
    fit = rc.fit_pictures(
        lambda values, block: family.render(scene, values, spp=2048, seed=1, max_bounces=0)[None],
        lambda values, block, seed: family.gradient(scene, values, spp=64, seed=100 + seed, max_bounces=0)[:, None],
        exact + sigma * random.normal(size=exact.shape),
        np.full(exact.shape, sigma**2),
        family.values,
        [0.1, 0.2],
        blocks=(4, 2, 1),
    )
    off = fit.values - truth
    # A chi-square of two degrees of freedom exceeds 20 once in 20,000 times; the noise of the renderings, a quarter of
    # that of the pictures, is in the margin.
    assert off @ np.linalg.solve(fit.covariance, off) < 20
    assert fit.converged
    assert np.all(fit.errors < [0.01, 0.05])


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"blocks": (3,)}, "blocks must divide pictures of 8 x 4 pixels"),
        ({"variance": np.zeros(SHAPE)}, "variances positive"),
        ({"scale": [1.0, 0.0, 1.0]}, "scales positive"),
        ({"observed": np.full(SHAPE, np.nan)}, "observed must be finite; found nan"),
        ({"start": [np.nan, 0.0, 0.0]}, "start and scale must be finite; found nan"),
        ({"start": [], "scale": []}, "start and scale must have shape"),
        ({"blocks": (0,)}, "blocks must divide"),
        ({"blocks": (2.0,)}, "blocks must divide"),
        ({"blocks": (True,)}, "blocks must divide"),
        ({"blocks": 2}, "blocks must divide .* found 2"),
        ({"steps": 0}, "steps is 0; expected a whole number of 1 or more"),
        ({"steps": 2.5}, "steps is 2.5; expected a whole number"),
        ({"seed": -1}, "seed is -1; expected a whole number of 0 or more"),
        ({"prior": (np.zeros(3), [1.0, 0.0, 1.0])}, "positive standard deviations"),
        ({"prior": 1.0}, "prior must be two numbers or arrays"),
        ({"bounds": 1.0}, "bounds must be two numbers or arrays"),
        ({"prior": (np.zeros(2), np.ones(2))}, "prior must be two numbers or arrays"),
        ({"bounds": (np.ones(3), -np.ones(3))}, "start must lie within bounds"),
        ({"bounds": (0.1, 1.0)}, "start must lie within bounds"),
        # An array of one picture would be broadcast to all of them.
        ({"pictures_of": lambda values, block: np.zeros(SHAPE)[0]}, "pictures_of.* must have shape"),
        ({"pictures_of": lambda values, block: np.full(SHAPE, np.nan)}, "pictures_of.* must be finite; found nan"),
        ({"derivatives_of": lambda values, block, seed: np.zeros((3, *SHAPE[1:]))}, "derivatives_of.* must have shape"),
        ({"derivatives_of": lambda values, block, seed: np.full((3, *SHAPE), np.inf)}, "derivatives_of.* found inf"),
    ],
)
def test_wrong_arguments_are_refused(changes: dict[str, object], message: str) -> None:
    with pytest.raises(rc.InputError, match=message):
        rc.fit_pictures(**{**arguments_of(*linear_problem()), **changes})


def test_a_value_of_which_pictures_say_nothing_is_not_called_known() -> None:
    matrix, observed, variance = linear_problem()
    matrix = matrix * np.reshape([1, 0, 1], (3, 1, 1, 1, 1))
    fit = rc.fit_pictures(**{**arguments_of(matrix, observed, variance), "scale": [1.0, 2.0, 1.0]})
    assert fit.errors[1] == pytest.approx(2e6)
    assert max(fit.errors[0], fit.errors[2]) < 10
    deviations, axes = fit.directions([1.0, 2.0, 1.0])
    assert deviations[0] == pytest.approx(1e6)
    assert np.abs(axes[0]) == pytest.approx([0, 1, 0], abs=1e-6)
