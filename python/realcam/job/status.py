"""The progress of a job."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .folder import JobFolder

_LAST_UNITS = 200  # number of latest units from which the rate is estimated


@dataclass(frozen=True)
class JobStatus:
    """The progress of a job.

    shots, shots_done: numbers of pictures. units_done, units_known: numbers of units; with a noise goal, units become
    known round by round. is_adaptive: True if some shot has a noise goal. share: estimated fraction of the work done, 0
    to 1. seconds_left: estimate from the rate of the last units; inf: unknown. damaged: names of units whose files are
    truncated or belong to another job; they do not count as done, and work() takes their samples again.
    """

    shots: int
    shots_done: int
    units_known: int
    units_done: int
    is_adaptive: bool
    share: float
    seconds_left: float
    damaged: tuple[str, ...] = ()

    @property
    def is_done(self) -> bool:
        return self.shots_done == self.shots


def status_of(folder: JobFolder) -> JobStatus:
    """Returns the progress of a job. Raises InputError."""
    known = done = shots_done = 0
    share = 0.0
    times: list[float] = []
    damaged: list[str] = []
    for shot, record in enumerate(folder.shots):
        files, damaged_here = folder.done(shot)
        damaged += damaged_here
        times += files.values()
        rounds, is_all = folder.rounds(shot)
        is_there = [[unit.file_name in files for unit in record.units(shot, round_)] for round_ in rounds]
        known_here, done_here = sum(map(len, is_there)), sum(map(sum, is_there))
        known += known_here
        done += done_here
        if is_all and done_here == known_here:
            shots_done += 1
            share += 1
        elif rounds:
            within, last = sum(is_there[-1]) / max(1, len(is_there[-1])), rounds[-1]
            share += (last.taken + within * last.left) / (last.taken + last.left) if last.left > 0 else within
    share /= len(folder.shots)
    is_adaptive = any(record.spp is None for record in folder.shots)
    left = _seconds_left(sorted(times)[-_LAST_UNITS:], done, share)
    return JobStatus(len(folder.shots), shots_done, known, done, is_adaptive, share, left, tuple(damaged))


def _seconds_left(last: list[float], done: int, share: float) -> float:
    """Estimated remaining seconds; inf: unknown.

    last: sorted times at which the latest units were written. done: number of finished units. share: fraction of the
    work done.
    """
    if share >= 1:
        return 0.0
    if len(last) < 2 or last[-1] <= last[0] or share <= 0:
        return math.inf
    rate = (len(last) - 1) / (last[-1] - last[0])  # units per second
    return done * (1 - share) / share / rate
