"""Other lenses, and what is saved."""

from __future__ import annotations

import tempfile
from collections.abc import Awaitable, Callable
from functools import cache
from pathlib import Path
from typing import Any

from nicegui import events, ui

from .._core import InputError, Lens, LensFileError, RealcamError, lens_names
from ..gallery import save_gallery
from .access import Folders
from .comparison import COMPARISONS, NOTHING
from .elements import show_choice
from .saving import save_lens, save_picture, save_shot
from .window import Window

LENS_SUFFIXES = (".toml", ".zmx", ".seq", ".len", ".dat", ".json", ".roa")
MOST_UPLOADED = 2 * 1024 * 1024  # bytes
_WANTED = f"a lens file ({' '.join(LENS_SUFFIXES)}) of at most {MOST_UPLOADED >> 20} MiB"


@cache
def lens_preview(name: str) -> str:
    """A small section of a bundled lens, as SVG. Raises LensFileError for any other name."""
    if name not in lens_names():
        raise LensFileError(f'there is no bundled lens "{name:.40}"')
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "lens.svg"
        save_gallery(path, [Lens.load(name)], columns=1)
        svg = path.read_text(encoding="utf-8")
    return svg


class FilesPanel:
    """Opens lenses and saves pictures, shots and lenses, in the folders that the server was started with."""

    def __init__(self, window: Window, folders: Folders, source: Path, run: Callable[..., Awaitable[Any]]) -> None:
        self._window, self._bench, self._folders, self._source, self._run = window, window.bench, folders, source, run
        with ui.element("section").classes("rc-controls").props('aria-label="Lens and files"'):
            with ui.row().classes("items-center w-full"):
                self._lens = ui.select(lens_names(), label="Lens", with_input=True).classes("grow")
                self._lens.props('data-testid="lens"').on("update:model-value", self._choose)
                self._lens.tooltip("One of the bundled lenses")
                # Its colour is that of the page's accents: the server's would be too dark on the dark page.
                gallery = ui.button("Gallery", on_click=self._open_gallery, color=None)
                gallery.props("flat no-caps").classes("rc-flat")
            self._compare = ui.select(list(COMPARISONS), label="Compare with", value=NOTHING).classes("w-full")
            self._compare.props('data-testid="compare"').on("update:model-value", self._compare_with)
            self._compare.tooltip("A second picture behind a wipe")
            self._other = ui.select(lens_names(), label="Other lens").classes("w-full")
            self._other.on("update:model-value", self._compare_with)
            self._other.bind_visibility_from(self._compare, "value", lambda value: value == "another lens")
            # Quasar's own face of an upload has buttons without names, one within another.
            upload = ui.upload(
                max_file_size=MOST_UPLOADED,
                auto_upload=True,
                on_upload=self._upload,
                on_rejected=lambda: ui.notify(f"Not opened: {_WANTED} is wanted", type="negative"),
            )
            upload.classes("hidden").props(f'accept="{",".join(LENS_SUFFIXES)}" data-testid="upload"')
            opens = ui.button("Open a lens file", color=None).props("flat no-caps").classes("rc-flat")
            opens.on("click", js_handler=f"() => getElement({upload.id}).$refs.qRef.pickFiles()")
            opens.tooltip(f"Of this or another program: {' '.join(LENS_SUFFIXES)}")
            with ui.row().classes("items-end w-full"):
                self._name = ui.input("Save as", value="picture.png").classes("grow").props('data-testid="save-name"')
                self._name.tooltip("picture.png, .exr or .dng; shot.toml; lens.toml, .zmx or .seq")
                self._what = ui.select(["picture", "shot", "lens"], value="picture").props('data-testid="save-what"')
                self._what.on("update:model-value", self._propose)
                ui.button("Save", on_click=self._save).props('no-caps data-testid="save"')
            self._said = ui.label().props('aria-live="polite" data-testid="said"')

    def update(self) -> None:
        """On the server's loop."""
        name = self._bench.controls.lens.name
        options = [*lens_names(), *([] if name in lens_names() else [name])]
        show_choice(self._lens, options, name)

    async def _choose(self) -> None:
        if self._lens.value in lens_names():
            await self._run(lambda: self._bench.set_lens(Lens.load(self._lens.value)))

    async def _compare_with(self) -> None:
        what = self._compare.value
        if what == "another lens" and not self._other.value:
            return
        lens = Lens.load(self._other.value) if what == "another lens" else None
        await self._run(self._bench.compare, what, lens)

    async def _upload(self, event: events.UploadEventArguments) -> None:
        suffix = Path(event.file.name).suffix.lower()
        if suffix not in LENS_SUFFIXES:
            self._say(f'"{event.file.name}" is not opened: {_WANTED} is wanted')
            return
        content = await event.file.read()

        def opened() -> str:
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder) / f"{Path(event.file.name).stem[:60]}{suffix}"
                path.write_bytes(content)
                try:
                    lens, notes = Lens._load_with_notes(path)
                except RealcamError as error:  # whose file the user does not know under that path
                    raise InputError(str(error).replace(str(path), event.file.name)) from None
            if not self._bench.set_lens(lens):
                problem = self._bench.problem
                raise InputError(problem.message if problem else "the lens does not fit the camera")
            return "; ".join(
                [f"Opened {event.file.name}", *(note.replace(str(path), event.file.name) for note in notes)]
            )

        await self._try(opened)

    def _propose(self) -> None:
        self._name.set_value({"picture": "picture.png", "shot": "shot.toml", "lens": "lens.toml"}[self._what.value])

    async def _save(self) -> None:
        what, bench = self._what.value, self._bench
        try:
            path = self._folders.inside(self._name.value)
            is_there = path.exists()
        except (RealcamError, OSError) as error:
            self._say(str(error))
            return
        if is_there and not await _agreed(f"{path.name} is there already."):
            return

        def saved() -> str:
            if what == "picture":
                save_picture(bench.image(), path, bench.shot.tone)
                return f"Wrote {path.name}"
            if what == "shot":
                written = save_shot(
                    self._source, bench.controls, bench.switches.of_model(bench.controls.model).as_words(), path
                )
                return f"Wrote {' and '.join(file.name for file in written)}"
            left_out = save_lens(bench.controls.set_lens, path)
            return "; ".join([f"Wrote {path.name}", *(f"not in it: {what}" for what in left_out)])

        await self._try(saved)

    async def _try(self, action: Callable[[], str]) -> None:
        """Says what the action returns, or why it could not be done."""
        try:
            self._say(await self._window.do(action))
        except (RealcamError, OSError) as error:
            self._say(str(error))

    def _say(self, text: str) -> None:
        self._said.set_text(text)

    def _open_gallery(self) -> None:
        async def choose(name: str) -> None:
            dialog.close()
            await self._run(lambda: self._bench.set_lens(Lens.load(name)))

        with ui.dialog() as dialog, ui.card().classes("max-w-5xl"), ui.row().classes("rc-gallery"):
            for name in lens_names():
                with ui.button(on_click=lambda name=name: choose(name)).props("flat no-caps"):
                    preview = ui.element("img").props(f'src="/realcam-lenses/{name}.svg" alt="{name}" loading="lazy"')
                    preview.props('width="190" height="146"')  # or the buttons would move while the previews come
        dialog.open()


async def _agreed(question: str) -> bool:
    """Asks whether a file may be replaced."""
    with ui.dialog() as dialog, ui.card():
        ui.label(question)
        with ui.row():
            ui.button("Replace it", on_click=lambda: dialog.submit(True)).props("no-caps")
            ui.button("Keep it", on_click=lambda: dialog.submit(False), color=None).props("no-caps flat autofocus")
    answer = await dialog
    dialog.delete()
    return bool(answer)
