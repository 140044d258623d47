"""Finds pose, focus and f-number of a camera from a picture of a known scene.

    python examples/camera_from_picture.py [--starts 20]

The picture is rendered and exposed on a sensor with shot and read noise. Each start is 5 cm, 5 degrees, half a metre of
focus and one stop away from the camera, in random directions. rc.fit_pictures finds the camera from means of 8 x 8
pixels first and from single pixels last. Prints the root mean square error in units of the Cramer-Rao bound, which no
unbiased method can beat, for each start and for each parameter.
"""

from __future__ import annotations

import argparse

import numpy as np
import realcam as rc

PARAMETERS = ["right_m", "up_m", "backward_m", "pitch_deg", "yaw_deg", "roll_deg", "focus_distance_m", "f_number"]
SCALE = np.array([0.05, 0.05, 0.05, 2, 2, 5, 0.3, 0.5])
BOUNDS = [-1.0] * 3 + [-30.0] * 3 + [1.0, 2.2], [1.0] * 3 + [30.0] * 3 + [20.0, 16.0]
FOCUS_M, F_NUMBER = 2.5, 4.0
# Samples per pixel of pictures and of each estimate of their derivatives, by the size of the blocks.
SPP = {8: (8, 8), 4: (16, 8), 2: (64, 16), 1: (256, 32)}
READ_NOISE_E = 3.0


def squares() -> rc.Scene:
    """Shining squares of random colours, 1.3 to 6 m from the camera; the far ones are larger."""
    random = np.random.default_rng(11)
    vertices, materials = [], []
    for distance, count, half in ((6, 100, 0.035), (3, 50, 0.022), (1.5, 22, 0.014)):
        for _ in range(count):
            x, y, z = distance * random.uniform((-0.42, -0.32, -1.1), (0.42, 0.32, -0.9))
            side = half * distance * random.uniform(0.5, 2)
            vertices += [(x + side * u, y + side * v, z) for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
            materials.append(rc.Material(emission=tuple(random.uniform(0.1, 2, 3))))
    vertices += [(100 * u, 100 * v, -20) for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    materials.append(rc.Material(emission=(0.3, 0.4, 0.6)))
    faces = [(4 * i + a, 4 * i + b, 4 * i + c) for i in range(len(materials)) for a, b, c in ((0, 1, 2), (0, 2, 3))]
    owners = np.repeat(np.arange(len(materials)), 2)
    return rc.Scene.from_arrays(vertices, faces, triangle_materials=owners, materials=materials)


class Problem:
    """A picture of a known scene by a camera that is to be found.

    electrons: from the three channels in lux seconds to electrons of a pixel behind each filter, (3, 3).
    """

    def __init__(self) -> None:
        self.scene = squares()
        lens = rc.Lens.load("double-gauss-50mm").focused(FOCUS_M).stopped_down(F_NUMBER)
        camera = rc.Camera(lens, film=rc.Film(24, 16, (48, 32)), exposure_time_s=1)
        self.family = rc.CameraParameters(camera, PARAMETERS)
        self.truth = self.family.values
        # The exposure gives 2000 electrons per pixel and filter on average.
        sensor = rc.Sensor.load("sony-imx071-color").electrons_per_um2()
        mean = (self.family.render(self.scene, self.truth, spp=16, max_bounces=0) @ sensor.T).mean()
        self.electrons = sensor * (2000 / mean)
        self.exact = self.pictures(self.truth, 1, seed=77, spp=1024)

    def pictures(self, values: np.ndarray, block: int, seed: int = 5, spp: int = 0) -> np.ndarray:
        """(1, H, W, 3), electrons. spp: 0: SPP."""
        samples = spp or SPP[block][0]
        return self.family.render(self.scene, values, seed=seed, spp=samples, max_bounces=0)[None] @ self.electrons.T

    def derivatives(self, values: np.ndarray, block: int, seed: int, spp: int = 0) -> np.ndarray:
        """(P, 1, H, W, 3)"""
        samples = spp or SPP[block][1]
        found = self.family.gradient(
            self.scene,
            values,
            seed=1000 + seed,
            spp=samples,
            outline_spp=samples // 4,  # derivatives by positions and the f-number come mostly from the outline
            max_bounces=0,
        )
        return found[:, None] @ self.electrons.T

    def information(self, spp: int = 256) -> np.ndarray:
        """(P, P): Fisher information of the picture. The product of two independent estimates of the derivatives has no
        bias by their noise."""
        noise = np.sqrt(self.exact + READ_NOISE_E**2)
        first, second = (
            (self.derivatives(self.truth, 1, seed, spp) / noise).reshape(len(PARAMETERS), -1).astype(float)
            for seed in (101, 102)
        )
        return (first @ second.T + second @ first.T) / 2

    def start(self, random: np.random.Generator) -> np.ndarray:
        """A camera 5 cm, 5 degrees, half a metre of focus and a stop away."""
        position, axis = (v / np.linalg.norm(v) for v in random.normal(size=(2, 3)))
        signs = random.choice([-1, 1], 2)
        return np.array([*0.05 * position, *5 * axis, FOCUS_M + 0.5 * signs[0], F_NUMBER * 2 ** (0.5 * signs[1])])

    def fit(self, random: np.random.Generator) -> rc.PictureFit:
        start = self.start(random)
        observed = random.poisson(self.exact) + random.normal(0, READ_NOISE_E, self.exact.shape)
        variance = np.maximum(observed, 0) + READ_NOISE_E**2
        return rc.fit_pictures(self.pictures, self.derivatives, observed, variance, start, SCALE, bounds=BOUNDS)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--starts", type=int, default=20)
    parser.add_argument("--first", type=int, default=0, help="Number of the first start, from 0")
    arguments = parser.parse_args()
    problem = Problem()
    information = problem.information()
    bound = np.sqrt(np.diag(np.linalg.inv(information)))
    errors = []
    for number in range(arguments.first, arguments.first + arguments.starts):
        random = np.random.default_rng(number)
        fit = problem.fit(random)
        error = fit.values - problem.truth
        errors.append(error)
        ratio = np.sqrt(error @ information @ error / len(error))
        worst = np.abs(error / bound).max()
        print(
            f"start {number}: error / bound {ratio:.2f}, worst {worst:.2f}; chi^2 {fit.chi_square:.2f}, "
            f"remaining step {fit.remaining_step:.1f}",
            flush=True,
        )
    spread = np.sqrt(np.mean(np.square(errors), 0))
    for name, one_bound, one_error in zip(PARAMETERS, bound, spread, strict=True):
        print(
            f"{name}: bound {one_bound:.2g}, root mean square error {one_error:.2g}, ratio {one_error / one_bound:.2f}"
        )


if __name__ == "__main__":
    main()
