"""Secondary results of a camera (drawing, rays, plan, depth of field), each computed on its own thread."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from .. import planning
from .._core import Camera, Film, InputError, Lens, Plan, RealcamError
from ..photography import SharpRange, depth_of_field
from ..photography.depth import usual_circle_mm
from ..shot import Shot
from .bench_state import state_of
from .camera_controls import CameraControls
from .lens_view import lens_view, ray_view
from .level_costs import measured_levels
from .listeners import Listeners
from .newest_task import NewestTask


class FollowUps:
    """Draws, measures and plans for a bench. Of several pending requests of a kind only the newest is done."""

    def __init__(self, shot: Shot, device: str, listeners: Listeners) -> None:
        self._shot, self._device, self._listeners = shot, device, listeners
        self._drawing = NewestTask("realcam-drawing", delay_s=0.02, share=0.2)
        self._tracing = NewestTask("realcam-rays", delay_s=0.02, share=0.2)
        # These take as long as several frames of the picture and therefore wait for the end of a movement.
        self._planning = NewestTask("realcam-planning", quiet_s=0.4)
        self._measuring_levels = NewestTask("realcam-levels")
        self._measuring_depth = NewestTask("realcam-depth-of-field", quiet_s=0.3)
        self._storing = NewestTask("realcam-state", quiet_s=0.5)

    def close(self) -> None:
        """Ends all threads after their current tasks, without waiting for them."""
        quick = self._drawing, self._tracing, self._storing
        for task in (*quick, self._planning, self._measuring_levels, self._measuring_depth):
            task.close()

    def draw(self, lens: Lens, plane: str) -> None:
        """Draws the section of a lens in a plane, "yz" or "xz"."""
        self._drawing.submit(lambda: self._listeners.lens(lens_view(lens, plane)))

    def trace(self, lens: Lens, heights_mm: Sequence[float], plane: str) -> None:
        """Draws the rays that end at these heights on the film."""
        self._tracing.submit(lambda: self._listeners.rays(ray_view(lens, heights_mm, plane)))

    def measure_depth_of_field(self, lens: Lens, film: Film) -> None:
        """Measures the depth of field, with the usual circle of confusion for this film."""

        def measure() -> None:
            try:
                sharp = depth_of_field(lens, usual_circle_mm((film.width_mm, film.height_mm))).real
            except InputError:
                sharp = SharpRange(math.nan, math.nan)
            self._listeners.sharp_range(sharp)

        self._measuring_depth.submit(measure)

    def measure_levels(self, camera: Camera) -> None:
        """Renders the shot at all levels of simulation with few pixels, and reports their costs (docs/accuracy.md)."""

        def measure() -> None:
            self._listeners.levels([], "measuring ...")
            self._listeners.levels(*measured_levels(self._shot.scene, camera, self._device))

        self._measuring_levels.submit(measure)

    def store_state(self, controls: CameraControls, switches: dict[str, str]) -> None:
        """Sends the state to the page, which stores it for a reload."""
        self._storing.submit(lambda: self._listeners.state(state_of(controls, switches)))

    def plan(self, camera: Camera, effects: list[str], on_plan: Callable[[Plan | None, str], None]) -> None:
        """Plans effects, given in the notation of shot files. on_plan: receives the plan and "", or None and the reason
        why there is no plan."""

        def plan() -> None:
            try:
                found = planning.plan(
                    self._shot.scene,
                    camera.replace(model="full"),
                    self._shot.settings,
                    device=self._device,
                    effects=effects,
                )
            except RealcamError as error:
                on_plan(None, str(error))
            else:
                on_plan(found, "")

        self._planning.submit(plan)

    def cancel_plan(self, on_plan: Callable[[Plan | None, str], None]) -> None:
        """Discards a pending request for a plan. on_plan: receives None and ""."""
        self._planning.submit(lambda: on_plan(None, ""))
