"""What there is to choose from: effects and devices."""

from __future__ import annotations

from dataclasses import dataclass

from . import _core


@dataclass(frozen=True)
class EffectInfo:
    """What can be simulated besides. str() is a line of it.

    name: for effects=(...). what: it is. needs: of lens, scene and camera. usage: what else to know, or "".
    is_on: unless it is left out, as "-name". parameter: what name alone means of "name=number"; None: it has none.
    has_wavelengths: samples have one each, so that an illuminant can be named. needs_full_lens: camera model "full".
    needs_coatings: in the lens file; else they are guessed. shows_in_previews: in pictures of fewer pixels than were
    asked for. cpu_time, gpu_time: of a picture with it over one without (benchmarks/effects.py); 0: not measured.
    """

    name: str
    what: str
    needs: str
    usage: str
    is_on: bool
    parameter: float | None
    has_wavelengths: bool
    needs_full_lens: bool
    needs_coatings: bool
    shows_in_previews: bool
    cpu_time: float
    gpu_time: float

    @property
    def description(self) -> str:
        """What it is and needs, in a line."""
        return "; ".join(filter(None, (self.what, f"needs {self.needs}", self.usage)))

    def __str__(self) -> str:
        return f"{self.name}: {self.description}"


@dataclass(frozen=True)
class Device:
    """What this machine can render with. str() is a line of it.

    name: for device=...: "cpu", "cuda:0", ... description: for people.
    """

    name: str
    description: str

    def __str__(self) -> str:
        return f"{self.name}: {self.description}"


def effects() -> list[EffectInfo]:
    """All effects that can be named."""
    return [EffectInfo(**row) for row in _core._effects()]


def devices() -> list[Device]:
    """All devices of this machine, the CPU first."""
    return [Device(**row) for row in _core._devices()]
