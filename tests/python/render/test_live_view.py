"""The live view: frames in flight, on a GPU and on the CPU."""

from __future__ import annotations

import threading
import time
from typing import Any

import numpy as np
import pytest
import realcam as rc
from frame_scene import frame_scene

from ..device_memory import GPUS, needs_gpu

on_each = pytest.mark.parametrize("on", ["cpu", pytest.param("cuda:0", marks=[needs_gpu, pytest.mark.gpu])])

LENS = rc.Lens.load("tessar-50mm").focused(4.0)


def camera(x: float = 0.0, **options: float) -> rc.Camera:
    return rc.Camera(LENS, film=rc.Film(36, 24, (90, 60)), position=(x, 1, 3), look_at=(0, 0.6, -2), **options)


@pytest.fixture(scope="module")
def scene() -> rc.Scene:
    return frame_scene(spheres=5, boxes=5)


def test_devices_of_a_live_view(scene: rc.Scene) -> None:
    assert rc.LiveView(scene, device="auto").shoot(camera()).samples == 1
    with pytest.raises(rc.InputError, match="frames are taken on a single GPU"):
        rc.LiveView(scene, device="cuda:0,1")


@pytest.mark.skipif(bool(GPUS), reason="there is a GPU")
def test_without_a_gpu_the_reason_is_given(scene: rc.Scene) -> None:
    with pytest.raises(rc.DeviceError, match=r"driver|CUDA|GPU"):
        rc.LiveView(scene, device="cuda")


@on_each
def test_frames_collect_the_samples_of_one_picture(scene: rc.Scene, on: str) -> None:
    live = rc.LiveView(scene, device=on, seed=3, max_bounces=1)
    frames = [live.shoot(camera(), spp=8) for _ in range(4)]
    assert [frame.samples for frame in frames] == [8, 16, 24, 32]
    whole = rc.render(scene, camera(), effects=(), spp=32, seed=3, max_bounces=1, device=on)
    expected = rc._core.develop(whole.pixels, camera().iso)
    # Sums in double in another order: a code may change where a value lies on its border.
    assert np.abs(frames[-1].codes.astype(int) - expected).max() <= 1
    assert not frames[-1].codes.flags.writeable


@on_each
def test_a_view_that_stands_still_after_focusing_is_any_sessions_picture(scene: rc.Scene, on: str) -> None:
    live = rc.LiveView(scene, device=on, seed=3, max_bounces=1)
    for distance in (2.0, 2.01, 2.02):
        camera_now = camera().replace(lens=LENS.focused(distance))
        first = live.shoot(camera_now, spp=8)
    assert first.samples == 8
    samples = [live.shoot(camera_now, spp=8).samples for _ in range(3)]
    # On a GPU, the pupils of the moving lens were found near one another.
    assert samples == ([16, 24, 32] if on == "cpu" else [8, 16, 24])
    whole = rc.render(scene, camera_now, effects=(), spp=samples[-1], seed=3, max_bounces=1, device=on)
    # The samples are the same, and float sums are in another order; another pupil table would differ by 1e-4.
    np.testing.assert_allclose(live.image().pixels, whole.pixels, rtol=2e-6, atol=1e-9)


@on_each
@pytest.mark.parametrize("effects", [["dispersion"], ["diffraction"], ["coatings", "ghosts"]])
def test_frames_have_the_effects_that_are_named(scene: rc.Scene, on: str, effects: list[str]) -> None:
    live = rc.LiveView(scene, device=on, seed=3)
    plain = live.shoot(camera(), spp=8)
    frame = live.shoot(camera(), spp=8, effects=effects)
    assert (plain.samples, frame.samples) == (8, 8)  # another picture
    whole = rc.render(scene, camera(), effects=effects, spp=8, seed=3, max_bounces=1, device=on)
    expected = rc._core.develop(whole.pixels, camera().iso)
    # Sums in double in another order: a code may change where a value lies on its border.
    assert np.abs(frame.codes.astype(int) - expected).max() <= 1
    assert np.abs(frame.codes.astype(int) - plain.codes).max() > 3
    with pytest.raises(rc.InputError, match="sharpness"):
        live.shoot(camera(), effects=["sharpness"])


def live_picture_of(scene: rc.Scene, device: str) -> tuple[rc.LiveView, Any, Any]:
    """A view, and pixels and depth of two frames, which are those of render."""
    live = rc.LiveView(scene, device=device, seed=3, max_bounces=1)
    with pytest.raises(rc.InputError, match="no picture yet"):
        live.picture()
    quarter = camera(exposure_time_s=0.25)
    for _ in range(2):
        live.shoot(quarter, spp=8)
    taken = live.picture()
    whole = rc.render(scene, quarter, effects=(), spp=16, seed=3, max_bounces=1, device=device)
    for found, expected in zip(taken, (whole.pixels, whole.depth), strict=True):
        assert found.dtype == np.float32
        np.testing.assert_allclose(np.asarray(found), expected, rtol=1e-6)  # sums in double, of 8 and 8 samples
    return live, *taken


def test_the_picture_on_the_cpu_is_that_of_render(scene: rc.Scene) -> None:
    live, pixels, _ = live_picture_of(scene, "cpu")
    assert isinstance(pixels, np.ndarray)
    # Later samples of the view must not change this array.
    before = pixels.copy()
    live.shoot(camera(), spp=8).codes  # noqa: B018
    del live
    np.testing.assert_array_equal(pixels, before)


def test_a_frame_on_the_cpu_is_under_way_while_others_work(scene: rc.Scene) -> None:
    live = rc.LiveView(scene, device="cpu", max_bounces=8)
    frame = live.shoot(camera(), spp=1 << 20)  # minutes
    assert not frame.ready
    assert rc.render(scene, camera(), effects=(), spp=1, device="cpu").spp == 1
    live.cancel()
    assert frame.ready
    with pytest.raises(rc.Cancelled):
        frame.codes  # noqa: B018
    with pytest.raises(rc.InputError, match="no picture yet"):
        live.picture()
    assert live.shoot(camera(), spp=1).samples == 1


def test_cancel_on_the_cpu_by_many_threads_at_once(scene: rc.Scene) -> None:
    live = rc.LiveView(scene, device="cpu", max_bounces=8)
    for _ in range(5):
        frame = live.shoot(camera(), spp=1 << 20)
        waiting: list[str] = []

        def wait_for(frame: rc.LiveFrame = frame, waiting: list[str] = waiting) -> None:
            try:
                live.shoot(camera(x=1.0), spp=1 << 20).codes  # noqa: B018
            except rc.Cancelled:
                waiting.append("another frame")
            try:
                frame.codes  # noqa: B018
            except rc.Cancelled:
                waiting.append("the frame")

        other = threading.Thread(target=wait_for)
        other.start()
        time.sleep(0.1)
        threads = [threading.Thread(target=live.cancel) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        # One that had not been shot by then goes on.
        while other.is_alive():
            live.cancel()
            other.join(0.1)
        assert waiting == ["another frame", "the frame"]
        assert live.shoot(camera(), spp=1).codes.any()


def test_a_view_may_go_with_a_frame_under_way(scene: rc.Scene) -> None:
    frame = rc.LiveView(scene, device="cpu", max_bounces=8).shoot(camera(), spp=1 << 20)
    with pytest.raises(rc.Cancelled):
        frame.codes  # noqa: B018


def test_wrong_frames_are_refused(scene: rc.Scene) -> None:
    live = rc.LiveView(scene, device="cpu")
    with pytest.raises(rc.InputError, match="spp"):
        live.shoot(camera(), spp=0)
    with pytest.raises(rc.InputError, match="tone curve"):
        live.shoot(camera(), tone="sepia")
    assert live.shoot(camera(), spp=2).samples == 2


@needs_gpu
@pytest.mark.gpu
def test_the_picture_on_the_gpu_is_that_of_render(scene: rc.Scene) -> None:
    live, pixels, _ = live_picture_of(scene, "cuda")
    assert pixels.device == "cuda:0"
    torch = pytest.importorskip("torch")
    shared = torch.from_dlpack(pixels)
    assert shared.data_ptr() == pixels.__cuda_array_interface__["data"][0]
    # The tensor outlives the view, and later samples of the view do not change it.
    before = shared.sum().item()
    live.shoot(camera(exposure_time_s=0.25), spp=8).codes  # noqa: B018
    del live, pixels
    assert shared.sum().item() == before


@on_each
def test_an_object_moves_between_frames(scene: rc.Scene, on: str) -> None:
    ball = frame_scene(spheres=1, boxes=0)
    scene = scene.with_instance(ball, name="ball")
    live = rc.LiveView(scene, device=on)
    assert live.shoot(camera(), spp=4).samples == 4
    for x in (0.2, -0.4):
        matrix = np.diag([0.5, 0.5, 0.5, 1.0])
        matrix[0, 3] = x
        scene = scene.moved("ball", matrix)
        live.show(scene)
        frame = live.shoot(camera(), spp=64)
        assert frame.samples == 64
        expected = rc._core.develop(
            rc.render(scene, camera(), effects=(), spp=64, max_bounces=1, device=on).pixels, camera().iso
        )
        # The hierarchy was refitted here and built there: a hit at an edge may be another, nothing else.
        assert (np.abs(frame.codes.astype(int) - expected) > 1).mean() < 1e-3
    live.show(frame_scene(spheres=2, boxes=2))
    other = live.shoot(camera(), spp=64).codes
    assert (np.abs(other.astype(int) - expected) > 1).mean() > 0.01


@on_each
def test_frames_outlive_their_view_and_do_not_share_memory(scene: rc.Scene, on: str) -> None:
    live = rc.LiveView(scene, device=on)
    codes = [live.shoot(camera(x=0.5 * i), spp=4).codes for i in range(6)]
    copies = [c.copy() for c in codes]
    for i in range(6):
        live.shoot(camera(x=-0.5 * i), spp=4).codes  # noqa: B018
    del live
    for now, then in zip(codes, copies, strict=True):
        np.testing.assert_array_equal(now, then)
    assert (copies[0] != copies[5]).any()


WIDE = rc.Camera(LENS, film=rc.Film(36, 24, (1200, 800)), position=(0, 1, 3), look_at=(0, 0.6, -2))


def seconds_of_one_sample(live: rc.LiveView) -> float:
    """Time for one sample of each pixel of WIDE. No stop takes longer; it scales with tools that slow the GPU down."""
    live.shoot(WIDE, spp=1).codes  # noqa: B018
    start = time.perf_counter()
    live.shoot(WIDE, spp=1).codes  # noqa: B018
    return time.perf_counter() - start


@needs_gpu
@pytest.mark.gpu
def test_cancel_takes_milliseconds(scene: rc.Scene) -> None:
    live = rc.LiveView(scene, max_bounces=8, device="cuda")
    one_sample = seconds_of_one_sample(live)
    for _ in range(3):
        frame = live.shoot(WIDE, spp=1 << 18)  # minutes
        time.sleep(0.1)
        start = time.perf_counter()
        live.cancel()
        # Each thread finishes the sample that it has begun. The remaining time allows for calls, for blocks that only
        # check the flag, and for a busy host.
        assert time.perf_counter() - start < 0.03 + 2 * one_sample
        with pytest.raises(rc.Cancelled):
            frame.codes  # noqa: B018
    with pytest.raises(rc.InputError, match="no picture yet"):
        live.picture()
    assert live.shoot(WIDE, spp=1).samples == 1


@needs_gpu
@pytest.mark.gpu
def test_cancel_from_another_thread(scene: rc.Scene) -> None:
    live = rc.LiveView(scene, max_bounces=8, device="cuda")
    one_sample = seconds_of_one_sample(live)
    frames = [live.shoot(WIDE, spp=1 << 18) for _ in range(3)]
    # The fourth waits for the first, which the stop ends.
    timer = threading.Timer(0.2, live.cancel)
    timer.start()
    start = time.perf_counter()
    live.shoot(WIDE, spp=1 << 18)
    for frame in frames:
        with pytest.raises(rc.Cancelled):
            frame.codes  # noqa: B018
    assert time.perf_counter() - start < 0.3 + 4 * one_sample
    timer.join()
    assert live.shoot(WIDE, spp=1).samples == 1


@needs_gpu
@pytest.mark.gpu
def test_cancel_leaves_a_whole_frame_or_none(scene: rc.Scene) -> None:
    live, spp = rc.LiveView(scene, seed=3, device="cuda"), 2048
    live.shoot(camera(), spp=1).codes  # noqa: B018
    live.cancel()
    start = time.perf_counter()
    live.shoot(camera(), spp=spp)
    exposure, depth = (array.numpy() for array in live.picture())
    whole = time.perf_counter() - start
    codes = live.shoot(camera(), spp=spp).codes  # of twice the samples
    seen = {"whole": 0, "stopped": 0}
    for i in range(12):
        live.cancel()
        live.shoot(camera(), spp=spp)
        second = live.shoot(camera(), spp=spp)
        # The cancellation comes at times from before the first frame's end to after the second's.
        stop = threading.Timer(whole * i / 4, live.cancel)
        stop.start()
        try:
            np.testing.assert_array_equal(second.codes, codes)
            seen["whole"] += 1
        except rc.Cancelled:
            seen["stopped"] += 1
        stop.join()
        live.shoot(camera(), spp=spp)
        stop = threading.Timer(whole * i / 8, live.cancel)
        stop.start()
        try:
            pixels, distances = live.picture()
            np.testing.assert_allclose(pixels.numpy(), exposure, rtol=1e-6)
            np.testing.assert_allclose(distances.numpy(), depth, rtol=1e-6)
            seen["whole"] += 1
        except rc.Cancelled:
            seen["stopped"] += 1
        except rc.InputError as error:
            assert "no picture yet" in str(error)  # the stop came first
        stop.join()
    assert min(seen.values()) > 0, seen


@needs_gpu
@pytest.mark.gpu
def test_cancel_by_many_threads_at_once(scene: rc.Scene) -> None:
    live = rc.LiveView(scene, max_bounces=8, device="cuda")
    for _ in range(10):
        frame = live.shoot(WIDE, spp=1 << 18)
        threads = [threading.Thread(target=live.cancel) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        with pytest.raises(rc.Cancelled):
            frame.codes  # noqa: B018
        assert live.shoot(WIDE, spp=1).codes.any()


@needs_gpu
@pytest.mark.gpu
@pytest.mark.slow
def test_a_view_left_alone_counts_past_two_to_the_31() -> None:
    sky = rc.Scene.from_arrays([[0, 0, 1e5], [1e-3, 0, 1e5], [0, 1e-3, 1e5]], [[0, 1, 2]]).with_environment(100.0)
    pixel = rc.Camera(LENS, film=rc.Film(1e-3, 1e-3, (1, 1)), model="pinhole", exposure_time_s=0.01)
    live = rc.LiveView(sky, max_bounces=0, device="cuda")
    live.shoot(pixel, spp=1)
    first = live.picture()[0].numpy()
    for i in range(129):
        frame = live.shoot(pixel, spp=1 << 24)
        assert frame.samples == 1 + (i + 1) * (1 << 24)
    assert frame.samples > 1 << 31
    # Every sample sees the same sky, through a film of a micrometre: only their number could change the mean.
    np.testing.assert_allclose(live.picture()[0].numpy(), first, rtol=1e-5)
