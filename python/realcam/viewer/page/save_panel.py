"""Panel that saves pictures, shots and lenses: into the server's folders, or as browser downloads.

A picture is saved as currently shown, denoised or not, at full resolution.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path
from typing import Any

from nicegui import ui

from ..._core import InputError, RealcamError
from ...files import check_target, write_whole
from ..saving import SUFFIXES, check_suffix, lens_content, picture_content, shot_contents
from ..server.access import Folders
from ..shot_source import ShotSource
from .camera_panel import grey_levels
from .window import Window

_PROPOSED = {"picture": "picture.png", "shot": "shot.toml", "lens": "lens.toml"}


class SavePanel:
    """Save panel. say: shows a message; its second argument is true for a problem."""

    def __init__(self, window: Window, folders: Folders, source: ShotSource, say: Callable[[str, bool], None]) -> None:
        self._window, self._bench, self._folders, self._source, self._say = window, window.bench, folders, source, say
        with ui.row().classes("items-end w-full"):
            self._name = ui.input("Save as", value="picture.png").classes("grow").props('data-testid="save-name"')
            kinds = {what: ", ".join(suffixes) for what, suffixes in SUFFIXES.items()}
            self._name.tooltip(f"A picture is {kinds['picture']}; a shot {kinds['shot']}; a lens {kinds['lens']}")
            self._what = ui.select(list(_PROPOSED), value="picture").props('data-testid="save-what"')
            self._what.on("update:model-value", self._propose)
        with ui.row().classes("items-center w-full"):
            save = ui.button("Save", on_click=lambda: self._try(self._save)).props('no-caps data-testid="save"')
            save.tooltip(f"Saves to {folders.first}, or to another folder that the lens bench was started with")
            download = ui.button("Download", color=None).props('no-caps outline data-testid="download"')
            download.classes("rc-flat").on("click", lambda: self._try(self._download))
            download.tooltip("Saves to the browser's download folder")
        with ui.row().classes("items-center w-full") as refined:
            self._refine = ui.button(on_click=lambda: self._try(self._save_refined), color=None)
            self._refine.props('no-caps outline data-testid="save-refined"').classes("rc-flat")
            self._refine.tooltip(
                'Waits until the picture has the noise of "Refine to" (panel Camera), and saves it then'
            )
            self._time_left = ui.label().props('data-testid="time-left"').classes("rc-note")
        refined.bind_visibility_from(self._what, "value", lambda what: what == "picture")
        note = ui.label("A picture is saved as it is shown now, at full resolution.").classes("rc-note")
        note.bind_visibility_from(self._what, "value", lambda what: what == "picture")
        self.update()
        ui.timer(1.0, self.update)

    def update(self) -> None:
        """Shows the bench's noise goal and the remaining time. On the server's loop."""
        self._refine.set_text(f"Save when the noise is {grey_levels(self._bench.noise_codes)}")
        self._time_left.set_text(f"Time left: {self._bench.time_left}")

    def _propose(self) -> None:
        self._name.set_value(_PROPOSED.get(self._what.value, ""))

    async def _try(self, action: Callable[[str, str], Any]) -> None:
        """Calls an action with the kind of content and the file name; shows its errors as messages."""
        name, what = self._name.value, self._what.value
        try:
            if not isinstance(name, str) or what not in _PROPOSED:
                raise InputError("expected the name of a file")
            check_suffix(what, name)
            await action(what, name)
        except (RealcamError, OSError) as error:
            self._say(str(error), True)

    async def _save_refined(self, what: str, name: str) -> None:
        await self._save(what, name, is_refined=True)

    async def _save(self, what: str, name: str, *, is_refined: bool = False) -> None:
        """Saves a picture, shot or lens. is_refined: waits first until the picture is refined. Raises RealcamError and
        OSError."""
        path = self._folders.inside(name)
        contents, left_out = (None, []) if what == "picture" else await self._window.do(self._contents, what, path)
        # Additional files are checked like the one that was named: they could be links that lead out of the folders.
        targets = {self._folders.inside(str(file)): file for file in contents or [path]}
        for target in targets:
            check_target(target)
        agreed: set[Path] = set()
        if not await self._agree(targets, agreed):
            return
        if is_refined:
            await self._refined()
        if contents is None:
            contents = {path: await self._picture(name)}
        if await self._write({target: contents[file] for target, file in targets.items()}, agreed):
            names = " and ".join(target.name for target in targets)
            self._say("; ".join([f"Wrote {names}", *(f"omitted: {part}" for part in left_out)]), False)

    async def _agree(self, targets: Any, agreed: set[Path]) -> bool:
        """Asks whether existing files not yet agreed to may be replaced. Returns false if not. Raises OSError."""
        existing = [target for target in targets if target not in agreed and target.exists()]
        if existing and not await _answer(" ".join(f"{target.name} exists already." for target in existing)):
            return False
        agreed.update(existing)
        return True

    async def _write(self, contents: dict[Path, bytes], agreed: set[Path]) -> bool:
        """Writes all files; on failure removes those that are new. Returns true if all were written. Raises
        ImageFileError."""
        new: set[Path] = set()
        try:
            while True:
                waiting = [target for target in contents if target not in new]
                if not await self._agree(waiting, agreed):
                    break
                for target in waiting:
                    replaces = target in agreed
                    if not await self._window.do(write_whole, target, contents[target], replaces=replaces):
                        break  # another window has just created the file; asks whether to replace it
                    if not replaces:
                        new.add(target)
                else:
                    new.clear()
                    return True
        finally:
            for target in new:
                target.unlink(missing_ok=True)
        return False

    async def _download(self, what: str, name: str) -> None:
        path = self._source.folder / Path(name).name
        left_out: list[str] = []
        if what == "picture":
            contents = {path: await self._picture(name)}
        else:
            contents, left_out = await self._window.do(self._contents, what, path)
        for file, content in contents.items():
            ui.download.content(content, file.name)
        self._say("; ".join([f"Downloaded {path.name}", *(f"omitted: {part}" for part in left_out)]), False)

    def _contents(self, what: str, path: Path) -> tuple[dict[Path, bytes], list[str]]:
        """Returns file contents of a shot or a lens, and the properties that the format cannot express."""
        bench = self._bench
        if what == "lens":
            content, left_out = lens_content(bench.controls.set_lens, path.name)
            return {path: content}, left_out
        effects = bench.switches.restricted_to_model(bench.controls.model).as_specs()
        return shot_contents(self._source, bench.controls, effects, path, bench.tone), []

    async def _picture(self, name: str) -> bytes:
        """Returns the file content of the picture as shown. Raises Cancelled."""
        bench = self._bench
        return await self._window.do(lambda: picture_content(bench.image(), name, bench.tone))

    async def _refined(self) -> None:
        """Waits until the picture has the requested noise, or the user chooses to save it at once. Raises InputError if
        the user cancels."""
        bench = self._bench
        if bench.is_refined:
            return
        with ui.dialog().props("persistent") as dialog, ui.card():
            progress = ui.label().props('data-testid="save-progress"')
            with ui.row():
                ui.button("Save it as it is now", on_click=lambda: dialog.submit(True)).props("no-caps")
                ui.button("Do not save", on_click=lambda: dialog.submit(False), color=None).props("no-caps flat")

        async def asked() -> Any:
            return await dialog

        answer = asyncio.ensure_future(asked())
        try:
            while not (bench.is_refined or answer.done() or dialog.is_deleted):
                progress.set_text(f"The picture is being refined: {bench.progress}. Time left: {bench.time_left}")
                await asyncio.wait([answer], timeout=0.2)
        finally:
            answer.cancel()
            if not dialog.is_deleted:
                dialog.close()
                dialog.delete()
        if not bench.is_refined and not (answer.done() and not answer.cancelled() and answer.result()):
            raise InputError("The picture was not saved.")


async def _answer(statement: str) -> bool:
    """Shows a statement that files exist. Returns true if the user allows to replace them."""
    with ui.dialog() as dialog, ui.card():
        ui.label(statement)
        with ui.row():
            ui.button("Replace it", on_click=lambda: dialog.submit(True)).props("no-caps")
            ui.button("Keep it", on_click=lambda: dialog.submit(False), color=None).props("no-caps flat autofocus")
    answer = await dialog
    dialog.delete()
    return bool(answer)
