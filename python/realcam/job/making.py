"""Creation of a job's folder."""

from __future__ import annotations

import os
import shutil
from collections.abc import Mapping
from pathlib import Path

from .._core import InputError, Scene
from ..archive import digest_of, write_archive
from ..files import system_name
from ..planning import resolved
from ..session import Session
from ..shot import Shot
from .engine import Engine, probe_of
from .folder import JOB_FILE, JobFolder, check_names
from .units import ShotRecord, checked_tile, tile_for
from .worker import pack_values, tone_text


def make_folder(
    folder: str | os.PathLike[str], shots: Mapping[str, Shot], device: str, tile: tuple[int, int] | None
) -> JobFolder:
    """Creates a job's folder. Raises InputError, ImageFileError and DeviceError; an incomplete folder is then
    removed."""
    path = Path(folder)
    check_is_new(path)
    check_names(list(shots))
    size = checked_tile(tile) if tile else None
    try:
        path.mkdir()
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}") from None
    try:
        return _written(path, shots, device, size)
    except BaseException:
        shutil.rmtree(path, ignore_errors=True)
        raise


def check_is_new(path: Path) -> None:
    """Raises InputError if a file or folder of this name exists."""
    system_name(path)
    if os.path.lexists(path):
        why = "this job exists already" if (path / JOB_FILE).exists() else "this name is in use"
        raise InputError(f"{path}: {why}; choose another name for a new job")


def _written(path: Path, shots: Mapping[str, Shot], device: str, tile: tuple[int, int] | None) -> JobFolder:
    """Writes the files of a job into an empty folder; arguments as for Job.make."""
    records: list[ShotRecord] = []
    probes: dict[str, str] = {}
    scenes: list[tuple[Scene, str]] = []  # with their digests: many shots share a scene, which may be large
    session: Session | None = None
    for name in ("shots", "scenes"):
        (path / name).mkdir()
    for index, (name, shot) in enumerate(shots.items()):
        # A limit of seconds would give each machine a different number of samples.
        settings = shot.settings.with_(seconds=None) if shot.settings.spp == "auto" else shot.settings
        camera, settings, plan = resolved(shot.scene, shot.camera, settings, device, stacklevel=5)
        if session is None:
            session = Session(shot.scene, camera, settings, device=device)
        else:
            session.set(scene=shot.scene, camera=camera, settings=settings)
        scene = next((digest for known, digest in scenes if known is shot.scene), None)
        if scene is None:
            content = pack_values(shot.scene)
            scene = digest_of(content)
            write_archive(path / "scenes" / f"{scene[:16]}.npz", content)
            scenes.append((shot.scene, scene))
            if scene not in probes:  # another Scene object may have the same content
                probes[scene] = probe_of(session)
        content = pack_values(
            session.camera, session.settings, tone=tone_text(shot.tone), plan=plan, exr_color_space=shot.exr_color_space
        )
        write_archive(path / "shots" / f"{index:05d}.npz", content)
        spp = None if session.settings.spp == "auto" else int(session.settings.spp)
        resolution = session.camera.film.resolution
        record = ShotRecord(
            name=name,
            digest=digest_of(content),
            scene=scene,
            resolution=resolution,
            tile=tile or tile_for(resolution, spp, Engine.of(session).is_cpu),
            spp=spp,
            has_layers=session.has_sampled_layers,
            has_traced_light=bool(session.expose_traced_light(0, 0).splats),
        )
        record.check_count()
        records.append(record)
    assert session is not None
    engine = Engine.of(session)
    return JobFolder.new(path, engine, "cpu" if engine.is_cpu else "cuda", records, probes)
