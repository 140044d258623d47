"""Variations of a shot: other apertures, lenses or zoom positions, with the same framing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from .._core import Camera, InputError, Lens
from ..number_text import number_text
from ..shot import Shot

NAMES = ("f_number", "lens", "zoom")


@dataclass(frozen=True)
class Variation:
    """A varied shot. label: the varied value, as a caption."""

    label: str
    shot: Shot


def variations(shot: Shot, name: str, values: Sequence[str]) -> list[Variation]:
    """Returns the shot with each of the values; the exposure time is scaled for equal brightness.

    name: "f_number", at an unchanged camera position; "lens" (names or files) or "zoom" (positions), for which the
    camera moves along its axis until the subject in focus has the same width on the film as before. Lenses keep the
    shot's f-number, or are wide open if that is slower. Raises InputError and what Lens.load raises.
    """
    if name not in NAMES:
        raise InputError(f'"{name:.40}" cannot be varied; expected {", ".join(NAMES[:-1])} or {NAMES[-1]}')
    make = {"f_number": _at_f_number, "lens": _with_lens, "zoom": _zoomed}[name]
    result = []
    for value in values:
        camera = make(shot.camera, value)
        f_number_ratio = camera.lens.f_number / shot.camera.lens.f_number
        camera = camera.replace(exposure_time_s=shot.camera.exposure_time_s * f_number_ratio**2)
        result.append(Variation(_label_of(camera, name), replace(shot, camera=camera)))
    return result


def _at_f_number(camera: Camera, value: str) -> Camera:
    try:
        f_number = float(value)
    except ValueError:
        f_number = math.nan
    if not (f_number > 0 and math.isfinite(f_number)):
        raise InputError(f'"{value:.40}" is not an f-number; expected a number such as 2.8')
    return camera.replace(lens=camera.lens.stopped_down(f_number))


def _with_lens(camera: Camera, value: str) -> Camera:
    lens = Lens.load(value).with_rings(f_number=camera.lens.f_number, opens_as_far_as_it_can=True)
    return _framed_alike(camera, lens)


def _zoomed(camera: Camera, value: str) -> Camera:
    return _framed_alike(camera, camera.lens.zoomed(value))


def _framed_alike(camera: Camera, lens: Lens) -> Camera:
    """Returns the camera with another lens, moved along its axis so that the subject in focus keeps its width."""
    focus_m = camera.lens.focus_distance_m
    if not math.isfinite(focus_m):
        raise InputError(
            "the shot is focused at infinity; specify focus_m of its subject, so that it can be framed alike"
        )
    position = np.array(camera.position)
    forward = np.array(camera.look_at) - position
    forward /= np.linalg.norm(forward)
    subject = position + focus_m * forward
    width_m = (focus_m - _behind_pupil_m(camera.lens)) * _half_width(camera)
    distance_m = focus_m
    # Fixed-point iteration: focusing changes the angle of view a little, and so the distance.
    for _ in range(4):
        framed = camera.replace(lens=lens.focused(distance_m))
        distance_m = width_m / _half_width(framed) + _behind_pupil_m(framed.lens)
    return framed.replace(position=tuple(subject - distance_m * forward), look_at=tuple(subject))


def _half_width(camera: Camera) -> float:
    """Returns half the width of the horizontal field of view at a distance of 1 from the entrance pupil."""
    angle_deg = camera.field_of_view_deg.horizontal
    if angle_deg >= 170:
        raise InputError(f"{camera.lens.name} sees {angle_deg:.0f} degrees, too wide to frame the shot alike")
    return math.tan(math.radians(angle_deg) / 2)


def _behind_pupil_m(lens: Lens) -> float:
    """Returns the distance from the entrance pupil to the film in m. Focus distances are measured from the film."""
    pupil_mm = lens.first_order().entrance_pupil_position_mm
    return 1e-3 * (lens.film_position_mm - pupil_mm) if math.isfinite(pupil_mm) else 0.0


def _label_of(camera: Camera, name: str) -> str:
    lens = camera.lens
    words = [f"f/{number_text(lens.f_number, 3)}"]
    if name != "f_number":
        focal_length_mm = lens.focused(math.inf).first_order().effective_focal_length_mm
        words = [f"{number_text(focal_length_mm, 3)} mm", *words, f"from {number_text(lens.focus_distance_m, 3)} m"]
    if name == "lens":
        words.insert(0, lens.name)
    return ", ".join(words)
