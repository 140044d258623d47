"""The web server of the lens bench."""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from fastapi import Response, WebSocket
from nicegui import app, ui
from nicegui.client import Client

from .._core import DeviceError, LensFileError
from ..shot import Shot
from .access import BodyLimit, Folders, Gate, is_local
from .files_panel import MOST_UPLOADED, lens_preview
from .left_requests import LeftRequests
from .lens_bench import AnyPictureLoop, LensBench
from .page import build_page
from .picture_loop import PictureLoop
from .remote import RemotePictureLoop
from .window import Window

_STATIC = Path(__file__).with_name("static")
_RECONNECT_S = 30.0  # for so long a window whose connection is lost keeps what it has
_MOST_MESSAGE = 1 << 20  # bytes, of the page's own socket, too
_UNKNOWN_WINDOW = 4404  # see stream.js
_MOST_WINDOWS = 16  # each has threads, a scene on the device and a picture


@dataclass(frozen=True)
class ServerSettings:
    """source: the shot's file. folders: the only ones that are read and written.

    token: "" makes one where it is wanted; with connect, it is that of the machine that photographs.
    """

    source: Path
    folders: tuple[Path, ...]
    host: str = "127.0.0.1"
    port: int = 8080
    device: str = "auto"
    token: str = ""
    connect: tuple[str, int] | None = None  #: the machine that photographs, if it is not this one
    shows_browser: bool = True


def serve(shot: Shot, settings: ServerSettings) -> None:
    """Serves until Ctrl-C. Raises InputError and DeviceError before it begins."""
    folders = Folders(settings.folders)
    is_open = is_local(settings.host) and (settings.connect is not None or not settings.token)
    token = None if is_open else settings.token or secrets.token_urlsafe(24)
    windows: dict[str, tuple[Client, Window]] = {}
    make_loop: Callable[..., AnyPictureLoop] = PictureLoop
    if settings.connect is not None:
        make_loop = partial(RemotePictureLoop, address=settings.connect, token=settings.token)
        make_loop(shot.scene, lambda _: None, lambda *_: None).close()  # so that a mistake is told at once

    app.add_middleware(BodyLimit, most=2 * MOST_UPLOADED)
    app.add_middleware(Gate, token=token)
    # Middleware that is added stands within NiceGUI's own.
    build_middleware_stack = app.build_middleware_stack
    app.build_middleware_stack = lambda: LeftRequests(build_middleware_stack())  # type: ignore[method-assign]
    app.add_static_files("/realcam", _STATIC)

    # By the title a page knows whether what it has kept is of this shot.
    @ui.page("/", title=f"{settings.source.name} - realcam", response_timeout=30)
    async def page(client: Client) -> None:
        if len(windows) >= _MOST_WINDOWS and not await _close_left_window(windows):
            ui.label("Too many windows are open; close one and load this page again.")
            return
        try:
            # On another thread, because the scene is made ready in the meantime.
            bench = await asyncio.to_thread(LensBench, shot, device=settings.device, make_loop=make_loop)
        except DeviceError as error:
            ui.label(str(error))
            return
        window = Window(bench)
        windows[window.key] = client, window
        client.on_delete(lambda: windows.pop(window.key, None))
        build_page(client, window, folders, settings.source.resolve())

    # Not a coroutine: the server draws them on threads of its own.
    @app.get("/realcam-lenses/{name}.svg")
    def preview(name: str) -> Response:
        try:
            return Response(lens_preview(name), media_type="image/svg+xml")
        except LensFileError:
            return Response(status_code=404)

    @app.websocket("/realcam/stream/{key}")
    async def stream(socket: WebSocket, key: str) -> None:
        if key not in windows:
            await socket.accept()
            await socket.close(_UNKNOWN_WINDOW, "the server does not know this window any more")
            return
        _, window = windows[key]
        await window.stream.serve(socket)

    address = f"http://{_shown(settings.host)}:{settings.port}/" + (f"?token={token}" if token else "")
    app.on_startup(lambda: print(f"realcam: the lens bench is at {address}", flush=True))
    ui.run(
        host=settings.host,
        port=settings.port,
        title="realcam",
        language="en-US",
        show=address if settings.shows_browser else False,
        reload=False,
        show_welcome_message=False,
        reconnect_timeout=_RECONNECT_S,
        binding_refresh_interval=None,
        ws_max_size=_MOST_MESSAGE,
        tailwind=True,
    )


async def _close_left_window(windows: dict[str, tuple[Client, Window]]) -> bool:
    """The oldest one whose page has gone, if any has; it would have been kept for some time yet."""
    for key, (client, window) in windows.items():
        if not client.has_socket_connection:
            del windows[key]
            await asyncio.to_thread(window.close)
            return True
    return False


def _shown(host: str) -> str:
    return f"[{host}]" if ":" in host else host
