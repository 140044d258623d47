"""Registry of the open windows."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor

from nicegui.client import Client

from ..lens_bench import LensBench
from ..page.window import Window


class Windows:
    """Open windows, at most `limit`, as each has threads, a scene on the device and a picture. For use on the server's
    loop."""

    def __init__(self, limit: int) -> None:
        self._limit = limit
        self._open: dict[str, tuple[Client, Window]] = {}
        self._opening = 0  # number of windows that are being opened
        # A separate executor, because the server would wait at shutdown for the loop's default one.
        self._executor = ThreadPoolExecutor(thread_name_prefix="realcam-windows")

    def get(self, key: str) -> Window | None:
        """Returns the window with a key; None if it is not open."""
        return self._open[key][1] if key in self._open else None

    async def open(self, client: Client, make: Callable[[], LensBench]) -> Window | None:
        """Opens a window, whose bench is made on another thread. Returns None if too many are open. Raises the
        exceptions of `make`."""
        abandoned = None
        if len(self._open) + self._opening >= self._limit:
            abandoned = self._remove_disconnected()
            if abandoned is None:
                return None
        self._opening += 1  # before the first await, during which more windows may be requested
        try:
            if abandoned:
                await asyncio.wrap_future(self._executor.submit(abandoned.close))
            made = self._executor.submit(make)
            try:
                bench = await asyncio.shield(asyncio.wrap_future(made))
            except asyncio.CancelledError:
                made.add_done_callback(_close_bench)
                raise
        finally:
            self._opening -= 1
        window = Window(bench)
        if client.is_deleted:  # the page was closed while the bench was made
            self._executor.submit(window.close)
            return None
        self._open[window.key] = client, window
        client.on_delete(lambda: self._close(window))
        return window

    def _close(self, window: Window) -> None:
        if self._open.pop(window.key, None):
            self._executor.submit(window.close)

    def _remove_disconnected(self) -> Window | None:
        """Removes and returns the oldest window without a connection, before its time to reconnect ends; None: there is
        no such window."""
        for key, (client, window) in self._open.items():
            if not client.has_socket_connection:
                del self._open[key]
                return window
        return None


def _close_bench(made: Future[LensBench]) -> None:
    if not made.cancelled() and made.exception() is None:
        made.result().close()
