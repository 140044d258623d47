"""Server-side state of one browser window."""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeVar

from ..lens_bench import LensBench
from ..server.stream import PictureStream

T = TypeVar("T")


class Window:
    """A bench, the stream to its page, and the thread that performs the user's actions in order."""

    def __init__(self, bench: LensBench) -> None:
        self.key = secrets.token_urlsafe(16)
        self.bench = bench
        self._actions = ThreadPoolExecutor(max_workers=1, thread_name_prefix="realcam-actions")
        self.stream = PictureStream(bench, self._actions)

    @property
    def path(self) -> str:
        """Path of its WebSocket."""
        return f"/realcam/stream/{self.key}"

    async def do(self, action: Callable[..., T], *arguments: Any, **named: Any) -> T:
        """Performs an action after all earlier ones. Raises the action's exceptions."""
        loop = asyncio.get_running_loop()
        return await loop.run_in_executor(self._actions, lambda: action(*arguments, **named))

    def close(self) -> None:
        """Ends its threads. May be called from any other thread."""
        self._actions.shutdown(wait=True, cancel_futures=True)
        self.bench.close()
