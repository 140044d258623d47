"""One window's camera: what the user has set, and the picture and the lens that follow."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from .. import planning
from .._core import Film, InputError, Lens, LensFileError, NothingToPlan, Plan, RealcamError
from ..image import Image
from ..photography import SharpRange, depth_of_field
from ..shot import Shot
from .bench_state import restored, state_of
from .camera_controls import CameraControls
from .comparison import Comparison
from .effect_switches import EFFECTS, Switches
from .lens_edits import LensHistory, with_value
from .lens_view import drawn_heights_mm, lens_view, ray_view
from .level_costs import measured_levels
from .light_meter import middle_grey_lx_s
from .listeners import Listeners, Problem
from .newest_task import NewestTask
from .picture_loop import PictureLoop
from .picture_request import Frame, PictureRequest
from .remote import RemotePictureLoop
from .ring_scales import Ring

AnyPictureLoop = PictureLoop | RemotePictureLoop


class LensBench:
    """Holds a shot's scene before a camera that a user changes. Functions may be called from one thread at a time.

    A change that makes no camera leaves everything as it is, and is told as a Problem; the next that makes one ends it.
    """

    def __init__(
        self, shot: Shot, *, device: str = "auto", make_loop: Callable[..., AnyPictureLoop] = PictureLoop
    ) -> None:
        self.shot, self._device = shot, device
        self.listeners = Listeners()
        self.controls = CameraControls.of(shot.camera)
        self.history = LensHistory(self.controls.lens)
        self.switches = Switches.of_shot(shot.effects)
        self.plan: Plan | None = None
        self.problem: Problem | None = None
        self._without_pictures: Problem | None = None  # why no more come, until the next one does
        self.noise_codes = 1.0
        self.hovered: tuple[float, float] | None = None
        self.comparison = Comparison()
        self._make_loop = make_loop
        self._lock = threading.Lock()  # of controls, which the picture's thread changes, too
        self._loops = {"a": self._new_loop("a")}
        # After the picture's first frame.
        self._drawing = NewestTask("realcam-drawing", delay_s=0.02)
        self._tracing = NewestTask("realcam-rays", delay_s=0.02)
        # Both take as long as some frames of the picture.
        self._planning = NewestTask("realcam-planning", quiet_s=0.4)
        self._measuring_rungs = NewestTask("realcam-rungs")
        self._measuring = NewestTask("realcam-depth-of-field", quiet_s=0.1)
        self._keeping = NewestTask("realcam-state", quiet_s=0.5)

    def close(self) -> None:
        """Ends all threads of the window."""
        self.listeners = Listeners()
        tasks = self._drawing, self._tracing, self._planning, self._measuring, self._measuring_rungs, self._keeping
        for task in tasks:
            task.close()
        for loop in self._loops.values():
            loop.close()

    # The camera.

    def show(self) -> None:
        """Photographs and draws everything as it stands, for a page that has just been opened."""
        self._photograph()
        self._draw()
        self._measure()
        self._ask_for_plan()
        self.listeners.controls()
        self.listeners.problem(self.problem)

    def change(self, **changes: Any) -> bool:
        """Sets fields of CameraControls. Whether a camera came of it."""
        return self._take(lambda: replace(self.controls, **changes))

    @property
    def apertures(self) -> Ring:
        return self.controls.apertures

    def turn(self, ring: str, steps: int) -> bool:
        """Turns a ring or dial by thirds of a stop; see CameraControls.turned. Raises InputError."""
        turned = self.controls.turned(ring, steps)
        return self._take(lambda: turned)

    def orbit(self, right: float, up: float) -> bool:
        """By shares of the picture's height: that much of it is about a radian."""
        return self.change(pose=self.controls.pose.orbited(-2.5 * right, -2.5 * up))

    def pan(self, right: float, up: float) -> bool:
        """By shares of the picture's height, so that what is looked at follows the mouse."""
        height = self.controls.seen_height_m
        return self.change(pose=self.controls.pose.panned(-right * height, up * height))

    def dolly(self, steps: float) -> bool:
        """Nearer by a tenth of the distance for each step."""
        return self.change(pose=self.controls.pose.dollied(0.9**steps))

    def focus_at(self, u: float, v: float) -> bool:
        """Focuses at what is at u, v of the picture."""
        distance = self._loops["a"].point(u, v).result().distance_m
        return self._take(lambda: replace(self.controls, focus_m=distance).focused_within_reach())

    def meter_at(self, u: float, v: float) -> bool:
        """Exposes so that what is around u, v becomes middle grey."""
        illuminance = self._loops["a"].point(u, v).result().illuminance_lx
        if not illuminance > 0:
            self._set_problem(Problem("there is no light where the meter looks"))
            return False
        now = self.controls
        wanted = middle_grey_lx_s(now.iso, now.compensation_ev)
        return self.change(exposure_time_s=wanted / illuminance, is_automatic=False)

    def set_resolution(self, width: int) -> bool:
        """Pixels across; the height follows from the film."""
        film = self.controls.film
        height = max(1, round(width * film.height_mm / film.width_mm))
        return self._take(lambda: replace(self.controls, film=film.replace(resolution=(width, height))))

    def restore(self, state: dict[str, Any]) -> bool:
        """What a page has kept of the bench that it had before; see bench_state."""
        switches = state.get("switches")
        if not self._take(lambda: restored(self.controls, state)):
            return False
        self.history = LensHistory(self.controls.lens)
        for effect, setting in (switches if isinstance(switches, dict) else {}).items():
            self.switch(effect, setting)
        self.listeners.controls()
        return True

    # The lens.

    def set_lens(self, lens: Lens) -> bool:
        """Another lens on the camera, with its own film."""
        width = self.controls.film.resolution[0]
        film = Film.for_lens(lens, None, (width, max(1, round(width * lens.film_mm[1] / lens.film_mm[0]))))

        def controls() -> CameraControls:
            fitted = replace(self.controls.with_lens(lens), film=film)
            try:
                return fitted.focused_within_reach()
            except InputError:  # too near for it, and its file does not say what its nearest focus is
                return replace(fitted, focus_m=math.inf)

        if not self._take(controls):
            return False
        self.history = LensHistory(self.controls.lens)
        self.listeners.controls()
        return True

    def edit(self, edited: Callable[[Lens], Lens], gesture: object = None) -> bool:
        """Changes the lens; see lens_edits. gesture: the same for all steps of one drag."""

        def controls() -> CameraControls:
            return self.controls.with_lens(edited(self.history.lens)).focused_within_reach()

        if not self._take(controls):
            return False
        self.history.push(self.controls.lens, gesture)
        self.listeners.controls()
        return True

    def edit_value(self, surface: int, field: str, value: Any, gesture: object = None) -> bool:
        """Changes a number or glass of the table (see lens_edits.with_value), which shows the lens as it is focused."""

        def edited(lens: Lens) -> Lens:
            wanted = value
            if field == "thickness_mm" and isinstance(value, int | float):
                wanted = value - self.controls.focusing_shift_mm(surface)
            return with_value(lens, surface, field, wanted)

        return self.edit(edited, gesture)

    def undo(self) -> bool:
        return self.history.can_undo and self._step(self.history.undo, self.history.redo)

    def redo(self) -> bool:
        return self.history.can_redo and self._step(self.history.redo, self.history.undo)

    def _step(self, there: Callable[[], Lens], back: Callable[[], Lens]) -> bool:
        lens = there()
        if self._take(lambda: self.controls.with_lens(lens).focused_within_reach()):
            return True
        back()
        return False

    def hover(self, u: float, v: float) -> None:
        """Draws the rays of what is at u, v of the picture."""
        self.hovered = u, v
        self._trace()

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
        camera = self.controls.camera

        def measure() -> None:
            self.listeners.rungs([], "measuring ...")
            self.listeners.rungs(*measured_levels(self.shot.scene, camera, self._device))

        self._measuring_rungs.submit(measure)

    # What comes of it.

    def image(self, slot: str = "a") -> Image:
        """The picture with all its samples; waits for it."""
        return self._loops[slot].image().result()

    def show_again(self) -> None:
        """Sends the picture as it is once more."""
        self._photograph()

    def set_jpeg_quality(self, quality: int) -> None:
        for loop in self._loops.values():
            loop.jpeg_quality = quality

    def _new_loop(self, slot: str) -> AnyPictureLoop:
        return self._make_loop(
            self.shot.scene,
            lambda frame: self._take_frame(slot, frame),
            self._take_failure,
            device=self._device,
            max_bounces=self.shot.max_bounces,
            seed=self.shot.seed,
        )

    def _take_failure(self, serial: int, message: str) -> None:
        if serial == 0:  # it is not about a picture
            self._without_pictures = Problem(message)
        self._set_problem(Problem(message))

    def _take_frame(self, slot: str, frame: Frame) -> None:
        if slot == "a":
            with self._lock:
                before = self.controls
                if before.is_automatic:
                    # Not a change by the user: it stays so when the exposure is no longer automatic.
                    self.controls = replace(before, exposure_time_s=frame.exposure_time_s)
            if before.is_automatic and abs(math.log2(frame.exposure_time_s / before.exposure_time_s)) > 0.01:
                self.listeners.controls()
        if self._without_pictures:
            self._without_pictures = None
            self._set_problem(None)
        self.listeners.frame(slot, frame)

    def _take(self, changed: Callable[[], CameraControls]) -> bool:
        """Tries a change; where no camera comes of it, everything stays as it is."""
        before = self.controls
        try:
            controls = changed()
            controls.camera  # noqa: B018
        except RealcamError as error:
            # Messages count surfaces from 1.
            surface = error.surface - 1 if isinstance(error, LensFileError) and error.surface > 0 else None
            self._set_problem(Problem(str(error), surface))
            return False
        with self._lock:
            if before.is_automatic and controls.is_automatic:
                controls = replace(controls, exposure_time_s=self.controls.exposure_time_s)
            self.controls = controls
        self._set_problem(None)
        self._photograph()
        lens_changed = (before.lens, before.zoom, before.focus_m, before.f_number) != (
            controls.lens,
            controls.zoom,
            controls.focus_m,
            controls.f_number,
        )
        if lens_changed:
            self._draw()
            self._measure()
        self._ask_for_plan()
        self._keep()
        if replace(before, pose=controls.pose) != controls:
            self.listeners.controls()
        return True

    def _set_problem(self, problem: Problem | None) -> None:
        problem = problem or self._without_pictures
        if problem != self.problem:
            self.problem = problem
            self.listeners.problem(problem)

    def _request(self, controls: CameraControls) -> PictureRequest:
        return PictureRequest(
            camera=controls.camera,
            effects=self.switches.of_model(controls.model).named(self.plan),
            tone=self.shot.tone,
            is_automatic=controls.is_automatic,
            compensation_ev=controls.compensation_ev,
            noise_codes=self.noise_codes,
        )

    def _photograph(self) -> None:
        self._loops["a"].submit(self._request(self.controls))
        try:
            other = self.comparison.beside(self.controls)
            if other is not None:
                self._loops["b"].submit(self._request(other))
        except RealcamError as error:
            self._set_problem(Problem(f"the picture to compare with: {error}"))

    def _draw(self) -> None:
        lens = self.controls.set_lens
        self._drawing.submit(lambda: self.listeners.lens(lens_view(lens)))
        self._trace()

    def _trace(self) -> None:
        lens, heights = self.controls.set_lens, drawn_heights_mm(self.controls.film, self.hovered)
        self._tracing.submit(lambda: self.listeners.rays(ray_view(lens, heights)))

    def _keep(self) -> None:
        controls, switches = self.controls, dict(self.switches.of)
        self._keeping.submit(lambda: self.listeners.state(state_of(controls, switches)))

    def _measure(self) -> None:
        lens = self.controls.set_lens

        def measure() -> None:
            try:
                sharp = depth_of_field(lens).real
            except InputError:
                sharp = SharpRange(math.nan, math.nan)
            self.listeners.sharp_range(sharp)

        self._measuring.submit(measure)

    def _ask_for_plan(self) -> None:
        if "auto" not in self.switches.of.values():
            self.plan = None
            self._planning.submit(lambda: self.listeners.plan(None, ""))  # how the switches stand
            return
        controls = self.controls
        words = self.switches.as_words()

        def plan() -> None:
            note = ""
            found: Plan | None = None
            try:
                found = planning.plan(
                    self.shot.scene,
                    controls.camera.replace(model="full"),
                    device=self._device,
                    seed=self.shot.seed,
                    max_bounces=self.shot.max_bounces,
                    effects=words,
                )
            except NothingToPlan as nothing:
                note = str(nothing)
            except RealcamError as error:
                note = str(error)
            before = self.switches.named(self.plan)
            self.plan = found
            self.listeners.plan(found, note)
            if self.switches.named(found) != before:
                self._photograph()

        self._planning.submit(plan)
