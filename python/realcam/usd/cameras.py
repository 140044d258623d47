"""Cameras of a stage, and their settings as keys of shot files."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from pxr import Gf, Sdf, Usd, UsdGeom

from ..shot import toml_value
from .assets import asset_of
from .glb import Json
from .motion import MAX_KEYS
from .stage import OpenStage, children_of, open_stage

# Attributes of a camera prim by which a stage keeps its lens. The focus is in metres, from the object plane to the
# film; USD's own focusDistance is in units of the stage, to the camera's origin, which is the entrance pupil.
LENS, F_NUMBER, FOCUS_M = "realcam:lens", "realcam:fNumber", "realcam:focusM"
_TOLERANCE = 1e-3  # of focus and f-number between keyframes, relative
_FILM_MM = (1.0, 500.0)  # diagonals of films that are not taken for a mistake in the stage's units


def camera_json(opened: OpenStage, prim: Usd.Prim) -> Json:
    """Returns a camera for glTF."""
    camera = UsdGeom.Camera(prim).GetCamera(opened.time)
    field = camera.GetFieldOfView(Gf.Camera.FOVVertical)
    _notice_what_is_left_out(opened, prim)
    if camera.projection == Gf.Camera.Orthographic or not 0 < field < 180:
        return {"type": "orthographic", "name": prim.GetName(), "orthographic": {"xmag": 1, "ymag": 1}}
    return {"type": "perspective", "name": prim.GetName(), "perspective": {"yfov": math.radians(field), "znear": 0.1}}


def settings_text(path: str, scale: float, variants: Sequence[str], camera: str) -> str:
    """See realcam.usd.camera_settings."""
    opened = open_stage(path, variants)
    prim = _camera_named(opened, camera)
    if prim is None:
        return ""
    settings = _Settings(opened, prim, scale * opened.metres_per_unit)
    return "".join(f"{name} = {toml_value(name, value)}\n" for name, value in settings.values().items())


def _camera_named(opened: OpenStage, name: str) -> Usd.Prim | None:
    """Returns the camera that realcam.Scene.cameras calls by this name, or the first perspective camera for "".

    The second of several cameras "main" is "main.2".
    """
    counts: dict[str, int] = {}
    stack = list(reversed(children_of(opened.stage.GetPseudoRoot())))
    while stack:
        prim = stack.pop()
        stack += reversed(children_of(prim))
        opened.count(prim, 0)
        if not prim.IsA(UsdGeom.Camera):
            continue
        base = prim.GetName()
        counts[base] = counts.get(base, 0) + 1
        shown = base if counts[base] == 1 else f"{base}.{counts[base]}"
        is_perspective = camera_json(opened, prim)["type"] == "perspective"
        if shown == name or (not name and is_perspective):
            return prim
    return None


def film_mm(opened: OpenStage, prim: Usd.Prim) -> tuple[float, float]:
    """Returns width and height of a camera's film. Apertures are in tenths of the stage's unit: in mm for a unit of
    1 cm."""
    camera, to_mm = UsdGeom.Camera(prim), _mm_per_tenth(opened)
    attributes = camera.GetHorizontalApertureAttr(), camera.GetVerticalApertureAttr()
    width, height = (to_mm * float(attribute.Get(opened.time) or 0) for attribute in attributes)
    return width, height


def _mm_per_tenth(opened: OpenStage) -> float:
    return 100 * opened.metres_per_unit


def _is_film(film: tuple[float, float]) -> bool:
    return min(film) > 0 and _FILM_MM[0] <= math.hypot(*film) <= _FILM_MM[1]


def _notice_what_is_left_out(opened: OpenStage, prim: Usd.Prim) -> None:
    camera = UsdGeom.Camera(prim)
    film = film_mm(opened, prim)
    if camera.GetHorizontalApertureAttr().HasAuthoredValue() and not _is_film(film):
        opened.notices.add(
            prim.GetPath(),
            f"its film of {film[0]:g} x {film[1]:g} mm, by the stage's unit, is left out; the lens's film is used",
        )
    for attribute, text in (
        (camera.GetClippingPlanesAttr(), "clippingPlanes are left out"),
        (camera.GetShutterOpenAttr(), "shutter:open and shutter:close are left out; the exposure time counts"),
        (camera.GetShutterCloseAttr(), "shutter:open and shutter:close are left out; the exposure time counts"),
        (camera.GetStereoRoleAttr(), "stereoRole is left out"),
        (camera.GetExposureResponsivityAttr(), "exposure:responsivity is left out"),
        (camera.GetExposureFStopAttr(), "exposure:fStop is left out; fStop counts"),
    ):
        if attribute.HasAuthoredValue():
            opened.notices.add(prim.GetPath(), text)
    for attribute in (camera.GetExposureAttr(), camera.GetExposureIsoAttr()):
        if attribute.HasAuthoredValue() and not camera.GetExposureTimeAttr().HasAuthoredValue():
            opened.notices.add(prim.GetPath(), "its exposure is metered; exposure and exposure:iso need exposure:time")


@dataclass
class _Settings:
    """Settings of a camera. metres: metres per unit of the stage."""

    opened: OpenStage
    prim: Usd.Prim
    metres: float

    def values(self) -> dict[str, Any]:
        """Returns keys of shot files with their values, and focus_is_to_pupil if focus distances are those to the
        entrance pupil."""
        camera = UsdGeom.Camera(self.prim)
        values: dict[str, Any] = {}
        self._add_lens(values)
        has_film = camera.GetHorizontalApertureAttr().HasAuthoredValue()
        film = film_mm(self.opened, self.prim)
        if has_film and _is_film(film):
            values["film_mm"] = list(film)
            to_mm = _mm_per_tenth(self.opened)
            shift = [to_mm * self._number(f"{side}ApertureOffset") for side in ("horizontal", "vertical")]
            if any(shift):
                values["film_shift_mm"] = shift
        self._add_rings(values)
        self._add_exposure(values)
        return values

    def _add_lens(self, values: dict[str, Any]) -> None:
        """Adds the lens: a bundled lens by its name, or a lens file."""
        attribute = self.prim.GetAttribute(LENS)
        lens = attribute.Get(self.opened.time) if attribute else None
        if isinstance(lens, Sdf.AssetPath):
            asset = asset_of(self.opened, lens)
            if not asset.path and os.sep in lens.path:
                raise self.opened.fail(attribute.GetPath(), f"expected a lens file; found no file {lens.path}")
            lens = asset.path or lens.path
        if lens is None:
            return
        if not isinstance(lens, str) or not lens:
            raise self.opened.fail(attribute.GetPath(), f"expected the name of a lens or its file; found {lens!r:.60}")
        values["lens"] = lens

    def _add_rings(self, values: dict[str, Any]) -> None:
        """Adds focus and f-number, as keyframes if they have values over time."""
        keys: dict[float, dict[str, Any]] = {}
        for key, sources in (
            ("focus_m", ((FOCUS_M, 1.0), ("focusDistance", self.metres))),
            ("f_number", ((F_NUMBER, 1.0), ("fStop", 1.0))),
        ):
            for name, factor in sources:
                number = self._number(name)
                if number <= 0:
                    continue
                if name == "focusDistance":
                    values["focus_is_to_pupil"] = True
                samples = self._samples(name)
                if len(samples) < 2:
                    values[key] = number * factor
                for seconds, sample in samples.items() if len(samples) >= 2 else ():
                    keys.setdefault(seconds, {})[key] = sample * factor
                break
        if keys:
            held = {"interpolation": "step"} if self._is_held else {}
            values["key"] = [{"time_s": time, **keys[time], **held} for time in sorted(keys)]

    @property
    def _is_held(self) -> bool:
        return bool(self.opened.stage.GetInterpolationType() == Usd.InterpolationTypeHeld)

    def _samples(self, name: str) -> dict[float, float]:
        """Returns the positive values of an attribute over time, by seconds. USD interpolates them linearly, and
        realcam their inverses or logarithms: there are more of them where the two would differ by more than
        _TOLERANCE."""
        attribute = self.prim.GetAttribute(name)
        samples = [(time, self._number(name, time)) for time in attribute.GetTimeSamples()[:MAX_KEYS]]
        samples = [(time, number) for time, number in samples if number > 0]
        found = {self.opened.seconds(time): number for time, number in samples}
        if self._is_held:
            return found
        for (start, first), (end, last) in pairwise(samples):
            # Halfway, inverses of two numbers with the ratio exp(r) differ from numbers by r^2 / 4, logarithms by half.
            count = math.ceil(abs(math.log(last / first)) / (2 * math.sqrt(_TOLERANCE)))
            for share in (i / count for i in range(1, count) if len(found) < MAX_KEYS):
                time = start + share * (end - start)
                found[self.opened.seconds(time)] = first + share * (last - first)
        return found

    def _add_exposure(self, values: dict[str, Any]) -> None:
        """Adds the exposure time and the sensitivity, if the camera has an exposure time. `exposure` is a factor 2^n on
        the sensitivity."""
        camera = UsdGeom.Camera(self.prim)
        if not camera.GetExposureTimeAttr().HasAuthoredValue():
            return
        values["exposure_time_s"] = self._number("exposure:time")
        values["iso"] = self._number("exposure:iso") * 2 ** self._number("exposure")

    def _number(self, name: str, time: float | None = None) -> float:
        """Returns the number of an attribute; 0 if the camera lacks it. Raises SceneFileError for other values."""
        attribute = self.prim.GetAttribute(name)
        value = attribute.Get(self.opened.time if time is None else Usd.TimeCode(time)) if attribute else None
        if value is None:
            return 0.0
        if not isinstance(value, (int, float)) or not math.isfinite(value):
            raise self.opened.fail(attribute.GetPath(), f"expected a finite number; found {value!r:.60}")
        return float(value)
