"""Cost of effects: render time of the frame benchmark's picture with each effect over that without effects, in one run.

    python benchmarks/effects.py [--device cpu] [--threads 1]

640 x 640 pixels, direct light, 20 samples (CPU) or 400 (GPU), through all surfaces of two lenses. The effects
alternate, so that other load of the machine affects all, and the smallest time of the rounds counts. The scene has an
additional point light in the field of view, for ghosts.
"""

from __future__ import annotations

import argparse
import time
import warnings

import realcam as rc
from frame_scene import frame_camera, frame_scene
from machine import machine

NAMES = tuple(effect.name for effect in rc.effects() if not effect.is_on)
# Measured sets of effects: none, each alone, and all.
EFFECTS: list[tuple[str, ...]] = [(), *((name,) for name in NAMES), NAMES]
LENSES = ("double-gauss-50mm", "phone-4mm")
ROUNDS = 5


def seconds_of(session: rc.Session, spp: int) -> float:
    """Time to add samples to a session."""
    start = time.perf_counter()
    session.add(spp)
    return time.perf_counter() - start


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--threads", type=int, default=1, help="number of threads on the CPU")
    arguments = parser.parse_args()
    warnings.simplefilter("ignore", UserWarning)
    spp = 20 if arguments.device == "cpu" else 400
    threads = arguments.threads if arguments.device == "cpu" else 0
    scene = frame_scene().with_point_light((1.0, 2.0, -6.0), (100, 100, 100))
    where = machine()
    print(f"{where['processor']}, {arguments.device}; realcam {where['commit']}; {where['date']}.", end=" ")
    print("Made by benchmarks/effects.py.\n")
    print("| lens | effects | s | over none |")
    print("|---|---|---|---|")
    for name in LENSES:
        lens = rc.Lens.load(name).with_coating("quarter_wave").focused(5.0)
        side = min(24.0, *lens.film_mm)
        film = rc.Film(side, side, (640, 640))
        camera = frame_camera().replace(lens=lens, film=film)
        sessions = {
            effects: rc.Session(scene, camera, device=arguments.device, threads=threads, effects=effects)
            for effects in EFFECTS
        }
        for session in sessions.values():
            session.add(1)
        shortest = {
            effects: min(times)
            for effects, times in zip(
                EFFECTS,
                zip(*([seconds_of(sessions[e], spp) for e in EFFECTS] for _ in range(ROUNDS)), strict=True),
                strict=True,
            )
        }
        for effects, seconds in shortest.items():
            print(
                f"| {name} | {', '.join(effects) or 'none'} | {seconds:.3f} | {seconds / shortest[()]:.2f} |",
                flush=True,
            )


if __name__ == "__main__":
    main()
