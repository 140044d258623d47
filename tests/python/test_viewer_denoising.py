"""Frames of the lens bench without noise, and what it says where there is no denoiser."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from frame_scene import frame_scene

pytest.importorskip("simplejpeg")

import simplejpeg
from realcam.denoiser import GUIDES
from realcam.viewer import saving
from realcam.viewer.lens_bench import LensBench
from realcam.viewer.picture_request import PictureRequest
from realcam.viewer.preview_denoiser import PreviewDenoiser, shrunk, why_missing

from . import bench_shots
from .test_viewer_picture_loop import FILM, Watched, camera, codes_of

wants_it = pytest.mark.skipif(why_missing("cpu") != "", reason="the extra realcam[denoise] is not installed")


@pytest.fixture(scope="module")
def scene() -> rc.Scene:
    return frame_scene(spheres=5, boxes=5)


@pytest.fixture
def watched(scene: rc.Scene) -> Iterator[Watched]:
    made = Watched(scene)
    yield made
    made.loop.close()


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[LensBench]:
    made = LensBench(rc.Shot.load(bench_shots.write_panels_shot(tmp_path)), device="cpu")
    yield made
    made.close()


def test_larger_pixels_have_the_mean_of_smaller_ones() -> None:
    """Whose number differs by one at most where a size does not divide the other; the light stays."""
    rng = np.random.default_rng(1)
    array = rng.random((9, 14, 3), np.float32)
    np.testing.assert_allclose(shrunk(array, (7, 3)), array.reshape(3, 3, 7, 2, 3).mean(axis=(1, 3)), rtol=1e-6)
    assert shrunk(array, (14, 9)) is array
    ramp = np.broadcast_to(np.arange(14, dtype=np.float32)[None, :, None], (9, 14, 3))
    rows = shrunk(ramp, (5, 4))[0, :, 0]  # columns 0 to 1, 2 to 4, 5 to 7, 8 to 10, 11 to 13
    np.testing.assert_allclose(rows, [0.5, 3, 6, 9, 12])


@wants_it
def test_a_frame_is_nearer_to_the_picture_that_it_becomes(scene: rc.Scene) -> None:
    noisy = rc.render(scene, camera(), effects=(), spp=2, layers=GUIDES, device="cpu")
    truth = rc.render(scene, camera(), effects=(), spp=512, seed=5, device="cpu").developed().astype(float)

    def error(exposure: np.ndarray) -> float:
        return float(np.sqrt(((rc._core.develop(exposure, 100) - truth) ** 2).mean()))

    result = PreviewDenoiser("cpu").denoised(noisy)
    assert result.shape == noisy.pixels.shape
    # The full denoiser leaves a third of the error of pictures with as many samples.
    assert error(result) < 0.7 * error(noisy.pixels)


@wants_it
def test_fewer_pixels_where_all_would_take_too_long(scene: rc.Scene) -> None:
    noisy = rc.render(scene, camera(), effects=(), spp=1, layers=GUIDES, device="cpu")
    slow = PreviewDenoiser("cpu")
    slow._rates.clear()
    slow._rates.append(120 * 80 / 0.1)  # a picture of half the pixels takes 50 ms
    assert slow.denoised(noisy, is_hurried=True).shape == (53, 80, 3)
    assert slow.denoised(noisy).shape == (80, 120, 3)


@wants_it
def test_a_picture_that_is_not_wanted_any_more_is_given_up(scene: rc.Scene) -> None:
    noisy = rc.render(scene, camera(), effects=(), spp=1, layers=GUIDES, device="cpu")
    with pytest.raises(rc.Cancelled):
        PreviewDenoiser("cpu").denoised(noisy, is_wanted=lambda: False)


@wants_it
def test_frames_are_denoised_until_the_noise_is_what_is_asked_for(watched: Watched) -> None:
    request = PictureRequest(camera(), noise_codes=2.0, denoises=True)
    last = watched.photograph(request)
    *before, final = watched.frames
    assert final is last and not last.is_denoised
    assert before and all(frame.is_denoised and not frame.is_final for frame in before)
    for frame in before:
        assert codes_of(frame).shape == (frame.height, frame.width, 3)
    # What the last frame shows, and what is saved, has nothing of it.
    raw = watched.loop.image().result(60)
    assert raw.denoiser == "" and not raw.layers
    difference = codes_of(last).astype(float) - raw.developed()
    assert np.abs(difference.mean()) < 1
    # Switched off, the same samples are shown as they are.
    count = len(watched.frames)
    watched.photograph(replace(request, denoises=False))
    assert not any(frame.is_denoised for frame in watched.frames[count:])


@wants_it
def test_another_exposure_is_shown_at_once(watched: Watched) -> None:
    """Of the denoised picture that is there, at its brightness."""
    big = rc.Film(36, 24, (600, 400))
    request = PictureRequest(camera(film=big), tone="linear", noise_codes=0.01, denoises=True)
    watched.loop.submit(request)
    watched.until(lambda: len(watched.frames) >= 2)
    darker = replace(request, camera=camera(film=big, exposure_time_s=0.005))
    serial = watched.loop.submit(darker)
    watched.until(lambda: watched.frames[-1].serial == serial)
    first = next(frame for frame in watched.frames if frame.serial == serial)
    assert first.is_denoised
    # Half of the light is less than 0.8 of the code, and not black.
    means = [float(codes_of(frame).mean()) for frame in (watched.frames[0], first)]
    assert 0.4 < means[1] / means[0] < 0.9


def test_previews_have_no_wavelengths(watched: Watched) -> None:
    """A sample of one wavelength is a coloured dot."""
    settings = rc.RenderSettings(effects=("dispersion", "coatings"))
    asked: list[tuple[tuple[int, int], tuple[str, ...]]] = []
    shoot = watched.loop._live.shoot

    def noting(taken_by: rc.Camera, now: rc.RenderSettings, **options: object) -> object:
        asked.append((taken_by.film.resolution, now.effects))
        return shoot(taken_by, now, **options)

    watched.loop._live.shoot = noting  # type: ignore[method-assign]
    big = camera(film=rc.Film(36, 24, (900, 600)))
    watched.loop.submit(PictureRequest(big, settings, noise_codes=0.01))
    watched.until(lambda: any(not frame.is_preview for frame in watched.frames))
    for size, effects in asked:
        assert effects == (("dispersion", "coatings") if size == (900, 600) else ("coatings",))
    assert {size for size, _ in asked} > {(900, 600)}


def test_without_a_denoiser_the_bench_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("REALCAM_OIDN", "/nowhere/libOpenImageDenoise.so")
    why_missing.cache_clear()
    try:
        bench = LensBench(rc.Shot.load(bench_shots.write_panels_shot(tmp_path)), device="cpu")
        try:
            assert not bench.denoises
            assert "pip install realcam[denoise] brings it" in bench.why_no_denoiser
            with pytest.raises(rc.InputError, match="pip install realcam"):
                bench.set_denoising(True)
            bench.set_denoising(False)
            bench.show()
            assert bench.image().pixels.mean() > 0
        finally:
            bench.close()
    finally:
        why_missing.cache_clear()


@wants_it
@pytest.mark.picture_files
def test_pictures_are_saved_raw_unless_asked(bench: LensBench, tmp_path: Path) -> None:
    oiio = pytest.importorskip("OpenImageIO")
    assert bench.denoises
    bench.show()
    raw, clean = bench.image(), bench.image(is_denoised=True)
    assert raw.denoiser == ""
    name = clean.denoiser
    assert name.startswith("Open Image Denoise 2.")
    for suffix in (".png", ".exr", ".jpg", ".dng"):
        if suffix == ".dng":
            pytest.importorskip("tifffile")
        path = tmp_path / f"picture{suffix}"
        path.write_bytes(saving.picture_content(clean, path.name, "film"))
        assert name.encode() in path.read_bytes()
        assert name.encode() not in saving.picture_content(raw, path.name, "film")
        if suffix != ".dng":
            read = oiio.ImageBuf(str(path))
            assert (read.spec().width, read.spec().height) == (bench_shots.WIDTH, bench_shots.HEIGHT)
    np.testing.assert_array_equal(
        simplejpeg.decode_jpeg(saving.picture_content(clean, "a.jpg", "film")).shape, (*FILM.resolution[::-1], 3)
    )
