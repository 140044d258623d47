"""rc.Session: adding samples step by step, changes that start a new picture and changes that do not, and stopping."""

from __future__ import annotations

import threading
import time

import numpy as np
import pytest
import realcam as rc

from .. import scenes

LENS = rc.Lens.load("tessar-50mm").focused(3.0)


def camera(columns: int = 40, rows: int = 30, x: float = 0.0, **more: object) -> rc.Camera:
    return rc.Camera(LENS, film=rc.Film(36, 27, (columns, rows)), position=(x, 0, 0), **{"exposure_time_s": 1, **more})


def room(lamp: float = 50.0) -> rc.Scene:
    wall = scenes.quad((0, 0, -3), 3, diffuse=0.6)
    return scenes.scene_of(wall, scenes.quad((0.3, 0.4, -2), 0.2, emission=lamp)).with_environment(1.0)


def test_added_samples_are_those_of_one_render(device: str) -> None:
    session = rc.Session(room(), camera(), device=device, seed=5, max_bounces=2, effects=())
    for spp in (256, 256, 88):
        session.add(spp)
    whole = rc.render(room(), camera(), effects=(), spp=600, device=device, seed=5, max_bounces=2)
    image = session.image()
    if device == "cpu":  # which adds up in steps of 256 samples in both cases
        assert image == whole
    np.testing.assert_allclose(image.pixels, whole.pixels, rtol=1e-6)  # sums in double, in another order
    np.testing.assert_allclose(image.depth, whole.depth, rtol=1e-6)
    assert (image.spp, image.seed, image.camera) == (600, 5, camera())
    assert image.stats.sampled_rays == whole.stats.sampled_rays
    assert image.stats.device == whole.stats.device
    assert image.stats.seconds >= image.stats.setup_seconds > 0


def lamps() -> tuple[rc.Scene, rc.Camera]:
    """A bright lamp, which wants ghosts of a coated lens, and a camera that can turn away from it."""
    lens = rc.Lens.load("double-gauss-50mm").focused(3.0).with_coating("bare")
    lamp = scenes.quad((0.3, 0.4, -2), 0.05, emission=1e5)
    view = rc.Camera(lens, film=rc.Film(36, 27, (40, 30)), exposure_time_s=0.01)
    return scenes.scene_of(scenes.quad((0, 0, -3), 3, diffuse=0.6), lamp).with_environment(50.0), view


def test_a_session_plans_as_render_does_and_anew_for_another_picture() -> None:
    scene, view = lamps()
    away = view.replace(position=(0, 0, -2.5), look_at=(0, 0, -3))
    session = rc.Session(scene, view, device="cpu")
    before = session.effects
    session.add(8)
    assert session.image() == rc.render(scene, view, spp=8, device="cpu")
    assert session.image().plan != ""
    assert before != ()
    session.set(camera=session.camera.replace(position=(0, 0, -2.5), look_at=(0, 0, -3)))
    session.add(4)
    whole = rc.render(scene, away, spp=4, device="cpu")
    assert session.image() == whole
    assert session.effects == whole.effects != before
    # The dials of the exposure begin no new picture, and change no plan.
    session.set(camera=session.camera.replace(iso=800))
    assert session.image().spp == 4
    assert session.effects == whole.effects
    dull = scenes.scene_of(scenes.quad((0, 0, -3), 3, diffuse=0.6)).with_environment(50.0)
    session.set(scene=dull)
    assert session.effects == rc.render(dull, away.replace(iso=800), spp=1, device="cpu").effects


def test_samples_of_each_pixel(device: str) -> None:
    session = rc.Session(room(), camera(), device=device, effects=())
    assert (session.samples.shape, session.samples.dtype) == ((30, 40), np.int64)
    assert (session.samples == 0).all()
    with pytest.raises(rc.InputError, match="no picture yet"):
        session.image()
    session.add(3)
    session.add()
    assert (session.samples == 4).all()


def test_another_picture_begins_anew_and_another_exposure_does_not(device: str) -> None:
    session = rc.Session(room(), camera(), device=device, effects=())
    session.add(8)
    before = session.image()
    session.set(camera=camera(exposure_time_s=0.25, iso=800))
    after = session.image()
    assert after.spp == 8
    np.testing.assert_array_equal(after.pixels, before.pixels / 4)  # a power of two: the same digits
    session.set(camera=camera(x=0.1))
    assert not session.samples.any()
    session.add(8)
    np.testing.assert_array_equal(
        session.image().pixels, rc.render(room(), camera(x=0.1), effects=(), spp=8, device=device).pixels
    )
    session.set(scene=room(lamp=100.0), camera=camera(20, 15))
    assert session.samples.shape == (15, 20)
    session.add(8)
    expected = rc.render(room(lamp=100.0), camera(20, 15), effects=(), spp=8, device=device)
    np.testing.assert_array_equal(session.image().pixels, expected.pixels)


def test_what_makes_no_picture_is_refused_and_what_was_collected_stays(device: str) -> None:
    session = rc.Session(room(), camera(), device=device, effects=())
    session.add(2)
    for spp in (0, -1, 1 << 25):
        with pytest.raises(rc.InputError, match="spp"):
            session.add(spp)
    assert (session.samples == 2).all()
    with pytest.raises(rc.InputError, match="too small for pictures"):
        session.set(camera=camera().replace(lens=LENS.stopped_down(1e5)))
    assert session.camera == camera()
    session.add(2)  # of the camera that was set before, from its first sample on
    assert (session.samples == 2).all()
    with pytest.raises(rc.InputError, match="toaster"):
        rc.Session(room(), camera(), device="toaster", effects=())
    for wrong in ({"camera": 3}, {"scene": 3}):
        with pytest.raises(rc.ArgumentError, match="must be a"):
            session.set(**wrong)  # type: ignore[arg-type]
    assert (session.samples == 2).all()


def test_a_scene_without_light_is_told() -> None:
    dark = scenes.scene_of(scenes.quad((0, 0, -3), 3))
    with pytest.warns(UserWarning, match="no light") as told:
        session = rc.Session(dark, camera(4, 3), device="cpu", effects=())
    with pytest.warns(UserWarning, match="no light") as told_again:
        session.set(scene=scenes.scene_of(scenes.quad((0, 0, -3), 2)))
    assert {warning.filename for warning in (*told, *told_again)} == {__file__}


def add_until_stopped(session: rc.Session, seconds: float) -> None:
    """Adds samples that would take minutes, and cancels them."""
    stop = threading.Timer(seconds, session.cancel)
    stop.start()
    with pytest.raises(rc.Cancelled):
        session.add(1 << 24)
    stop.join()


def test_a_stop_keeps_what_was_taken(device: str) -> None:
    """Pixels then differ in their samples, and each is divided by its own: a constant field stays constant."""
    sky, wide = scenes.sky(), camera(400, 300)
    session = rc.Session(sky, wide, device=device, max_bounces=0, effects=())
    add_until_stopped(session, 0.3)
    samples = session.samples
    assert samples.max() > samples.min()
    image = session.image()
    assert image.spp == round(float(samples.mean()))
    taken = samples > 0
    assert (image.pixels[~taken] == 0).all()
    assert not np.isnan(image.pixels).any()
    many = samples >= 64
    expected = rc.render(sky, wide, effects=(), spp=64, max_bounces=0, device=device).pixels[many]
    # Weights of samples differ by natural vignetting within the pixel and rays that are lost at rims: by some percent.
    np.testing.assert_allclose(image.pixels[many], expected, rtol=0.2)
    session.add(1)
    assert (session.samples == samples + 1).all()


def test_a_stop_leaves_no_tile_half_done() -> None:
    """With dispersion, pixels share samples, so that all pixels of a tile must have the same samples."""
    session = rc.Session(room(), camera(200, 150), device="cpu", effects=("dispersion",))
    add_until_stopped(session, 0.3)
    samples = session.samples
    for row in range(0, 150, 32):
        for column in range(0, 200, 32):
            assert len(np.unique(samples[row : row + 32, column : column + 32])) == 1


def test_threads_take_turns() -> None:
    session = rc.Session(room(), camera(), device="cpu", effects=())
    threads = [threading.Thread(target=session.add, args=(8,)) for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert (session.samples == 48).all()
    whole = rc.render(room(), camera(), effects=(), spp=48, device="cpu")
    # The samples are the same, summed in groups of 8.
    np.testing.assert_allclose(session.image().pixels, whole.pixels, rtol=1e-6)


def test_cancel_ends_the_turn_of_another_thread_and_no_other() -> None:
    session = rc.Session(room(), camera(300, 200), device="cpu", effects=())
    session.cancel()  # nothing is under way
    session.add(1)
    ended: list[float] = []

    def work() -> None:
        with pytest.raises(rc.Cancelled):
            session.add(1 << 20)
        ended.append(time.monotonic())

    thread = threading.Thread(target=work)
    thread.start()
    time.sleep(0.3)
    session.cancel()
    thread.join(timeout=10)
    assert ended
    session.add(1)
    assert session.samples.min() >= 2
    other = rc.Session(room(), camera(30, 20), device="cpu", effects=())
    session.cancel()
    other.add(1)


def test_sessions_do_not_disturb_render_and_each_other() -> None:
    one, two = (rc.Session(room(lamp), camera(), device="cpu", effects=()) for lamp in (50.0, 5000.0))
    expected = [rc.render(room(lamp), camera(), effects=(), spp=16, device="cpu").pixels for lamp in (50.0, 5000.0)]
    for _ in range(2):
        one.add(8)
        rc.render(room(9.0), camera(x=1), effects=(), spp=1, device="cpu")
        two.add(8)
    for session, pixels in zip((one, two), expected, strict=True):
        np.testing.assert_allclose(session.image().pixels, pixels, rtol=1e-6)


def test_other_settings_are_those_of_another_render() -> None:
    session = rc.Session(room(), camera(), device="cpu", effects=())
    for settings in (rc.RenderSettings(spp=4, seed=2, effects=()), rc.RenderSettings(spp=4, layers="normal")):
        session.set(settings=settings)
        session.add(4)
        assert session.image() == rc.render(room(), camera(), settings, device="cpu")
