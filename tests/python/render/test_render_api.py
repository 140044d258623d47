"""rc.render: what it takes and returns, the same picture however it is computed, progress and stopping."""

from __future__ import annotations

import dataclasses
import os
import signal
import subprocess
import sys
import textwrap
import threading
from collections.abc import Callable

import numpy as np
import pytest
import realcam as rc

from .. import scenes


def small_scene() -> rc.Scene:
    lamp = scenes.quad((0.3, 1, -2), 0.3, right=(1, 0, 0), up=(0, 0, 1), emission=50)
    floor = scenes.quad((0, -0.5, -3), 3, right=(1, 0, 0), up=(0, 0, -1), diffuse=0.6)
    card = scenes.quad((0.1, -0.1, -2.2), 0.3, diffuse=(0.8, 0.4, 0.2), specular=0.1, shininess=20)
    return scenes.scene_of(lamp, floor, card).with_environment((1, 2, 3)).with_sun((0.2, -1, -0.3), (9, 9, 9))


def camera(columns: int = 80, rows: int = 70, model: str = "full") -> rc.Camera:
    lens = rc.Lens.load("double-gauss-50mm").focused(2.2)
    return rc.Camera(lens, film=rc.Film(24, 21, (columns, rows)), exposure_time_s=1, model=model)


def test_what_is_returned() -> None:
    taken_by = camera(31, 17)
    image = rc.render(small_scene(), taken_by, effects=(), spp=3, seed=4)
    assert (image.pixels.shape, image.pixels.dtype) == ((17, 31, 3), np.float32)
    assert (image.depth.shape, image.depth.dtype) == ((17, 31), np.float32)
    assert np.isfinite(image.pixels).all()
    assert (image.pixels >= 0).all()
    assert (image.camera is taken_by, image.spp, image.seed) == (True, 3, 4)
    stats = image.stats
    assert stats.sampled_rays <= 31 * 17 * 3
    assert 0 < stats.passed_rays <= stats.sampled_rays
    assert stats.scene_rays >= stats.passed_rays
    assert stats.seconds >= stats.setup_seconds > 0
    assert stats.device
    assert rc.devices()
    with pytest.raises(dataclasses.FrozenInstanceError):
        image.spp = 5  # type: ignore[misc]


@pytest.mark.parametrize("model", ["thin", "full"])
def test_same_seed_same_picture_whatever_the_number_of_threads(model: str) -> None:
    """Random numbers belong to pixel and sample, not to a thread or to the order of the tiles."""
    reference = rc.render(small_scene(), camera(model=model), effects=(), spp=20, seed=7, max_bounces=2, threads=1)
    for threads in (2, 3, 0):
        again = rc.render(
            small_scene(), camera(model=model), effects=(), spp=20, seed=7, max_bounces=2, threads=threads
        )
        # Only the order of sums within a pixel could differ: 20 sums in double, rounded to float32 once.
        np.testing.assert_allclose(again.pixels, reference.pixels, rtol=1e-6)
        np.testing.assert_array_equal(again.depth, reference.depth)
    other = rc.render(small_scene(), camera(model=model), effects=(), spp=20, seed=8, max_bounces=2)
    assert (other.pixels != reference.pixels).mean() > 0.5


def test_renders_side_by_side_do_not_disturb_each_other() -> None:
    alone = [rc.render(small_scene(), camera(), effects=(), spp=8, seed=seed).pixels for seed in range(3)]
    together: list[np.ndarray | None] = [None] * 3

    def work(seed: int) -> None:
        together[seed] = rc.render(small_scene(), camera(), effects=(), spp=8, seed=seed).pixels

    threads = [threading.Thread(target=work, args=(seed,)) for seed in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for expected, measured in zip(alone, together, strict=True):
        assert measured is not None
        np.testing.assert_allclose(measured, expected, rtol=1e-6)


def test_more_samples_than_one_visit_of_a_tile_continue_the_sequence() -> None:
    """Passes of up to 256 samples add up: every sample is used exactly once."""
    many = rc.render(small_scene(), camera(8, 7), effects=(), spp=700, seed=1).pixels
    thin = camera(8, 7, "thin")  # which stops no sample, so that nothing of it is balanced
    rays = thin.generate_rays(spp=700, seed=1)
    sky = rc.render(scenes.sky(), thin, effects=(), spp=700, seed=1).pixels[..., 0]
    expected = rays.weights.astype(np.float64).reshape(7, 8, 700).mean(axis=2)
    # 700 float32 weights, summed in double on both sides.
    np.testing.assert_allclose(sky, expected, rtol=1e-6)
    assert np.isfinite(many).all()


def test_film_of_one_pixel_and_of_odd_sizes() -> None:
    for size in ((1, 1), (33, 1), (1, 65), (31, 33)):
        image = rc.render(scenes.sky(), camera(*size), effects=(), spp=2)
        assert image.pixels.shape == (size[1], size[0], 3)
        assert (image.pixels > 0).mean() > 0.9


def test_progress_rises_from_0_to_1() -> None:
    seen: list[float] = []
    # Long enough for some reports: they come 20 times a second.
    rc.render(small_scene(), camera(400, 350), effects=(), spp=64, max_bounces=4, progress=seen.append)
    assert seen == sorted(seen)
    assert all(0 <= share <= 1 for share in seen)
    assert seen[-1] == 1.0


def small_picture() -> rc.Image:
    return rc.render(small_scene(), camera(4, 4), effects=(), spp=1)


def fails() -> None:
    raise LookupError("a mistake of the user's")


@pytest.mark.parametrize(
    ("answer", "error", "says"),
    [
        (lambda: False, rc.Cancelled, None),
        (small_picture, rc.InputError, "progress function"),  # one render within another
        (fails, LookupError, "a mistake of the user's"),
    ],
    ids=["stops", "renders", "fails"],
)
def test_a_progress_function_ends_the_picture_at_once(
    answer: Callable[[], object], error: type[Exception], says: str | None
) -> None:
    calls: list[float] = []

    def progress(done: float) -> object:
        calls.append(done)
        return answer()

    with pytest.raises(error, match=says):
        rc.render(small_scene(), camera(2000, 1700), effects=(), spp=20000, progress=progress)  # type: ignore[arg-type]
    assert len(calls) == 1
    assert calls[0] < 0.9
    # The backend has no leftover state.
    assert small_picture().pixels.shape == (4, 4, 3)


def test_progress_bar_says_nothing_where_there_is_no_terminal(capfd: pytest.CaptureFixture[str]) -> None:
    rc.render(small_scene(), camera(8, 8), effects=(), spp=1, progress=True)
    out, err = capfd.readouterr()
    assert (out, err.strip()) == ("", "")


@pytest.mark.skipif(os.name != "posix", reason="signals are sent to a process")
def test_ctrl_c_is_a_keyboard_interrupt() -> None:
    program = textwrap.dedent("""
        import sys, numpy as np, realcam as rc
        scene = rc.Scene.from_arrays(np.array([[-9, -9, -3], [9, -9, -3], [0, 9, -3.0]]), [[0, 1, 2]])
        camera = rc.Camera(rc.Lens.load("double-gauss-50mm"), film=rc.Film(36, 24, (2000, 1300)))
        try:
            print("started", flush=True)
            rc.render(scene.with_environment(1.0), camera, spp=100000)
        except KeyboardInterrupt:
            sys.exit(42)
    """)
    process = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None
        assert process.stdout.readline() == "started\n"
        # Just before the render or in it. The limit only keeps a failure from hanging.
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=60) == 42
    finally:
        process.kill()
        process.wait()
        process.stdout.close()
