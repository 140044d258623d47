"""The thread that photographs for a window of the lens bench."""

from __future__ import annotations

import math
import threading
import time
from dataclasses import replace

import numpy as np
import pytest
import realcam as rc

pytest.importorskip("simplejpeg")

from realcam.viewer.pictures.noise_measurement import NoiseMeasurement
from realcam.viewer.pictures.pace import Pace
from realcam.viewer.pictures.picture_loop import PictureLoop
from realcam.viewer.pictures.picture_request import Frame, PictureRequest

from .watched_loop import FILM, Watched, camera, codes_of


def test_a_picture_is_refined_to_the_noise_that_is_asked_for(watched: Watched) -> None:
    last = watched.photograph(PictureRequest(camera(), noise_codes=2.0))
    frames = watched.frames
    assert last.noise_codes is not None
    assert 0 < last.noise_codes <= 2.0
    assert (last.width, last.height) == FILM.resolution
    assert not last.is_preview
    assert [frame.is_final for frame in frames] == [False] * (len(frames) - 1) + [True]
    assert {frame.serial for frame in frames} == {1}
    sizes = [frame.width for frame in frames]
    assert sizes == sorted(sizes)
    whole = [frame.samples for frame in frames if not frame.is_preview]
    assert whole == sorted(set(whole))
    for frame in frames:
        assert codes_of(frame).shape == (frame.height, frame.width, 3)
        assert (frame.whole_width, frame.whole_height) == FILM.resolution
    assert last.costs is not None
    shares = last.costs.lens_share, last.costs.scene_share, last.costs.other_share
    assert sum(shares) == pytest.approx(1)
    assert 0 < last.costs.passing_share <= 1
    finer = watched.photograph(PictureRequest(camera(), noise_codes=1.0))
    assert finer.samples > last.samples


@pytest.mark.slow
def test_the_time_that_is_left_is_told_truly(watched: Watched) -> None:
    """In the second half, the reported time is right within a factor of two: the square of the noise is estimated to
    two fifths, and the load of a machine varies."""
    told: list[tuple[float, float | None]] = []
    take = watched._take
    watched.loop._encoder._on_frame = lambda frame: (told.append((time.monotonic(), frame.left_s)), take(frame))
    watched.photograph(PictureRequest(camera(film=rc.Film(36, 24, (240, 160))), noise_codes=0.5))
    (begun, _), (ended, last) = told[0], told[-1]
    assert last == 0
    late = [(ended - at, left) for at, left in told if left and 0.5 < (at - begun) / (ended - begun) < 0.8]
    assert late
    assert 0.5 < np.median([left / truth for truth, left in late]) < 2, told


def test_a_goal_beyond_the_most_samples_is_told(watched: Watched) -> None:
    """The noise of the end, from a quarter of the samples on.

    The estimates of 64 and of 256 samples are each right within a third, so that one is between half and twice the
    other; in 24 runs it was 0.7 to 1.6 times.
    """
    last = watched.photograph(PictureRequest(camera(), noise_codes=0.01, max_spp=256))
    assert last.samples == 256
    assert last.noise_codes is not None and last.noise_codes > 0.01
    for frame in watched.frames:
        if frame.samples >= 64:
            assert frame.final_noise_codes is not None
            assert 0.5 < frame.final_noise_codes / last.noise_codes < 2


def test_the_noise_that_is_told_is_the_error(watched: Watched) -> None:
    """The reference picture has enough samples that its own noise does not count."""
    small = camera(film=rc.Film(36, 24, (60, 40)))
    reference = rc.render(watched.scene, small, effects=(), spp=4096, seed=99, max_bounces=1, device="cpu")
    truth = rc._core.develop(reference.pixels, 100).astype(float)
    for asked in (3.0, 1.0):
        told, true = [], []
        for seed in range(4):
            settings = rc.RenderSettings(seed=seed, effects=(), max_bounces=1)
            told.append(watched.photograph(PictureRequest(small, settings, noise_codes=asked)).noise_codes)
            error = rc._core.develop(watched.loop.image().result(60).pixels, 100) - truth
            # Two roundings to codes have a variance of 1/12 each.
            true.append(math.sqrt(max(0.0, float(np.mean(error * error)) - 1 / 6)))
        # The picture has the samples of the estimate at most, and those of one frame more; samples that are spread
        # evenly have a little less noise than the root of their count says, and the estimate, which believes that law,
        # is high.
        ratio = np.array(told) / np.array(true)
        assert 0.8 < ratio.mean() < 1.8, (told, true)


def test_the_newest_request_wins(watched: Watched) -> None:
    serials = [watched.loop.submit(PictureRequest(camera(0.01 * k), noise_codes=8.0)) for k in range(40)]
    watched.until(lambda: watched.frames and watched.frames[-1].serial == serials[-1] and watched.frames[-1].is_final)
    shown = [frame.serial for frame in watched.frames]
    assert shown == sorted(shown)  # nothing older comes after something newer
    assert len(set(shown)) < len(serials)


def test_every_request_that_is_begun_gets_its_first_frame(watched: Watched) -> None:
    """The picture follows the mouse, however often the mouse sends events."""
    count, deadline = 0, time.monotonic() + 60
    while len({frame.serial for frame in watched.frames}) < 20:
        assert time.monotonic() < deadline
        watched.loop.submit(PictureRequest(camera(0.001 * count)))
        count += 1
        time.sleep(0.005)
    gaps = np.diff(sorted({frame.serial for frame in watched.frames}))
    assert gaps.max() < count / 2


@pytest.mark.slow
def test_a_frame_that_refines_is_given_up_for_a_change(watched: Watched) -> None:
    big = rc.Film(36, 24, (1200, 800))
    watched.loop.submit(PictureRequest(camera(film=big), noise_codes=0.01))
    watched.until(lambda: len([f for f in watched.frames if not f.is_preview]) >= 2)
    # A frame of that size takes some tenths of a second; the change is shown as soon as ever.
    for k in range(1, 4):
        serial = watched.loop.submit(PictureRequest(camera(0.1 * k, film=big), noise_codes=0.01))
        watched.until(lambda serial=serial: watched.frames[-1].serial == serial)
        time.sleep(0.2)
    assert watched.errors == []


def test_another_exposure_needs_no_new_samples(watched: Watched) -> None:
    request = PictureRequest(camera(), noise_codes=4.0, tone="linear")
    before = watched.photograph(request)
    image = watched.loop.image().result(60)
    brighter = replace(request, camera=camera(exposure_time_s=0.02), noise_codes=16.0)
    after = watched.photograph(brighter)
    assert after.samples == before.samples
    expected = rc._core.develop(2 * image.pixels, 100, "linear")
    # JPEG with its coarser colours.
    assert np.abs(codes_of(after).mean(axis=2) - expected.mean(axis=2)).mean() < 3
    assert np.abs(codes_of(before).mean(axis=2) - expected.mean(axis=2)).mean() > 10
    faster = watched.photograph(replace(request, camera=camera(iso=200), noise_codes=16.0))
    assert faster.samples == before.samples
    assert np.abs(codes_of(faster).astype(float) - codes_of(after)).mean() < 1
    twice = watched.loop.image().result(60)
    assert twice.camera.exposure_time_s == 0.01
    assert twice.camera.iso == 200


def test_a_picture_that_is_asked_for_once_more_is_one_frame(watched: Watched) -> None:
    """The last frame is sent again unchanged, so that nothing is reported twice."""
    request = PictureRequest(camera(), noise_codes=4.0)
    before = watched.photograph(request)
    watched.loop.jpeg_quality = 90
    again = watched.photograph(request)
    watched.loop.point(0.5, 0.5).result(60)  # which is answered when the loop has nothing else to do
    assert [frame for frame in watched.frames if frame.serial == again.serial] == [again]
    assert (again.jpeg_quality, again.samples, again.noise_codes) == (90, before.samples, before.noise_codes)


def test_a_brighter_picture_is_refined_until_its_own_noise_is_small(watched: Watched) -> None:
    """Eight times the exposure are eight times the noise, where the tone curve is straight."""
    dark = PictureRequest(camera(exposure_time_s=0.0005), noise_codes=1.0, tone="linear")
    before = watched.photograph(dark)
    bright = replace(dark, camera=camera(exposure_time_s=0.004))
    after = watched.photograph(bright)
    assert after.samples > before.samples
    assert after.noise_codes is not None
    assert after.noise_codes <= 1.0


def test_automatic_exposure_makes_the_picture_grey(watched: Watched) -> None:
    for time_s in (0.3, 1e-5):
        last = watched.photograph(PictureRequest(camera(exposure_time_s=time_s), is_automatic=True, noise_codes=4.0))
        plain = watched.loop.image().result(60)
        # Middle grey is 10 lx s at ISO 1; a metered mean is what Camera.metered finds, by a robust mean of its own.
        metered = rc._core._metered_exposure(np.ascontiguousarray(plain.pixels))
        assert metered == pytest.approx(0.1, rel=0.1)
        assert last.exposure_time_s == pytest.approx(plain.camera.exposure_time_s)
    corrected = watched.photograph(PictureRequest(camera(), is_automatic=True, compensation_ev=1.0, noise_codes=4.0))
    assert corrected.exposure_time_s == pytest.approx(2 * last.exposure_time_s, rel=0.1)


def test_it_sleeps_when_the_picture_is_done(watched: Watched) -> None:
    watched.photograph(PictureRequest(camera(), noise_codes=4.0))
    count = len(watched.frames)
    time.sleep(0.2)
    before = time.process_time()
    time.sleep(1.0)
    assert time.process_time() - before < 0.05
    assert len(watched.frames) == count


@pytest.mark.slow
def test_the_picture_that_is_saved_is_the_one_asked_for_last(watched: Watched) -> None:
    big = rc.Film(36, 24, (900, 600))
    for k in range(1, 6):
        watched.loop.submit(PictureRequest(camera(film=big), noise_codes=0.01))
        if k % 2:
            watched.until(lambda k=k: len(watched.frames) > 2 * k)
        watched.loop.submit(PictureRequest(camera(0.1 * k, film=big), noise_codes=0.01))
        asked = watched.loop.image()
        time.sleep(0.05 * k)
        watched.loop.submit(PictureRequest(camera(0.2 * k, film=big), noise_codes=0.01))
        image = asked.result(60)
        assert image.pixels.shape == (600, 900, 3)
        assert image.camera.film.resolution == (900, 600)
        assert image.camera.position[0] in (0.1 * k, 0.2 * k)
        assert image.pixels.min() >= 0
        assert np.median(image.pixels) > 0
    assert watched.errors == []


def test_what_a_pixel_shows(watched: Watched) -> None:
    with pytest.raises(rc.InputError, match="no picture yet"):
        watched.loop.point(0.5, 0.5).result(10)
    watched.photograph(PictureRequest(camera(), noise_codes=4.0))
    image = watched.loop.image().result(60)
    point = watched.loop.point(0.5, 0.7).result(10)
    assert point.distance_m == pytest.approx(float(image.depth[56, 60]), rel=0.02)
    top = watched.loop.point(0.5, 0.0).result(10)
    assert math.isinf(top.distance_m)  # the sky
    for u, v in ((0, 0), (1, 1), (0, 1)):
        watched.loop.point(u, v).result(10)


def light_of(codes: np.ndarray) -> float:
    """Mean linear light of sRGB codes (IEC 61966-2-1). Noise does not change it, but lowers the mean of the codes."""
    encoded = codes / 255
    return float(np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4).mean())


def test_a_slow_frame_has_the_exposure_set_meanwhile(watched: Watched, monkeypatch: pytest.MonkeyPatch) -> None:
    """The last frame of a picture above all, after which no other comes."""
    monkeypatch.setattr(Pace, "is_slow", lambda *_: True)
    monkeypatch.setattr(Pace, "was_slow", lambda *_: True)
    monkeypatch.setattr(Pace, "next_size", lambda self, size, whole: whole)
    monkeypatch.setattr(Pace, "refining_spp", lambda *_: 100)
    film = FILM.replace(resolution=(360, 240))
    bright = PictureRequest(camera(film=film), noise_codes=0.0, max_spp=100, tone="linear")
    dark = replace(bright, camera=camera(film=film, exposure_time_s=0.01 / 16))
    serial = watched.loop.submit(bright)
    watched.until(lambda: watched.frames and watched.frames[-1].serial == serial)
    begun = time.monotonic()
    while not watched.loop._refines:  # from now on for some tenths of a second
        assert time.monotonic() < begun + 60
        time.sleep(0.001)
    assert not watched.frames[-1].is_final
    serial = watched.photograph(dark).serial
    expected = light_of(rc.render(watched.scene, dark.camera, spp=16, effects=()).developed("linear"))
    frames = [frame for frame in watched.frames if frame.serial == serial]
    assert len(frames) > 1
    for frame in frames:
        assert light_of(codes_of(frame)) == pytest.approx(expected, rel=0.05)


def test_who_asks_means_the_picture_that_was_wanted_last(watched: Watched) -> None:
    """A query refers to the latest request, not to the picture still shown: a click may come right after a move."""
    watched.photograph(PictureRequest(camera(), noise_codes=8.0))
    for z in (6.0, 3.0, 9.0):
        watched.loop.submit(PictureRequest(camera().replace(position=(0, 1, z)), noise_codes=8.0))
        point = watched.loop.point(0.5, 0.7).result(60)
        image = watched.loop.image().result(60)
        assert image.camera.position == (0, 1, z)
        assert point.distance_m == pytest.approx(float(image.depth[56, 60]), rel=0.05)


def test_the_light_of_a_point_does_not_depend_on_the_exposure(watched: Watched) -> None:
    """Metering uses the existing samples, which were collected with another exposure time."""
    request = PictureRequest(camera(), noise_codes=4.0)
    watched.photograph(request)
    first = watched.loop.point(0.5, 0.7).result(10)
    watched.photograph(replace(request, camera=camera(exposure_time_s=0.08), noise_codes=64.0))
    second = watched.loop.point(0.5, 0.7).result(10)
    assert second.illuminance_lx == pytest.approx(first.illuminance_lx, rel=1e-5)


def test_an_error_is_told_and_the_next_request_is_photographed(watched: Watched) -> None:
    serial = watched.loop.submit(PictureRequest(camera(), rc.RenderSettings(effects="auto")))
    watched.until(lambda: watched.errors)
    assert watched.errors[0][0] == serial
    assert "planned first" in watched.errors[0][1]
    assert watched.photograph(PictureRequest(camera(), noise_codes=8.0)).samples > 0
    assert len(watched.errors) == 1


def test_a_listener_that_fails_does_not_end_the_loop(spheres: rc.Scene) -> None:
    calls, came = [], threading.Event()

    def take(frame: Frame) -> None:
        calls.append(frame)
        if len(calls) == 1:
            raise ValueError("a mistake of the listener")
        came.set()

    errors: list[str] = []
    loop = PictureLoop(spheres, take, lambda serial, message: errors.append(message), device="cpu")
    try:
        loop.submit(PictureRequest(camera(), noise_codes=8.0))
        deadline = time.monotonic() + 60
        while not errors and time.monotonic() < deadline:
            time.sleep(0.01)
        assert errors == ["the picture could not be rendered; see the server's log"]
        loop.submit(PictureRequest(camera(0.1), noise_codes=8.0))
        assert came.wait(60)
    finally:
        loop.close()


def test_closing_ends_it_in_the_middle_of_everything(spheres: rc.Scene) -> None:
    for pause in (0.0, 0.05, 0.3):
        watched = Watched(spheres)
        watched.loop.submit(PictureRequest(camera(film=rc.Film(36, 24, (1200, 800))), noise_codes=0.01))
        time.sleep(pause)
        asked = watched.loop.image()
        start = time.monotonic()
        watched.loop.close()
        assert time.monotonic() - start < 10
        assert asked.done()
        with pytest.raises(rc.RealcamError):
            watched.loop.point(0.5, 0.5).result(1)


GREY_LX = 0.1 / 0.01  # exposed to middle grey in 0.01 s at ISO 100


def codes_per_share() -> float:
    """The slope of the linear tone at middle grey: codes by the share of the light, over the curve of sRGB."""
    codes = [rc._core.develop(np.full((1, 1, 3), 0.1 * f, np.float32), 100, "linear")[0, 0, 0] for f in (0.8, 1.2)]
    return (float(codes[1]) - float(codes[0])) / 0.4


def test_the_noise_of_parts_is_where_it_is() -> None:
    """The right half of the picture is noisy. Each part reports the noise of the mean of all its samples."""
    random = np.random.default_rng(3)
    deviation = np.zeros((160, 320, 1), np.float32)
    deviation[:, 160:] = 0.1 * GREY_LX
    first, second = (GREY_LX + deviation * random.standard_normal((160, 320, 3)).astype(np.float32) for _ in range(2))
    measured = NoiseMeasurement()
    assert measured.tiles(0.01, 100, "linear") is None
    measured.add(8, first)
    measured.add(16, 0.5 * (first + second))
    tiles = np.array(measured.tiles(0.01, 100, "linear"))
    assert tiles.shape == (16, 16)
    assert tiles[:, :8].max() < 0.3
    # The mean of two has the deviation of one over the root of two; 118 codes per middle grey, at the slope of sRGB.
    expected = 0.1 * codes_per_share() / math.sqrt(2)
    # 600 numbers a part: within 3% of it in the mean of all, and four of their own deviations each.
    assert tiles[:, 8:].mean() == pytest.approx(expected, rel=0.1)
    assert measured.codes(0.01, 100, "linear") == pytest.approx(math.sqrt(np.mean(tiles**2)), rel=0.05)


def test_noise_is_measured_between_doublings_too() -> None:
    """The mean of n samples has the deviation of one over the root of n, whenever the next doubling is."""
    random = np.random.default_rng(4)
    samples = (GREY_LX * (1 + 0.2 * random.standard_normal((13, 160, 160, 3)))).astype(np.float32)
    measured = NoiseMeasurement()
    for n in (2, 4, 5, 7, 8, 9, 13):
        assert measured.is_doubled(n) == (n in (2, 4, 8))
        measured.add(n, samples[:n].mean(axis=0))
        assert measured.samples == n
        if n > 2:
            # 76 800 numbers: within 0.4% but for the curve of sRGB.
            assert measured.codes(0.01, 100, "linear") == pytest.approx(
                0.2 * codes_per_share() / math.sqrt(n), rel=0.05
            )


def test_a_picture_ends_with_about_the_samples_that_its_noise_takes(
    watched: Watched, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The number is seldom a power of two. 1.2 times less noise takes 1.44 times the samples, and estimates err."""
    monkeypatch.setattr(Pace, "refining_spp", lambda *_: 1)
    first = watched.photograph(PictureRequest(camera(), noise_codes=2.0))
    assert first.noise_codes is not None
    finer = watched.photograph(PictureRequest(camera(), noise_codes=first.noise_codes / 1.2))
    assert finer.noise_codes is not None
    assert finer.samples < 1.8 * first.samples


def test_large_frames_where_few_samples_are_added_to_many() -> None:
    pace, size = Pace(), (100, 100)
    for _ in range(5):
        pace.record(10_000, 0.1, is_first=False)  # one sample of each pixel
    assert [pace.refining_spp(size, samples) for samples in (0, 8, 15, 16, 40, 4000)] == [1, 1, 1, 2, 5, 10]
