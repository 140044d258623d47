"""How many samples a picture gets: a number, or as many as its noise needs."""

from __future__ import annotations

from typing import Literal

from . import _core

Samples = int | Literal["auto"]


def noise_request(
    spp: Samples,
    noise: float | None,
    noise_codes: float | None,
    seconds: float | None,
    max_spp: int | None,
) -> _core._NoiseRequest | None:
    """What is said of the noise where spp is "auto"; else None, and InputError where something is said all the same."""
    if spp == "auto":
        return _core._NoiseRequest(noise, noise_codes, seconds, max_spp)
    if isinstance(spp, str):
        raise _core.ArgumentError(f'spp must be a whole number or "auto"; it is {spp!r:.60}')
    if any(value is not None for value in (noise, noise_codes, seconds, max_spp)):
        raise _core.InputError('noise, noise_codes, seconds and max_spp belong to spp="auto"')
    return None
