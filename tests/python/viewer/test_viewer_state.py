"""The bench state that a page stores, and restores after a restart of the server."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from types import SimpleNamespace
from typing import cast

import pytest
import realcam as rc
from realcam.viewer.bench_state import restored, state_of
from realcam.viewer.camera_controls import CameraControls
from realcam.viewer.effect_switches import Switches
from realcam.viewer.pose import Pose
from realcam.viewer.ring_scales import zoom_ring

CAMERA = rc.Camera(rc.Lens.load("tessar-50mm").focused(2.0), film=rc.Film(36, 24, (90, 60)))
FRESH = CameraControls.of(CAMERA)


@pytest.mark.parametrize(("focus_m", "zoom"), [(1.5, "17mm"), (math.inf, 20.0)])
def test_all_that_was_set_comes_back(focus_m: float, zoom: str | float) -> None:
    lens = rc.Lens.load("zoom-11-24mm").with_surface(0, radius_of_curvature_mm=50.0)
    before = replace(
        FRESH.with_lens(lens),
        zoom=zoom,
        f_number=5.6,
        focus_m=focus_m,
        pose=Pose((1, 2, 3), (0, 0.5, 0), (0, 0, 1)),
        film=rc.Film(20, 10, (6000, 3000), shift_mm=(1.5, -2.0)),
        exposure_time_s=0.5,
        iso=400.0,
        compensation_ev=-1.0,
        is_automatic=True,
        model="thin",
    )
    text = json.dumps(state_of(before, {"ghosts": "on"}), allow_nan=False)
    after = restored(FRESH, json.loads(text))
    assert after == replace(before, lens=after.lens)
    # The file's numbers are those of the lens: its rays are the same.
    assert [s.radius_of_curvature_mm for s in after.lens.surfaces] == [s.radius_of_curvature_mm for s in lens.surfaces]
    assert after.camera.lens.first_order().effective_focal_length_mm == pytest.approx(
        before.camera.lens.first_order().effective_focal_length_mm, rel=1e-12
    )


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("lens", 5),
        ("lens", "this is no lens"),
        ("name", None),
        ("pose", [0.0] * 8),
        ("pose", [math.inf] * 9),
        ("film", [36, 24, 32769, 10]),
        ("film", [36, 24, 0, 10]),
        ("film", [36, 24, 1e300, 10]),
        ("film", [36, 24, 10.5, 10]),
        ("f_number", "wide"),
        ("iso", True),
        ("zoom", [17]),
        ("model", 3),
    ],
)
def test_what_nobody_has_kept_is_refused(key: str, value: object) -> None:
    state = state_of(FRESH, {}) | {key: value}
    with pytest.raises(rc.RealcamError):
        restored(FRESH, state)


def test_a_name_leads_to_no_other_folder() -> None:
    state = state_of(FRESH, {}) | {"name": "../../etc/passwd"}
    assert "/" not in restored(FRESH, state).lens.name


@pytest.mark.parametrize(
    "words",
    [
        ["auto"],
        ["auto", "ghosts=1e-08", "-dispersion"],
        ["coatings", "film_reflection=0.1"],
        [],
        ["auto", "-motion_blur"],
        ["-rolling_shutter", "dispersion"],
    ],
)
def test_effects_are_those_that_the_shot_names(words: list[str]) -> None:
    switches = Switches.from_shot(words)
    assert sorted(switches.as_specs()) == sorted(words)
    # "-name" excludes an effect without a switch and stays in the list; an effect whose switch is off is not listed.
    named = [word for word in words if word not in ("auto", "-dispersion")]
    assert sorted(switches.effects_to_simulate(None)) == sorted(named)


def test_a_model_without_surfaces_has_none_of_their_effects() -> None:
    switches = Switches.from_shot(["auto", "dispersion", "ghosts=1e-8", "diffraction", "-motion_blur"])
    assert switches.restricted_to_model("full") is switches
    for model in ("thin", "thick", "pinhole", "polynomial"):
        restricted = switches.restricted_to_model(model)
        assert restricted.effects_to_simulate(None) == ("diffraction", "-motion_blur")
        assert not {"dispersion", "ghosts=1e-8", "auto"} & set(restricted.as_specs())
    assert switches.effects_to_simulate(None) == ("dispersion", "ghosts=1e-8", "diffraction", "-motion_blur")


def test_a_zoom_ring_of_one_focal_length_is_none() -> None:
    zoom = SimpleNamespace(zoom_focal_lengths_mm=[50.0, 50.0])
    assert zoom_ring(cast(rc.Lens, zoom)) is None
    three = zoom_ring(cast(rc.Lens, SimpleNamespace(zoom_focal_lengths_mm=[50.0, 50.0, 100.0])))
    assert three is not None
    assert three.values[0] == 50.0
