"""Layout of the bench's page."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from nicegui import ui
from nicegui.client import Client
from nicegui.element import Element
from nicegui.events import GenericEventArguments

from ..._core import RealcamError
from ..comparison import NOTHING
from ..server.access import Folders
from ..server.server_loop import call_on_loop
from ..shot_source import ShotSource
from .camera_panel import CameraPanel
from .elements import CostPanel, HelpDialog, LensDrawing, PictureCanvas, TabbedPanels
from .lens_panel import ComparisonPanel, LensPanel
from .plots_panel import PlotsPanel
from .save_panel import SavePanel
from .window import Window


def build_page(client: Client, window: Window, folders: Folders, source: ShotSource) -> None:
    """Builds the page and keeps it up to date. Must be called in the page function."""
    loop, bench = asyncio.get_running_loop(), window.bench
    ui.add_head_html('<link rel="stylesheet" href="/realcam/page.css">')
    dark = ui.dark_mode(None)
    ui.colors(primary="#0b5cad")  # contrast of at least 6 under white text, and as text on the light page

    async def run(action: Callable[..., Any], *arguments: Any, **named: Any) -> None:
        """Performs an action of the bench; shows its errors as notifications."""
        try:
            await window.do(action, *arguments, **named)
        except RealcamError as error:
            ui.notify(str(error), type="negative")

    with ui.element("header").classes("rc-header"):
        ui.label(f"realcam: {source.name}").classes("text-lg")
        ui.space()
        again = ui.button("Start again", color=None).props("outline no-caps").classes("rc-flat")
        again.on("click", js_handler="() => [...window.realcamStreams.values()][0].startAgain()")
        again.tooltip("Restores camera, lens and effects of the shot file")
        HelpDialog()
        ui.toggle({None: "Auto", False: "Light", True: "Dark"}, value=None).bind_value_to(dark, "value").props(
            'no-caps aria-label="Colours of the page" data-testid="theme"'
        )
    camera = CameraPanel(window, run)
    with ui.element("main").classes("rc-page"):
        with ui.element("div").classes("rc-column"):
            canvas = PictureCanvas(window.path)
            camera.add_rings()
        with TabbedPanels("Lens", "Camera", "Effects", "Plots", "Save").classes("rc-column") as panels:
            said = ui.label().classes("rc-said").props('aria-live="polite" data-testid="said"')

            def say(text: str, is_problem: bool) -> None:
                """Shows a message above the panels."""
                said.set_text(text)
                said.classes(add="rc-problem" if is_problem else "", remove="" if is_problem else "rc-problem")

            with panels.panel("Lens"):
                lens = LensPanel(window, run, say)
                drawing = LensDrawing(window.path)
            with panels.panel("Camera"):
                camera.add_settings()
                ComparisonPanel(window, run)
            with panels.panel("Effects"):
                CostPanel(window.path)
            with panels.panel("Plots"):
                plots = PlotsPanel(window)
            with panels.panel("Save"):
                save = SavePanel(window, folders, source, say)
    camera.update()
    lens.update()
    panels.on("shown", lambda: plots.show(panels.shown == "Plots"))
    canvas.on("picked", lambda event: _pick(event, plots))

    waiting = False
    last_arguments: dict[str, tuple[bool, ...]] = {"setHistory": (False, False), "setComparison": (False,)}

    def call_if_changed(element: Element, method: str, *values: bool) -> None:
        """Calls a method of a component if its arguments have changed, because each call redraws the component."""
        if last_arguments[method] != values:
            last_arguments[method] = values
            element.run_method(method, *values)

    def update_soon() -> None:
        """Schedules one update for all changes within 0.05 s."""
        nonlocal waiting
        if not waiting:
            waiting = True
            loop.call_later(0.05, update)

    def update() -> None:
        nonlocal waiting
        waiting = False
        with client:
            camera.update()
            lens.update()
            save.update()
            plots.update()
            call_if_changed(drawing, "setHistory", bench.history.can_undo, bench.history.can_redo)
            call_if_changed(canvas, "setComparison", bench.comparison.kind != NOTHING)

    bench.listeners.controls = lambda: call_on_loop(loop, update_soon)
    bench.listeners.sharp_range = lambda sharp: call_on_loop(loop, camera.show_sharp_range, sharp)

    client.on_delete(plots.close)


def _pick(event: GenericEventArguments, plots: PlotsPanel) -> None:
    """Passes the picture point that the user clicked to the plots."""
    point = event.args if isinstance(event.args, dict) else {}
    u, v = point.get("u"), point.get("v")
    if isinstance(u, int | float) and isinstance(v, int | float) and 0 <= u <= 1 and 0 <= v <= 1:
        plots.pick(float(u), float(v))
