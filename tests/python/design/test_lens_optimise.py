"""realcam lens optimise: what it writes, what it keeps to, and what it refuses."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import realcam as rc
from realcam.cli import app as cli


def said(words: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> tuple[int, str, str]:
    monkeypatch.setattr("sys.argv", ["realcam", "lens", "optimise", *words])
    with pytest.raises(SystemExit) as ended:
        cli.run()
    return int(ended.value.code or 0), *capsys.readouterr()


def test_a_sharper_lens_is_written_and_keeps_its_focal_length(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "sharper.toml"
    words = ["cooke-triplet-50mm", "-o", str(out), "--steps", "5", "--fields-deg", "0,14", "--json"]
    code, text, _ = said(words, monkeypatch, capsys)
    assert code == 0
    figures = json.loads(text)
    assert figures["rms_spot_mm"] < figures["rms_spot_before_mm"]
    before, after = rc.Lens.load("cooke-triplet-50mm"), rc.Lens.load(out)
    assert after.surfaces[0].curvature_per_mm != before.surfaces[0].curvature_per_mm
    # An error of 1 mm counts as 0.1 mm of all spots, which are of hundredths.
    expected = before.first_order().effective_focal_length_mm
    assert after.first_order().effective_focal_length_mm == pytest.approx(expected, abs=0.1)


def test_an_interruption_writes_the_best_lens_and_ends_in_130(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from realcam.optimisation import optimiser as optimisation

    looks = optimisation._Search.residuals

    def interrupted(self: optimisation._Search, x: object) -> object:
        if self.evaluations == 2:
            raise KeyboardInterrupt
        return looks(self, x)  # type: ignore[arg-type]

    monkeypatch.setattr(optimisation._Search, "residuals", interrupted)
    out = tmp_path / "best.toml"
    code, text, _ = said(["cooke-triplet-50mm", "-o", str(out)], monkeypatch, capsys)
    assert code == 130
    assert "interrupted" in text
    assert rc.Lens.load(out).first_order().effective_focal_length_mm > 0


def test_glass_does_not_become_thinner_than_can_be_made(tmp_path: Path) -> None:
    """Unless it is thinner already; air may."""
    from realcam.cli.optimise import Bounds

    lens = rc.Lens.load("cooke-triplet-50mm")
    bounds = Bounds()
    glasses = [i for i, surface in enumerate(lens.surfaces) if bounds.least_thickness_of(lens, i) == 1.0]
    assert len(glasses) == 3
    thin = lens.with_surface(glasses[1], thickness_mm=0.6)
    assert bounds.least_thickness_of(thin, glasses[1]) == pytest.approx(0.6)
    assert bounds.least_thickness_of(lens, glasses[0] + 1) == 0.1
