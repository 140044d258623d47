"""Derivatives of pictures beside central differences with common random numbers: 30 parameters, six scenes.

    python benchmarks/picture_gradients.py [--device cuda:0] [--seeds 16] [--spp 128] [--scene NAME]

For each scene, a loss is the sum of the pixels of a small picture with random weights. Its derivatives by all
parameters (rc.render_gradient, reverse mode) and their central differences are estimated with `seeds` seeds each, whose
spread is the standard error. Differences with the step h and 2 h yield the bias of the step, which Richardson
extrapolation removes before the two are compared. The step changes the picture by about 3% (root mean square), so that
its bias is small. Prints tables in Markdown:

- z scores of the losses' derivatives, and of the pixels of derivative pictures (forward mode) by six parameters;
- the bias of the differences, in units of their standard error and relative to the derivative;
- noise and time: the factor by which variance times time of differences exceeds that of one gradient, if 20
  parameters share its pass. Time is that of the processor, on a GPU that of the clock.

Losses and differences run on `device`; derivative pictures, in forward mode, on the CPU.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import realcam as rc

PIXELS = (12, 9)
CHANGE = 0.03  # of the picture by a step, relative root mean square
SHARED = 20  # parameters in one pass
PICTURES = ["right_m", "backward_m", "yaw_deg", "film_shift_up_mm", "focus_distance_m", "f_number"]
POSE = ["right_m", "up_m", "backward_m", "pitch_deg", "yaw_deg", "roll_deg"]
KINDS = {
    "translation": POSE[:3],
    "rotation": POSE[3:],
    "film": ["film_shift_right_mm", "film_shift_up_mm"],
    "focus": ["focus_distance_m"],
    "stop": ["f_number"],
}


@dataclass(frozen=True)
class Case:
    """A scene with a camera. settings: of rc.render."""

    name: str
    scene: rc.Scene
    camera: rc.Camera
    settings: dict[str, object] = field(default_factory=lambda: {"max_bounces": 0})


@dataclass(frozen=True)
class Estimate:
    """Values of each seed, (S, ...), and seconds of one seed."""

    values: np.ndarray
    seconds: float

    @property
    def mean(self) -> np.ndarray:
        return self.values.mean(0)

    @property
    def error(self) -> np.ndarray:
        return self.values.std(0, ddof=1) / np.sqrt(len(self.values))


class Quads:
    """Collects rectangles for a scene."""

    def __init__(self) -> None:
        self.vertices: list[np.ndarray] = []
        self.materials: list[rc.Material] = []

    def add(self, middle: object, right: object, up: object, **material: object) -> None:
        """Adds a rectangle; right, up: half of its sides, whose product points to its front."""
        m, r, u = (np.asarray(part, float) for part in (middle, right, up))
        self.vertices += [m - r - u, m + r - u, m + r + u, m - r + u]
        self.materials.append(rc.Material(**material))

    def scene(self) -> rc.Scene:
        faces = [
            [4 * i + a, 4 * i + b, 4 * i + c] for i in range(len(self.materials)) for a, b, c in ((0, 1, 2), (0, 2, 3))
        ]
        return rc.Scene.from_arrays(
            self.vertices,
            faces,
            uvs=np.tile([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], (len(self.materials), 1)),
            triangle_materials=np.repeat(np.arange(len(self.materials)), 2),
            materials=self.materials,
        )


def film_at(*shift_mm: float) -> rc.Film:
    """A film of pixels of 0.1 mm, off the axis."""
    return rc.Film(PIXELS[0] / 10, PIXELS[1] / 10, PIXELS, shift_mm=shift_mm)


def double_gauss(focus_m: float, f_number: float, *shift_mm: float) -> rc.Camera:
    lens = rc.Lens.load("double-gauss-50mm").focused(focus_m).stopped_down(f_number)
    return rc.Camera(lens, film=film_at(*shift_mm), exposure_time_s=1)


def occluder() -> Case:
    """An edge at 1.4 m that hides stripes at 3 m, across the focus at 2 m."""
    random, quads = np.random.default_rng(3), Quads()
    for x in np.arange(-1.15, 1.2, 0.1):
        quads.add((x, 0, -3), (0.05, 0, 0), (0, 1.5, 0), emission=tuple(random.uniform(0.2, 2, 3)))
    right, up = np.array((np.cos(0.3), np.sin(0.3), 0)), np.array((-np.sin(0.3), np.cos(0.3), 0))
    quads.add(-1.2 * right - (0, 0, 1.4), 1.5 * right, 1.5 * up, diffuse=(0, 0, 0))
    return Case("occluder", quads.scene(), double_gauss(2, 4, 10, 6))


def lamp() -> Case:
    """A lamp's disc of 4 cm at 6 m, out of focus, at the corner of the film, where rims cut it."""
    quads = Quads()
    middle = np.array((14.0, 8.0)) / 50 * 6
    for y in np.linspace(-0.019, 0.019, 20):
        quads.add((middle[0], middle[1] + y, -6), (np.sqrt(0.02**2 - y**2), 0, 0), (0, 0.001, 0), emission=(9, 6, 3))
    return Case("lamp", quads.scene(), double_gauss(1.5, 2.4, 14.3, 8.2))


def shadow() -> Case:
    """A diffuse plane with the shadow of an edge before a small lamp, in direct light."""
    quads = Quads()
    quads.add((0, 0, -2.5), (2, 0, 0), (0, 2, 0), diffuse=(0.7, 0.6, 0.4))
    quads.add((0.9, 0.8, -1.2), (-0.04, 0, 0.04), (0, 0.04, 0), emission=(300, 300, 300))
    # The shadow's edge crosses the middle of the picture.
    quads.add((0.82, 0.3, -1.85), (0.2, 0.02, 0), (0, 0.28, 0), diffuse=(0.1, 0.1, 0.1))
    return Case("shadow", quads.scene(), double_gauss(2.2, 2.8, 10, 6))


def fisheye() -> Case:
    """The border of a fisheye's picture, 110 degrees from its axis, in a room of coloured rectangles."""
    random, quads = np.random.default_rng(5), Quads()
    for axis in range(3):
        for side in (-2, 2):
            middle, a, b = side * np.eye(3)[axis], np.eye(3)[(axis + 1) % 3], np.eye(3)[(axis + 2) % 3]
            a = a if side < 0 else -a
            for u in np.arange(-1.8, 2, 0.4):
                for v in np.arange(-1.8, 2, 0.4):
                    emission = tuple(random.uniform(0.1, 2, 3))
                    quads.add(middle + u * a + v * b, 0.2 * a, 0.2 * b, emission=emission)
    lens = rc.Lens.load("fisheye-6mm-220deg").focused(1).stopped_down(8)
    return Case("fisheye's border", quads.scene(), rc.Camera(lens, film=film_at(11.3, 0.7), exposure_time_s=1))


def texture() -> Case:
    """A plane with a smooth texture at the focus, half as wide as a pixel's image per texel."""
    random, quads = np.random.default_rng(7), Quads()
    texels = random.uniform(0.1, 1, (512, 512, 3))
    quads.add((0, 0, -2), (0.75, 0, 0), (0, 0.75, 0), emission=(2, 2, 2), emission_texture=texels)
    return Case("texture", quads.scene(), double_gauss(2, 4, 10, 6))


def demo() -> Case:
    """The demo scene with six bounces, in the light and with the pose of its shot."""
    lens = rc.Lens.load("double-gauss-50mm").focused(1.05).stopped_down(2.8)
    film = rc.Film(6, 4.5, PIXELS, shift_mm=(3, -1))
    camera = rc.Camera(lens, film=film, position=(0, 0.25, 1.1), look_at=(0, 0.12, 0), exposure_time_s=0.025)
    scene = rc.Scene.load("demo").with_environment((20, 28, 46))
    return Case("demo", scene, camera, {"max_bounces": 6})


CASES: dict[str, Callable[[], Case]] = {
    "occluder": occluder,
    "lamp": lamp,
    "shadow": shadow,
    "fisheye": fisheye,
    "texture": texture,
    "demo": demo,
}


def parameters_of(lens: rc.Lens) -> list[rc.Variable | str]:
    """30 parameters: pose, shift, rings, and surfaces from the first to the last."""
    bent = [i for i, s in enumerate(lens.surfaces) if s.type == "refracting" and s.curvature_per_mm != 0]
    glass = [i for i in bent if lens.surfaces[i].material.index(lens.wavelength_nm) > 1.1]
    gaps = [i for i, s in enumerate(lens.surfaces[:-1]) if s.thickness_mm > 0]

    def some(indices: list[int], count: int) -> list[int]:
        return [indices[i] for i in np.linspace(0, len(indices) - 1, count).round().astype(int)]

    return [
        *POSE,
        *KINDS["film"],
        "focus_distance_m",
        "f_number",
        *(rc.Variable.radius(i) for i in some(bent, 6)),
        *(rc.Variable.thickness(i) for i in some(gaps, 6)),
        *(rc.Variable.index(i) for i in some(glass, 2)),
        *(rc.Variable.tilt(i, axis) for i, axis in zip(some(bent[1:-1], 2), "xy", strict=True)),
        *(rc.Variable.decentre(i, axis) for i, axis in zip(some(bent, 2), "xy", strict=True)),
        rc.Variable.conic(bent[0]),
        rc.Variable.aspheric(bent[-1], 4),
    ]


def kind_of(parameter: rc.Variable | str) -> str:
    if isinstance(parameter, str):
        return next(kind for kind, names in KINDS.items() if parameter in names)
    if parameter.quantity in ("tilt", "decentre"):
        return "tilt, decentre"
    return "thickness, index" if parameter.quantity in ("thickness", "index") else "curvature, asphere"


class Study:
    """Gradients and differences of one case.

    by_gradient: (S, P), of the loss. by_pictures: (S, 6, H, W), of the pixels' sums over channels. differences: for the
    steps h and 2 h, (S, 2, P), and picture_differences (S, 2, 6, H, W).
    """

    def __init__(self, case: Case, seeds: int, spp: int, device: str) -> None:
        self.case = case
        self.clock = time.process_time if device == "cpu" else time.perf_counter
        self.parameters = parameters_of(case.camera.lens)
        self.family = rc.CameraParameters(case.camera, self.parameters)
        self.of_pictures = rc.CameraParameters(case.camera, PICTURES)
        self.settings = {**case.settings, "spp": spp, "device": device}
        self.on_cpu = {**self.settings, "device": "cpu"}
        self.weights = np.random.default_rng(1).normal(size=(PIXELS[1], PIXELS[0], 3))
        picture = self.family.render(case.scene, self.family.values, seed=1, **self.settings)
        self.luminance = picture.sum(-1)
        self.steps = self._steps(picture)
        self.by_gradient = self._of_seeds(
            seeds,
            lambda seed: self.family.gradient(case.scene, self.family.values, self.weights, seed=seed, **self.settings),
        )
        self.by_pictures = self._of_seeds(
            seeds,
            lambda seed: self.of_pictures.gradient(
                case.scene, self.of_pictures.values, seed=500 + seed, **self.on_cpu
            ).sum(-1),
        )
        both = self._of_seeds(seeds, self._difference)
        count = 2 * len(self.parameters)
        # Seconds of one difference of one parameter.
        self.differences = Estimate(both.values[:, :count].reshape(seeds, 2, -1), both.seconds / count)
        self.picture_differences = both.values[:, count:].reshape(seeds, 2, len(PICTURES), PIXELS[1], PIXELS[0])

    def _of_seeds(self, seeds: int, of_seed: Callable[[int], np.ndarray]) -> Estimate:
        begin = self.clock()
        values = np.array([of_seed(seed) for seed in range(seeds)], float)
        return Estimate(values, (self.clock() - begin) / seeds)

    def _steps(self, picture: np.ndarray) -> np.ndarray:
        """(P,): steps that change the picture by CHANGE. The product of two independent estimates of a derivative
        picture has no bias by noise."""
        first, second = (
            self.family.gradient(self.case.scene, self.family.values, seed=seed, **self.on_cpu) for seed in (900, 901)
        )
        squares = (first * second).mean((1, 2, 3), dtype=float)
        noise = ((first - second) ** 2).mean((1, 2, 3), dtype=float)
        steps = CHANGE * np.sqrt((picture.astype(float) ** 2).mean() / np.maximum(squares, 0.1 * noise))
        # The rings must not reach their ends.
        is_ring = [kind_of(p) in ("focus", "stop") for p in self.parameters]
        steps = np.where(is_ring, np.minimum(steps, 0.05 * self.family.values), steps)
        for i, unit in enumerate(np.eye(len(steps))):
            while not all(self._exists(2 * sign * steps[i] * unit) for sign in (1, -1)):
                steps[i] /= 2
        return steps

    def _exists(self, change: np.ndarray) -> bool:
        """True if there is a camera whose values are changed by this; its surfaces may cross otherwise."""
        try:
            self.family.camera_at(self.family.values + change)
        except rc.RealcamError:
            return False
        return True

    def _difference(self, seed: int) -> np.ndarray:
        """Differences of the loss for h and 2 h, (2 P), and of the pixels, (2 * 6 * H * W)."""
        losses, pixels = np.zeros((2, len(self.steps))), []
        for j, factor in enumerate((1, 2)):
            for i, step in enumerate(factor * self.steps):
                change = step * np.eye(len(self.steps))[i]
                above, below = (
                    self.family.render(
                        self.case.scene, self.family.values + sign * change, seed=1000 + seed, **self.settings
                    ).astype(float)
                    for sign in (1, -1)
                )
                slope = (above - below) / (2 * step)
                losses[j, i] = (slope * self.weights).sum()
                if self.parameters[i] in PICTURES:
                    pixels.append(slope.sum(-1))
        return np.concatenate([losses.ravel(), np.array(pixels).ravel()])

    @property
    def z(self) -> np.ndarray:
        """(P,): of the loss's derivatives, against extrapolated differences."""
        return scores(self.by_gradient, extrapolated(self.differences.values))

    @property
    def pixel_z(self) -> np.ndarray:
        """(6, N): of the pixels that are not dark, whose few samples have a skew distribution."""
        z = scores(self.by_pictures, extrapolated(self.picture_differences))
        return z[:, self.luminance > 0.1 * self.luminance.max()]

    @property
    def bias(self) -> Estimate:
        """(S, P): of differences with the step h."""
        return Estimate((self.differences.values[:, 1] - self.differences.values[:, 0]) / 3, 0.0)

    @property
    def gains(self) -> np.ndarray:
        """(P,): variance times time of differences over that of gradients, for SHARED parameters."""
        variances = self.differences.values[:, 0].var(0, ddof=1) / self.by_gradient.values.var(0, ddof=1)
        return variances * SHARED * self.differences.seconds / self.by_gradient.seconds


def extrapolated(differences: np.ndarray) -> Estimate:
    """Richardson extrapolation of differences with h and 2 h, (S, 2, ...)."""
    return Estimate((4 * differences[:, 0] - differences[:, 1]) / 3, 0.0)


def scores(first: Estimate, second: Estimate) -> np.ndarray:
    """z scores of the difference of means; 0 where both are 0."""
    error = np.hypot(first.error, second.error)
    return np.divide(first.mean - second.mean, error, out=np.zeros_like(error), where=error > 0)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=16)
    parser.add_argument("--spp", type=int, default=128)
    parser.add_argument("--device", default="cpu", help="cpu, or one GPU, such as cuda:0")
    parser.add_argument("--scene", choices=list(CASES), action="append", help="One of the six; may be repeated")
    parser.add_argument("--list", action="store_true", help="Print the z scores of each parameter")
    arguments = parser.parse_args()
    if arguments.seeds < 3:
        parser.error("--seeds must be 3 or more: z scores of fewer have no finite deviation")
    studies = []
    for name in arguments.scene or CASES:
        begin = time.perf_counter()
        studies.append(Study(CASES[name](), arguments.seeds, arguments.spp, arguments.device))
        print(f"{name}: {time.perf_counter() - begin:.0f} s", file=sys.stderr, flush=True)
        if arguments.list:
            study = studies[-1]
            for parameter, step, z, mean, error in zip(
                study.parameters, study.steps, study.z, study.by_gradient.mean, study.by_gradient.error, strict=True
            ):
                print(f"{name}: {parameter}: {mean:.4g} +- {error:.2g}, step {step:.3g}, z {z:.2f}", flush=True)
    # The ratio of a mean of `seeds` numbers to its estimated error is distributed as Student's t.
    freedom = 2 * (arguments.seeds - 1)
    expected = np.sqrt(freedom / (freedom - 2))
    print(f"\nExpected standard deviation of z: {expected:.2f} (Student's t)\n")
    print(
        "| scene | mean z | sd of z | largest | error, median | pixels | mean z^2 | largest |\n|---" + "|---" * 7 + "|"
    )
    for s in studies:
        z, pixels = s.z, s.pixel_z
        error = np.median(np.abs(s.by_gradient.error / s.by_gradient.mean))
        print(
            f"| {s.case.name} | {z.mean():.2f} | {z.std():.2f} | {np.abs(z).max():.1f} | {error:.1%} | {pixels.size} | "
            f"{(pixels**2).mean():.2f} | {np.abs(pixels).max():.1f} |"
        )
    print("\n| scene | bias of differences: sd of z | largest, % of the derivative | parameter |\n|---|---|---|---|")
    for s in studies:
        bias = s.bias
        relative = np.abs(bias.mean / s.differences.mean[0])
        worst = int(np.argmax(np.where(np.abs(bias.mean) > 3 * bias.error, relative, 0)))
        print(
            f"| {s.case.name} | {(bias.mean / bias.error).std():.1f} | {relative[worst]:.1%} | {s.parameters[worst]} |"
        )
    kinds = list(dict.fromkeys(map(kind_of, studies[0].parameters)))
    print(
        "\n| scene | a gradient / a difference, time | "
        + " | ".join(kinds)
        + " |\n|---|---"
        + "|---" * len(kinds)
        + "|"
    )
    for s in studies:
        cells = []
        for kind in kinds:
            gains = s.gains[[kind_of(p) == kind for p in s.parameters]]
            cells.append(f"{gains.min():.2g}" if len(gains) == 1 else f"{gains.min():.2g} to {gains.max():.2g}")
        print(f"| {s.case.name} | {s.by_gradient.seconds / s.differences.seconds:.1f} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
