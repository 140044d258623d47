"""Writing a job's folder."""

from __future__ import annotations

import os
import shutil
from collections.abc import Mapping
from pathlib import Path

from .._core import InputError, Scene
from ..files import system_name
from ..planning import settled
from ..session import Session
from ..shot import Shot
from .engine import Engine, probe_of
from .folder import JOB_FILE, JobFolder
from .stored import digest_of, pickled, store
from .units import ShotRecord, checked_tile, tile_for


def make_folder(
    folder: str | os.PathLike[str], shots: Mapping[str, Shot], device: str, tile: tuple[int, int] | None
) -> JobFolder:
    """Raises InputError, ImageFileError and DeviceError; a folder that is not whole is gone then."""
    path = Path(folder)
    check_is_new(path)
    _check_names(shots)
    try:
        path.mkdir()
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}") from None
    try:
        return _Making(path, device, tile).folder_of(shots)
    except BaseException:
        shutil.rmtree(path, ignore_errors=True)
        raise


def check_is_new(path: Path) -> None:
    """Raises InputError where no folder of this name can be made."""
    system_name(path)
    if os.path.lexists(path):
        why = "this job is there already" if (path / JOB_FILE).exists() else "this is there already"
        raise InputError(f"{path}: {why}; another name is wanted for a new job")


def _check_names(shots: Mapping[str, Shot]) -> None:
    if not shots:
        raise InputError("a job wants one shot at least")
    for name in shots:
        if not name or name.startswith(".") or "/" in name or not name.isprintable() or len(name) > 200:
            raise InputError(f'a shot\'s name is that of its picture, a file; it is "{name:.40}"')


class _Making:
    def __init__(self, path: Path, device: str, tile: tuple[int, int] | None) -> None:
        self._path, self._device, self._tile = path, device, tile
        self._stored: list[tuple[Scene, str]] = []  # with their digests
        self._session: Session | None = None

    def folder_of(self, shots: Mapping[str, Shot]) -> JobFolder:
        records, probes = [], {}
        for number, (name, shot) in enumerate(shots.items()):
            session, plan = self._settle(shot)
            scene = self._store_scene(shot.scene)
            if scene not in probes:
                probes[scene] = probe_of(session)
            content = pickled((session.camera, session.settings, shot.tone, plan))
            file = f"{number:05d}.shot"
            store(self._path / "shots" / file, content)
            records.append(self._record(name, file, digest_of(content), scene, session))
        engine = Engine.of(session)
        made = JobFolder(self._path, engine, "cpu" if engine.is_cpu else "cuda", records, probes)
        made.write()
        return made

    def _settle(self, shot: Shot) -> tuple[Session, str]:
        """A session on a shot as all processes are to take it."""
        settings = shot.settings
        if settings.spp == "auto":
            settings = settings.with_(seconds=None)
        camera, settings, plan = settled(shot.scene, shot.camera, settings, self._device, stacklevel=5)
        if self._session is not None:
            self._session.set(scene=shot.scene, camera=camera, settings=settings)
        else:
            self._session = Session(shot.scene, camera, settings, device=self._device)
        return self._session, plan

    def _store_scene(self, scene: Scene) -> str:
        """Its digest. Many shots have the same scene, which may be large."""
        for known, digest in self._stored:
            if known is scene:
                return digest
        content = pickled(scene)
        digest = digest_of(content)
        store(self._path / "scenes" / f"{digest[:16]}.scene", content)
        self._stored.append((scene, digest))
        return digest

    def _record(self, name: str, file: str, digest: str, scene: str, session: Session) -> ShotRecord:
        spp = None if session.settings.spp == "auto" else session.settings.spp
        resolution = session.camera.film.resolution
        is_cpu = Engine.of(session).is_cpu
        return ShotRecord(
            name=name,
            file=file,
            digest=digest,
            scene=scene,
            resolution=resolution,
            tile=checked_tile(self._tile) if self._tile else tile_for(resolution, spp, is_cpu),
            spp=spp,
            has_layers=session.has_sampled_layers,
            has_traced_light=bool(session.expose_traced_light(0, 0).splats),
        )
