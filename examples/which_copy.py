"""Finds the spacings, tilts and decentres of a manufactured copy of a lens from pictures of a chart.

    python examples/which_copy.py [--copies 4] [--grade precision]

Copies of a lens are drawn from a tolerance class. Each photographs a chart, in the centre of the film and in two of
its corners, at three settings of the focusing ring, with shot noise. rc.fit_pictures finds its errors by Gauss-Newton
steps, with the class as prior. Prints the directions that the pictures determine worst, and how well pictures at
another focus and f-number, which were not used, are predicted: beside the nominal lens, in units of the noise. The last
lines are a table of all copies.
"""

from __future__ import annotations

import argparse
import math

import numpy as np
import realcam as rc
from realcam.tolerance.elements import elements_of

PIXELS, SIDE_MM = 8, 0.24
FOCUS_M, HELD_OUT_M, F_NUMBER, HELD_OUT_F_NUMBER = (1.92, 2.0, 2.08), 1.96, 2.8, 2.4
CHART_M = 2.0
PLACES_MM = ((0, 0), (12, 8), (-12, -8))
SPP = {4: (128, 64), 2: (256, 128), 1: (512, 128)}
ELECTRONS = 2000  # of a pixel on average
LIMIT_DEG = 0.02  # standard deviation of the camera's unknown pitch and yaw


def chart(points_m: np.ndarray) -> rc.Scene:
    """Shining squares of three sizes around each point of the chart, which is at the distance CHART_M."""
    random = np.random.default_rng(2)
    vertices, materials = [], []
    for x, y in points_m:
        for layer, (side, reach) in enumerate(((0.008, 0.03), (0.003, 0.012), (0.001, 0.006))):
            for _ in range(60):
                u, v = np.array((x, y)) + random.uniform(-reach, reach, 2)
                z = -CHART_M + 1e-5 * (layer + random.uniform(0, 1))
                half = side * random.uniform(0.3, 0.7)
                vertices += [
                    (u - half, v - half, z),
                    (u + half, v - half, z),
                    (u + half, v + half, z),
                    (u - half, v + half, z),
                ]
                materials.append(rc.Material(emission=(random.uniform(0.05, 1),) * 3))
    faces = [(4 * i + a, 4 * i + b, 4 * i + c) for i in range(len(materials)) for a, b, c in ((0, 1, 2), (0, 2, 3))]
    owners = np.repeat(np.arange(len(materials)), 2)
    return rc.Scene.from_arrays(vertices, faces, triangle_materials=owners, materials=materials)


class Bench:
    """The chart and the cameras. Errors of a lens: of its thicknesses, mm, then tilt x and y, degrees, and decentre x
    and y, mm, of each element, and pitch and yaw of the camera, degrees.

    tolerances: of thicknesses and elements. deviations: (P,), of the prior. excess: variance of a rendering with
    SPP[1] samples, in units of that of the shot noise.
    """

    def __init__(self, grade: str) -> None:
        self.lens = rc.Lens.load("double-gauss-50mm")
        limits = rc.Tolerances.grade(grade)
        self.tolerances = rc.Tolerances(
            thickness_mm=limits.thickness_mm,
            element_tilt_arcmin=limits.element_tilt_arcmin,
            element_decentre_mm=limits.element_decentre_mm,
        )
        self.gaps = [t.first for t in self.tolerances.of(self.lens) if t.kind == "thickness_mm"]
        self.elements = elements_of(self.lens)
        names = [f"thickness {i + 1}" for i in self.gaps]
        # Standard deviations of uniform distributions over an interval and over a disc.
        deviations = [limits.thickness_mm / math.sqrt(3)] * len(self.gaps)
        for first, last in self.elements:
            names += [
                f"{kind} of {first + 1} to {last + 1}" for kind in ("tilt x", "tilt y", "decentre x", "decentre y")
            ]
            deviations += [limits.element_tilt_arcmin / 60 / 2] * 2 + [limits.element_decentre_mm / 2] * 2
        self.names = [*names, "pitch", "yaw"]
        self.deviations = np.array([*deviations, LIMIT_DEG, LIMIT_DEG])
        to_pupil_m = CHART_M - 0.085
        self.scene = chart(np.array(PLACES_MM) * to_pupil_m / 51.0)
        first = self.pictures(np.zeros(len(self.names)), 1, scale=1.0)
        self.scale = ELECTRONS / first.mean()
        first, second = (self.pictures(np.zeros(len(self.names)), 1, seed=seed) for seed in (300, 400))
        self.excess = ((first - second) ** 2 / 2).mean() / first.mean()

    def surfaces_of(self, element: tuple[int, int]) -> list[tuple[int, float]]:
        """Surfaces of an element, with the distance of their vertices behind its centre, mm."""
        first, last = element
        z = np.cumsum([0.0] + [self.lens.surfaces[i].thickness_mm for i in range(first, last)])
        return [(first + i, float(at - z[-1] / 2)) for i, at in enumerate(z)]

    def lens_with(self, errors: np.ndarray, focus_m: float, f_number: float) -> rc.Lens:
        """The lens with errors and its rings where the nominal lens has this focus and f-number."""
        lens = self.lens.focused(focus_m).stopped_down(f_number)
        surfaces = dict(enumerate(lens.surfaces))
        for i, error in zip(self.gaps, errors, strict=False):
            surfaces[i] = surfaces[i].replace(thickness_mm=surfaces[i].thickness_mm + error)
        moves = errors[len(self.gaps) : -2].reshape(-1, 4)
        for element, (tilt_x, tilt_y, x, y) in zip(self.elements, moves, strict=True):
            for i, z in self.surfaces_of(element):
                shift = (x + z * math.radians(tilt_y), y - z * math.radians(tilt_x), 0)
                surfaces[i] = surfaces[i].replace(tilt_deg=(tilt_x, tilt_y, 0), decentre_mm=shift, returns=True)
        return lens.with_surfaces(surfaces)

    def directions(self) -> list[dict[rc.Variable | str, float]]:
        """The errors as parameters of rc.render_gradient."""
        found: list[dict[rc.Variable | str, float]] = [{rc.Variable.thickness(i): 1.0} for i in self.gaps]
        for element in self.elements:
            surfaces = self.surfaces_of(element)
            tilt, decentre = rc.Variable.tilt, rc.Variable.decentre
            found.append(
                {k: v for i, z in surfaces for k, v in ((tilt(i, "x"), 1.0), (decentre(i, "y"), -math.radians(z)))}
            )
            found.append(
                {k: v for i, z in surfaces for k, v in ((tilt(i, "y"), 1.0), (decentre(i, "x"), math.radians(z)))}
            )
            found += [{decentre(i, axis): 1.0 for i, _ in surfaces} for axis in "xy"]
        return [*found, {"pitch_deg": 1.0}, {"yaw_deg": 1.0}]

    def cameras(self, errors: np.ndarray, focus_m: tuple[float, ...], f_number: float) -> list[rc.Camera]:
        """One camera for each focus and place on the film."""
        found = []
        for focus in focus_m:
            lens = self.lens_with(errors, focus, f_number)
            for shift in PLACES_MM:
                film = rc.Film(SIDE_MM, SIDE_MM, (PIXELS, PIXELS), shift_mm=shift)
                camera = rc.Camera(lens, film=film, exposure_time_s=1)
                found.append(rc.CameraParameters(camera, ["pitch_deg", "yaw_deg"]).camera_at(errors[-2:]))
        return found

    def pictures(
        self,
        errors: np.ndarray,
        block: int,
        *,
        spp: int = 0,
        seed: int = 5,
        focus_m: tuple[float, ...] = FOCUS_M,
        f_number: float = F_NUMBER,
        scale: float | None = None,
    ) -> np.ndarray:
        """(K, H, W, 1), electrons."""
        factor = self.scale if scale is None else scale
        return np.stack(
            [
                factor
                * rc.CameraParameters(camera, "up_m")
                .render(self.scene, [0], seed=seed + i, spp=spp or SPP[block][0], max_bounces=0)
                .mean(-1, keepdims=True)
                for i, camera in enumerate(self.cameras(errors, focus_m, f_number))
            ]
        )

    def derivatives(self, errors: np.ndarray, block: int, seed: int) -> np.ndarray:
        """(P, K, H, W, 1)"""
        found = [
            rc.render_gradient(
                self.scene,
                camera,
                self.directions(),
                seed=1000 * seed + i,
                spp=SPP[block][1],
                control_spp=0,
                max_bounces=0,
            ).mean(-1, keepdims=True)
            for i, camera in enumerate(self.cameras(errors, FOCUS_M, F_NUMBER))
        ]
        return self.scale * np.stack(found, axis=1)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--copies", type=int, default=4)
    parser.add_argument("--grade", default="precision", help="commercial, precision or high")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    bench = Bench(arguments.grade)
    study = rc.tolerance_study(
        bench.lens, bench.tolerances, arguments.copies, seed=arguments.seed, compensators=(), rings=6
    )
    nothing = np.zeros(len(bench.names))
    rows = []
    for number in range(arguments.copies):
        random = np.random.default_rng(number)
        errors = dict.fromkeys(bench.names, 0.0)
        for tolerance, sizes in study.errors_of(number):
            if tolerance.kind == "thickness_mm":
                errors[f"thickness {tolerance.first + 1}"] = sizes[0]
            else:
                kind, factor = ("tilt", 1 / 60) if tolerance.kind == "element_tilt_arcmin" else ("decentre", 1)
                for axis, size in zip("xy", sizes, strict=True):
                    errors[f"{kind} {axis} of {tolerance.first + 1} to {tolerance.last + 1}"] = factor * size
        truth = np.array(list(errors.values()))
        truth[-2:] = random.normal(0, LIMIT_DEG, 2)
        exact = bench.pictures(truth, 1, spp=2048, seed=77)
        observed = random.poisson(exact).astype(float)
        fit = rc.fit_pictures(
            bench.pictures,
            bench.derivatives,
            observed,
            (1 + bench.excess) * np.maximum(observed, 1),
            nothing,
            bench.deviations,
            prior=(nothing, bench.deviations),
            blocks=(4, 2, 1),
            steps=5,
        )
        off = (fit.values - truth) @ np.linalg.solve(fit.covariance, fit.values - truth) / len(truth)
        print(f"copy {number}: chi^2 {fit.chi_square:.2f}, mean square error / posterior variance {off:.2f}")
        for name, wanted, found, error, before in zip(
            bench.names, truth, fit.values, fit.errors, bench.deviations, strict=True
        ):
            print(f"  {name:24} {wanted:8.4f}  found {found:8.4f} +- {error:.4f}, before +- {before:.4f}")
        sizes, axes = fit.directions(bench.deviations)
        print(f"  standard deviations along the axes, of those before: {np.round(sizes, 3).tolist()}")
        for size, axis in list(zip(sizes, axes, strict=True))[:3]:
            parts = np.argsort(-np.abs(axis))[:4]
            print(f"  {size:.2f}: " + ", ".join(f"{axis[i]:+.2f} {bench.names[i]}" for i in parts))
        settings = {"spp": 16384, "focus_m": (HELD_OUT_M,), "f_number": HELD_OUT_F_NUMBER}
        held_out = bench.pictures(truth, 1, seed=78, **settings)
        unseen = []
        for name, values in (("nominal lens", np.array([*nothing[:-2], *truth[-2:]])), ("fitted copy", fit.values)):
            predicted = bench.pictures(values, 1, seed=79, **settings)
            unseen.append(np.sqrt(np.mean((predicted - held_out) ** 2 / held_out)))
            print(f"  held out, {name}: {unseen[-1]:.2f} of the noise", flush=True)
        rows.append((number, off, (sizes < 1 / 3).sum(), (sizes > 0.99).sum(), *unseen))
    print(
        "\n| copy | mean square of the posterior | directions known to a third | not at all | nominal lens, held out | "
        "fitted copy |\n|---" + "|---" * 5 + "|"
    )
    for number, off, known, unknown, nominal, fitted in rows:
        print(f"| {number} | {off:.2f} | {known} | {unknown} | {nominal:.2f} | {fitted:.2f} |")


if __name__ == "__main__":
    main()
