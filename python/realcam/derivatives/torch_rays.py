"""Ray tracing that PyTorch differentiates with respect to lens variables and rays. Needs the package torch."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .._core import InputError, Lens
from .rays import backpropagate_rays
from .variable import SETTABLE, Variable, checked, with_values

if TYPE_CHECKING:
    import torch


def trace_with_torch(
    lens: Lens,
    origins_mm: torch.Tensor,
    directions: torch.Tensor,
    variables: Sequence[Variable],
    values: torch.Tensor,
    *,
    wavelength_nm: float | None = None,
    start: str = "film",
) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor, torch.Tensor]:
    """Lens.trace of the lens with `values` (V,) for its variables, differentiable by torch.autograd.

    origins_mm, directions: (N, 3), lens frame, in host memory. variables: curvatures, thicknesses, conics, aspheric
    coefficients, indices, tilts and decentres; `values` are in their units. An index holds for all wavelengths: its
    medium has no dispersion. wavelength_nm: None is the design wavelength. start: "film" or "scene", the side on which
    the rays enter the lens.
    Returns origins, mm, and unit directions (N, 3), optical paths, mm (N,), in float64, and booleans (N,): True if the
    ray passes. Rays that do not pass are zero and have no derivatives. First derivatives by origins, directions and
    values are supported; second derivatives are not. Raises InputError for variables that the lens does not have,
    ImportError without torch.
    """
    import torch

    listed = checked(lens, variables)
    for variable in listed:
        if variable.quantity not in SETTABLE:
            raise InputError(f'the quantity "{variable.quantity}" cannot be set; expected one of {", ".join(SETTABLE)}')
    if tuple(values.shape) != (len(listed),):
        raise InputError(f"values must be {len(listed)} numbers, one for each variable")
    for tensor in (origins_mm, directions, values):
        if tensor.device.type != "cpu":
            raise InputError(f"tensors must be in host memory; found one on {tensor.device}")

    def numbers(tensor: torch.Tensor) -> np.ndarray:
        array: np.ndarray = tensor.detach().double().numpy()
        return array

    class Trace(torch.autograd.Function):  # type: ignore[misc]
        @staticmethod
        def forward(ctx: Any, o: torch.Tensor, d: torch.Tensor, v: torch.Tensor) -> Any:
            ctx.changed = with_values(lens, listed, v.detach().double().tolist())
            ctx.save_for_backward(o, d, v)
            out = ctx.changed.trace(numbers(o), numbers(d), wavelength_nm=wavelength_nm, start=start)
            passes = torch.from_numpy(out.status == 0)
            ctx.mark_non_differentiable(passes)

            def tensor(array: np.ndarray) -> torch.Tensor:
                return torch.where(passes if array.ndim == 1 else passes[:, None], torch.from_numpy(array), 0.0)

            return tensor(out.origins_mm), tensor(out.directions), tensor(out.optical_path_mm), passes

        @staticmethod
        @torch.autograd.function.once_differentiable  # type: ignore[untyped-decorator]
        def backward(ctx: Any, grad_origins: Any, grad_directions: Any, grad_paths: Any, _: Any) -> Any:
            inputs = ctx.saved_tensors  # origins, directions, values
            found = backpropagate_rays(
                ctx.changed,
                numbers(inputs[0]),
                numbers(inputs[1]),
                listed,
                of_origins=grad_origins.numpy(),
                of_directions=grad_directions.numpy(),
                of_optical_paths=grad_paths.numpy(),
                wavelength_nm=wavelength_nm,
                start=start,
            )
            parts = found.by_origins, found.by_directions, found.by
            return tuple(torch.from_numpy(part).to(to.dtype) for part, to in zip(parts, inputs, strict=True))

    return Trace.apply(origins_mm, directions, values)  # type: ignore[no-any-return]
