"""What a process does of a job: exposing units, and adding up rounds."""

from __future__ import annotations

import threading
import warnings
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

import numpy as np

from .._core import Camera, InputError, RealcamError, RenderSettings, Scene
from ..film_part import FilmPart
from ..session import Session
from .claims import Claims
from .engine import probe_of
from .folder import JOB_FILE, DamagedFileError, JobFolder, read_round, write_round
from .shot_film import ShotFilm, first_round
from .stored import read_stored
from .units import Round, Unit, counts_of


class StoredShot(NamedTuple):
    """What a shot's file holds beside its scene."""

    camera: Camera
    settings: RenderSettings
    tone: str
    plan: str


class Worker:
    """A job in one process, with the session that it needed last. All functions raise InputError, DeviceError and
    ImageFileError; an OSError becomes an InputError that names the file."""

    def __init__(self, folder: JobFolder, threads: int = 0, device: str | None = None) -> None:
        self.folder = folder
        self._threads, self._device = threads, device or folder.device
        self._claims = Claims()
        self._session: Session | None = None
        self._scene: tuple[str, Scene] | None = None
        self._checked: set[str] = set()  # scenes
        self._at = -1  # the session's shot
        self._round: tuple[Path, Round] | None = None
        self._films: dict[int, ShotFilm] = {}

    def shot(self, number: int) -> StoredShot:
        record = self.folder.shots[number]
        state = read_stored(self.folder.path / "shots" / record.file, record.digest)
        camera, settings, tone, plan = state
        return StoredShot(camera, settings.with_(threads=self._threads), tone, plan)

    def scene(self, digest: str) -> Scene:
        if self._scene is None or self._scene[0] != digest:
            self._scene = None  # before the next takes as much memory
            self._scene = (digest, read_stored(self.folder.path / "scenes" / f"{digest[:16]}.scene", digest))
        return self._scene[1]

    def session(self, number: int) -> Session:
        """On that shot."""
        if self._session is None or self._at != number:
            scene = self.folder.shots[number].scene
            if scene not in self._checked:
                self._check(scene)
            self._session, self._at = self._set(number), number
        return self._session

    def _set(self, number: int) -> Session:
        shot, scene = self.shot(number), self.scene(self.folder.shots[number].scene)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # whoever made the job has seen them
            if self._session is not None:
                self._session.set(scene=scene, camera=shot.camera, settings=shot.settings)
                return self._session
            with self.folder.engine.pinned():
                return Session(scene, shot.camera, shot.settings, device=self._device)

    def _check(self, scene: str) -> None:
        """That the samples of this machine are those of the job."""
        first = next(i for i, shot in enumerate(self.folder.shots) if shot.scene == scene)
        session = self._set(first)
        self.folder.engine.check(session, str(self.folder.path))
        if probe_of(session) != self.folder.probes[scene]:
            raise InputError(
                f"{self.folder.path}: this machine computes other samples than the one that made the job, although it "
                "names itself as the same; other libraries or another processor may be why"
            )
        self._session, self._at = session, first
        self._checked.add(scene)

    def run(self, unit: Unit) -> bool:
        """Exposes a unit, unless it is done or another process has it in hand. Whether it was done here."""
        path = self.folder.unit_path(unit)
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            if path.exists():
                return False
            with self._claims.claimed(path) as is_mine:
                if not is_mine or path.exists():
                    return False
                self.expose(unit).save(path)
                return True
        except OSError as error:
            raise InputError(f"{path}: {error.strerror or error}") from None

    def expose(self, unit: Unit) -> FilmPart:
        session = self.session(unit.shot)
        if unit.region is None:
            return session.expose_traced_light(unit.first, unit.spp)
        if unit.kind == "layers":
            return session.expose_layers(unit.region, unit.first, unit.spp)
        counts = None
        if self.folder.shots[unit.shot].spp is None:
            counts = counts_of(self._round_of(unit), unit.region, unit.first)
            if counts is None:  # of the first round
                counts = np.full(unit.region[:1:-1], unit.spp, np.uint32)
        return session.expose(unit.region, unit.first, unit.spp, counts)

    def _round_of(self, unit: Unit) -> Round:
        path = self.folder.round_path(unit.shot, unit.round)
        if self._round is None or self._round[0] != path:
            found = read_round(path)
            if found is None:
                raise InputError(f"{path}: the shot has no such round")
            self._round = (path, found)
        return self._round[1]

    def missing(self, shot: int) -> list[Unit]:
        """The units that can be done of a shot. Where a round is whole, the next one is found first, unless another
        process does that already: then there are none."""
        while True:
            rounds, is_all = self.folder.rounds(shot)
            for round_ in rounds:  # also of earlier ones some may have been lost
                if missing := self.folder.missing(shot, round_):
                    return missing
            if is_all or not self._find_round(shot, rounds):
                return []

    def is_done(self, shot: int) -> bool:
        rounds, is_all = self.folder.rounds(shot)
        return is_all and not any(self.folder.missing(shot, round_) for round_ in rounds)

    def _find_round(self, shot: int, known: list[Round]) -> bool:
        """Whether it was found here or is there."""
        path = self.folder.round_path(shot, len(known))
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            with self._claims.claimed(path) as is_mine:
                if not is_mine:
                    return False
                if not path.exists():
                    with suppress(DamagedFileError):  # whose unit is missing again
                        write_round(path, self._following(shot, known))
                return True
        except OSError as error:
            raise InputError(f"{path}: {error.strerror or error}") from None

    def _following(self, shot: int, known: list[Round]) -> Round | None:
        stored = self.shot(shot)
        if not known:
            return first_round(stored.settings)
        film = self._films.pop(shot, None)
        if film is None or film.rounds >= len(known):
            film = ShotFilm(self.folder, shot, stored.camera, stored.settings)
        following = None
        for round_ in known[film.rounds :]:
            film.add(round_)
            following = film.after(round_)
        self._films = {shot: film}  # films are large, and one that is gone is read again
        return following

    def film(self, shot: int) -> ShotFilm:
        """All of a shot. Raises InputError where some of it is missing."""
        stored = self.shot(shot)
        film = ShotFilm(self.folder, shot, stored.camera, stored.settings)
        for round_ in self.folder.rounds(shot)[0]:
            film.add(round_)
            if self.folder.shots[shot].spp is None:
                film.after(round_)
        return film


class _Kept(threading.local):
    """The worker that a thread needed last: the next unit is mostly of the same shot."""

    key: tuple[str, float, int] | None = None
    worker: Worker | None = None

    def worker_of(self, folder: str, threads: int) -> Worker:
        key = (folder, (Path(folder) / JOB_FILE).stat().st_mtime, threads)
        if self.worker is None or self.key != key:
            self.worker, self.key = None, None
            self.worker, self.key = Worker(JobFolder.open(folder), threads), key
        return self.worker


_KEPT = _Kept()


def run_unit(folder: str, unit: Unit, threads: int) -> tuple[bool, str]:
    """What an executor's process is sent: whether the unit was done here, and what was wrong; empty: nothing."""
    try:
        return _KEPT.worker_of(folder, threads).run(unit), ""
    except FileNotFoundError:
        return False, f"{folder}: this machine has no such job folder; all machines of a job need the same one"
    except RealcamError as error:
        return False, str(error)
