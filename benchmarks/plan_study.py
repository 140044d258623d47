"""Is the planner right? Drawn shots with and without each effect: what that changes, and what was foreseen.

    python benchmarks/plan_study.py [--device cpu] [--shots 32] [--seed 1] [--spp 1024]

Each shot is a drawn scene (boards with a pattern, in daylight, at night with lamps, with the sun in the frame, near or
far, some moving) before a drawn camera. An effect is measured by itself, a camera model against the next better one.

A change of light in codes is that of the mean of some square of 8 by 8 pixels (the 99th percentile over them), or, of
vignetting and coatings, of some twelfth of the picture. A change in pixels is what moves and blurs the one picture into
the other: in each twelfth, B = A + shift . grad A + (s^2 / 2) laplacian A + gain A + constant is fitted to each channel
of both, smoothed alike, and a blur of variance s^2 is that of a disc of 4 s. The noise of two pictures that differ in
their random numbers alone is taken off in squares.
"""

from __future__ import annotations

import argparse
import warnings
from dataclasses import dataclass

import numpy as np
import realcam as rc
from srgb import srgb_codes

EFFECTS = ("dispersion", "coatings", "ghosts", "diffraction")
MODELS = {  # without, with
    "defocus": ("pinhole", "thin"),
    "distortion": ("thin", "mapped"),
    "vignetting": ("thin", "mapped"),
    "aberrations": ("mapped", "full"),
}
LENSES = (
    "double-gauss-50mm",
    "phone-4mm",
    "fisheye-10mm",
    "singlet-100mm",
    "tessar-50mm",
    "telephoto-250mm",
    "mirror-telephoto-500mm",
    "zoom-70-210mm-at-70mm",
)


@dataclass
class Shot:
    name: str
    scene: rc.Scene
    camera: rc.Camera


def board(middle: tuple[float, float, float], width: float) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and texture coordinates of a square that faces +z."""
    x, y, z = middle
    half = width / 2
    corners = np.array(
        [[x - half, y - half, z], [x + half, y - half, z], [x + half, y + half, z], [x - half, y + half, z]]
    )
    return corners, np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def pattern(random: np.random.Generator) -> np.ndarray:
    """Bars, squares and a ramp, of two greys."""
    side = 256
    x, y = np.meshgrid(np.arange(side), np.arange(side))
    cell = int(random.choice([16, 32, 64]))
    picture = np.where((x // cell + y // cell) % 2 == 0, 230, 40).astype(np.uint8)
    picture[: side // 4] = np.linspace(40, 230, side).astype(np.uint8)
    return np.repeat(picture[..., None], 3, axis=2)


def scene_of(boards: list[tuple[np.ndarray, np.ndarray]], random: np.random.Generator) -> rc.Scene:
    vertices, uvs = (np.concatenate([b[i] for b in boards]) for i in (0, 1))
    faces = [[4 * i + a, 4 * i + b, 4 * i + c] for i in range(len(boards)) for a, b, c in ((0, 1, 2), (0, 2, 3))]
    scene = rc.Scene.from_arrays(vertices, faces, uvs=uvs, materials=[rc.Material(diffuse=(0.8, 0.8, 0.8))])
    return scene.with_texture(0, pattern(random))


def drawn_shot(number: int, seed: int) -> Shot:
    random = np.random.default_rng([seed, number])
    kind = ("daylight", "night", "sun", "near", "far", "moving")[number % 6]
    name = LENSES[int(random.integers(len(LENSES)))]
    lens = rc.Lens.load(name)
    first = lens.first_order()
    nearest = 1.5 * max(0.3, 10 * abs(first.effective_focal_length_mm) / 1000)
    distance = {"near": nearest, "far": 100 * nearest}.get(kind, float(nearest * random.uniform(2, 20)))
    focus = distance * float(random.choice([1.0, 1.0, 0.7, 1.5]))
    lens = lens.focused(focus)
    # A mirror telephoto can hardly be stopped down: its middle is dark.
    most = 2 if name.startswith("mirror") else 5
    f_number = first.f_number * float(random.choice([1.0, 1.4, 2.0, 4.0, 8.0][:most]))
    if f_number > first.f_number:
        lens = lens.stopped_down(f_number)
    lens = lens.with_coating(str(random.choice(["bare", "quarter_wave"])))
    width = min(lens.film_mm) * float(random.choice([0.05, 0.3, 1.0]))
    film = rc.Film(width, width * 2 / 3, (240, 160))
    field = width / abs(lens.first_order().effective_focal_length_mm)
    at = [
        board(
            (
                field * distance * float(random.uniform(-0.3, 0.3)) * k,
                field * distance * float(random.uniform(-0.2, 0.2)),
                -distance * k,
            ),
            0.5 * field * distance * k,
        )
        for k in (1.0, 1.6, 3.0)
    ]
    back = 12 * distance
    at.append(board((0, 0, -back), 6 * field * back))
    scene = scene_of(at, random)
    exposure = 1 / 200
    if kind == "night":
        scene = scene.with_environment(0.05)
        for _ in range(3):
            place = (
                field * distance * float(random.uniform(-0.4, 0.4)),
                field * distance * float(random.uniform(-0.25, 0.25)),
                -0.95 * distance,
            )
            candela = (30.0 * distance**2,) * 3
            scene = scene.with_point_light(place, candela)
        exposure = 1 / 15
    else:
        towards = np.array([0.4, -0.6, -0.7])
        if kind == "sun":
            towards = np.array([0.25 * field, -0.2 * field, 1.0])
        towards = towards / np.linalg.norm(towards)
        scene = scene.with_environment(3000.0).with_sun(tuple(towards), (8e4, 8e4, 8e4))
    camera = rc.Camera(lens, film=film, exposure_time_s=exposure)
    if kind == "moving":
        pixels = float(random.choice([0.1, 0.3, 0.8, 3.0]))
        way = pixels * width / 240 / 1000 * distance / (abs(first.effective_focal_length_mm) / 1000)
        there, further = np.eye(4), np.eye(4)
        further[:3, 3] = (way / exposure, 0, 0)
        object_ = scene_of([board((0, 0, -0.9 * distance), 0.3 * field * distance)], random)
        scene = scene.with_instance(object_, name="moving").moved("moving", [there, further], times_s=[0, 1])
    dim = rc.render(scene, camera.replace(model="pinhole"), spp=32, device="cpu", max_bounces=0)
    bright = float(np.quantile(dim.pixels.mean(axis=2), 0.9))
    camera = camera.replace(iso=float(np.clip(0.5 / (0.018 * max(bright, 1e-12)), 1e-6, 1e9)))
    return Shot(f"{number} {kind} {name} f/{f_number:.1f} {1000 * width / 240:.1f} um", scene, camera)


def codes(image: rc.Image) -> np.ndarray:
    return srgb_codes(0.018 * image.camera.iso * image.pixels.astype(np.float64))


def smooth(picture: np.ndarray) -> np.ndarray:
    """By a binomial filter of five by five pixels: of both pictures, it changes none of what is fitted."""
    for axis in (0, 1):
        for _ in range(2):
            ends = [np.take(picture, [i], axis=axis) for i in (0, -1)]
            padded = np.concatenate([ends[0], picture, ends[1]], axis=axis)
            length = picture.shape[axis]
            low, middle, high = (np.take(padded, np.arange(k, k + length), axis=axis) for k in range(3))
            picture = (low + 2 * middle + high) / 4
    return picture


def parts_of(picture: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Twelve."""
    rows = np.array_split(np.arange(2, picture.shape[0] - 2), 3)
    columns = np.array_split(np.arange(2, picture.shape[1] - 2), 4)
    return [np.ix_(r, c) for r in rows for c in columns]


def change_in_codes(a: np.ndarray, b: np.ndarray) -> float:
    height, width = (8 * (side // 8) for side in a.shape[:2])
    squares = (a - b)[:height, :width].reshape(height // 8, 8, width // 8, 8, 3).mean(axis=(1, 3))
    return float(np.quantile(np.abs(squares), 0.99))


@dataclass
class Change:
    moved_px: float = 0.0
    colours_px: float = 0.0  # between blue and red
    blur_px: float = 0.0
    light_codes: float = 0.0


def change_in_pixels(a: np.ndarray, b: np.ndarray) -> Change:
    """The most of all parts. `a`: the sharper one."""
    a, b = smooth(a), smooth(b)
    down, across = np.gradient(a, axis=(0, 1))
    laplacian = np.gradient(down, axis=0) + np.gradient(across, axis=1)
    most = Change()
    for part in parts_of(a):
        # Enough edges in both directions, or a shift along the edges could be any.
        slopes = np.stack([t[part].ravel() for t in (across, down)])
        if np.linalg.eigvalsh(slopes @ slopes.T / slopes.shape[1])[0] < 1:
            continue
        shifts, blurs = [], []
        for channel in range(3):
            terms = [t[part][..., channel].ravel() for t in (across, down, laplacian / 2, a, np.ones_like(a))]
            found, *_ = np.linalg.lstsq(np.stack(terms, axis=1), (b - a)[part][..., channel].ravel(), rcond=None)
            shifts.append(found[:2])
            blurs.append(4 * np.sqrt(abs(found[2])))
            light = found[3] * a[part][..., channel].mean() + found[4]
            most.light_codes = max(most.light_codes, abs(float(light)))
        most.moved_px = max(most.moved_px, *(float(np.hypot(*shift)) for shift in shifts))
        most.colours_px = max(most.colours_px, float(np.hypot(*(shifts[2] - shifts[0]))))
        most.blur_px = max(most.blur_px, *(float(blur) for blur in blurs))
    return most


def measured(effect: str, unit: str, a: np.ndarray, b: np.ndarray) -> float:
    if effect in ("vignetting", "coatings"):
        return change_in_pixels(a, b).light_codes
    if unit == "codes":
        return change_in_codes(a, b)
    change = change_in_pixels(a, b)
    if effect == "distortion":
        return change.moved_px
    return max(change.colours_px, change.blur_px) if effect == "dispersion" else change.blur_px


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--shots", type=int, default=32)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--spp", type=int, default=1024)
    words = parser.parse_args()
    warnings.simplefilter("ignore", UserWarning)
    right = total = 0
    print("| shot | effect | foreseen | measured | threshold | decision |")
    print("|---|---|---|---|---|---|")
    for number in range(words.shots):
        shot = drawn_shot(number, words.seed)
        plan = rc.plan(shot.scene, shot.camera, device=words.device)
        foreseen = {decision.effect: decision for decision in plan.decisions}

        def taken(effects: set[str], model: str = "full", seed: int = 1, shot: Shot = shot) -> np.ndarray:
            camera = shot.camera.replace(model=model)
            return codes(rc.render(shot.scene, camera, spp=words.spp, device=words.device, seed=seed, effects=effects))

        pictures = {"full noise": taken(set(), seed=2)}
        for effect in EFFECTS:
            pictures[effect], pictures[effect + " noise"] = (taken({effect}, seed=seed) for seed in (1, 2))
        if "motion_blur" in foreseen:
            pictures["still"] = taken({"-motion_blur"})
        for model in ("full", "pinhole", "thin", "mapped"):
            try:
                pictures[model] = taken(set(), model)
            except rc.InputError:  # the lens sees more than that model can
                pictures[model] = np.zeros_like(pictures["full noise"])
        for effect, decision in foreseen.items():
            if effect in MODELS:
                pairs = (MODELS[effect], ("full", "full noise"))
            elif effect == "motion_blur":
                pairs = (("still", "full"), ("full", "full noise"))
            elif effect in EFFECTS:
                pairs = (("full", effect), (effect, effect + " noise"))
            else:
                continue
            change, least = (measured(effect, decision.unit, pictures[a], pictures[b]) for a, b in pairs)
            size = float(np.sqrt(max(change**2 - least**2, 0)))
            needed = size >= decision.threshold
            said = decision.size >= decision.threshold
            right += needed == said
            total += 1
            verdict = "right" if needed == said else "false drop" if needed else "false keep"
            print(
                f"| {shot.name} | {effect} | {decision.size:.3g} {decision.unit} | {size:.3g} (noise {least:.2g}) "
                f"| {decision.threshold:g} | {verdict} |",
                flush=True,
            )
    print(f"\n{right} of {total} right.")


if __name__ == "__main__":
    main()
