"""The stream between a bench and its page, without a network: what comes while something takes long."""

from __future__ import annotations

import asyncio
import contextlib
import gc
import json
import threading
from collections.abc import AsyncIterator, Awaitable, Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any
from unittest.mock import Mock

import pytest

pytest.importorskip("simplejpeg")
pytest.importorskip("starlette")

from realcam import InputError
from realcam.viewer.lens_bench import LensBench
from realcam.viewer.listeners import Listeners, Problem
from realcam.viewer.pictures.picture_request import Frame
from realcam.viewer.server.stream import PictureStream

from .processes import run_apart

WAIT_S = 30.0
MOVES = [{"type": "turn", "ring": "iso", "steps": k % 5 - 2} for k in range(3000)]


class Link:
    """A WebSocket as an ASGI server gives it."""

    def __init__(self) -> None:
        self.from_page: asyncio.Queue[dict[str, Any]] = asyncio.Queue()
        self.frames: asyncio.Queue[bytes] = asyncio.Queue()
        self.closed: tuple[int, str] | None = None

    def says(self, *messages: dict[str, Any] | str) -> None:
        for message in messages:
            text = message if isinstance(message, str) else json.dumps(message)
            self.from_page.put_nowait({"type": "websocket.receive", "text": text})

    def hang_up(self) -> None:
        self.from_page.put_nowait({"type": "websocket.disconnect"})

    async def accept(self) -> None:
        pass

    async def receive(self) -> dict[str, Any]:
        return await self.from_page.get()

    async def send_text(self, text: str) -> None:
        pass

    async def send_bytes(self, packed: bytes) -> None:
        self.frames.put_nowait(packed)

    async def close(self, code: int, reason: str) -> None:
        self.closed = code, reason


class SlowBench:
    """Notes what it is asked for; does nothing before it may."""

    def __init__(self) -> None:
        self.may, self.turned = threading.Event(), []
        self.bench = Mock(spec=LensBench)
        self.bench.listeners = Listeners()
        self.bench.show.side_effect = lambda: self.may.wait(WAIT_S)
        self.bench.turn.side_effect = self.turn

    def turn(self, ring: str, steps: int) -> bool:
        assert self.may.wait(WAIT_S)
        self.turned.append(steps)
        return True


def frame(serial: int, *, quality: int = 90, is_final: bool = False) -> Frame:
    return Frame(
        serial=serial,
        jpeg=b"a picture",
        jpeg_quality=quality,
        width=3,
        height=2,
        whole_width=3,
        whole_height=2,
        samples=1,
        is_preview=False,
        is_final=is_final,
        noise_codes=None,
        seconds=0.1,
        exposure_time_s=0.01,
        costs=None,
    )


async def until(is_so: Callable[[], bool]) -> None:
    async def waiting() -> None:
        while not is_so():
            await asyncio.sleep(0.005)

    await asyncio.wait_for(waiting(), WAIT_S)


@contextlib.asynccontextmanager
async def served(stream: PictureStream, link: Link) -> AsyncIterator[None]:
    serving = asyncio.create_task(stream.serve(link))
    yield
    link.hang_up()
    await asyncio.wait_for(serving, WAIT_S)


def run(test: Callable[[SlowBench, PictureStream], Awaitable[None]]) -> None:
    slow = SlowBench()
    with ThreadPoolExecutor(max_workers=1) as actions:

        async def begun() -> None:
            try:
                await test(slow, PictureStream(slow.bench, actions))
            finally:
                slow.may.set()

        run_apart(begun())


def test_everything_is_read_while_something_takes_long() -> None:
    """The frames go on, and the answers to the server's pings, which come on the same way, are read."""

    async def test(slow: SlowBench, stream: PictureStream) -> None:
        link = Link()
        async with served(stream, link):
            link.says(*MOVES)
            for serial in (1, 2, 3):
                slow.bench.listeners.frame("a", frame(serial))
                await asyncio.wait_for(link.frames.get(), WAIT_S)
                link.says(f"ack a {serial}")
            await until(link.from_page.empty)
            assert slow.turned == []
            slow.may.set()
            await until(lambda: len(slow.turned) == len(MOVES))
            assert slow.turned == [move["steps"] for move in MOVES]

    run(test)


@pytest.mark.parametrize("seconds", [0.0, 0.2])
def test_the_last_frame_of_a_picture_comes_at_its_best(seconds: float) -> None:
    """This holds even if a slow link or page lowers the quality of all other frames."""

    async def test(slow: SlowBench, stream: PictureStream) -> None:
        slow.may.set()
        link = Link()
        async with served(stream, link):
            for serial, is_final in ((1, False), (2, True)):
                slow.bench.listeners.frame("a", frame(serial, quality=60, is_final=is_final))
                await asyncio.wait_for(link.frames.get(), WAIT_S)
                assert not slow.bench.show_again.called
                await asyncio.sleep(seconds)
                link.says(f"ack a {serial}")
                await until(lambda count=serial: slow.bench.set_jpeg_quality.call_count == count)
            await until(lambda: slow.bench.show_again.called)
            slow.bench.set_jpeg_quality.assert_called_with(90)
            slow.bench.listeners.frame("a", frame(3, quality=90, is_final=True))
            await asyncio.wait_for(link.frames.get(), WAIT_S)
            link.says("ack a 3")
            await until(lambda: slow.bench.set_jpeg_quality.call_count == 3)
            assert slow.bench.show_again.call_count == 1

    run(test)


def test_what_was_asked_for_before_a_connection_was_lost_is_done() -> None:
    async def test(slow: SlowBench, stream: PictureStream) -> None:
        link = Link()
        async with served(stream, link):
            await until(lambda: slow.bench.show.called)  # and is under way, so that all seven have to wait
            link.says(*MOVES[:7])
            await until(link.from_page.empty)
        async with served(stream, Link()):
            slow.may.set()
            await until(lambda: len(slow.turned) == 7)
            assert slow.turned == [move["steps"] for move in MOVES[:7]]

    run(test)


def test_what_cannot_be_done_is_told_although_the_connection_was_lost() -> None:
    async def test(slow: SlowBench, stream: PictureStream) -> None:
        def undo() -> None:
            assert slow.may.wait(WAIT_S)
            raise InputError("there is nothing to take back")

        slow.bench.undo.side_effect = undo
        unseen: list[dict[str, Any]] = []
        asyncio.get_running_loop().set_exception_handler(lambda _, context: unseen.append(context))
        link = Link()
        async with served(stream, link):
            link.says({"type": "undo"})
            await until(link.from_page.empty)
        slow.may.set()
        await until(lambda: slow.bench.report.called)
        slow.bench.report.assert_called_once_with(Problem("there is nothing to take back", view="lens"))
        gc.collect()  # asyncio tells of an exception that nobody has taken when its future goes
        assert unseen == []

    run(test)


@pytest.mark.parametrize("sent", [MOVES * 10, [*MOVES[:5], "nonsense"]], ids=["a flood", "nonsense"])
def test_what_no_page_sends_ends_the_connection_and_what_came_with_it(sent: list[Any]) -> None:
    async def test(slow: SlowBench, stream: PictureStream) -> None:
        link = Link()
        serving = asyncio.create_task(stream.serve(link))
        link.says(*sent)
        await asyncio.wait_for(serving, WAIT_S)
        assert link.closed is not None
        assert link.closed[0] == 1008
        slow.may.set()
        other = Link()
        async with served(stream, other):
            other.says({"type": "turn", "ring": "iso", "steps": 4})
            await until(lambda: 4 in slow.turned)
            assert len(slow.turned) <= 2  # the one that was under way, and this one

    run(test)
