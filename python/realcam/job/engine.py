"""Identity of the compute engine of a job: machines with different engines would not produce the same bits."""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from .._core import InputError, __version__
from ..session import Session

# The kernels of these instruction sets do the same arithmetic, with fused multiply-add; those of v2 have none.
_WITH_EQUAL_BITS = frozenset({"v3", "v4"})


@dataclass(frozen=True)
class Engine:
    """The software and hardware that determine the bits of samples: the version of realcam, the device ("CPU" or the
    GPU's name), the Embree version, and the instruction set."""

    realcam: str
    device: str
    embree: str = ""
    instruction_set: str = ""

    @classmethod
    def of(cls, session: Session) -> Engine:
        """The engine of a session."""
        name = session.device
        found = re.fullmatch(r"CPU \(Embree ([^,]+), x86-64-([^,]+), .*\)", name)
        if not found:
            # A session with several GPUs computes each unit's samples on one of them.
            return cls(__version__, name.removeprefix("GPU (").removesuffix(")").partition(" + ")[0])
        # A machine with only v3 computes the same bits as one with v4.
        instruction_set = "v3" if found[2] in _WITH_EQUAL_BITS else found[2]
        return cls(__version__, "CPU", found[1], instruction_set)

    @property
    def is_cpu(self) -> bool:
        return self.device == "CPU"

    def __str__(self) -> str:
        cpu = f", Embree {self.embree}, x86-64-{self.instruction_set}" if self.is_cpu else ""
        return f"realcam {self.realcam} on {self.device}{cpu}"

    def check_version(self, folder: str) -> None:
        """Raises InputError if the running version of realcam differs."""
        if self.realcam != __version__:
            raise InputError(
                f"{folder}: this job was made by realcam {self.realcam}, and this is realcam {__version__}; all "
                "machines of a job need the same version"
            )

    @contextmanager
    def pinned(self) -> Iterator[None]:
        """Context in which a new session computes with v2 if the job requires it.

        Has no effect if this process has already computed something; `check` then reports the difference.
        """
        name = "REALCAM_INSTRUCTION_SET"
        if self.instruction_set != "v2" or name in os.environ:
            yield
            return
        os.environ[name] = "v2"
        try:
            yield
        finally:
            del os.environ[name]

    def check(self, session: Session, folder: str) -> None:
        """Raises InputError if this process computes with another engine."""
        here = Engine.of(session)
        if here != self:
            raise InputError(f"{folder}: the job requires {self}; this process has {here}, whose samples would differ")


def probe_of(session: Session) -> str:
    """Returns a hash of some samples of a session's picture, to detect machines that produce different bits."""
    width, height = session.camera.film.resolution
    columns, rows = min(16, width), min(16, height)
    digest = hashlib.sha256()
    for column, row in ((0, 0), ((width - columns) // 2, (height - rows) // 2)):
        part = session.expose((column, row, columns, rows), 0, 4)
        assert part.pixels is not None
        digest.update(part.pixels.tobytes())
    return digest.hexdigest()
