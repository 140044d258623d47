"""rc.torch_render beside rc.render_gradient and central differences with common random numbers."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
import realcam as rc

from .test_picture_gradient import ADJOINT, ERRORS, corner_camera, estimate, stripes


def test_torch_is_asked_for_in_one_line() -> None:
    code = "import sys; sys.modules['torch'] = None; import realcam as rc; rc.torch_render(None, [], {})"
    failed = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=100)
    assert failed.stderr.strip().endswith("realcam.torch_render needs PyTorch: pip install realcam[torch]")


@pytest.mark.parametrize(
    ("name", "value", "limits"),
    [
        ("gradient_spp", 0, "from 1 to 16777216"),
        ("gradient_spp", -1, "from 1 to 16777216"),
        ("gradient_spp", 2.5, "from 1 to 16777216"),
        ("gradient_seed", -1, "from 0 to 4294967295"),
    ],
)
def test_wrong_counts_and_seeds_are_refused(name: str, value: float, limits: str) -> None:
    with pytest.raises(rc.InputError, match=f"^{name} is {value}; expected a whole number {limits}$"):
        rc.torch_render(stripes(), corner_camera(), {}, **{name: value})


torch = pytest.importorskip("torch", reason="torch is an extra")

SETTINGS = {"max_bounces": 0, "spp": 16}


def test_pictures_are_those_of_the_cameras() -> None:
    scene, camera = stripes(), corner_camera()
    f_numbers = torch.tensor([4.0, 5.6])
    focus = torch.tensor(2.5)
    pictures = rc.torch_render(scene, camera, {"f_number": f_numbers, "focus_distance_m": focus}, seed=3, **SETTINGS)
    for i, f_number in enumerate((4.0, 5.6)):
        lens = camera.lens.focused(2.5).stopped_down(float(np.float32(f_number)))
        wanted = rc.CameraParameters(camera.replace(lens=lens), "up_m").render(scene, [0], seed=3 + i, **SETTINGS)
        np.testing.assert_array_equal(pictures[i].numpy(), wanted)
    single = rc.torch_render(scene, camera, {"f_number": torch.tensor(4.0)}, **SETTINGS)
    assert single.shape == (8, 8, 3) and single.dtype == torch.float32


@pytest.mark.slow
def test_gradient_of_a_loss_equals_differences() -> None:
    """gradcheck by differences that are larger than the noise: a loss that is quadratic in the pictures of two cameras,
    which share their focus. The two pictures of a product have different samples, so that the product is unbiased."""
    scene = stripes()
    cameras = [corner_camera(), corner_camera(5.6)]
    adjoints = torch.tensor(np.stack([ADJOINT, -ADJOINT]), dtype=torch.float32)
    start = np.array([2.1, 0.0, 0.01])  # focus distance, and right_m of both

    def loss(values: torch.Tensor, seed: int, spp: int) -> torch.Tensor:
        parameters = {"focus_distance_m": values[0], "right_m": values[1:]}
        first, second = (
            rc.torch_render(scene, cameras, parameters, seed=10 * seed + offset, max_bounces=0, spp=spp)
            for offset in (0, 5000)
        )
        return (adjoints * (first + 0.1 * first * second)).sum()

    def of_seed(seed: int) -> np.ndarray:
        values = torch.tensor(start, requires_grad=True)
        loss(values, seed, 32).backward()
        return values.grad.numpy()

    found, error = estimate(of_seed)
    for i, step in enumerate(np.diag([0.05, 2e-4, 2e-4])):

        def difference(seed: int, step: np.ndarray = step) -> np.ndarray:
            above, below = (loss(torch.tensor(start + sign * step), 100 + seed, 64) for sign in (1, -1))
            return np.array((above - below).item() / (2 * step.sum()))

        wanted, wanted_error = estimate(difference)
        assert abs(wanted) > 0
        assert abs(found[i] - wanted) < ERRORS * np.hypot(error[i], wanted_error), (i, found[i], wanted)


def test_backward_is_render_gradient_with_its_own_seed() -> None:
    scene, camera = stripes(), corner_camera()
    value = torch.tensor(2.0, requires_grad=True)
    picture = rc.torch_render(scene, camera, {"focus_distance_m": value}, gradient_seed=7, gradient_spp=4, **SETTINGS)
    (picture * torch.tensor(ADJOINT)).sum().backward()
    wanted = rc.render_gradient(scene, camera, "focus_distance_m", ADJOINT, seed=7, spp=4, max_bounces=0)
    assert value.grad is not None and value.grad.item() == pytest.approx(wanted[0], rel=1e-5)


def test_pictures_run_on_the_device_that_is_named() -> None:
    with pytest.raises(rc.InputError, match="tpu"):
        rc.torch_render(stripes(), corner_camera(), {"up_m": torch.tensor(0.0)}, device="tpu", **SETTINGS)


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"f_number": torch.zeros(2, 2)}, r"f_number must have shape \(\) or \(1,\); found \(2, 2\)"),
        ({"f_number": torch.ones(2), "up_m": torch.ones(3)}, "must have shape"),
        ({"f_number": 4.0}, "f_number must be a torch.Tensor of real numbers; found float"),
        ({"f_number": np.array(4.0)}, "f_number must be a torch.Tensor of real numbers; found float64"),
        ({"f_number": torch.tensor(4 + 0j)}, "f_number must be a torch.Tensor of real numbers; found torch.complex64"),
        ([torch.tensor(4.0)], "parameters must be a dict of tensors; found a list"),
        ({"zoom": torch.tensor(1.0)}, "unknown parameter 'zoom'"),
        ({"up_m": torch.tensor(1.0, device="meta")}, "must be in host memory"),
    ],
)
def test_wrong_tensors_are_refused(parameters: object, message: str) -> None:
    with pytest.raises(rc.InputError, match=message):
        rc.torch_render(stripes(), corner_camera(), parameters, **SETTINGS)
