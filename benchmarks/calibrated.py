"""Cost of a calibrated camera: render time over that of the same lens with its own geometry, in one run.

    python benchmarks/calibrated.py [--device cpu] [--threads 1] [--rounds 9] [--spp 64]

640 x 480 pixels of the demo's scene, without effects and with one bounce, and the camera's rays alone.
Each calibration is a model fitted to the lens, so that both cameras see the same. They alternate, so that other load of
the machine affects both; the table gives the median ratio and the range of its middle half. On a CPU, times are
processor times. The preparation is that of both cameras, for a picture of 8 x 6 pixels: after a change of focus without
effects, and after a change of the pose with the planner's effects.
"""

from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Callable, Sequence
from functools import partial
from typing import TypeVar

import numpy as np
import realcam as rc
from machine import machine

# A lens of spheres, one with aspheres, and a fisheye, each with a film that it fills: width in mm.
LENSES = {"double-gauss-50mm": 36.0, "phone-4mm": 4.4, "fisheye-6mm-220deg": 12.0}
SIZE = (640, 480)
RAYS_PER_PIXEL = 8

T = TypeVar("T")


def cameras(name: str, width_mm: float, shot: rc.Shot) -> tuple[rc.Camera, rc.Camera]:
    """Returns the camera of the demo with a lens, and the same with the geometry of a calibration."""
    film_mm = (width_mm, width_mm * SIZE[1] / SIZE[0])
    lens = rc.Lens.load(name).focused(shot.camera.lens.focus_distance_m)
    fitted = lens.calibration(film_mm=film_mm, resolution=SIZE)
    pose = {"position": shot.camera.position, "look_at": shot.camera.look_at, "up": shot.camera.up}
    calibrated = fitted.camera(lens, film_width_mm=width_mm, exposure_time_s=0.01, **pose)
    return rc.Camera(lens, film=calibrated.film, exposure_time_s=0.01, **pose), calibrated


def seconds(work: Callable[[T], object], subject: T, clock: Callable[[], float]) -> float:
    """Returns the time of a work on a subject."""
    start = clock()
    work(subject)
    return clock() - start


def take_first(session: rc.Session, camera: rc.Camera) -> None:
    """Takes the first sample of a camera."""
    session.set(camera=camera)
    session.add(1)


def preparation_ms(
    scene: rc.Scene,
    pair: Sequence[rc.Camera],
    settings: rc.RenderSettings,
    rounds: int,
    device: str,
    clock: Callable[[], float],
) -> str:
    """Returns the median times of the first samples of both cameras, after a change of focus or, if the effects are
    planned, of the pose, as text."""
    medians = []
    for camera in pair:
        film = camera.film
        small = camera.replace(film=rc.Film(film.width_mm, film.height_mm, (8, 6), film.shift_mm))
        session = rc.Session(scene, small, settings, device=device)
        take_first(session, small)
        x, y, z = camera.position
        if settings.effects == ():
            changed = [small.replace(lens=camera.lens.focused(2 + 0.1 * k)) for k in range(rounds)]
        else:
            changed = [small.replace(position=(x + 0.01 * k, y, z)) for k in range(1, rounds + 1)]
        medians.append(np.median([seconds(partial(take_first, session), view, clock) for view in changed]))
    return ", ".join(f"{1000 * median:.1f}" for median in medians)


def ratio(work: Callable[[T], object], pair: Sequence[T], rounds: int, clock: Callable[[], float]) -> str:
    """Returns the median of the time for the second subject over that for the first, and the range of its middle half,
    as text."""
    for subject in pair:
        work(subject)
    found = []
    for _ in range(rounds):
        first, second = (seconds(work, subject, clock) for subject in pair)
        found.append(second / first)
    low, median, high = np.quantile(found, (0.25, 0.5, 0.75))
    return f"{median:.3f} ({low:.3f} to {high:.3f})"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--threads", type=int, default=1, help="number of threads on the CPU")
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--spp", type=int, default=64)
    arguments = parser.parse_args()
    warnings.simplefilter("ignore", UserWarning)
    clock = time.process_time if arguments.device == "cpu" else time.perf_counter
    shot = rc.Shot.load("demo", device=arguments.device)
    settings = rc.RenderSettings(spp=arguments.spp, max_bounces=1, effects=(), threads=arguments.threads)
    print(machine())
    print("| lens | picture | rays alone | new focus, ms | new pose, planned, ms |\n|---|---|---|---|---|")
    planned = rc.RenderSettings(spp=1, threads=arguments.threads)
    for name, width_mm in LENSES.items():
        pair = cameras(name, width_mm, shot)
        sessions = [rc.Session(shot.scene, camera, settings, device=arguments.device) for camera in pair]
        picture = ratio(lambda session: session.add(arguments.spp), sessions, arguments.rounds, clock)
        rays = ratio(
            lambda camera: camera.generate_rays(spp=RAYS_PER_PIXEL, device=arguments.device),
            pair,
            arguments.rounds,
            clock,
        )
        focus, pose = (
            preparation_ms(shot.scene, pair, each, arguments.rounds, arguments.device, clock)
            for each in (settings, planned)
        )
        print(f"| {name} | {picture} | {rays} | {focus} | {pose} |", flush=True)


if __name__ == "__main__":
    main()
