"""What a page asks for and what is not done yet."""

from __future__ import annotations

import asyncio
from collections import deque

from .messages import BadMessage, Message, merged

_MOST_CHARACTERS = 1 << 20  # of all messages that wait; a thousand edits have a tenth of it


class Inbox:
    """Messages in their order, of which those that need not be done one by one are merged.

    It never makes the page wait: while nothing is read from a connection, the answers to the server's pings are not
    read either, and a connection that does not answer is taken for lost.
    """

    def __init__(self) -> None:
        self._waiting: deque[tuple[Message, int]] = deque()
        self._characters = 0
        self._mail = asyncio.Event()

    def put(self, message: Message, characters: int) -> None:
        """characters: of its text. Raises BadMessage where more waits than a page of ours asks for."""
        if self._waiting:
            last, length = self._waiting[-1]
            one = merged(last, message)
            if one is not None:
                self._waiting.pop()
                self._characters -= length
                message = one
        self._waiting.append((message, characters))
        self._characters += characters
        if self._characters > _MOST_CHARACTERS:
            raise BadMessage("more is asked for than can be done")
        self._mail.set()

    async def next(self) -> Message:
        """The oldest one; waits for it."""
        while not self._waiting:
            self._mail.clear()
            await self._mail.wait()
        message, characters = self._waiting.popleft()
        self._characters -= characters
        return message

    def __len__(self) -> int:
        """How many wait."""
        return len(self._waiting)

    def clear(self) -> None:
        self._waiting.clear()
        self._characters = 0
