"""One window's camera: what the user has set, and the picture and the lens that follow."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from .._core import Film, InputError, Lens, LensFileError, Plan, RealcamError, RenderSettings
from ..drawing.cut import PLANES
from ..image import Image
from ..number_text import counted, duration_text
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
from .light_meter import middle_grey_lx_s
from .listeners import Listeners, Problem
from .picture_loop import PictureLoop
from .picture_request import MOST_SPP, Frame, PictureRequest
from .preview_denoiser import why_missing
from .ring_scales import Ring

_BOUNCES_UNPLANNED = 8  # with which glass is no black, until the plan says how many


class LensBench:
    """Holds a shot's scene before a camera that a user changes. Functions may be called from one thread at a time.

    A change that makes no camera leaves everything as it is, and is told as a Problem; the next that makes one ends it.
    """

    def __init__(self, shot: Shot, *, device: str = "auto", noise_codes: float = 1.0) -> None:
        self.shot, self._device = shot, device
        self.listeners = Listeners()
        self.controls = CameraControls.of(shot.camera)
        self.history = History(self.controls.mount)
        self.switches = Switches.of_shot(shot.settings.effects)
        self.plan: Plan | None = None
        self.problem: Problem | None = None
        self.noise_codes = noise_codes
        self.why_no_denoiser = why_missing(device)
        self.denoises = not self.why_no_denoiser
        self.hovered: tuple[float, float] | None = None
        self._plane = "yz"
        self._copies: list[tuple[Lens, Lens]] = []  # with the lens that each is a copy of
        self.comparison = Comparison()
        self._lock = threading.Lock()  # of controls, which the picture's thread changes, too
        self._frame: Frame | None = None
        self._loops = {"a": self._new_loop("a")}
        self._follow_ups = FollowUps(shot, device, self.listeners)

    def close(self) -> None:
        """Ends all threads of the window."""
        self.listeners.leave()
        self._follow_ups.close()
        for loop in self._loops.values():
            loop.close()

    # The camera.

    def show(self) -> None:
        """Photographs and draws everything as it stands, for a page that has just been opened."""
        self._photograph()
        self._draw()
        self._ask_for_plan()
        self.listeners.controls()
        self.listeners.problem(self.problem)

    def change(self, **changes: Any) -> bool:
        """Sets fields of CameraControls. Whether a camera came of it."""
        return self._take(lambda: replace(self.controls, **changes), of="picture")

    @property
    def apertures(self) -> Ring:
        return self.controls.apertures

    def turn(self, ring: str, steps: int) -> bool:
        """Turns a ring or dial by steps; see CameraControls.turned. Raises InputError."""
        turned = self.controls.turned(ring, steps)
        if ring == "zoom":
            return turned.zoom != self.controls.zoom and self.set_zoom(turned.zoom)
        return self._take(lambda: turned, of="picture")

    def set_zoom(self, zoom: str | float | None, gesture: object = None) -> bool:
        """The zoom ring (see CameraControls), which undo takes back. gesture: the same for all steps of one drag."""
        if not self._take(lambda: replace(self.controls, zoom=zoom).focused_within_reach(), of="picture"):
            return False
        self._push(gesture)
        return True

    def orbit(self, right: float, up: float) -> bool:
        """By shares of the picture's height: that much of it is about a radian."""
        return self.change(pose=self.controls.pose.orbited(-2.5 * right, -2.5 * up))

    def pan(self, right: float, up: float) -> bool:
        """By shares of the picture's height, so that what is looked at follows the mouse."""
        height = self.controls.seen_height_m
        return self.change(pose=self.controls.pose.panned(-right * height, -up * height))

    def dolly(self, steps: float) -> bool:
        """Nearer by a tenth of the distance for each step."""
        return self.change(pose=self.controls.pose.dollied(0.9**steps))

    def focus_at(self, u: float, v: float) -> bool:
        """Focuses at what is at u, v of the picture."""
        distance = self._loops["a"].point(u, v).result().distance_m
        return self._take(lambda: replace(self.controls, focus_m=distance).focused_within_reach(), of="picture")

    def meter_at(self, u: float, v: float) -> bool:
        """Exposes so that what is around u, v becomes middle grey."""
        illuminance = self._loops["a"].point(u, v).result().illuminance_lx
        if not illuminance > 0:
            self.report(Problem("there is no light where the meter looks", of="picture"))
            return False
        now = self.controls
        wanted = middle_grey_lx_s(now.iso, now.compensation_ev)
        return self.change(exposure_time_s=wanted / illuminance, is_automatic=False)

    def set_resolution(self, width: int) -> bool:
        """Pixels across; the height follows from the film."""
        return self._take(lambda: replace(self.controls, film=of_width(self.controls.film, width)), of="picture")

    def set_film_mm(self, width_mm: float, height_mm: float) -> bool:
        """Another size of the film, with as many pixels across, which undo takes back as it does another lens."""

        def changed() -> CameraControls:
            film = self.controls.film.replace(width_mm=width_mm, height_mm=height_mm)
            return replace(self.controls, film=of_width(film, film.resolution[0]))

        if not self._take(changed, of="picture"):
            return False
        self._push()
        return True

    def restore(self, state: dict[str, Any]) -> bool:
        """What a page has kept of the bench that it had before; see bench_state."""
        switches = state.get("switches")
        if not self._take(lambda: restored(self.controls, state)):
            return False
        self.history = History(self.controls.mount)
        for effect, setting in (switches if isinstance(switches, dict) else {}).items():
            self.switch(effect, setting)
        self.listeners.controls()
        return True

    # The lens.

    def set_lens(self, lens: Lens) -> bool:
        """Another lens on the camera, with its own film."""
        mount = Mount(lens, Film.for_lens(lens), self.controls.with_lens(lens).zoom)
        if not self._take(lambda: self._fitted(mount)):
            return False
        self._push()
        return True

    def edit(self, edited: Callable[[Lens], Lens], gesture: object = None) -> bool:
        """Changes the lens; see lens_edits. gesture: the same for all steps of one drag."""
        if not self._take(lambda: self.controls.with_lens(edited(self.controls.lens)).focused_within_reach()):
            return False
        self._push(gesture)
        return True

    def edit_value(self, surface: int, field: str, value: Any, gesture: object = None) -> bool:
        """Changes a number or glass of the table (see lens_edits.with_value), which shows the lens as it is focused."""

        def edited(lens: Lens) -> Lens:
            wanted = value
            if field == "thickness_mm" and isinstance(value, int | float):
                wanted = value - self.controls.focusing_shift_mm(surface)
            return with_value(lens, surface, field, wanted)

        return self.edit(edited, gesture)

    def another_copy(self, grade: str) -> bool:
        """The lens with random errors of a grade; a copy is replaced by another one of the same lens."""
        lens = self.controls.lens
        drawn = next((drawn for copy, drawn in self._copies if copy == lens), lens)
        if not self.edit(lambda _: random_copy(drawn, grade)):
            return False
        self._copies.append((self.controls.lens, drawn))
        return True

    def undo(self) -> bool:
        return self.history.can_undo and self._step(self.history.undo, self.history.redo)

    def redo(self) -> bool:
        return self.history.can_redo and self._step(self.history.redo, self.history.undo)

    def _step(self, there: Callable[[], Mount], back: Callable[[], Mount]) -> bool:
        mount = there()
        if self._take(lambda: self._fitted(mount)):
            return True
        back()
        return False

    def _push(self, gesture: object = None) -> None:
        self.history.push(self.controls.mount, gesture)
        self.listeners.controls()

    def _fitted(self, mount: Mount) -> CameraControls:
        """The camera with a lens and the film that belongs to it, of as many pixels across as now."""
        controls = self.controls.with_mount(mount)
        try:
            return controls.focused_within_reach()
        except InputError:  # too near for it, and its file does not say what its nearest focus is
            return replace(controls, focus_m=math.inf)

    def hover(self, u: float, v: float) -> None:
        """Draws the rays of what is at u, v of the picture."""
        self.hovered = u, v
        self._trace()

    def cut(self, plane: str) -> None:
        """Draws the lens in the plane "yz" or "xz". Raises InputError for another."""
        if plane not in PLANES:
            raise InputError(f'there is no plane "{plane:.10}"')
        self._plane = plane
        self._draw()

    # Effects, and what the picture is compared with.

    def switch(self, effect: str, state: str) -> None:
        """effect: one of EFFECTS. state: "auto", "on" or "off". Raises InputError."""
        if effect not in EFFECTS or state not in ("auto", "on", "off"):
            raise InputError(f'there is no switch "{effect:.40}" that could be "{state:.10}"')
        self.switches.of[effect] = state
        self._keep()
        self._photograph()
        self._ask_for_plan()

    def set_noise(self, codes: float) -> None:
        """Refines the picture until its noise is as small."""
        self.noise_codes = codes
        self._photograph()

    def set_denoising(self, is_on: bool) -> None:
        """Shows pictures without their noise for as long as they are refined. Raises InputError without a denoiser."""
        if is_on and self.why_no_denoiser:
            raise InputError(self.why_no_denoiser)
        self.denoises = is_on
        self._photograph()

    def compare(self, with_what: str, lens: Lens | None = None) -> None:
        """Shows a second picture; see Comparison. Raises InputError where its camera makes none."""
        comparison = Comparison.of(with_what, self.controls, lens)
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
        self._photograph()
        self.listeners.controls()

    def measure_rungs(self) -> None:
        """Takes the shot at all levels of simulation, in few pixels, and tells what each costs (docs/accuracy.md)."""
        self._follow_ups.measure_levels(self.controls.camera)

    # What comes of it.

    def image(self, slot: str = "a") -> Image:
        """The picture as it is shown, denoised or not, with all its pixels; waits for the first samples of them."""
        return self._loops[slot].image().result()

    @property
    def asked(self) -> dict[str, int]:
        """The serials of the pictures that were asked for last, by their slots. On the thread of the user's actions."""
        return {slot: loop.serial for slot, loop in self._loops.items()}

    @property
    def is_refined(self) -> bool:
        """Whether the picture has the noise that is asked for, or as many samples as a picture may have."""
        frame = self._frame
        return frame is not None and frame.is_final and frame.serial >= self._loops["a"].serial

    @property
    def progress(self) -> str:
        """How far the picture is on its way there, in words."""
        frame = self._frame
        if frame is None or frame.serial < self._loops["a"].serial:
            return "it has just begun"
        samples = f"{counted(frame.samples, 'sample')} per pixel"
        if frame.noise_codes is None:
            return samples
        return f"{samples}, noise {frame.noise_codes:.1f} of 255 grey levels where {self.noise_codes:g} is wanted"

    @property
    def time_left(self) -> str:
        """How long the picture takes to be refined, in words."""
        frame = self._frame
        if self.is_refined:
            return "none"
        if frame is None or frame.serial < self._loops["a"].serial or frame.left_s is None:
            return "not known yet"
        text = f"about {duration_text(frame.left_s)}"
        final = frame.final_noise_codes
        if final is None or final < 1.1 * self.noise_codes:  # the forecast's own error
            return text
        return f"{text}, to about {final:.2g} grey levels: {counted(MOST_SPP, 'sample')} per pixel are the most here"

    def show_again(self) -> None:
        """Sends the picture as it is once more."""
        self._photograph()

    def set_jpeg_quality(self, quality: int) -> None:
        for loop in self._loops.values():
            loop.jpeg_quality = quality

    def _new_loop(self, slot: str) -> PictureLoop:
        return PictureLoop(
            self.shot.scene,
            lambda frame: self._take_frame(slot, frame),
            self._take_failure,
            device=self._device,
        )

    def _take_failure(self, serial: int, message: str) -> None:
        self.report(Problem(message, of="picture"))

    def _take_frame(self, slot: str, frame: Frame) -> None:
        if slot == "a":
            self._frame = frame
            with self._lock:
                before = self.controls
                if before.is_automatic:
                    # Not a change by the user: it stays so when the exposure is no longer automatic.
                    self.controls = replace(before, exposure_time_s=frame.exposure_time_s)
            if before.is_automatic and abs(math.log2(frame.exposure_time_s / before.exposure_time_s)) > 0.01:
                self.listeners.controls()
        self.listeners.frame(slot, frame)

    def _take(self, changed: Callable[[], CameraControls], *, of: str = "lens") -> bool:
        """Tries a change; where no camera comes of it, everything stays as it is. of: see Problem."""
        before = self.controls
        try:
            controls = changed()
            controls.camera  # noqa: B018
        except RealcamError as error:
            # Messages count surfaces from 1.
            surface = error.surface - 1 if isinstance(error, LensFileError) and error.surface > 0 else None
            self.report(Problem(str(error), surface, of))
            return False
        with self._lock:
            if before.is_automatic and controls.is_automatic:
                controls = replace(controls, exposure_time_s=self.controls.exposure_time_s)
            self.controls = controls
        self.report(None)
        self._photograph()
        if _drawn(before) != _drawn(controls):
            self._draw()
        self._ask_for_plan()
        self._keep()
        if replace(before, pose=controls.pose) != controls:
            self.listeners.controls()
        return True

    def report(self, problem: Problem | None) -> None:
        """Tells a problem, which ends with the next change that can be made; None: there is none any more."""
        if problem != self.problem:
            self.problem = problem
            self.listeners.problem(problem)

    def _settings(self, switches: Switches) -> RenderSettings:
        """Those of a picture: what is left to the plan as it says, or as pictures are taken until there is one."""
        settings = self.shot.settings.with_(effects=switches.named(self.plan))
        if settings.max_bounces == "auto":
            settings = settings.with_(max_bounces=self.plan.max_bounces if self.plan else _BOUNCES_UNPLANNED)
        return settings

    def _request(self, controls: CameraControls) -> PictureRequest:
        return PictureRequest(
            camera=controls.camera,
            settings=self._settings(self.switches.of_model(controls.model)),
            tone=self.shot.tone,
            is_automatic=controls.is_automatic,
            compensation_ev=controls.compensation_ev,
            noise_codes=self.noise_codes,
            denoises=self.denoises,
        )

    def _photograph(self) -> None:
        self._loops["a"].submit(self._request(self.controls))
        try:
            other = self.comparison.beside(self.controls)
            if other is not None:
                self._loops["b"].submit(self._request(other))
        except RealcamError as error:
            self.report(Problem(f"the picture to compare with: {error}", of="picture"))

    def _draw(self) -> None:
        self._follow_ups.draw(self.controls.lens_on_film, self._drawn_plane)
        self._follow_ups.measure_depth_of_field(self.controls.set_lens, self.controls.film)
        self._trace()

    def _trace(self) -> None:
        lens, plane = self.controls.lens_on_film, self._drawn_plane
        axis = None if lens.is_rotational else PLANES[plane]
        self._follow_ups.trace(lens, drawn_heights_mm(self.controls.film, self.hovered, axis), plane)

    @property
    def _drawn_plane(self) -> str:
        """All planes of a lens of revolution are alike."""
        return "yz" if self.controls.lens_on_film.is_rotational else self._plane

    def _keep(self) -> None:
        self._follow_ups.keep(self.controls, dict(self.switches.of))

    def _ask_for_plan(self) -> None:
        if "auto" in self.switches.of.values() or self.shot.settings.max_bounces == "auto":
            self._follow_ups.plan(self.controls.camera, self.switches.as_words(), self._take_plan)
        else:
            self.plan = None
            self._follow_ups.plan_nothing(self._take_plan)  # how the switches stand is told all the same

    def _take_plan(self, plan: Plan | None, note: str) -> None:
        before = self._settings(self.switches)
        self.plan = plan
        self.listeners.plan(plan, note)
        if self._settings(self.switches) != before:
            self._photograph()


def _drawn(controls: CameraControls) -> tuple[Any, ...]:
    """What the drawing of a lens shows."""
    film = controls.film
    size = film.width_mm, film.height_mm, film.shift_mm
    return controls.lens, controls.zoom, controls.focus_m, controls.f_number, size
