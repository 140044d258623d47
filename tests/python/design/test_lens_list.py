"""realcam lens list: figures of the lenses, and what chooses them."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
import realcam as rc

from ..programs import Command


@pytest.mark.parametrize(
    ("words", "names"),
    [
        ("--kind zoom", {"zoom-11-24mm", "zoom-25-50mm", "zoom-70-200mm", "zoom-70-210mm", "zoom-80-200mm"}),
        ("--kind mirror --focal-length 500mm", {"mirror-telephoto-500mm", "off-axis-500mm"}),
        ("--kind very-wide-angle --focal 5-12", {"fisheye-10mm", "fisheye-6mm-220deg"}),
        # By the titles: f/0.95 and f/1.2.
        ("--f-number f/1.3", {"fast-50mm", "fast-52mm", "cinema-50mm"}),
        ("--f-number f/8-f/10", {"landscape-100mm", "hologon-15mm"}),
        # A zoom of 25 to 50 mm reaches 40.
        ("--focal 40mm", {"zoom-25-50mm"}),
        ("SUMMICRON", {"summicron-50mm"}),
        ("canon zoom 11-24", {"zoom-11-24mm"}),
        ("tronnier --kind normal --focal-length 50", {"double-gauss-50mm"}),
    ],
)
def test_lenses_are_chosen(words: str, names: set[str], command: Command) -> None:
    done = command("lens", "list", *words.split())
    assert (done.returncode, done.stderr) == (0, "")
    assert {line.split()[0] for line in done.stdout.splitlines()} == names


def test_all_lenses_with_their_figures(command: Command) -> None:
    lines = command("lens", "list").stdout.splitlines()
    assert [line.split()[0] for line in lines] == rc.lens_names()
    [gauss] = [line for line in lines if line.startswith("double-gauss-50mm ")]
    assert re.fullmatch(r"double-gauss-50mm +normal +50\.4 mm +f/2 +Double Gauss 50 mm f/2 \(Tronnier\)", gauss)
    [zoom] = [line for line in lines if line.startswith("zoom-25-50mm ")]
    assert re.search(r" zoom +25\.5-48\.8 mm +f/4 ", zoom)
    rows = {row["name"]: row for row in json.loads(command("lens", "list", "--json").stdout)}
    assert list(rows) == rc.lens_names()
    tessar = rc.Lens.load("tessar-50mm")
    focal_length_mm = tessar.first_order().effective_focal_length_mm
    assert rows["tessar-50mm"]["focal_lengths_mm"] == [focal_length_mm] * 2
    assert rows["tessar-50mm"]["f_number"] == tessar.f_number
    assert (rows["tessar-50mm"]["title"], rows["tessar-50mm"]["year"]) == (tessar.title, 1952)


def test_lenses_of_the_lens_path(command: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("REALCAM_LENS_PATH", "")
    rc.Lens.load("tessar-50mm").save(tmp_path / "mine.toml")
    (tmp_path / "tessar-50mm.toml").write_text("a bundled lens comes first")
    (tmp_path / "broken.toml").write_text("format = 1")
    (tmp_path / "notes.txt").write_text("no lens")
    done = command("lens", "list", "--lens-path", tmp_path, "--json")
    rows = {row["name"]: row for row in json.loads(done.stdout)}
    assert set(rows) == {*rc.lens_names(), "mine"}
    assert rows["mine"]["file"] == str(tmp_path / "mine.toml")
    assert rows["mine"]["f_number"] == pytest.approx(rows["tessar-50mm"]["f_number"])
    assert done.stderr.startswith(f"realcam: warning: {tmp_path / 'broken.toml'} is left out: ")
