"""Rays as a function of torch.autograd: gradcheck, which is PyTorch's own test by differences."""

from __future__ import annotations

import pytest
import realcam as rc

torch = pytest.importorskip("torch", reason="torch is an extra")

from realcam.derivatives.torch_rays import trace_with_torch  # noqa: E402


def test_autograd_agrees_with_differences() -> None:
    lens = rc.Lens.load("cooke-triplet-50mm")
    variables = [rc.Variable.radius(0), rc.Variable.thickness(0), rc.Variable.tilt(2, "x")]
    values = torch.tensor([v.of(lens.surfaces[v.surface]) for v in variables], dtype=torch.float64, requires_grad=True)
    origins = torch.tensor([[1.0, 2.0, -5.0], [-2.0, 0.5, -3.0]], dtype=torch.float64, requires_grad=True)
    directions = torch.tensor([[0.0, 0.1, 1.0], [0.05, 0.0, 2.0]], dtype=torch.float64, requires_grad=True)

    def outputs(o: torch.Tensor, d: torch.Tensor, v: torch.Tensor) -> tuple[torch.Tensor, ...]:
        return trace_with_torch(lens, o, d, variables, v, start="scene")[:3]

    # Differences of double are good to some 1e-7; the radius's derivatives are some thousands.
    assert torch.autograd.gradcheck(outputs, (origins, directions, values), eps=1e-7, atol=1e-4, rtol=1e-4)


def test_a_ray_that_does_not_pass_has_no_derivatives() -> None:
    lens = rc.Lens.load("cooke-triplet-50mm")
    values = torch.tensor([lens.surfaces[0].curvature_per_mm], dtype=torch.float64, requires_grad=True)
    at, _, _, passes = trace_with_torch(
        lens,
        torch.tensor([[0.0, 500.0, -5.0]]),
        torch.tensor([[0.0, 0.0, 1.0]]),
        [rc.Variable.radius(0)],
        values,
        start="scene",
    )
    assert not passes.any()
    at.sum().backward()
    assert values.grad is not None and values.grad.item() == 0


def test_wrong_values_are_refused() -> None:
    lens = rc.Lens.load("cooke-triplet-50mm")
    rays = torch.zeros((1, 3))
    with pytest.raises(rc.InputError, match="values must be 1 numbers"):
        trace_with_torch(lens, rays, rays, [rc.Variable.radius(0)], torch.zeros(2))
    for surface in (-1, 99):
        with pytest.raises(rc.InputError, match=f"there is no surface {surface}; the lens has"):
            trace_with_torch(lens, rays, rays, [rc.Variable.radius(surface)], torch.zeros(1))
    with pytest.raises(rc.InputError, match='the quantity "film_distance" cannot be set'):
        trace_with_torch(lens, rays, rays, [rc.Variable.film_distance()], torch.zeros(1))
