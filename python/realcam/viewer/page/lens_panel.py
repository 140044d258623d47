"""Panels that choose the lens, and the comparison."""

from __future__ import annotations

import tempfile
from collections.abc import Awaitable, Callable
from functools import cache
from pathlib import Path
from typing import Any

from nicegui import events, run, ui

from ..._core import InputError, Lens, LensFileError, RealcamError, lens_names
from ...drawing.gallery import save_gallery
from ...files import LENS_SUFFIXES
from ..comparison import COMPARISONS, NOTHING
from ..lens_reading import lens_from
from .elements import LensGallery, show_choice
from .window import Window

MAX_UPLOADED = 2 * 1024 * 1024  # bytes
_EXPECTED_FILE = f"a lens file ({' '.join(LENS_SUFFIXES)}) of at most {MAX_UPLOADED >> 20} MiB"


@cache
def lens_preview(name: str) -> str:
    """Returns a small section of a bundled lens, as SVG. Raises LensFileError for an unknown name."""
    if name not in lens_names():
        raise LensFileError(f'there is no bundled lens "{name:.40}"')
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "lens.svg"
        save_gallery(path, [Lens.load(name)], columns=1, titles=False)
        svg = path.read_text(encoding="utf-8")
    return svg


class LensPanel:
    """Mounts another lens: a bundled one, or one from a file uploaded by the browser.

    say: shows a message; its second argument is true for a problem.
    """

    def __init__(
        self, window: Window, run_action: Callable[..., Awaitable[Any]], say: Callable[[str, bool], None]
    ) -> None:
        self._window, self._bench, self._run, self._say = window, window.bench, run_action, say
        with ui.row().classes("items-center w-full"):
            self._lens = ui.select(lens_names(), label="Lens", with_input=True).classes("grow")
            self._lens.props('data-testid="lens"').on("update:model-value", self._choose)
            self._lens.tooltip("One of the bundled lenses")
            LensGallery().on("chosen", self._choose_card)
            # Quasar's upload widget is hidden: its buttons have no accessible names and are nested.
            self._files = ui.upload(
                max_file_size=MAX_UPLOADED,
                auto_upload=True,
                on_upload=self._upload,
                on_rejected=lambda: ui.notify(f"Not opened: expected {_EXPECTED_FILE}", type="negative"),
            )
            self._files.classes("hidden").props(f'accept="{",".join(LENS_SUFFIXES)}" data-testid="upload"')
            opens = ui.button("Open a lens file", color=None).props("no-caps outline").classes("rc-flat")
            # Quasar rejects a file that is in its list, and browsers send no event if the same file is chosen again.
            opens.on(
                "click",
                js_handler=f"""() => {{
                    const files = getElement({self._files.id}).$refs.qRef;
                    files.reset();
                    files.$el.querySelector("input[type=file]").value = "";
                    files.pickFiles();
                }}""",
            )
            opens.tooltip(f"Opens a lens file of this or another program: {' '.join(LENS_SUFFIXES)}")

    def update(self) -> None:
        """On the server's loop."""
        name = self._bench.controls.lens.name
        options = [*lens_names(), *([] if name in lens_names() else [name])]
        show_choice(self._lens, options, name)

    async def _choose(self) -> None:
        await self._choose_bundled(self._lens.value)

    async def _choose_card(self, event: events.GenericEventArguments) -> None:
        await self._choose_bundled(event.args)

    async def _choose_bundled(self, name: Any) -> None:
        if name in lens_names():
            await self._run(lambda: self._bench.set_lens(Lens.load(name)))

    async def _upload(self, event: events.UploadEventArguments) -> None:
        self._files.reset()
        suffix = Path(event.file.name).suffix.lower()
        if suffix not in LENS_SUFFIXES:
            self._say(f'"{event.file.name}" is not opened: expected {_EXPECTED_FILE}', True)
            return
        name, content = event.file.name, await event.file.read()
        try:
            # Read outside of the window's own thread, so that the user's actions need not wait for the file.
            read = await run.io_bound(lens_from, name, content)
            if read is None:  # the server is shutting down
                return
            lens, notes = read
            if not await self._window.do(self._bench.set_lens, lens):
                problem = self._bench.problem
                raise InputError(problem.message if problem else "the lens does not fit the camera")
        except RealcamError as error:
            self._say(str(error), True)
        else:
            self._say("; ".join([f"Opened {name}", *notes]), False)


class ComparisonPanel:
    """Chooses the second picture behind the wipe."""

    def __init__(self, window: Window, run_action: Callable[..., Awaitable[Any]]) -> None:
        self._bench, self._run = window.bench, run_action
        self._compare = ui.select(list(COMPARISONS), label="Compare with", value=NOTHING).classes("w-full")
        self._compare.props('data-testid="compare"').on("update:model-value", self._compare_with)
        self._compare.tooltip("Shows a second picture to the right of a line that you can move")
        self._other = ui.select(lens_names(), label="Other lens").classes("w-full")
        self._other.on("update:model-value", self._compare_with)
        self._other.bind_visibility_from(self._compare, "value", lambda value: value == "another lens")

    async def _compare_with(self) -> None:
        what = self._compare.value
        if what == "another lens" and not self._other.value:
            return
        lens = Lens.load(self._other.value) if what == "another lens" else None
        await self._run(self._bench.compare, what, lens)
