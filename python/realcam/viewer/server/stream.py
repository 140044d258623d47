"""WebSocket between a window's bench and its page: sends frames and drawings, receives mouse and keyboard input.

A frame is a binary message: the length of a JSON header as four bytes, little-endian, the header, a JPEG. At most one
frame is unacknowledged; once the page has acknowledged it, the newest waiting one is sent. Other messages are JSON
text.
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

from ..._core import Plan, RealcamError
from ..lens_bench import LensBench
from ..listeners import Problem
from ..pictures.picture_request import Frame
from .inbox import Inbox
from .messages import BadMessage, Message, json_text, parsed, perform, subject
from .server_loop import call_on_loop

_log = logging.getLogger(__name__)

_QUALITIES = (40, 90)  # lowest and highest JPEG quality
_SLOW_S, _FAST_S = 0.120, 0.050  # round-trip times of a frame above and below which the quality is adapted
_RESEND_LIMIT_S = 0.5  # largest round-trip time of a final frame at which it is sent again at the highest quality


class PictureStream:
    """Serves the page of one bench: one connection at a time, and a new one after a lost connection.

    executor: its single thread performs the user's actions. Must be made on the server's loop.
    """

    def __init__(self, bench: LensBench, executor: ThreadPoolExecutor) -> None:
        self._bench, self._executor = bench, executor
        self._loop = asyncio.get_running_loop()
        self._frames: dict[str, Frame] = {}  #: frames to send, by slot
        self._texts: dict[str, str] = {}  #: messages to send, by type
        self._has_news = asyncio.Event()  #: set if there is something to send
        self.inbox = Inbox()  #: outlives a lost connection
        self._serving: list[asyncio.Task[None]] = []  #: tasks of the newest connection
        self._sent: tuple[str, float] | None = None  #: the unacknowledged frame, and the time at which it was sent
        self._sent_frame: Frame | None = None  #: the last frame sent
        self._quality = _QUALITIES[1]
        bench.listeners.frame = self._offer_frame
        bench.listeners.lens = lambda view: self._offer_text("lens", view)
        bench.listeners.rays = lambda view: self._offer_text("rays", view)
        bench.listeners.problem = self._offer_problem
        bench.listeners.plan = self._offer_plan
        bench.listeners.state = lambda state: self._offer_text("state", {"state": state})
        bench.listeners.levels = lambda levels, note: self._offer_text("levels", {"levels": levels, "note": note})

    async def serve(self, socket: WebSocket) -> None:
        """Serves until the page disconnects. Closes the connection at a message that our page never sends."""
        await socket.accept()
        for task in self._serving:  # a dead connection would continue to take frames
            task.cancel()
        self._sent = None
        endless = [asyncio.create_task(part) for part in (self._receive(socket), self._send(socket), self._work())]
        tasks = [*endless, asyncio.create_task(self._begin())]
        self._serving = tasks
        try:
            done, _ = await asyncio.wait(endless, return_when=asyncio.FIRST_COMPLETED)
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
        """Lets the bench send its current state. Logs errors, because nobody awaits this task."""
        try:
            await self._loop.run_in_executor(self._executor, self._bench.show)
        except Exception:
            _log.exception("the state of the bench could not be sent")

    async def _receive(self, socket: WebSocket) -> None:
        while True:
            event = await socket.receive()
            if event["type"] == "websocket.disconnect":
                return
            text = event.get("text")
            if text is None:
                raise BadMessage("expected text messages")
            if text.startswith("ack "):
                self._acknowledge(text[4:])
            else:
                self.inbox.put(parsed(text), len(text))

    async def _work(self) -> None:
        """Performs the messages of the inbox in order. Raises BadMessage."""
        while True:
            message = await self.inbox.next()
            # Shielded, because otherwise a queued action would be cancelled with the connection.
            bad = await asyncio.shield(self._loop.run_in_executor(self._executor, self._perform, message))
            if bad:
                raise bad

    def _perform(self, message: Message) -> BadMessage | None:
        """Performs a message on the executor's thread. Never raises, because nobody awaits it after a lost connection.

        Returns the BadMessage of a message that our page never sends.
        """
        try:
            perform(message, self._bench)
        except BadMessage as bad:
            return bad
        except RealcamError as error:
            self._bench.report(Problem(str(error), view=subject(message)))
        except Exception:
            _log.exception("the message %.200s could not be performed", message)
            text = "this action failed; see the server's log"
            self._bench.report(Problem(text, view=subject(message)))
        return None

    async def _send(self, socket: WebSocket) -> None:
        while True:
            await self._has_news.wait()
            self._has_news.clear()
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
        """Handles the page's acknowledgement of the last frame. name: its slot and serial, "a 12"."""
        if self._sent is None or self._sent[0] != name:
            return
        took = time.perf_counter() - self._sent[1]
        self._sent = None
        # Multiplicative decrease, additive increase: recovers from a slow moment within ten fast frames.
        lowest, highest = _QUALITIES
        if took > _SLOW_S:
            self._quality = max(lowest, int(0.8 * self._quality))
        elif took < _FAST_S:
            self._quality = min(highest, self._quality + 5)
        frame = self._sent_frame
        # Sends a final frame of reduced quality again, because no further frame would replace it.
        is_sent_again = bool(frame and frame.is_final and frame.jpeg_quality < highest and not self._frames)
        is_sent_again &= took <= _RESEND_LIMIT_S
        self._bench.set_jpeg_quality(highest if is_sent_again else self._quality)
        self._has_news.set()
        if is_sent_again:
            with contextlib.suppress(RuntimeError):  # raised if the window is closed
                self._executor.submit(self._bench.show_again)

    # The following functions may be called on any thread.

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
            note = 'Effects of glass and coatings need the camera model "all surfaces". ' + note
        states = self._bench.switches.restricted_to_model(model).states
        self._offer_text("plan", {"rows": rows, "note": note, "states": states})

    def _offer_text(self, kind: str, content: dict[str, Any]) -> None:
        call_on_loop(self._loop, self._put_text, kind, json_text({"type": kind, **content}))

    def _put_frame(self, slot: str, frame: Frame) -> None:
        self._frames[slot] = frame
        self._has_news.set()

    def _put_text(self, kind: str, text: str) -> None:
        self._texts[kind] = text
        self._has_news.set()


def _packed(slot: str, frame: Frame) -> bytes:
    """Returns the binary message of a frame."""
    header = {key: value for key, value in vars(frame).items() if key not in ("jpeg", "costs")}
    header |= {"slot": slot, "costs": vars(frame.costs) if frame.costs else None}
    text = json_text(header).encode()
    return struct.pack("<I", len(text)) + text + frame.jpeg
