"""The WebSocket between a window's bench and its page: frames and drawings one way, mouse and keys the other.

A frame is a binary message: the length of a JSON header as four bytes, little-endian, the header, a JPEG. At most one
is under way; of those that come meanwhile the newest is sent when the page has acknowledged it. All else is JSON text.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import struct
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict
from typing import Any

from starlette.websockets import WebSocket, WebSocketDisconnect

from .._core import Plan, RealcamError
from .inbox import Inbox
from .lens_bench import LensBench
from .listeners import Problem
from .messages import BadMessage, Message, json_text, parsed, perform, subject
from .picture_request import Frame
from .server_loop import call_on_loop

_log = logging.getLogger(__name__)

_QUALITIES = (40, 90)  # of JPEG
_SLOW_S, _QUICK_S = 0.120, 0.050  # from sending a frame to its acknowledgement
_LAST_S = 0.5  # of a last frame, which then comes once more at its best: some times as large, while nobody waits


class PictureStream:
    """Serves the pages that show one bench: one at a time, and the next one after a lost connection."""

    def __init__(self, bench: LensBench, executor: ThreadPoolExecutor) -> None:
        self._bench, self._executor = bench, executor
        self._loop = asyncio.get_running_loop()
        self._frames: dict[str, Frame] = {}
        self._texts: dict[str, str] = {}
        self._news = asyncio.Event()
        self.inbox = Inbox()  #: outlives a connection that is lost
        self._serving: list[asyncio.Task[None]] = []  #: of the newest connection
        self._sent: tuple[str, float] | None = None  #: the frame that is not acknowledged, and when it was sent
        self._sent_frame: Frame | None = None  #: the last one
        self._quality = _QUALITIES[1]
        bench.listeners.frame = self._offer_frame
        bench.listeners.lens = lambda view: self._offer_text("lens", view)
        bench.listeners.rays = lambda view: self._offer_text("rays", view)
        bench.listeners.problem = self._offer_problem
        bench.listeners.plan = self._offer_plan
        bench.listeners.state = lambda state: self._offer_text("state", {"state": state})
        bench.listeners.rungs = lambda rungs, note: self._offer_text("rungs", {"rungs": rungs, "note": note})

    async def serve(self, socket: WebSocket) -> None:
        """Until the page goes. Refuses what no page of ours sends by closing the connection."""
        await socket.accept()
        for task in self._serving:  # a connection that has died without a word would go on taking frames
            task.cancel()
        self._sent = None
        tasks = [
            asyncio.create_task(part)
            for part in (self._receive(socket), self._send(socket), self._work(), self._begin())
        ]
        self._serving = tasks
        try:
            done, _ = await asyncio.wait(tasks[:3], return_when=asyncio.FIRST_COMPLETED)
            for task in done:
                error = None if task.cancelled() else task.exception()
                if isinstance(error, BadMessage):
                    self.inbox.clear()
                    await socket.close(1008, str(error)[:100])
                elif error and not isinstance(error, WebSocketDisconnect | RuntimeError):
                    raise error
        finally:
            for task in tasks:
                task.cancel()

    async def _begin(self) -> None:
        await self._loop.run_in_executor(self._executor, self._bench.show)

    async def _receive(self, socket: WebSocket) -> None:
        while True:
            event = await socket.receive()
            if event["type"] == "websocket.disconnect":
                return
            text = event.get("text")
            if text is None:
                raise BadMessage("texts are wanted")
            if text.startswith("ack "):
                self._acknowledge(text[4:])
            else:
                self.inbox.put(parsed(text), len(text))

    async def _work(self) -> None:
        while True:
            message = await self.inbox.next()
            # Shielded, because what waits for its turn would be given up with the connection.
            bad = await asyncio.shield(self._loop.run_in_executor(self._executor, self._perform, message))
            if bad:
                raise bad

    def _perform(self, message: Message) -> BadMessage | None:
        """On the executor's thread. Raises nothing, because nobody waits for it where the connection is lost meanwhile.

        Returns what makes it no message of our pages.
        """
        try:
            perform(message, self._bench)
        except BadMessage as bad:
            return bad
        except RealcamError as error:
            self._bench.report(Problem(str(error), of=subject(message)))
        except Exception:
            _log.exception("%.200s could not be done", message)
            text = "that could not be done; the server's log says more"
            self._bench.report(Problem(text, of=subject(message)))
        return None

    async def _send(self, socket: WebSocket) -> None:
        while True:
            await self._news.wait()
            self._news.clear()
            texts, self._texts = self._texts, {}
            for text in texts.values():
                await socket.send_text(text)
            if self._frames and self._sent is None:
                slot = next(iter(self._frames))
                frame = self._frames.pop(slot)
                self._sent = f"{slot} {frame.serial}", time.perf_counter()
                self._sent_frame = frame
                await socket.send_bytes(_packed(slot, frame))

    def _acknowledge(self, name: str) -> None:
        if self._sent is None or self._sent[0] != name:
            return
        took = time.perf_counter() - self._sent[1]
        self._sent = None
        # Down by a share, up by steps: a slow moment is forgotten after ten quick frames.
        lowest, highest = _QUALITIES
        if took > _SLOW_S:
            self._quality = max(lowest, int(0.8 * self._quality))
        elif took < _QUICK_S:
            self._quality = min(highest, self._quality + 5)
        frame = self._sent_frame
        # Nothing would come any more, and the last frame of a picture would stay as a slow moment has left it.
        is_sent_again = bool(frame and frame.is_final and frame.jpeg_quality < highest and not self._frames)
        is_sent_again &= took <= _LAST_S
        self._bench.set_jpeg_quality(highest if is_sent_again else self._quality)
        self._news.set()
        if is_sent_again:
            with contextlib.suppress(RuntimeError):  # the window is closed
                self._executor.submit(self._bench.show_again)

    # On any thread.

    def _offer_frame(self, slot: str, frame: Frame) -> None:
        call_on_loop(self._loop, self._put_frame, slot, frame)

    def _offer_problem(self, problem: Problem | None) -> None:
        self._offer_text("problem", {"problem": asdict(problem) if problem else None})

    def _offer_plan(self, plan: Plan | None, note: str) -> None:
        rows = [
            {
                "effect": decision.effect,
                "size": decision.size,
                "unit": decision.unit,
                "threshold": decision.threshold,
                "is_kept": decision.is_kept,
                "reason": decision.reason,
            }
            for decision in (plan.decisions if plan else ())
        ]
        model = self._bench.controls.model
        if model != "full":
            note = "What glass and coatings do is seen with the camera model of all surfaces. " + note
        states = self._bench.switches.of_model(model).of
        self._offer_text("plan", {"rows": rows, "note": note, "states": states})

    def _offer_text(self, kind: str, content: dict[str, Any]) -> None:
        call_on_loop(self._loop, self._put_text, kind, json_text({"type": kind, **content}))

    def _put_frame(self, slot: str, frame: Frame) -> None:
        self._frames[slot] = frame
        self._news.set()

    def _put_text(self, kind: str, text: str) -> None:
        self._texts[kind] = text
        self._news.set()


def _packed(slot: str, frame: Frame) -> bytes:
    header = {key: value for key, value in vars(frame).items() if key not in ("jpeg", "costs")}
    header |= {"slot": slot, "costs": vars(frame.costs) if frame.costs else None}
    text = json_text(header).encode()
    return struct.pack("<I", len(text)) + text + frame.jpeg
