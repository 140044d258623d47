"""Views of OpenColorIO in the lens bench."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import realcam as rc

pytest.importorskip("PyOpenColorIO")
pytest.importorskip("simplejpeg")
pytest.importorskip("tomlkit")

from realcam.viewer import saving
from realcam.viewer.lens_bench import LensBench
from realcam.viewer.pictures.picture_request import PictureRequest
from realcam.viewer.shot_source import ShotSource

from . import bench_shots
from .watched_loop import Watched, camera, codes_of

pytestmark = pytest.mark.picture_files

STUDIO = "ocio://studio-config-v4.0.0_aces-v2.0_ocio-v2.5"


def test_a_picture_is_shown_through_the_view_of_its_request(watched: Watched) -> None:
    """The last frame is the final picture through the view, except for the compression as JPEG."""
    view = rc.OcioView(STUDIO, view="Un-tone-mapped")
    last = watched.photograph(PictureRequest(camera(), noise_codes=2.0, tone=view))
    expected = view.developed(watched.loop.image().result(60).pixels, camera().iso)
    assert np.abs(codes_of(last).astype(int) - expected).mean() < 4
    assert last.noise_codes is not None
    # Another view of the same samples: no sample is taken.
    other = rc.OcioView(STUDIO)
    shown = watched.photograph(PictureRequest(camera(), noise_codes=2.0, tone=other))
    expected = other.developed(watched.loop.image().result(60).pixels, camera().iso)
    assert np.abs(codes_of(shown).astype(int) - expected).mean() < 4


def test_views_are_chosen_and_saved(tmp_path: Path) -> None:
    path = bench_shots.write_panels_shot(tmp_path)
    source, shot = ShotSource.opened(path, "cpu", {"ocio": STUDIO})
    bench = LensBench(shot, device="cpu")
    try:
        assert bench.tone == rc.OcioView(STUDIO)
        bench.set_view("Rec.1886 Rec.709 - Display", "Un-tone-mapped")
        with pytest.raises(rc.InputError, match="has no view 'nope'"):
            bench.set_view("sRGB - Display", "nope")
        target = tmp_path / "saved.toml"
        effects = bench.switches.as_specs()
        for file, content in saving.shot_contents(source, bench.controls, effects, target, bench.tone).items():
            file.write_bytes(content)
        saved = rc.Shot.load(target)
        assert saved.tone == rc.OcioView(STUDIO, "Rec.1886 Rec.709 - Display", "Un-tone-mapped")
    finally:
        bench.close()


def test_a_bench_without_a_configuration_has_no_views(tmp_path: Path) -> None:
    bench = LensBench(rc.Shot.load(bench_shots.write_panels_shot(tmp_path)), device="cpu")
    try:
        with pytest.raises(rc.InputError, match="no configuration of OpenColorIO"):
            bench.set_view("sRGB - Display", "Raw")
    finally:
        bench.close()
