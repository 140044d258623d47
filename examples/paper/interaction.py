"""Figure 9: the system at work. A camera is set, a face of its lens is bent, and the picture follows."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from frame_scene import frame_camera, frame_scene
from realcam import Film, Lens, RenderSettings, devices
from realcam.drawing import draw_states
from realcam.shot import Shot

from .experiment import Experiment, Figure, Row, drawn, photographed

if TYPE_CHECKING:
    from realcam.viewer.lens_bench import LensBench
    from realcam.viewer.pictures.picture_request import Frame

SIDE = 320
SAMPLES = 64
BENT_MM = 26.0  # the first radius, instead of 29.475


def experiment(device: str) -> Experiment:
    title = "Figure 9: the interactive system"
    try:
        from realcam.viewer.lens_bench import LensBench
    except ImportError as error:
        return Experiment(title, (f"Left out: it needs {error.name}; pip install realcam[view] installs it.",))
    lens, scene = Lens.load("double-gauss-50mm"), frame_scene()
    camera = frame_camera().replace(lens=lens.focused(4.0), film=Film(24, 24, (SIDE, SIDE))).metered(scene)
    bench = LensBench(Shot(scene, camera, RenderSettings(effects=())), device=device)
    try:
        steps = _Steps(bench)
        made = steps.take("The camera as it stands", bench.show)
        closed = steps.take("The aperture ring at f/8, and as much longer exposed", lambda: _set_aperture(bench, 8.0))
        _set_aperture(bench, lens.first_order().f_number)
        bent = steps.take(f"Open again, the first face bent to a radius of {BENT_MM:g} mm", lambda: _bend(bench))
        edited = bench.controls.lens
    finally:
        bench.close()
    before, after = (f"{one.first_order().effective_focal_length_mm:.2f} mm" for one in (lens, edited))
    sketch = draw_states([("as it was made", lens), ("its first face bent", edited)], insets=False, width_px=900)
    name = next((str(d) for d in devices() if d.name.startswith(device)), str(devices()[0]))
    return Experiment(
        title,
        (
            "The paper ends with its window, in which the camera is set and the lens is shown and edited. Here that "
            "is a page in the browser (realcam view). The pictures below come from what stands behind that page, "
            "told to do what a user does: after each change a picture of few pixels is there at once, which is then "
            "refined.",
        ),
        (made.figure, closed.figure, bent.figure, drawn("The lens before and after, the film where it was", sketch)),
        (
            Row("aperture ring to first picture", "", f"{1000 * closed.seconds:.0f} ms on {name}"),
            Row("edit of the lens to first picture", "", f"{1000 * bent.seconds:.0f} ms"),
            Row("focal length of the edited lens", "", f"{after}; {before} before"),
        ),
    )


def _set_aperture(bench: LensBench, f_number: float) -> None:
    now = bench.controls
    longer = (f_number / (now.f_number or 1.0)) ** 2
    bench.change(f_number=f_number, exposure_time_s=longer * now.exposure_time_s)


def _bend(bench: LensBench) -> None:
    bench.edit(lambda lens: lens.with_surface(0, radius_of_curvature_mm=BENT_MM))


@dataclass(frozen=True)
class _Step:
    figure: Figure
    seconds: float  #: from the change to its first picture


class _Steps:
    """Changes a bench step by step, and waits each time until the picture is refined."""

    def __init__(self, bench: LensBench) -> None:
        self._bench = bench
        self._frames: list[Frame] = []
        self._news = threading.Condition()
        bench.listeners.frame = self._hear

    def take(self, caption: str, change: Callable[[], object]) -> _Step:
        with self._news:
            last = max((frame.serial for frame in self._frames), default=0)
            self._frames.clear()
        change()
        with self._news:
            self._news.wait_for(lambda: any(self._is_refined(frame) for frame in self._of(last)))
            first = self._of(last)[0]
        return _Step(photographed(caption, self._bench.image()), first.seconds)

    def _of(self, last: int) -> list[Frame]:
        return [frame for frame in self._frames if frame.serial > last]

    @staticmethod
    def _is_refined(frame: Frame) -> bool:
        return frame.is_final or (not frame.is_preview and frame.samples >= SAMPLES)

    def _hear(self, _: str, frame: Frame) -> None:
        with self._news:
            self._frames.append(frame)
            self._news.notify_all()
