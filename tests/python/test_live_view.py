"""The live view: frames in flight on a GPU."""

from __future__ import annotations

import threading
import time

import numpy as np
import pytest
import realcam as rc
from realcam.bench import frame_scene

HAS_GPU = any(line.startswith("cuda:") for line in rc.devices())
needs_gpu = pytest.mark.skipif(not HAS_GPU, reason="no GPU on this machine")

LENS = rc.Lens.load("tessar-50mm").focused(4.0)


def camera(x: float = 0.0, **options: float) -> rc.Camera:
    return rc.Camera(LENS, film=rc.Film(36, 24, (90, 60)), position=(x, 1, 3), look_at=(0, 0.6, -2), **options)


@pytest.fixture(scope="module")
def scene() -> rc.Scene:
    return frame_scene(spheres=5, boxes=5)


def test_a_live_view_on_the_cpu_is_refused(scene: rc.Scene) -> None:
    with pytest.raises(rc.DeviceError, match="GPU"):
        rc.LiveView(scene, device="cpu")


@pytest.mark.skipif(HAS_GPU, reason="there is a GPU")
def test_without_a_gpu_the_reason_is_given(scene: rc.Scene) -> None:
    with pytest.raises(rc.DeviceError, match=r"driver|CUDA|GPU"):
        rc.LiveView(scene)


@needs_gpu
@pytest.mark.gpu
def test_frames_collect_the_samples_of_one_picture(scene: rc.Scene) -> None:
    live = rc.LiveView(scene, seed=3, max_bounces=1)
    frames = [live.shoot(camera(), spp=8) for _ in range(4)]
    assert [frame.samples for frame in frames] == [8, 16, 24, 32]
    whole = rc.render(scene, camera(), spp=32, seed=3, max_bounces=1, device="cuda")
    expected = rc._core.develop(whole.pixels, camera().iso)
    # Sums in double in another order: a code may change where a value lies on its border.
    assert np.abs(frames[-1].codes.astype(int) - expected).max() <= 1
    assert not frames[-1].codes.flags.writeable


@needs_gpu
@pytest.mark.gpu
def test_another_camera_begins_anew_and_another_exposure_does_not(scene: rc.Scene) -> None:
    live = rc.LiveView(scene)
    live.shoot(camera(), spp=4)
    assert live.shoot(camera(exposure_time_s=0.5), spp=4).samples == 8
    assert live.shoot(camera(x=0.1), spp=4).samples == 4
    assert live.shoot(camera(x=500.0), spp=4).samples == 4  # far away: the scene is placed anew


@needs_gpu
@pytest.mark.gpu
def test_the_picture_on_the_gpu_is_that_of_render(scene: rc.Scene) -> None:
    live = rc.LiveView(scene, seed=3, max_bounces=1)
    with pytest.raises(rc.InputError, match="no picture yet"):
        live.picture()
    for _ in range(2):
        live.shoot(camera(exposure_time_s=0.25), spp=8)
    pixels, depth = live.picture()
    whole = rc.render(scene, camera(exposure_time_s=0.25), spp=16, seed=3, max_bounces=1, device="cuda:0")
    assert pixels.device == "cuda:0"
    np.testing.assert_allclose(pixels.numpy(), whole.pixels, rtol=1e-6)
    np.testing.assert_allclose(depth.numpy(), whole.depth, rtol=1e-6)
    torch = pytest.importorskip("torch")
    shared = torch.from_dlpack(pixels)
    assert shared.data_ptr() == pixels.__cuda_array_interface__["data"][0]
    # It outlives the view, and what the view collects next does not change it.
    before = shared.sum().item()
    live.shoot(camera(exposure_time_s=0.25), spp=8).codes  # noqa: B018
    del live, pixels
    assert shared.sum().item() == before


@needs_gpu
@pytest.mark.gpu
def test_an_object_moves_between_frames(scene: rc.Scene) -> None:
    ball = frame_scene(spheres=1, boxes=0)
    scene = scene.with_instance(ball, name="ball")
    live = rc.LiveView(scene)
    assert live.shoot(camera(), spp=4).samples == 4
    for x in (0.2, -0.4):
        matrix = np.diag([0.5, 0.5, 0.5, 1.0])
        matrix[0, 3] = x
        scene = scene.moved("ball", matrix)
        live.show(scene)
        frame = live.shoot(camera(), spp=64)
        assert frame.samples == 64
        expected = rc._core.develop(rc.render(scene, camera(), spp=64, device="cuda").pixels, camera().iso)
        # The hierarchy was refitted here and built there: a hit at an edge may be another, nothing else.
        assert (np.abs(frame.codes.astype(int) - expected) > 1).mean() < 1e-3
    live.show(frame_scene(spheres=2, boxes=2))
    other = live.shoot(camera(), spp=64).codes
    assert (np.abs(other.astype(int) - expected) > 1).mean() > 0.01


@needs_gpu
@pytest.mark.gpu
def test_frames_outlive_their_view_and_do_not_share_memory(scene: rc.Scene) -> None:
    live = rc.LiveView(scene)
    codes = [live.shoot(camera(x=0.5 * i), spp=4).codes for i in range(6)]
    copies = [c.copy() for c in codes]
    for i in range(6):
        live.shoot(camera(x=-0.5 * i), spp=4).codes  # noqa: B018
    del live
    for now, then in zip(codes, copies, strict=True):
        np.testing.assert_array_equal(now, then)
    assert (copies[0] != copies[5]).any()


@needs_gpu
@pytest.mark.gpu
def test_cancel_from_another_thread(scene: rc.Scene) -> None:
    live = rc.LiveView(scene, max_bounces=8)
    wide = rc.Camera(LENS, film=rc.Film(36, 24, (1200, 800)), position=(0, 1, 3), look_at=(0, 0.6, -2))
    live.shoot(wide, spp=1).codes  # noqa: B018
    frame = live.shoot(wide, spp=1 << 18)  # minutes
    threading.Timer(0.2, live.cancel).start()
    start = time.perf_counter()
    with pytest.raises(rc.Cancelled):
        frame.codes  # noqa: B018
    assert time.perf_counter() - start < 30
    assert live.shoot(wide, spp=1).samples == 1
