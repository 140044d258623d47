"""Files that the page saves, and files that it must not change."""

from __future__ import annotations

import stat
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import realcam as rc

pytest.importorskip("nicegui")
playwright = pytest.importorskip("playwright.sync_api")

from .bench_pages import CHROMIUM, BenchPage, Server, until  # noqa: E402

pytestmark = [pytest.mark.picture_files, pytest.mark.skipif(CHROMIUM is None, reason="no chromium")]


def ask_to_save(bench: BenchPage, what: str, name: str, button: str = "save") -> None:
    bench.choose_what_to_save(what, name)
    bench.test_id(button).click()


def answer(bench: BenchPage, text: str) -> None:
    bench.page.get_by_role("button", name=text).click()
    bench.page.locator(".q-dialog").wait_for(state="detached")


def edited(bench: BenchPage) -> None:
    before = bench.figure("effective_focal_length_mm")
    bench.edit(0, "radius_mm", "27.5")
    until(lambda: bench.figure("effective_focal_length_mm"), lambda f: abs(f - before) > 0.5, "edited")


@pytest.fixture
def folder(server: Server, request: pytest.FixtureRequest) -> Path:
    """A folder of the test's own within that of the server."""
    made = server.shot.parent / request.node.name.replace("[", "-").replace("]", "")
    made.mkdir()
    return made


@pytest.mark.slow
def test_the_lens_beside_a_shot_is_asked_for_too(bench: BenchPage, folder: Path) -> None:
    (folder / "shot-lens.toml").write_text("precious")
    edited(bench)
    for reply, is_kept in (("Keep it", True), ("Replace it", False)):
        ask_to_save(bench, "shot", f"{folder.name}/shot.toml")
        bench.page.get_by_text("shot-lens.toml exists already").wait_for()
        answer(bench, reply)
        if not is_kept:
            bench.until_text("said", lambda text: text.startswith("Wrote"))
        assert ((folder / "shot-lens.toml").read_text() == "precious") == is_kept
        assert (folder / "shot.toml").exists() != is_kept
    assert rc.Shot.load(folder / "shot.toml").camera.lens.surfaces[0].radius_of_curvature_mm == 27.5


def test_nothing_is_written_through_a_link_out_of_the_folders(bench: BenchPage, folder: Path, tmp_path: Path) -> None:
    victim = tmp_path / "victim.toml"
    victim.write_text("of somebody else")
    (folder / "shot-lens.toml").symlink_to(victim)
    (folder / "lens.toml").symlink_to(tmp_path / "not-there.toml")
    edited(bench)
    ask_to_save(bench, "shot", f"{folder.name}/shot.toml")
    bench.until_text("said", lambda text: "shot-lens.toml" in text and "outside the folders" in text)
    ask_to_save(bench, "lens", f"{folder.name}/lens.toml")
    bench.until_text("said", lambda text: "lens.toml" in text and "outside the folders" in text)
    assert victim.read_text() == "of somebody else"
    assert not (tmp_path / "not-there.toml").exists()
    assert not (folder / "shot.toml").exists()


@pytest.mark.slow
def test_two_windows_that_save_one_new_name(browser: Any, server: Server, bench: BenchPage, folder: Path) -> None:
    """The one that comes later is asked, even if neither saw the file of the other when it asked for its own."""
    edited(bench)
    other = BenchPage(browser, server.url)
    try:
        for page in (bench, other):
            page.choose_what_to_save("lens", f"{folder.name}/mine.toml")
        for page in (bench, other):
            page.test_id("save").click(no_wait_after=True)

        def seen() -> list[bool]:
            return [page.page.get_by_text("mine.toml exists already").is_visible() for page in (bench, other)]

        until(seen, lambda asked: sum(asked) == 1, "one is asked")
        first, second = (other, bench) if seen()[0] else (bench, other)
        first.until_text("said", lambda text: text == "Wrote mine.toml")
        answer(second, "Keep it")
    finally:
        other.close()
    radius = rc.Lens.load(folder / "mine.toml").surfaces[0].radius_of_curvature_mm
    assert (radius == 27.5) == (first is bench)


def test_a_file_that_is_replaced_keeps_its_permissions(bench: BenchPage, folder: Path) -> None:
    for name in ("picture.png", "picture.jpg", "lens.toml"):
        path = folder / name
        path.write_text("private")
        path.chmod(0o600)
        ask_to_save(bench, "lens" if "lens" in name else "picture", f"{folder.name}/{name}")
        answer(bench, "Replace it")
        bench.until_text("said", lambda text, name=name: text == f"Wrote {name}")
        assert path.read_bytes() != b"private"
        assert stat.S_IMODE(path.stat().st_mode) == 0o600


def error_of(path: Path, reference: rc.Image) -> float:
    oiio = pytest.importorskip("OpenImageIO")
    codes = oiio.ImageBuf(str(path)).get_pixels(oiio.UINT8)[..., :3].astype(float)
    return float(np.sqrt(np.mean((codes - reference.developed()) ** 2)))


@pytest.mark.slow
def test_a_picture_is_saved_with_the_noise_that_is_asked_for(bench: BenchPage, server: Server, folder: Path) -> None:
    """It has a button of its own, here clicked as soon as the page is open, when the picture has one sample."""
    shot = rc.Shot.load(server.shot)
    bench.choose("refine to", "2 grey levels")
    bench.until_text("save-refined", lambda text: text == "Save when the noise is 2 grey levels")
    ask_to_save(bench, "picture", f"{folder.name}/refined.png", "save-refined")
    until(lambda: bench.text("said"), lambda text: text == "Wrote refined.png", "saved", 240)
    bench.until_text("time-left", lambda text: text == "Time left: none")
    reference = rc.render(shot.scene, shot.camera, effects=(), spp=512, seed=9, device="cpu")
    # The reported noise is at least the error, within a fifth (test_viewer_picture_loop.py); the rounding of both
    # pictures adds 0.4, and the reference 1.6. One sample has 36, and the picture without this button 3.3.
    assert error_of(folder / "refined.png", reference) < 2.9


@pytest.mark.slow
def test_a_picture_is_saved_as_it_is_seen_now(bench: BenchPage, folder: Path) -> None:
    """It has all pixels of the shown picture, denoised or not, and is saved without waiting for the noise goal."""
    oiio = pytest.importorskip("OpenImageIO")
    bench.choose("resolution", "960 pixels across")
    bench.choose("refine to", "half a grey level (fine)")
    until(bench.shown, lambda picture: picture.shape[1] == 960 and "preview" not in bench.status, "all pixels")
    ask_to_save(bench, "picture", f"{folder.name}/seen.png")
    seen = bench.shown()
    bench.until_text("said", lambda text: text == "Wrote seen.png")
    assert "done" not in bench.status
    saved = oiio.ImageBuf(str(folder / "seen.png")).get_pixels(oiio.UINT8)
    assert saved.shape[:2] == (640, 960)
    # JPEG of the least quality, and the samples of a second, change less than the noise of one sample, 36 levels.
    assert np.abs(saved[..., :3].astype(float) - seen).mean() < 10


@pytest.mark.slow
def test_saving_a_refined_picture_is_given_up_or_cut_short(bench: BenchPage, folder: Path) -> None:
    bench.choose("resolution", "960 pixels across")
    bench.choose("refine to", "half a grey level (fine)")
    ask_to_save(bench, "picture", f"{folder.name}/soon.png", "save-refined")
    bench.until_text("save-progress", lambda text: "sample" in text and "Time left" in text)
    answer(bench, "Do not save")
    bench.until_text("said", lambda text: text == "The picture was not saved.")
    assert list(folder.iterdir()) == []
    ask_to_save(bench, "picture", f"{folder.name}/soon.png", "save-refined")
    bench.until_text("save-progress", lambda text: "sample" in text)
    answer(bench, "Save it as it is now")
    bench.until_text("said", lambda text: text == "Wrote soon.png")
    assert (folder / "soon.png").stat().st_size > 1000


@pytest.mark.slow
def test_a_picture_is_downloaded(bench: BenchPage, server: Server, tmp_path: Path) -> None:
    oiio = pytest.importorskip("OpenImageIO")
    bench.picture()
    for suffix in ("png", "jpg", "jpeg", "exr", "dng"):
        name = f"mine.{suffix}"
        with bench.page.expect_download() as asked:
            ask_to_save(bench, "picture", name, "download")
        assert asked.value.suggested_filename == name
        asked.value.save_as(tmp_path / name)
        assert oiio.ImageBuf(str(tmp_path / name)).spec().width > 0, name
        assert not (server.shot.parent / name).exists()


def test_a_shot_is_downloaded_with_its_lens(bench: BenchPage, server: Server) -> None:
    edited(bench)
    files = []
    bench.page.on("download", lambda file: files.append(file))
    ask_to_save(bench, "shot", "mine.toml", "download")
    until(lambda: (bench.page.wait_for_timeout(50), len(files))[1], lambda count: count == 2, "both files")
    for file in files:
        file.save_as(server.shot.parent / file.suggested_filename)  # where its scene is
    shot = rc.Shot.load(server.shot.parent / "mine.toml")
    assert shot.camera.lens.surfaces[0].radius_of_curvature_mm == 27.5


@pytest.mark.slow
def test_an_unknown_ending_is_told_where_one_looks(bench: BenchPage, folder: Path) -> None:
    for what, name in (("picture", "x.gif"), ("shot", "x.png"), ("lens", "x.txt")):
        ask_to_save(bench, what, f"{folder.name}/{name}")
        bench.until_text("said", lambda text, name=name: name in text and "expected" in text)
        said = bench.test_id("said")
        assert said.is_visible()
        assert "rc-problem" in (said.get_attribute("class") or "")
    assert list(folder.iterdir()) == []
