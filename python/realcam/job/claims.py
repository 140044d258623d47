"""Which process has which unit in hand.

Claims save work, and nothing else hangs on them: a unit that two processes did would have the same bits twice.
"""

from __future__ import annotations

import os
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

_BEAT_S = 5.0
# A claim that nobody has renewed for so long is another's to take.
_SILENCE_S = 30.0


class Claims:
    """Files beside the units, which their owner renews while it works. Clocks of other machines are never compared."""

    def __init__(self) -> None:
        self._seen: dict[Path, tuple[float, float]] = {}  # the last renewal, and when it was first seen here

    @contextmanager
    def claimed(self, path: Path) -> Iterator[bool]:
        """Whether the unit at `path` is this process's while the context lasts. Raises OSError."""
        claim = path.with_suffix(".claim")
        if not self._take(claim):
            yield False
            return
        over = threading.Event()
        beat = threading.Thread(target=_renew, args=(claim, over), daemon=True)
        beat.start()
        try:
            yield True
        finally:
            over.set()
            beat.join()
            claim.unlink(missing_ok=True)

    def _take(self, claim: Path) -> bool:
        try:
            with claim.open("x") as file:
                file.write(f"{os.getpid()} {socket.gethostname()}")
            return True
        except FileExistsError:
            if not self._is_given_up(claim):
                return False
        except OSError:
            claim.unlink(missing_ok=True)
            raise
        claim.unlink(missing_ok=True)
        self._seen.pop(claim, None)
        return self._take(claim)

    def _is_given_up(self, claim: Path) -> bool:
        try:
            renewed, owner = claim.stat().st_mtime, claim.read_text()
        except OSError:  # it was finished meanwhile
            return False
        process, _, host = owner.partition(" ")
        if host == socket.gethostname() and process.isdecimal() and not _is_running(int(process)):
            return True
        before, since = self._seen.setdefault(claim, (renewed, time.monotonic()))
        if before != renewed:
            self._seen[claim] = (renewed, time.monotonic())
            return False
        return time.monotonic() - since > _SILENCE_S


def _is_running(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:  # another user's
        pass
    return True


def _renew(claim: Path, over: threading.Event) -> None:
    while not over.wait(_BEAT_S):
        with suppress(OSError):
            os.utime(claim)
