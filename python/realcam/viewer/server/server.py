"""The web server of the lens bench."""

from __future__ import annotations

import contextlib
import logging
import os
import secrets
import signal
import socket
import sys
import threading
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from fastapi import Response, WebSocket
from nicegui import app, ui
from nicegui.client import Client

from ..._core import DeviceError, InputError, LensFileError
from ...shot import Shot
from ..lens_bench import LensBench
from ..lens_reading import reader
from ..page.layout import build_page
from ..page.lens_panel import MAX_UPLOADED, lens_preview
from ..page.plots_panel import plotter
from ..shot_source import ShotSource
from .access import BodyLimit, Folders, Gate, is_local
from .left_requests import LeftRequests
from .strange_requests import shorten_tracebacks
from .windows import Windows

_STATIC = Path(__file__).parents[1] / "page" / "static"
_MAX_MESSAGE = 1 << 20  # bytes; applies to NiceGUI's socket as well
_UNKNOWN_WINDOW = 4404  # see stream.js
_SHUTDOWN_TIMEOUT_S = 1  # time that the server waits at shutdown for browsers to close their connections


@dataclass(frozen=True)
class ServerSettings:
    """Settings of the lens bench's server.

    folders: the only ones that are read and written. token: "": generated if the server needs one.
    device: of rendering. shows_browser: opens the page in a browser. tells_address: prints the page's address.
    noise_codes: noise to which a new window refines its pictures, in 8-bit codes.
    most_windows: limit, as each window has threads, a scene on the device and a picture.
    reconnect_s: time that a window is retained after its connection is lost.
    """

    folders: tuple[Path, ...]
    host: str = "127.0.0.1"
    port: int = 8080
    device: str = "auto"
    token: str = ""
    shows_browser: bool = True
    tells_address: bool = True
    noise_codes: float = 1.0
    most_windows: int = 16
    reconnect_s: float = 30.0


def serve(shot: Shot, source: ShotSource, settings: ServerSettings) -> None:
    """Serves until Ctrl-C, which ends the program. Raises InputError if a folder does not exist."""
    folders = Folders(settings.folders)
    token = None if is_local(settings.host) and not settings.token else settings.token or secrets.token_urlsafe(24)
    windows = Windows(settings.most_windows)

    app.add_middleware(BodyLimit, max_bytes=2 * MAX_UPLOADED)
    app.add_middleware(Gate, token=token)
    # add_middleware adds inside of NiceGUI's own middleware; LeftRequests must be outermost.
    build_middleware_stack = app.build_middleware_stack
    app.build_middleware_stack = lambda: LeftRequests(build_middleware_stack())  # type: ignore[method-assign]
    app.add_static_files("/realcam", _STATIC)

    # The page recognises by its title whether its stored state belongs to this shot.
    @ui.page("/", title=f"{source.name} - realcam", response_timeout=30)
    async def page(client: Client) -> None:
        try:
            make = partial(LensBench, shot, device=settings.device, noise_codes=settings.noise_codes)
            window = await windows.open(client, make)
        except DeviceError as error:
            ui.label(str(error))
            return
        if window is None:
            ui.label("Too many windows are open; close one and reload this page.")
            return
        build_page(client, window, folders, source)

    # A plain function, not a coroutine, so that the server draws previews on worker threads.
    @app.get("/realcam-lenses/{name}.svg")
    def preview(name: str) -> Response:
        try:
            return Response(lens_preview(name), media_type="image/svg+xml")
        except LensFileError:
            return Response(status_code=404)

    @app.websocket("/realcam/stream/{key}")
    async def stream(socket: WebSocket, key: str) -> None:
        window = windows.get(key)
        if window is None:
            await socket.accept()
            await socket.close(_UNKNOWN_WINDOW, "this window is no longer open on the server")
            return
        await window.stream.serve(socket)

    address = f"http://{_shown(settings.host)}:{settings.port}/" + (f"?token={token}" if token else "")

    async def started() -> None:
        """Prints the address, and starts the worker processes."""
        if settings.tells_address:
            print(f"realcam: the lens bench is at {address}", flush=True)
        for process, module in ((reader, "realcam.viewer.lens_reading"), (plotter, "realcam.viewer.page.close_look")):
            threading.Thread(target=process.warm_up, args=(module,), daemon=True).start()

    shorten_tracebacks()
    # Hides the message about connections that clients have not closed at shutdown.
    logging.getLogger("uvicorn.error").addFilter(lambda record: "timeout graceful shutdown" not in record.getMessage())
    status = 128 + signal.SIGINT

    def end(*_: object) -> None:
        nonlocal status
        status = 128 + signal.SIGTERM
        raise KeyboardInterrupt

    signal.signal(signal.SIGTERM, end)  # the server calls this handler after its shutdown
    with contextlib.suppress(KeyboardInterrupt):
        ui.run(
            host=settings.host,
            port=settings.port,
            title="realcam",
            language="en-US",
            show=address if settings.shows_browser else False,
            reload=False,
            show_welcome_message=False,
            reconnect_timeout=settings.reconnect_s,
            binding_refresh_interval=None,
            ws_max_size=_MAX_MESSAGE,
            tailwind=True,
            timeout_graceful_shutdown=_SHUTDOWN_TIMEOUT_S,
            # Called once the server listens, whereas startup handlers are called before.
            callback_notify=started,
            timeout_notify=10**9,
        )
    for process in (reader, plotter):
        process.end()
    # Python would wait for threads to finish frames, plans and drawings that are no longer needed.
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)


def check_port(host: str, port: int) -> None:
    """Raises InputError if the server cannot listen at the address."""
    try:
        for family, kind, protocol, _, address in socket.getaddrinfo(host, port, type=socket.SOCK_STREAM):
            with socket.socket(family, kind, protocol) as listening:
                listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
                if family == socket.AF_INET6:
                    listening.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_V6ONLY, 1)  # as in the server
                listening.bind(address)
                listening.listen()
    except OSError as error:
        raise InputError(
            f"cannot serve at {_shown(host)}:{port}: {error.strerror}; choose another address by --host and --port"
        ) from None


def _shown(host: str) -> str:
    return f"[{host}]" if ":" in host else host
