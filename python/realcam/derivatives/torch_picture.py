"""Pictures as a function of torch.autograd: rc.torch_render. Needs the package torch."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .._core import Camera, InputError, RenderSettings, Scene
from ..settings import MAX_SEED, MAX_SPP, whole_number
from .camera_parameters import CameraParameters
from .picture import Parameter, final_settings

if TYPE_CHECKING:
    import torch
    from typing_extensions import Unpack

    from .._core import _SettingsKwargs


def torch_render(
    scene: Scene,
    cameras: Camera | Sequence[Camera],
    parameters: Mapping[Parameter, torch.Tensor],
    *,
    gradient_seed: int | None = None,
    gradient_spp: int | None = None,
    device: str = "auto",
    settings: RenderSettings | None = None,
    **changes: Unpack[_SettingsKwargs],
) -> torch.Tensor:
    """Pictures of cameras, lux seconds, differentiable by torch.autograd with respect to the cameras' parameters.

    cameras: one Camera, or B of them with films of one resolution. parameters: tensors of values by parameter, see
    CameraParameters; each is one number for all cameras, or (B,). One Camera with tensors (B,) is B cameras. device, of
    pictures and gradients, settings, changes: as for rc.render_gradient. Tensors are in host memory for all devices.
    Returns (B, H, W, 3), float32; (H, W, 3) for one Camera with single numbers.

    Backward is one pass of rc.render_gradient per camera for all parameters. Its samples, gradient_spp per pixel (None:
    spp) of gradient_seed (None: derived from seed), are independent of those of the picture: the gradient of any loss
    that is at most quadratic in the picture is unbiased. Camera i has seed + i and gradient_seed + i. Second
    derivatives are not supported.
    Raises InputError for parameters that cannot be set, for counts and seeds out of range, and for tensors of other
    types and shapes or on other devices than the CPU; ImportError without torch.
    """
    if gradient_spp is not None:
        gradient_spp = whole_number("gradient_spp", gradient_spp, 1, MAX_SPP)
    if gradient_seed is not None:
        gradient_seed = whole_number("gradient_seed", gradient_seed, 0, MAX_SEED)
    try:
        import torch
    except ImportError as error:
        raise ImportError("realcam.torch_render needs PyTorch: pip install realcam[torch]") from error

    if not isinstance(parameters, Mapping):
        raise InputError(f"parameters must be a dict of tensors; found a {type(parameters).__name__}")
    for parameter, tensor in parameters.items():
        if not isinstance(tensor, torch.Tensor) or tensor.is_complex() or tensor.dtype == torch.bool:
            found = getattr(tensor, "dtype", type(tensor).__name__)
            raise InputError(f"{parameter} must be a torch.Tensor of real numbers; found {found}")
    listed = [cameras] if isinstance(cameras, Camera) else list(cameras)
    counts = {len(tensor) for tensor in parameters.values() if tensor.ndim == 1}
    is_single = isinstance(cameras, Camera) and not counts
    count = counts.pop() if isinstance(cameras, Camera) and counts else len(listed)
    listed = listed * count if isinstance(cameras, Camera) else listed
    for parameter, tensor in parameters.items():
        if tensor.shape not in ((), (count,)):
            raise InputError(f"{parameter} must have shape () or ({count},); found {tuple(tensor.shape)}")
        if tensor.device.type != "cpu":
            raise InputError(f"{parameter} must be in host memory; found a tensor on {tensor.device}")
    if len({camera.film.resolution for camera in listed}) != 1:
        raise InputError("expected at least one camera, and films of one resolution")
    families = [CameraParameters(camera, tuple(parameters)) for camera in listed]
    of_picture = final_settings(settings, changes)
    seed = of_picture.seed
    # Any offset gives independent random numbers.
    second_seed = (seed + 0x85EBCA6B) % 2**32 if gradient_seed is None else gradient_seed
    of_gradient = of_picture if gradient_spp is None else of_picture.with_(spp=gradient_spp)

    class Render(torch.autograd.Function):  # type: ignore[misc]
        @staticmethod
        def forward(ctx: Any, values: torch.Tensor) -> torch.Tensor:
            ctx.save_for_backward(values)
            pictures = [
                family.render(scene, row, device=device, settings=of_picture, seed=(seed + i) % 2**32)
                for i, (family, row) in enumerate(zip(families, values.numpy(), strict=True))
            ]
            return torch.from_numpy(np.stack(pictures))

        @staticmethod
        @torch.autograd.function.once_differentiable  # type: ignore[untyped-decorator]
        def backward(ctx: Any, adjoints: torch.Tensor) -> torch.Tensor:
            (values,) = ctx.saved_tensors
            rows = zip(families, values.numpy(), adjoints.numpy(), strict=True)
            gradients = [
                family.gradient(
                    scene, row, adjoint, device=device, settings=of_gradient, seed=(second_seed + i) % 2**32
                )
                for i, (family, row, adjoint) in enumerate(rows)
            ]
            return torch.from_numpy(np.stack(gradients))

    columns = [tensor.double().expand(count) for tensor in parameters.values()]
    pictures: torch.Tensor = Render.apply(torch.stack(columns, dim=1))
    return pictures[0] if is_single else pictures
