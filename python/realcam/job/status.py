"""How far a job is."""

from __future__ import annotations

import math
import os
import zipfile
from dataclasses import dataclass

from .folder import JobFolder

# By so many units that were done last the rate is known.
_LAST_UNITS = 200


@dataclass(frozen=True)
class JobStatus:
    """How far a job is.

    shots, shots_done: numbers of pictures. units_done, units_known: where the noise decides, units become known round
    by round. in_hand: units that processes have claimed.
    is_adaptive: whether the noise decides for some shot. share: of all work, 0 to 1, about. seconds_left: at the pace
    of the last units, about; inf: not known. damaged: the names of units whose files are cut short, which work() does
    again; they do not count as done.
    """

    shots: int
    shots_done: int
    units_known: int
    units_done: int
    in_hand: int
    is_adaptive: bool
    share: float
    seconds_left: float
    damaged: tuple[str, ...] = ()

    @property
    def is_done(self) -> bool:
        return self.shots_done == self.shots


def status_of(folder: JobFolder) -> JobStatus:
    """Raises InputError."""
    known = done = shots_done = in_hand = 0
    share = 0.0
    times: list[float] = []
    damaged: list[str] = []
    for shot in range(len(folder.shots)):
        here = folder.path / "units" / f"{shot:05d}"
        files: dict[str, float] = {}  # when they were written
        claims: set[str] = set()
        if here.is_dir():
            with os.scandir(here) as entries:
                for entry in entries:
                    if entry.name.endswith(".claim"):
                        claims.add(entry.name.removesuffix(".claim"))
                    elif entry.name.endswith(".npz") and not entry.name.startswith("."):
                        if zipfile.is_zipfile(entry.path):  # which looks at the end alone
                            files[entry.name] = entry.stat().st_mtime
                        else:
                            damaged.append(f"{here.name}/{entry.name}")
        # A process that is killed after it has written its unit leaves the claim behind.
        in_hand += len(claims - {name.removesuffix(".npz") for name in files})
        times += files.values()
        rounds, is_all = folder.rounds(shot)
        of_round: list[bool] = []
        known_here = done_here = 0
        for round_ in rounds:
            of_round = [unit.file_name in files for unit in folder.shots[shot].units(shot, round_)]
            known_here += len(of_round)
            done_here += sum(of_round)
        known += known_here
        done += done_here
        is_done = is_all and done_here == known_here
        shots_done += is_done
        if is_done:
            share += 1
        elif rounds:
            within = sum(of_round) / max(1, len(of_round))
            last = rounds[-1]
            share += (last.taken + within * last.left) / (last.taken + last.left) if last.left > 0 else within
    share /= max(1, len(folder.shots))
    return JobStatus(
        shots=len(folder.shots),
        shots_done=shots_done,
        units_known=known,
        units_done=done,
        in_hand=in_hand,
        is_adaptive=any(shot.spp is None for shot in folder.shots),
        share=share,
        seconds_left=_seconds_left(times, done, share),
        damaged=tuple(sorted(damaged)),
    )


def _seconds_left(times: list[float], done: int, share: float) -> float:
    if share >= 1:
        return 0.0
    last = sorted(times)[-_LAST_UNITS:]
    if len(last) < 2 or last[-1] <= last[0] or share <= 0:
        return math.inf
    rate = (len(last) - 1) / (last[-1] - last[0])  # units per second
    return done * (1 - share) / share / rate
