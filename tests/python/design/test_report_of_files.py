"""`realcam lens report` shows the fields and wavelengths that another program's file states."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest
import realcam as rc
from realcam.analysis.fields import three_of

from ..programs import Command

# All files have fields of 0, 8, 12 and 16 degrees and wavelengths of 450, 546 (primary) and 620 nm.
ZEMAX = [
    (r"FTYP .*", "FTYP 0 0 4 3 0 0 0"),
    (r"XFLN .*", "XFLN 0 0 0 0"),
    (r"YFLN .*", "YFLN 0 8 12 16"),
    (r"WAVM 1 .*", "WAVM 1 0.45 1\nWAVM 2 0.546 1\nWAVM 3 0.62 1\nWAVM 4 0.55 1\nWAVM 5 0.55 1"),
    (r"PWAV 1", "PWAV 2"),
]
CODE_V = [
    (r"\nWL .*", "\nWL 620 546 450"),
    (r"\nREF 1", "\nREF 2"),
    (r"\nWTW 1", "\nWTW 1 1 1"),
    (r"\nXRI .*", "\nXAN 0 0 0 0"),
    (r"\nYRI .*", "\nYAN 0 8 12 16"),
    (r"\nWTF .*", "\nWTF 1 1 1 1"),
]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:not in the file")
@pytest.mark.parametrize(("suffix", "changes"), [(".zmx", ZEMAX), (".seq", CODE_V)], ids=["zemax", "code v"])
def test_fields_and_wavelengths_are_those_of_the_file(
    suffix: str, changes: list[tuple[str, str]], tmp_path: Path, command: Command
) -> None:
    file, page = tmp_path / f"lens{suffix}", tmp_path / "lens.html"
    rc.Lens.load("tessar-50mm").save(file)
    text = file.read_text(encoding="latin-1")
    for pattern, stated in changes:
        text, count = re.subn(pattern, stated, text, count=1)
        assert count == 1, pattern
    file.write_text(text, encoding="latin-1")
    _, fields, wavelengths = rc.Lens._load_with_light(file)
    assert fields == pytest.approx([0, 8, 12, 16])
    assert sorted(wavelengths) == pytest.approx([450, 546, 620])
    done = command("lens", "report", str(file), "-o", str(page))
    assert done.returncode == 0, done.stderr
    shown = re.sub(r"<[^>]*>", " ", page.read_text(encoding="utf-8"))
    assert re.search(r"fields\s+0°, 12°, 16°", shown)  # 12 is nearest to 0.7 of 16
    assert re.search(r"wavelengths\s+450, 546, 620 nm", shown)


def test_three_of_few_and_of_many() -> None:
    assert three_of([0, 20]) == [0, 14, 20]
    assert three_of([0, 5, 14.5, 20]) == [0, 14.5, 20]
    assert three_of([486.1, 587.6, 656.3], 587.6) == [486.1, 587.6, 656.3]
    assert three_of([550], 550) == [550]


@pytest.mark.filterwarnings("ignore:not in the file")
def test_heights_are_the_angles_of_their_chief_rays(tmp_path: Path) -> None:
    """Image heights at infinity: tan(angle) = height / focal length."""
    lens = rc.Lens.load("tessar-50mm")
    lens.save(tmp_path / "lens.zmx")  # which writes the film's corner as an image height
    read, fields, wavelengths = rc.Lens._load_with_light(tmp_path / "lens.zmx")
    corner = math.hypot(*lens.film_mm) / 2
    angle = math.degrees(math.atan(corner / read.first_order().effective_focal_length_mm))
    assert fields == pytest.approx([0, angle], rel=1e-9)
    assert wavelengths == pytest.approx([lens.wavelength_nm])
    assert rc.Lens._load_with_light("tessar-50mm")[1:] == ([], [])  # a file of realcam states none
