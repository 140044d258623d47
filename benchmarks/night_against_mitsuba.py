"""Lamps out of focus at night: realcam and Mitsuba 3 on the CPU, error over time through the same lens, in one run.

    DRJIT_LIBLLVM_PATH=/usr/lib/x86_64-linux-gnu/libLLVM-19.so python benchmarks/night_against_mitsuba.py [--threads 2]

Both programs render the same triangles, lamps and sky with direct light. Mitsuba uses its integrator "path" with the
sampler "multijitter", and the double Gauss as a sensor in Python (mitsuba_lens.py). The reference is the mean of
Mitsuba's and realcam's pictures with many samples, so that it favours neither program.

Prints, for each scene, relative mean square errors over CPU seconds, and the seconds to an error of 0.01, interpolated
by a power law between the neighbouring sample counts.
"""

from __future__ import annotations

import argparse
import itertools
import json
from collections.abc import Callable
from dataclasses import dataclass

import drjit as dr
import mitsuba as mi
import numpy as np
import realcam as rc
from against_mitsuba_cpu import Program, error_at, mitsuba_program
from demo_triangles import DEMO, demo_triangles
from frame_scene import _quad, _sphere
from machine import Result, machine
from mitsuba_lens import load_lens_sensor
from mitsuba_scene import TWO_SIDED, mesh

FILM = rc.Film(36, 24, (240, 160))
GOAL = 0.01  # relative mean square error
PATH = {"type": "path", "max_depth": 2}  # visible emitters and direct light

Mesh = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class Night:
    """A scene of diffuse objects and lamps, with a camera; lengths in metres."""

    objects: list[Mesh]
    lamps: dict[float, list[Mesh]]  # by radiance, cd/m^2
    sky: float  # radiance of the environment, cd/m^2
    focus_m: float  # focus distance
    position: tuple[float, float, float] = (0, 0, 0)
    look_at: tuple[float, float, float] = (0, 0, -1)


def _joined(meshes: list[Mesh]) -> Mesh:
    """All meshes as one."""
    firsts = np.cumsum([0, *(len(points) for points, _ in meshes)])
    return (
        np.concatenate([points for points, _ in meshes]),
        np.concatenate([faces + first for (_, faces), first in zip(meshes, firsts, strict=False)]),
    )


def _ground(height: float) -> Mesh:
    return _quad([(-50, height, 20), (50, height, 20), (50, height, -80), (-50, height, -80)])


def garlands() -> Night:
    """Small lamps at 2.5 to 10 m behind a table at 1 m."""
    random = np.random.default_rng(3)
    table = _quad([(-0.6, -0.15, -0.7), (0.6, -0.15, -0.7), (0.6, -0.15, -1.4), (-0.6, -0.15, -1.4)])
    balls = [_sphere((x, -0.1, -1.0), 0.05, 32, 16) for x in (-0.2, 0.0, 0.2)]
    lamps = []
    for _ in range(40):
        z = random.uniform(-10, -2.5)
        lamps.append(_sphere((random.uniform(-0.3, 0.3) * -z, random.uniform(-0.02, 0.2) * -z, z), 0.008, 8, 4))
    return Night([table, *balls, _ground(-1)], {3e4: lamps}, 1.0, 1.0)


def street() -> Night:
    """Street lamps at 8 to 60 m behind a ball in focus at 1.5 m."""
    lamps = [_sphere((side * 3.5, 2.5, -z), 0.08, 12, 6) for side in (-1, 1) for z in np.linspace(8, 60, 10)]
    walls = [_quad([(x, -6, 0), (x, 6, 0), (x, 6, -70), (x, -6, -70)]) for x in (-5, 5)]
    return Night([_ground(-1.5), _sphere((0.1, -0.1, -1.5), 0.15, 32, 16), *walls], {2e4: lamps}, 0.2, 1.5)


def before_the_focus() -> Night:
    """Lamps at 0.5 to 0.8 m in front of the plane in focus at 4 m."""
    lamps = [_sphere((0.02 * x, 0.05 * np.sin(x), -0.5 - 0.03 * abs(x)), 0.001, 8, 4) for x in range(-8, 9)]
    return Night([_ground(-0.5), *(_sphere((x, 0, -4), 0.4, 32, 16) for x in (-1, 0, 1))], {1e5: lamps}, 5.0, 4.0)


def demo() -> Night:
    """The demo shot with grey diffuse materials; lamps and sky have the mean radiance of their channels."""
    objects: list[Mesh] = []
    lamps: dict[float, list[Mesh]] = {}
    for part, radiance in demo_triangles():
        (lamps.setdefault(radiance, []) if radiance > 0 else objects).append(part)
    camera = rc.Shot.load(DEMO.with_suffix(".toml")).camera
    return Night(objects, lamps, 31.3, camera.lens.focus_distance_m, camera.position, camera.look_at)


SCENES: dict[str, Callable[[], Night]] = {
    "demo": demo,
    "garlands": garlands,
    "street": street,
    "before the focus": before_the_focus,
}


def programs_of(night: Night, threads: int) -> dict[str, Program]:
    """realcam with and without light tracing, and Mitsuba, by name."""
    parts = {0.0: _joined(night.objects)} | {radiance: _joined(lamps) for radiance, lamps in night.lamps.items()}
    scene = rc.Scene.from_arrays(
        *_joined(list(parts.values())),
        triangle_materials=np.repeat(range(len(parts)), [len(faces) for _, faces in parts.values()]),
        materials=[rc.Material(emission=3 * (radiance,)) for radiance in parts],
    ).with_environment(night.sky)
    meshes = {
        f"part{i}": mesh(f"part{i}", *part, radiance, TWO_SIDED) for i, (radiance, part) in enumerate(parts.items())
    }
    sky = {"type": "constant", "radiance": {"type": "rgb", "value": night.sky}}
    peer = mi.load_dict({"type": "scene", "sky": sky} | meshes)
    lens = rc.Lens.load("double-gauss-50mm").focused(night.focus_m)
    camera = rc.Camera(lens, film=FILM, position=night.position, look_at=night.look_at, exposure_time_s=1)

    def ours(tracing: str) -> Program:
        def render(spp: int, seed: int) -> np.ndarray:
            image = rc.render(scene, camera, effects=(), spp=spp, seed=seed, max_bounces=0, device="cpu",
                              threads=threads, light_tracing=tracing)  # fmt: skip
            return image.pixels.mean(axis=2)

        return Program(render)

    theirs = mitsuba_program(peer, lambda spp: load_lens_sensor(camera, "multijitter", spp), PATH, 1.0)
    return {"realcam": ours("weighted"), "realcam, samples of pixels alone": ours("off"), "mitsuba": theirs}


def seconds_to(goal: float, rows: list[Result]) -> float:
    """CPU seconds to a relative mean square error, by the power law through the neighbouring sample counts."""
    log = [(np.log(row["cpu_seconds"]), np.log(row["relative_mse"])) for row in rows]
    for (t0, e0), (t1, e1) in itertools.pairwise(log):
        if e1 <= np.log(goal) or (t1, e1) == log[-1]:
            return float(np.exp(t0 + (np.log(goal) - e0) * (t1 - t0) / (e1 - e0)))
    raise ValueError("at least two sample counts are required")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--reference-spp", type=int, default=16384)
    arguments = parser.parse_args()
    dr.set_thread_count(arguments.threads)
    record: Result = {"machine": machine(), "threads": arguments.threads, "mitsuba": mi.__version__, "scenes": {}}
    passes = max(1, arguments.reference_spp // 1024)  # of 1024 samples, to limit Mitsuba's memory
    for scene_name, make in SCENES.items():
        programs = programs_of(make(), arguments.threads)
        ours = programs["realcam"].render(arguments.reference_spp, 1000)
        theirs = np.mean([programs["mitsuba"].render(1024, 1000 + k) for k in range(passes)], 0)
        reference = 0.5 * (ours + theirs)
        scale = reference**2 + (0.01 * reference.mean()) ** 2
        counts = {"realcam": [4, 16, 64], "realcam, samples of pixels alone": [64, 256], "mitsuba": [64, 256, 1024]}
        rows = {
            name: [error_at(program, spp, reference, scale) for spp in counts[name]]
            for name, program in programs.items()
        }
        record["scenes"][scene_name] = {
            "difference_of_means": float(f"{ours.mean() / theirs.mean() - 1:.3g}"),
            "cpu_seconds_to_0.01": {who: float(f"{seconds_to(GOAL, points):.3g}") for who, points in rows.items()},
            "programs": rows,
        }
    print(json.dumps(record, indent=1))


if __name__ == "__main__":
    main()
