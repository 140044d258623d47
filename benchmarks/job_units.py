"""Overhead of dividing pictures among processes: a job of many small units against one session, in the same run.

    python benchmarks/job_units.py [--units 10000] [--folder FOLDER]

Units have 32 x 32 pixels and 16 samples, so that the overhead of a unit becomes visible: writing its file, and
accumulation at the end. Both pictures are rendered by one thread and compared bit by bit. Units of the default size,
16384 pixels and 256 samples, are measured as well, on a picture of 24 units.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path

import numpy as np
import realcam as rc
from machine import machine


def wall_shot(width: int, height: int, spp: int) -> rc.Shot:
    """A shot of a wall, whose samples are cheap, so that the overhead of a unit becomes visible."""
    corners = [(-3, -3, -3), (3, -3, -3), (3, 3, -3), (-3, 3, -3)]
    wall = rc.Scene.from_arrays(corners, [(0, 1, 2), (0, 2, 3)]).with_environment(50)
    film = rc.Film(24, 24 * height / width, (width, height))
    camera = rc.Camera(rc.Lens.load("tessar-50mm").focused(3), film=film, exposure_time_s=0.01)
    return rc.Shot(wall, camera, rc.RenderSettings(spp=spp, effects=(), threads=1))


def seconds_of(shot: rc.Shot, tile: tuple[int, int] | None, folder: Path) -> tuple[int, list[float], list[float]]:
    """Returns the number of units, and the CPU and the wall seconds of one session, of the job's work, and of the
    accumulation. folder: of the job, which is created."""
    job = rc.Job.make(folder, {"picture": shot}, device="cpu", tile=tile)
    clocks = (time.process_time, time.perf_counter)
    times = [[clock() for clock in clocks]]
    whole = rc.render(shot.scene, shot.camera, shot.settings, device="cpu")
    times.append([clock() for clock in clocks])
    job.work(threads=1)
    times.append([clock() for clock in clocks])
    image = job.image()
    times.append([clock() for clock in clocks])
    assert np.array_equal(image.pixels, whole.pixels)
    cpu, wall = np.diff(times, axis=0).T.tolist()
    return job.status().units_done, cpu, wall


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--units", type=int, default=10000)
    parser.add_argument(
        "--folder", type=Path, help="folder in which the job is created [the system's temporary folder]"
    )
    arguments = parser.parse_args()
    side = 32 * round(arguments.units**0.5)
    where = machine()
    print(f"{where['processor']}, one thread; realcam {where['commit']}; {where['date']}.", end=" ")
    print("Made by benchmarks/job_units.py.\n")
    print("| units | of | session, CPU s | work, CPU s | adding up, CPU s | beside samples, CPU ms a unit | wall ms |")
    print("|---|---|---|---|---|---|---|")
    for shot, tile in ((wall_shot(side, side, 16), (32, 32)), (wall_shot(768, 512, 256), None)):
        with tempfile.TemporaryDirectory(dir=arguments.folder) as folder:
            units, cpu, wall = seconds_of(shot, tile, Path(folder) / "job")
        overhead_ms = [1e3 * (work + adding - session) / units for session, work, adding in (cpu, wall)]
        name = "32 x 32 x 16" if tile else "128 x 128 x 256"
        print(
            f"| {units} | {name} | {cpu[0]:.1f} | {cpu[1]:.1f} | {cpu[2]:.1f} "
            f"| {overhead_ms[0]:.2f} | {overhead_ms[1]:.2f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
