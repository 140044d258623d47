"""A closer look at the lens: plots for the point that was clicked."""

from __future__ import annotations

import asyncio
import html
import multiprocessing
import os
from concurrent.futures import BrokenExecutor, ProcessPoolExecutor
from functools import cache

from nicegui import ui

from .._core import RealcamError
from .close_look import PLOTS, Look, height_of, plot_svg
from .newest_task import NewestTask
from .server_loop import call_on_loop
from .window import Window


@cache
def plotting_process() -> ProcessPoolExecutor:
    """Draws for all windows, where it does not keep the threads of the pictures from running."""
    return ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn"), initializer=os.nice, initargs=(10,))


class PlotsPanel:
    """One plot at a time, drawn on a thread of its own while the lens is changed."""

    def __init__(self, window: Window) -> None:
        self._bench = window.bench
        self._loop = asyncio.get_running_loop()
        self._task = NewestTask("realcam-plots")
        self._at = (0.5, 0.5)
        with ui.element("section").classes("rc-controls").props('aria-label="A closer look"'):
            self._kind = ui.select({kind: title for kind, (title, _) in PLOTS.items()}, value="spot", label="Plot")
            self._kind.classes("w-full").props('data-testid="plot"').on("update:model-value", self.update)
            self._help = ui.label().classes("rc-note")
            self._place = ui.label().classes("rc-note").props('data-testid="plot-place"')
            self._plot = ui.html("", sanitize=False).classes("w-full rc-plot").props('data-testid="plot-svg"')
        self.update()

    def close(self) -> None:
        self._task.close()

    def pick(self, u: float, v: float) -> None:
        """Plots what is of one point for this place in the picture."""
        self._at = u, v
        self.update()

    def update(self) -> None:
        """On the server's loop."""
        kind, controls = self._kind.value, self._bench.controls
        self._help.set_text(PLOTS[kind][1])
        height = height_of(*self._at, (controls.film.width_mm, controls.film.height_mm))
        self._place.set_text(f"{height:.3g} mm from the middle of the film; in the plane in focus")
        look = Look(kind, controls.set_lens, height)
        self._task.submit(lambda: self._draw(look))

    def _draw(self, look: Look) -> None:
        try:
            drawn = plotting_process().submit(plot_svg, look)
        except BrokenExecutor:
            raise
        except RuntimeError:  # the server is going down
            return
        try:
            content = drawn.result()
        except RealcamError as error:
            content = f'<p class="rc-problem">{html.escape(str(error))}</p>'
        call_on_loop(self._loop, self._plot.set_content, content)
