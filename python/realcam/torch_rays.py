"""Rays for PyTorch: a lens as a differentiable function of its numbers and of the rays. Needs the package torch."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._core import InputError, Lens, Surface
from .derivatives.rays import ray_derivatives
from .variable import Variable, checked

if TYPE_CHECKING:
    import torch


SETTABLE = ("curvature", "thickness", "conic", "aspheric", "index", "tilt", "decentre")


def with_values(lens: Lens, variables: Sequence[Variable], values: Sequence[float]) -> Lens:
    """The lens with its variables set. Raises InputError for lenses that cannot be."""
    surfaces: dict[int, Surface] = {}
    for variable, value in zip(variables, values, strict=True):
        surface = surfaces.get(variable.surface, lens.surfaces[variable.surface])
        surfaces[variable.surface] = variable.set(surface, float(value))
    return lens.with_surfaces(surfaces)


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
    """Lens.trace of the lens with `values` (V,) for its variables, as a function that torch.autograd differentiates.

    origins_mm, directions: (N, 3), lens frame, of the host. variables: curvatures, thicknesses, conics, aspheric
    coefficients, indices, tilts and decentres.
    Returns origins, mm, and unit directions (N, 3), optical paths, mm (N,), in float64, and which rays pass (N,). Rays
    that do not are zero and have no derivatives. Derivatives are by origins, directions and values; of these there are
    no second ones. Raises InputError for what the lens has not, ImportError without torch.
    """
    import torch

    listed = checked(lens, variables)
    for variable in listed:
        if variable.quantity not in SETTABLE:
            raise InputError(f'a lens cannot be given a value of "{variable.quantity}"; {", ".join(SETTABLE)} can')
    if tuple(values.shape) != (len(listed),):
        raise InputError(f"values must be {len(listed)} numbers, one for each variable")
    for tensor in (origins_mm, directions, values):
        if tensor.device.type != "cpu":
            raise InputError(f"rays with derivatives are traced on the host, and a tensor lies on {tensor.device}")

    class Trace(torch.autograd.Function):  # type: ignore[misc]
        @staticmethod
        def forward(ctx: Any, o: torch.Tensor, d: torch.Tensor, v: torch.Tensor) -> Any:
            changed = with_values(lens, listed, v.detach().double().tolist())
            found = ray_derivatives(
                changed,
                o.detach().double().numpy(),
                d.detach().double().numpy(),
                listed,
                wavelength_nm=wavelength_nm,
                start=start,
            )
            passes = torch.from_numpy(found.status == 0)

            def tensor(array: np.ndarray) -> torch.Tensor:
                return torch.from_numpy(np.nan_to_num(array, nan=0.0))

            by = np.concatenate([found.origins_by, found.directions_by, found.optical_path_by[:, None]], axis=1)
            by_start = np.concatenate(
                [found.origins_by_start, found.directions_by_start, found.optical_path_by_start[:, None]], axis=1
            )
            ctx.save_for_backward(tensor(by), tensor(by_start))
            ctx.types = o.dtype, d.dtype, v.dtype
            ctx.mark_non_differentiable(passes)
            return tensor(found.origins_mm), tensor(found.directions), tensor(found.optical_path_mm), passes

        @staticmethod
        @torch.autograd.function.once_differentiable  # type: ignore[untyped-decorator]
        def backward(ctx: Any, of_origins: Any, of_directions: Any, of_paths: Any, _: Any) -> Any:
            by, by_start = ctx.saved_tensors
            change = torch.cat([of_origins, of_directions, of_paths[:, None]], dim=1)
            of_start = torch.einsum("nr,nrs->ns", change, by_start)
            of_values = torch.einsum("nr,nrv->v", change, by)
            o, d, v = ctx.types
            return of_start[:, :3].to(o), of_start[:, 3:].to(d), of_values.to(v)

    return Trace.apply(origins_mm, directions, values)  # type: ignore[no-any-return]
