"""Frames of the lens bench without noise, and what it says where there is no denoiser."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

pytest.importorskip("simplejpeg")

from realcam.denoiser import GUIDES
from realcam.viewer import saving
from realcam.viewer.lens_bench import LensBench
from realcam.viewer.pictures.picture_request import PictureRequest
from realcam.viewer.pictures.preview_denoiser import PreviewDenoiser, why_missing

from . import bench_shots
from .bench_pages import until
from .watched_loop import Watched, camera, codes_of

BenchOf = Callable[..., LensBench]
wants_it = pytest.mark.skipif(why_missing("cpu") != "", reason="the extra realcam[denoise] is not installed")


@wants_it
def test_a_frame_is_nearer_to_the_picture_that_it_becomes(spheres: rc.Scene) -> None:
    noisy = rc.render(spheres, camera(), effects=(), spp=2, layers=GUIDES, device="cpu")
    truth = rc.render(spheres, camera(), effects=(), spp=512, seed=5, device="cpu").developed().astype(float)

    def error(image: rc.Image) -> float:
        return float(np.sqrt(((image.developed() - truth) ** 2).mean()))

    result = PreviewDenoiser("cpu").denoised(lambda: noisy)
    assert result.pixels.shape == noisy.pixels.shape
    # The full denoiser leaves a third of the error of pictures with as many samples.
    assert error(result) < 0.7 * error(noisy)


@wants_it
def test_a_picture_that_is_not_wanted_any_more_is_given_up(spheres: rc.Scene) -> None:
    noisy = rc.render(spheres, camera(), effects=(), spp=1, layers=GUIDES, device="cpu")
    with pytest.raises(rc.Cancelled):
        PreviewDenoiser("cpu").denoised(lambda: noisy, is_wanted=lambda: False)


@wants_it
@pytest.mark.slow
def test_only_the_first_frame_of_a_change_is_noisy_where_denoising_is_slow(watched: Watched) -> None:
    """The first one has all pixels; each later frame is denoised, with at least as many pixels as the previous one."""
    watched.loop._taker._denoiser._rates.extend([1.0] * 5)  # pixels a second
    big = camera(film=rc.Film(36, 24, (600, 400)))
    serial = watched.loop.submit(PictureRequest(big, noise_codes=0.01, denoises=True))
    watched.until(lambda: sum(not frame.is_preview for frame in watched.frames) >= 2)
    first, *later = watched.frames
    assert not first.is_denoised
    assert all(frame.is_denoised and frame.serial == serial for frame in later)
    widths = [frame.width for frame in watched.frames]
    assert widths == sorted(widths) and widths[-1] == 600


@wants_it
def test_other_settings_are_not_shown_with_fewer_pixels(watched: Watched) -> None:
    """This happens when the planner has decided: the camera has not moved, and the picture keeps its resolution."""
    big = camera(film=rc.Film(36, 24, (600, 400)))
    request = PictureRequest(big, noise_codes=0.01, denoises=True)
    watched.loop.submit(request)
    watched.until(lambda: watched.frames and not watched.frames[-1].is_preview)
    count = len(watched.frames)
    serial = watched.loop.submit(replace(request, settings=request.settings.with_(effects=("dispersion",))))
    assert watched.loop.point(0.5, 0.5).result(60).distance_m > 0
    watched.until(lambda: watched.frames[-1].serial == serial)
    assert {frame.width for frame in watched.frames[count:]} == {600}
    assert watched.frames[-1].is_denoised


@wants_it
def test_frames_are_denoised_until_the_noise_is_what_is_asked_for(watched: Watched) -> None:
    request = PictureRequest(camera(), noise_codes=2.0, denoises=True)
    last = watched.photograph(request)
    *before, final = watched.frames
    assert final is last and not last.is_denoised
    assert before and all(frame.is_denoised and not frame.is_final for frame in before)
    for frame in before:
        assert codes_of(frame).shape == (frame.height, frame.width, 3)
    # The last frame, and a picture that is saved then, are not denoised.
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
    """The existing denoised picture is shown with the new brightness."""
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


@pytest.fixture
def no_denoiser(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setenv("REALCAM_OIDN", "/nowhere/libOpenImageDenoise.so")
    why_missing.cache_clear()
    yield
    why_missing.cache_clear()


@pytest.mark.usefixtures("no_denoiser")
def test_without_a_denoiser_the_bench_says_what_to_install(bench_of: BenchOf, tmp_path: Path) -> None:
    bench = bench_of(rc.Shot.load(bench_shots.write_panels_shot(tmp_path)))
    assert not bench.denoises
    assert "install it with pip install realcam[denoise]" in bench.why_no_denoiser
    with pytest.raises(rc.InputError, match="pip install realcam"):
        bench.set_denoising(True)
    bench.set_denoising(False)
    bench.show()
    assert bench.image().pixels.mean() > 0


@wants_it
@pytest.mark.picture_files
def test_a_picture_is_saved_as_it_is_seen(bench_of: BenchOf, tmp_path: Path) -> None:
    """Denoised with the denoiser's name in the file, or without denoising; each within the JPEG error of the frame."""
    oiio = pytest.importorskip("OpenImageIO")
    shot = rc.Shot.load(bench_shots.write_panels_shot(tmp_path, width=600))
    bench, frames = bench_of(shot, noise_codes=0.01), []
    bench.listeners.frame = lambda slot, frame: frames.append(frame)
    bench.set_jpeg_quality(95)
    names = []
    for denoises in (True, False):
        bench.set_denoising(denoises)
        until(lambda d=denoises: frames and frames[-1].is_denoised == d and not frames[-1].is_preview, bool, "shown")
        image = bench.image()
        seen = codes_of(frames[-1]).astype(float)
        assert image.developed("film").shape == seen.shape
        # The noise of a frame of few samples is 20 grey levels and more, and the frame may be one older.
        assert np.abs(image.developed("film") - seen).mean() < (3 if denoises else 10)
        names.append(image.denoiser)
        for suffix in (".png", ".exr", ".jpg", ".dng"):
            if suffix == ".dng":
                pytest.importorskip("tifffile")
            path = tmp_path / f"picture{suffix}"
            path.write_bytes(saving.picture_content(image, path.name, "film"))
            assert (b"Open Image Denoise" in path.read_bytes()) == denoises
            if suffix != ".dng":
                read = oiio.ImageBuf(str(path))
                assert (read.spec().width, read.spec().height) == (600, 400)
    assert names[0].startswith("Open Image Denoise 2.") and names[1] == ""
