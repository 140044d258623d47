"""Lens files that a page brings, as hostile as they may be."""

from __future__ import annotations

import time

import pytest
import realcam as rc
from realcam.viewer import lens_reading, saving
from realcam.viewer.bench_state import restored, state_of
from realcam.viewer.camera_controls import CameraControls
from realcam.viewer.lens_edits import with_value
from realcam.viewer.lens_reading import lens_from

from ..package import worker_tasks


@pytest.mark.filterwarnings("ignore:not in the file")
def test_a_lens_that_was_saved_is_read() -> None:
    lens = with_value(rc.Lens.load("heliar-100mm"), 0, "radius_mm", 30.0)
    for name in ("mine.toml", "mine.ZMX", "mine.seq"):
        read, _ = lens_from(name, saving.lens_content(lens, name.lower())[0])
        assert read.first_order().effective_focal_length_mm == pytest.approx(
            lens.first_order().effective_focal_length_mm, rel=1e-6
        )
    with pytest.raises(rc.InputError, match="expected a lens file"):
        saving.lens_content(lens, "mine.txt")


@pytest.mark.parametrize("name", ["x.toml", "x.zmx", "../../x.seq", "x" * 300 + ".toml", ".toml"])
def test_what_is_no_lens_is_named_as_the_user_names_it(name: str) -> None:
    with pytest.raises(rc.InputError) as error:
        lens_from(name, b"nonsense\0\xff")
    assert "/tmp" not in str(error.value)


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("dots.toml", b"a." * 150_000 + b"b = 1"),
        ("brackets.toml", b"a = " + b"[" * 200_000),
        ("ampersands.seq", b"RDM;LEN\n" + b"x&\n" * 100_000),
        ("brackets.json", b"[" * 200_000),
    ],
)
def test_files_that_are_made_to_hurt_their_reader(name: str, content: bytes) -> None:
    """Whatever becomes of the reader, the program lives, and reads the next."""
    with pytest.raises(rc.InputError):
        lens_from(name, content)
    lens, _ = lens_from("double.toml", rc.Lens.load("tessar-50mm")._file_content("double.toml")[0])
    assert lens.first_order().effective_focal_length_mm == pytest.approx(49.94, abs=0.01)


def test_a_reader_that_crashes_or_never_ends_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    before = CameraControls.of(rc.Camera(rc.Lens.load("tessar-50mm")))
    for reads, longest_s, told in (
        (worker_tasks.crash, 60.0, "crashed"),
        (worker_tasks.compute_for_ever, 0.7, "longer than 0.7 s"),
    ):
        monkeypatch.setattr(lens_reading, "_read", reads)
        monkeypatch.setattr(lens_reading, "_TIMEOUT_S", longest_s)
        begun = time.monotonic()
        with pytest.raises(rc.InputError, match=f"mine.toml: reading the file .*{told}"):
            lens_from("mine.toml", b"")
        # Restoring the state that a page brings back fails in the same way.
        with pytest.raises(rc.InputError, match=told):
            restored(before, state_of(before, {}))
        assert time.monotonic() - begun < 60
