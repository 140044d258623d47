"""realcam and Mitsuba 3 on the CPU: time for the same work, and error over time, in one run.

    DRJIT_LIBLLVM_PATH=/usr/lib/x86_64-linux-gnu/libLLVM-19.so python benchmarks/against_mitsuba_cpu.py [--threads 2]

Needs the extra `bench`, and LLVM for Mitsuba: 19 is Debian's newest (apt-get install libllvm19). The scene is that of
`realcam bench frame`: the same triangles, emitter and sky, 640 x 640 pixels, direct light.

Same work: 20 samples per pixel of a camera ray and two shadow rays, in realcam to the lamp and to the sky, in Mitsuba
by the integrator "direct" with two emitter samples and no BSDF sample, in one kernel for the whole picture that is
compiled before. The programs alternate, so that other load of the machine affects both, and the smallest time of four
rounds counts. The run stops if the pictures differ.

Error over time: relative mean square error of pictures at increasing sample counts against one of many more samples,
through a thin lens and through the double Gauss; Mitsuba uses the integrators and samplers with the smallest errors.

Writes PROCESSOR-N-threads-against-mitsuba.json, .md and .png into benchmarks/results, or the folder of --output.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import drjit as dr
import mitsuba as mi
import numpy as np
import realcam as rc
from frame_scene import frame_camera, frame_scene
from machine import Result, machine

mi.set_variant("llvm_ad_rgb")

from cpu_report import write_report  # noqa: E402
from mitsuba_lens import load_lens_sensor  # noqa: E402
from mitsuba_scene import frame_scene as mitsuba_frame_scene  # noqa: E402
from mitsuba_scene import sensor  # noqa: E402

SKY, SPHERES, BOXES = 100.0, 50, 50
SPP, ROUNDS = 20, 4
ERROR_ROUNDS = 3
# Mitsuba's sensors by realcam's camera models.
KINDS = {"pinhole": "perspective", "thin": "thinlens"}
TWO_EMITTER_SAMPLES = {"type": "direct", "emitter_samples": 2, "bsdf_samples": 0}
# Each integrator with the sampler that had the least error with it, of all that Mitsuba has.
BEST = {
    "path, emitter and BSDF sample": ({"type": "path", "max_depth": 2}, "multijitter"),
    "direct, emitter and BSDF sample": ({"type": "direct"}, "multijitter"),
    "direct, two emitter samples": (TWO_EMITTER_SAMPLES, "ldsampler"),
}


@dataclass(frozen=True)
class Program:
    """A program that renders a picture. render: called with samples per pixel and seed, returns (H, W), lux."""

    render: Callable[[int, int], np.ndarray]

    def timed(self, spp: int, seed: int) -> tuple[np.ndarray, float, float]:
        """The picture, its CPU seconds on all threads, and its wall seconds."""
        cpu, wall = time.process_time(), time.perf_counter()
        picture = self.render(spp, seed)
        return picture, time.process_time() - cpu, time.perf_counter() - wall


def realcam_program(scene: rc.Scene, camera: rc.Camera, threads: int) -> Program:
    """Direct light by realcam."""

    def render(spp: int, seed: int) -> np.ndarray:
        image = rc.render(scene, camera, effects=(), spp=spp, seed=seed, max_bounces=0, device="cpu", threads=threads)
        return image.pixels.mean(axis=2) / camera.exposure_time_s

    return Program(render)


def mitsuba_program(
    scene: mi.Scene,
    load_sensor: Callable[[int], mi.Sensor],
    integrator: dict[str, object],
    irradiance_of_unit_radiance: np.ndarray | float,
) -> Program:
    """A picture by Mitsuba. load_sensor: called with the number of samples, which stratified samplers need.

    irradiance_of_unit_radiance: factor from Mitsuba's radiance to illuminance, for each pixel or all.
    """
    loaded = mi.load_dict(integrator)
    sensors: dict[int, mi.Sensor] = {}

    def render(spp: int, seed: int) -> np.ndarray:
        if spp not in sensors:
            sensors[spp] = load_sensor(spp)
        image = mi.render(scene, sensor=sensors[spp], integrator=loaded, spp=spp, seed=seed)
        return np.array(image).mean(axis=2) * irradiance_of_unit_radiance

    return Program(render)


def irradiance_of_unit_radiance(camera: rc.Camera) -> np.ndarray:
    """(H, W): mean weight of an ideal camera's rays, which converts the radiance of Mitsuba's cameras to
    illuminance."""
    width, height = camera.film.resolution
    spp = 4
    rays = camera.generate_rays(spp=spp)
    return (np.bincount(rays.pixels, rays.weights, width * height) / spp).reshape(height, width)


def same_work(scene: rc.Scene, peer: mi.Scene, threads: int) -> Result:
    """Times of both programs by camera model, and the differences of their pictures. peer: Mitsuba's scene."""
    programs: dict[tuple[str, str], Program] = {}
    for model, kind in KINDS.items():
        camera = frame_camera(model)
        settings = sensor(kind, camera)
        programs["realcam", model] = realcam_program(scene, camera, threads)
        programs["mitsuba", model] = mitsuba_program(
            peer,
            lambda spp, settings=settings: mi.load_dict(settings),
            TWO_EMITTER_SAMPLES,
            irradiance_of_unit_radiance(camera),
        )
    full = frame_camera("full")
    programs["realcam", "full"] = realcam_program(scene, full, threads)
    programs["mitsuba", "full"] = mitsuba_program(peer, lambda spp: load_lens_sensor(full), TWO_EMITTER_SAMPLES, 1.0)

    cpu: dict[tuple[str, str], list[float]] = {}
    wall: dict[tuple[str, str], list[float]] = {}
    sums: dict[tuple[str, str], np.ndarray] = {}
    for seed in range(ROUNDS + 1):
        for name, program in programs.items():
            picture, cpu_seconds, wall_seconds = program.timed(SPP, seed)
            if seed == 0:  # builds hierarchies and compiles kernels
                continue
            cpu.setdefault(name, []).append(cpu_seconds)
            wall.setdefault(name, []).append(wall_seconds)
            sums[name] = sums.get(name, 0) + picture / ROUNDS
    return {
        model: {
            f"{program}_{clock}_seconds": round(min(times[program, model]), 3)
            for clock, times in (("cpu", cpu), ("wall", wall))
            for program in ("realcam", "mitsuba")
        }
        | agreement(sums["realcam", model], sums["mitsuba", model])
        for model in (*KINDS, "full")
    }


def agreement(ours: np.ndarray, theirs: np.ndarray) -> Result:
    """Relative differences of two pictures. Stops the run if they exceed the noise.

    At 20 samples the noise of a pixel is a third, in places a half for Mitsuba; that of the mean of four pictures is
    below 1% over 40 x 40 pixels, and below 0.1% over the whole picture.
    """

    def in_blocks(picture: np.ndarray) -> np.ndarray:
        height, width = picture.shape
        return picture.reshape(height // 40, 40, width // 40, 40).mean(axis=(1, 3))

    mean = ours.mean() / theirs.mean() - 1
    blocks = float(np.sqrt(np.mean((in_blocks(ours) / in_blocks(theirs) - 1) ** 2)))
    if not (abs(mean) < 0.003 and blocks < 0.02):
        raise SystemExit(
            f"the programs do not the same work: their means differ by {mean:.2%}, blocks of pixels by {blocks:.2%}"
        )
    return {"difference_of_means": round(float(mean), 5), "difference_of_blocks_rms": round(blocks, 5)}


def relative_mse(picture: np.ndarray, reference: np.ndarray, scale: np.ndarray) -> float:
    """Mean of the squared differences over `scale`, (H, W)."""
    return float(np.mean((picture - reference) ** 2 / scale))


def best_programs(peer: mi.Scene, camera: rc.Camera) -> dict[str, Program]:
    """Mitsuba with each integrator of BEST, through its thin lens, or the double Gauss as a sensor in Python."""
    is_full = camera.model == "full"

    def sensor_for(sampler: str) -> Callable[[int], mi.Sensor]:
        if is_full:
            return lambda spp: load_lens_sensor(camera, sampler, spp)
        return lambda spp: mi.load_dict(sensor("thinlens", camera, sampler, spp))

    falloff = 1.0 if is_full else irradiance_of_unit_radiance(camera)
    return {
        f"Mitsuba: {name}": mitsuba_program(peer, sensor_for(sampler), integrator, falloff)
        for name, (integrator, sampler) in BEST.items()
    }


def error_over_time(
    scene: rc.Scene, peer: mi.Scene, model: str, threads: int, counts: list[int], reference_spp: int
) -> Result:
    """Errors of all programs at these numbers of samples per pixel."""
    camera = frame_camera(model)
    programs = {"realcam": realcam_program(scene, camera, threads)} | best_programs(peer, camera)
    # A seed that no measured picture has.
    reference = programs["realcam"].render(reference_spp, 1000)
    # In black pixels, differences are relative to a hundredth of the mean.
    scale = reference**2 + (0.01 * reference.mean()) ** 2
    return {
        "reference_spp": reference_spp,
        "programs": {
            name: [error_at(program, spp, reference, scale) for spp in counts] for name, program in programs.items()
        },
    }


def error_at(program: Program, spp: int, reference: np.ndarray, scale: np.ndarray) -> Result:
    """Relative mean square error against the reference, relative variance of pictures with different seeds, and times.

    Error and variance are equal if the program's pictures converge to the reference.
    """
    rounds = [program.timed(spp, seed) for seed in range(1, ERROR_ROUNDS + 1)]  # the first may compile
    pictures = [picture for picture, _, _ in rounds]
    return {
        "spp": spp,
        "cpu_seconds": round(min(cpu for _, cpu, _ in rounds), 3),
        "wall_seconds": round(min(wall for _, _, wall in rounds), 3),
        "relative_mse": float(f"{np.mean([relative_mse(p, reference, scale) for p in pictures]):.4g}"),
        "relative_variance": float(f"{np.mean(np.var(pictures, axis=0, ddof=1) / scale):.4g}"),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--output", type=Path, default=Path(__file__).parent / "results")
    parser.add_argument("--quick", action="store_true", help="few samples, to test the program")
    arguments = parser.parse_args()
    dr.set_thread_count(arguments.threads)
    scene = frame_scene(SPHERES, BOXES, sky=SKY)
    peer = mitsuba_frame_scene(SPHERES, BOXES, sky=SKY)
    counts, reference_spp = ([1, 4], 64) if arguments.quick else ([4, 16, 64, 256], 4096)
    record = {
        "machine": machine(),
        "threads": arguments.threads,
        "mitsuba": f"{mi.__version__}, {mi.variant()}, LLVM {'.'.join(map(str, dr.detail.llvm_version()))}",
        "triangles": scene.triangle_count,
        "spp": SPP,
        "same_work": same_work(scene, peer, arguments.threads),
        "error_over_time": {
            model: error_over_time(scene, peer, model, arguments.threads, counts, reference_spp)
            for model in ("thin", "full")
        },
    }
    write_report(record, arguments.output)


if __name__ == "__main__":
    main()
