"""Jobs and the processes that work on them, for tests."""

from __future__ import annotations

import os
import subprocess
import sys
import warnings
from pathlib import Path

import realcam as rc

from .. import scenes


def shot(spp: int | str = 300, **more: object) -> rc.Shot:
    """A lamp before a wall, through a lens that shows ghosts of it."""
    lamp = scenes.quad((0.3, 0.4, -2), 0.05, emission=1e5)
    scene = scenes.scene_of(scenes.quad((0, 0, -3), 3, diffuse=0.6), lamp).with_environment(50.0)
    lens = rc.Lens.load("double-gauss-50mm").focused(3.0).with_coating("bare")
    camera = rc.Camera(lens, film=rc.Film(36, 24, (60, 40)), exposure_time_s=0.01)
    settings = {"spp": spp, "seed": 3, "max_bounces": 2, "effects": ("ghosts",), "layers": ("normal", "variance")}
    return rc.Shot(scene, camera, rc.RenderSettings(**{**settings, **more}))


def picture(of: rc.Shot) -> rc.Image:
    """Renders the shot in a single process, as the reference for jobs."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "the noise is")  # of 600 samples, which are few for a test's sake
        return rc.render(of.scene, of.camera, of.settings, device="cpu")


def started(*words: str | Path, **more: object) -> subprocess.Popen[str]:
    """`realcam job ...` as a process of its own."""
    program = [sys.executable, "-m", "realcam", "job", *map(str, words)]
    environment = {**os.environ, "PYTHONPATH": str(Path(rc.__file__).parents[1])}
    return subprocess.Popen(program, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **more)  # type: ignore[call-overload]


def run(*words: str | Path, **more: object) -> tuple[int, str, str]:
    """Exit code, output and errors of `realcam job ...`."""
    process = started(*words, **more)
    output, errors = process.communicate(timeout=120)
    return process.returncode, output, errors


def units(folder: Path) -> dict[str, tuple[int, int]]:
    """The units that are done: which file each is, and when it was written."""
    found = {}
    for path in (folder / "units").glob("*/*.npz"):
        stat = path.stat()
        found[path.name] = (stat.st_ino, stat.st_mtime_ns)
    return found
