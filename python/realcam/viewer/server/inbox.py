"""Queue of a page's pending messages."""

from __future__ import annotations

import asyncio
from collections import deque

from .messages import BadMessage, Message, merged

_MAX_CHARACTERS = 1 << 20  # total length of all pending messages; a thousand edits take a tenth of it


class Inbox:
    """First-in, first-out queue that merges consecutive messages where possible.

    It never blocks the connection's reader: otherwise the replies to the server's pings would not be read either, and
    the connection would be considered lost.
    """

    def __init__(self) -> None:
        self._waiting: deque[tuple[Message, int]] = deque()
        self._characters = 0
        self._mail = asyncio.Event()

    def put(self, message: Message, characters: int) -> None:
        """Adds a message. characters: length of its text. Raises BadMessage if more is pending than our page ever
        sends."""
        if self._waiting:
            last, length = self._waiting[-1]
            replacement = merged(last, message)
            if replacement is not None:
                self._waiting.pop()
                self._characters -= length
                message = replacement
        self._waiting.append((message, characters))
        self._characters += characters
        if self._characters > _MAX_CHARACTERS:
            raise BadMessage("too many messages are pending")
        self._mail.set()

    async def next(self) -> Message:
        """Removes and returns the oldest message; waits for one if the queue is empty."""
        while not self._waiting:
            self._mail.clear()
            await self._mail.wait()
        message, characters = self._waiting.popleft()
        self._characters -= characters
        return message

    def __len__(self) -> int:
        """Number of pending messages."""
        return len(self._waiting)

    def clear(self) -> None:
        """Discards all pending messages."""
        self._waiting.clear()
        self._characters = 0
