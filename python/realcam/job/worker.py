"""Work of one process on a job: rendering units, accumulating rounds, and planning further rounds."""

from __future__ import annotations

import json
import random
import threading
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .. import _core
from .._core import Camera, InputError, RealcamError, RenderSettings, Scene
from ..archive import packed, read_archive, write_archive
from ..film_part import AccumulatedFilm
from ..ocio import BUILT_IN, OcioView
from ..pickling import described, from_description
from ..session import Session
from .engine import probe_of
from .executing import Outcome, Part, range_of_part
from .folder import DamagedFileError, JobFolder
from .units import Round, Unit

_MAX_SCENE_BYTES = 1 << 36  # of a scene's file


@dataclass(frozen=True)
class StoredShot:
    """Content of a shot's file, which excludes its scene."""

    camera: Camera
    settings: RenderSettings
    tone: str | OcioView
    plan: str  #: description of the plan, for the picture
    exr_color_space: str


def tone_text(tone: str | OcioView) -> str:
    """Returns a tone curve or a view as text. Raises InputError for a configuration that is a file, because a job reads
    no files outside of its folder."""
    if not isinstance(tone, OcioView):
        return tone
    if not tone.config.startswith(BUILT_IN):
        raise InputError(
            f"{tone.config}: a job stores no configuration files; use a built-in one ({BUILT_IN}...), or give the view "
            "to Image.save when the job is finished"
        )
    return json.dumps([tone.config, tone.display, tone.view])


def _tone_from(text: str) -> str | OcioView:
    """Returns the tone curve or view of tone_text. Raises InputError."""
    if not text.startswith("["):
        return text
    try:
        config, display, view = json.loads(text)
        if config.startswith(BUILT_IN):
            return OcioView(config, display, view)
    except (ValueError, AttributeError, RecursionError):
        pass
    raise InputError("its view is malformed")


def pack_values(*values: Any, **more: str) -> bytes:
    """Returns an archive of realcam values, keyed by their type names, and of texts `more`; see read_values."""
    buffers: list[np.ndarray] = []
    descriptions = {type(value).__name__: described(value, buffers) for value in values}
    return packed(descriptions | more, {"buffer": np.concatenate([*buffers, np.empty(0, np.uint8)])})


def read_values(path: Path, digest: str) -> dict[str, Any]:
    """Returns the values and texts of an archive by name. Raises InputError if the file does not match the digest."""
    descriptions, arrays = read_archive(path, limit_bytes=_MAX_SCENE_BYTES, digest=digest)
    try:
        return {
            key: value if isinstance(value, str) else from_description(value, arrays["buffer"], key)
            for key, value in descriptions.items()
        }
    except (RealcamError, KeyError, AttributeError) as error:
        raise InputError(f"{path}: {error if isinstance(error, RealcamError) else 'this file is malformed'}") from None


class ShotFilm:
    """Accumulated film of a shot, to which rounds are added in order.

    shot: index in the job. rounds: number of rounds added so far.
    """

    def __init__(self, folder: JobFolder, shot: int, stored: StoredShot) -> None:
        self._folder, self._shot, self._stored = folder, shot, stored
        self._record = folder.shots[shot]
        self.film = AccumulatedFilm(*self._record.resolution)
        self.rounds = 0
        self._noise: _core._Rounds | None = None
        self._mean_spp = 0

    def add(self, round_: Round) -> Round | None:
        """Adds a round. Returns the following round of a shot with a noise goal, or None if there is no further one.

        Decisions depend only on the sums, so that every process makes the same. Raises InputError if units are missing
        or damaged.
        """
        for unit in self._record.units(self._shot, round_):
            self.film.add(self._folder.read(unit, round_))
        self.rounds += 1
        if round_.is_of_layers or self._record.spp is not None:
            return None
        counts, pixels = round_.counts, self.film.pixels.size
        self._mean_spp += round_.spp if counts is None else -(-int(counts.sum(dtype="int64")) // pixels)
        seconds = self._stored.camera.exposure_time_s
        exposure = self.film.exposure(self._stored.settings, seconds)
        traced = self.film.traced_exposure(seconds) if round_.traces_lights else np.empty(0, np.float32)
        samples = self.film.pixels["samples"].astype("int64")
        if self._noise is None:
            self._noise = _core._Rounds(self._stored.settings, self._stored.camera.iso, exposure, samples, traced)
        else:
            assert counts is not None
            self._noise.add(exposure, counts, traced)
        next_counts, taken = self._noise.next(), float(samples.sum())
        if next_counts.any():
            left = max(self._noise.left(), float(next_counts.sum(dtype="int64")))
            begin = round_.samples + round_.spp
            progress = {"traces_lights": self._noise.traces_lights, "taken": taken, "left": left}
            return Round(round_.number + 1, begin, int(next_counts.max()), next_counts, **progress)  # type: ignore[arg-type]
        if self._record.has_layers:
            return Round(round_.number + 1, 0, self._mean_spp, is_of_layers=True, taken=taken)
        return None

    @property
    def shortfall(self) -> str:
        """Message if the noise goal was not reached; empty otherwise."""
        return self._noise.shortfall() if self._noise else ""


class Worker:
    """A job in one process, which caches the session and scene last used.

    All functions raise InputError (also for an OSError, with the file's name), DeviceError and ImageFileError.
    """

    def __init__(self, folder: JobFolder, threads: int = 0, device: str | None = None) -> None:
        self.folder = folder
        self._threads, self._device = threads, device or folder.device
        self._session: Session | None = None
        self._scene: tuple[str, Scene] | None = None
        self._checked: set[str] = set()  # digests of the scenes for which this machine computes the same samples
        self._session_shot = -1  # index of the session's shot
        self._rounds: dict[int, list[Round]] = {}
        self._films: dict[int, ShotFilm] = {}

    def shot(self, index: int) -> StoredShot:
        """Reads a shot. Raises InputError if its file is damaged."""
        record = self.folder.shots[index]
        path = self.folder.directory("shots") / f"{index:05d}.npz"
        values = read_values(path, record.digest)
        try:
            camera, settings = values["Camera"], values["RenderSettings"].with_(threads=self._threads)
            stored = StoredShot(camera, settings, _tone_from(values["tone"]), values["plan"], values["exr_color_space"])
        except KeyError:
            raise InputError(f"{path}: this file is malformed") from None
        except InputError as error:
            raise InputError(f"{path}: {error}") from None
        spp = None if settings.spp == "auto" else settings.spp
        if (camera.film.resolution, spp) != (record.resolution, record.spp):
            raise InputError(f"{path}: its resolution or number of samples differs from job.json")
        return stored

    def scene(self, digest: str) -> Scene:
        """Reads a scene, unless it is the last one used. Raises InputError if its file is damaged."""
        if self._scene is None or self._scene[0] != digest:
            self._scene = None  # frees its memory before the next one is read
            path = self.folder.directory("scenes") / f"{digest[:16]}.npz"
            self._scene = (digest, read_values(path, digest)["Scene"])
        return self._scene[1]

    def session(self, index: int) -> Session:
        """Returns the session, set to a shot. Raises InputError if this machine's samples differ from the job's."""
        if self._session is None or self._session_shot != index:
            scene = self.folder.shots[index].scene
            if scene not in self._checked:
                first = next(i for i, shot in enumerate(self.folder.shots) if shot.scene == scene)
                self._set(first)
                assert self._session is not None
                self.folder.engine.check(self._session, str(self.folder.path))
                if probe_of(self._session) != self.folder.probes[scene]:
                    raise InputError(
                        f"{self.folder.path}: the samples of this machine differ from those of the one that made the "
                        "job, although their descriptions are equal; their libraries or processors may differ"
                    )
                self._checked.add(scene)
            self._set(index)
        assert self._session is not None
        return self._session

    def _set(self, index: int) -> None:
        """Sets the session to a shot."""
        shot, scene = self.shot(index), self.scene(self.folder.shots[index].scene)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # already shown when the job was made
            if self._session is not None:
                self._session.set(scene=scene, camera=shot.camera, settings=shot.settings)
            else:
                with self.folder.engine.pinned():
                    self._session = Session(scene, shot.camera, shot.settings, device=self._device)
        self._session_shot = index

    def run(self, unit: Unit) -> None:
        """Renders a unit and writes it, unless its file exists."""
        try:
            path = self.folder.unit_path(unit)
            if path.exists():
                return
            path.parent.mkdir(parents=True, exist_ok=True)
            content = self._expose(unit).packed(self.folder.id)
            if not self.folder.is_current():
                raise InputError(f"{self.folder.path}: the job was replaced while this process worked on it")
            write_archive(path, content, replaces=False)  # another process may have written it meanwhile
        except OSError as error:
            raise InputError(f"{self.folder.path}: {error.strerror or error}") from None

    def _expose(self, unit: Unit) -> Any:
        """Renders a unit. Returns its FilmPart."""
        session = self.session(unit.shot)
        if unit.region is None:
            return session.expose_traced_light(unit.first, unit.spp)
        if unit.kind == "layers":
            return session.expose_layers(unit.region, unit.first, unit.spp)
        if self.folder.shots[unit.shot].spp is not None:
            return session.expose(unit.region, unit.first, unit.spp)
        if unit.round >= len(self._rounds.get(unit.shot, [])):
            self._rounds = {unit.shot: self.folder.rounds(unit.shot)[0]}
        if unit.round >= len(self._rounds[unit.shot]):
            raise InputError(f"{self.folder.path}: {unit} belongs to a round that the shot does not have")
        counts = self._rounds[unit.shot][unit.round].counts_of(unit)
        if counts is None:
            counts = np.full(unit.region[:1:-1], unit.spp, np.uint32)
        return session.expose(unit.region, unit.first, unit.spp, counts)

    def missing(self, shot: int) -> tuple[Round, list[Unit]] | None:
        """Returns the first incomplete round of a shot and its missing units; None: the shot is finished.

        If all known rounds are complete, computes and writes the next one.
        """
        while True:
            rounds, is_all = self.folder.rounds(shot)
            for round_ in rounds:
                if units := self.folder.missing(shot, round_):
                    return round_, units
            if is_all:
                return None
            try:
                following = self._following(shot, rounds)
            except DamagedFileError:
                self._films.pop(shot, None)
                continue  # the damaged unit was removed and is now missing
            self.folder.write_round(shot, len(rounds), following)

    def _following(self, shot: int, known: list[Round]) -> Round | None:
        """Computes the round after the known ones, which are complete; None: there is no further one."""
        stored = self.shot(shot)
        if not known:
            return Round(0, 0, _core._Rounds.first_samples(stored.settings))
        film = self._films.pop(shot, None)
        if film is None or film.rounds >= len(known):
            film = ShotFilm(self.folder, shot, stored)
        following = None
        for round_ in known[film.rounds :]:
            following = film.add(round_)
        self._films = {shot: film}  # one at a time: films are large
        return following

    def film(self, shot: int) -> ShotFilm:
        """Returns the complete film of a shot. Raises InputError if units are missing or damaged."""
        film = ShotFilm(self.folder, shot, self.shot(shot))
        for round_ in self.folder.rounds(shot)[0]:
            film.add(round_)
        return film

    def work(self, part: Part | None) -> Iterator[None]:
        """Renders the missing units, and yields after each.

        A part (k, n) is the k-th contiguous n-th of each round, counted over all shots. Units of other parts follow
        only if a noise goal needs them for the next round. A process never waits: units that others are working on may
        be rendered twice, with the same bits. Each process takes units of other parts in its own random order, so that
        this is rare.
        """
        records = self.folder.shots
        order = random.Random(None if part is None else part[0])
        k, n = part or (1, 1)
        first = range_of_part(len(records), part).start
        indices = [*range(first, len(records)), *range(first)]
        if part is None:
            order.shuffle(indices)
        for shot in indices:
            is_counted = records[shot].spp is not None  # the number of samples is fixed
            while (found := self.missing(shot)) is not None:
                units = list(records[shot].units(shot, found[0]))
                ends = [(shot + i / len(units)) / len(records) * n for i in range(len(units))]
                of_part = {unit for unit, end in zip(units, ends, strict=True) if int(end) == k - 1}
                own = [unit for unit in found[1] if unit in of_part]
                others = [] if is_counted else [unit for unit in found[1] if unit not in of_part]
                order.shuffle(others if part else own)
                for unit in own + others:
                    self.run(unit)
                    yield
                if is_counted:  # the remaining units belong to other parts
                    break


class _LastWorker(threading.local):
    """The worker last used by a thread of an executor."""

    key: tuple[str, str, int] | None = None  #: folder, id of the job, and number of threads
    worker: Worker | None = None

    def worker_of(self, folder: str, job: str, threads: int) -> Worker:
        """Returns the worker of a job, by its id. Raises InputError if the folder has another job."""
        if self.worker is None or self.key != (folder, job, threads):
            self.worker, opened = None, JobFolder.open(folder)
            if opened.id != job:
                raise InputError(f"{folder}: the job was replaced, or this machine has another one of this name")
            self.worker, self.key = Worker(opened, threads), (folder, job, threads)
        return self.worker


_LAST_WORKER = _LastWorker()


def run_unit(folder: str, job: str, unit: Unit, threads: int) -> Outcome:
    """Renders a unit in a process of an executor. Returns an error message, empty on success."""
    try:
        _LAST_WORKER.worker_of(folder, job, threads).run(unit)
    except RealcamError as error:
        return str(error)
    return ""
