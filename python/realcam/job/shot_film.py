"""What the units of a shot add up to, and how its noise calls for more."""

from __future__ import annotations

import numpy as np

from .. import _core
from .._core import Camera, RenderSettings
from ..film_part import CollectedFilm
from .folder import JobFolder
from .units import Round


class ShotFilm:
    """The film of a shot, to which rounds are added one after the other."""

    def __init__(self, folder: JobFolder, shot: int, camera: Camera, settings: RenderSettings) -> None:
        self._folder, self._shot, self._camera, self._settings = folder, shot, camera, settings
        self.film = CollectedFilm(*folder.shots[shot].resolution)
        self.rounds = 0  # added
        self._noise: _core._Rounds | None = None
        self._mean_spp = 0

    def add(self, round_: Round) -> None:
        """Raises InputError where units are missing or damaged."""
        for unit in self._folder.shots[self._shot].units(self._shot, round_):
            self.film.add(self._folder.read(unit))
        self.rounds += 1
        pixels = self.film.pixels.size
        if round_.counts is not None:
            self._mean_spp += -(-int(round_.counts.sum(dtype="int64")) // pixels)
        elif not round_.is_of_layers:
            self._mean_spp += round_.spp

    def after(self, round_: Round) -> Round | None:
        """The next round of a shot whose noise decides, once `round_` was added as the last; None: there is none.

        The same decisions as in one session, from the same numbers.
        """
        if round_.is_of_layers:
            return None
        seconds = self._camera.exposure_time_s
        exposure = self.film.exposure(self._settings, seconds)
        traced = self.film.traced_exposure(seconds) if round_.traces_lights else np.empty(0, np.float32)
        if self._noise is None:
            samples = self.film.pixels["samples"].astype("int64")
            self._noise = _core._Rounds(self._settings, self._camera.iso, exposure, samples, traced)
        else:
            assert round_.counts is not None
            self._noise.add(exposure, round_.counts, traced)
        counts = self._noise.next()
        most, taken = int(counts.max()), float(self.film.pixels["samples"].sum())
        if most > 0:
            left = max(self._noise.left(), float(counts.sum(dtype="int64")))
            return Round(
                round_.number + 1,
                round_.samples + round_.spp,
                most,
                counts,
                traces_lights=self._noise.traces_lights,
                taken=taken,
                left=left,
            )
        if self._folder.shots[self._shot].has_layers:
            return Round(round_.number + 1, 0, self._mean_spp, is_of_layers=True, taken=taken, left=0)
        return None

    @property
    def shortfall(self) -> str:
        return self._noise.shortfall() if self._noise else ""


def first_round(settings: RenderSettings) -> Round:
    """Of a shot whose noise decides."""
    return Round(0, 0, _core._Rounds.first_samples(settings))
