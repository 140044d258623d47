"""How many windows there are, however they are asked for."""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Callable
from typing import Any
from unittest.mock import Mock

import pytest

pytest.importorskip("nicegui")

from realcam.viewer.server.windows import Windows

from .processes import run_apart

WAIT_S = 30.0


class Page:
    """A page's client, as far as windows know it."""

    def __init__(self, is_connected: bool = True) -> None:
        self.has_socket_connection, self.is_deleted = is_connected, False
        self.leave: Callable[[], None] = lambda: None

    def on_delete(self, leave: Callable[[], None]) -> None:
        self.leave = leave


class Benches:
    """Makes benches slowly, and counts them."""

    def __init__(self, seconds: float = 0.2) -> None:
        self.seconds, self.lock, self.now, self.most = seconds, threading.Lock(), 0, 0

    def make(self) -> Any:
        with self.lock:
            self.now += 1
            self.most = max(self.most, self.now)
        time.sleep(self.seconds)
        bench = Mock()
        bench.close = self.close
        return bench

    def close(self) -> None:
        with self.lock:
            self.now -= 1

    async def until(self, now: int) -> None:
        deadline = time.monotonic() + WAIT_S
        while self.now != now:
            assert time.monotonic() < deadline, self.now
            await asyncio.sleep(0.02)


def test_of_sixty_that_come_at_once_as_many_are_made_as_may_be() -> None:
    benches = Benches()

    async def come() -> list[Any]:
        windows = Windows(5)
        return await asyncio.gather(*(windows.open(Page(), benches.make) for _ in range(60)))  # type: ignore[arg-type]

    made = run_apart(come())
    assert sum(window is not None for window in made) == 5
    assert benches.most == 5


def test_one_whose_page_has_gone_makes_room() -> None:
    benches = Benches(0)

    async def come() -> None:
        windows = Windows(2)
        gone, stays = Page(), Page()
        first = await windows.open(gone, benches.make)  # type: ignore[arg-type]
        await windows.open(stays, benches.make)  # type: ignore[arg-type]
        assert await windows.open(Page(), benches.make) is None  # type: ignore[arg-type]
        gone.has_socket_connection = False
        assert await windows.open(Page(), benches.make) is not None  # type: ignore[arg-type]
        assert first is not None
        assert windows.get(first.key) is None
        await benches.until(2)
        stays.leave()
        await benches.until(1)
        assert await windows.open(Page(), benches.make) is not None  # type: ignore[arg-type]

    run_apart(come())


def test_one_that_nobody_waits_for_any_more_is_closed() -> None:
    """The page is closed, or its request is cancelled, while the scene is being prepared."""
    benches = Benches(0.5)

    async def come() -> None:
        windows = Windows(2)
        asked = asyncio.ensure_future(windows.open(Page(), benches.make))  # type: ignore[arg-type]
        await asyncio.sleep(0.1)
        asked.cancel()
        gone = Page()
        other = asyncio.ensure_future(windows.open(gone, benches.make))  # type: ignore[arg-type]
        await asyncio.sleep(0.1)
        gone.is_deleted = True
        assert await other is None
        await benches.until(0)

    run_apart(come())
