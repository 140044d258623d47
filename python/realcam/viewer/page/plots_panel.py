"""Panel of lens plots for the point that was clicked."""

from __future__ import annotations

import asyncio
import html

from nicegui import ui

from ..._core import RealcamError
from ..lens_view import height_of
from ..newest_task import NewestTask
from ..server.server_loop import call_on_loop
from ..worker_process import WorkerProcess, WorkError
from .close_look import PLOTS, PlotRequest, plot_svg, plots_of
from .window import Window

_TIMEOUT_S = 120.0  # long enough for a machine that is busy rendering
#: Process that draws for all windows, so that plots do not block the rendering threads of this one.
plotter = WorkerProcess()


class PlotsPanel:
    """Shows one plot of the lens, drawn once changes have stopped, and only while the panel is shown."""

    def __init__(self, window: Window) -> None:
        self._bench = window.bench
        self._loop = asyncio.get_running_loop()
        self._task = NewestTask("realcam-plots", quiet_s=0.3)  # during a movement the pictures need the processor
        self._picture_point = (0.5, 0.5)
        self._request: PlotRequest | None = None
        self._is_shown = False
        with ui.element("section").props('aria-label="Plots of the lens"'):
            self._kind = ui.select({kind: title for kind, (title, _) in PLOTS.items()}, value="spot", label="Plot")
            self._kind.classes("w-full").props('data-testid="plot"').on("update:model-value", self.update)
            self._help = ui.label().classes("rc-note")
            self._point = ui.label().classes("rc-note").props('data-testid="plot-point"')
            with ui.element("div").classes("rc-plot-box"):
                self._plot = ui.html("", sanitize=False).classes("w-full rc-plot").props('data-testid="plot-svg"')
                self._busy = ui.row().classes("rc-busy").props('data-testid="plot-busy" role="status"')
                with self._busy:
                    ui.spinner(size="1.5rem")
                    ui.label("Drawing the plot ...")

    def show(self, is_shown: bool) -> None:
        """Notifies that the panel is shown or hidden. On the server's loop."""
        self._is_shown = is_shown
        self.update()

    def close(self) -> None:
        self._task.close()

    def pick(self, u: float, v: float) -> None:
        """Selects the picture point for plots of a single field."""
        self._picture_point = u, v
        self.update()

    def update(self) -> None:
        """Requests a new plot if its arguments have changed. On the server's loop."""
        if not self._is_shown:
            return
        controls = self._bench.controls
        lens = controls.lens_on_film
        plots = plots_of(lens)
        if self._kind.value not in plots:
            self._kind.set_options({kind: title for kind, (title, _) in plots.items()}, value=next(iter(plots)))
        kind = self._kind.value
        self._help.set_text(plots[kind][1])
        height = height_of(*self._picture_point, controls.film)
        text = (
            f"The point is {height:.3g} mm from the lens's axis on the film" if lens.is_rotational else "Over the film"
        )
        self._point.set_text(f"{text}, in the plane in focus. Click the picture to choose a point.")
        request = PlotRequest(kind, lens, height)
        if request != self._request:
            self._request = request
            self._plot.set_content("")
            self._busy.set_visibility(True)
            self._task.submit(lambda: self._draw(request))

    def _draw(self, request: PlotRequest) -> None:
        try:
            try:
                content = plotter.call(plot_svg, request, seconds=_TIMEOUT_S)
            except WorkError:  # retries once, as the failure may be unrelated to this plot
                content = plotter.call(plot_svg, request, seconds=_TIMEOUT_S)
        except WorkError as error:
            content = f'<p class="rc-problem">There is no plot: drawing {error}</p>'
        except RealcamError as error:
            content = f'<p class="rc-problem">{html.escape(str(error))}</p>'
        call_on_loop(self._loop, self._show, request, content)

    def _show(self, request: PlotRequest, content: str) -> None:
        if request == self._request:
            self._plot.set_content(content)
            self._busy.set_visibility(False)
