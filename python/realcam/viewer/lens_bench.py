"""The bench of one window: the user's settings, and the picture and lens views that follow from them."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from .._core import InputError, Lens, LensFileError, Plan, RealcamError, RenderSettings
from ..image import Image
from ..number_text import counted, duration_text
from ..ocio import OcioView
from ..section.cut import PLANES
from ..shot import Shot
from ..tolerance import random_copy
from .bench_state import restored
from .camera_controls import CameraControls, Mount, of_width
from .comparison import Comparison
from .effect_switches import EFFECTS, Switches
from .follow_ups import FollowUps
from .history import History
from .lens_edits import with_value
from .lens_view import drawn_heights_mm
from .listeners import Listeners, Problem
from .pictures.light_meter import middle_grey_lx_s
from .pictures.picture_loop import PictureLoop
from .pictures.picture_request import MAX_SPP, Frame, PictureRequest
from .pictures.preview_denoiser import why_missing
from .ring_scales import Ring

_BOUNCES_UNPLANNED = 8  # path length until there is a plan; enough that objects of glass are not black


class LensBench:
    """A shot's scene and a camera that the user changes. Functions may be called from one thread at a time.

    Functions that change the camera return true on success. A change that leads to an invalid camera has no effect, and
    is reported as a Problem, which ends with the next valid change. Picture coordinates u, v: 0 to 1, from the upper
    left corner. device: for rendering, as for realcam.render. noise_codes: noise to which the picture is refined, in
    8-bit codes.
    """

    def __init__(self, shot: Shot, *, device: str = "auto", noise_codes: float = 1.0) -> None:
        self.shot, self._device = shot, device
        self.tone = shot.tone  #: develops the pictures
        self.listeners = Listeners()
        self.controls = CameraControls.of(shot.camera)
        self.history = History(self.controls.mount)
        self.switches = Switches.from_shot(shot.settings.effects)
        self.plan: Plan | None = None
        self.problem: Problem | None = None
        self.noise_codes = noise_codes
        self.why_no_denoiser = why_missing(device)
        self.denoises = not self.why_no_denoiser
        self.hovered: tuple[float, float] | None = None
        self._plane = "yz"
        self._copies: list[tuple[Lens, Lens]] = []  # pairs of a toleranced copy and its nominal lens
        self.comparison = Comparison()
        self._lock = threading.Lock()  # guards controls, which the picture's thread also changes
        self._frame: Frame | None = None
        self._loops = {"a": self._new_loop("a")}  # by slot: "a" is the picture, "b" the one to compare with
        self._follow_ups = FollowUps(shot, device, self.listeners)

    def close(self) -> None:
        """Ends all threads of the window."""
        self.listeners.leave()
        self._follow_ups.close()
        for loop in self._loops.values():
            loop.close()

    # The camera.

    def show(self) -> None:
        """Renders and draws the current state, for a page that has just been opened."""
        self._request_pictures()
        self._draw()
        self._request_plan()
        self.listeners.controls()
        self.listeners.problem(self.problem)

    def change(self, **changes: Any) -> bool:
        """Sets fields of CameraControls."""
        return self._apply(lambda: replace(self.controls, **changes), view="picture")

    @property
    def apertures(self) -> Ring:
        """The aperture ring of the lens."""
        return self.controls.apertures

    def turn(self, ring: str, steps: int) -> bool:
        """Turns a ring or dial by steps; see CameraControls.turned. Raises InputError."""
        turned = self.controls.turned(ring, steps)
        if ring == "zoom":
            return turned.zoom != self.controls.zoom and self.set_zoom(turned.zoom)
        return self._apply(lambda: turned, view="picture")

    def set_zoom(self, zoom: str | float | None, gesture: object = None) -> bool:
        """Sets the zoom (see CameraControls); can be undone. gesture: equal for all steps of one drag."""
        if not self._apply(lambda: replace(self.controls, zoom=zoom).focused_within_reach(), view="picture"):
            return False
        self._push(gesture)
        return True

    def orbit(self, right: float, up: float) -> bool:
        """Orbits about the look-at point. right, up: mouse movement over the picture's height; 0.4 is a radian."""
        return self.change(pose=self.controls.pose.orbited(-2.5 * right, -2.5 * up))

    def pan(self, right: float, up: float) -> bool:
        """Pans so that the look-at point follows the mouse. right, up: mouse movement over the picture's height."""
        height = self.controls.seen_height_m
        return self.change(pose=self.controls.pose.panned(-right * height, -up * height))

    def dolly(self, steps: float) -> bool:
        """Moves towards the look-at point by a tenth of the distance per step."""
        return self.change(pose=self.controls.pose.dollied(0.9**steps))

    def focus_at(self, u: float, v: float) -> bool:
        """Focuses on the object at u, v of the picture."""
        distance = self._loops["a"].point(u, v).result().distance_m
        return self._apply(lambda: replace(self.controls, focus_m=distance).focused_within_reach(), view="picture")

    def meter_at(self, u: float, v: float) -> bool:
        """Sets the exposure time so that the spot around u, v becomes middle grey."""
        illuminance = self._loops["a"].point(u, v).result().illuminance_lx
        if not illuminance > 0:
            self.report(Problem("no light reaches the metered point", view="picture"))
            return False
        exposure_lx_s = middle_grey_lx_s(self.controls.iso, self.controls.compensation_ev)
        return self.change(exposure_time_s=exposure_lx_s / illuminance, is_automatic=False)

    def set_resolution(self, width: int) -> bool:
        """Sets the width of the picture in pixels; its height follows from the film's size."""

        def changed() -> CameraControls:
            controls = self.controls
            return replace(controls, film=of_width(controls.film, width, controls.pixel_aspect))

        return self._apply(changed, view="picture")

    def set_film_mm(self, width_mm: float, height_mm: float) -> bool:
        """Sets the film's size; the picture keeps its width in pixels. Can be undone."""

        def changed() -> CameraControls:
            film = self.controls.film.replace(width_mm=width_mm, height_mm=height_mm)
            return replace(self.controls, film=of_width(film, film.resolution[0], self.controls.pixel_aspect))

        if not self._apply(changed, view="picture"):
            return False
        self._push()
        return True

    def restore(self, state: dict[str, Any]) -> bool:
        """Restores the state of an earlier bench, stored by the page; see bench_state."""
        switches = state.get("switches")
        if not self._apply(lambda: restored(self.controls, state)):
            return False
        self.history = History(self.controls.mount)
        for effect, setting in (switches if isinstance(switches, dict) else {}).items():
            self.switch(effect, setting)
        self.listeners.controls()
        return True

    # The lens.

    def set_lens(self, lens: Lens) -> bool:
        """Mounts another lens with its own film, or with that of the calibration."""
        mount = Mount(lens, self.controls.film_for(lens), self.controls.with_lens(lens).zoom)
        if not self._apply(lambda: self._fitted(mount)):
            return False
        self._push()
        return True

    def edit(self, edited: Callable[[Lens], Lens], gesture: object = None) -> bool:
        """Replaces the lens by the result of `edited` (see lens_edits); can be undone. gesture: equal for all steps of
        one drag."""
        if not self._apply(lambda: self.controls.with_lens(edited(self.controls.lens)).focused_within_reach()):
            return False
        self._push(gesture)
        return True

    def edit_value(self, surface: int, field: str, value: Any, gesture: object = None) -> bool:
        """Changes a number or glass of the table (see lens_edits.with_value). The table shows the focused lens, so that
        a thickness is converted to the unfocused one."""

        def edited(lens: Lens) -> Lens:
            unfocused = value
            if field == "thickness_mm" and isinstance(value, int | float):
                unfocused = value - self.controls.focusing_shift_mm(surface)
            return with_value(lens, surface, field, unfocused)

        return self.edit(edited, gesture)

    def another_copy(self, grade: str) -> bool:
        """Replaces the lens by a random copy with the tolerances of a grade (see realcam.Tolerances); can be undone.

        If the lens is such a copy, it is replaced by another copy of its nominal lens.
        """
        lens = self.controls.lens
        nominal = next((nominal for copy, nominal in self._copies if copy == lens), lens)
        if not self.edit(lambda _: random_copy(nominal, grade)):
            return False
        self._copies.append((self.controls.lens, nominal))
        return True

    def undo(self) -> bool:
        """Undoes the last change of lens, film or zoom."""
        return self.history.can_undo and self._step(self.history.undo, self.history.redo)

    def redo(self) -> bool:
        """Redoes the last change that was undone."""
        return self.history.can_redo and self._step(self.history.redo, self.history.undo)

    def _step(self, step: Callable[[], Mount], inverse: Callable[[], Mount]) -> bool:
        """Moves in the history by `step`; back by `inverse` if the camera would be invalid."""
        mount = step()
        if self._apply(lambda: self._fitted(mount)):
            return True
        inverse()
        return False

    def _push(self, gesture: object = None) -> None:
        """Adds the current lens, film and zoom to the history."""
        self.history.push(self.controls.mount, gesture)
        self.listeners.controls()

    def _fitted(self, mount: Mount) -> CameraControls:
        """The controls with a lens and its film, and the same number of pixels across."""
        controls = self.controls.with_mount(mount)
        try:
            return controls.focused_within_reach()
        except InputError:  # the focus is too close for the lens, and its file has no nearest focus
            return replace(controls, focus_m=math.inf)

    def hover(self, u: float, v: float) -> None:
        """Draws the rays to the film point at u, v of the picture."""
        self.hovered = u, v
        self._trace()

    def cut(self, plane: str) -> None:
        """Draws the section of the lens in the plane "yz" or "xz". Raises InputError for another plane."""
        if plane not in PLANES:
            raise InputError(f'unknown plane "{plane:.10}"; expected {" or ".join(PLANES)}')
        self._plane = plane
        self._draw()

    # Effects and comparison.

    def switch(self, effect: str, state: str) -> None:
        """Sets the switch of an effect. effect: one of EFFECTS. state: "auto", "on" or "off". Raises InputError."""
        if effect not in EFFECTS or state not in ("auto", "on", "off"):
            raise InputError(f'the switch "{effect:.40}" cannot be set to "{state:.10}"')
        self.switches.states[effect] = state
        self._store_state()
        self._request_pictures()
        self._request_plan()

    def set_noise(self, codes: float) -> None:
        """Sets the noise to which the picture is refined, in 8-bit codes."""
        self.noise_codes = codes
        self._request_pictures()

    def set_view(self, display: str, view: str) -> None:
        """Sets the view that develops the pictures. Raises InputError if the configuration does not have it, or if the
        shot has no configuration of OpenColorIO."""
        if not isinstance(self.tone, OcioView):
            raise InputError("the shot has no configuration of OpenColorIO (--ocio)")
        self.tone = replace(self.tone, display=display, view=view)
        self._request_pictures()

    def set_denoising(self, is_on: bool) -> None:
        """Switches denoising of pictures that are still being refined. Raises InputError without a denoiser."""
        if is_on and self.why_no_denoiser:
            raise InputError(self.why_no_denoiser)
        self.denoises = is_on
        self._request_pictures()

    def compare(self, kind: str, lens: Lens | None = None) -> None:
        """Shows a second picture beside the first.

        kind: one of COMPARISONS. lens: the lens of the kind "another lens". Raises InputError if its camera is invalid.
        """
        comparison = Comparison.of(kind, self.controls, lens)
        other = comparison.beside(self.controls)
        if other is not None:
            other.camera  # noqa: B018
        self.comparison = comparison
        if other is None:
            loop = self._loops.pop("b", None)
            if loop:
                loop.close()
        elif "b" not in self._loops:
            self._loops["b"] = self._new_loop("b")
        self._request_pictures()
        self.listeners.controls()

    def measure_levels(self) -> None:
        """Renders the shot at all levels of simulation with few pixels, and reports their costs (docs/accuracy.md)."""
        self._follow_ups.measure_levels(self.controls.camera)

    # Results.

    def image(self, slot: str = "a") -> Image:
        """Returns the picture as shown, denoised or not, at full resolution; waits for its first samples."""
        return self._loops[slot].image().result()

    @property
    def requested_serials(self) -> dict[str, int]:
        """Serial numbers of the pictures last requested, by slot. Must be read on the thread of the user's actions."""
        return {slot: loop.serial for slot, loop in self._loops.items()}

    @property
    def is_refined(self) -> bool:
        """True if the picture has the requested noise, or the maximum number of samples."""
        frame = self._frame
        return frame is not None and frame.is_final and frame.serial >= self._loops["a"].serial

    @property
    def progress(self) -> str:
        """Progress of the refinement, as text."""
        frame = self._frame
        if frame is None or frame.serial < self._loops["a"].serial:
            return "no samples yet"
        samples = f"{counted(frame.samples, 'sample')} per pixel"
        if frame.noise_codes is None:
            return samples
        return f"{samples}, noise {frame.noise_codes:.1f} of 255 grey levels; the goal is {self.noise_codes:g}"

    @property
    def time_left(self) -> str:
        """Remaining time of the refinement, as text."""
        frame = self._frame
        if self.is_refined:
            return "none"
        if frame is None or frame.serial < self._loops["a"].serial or frame.left_s is None:
            return "not known yet"
        text = f"about {duration_text(frame.left_s)}"
        final = frame.final_noise_codes
        if final is None or final < 1.1 * self.noise_codes:  # within the error of the forecast
            return text
        limit = counted(MAX_SPP, "sample")
        return f"{text}, until a noise of about {final:.2g} grey levels at the limit of {limit} per pixel"

    def show_again(self) -> None:
        """Sends the current pictures again, encoded with the current JPEG quality."""
        self._request_pictures()

    def set_jpeg_quality(self, quality: int) -> None:
        """Sets the JPEG quality of later frames, 0 to 100."""
        for loop in self._loops.values():
            loop.jpeg_quality = quality

    def _new_loop(self, slot: str) -> PictureLoop:
        return PictureLoop(
            self.shot.scene,
            lambda frame: self._forward_frame(slot, frame),
            self._report_error,
            device=self._device,
        )

    def _report_error(self, serial: int, message: str) -> None:
        self.report(Problem(message, view="picture"))

    def _forward_frame(self, slot: str, frame: Frame) -> None:
        """Forwards a frame to the page, and stores the exposure time of automatic exposure. On a thread of the loop."""
        if slot == "a":
            self._frame = frame
            with self._lock:
                before = self.controls
                if before.is_automatic:
                    # Stored as the setting, so that the exposure time is retained when automatic exposure is switched
                    # off.
                    self.controls = replace(before, exposure_time_s=frame.exposure_time_s)
            if before.is_automatic and abs(math.log2(frame.exposure_time_s / before.exposure_time_s)) > 0.01:
                self.listeners.controls()
        self.listeners.frame(slot, frame)

    def _apply(self, changed: Callable[[], CameraControls], *, view: str = "lens") -> bool:
        """Applies the controls that `changed` returns, and updates pictures, drawings and plan.

        If it raises RealcamError, or the camera is invalid, reports a problem and returns false. view: see Problem.
        """
        before = self.controls
        try:
            controls = changed()
            controls.camera  # noqa: B018
        except RealcamError as error:
            # Messages count surfaces from 1.
            surface = error.surface - 1 if isinstance(error, LensFileError) and error.surface > 0 else None
            self.report(Problem(str(error), surface, view))
            return False
        with self._lock:
            if before.is_automatic and controls.is_automatic:
                controls = replace(controls, exposure_time_s=self.controls.exposure_time_s)
            self.controls = controls
        self.report(None)
        self._request_pictures()
        if _drawn(before) != _drawn(controls):
            self._draw()
        self._request_plan()
        self._store_state()
        if replace(before, pose=controls.pose) != controls:
            self.listeners.controls()
        return True

    def report(self, problem: Problem | None) -> None:
        """Reports a problem, which ends with the next valid change; None: ends it."""
        if problem != self.problem:
            self.problem = problem
            self.listeners.problem(problem)

    def _settings(self, switches: Switches) -> RenderSettings:
        """Render settings of a picture: values on "auto" follow the plan, or defaults until there is a plan."""
        settings = self.shot.settings.with_(effects=switches.effects_to_simulate(self.plan))
        if settings.max_bounces == "auto":
            settings = settings.with_(max_bounces=self.plan.max_bounces if self.plan else _BOUNCES_UNPLANNED)
        return settings

    def _request(self, controls: CameraControls) -> PictureRequest:
        return PictureRequest(
            camera=controls.camera,
            settings=self._settings(self.switches.restricted_to_model(controls.model)),
            tone=self.tone,
            is_automatic=controls.is_automatic,
            compensation_ev=controls.compensation_ev,
            noise_codes=self.noise_codes,
            denoises=self.denoises,
        )

    def _request_pictures(self) -> None:
        """Requests the picture with the current settings, and the one to compare with."""
        self._loops["a"].submit(self._request(self.controls))
        try:
            other = self.comparison.beside(self.controls)
            if other is not None:
                self._loops["b"].submit(self._request(other))
        except RealcamError as error:
            self.report(Problem(f"comparison: {error}", view="picture"))

    def _draw(self) -> None:
        """Requests the drawing of the lens, its rays and the depth of field."""
        self._follow_ups.draw(self.controls.lens_on_film, self._drawn_plane)
        self._follow_ups.measure_depth_of_field(self.controls.set_lens, self.controls.film)
        self._trace()

    def _trace(self) -> None:
        lens, plane = self.controls.lens_on_film, self._drawn_plane
        axis = None if lens.is_rotational else PLANES[plane]
        self._follow_ups.trace(lens, drawn_heights_mm(self.controls.film, self.hovered, axis), plane)

    @property
    def _drawn_plane(self) -> str:
        """Plane of the drawing; always "yz" for a rotationally symmetric lens, whose meridional planes are equal."""
        return "yz" if self.controls.lens_on_film.is_rotational else self._plane

    def _store_state(self) -> None:
        self._follow_ups.store_state(self.controls, dict(self.switches.states))

    def _request_plan(self) -> None:
        """Requests a plan if a setting depends on it; otherwise discards the plan."""
        if "auto" in self.switches.states.values() or self.shot.settings.max_bounces == "auto":
            self._follow_ups.plan(self.controls.camera, self.switches.as_specs(), self._apply_plan)
        else:
            self.plan = None
            self._follow_ups.cancel_plan(self._apply_plan)  # sends the state of the switches without a plan

    def _apply_plan(self, plan: Plan | None, note: str) -> None:
        """Stores and reports a plan, and requests new pictures if their settings change. On the planner's thread."""
        before = self._settings(self.switches)
        self.plan = plan
        self.listeners.plan(plan, note)
        if self._settings(self.switches) != before:
            self._request_pictures()


def _drawn(controls: CameraControls) -> tuple[Any, ...]:
    """Settings on which the drawing of the lens depends."""
    film = controls.film
    size = film.width_mm, film.height_mm, film.shift_mm
    return controls.lens, controls.zoom, controls.focus_m, controls.f_number, size
