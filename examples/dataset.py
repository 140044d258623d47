"""Makes labelled pictures of random scenes through random lenses, on all cores or on the GPU.

    python examples/dataset.py --output out/dataset --count 200 --size 480x320

Each picture NNNNN has three files: NNNNN.png; NNNNN.exr with exposure, depth along the axis (Z, DepthMiddle.Z) and
object ids (ObjectId); NNNNN.json with pose, intrinsics, a fitted camera model (docs/vision.md) and its objects.
dataset.json is the index, in the format of COCO. Started again, it makes what is missing; the same --seed makes the
same pictures.
"""

from __future__ import annotations

import argparse
import json
import os
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import realcam as rc

LENSES = ("double-gauss-50mm", "tessar-50mm", "sonnar-50mm", "phone-4mm", "fisheye-6mm-220deg")
CATEGORIES = ("box", "ball", "pyramid")


@dataclass(frozen=True)
class Order:
    """What one worker needs to make a picture."""

    number: int
    seed: int
    size: tuple[int, int]
    spp: int
    device: str
    threads: int
    folder: Path

    def file(self, suffix: str) -> Path:
        return self.folder / f"{self.number:05d}{suffix}"


def shape(category: str) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and triangles of a body that stands on y = 0 and is 1 m wide and high."""
    if category == "ball":
        across, down = 24, 12
        polar, turn = np.meshgrid(
            np.linspace(0, np.pi, down + 1), np.arange(across) * 2 * np.pi / across, indexing="ij"
        )
        ring = np.sin(polar)
        vertices = 0.5 * np.stack([ring * np.sin(turn), 1 + np.cos(polar), ring * np.cos(turn)], axis=-1).reshape(-1, 3)
        a = (np.arange(down)[:, None] * across + np.arange(across)).ravel()
        b = a - a % across + (a + 1) % across
        return vertices, np.concatenate([np.stack([a, a + across, b + across], 1), np.stack([a, b + across, b], 1)])
    base = np.array([[-0.5, 0, 0.5], [0.5, 0, 0.5], [0.5, 0, -0.5], [-0.5, 0, -0.5]])
    if category == "pyramid":
        return np.vstack([base, [[0, 1, 0]]]), np.array([[i, (i + 1) % 4, 4] for i in range(4)])
    sides = [[i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i] for i in range(4)]
    quads = np.array([*sides, [4, 5, 6, 7]])
    return np.vstack([base, base + np.array([0, 1, 0])]), np.vstack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def random_scene(rng: np.random.Generator) -> tuple[rc.Scene, list[str], np.ndarray]:
    """A floor with bodies on it; the bodies' categories, in the order of their ids from 2 on, and their middles."""
    floor = np.array([[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9]])
    grey = rc.Material(diffuse=tuple(rng.uniform(0.2, 0.6, 3)), name="floor")
    scene = rc.Scene.from_arrays(floor, [[0, 1, 2], [0, 2, 3]], materials=[grey])
    categories: list[str] = []
    middles: list[np.ndarray] = []
    sizes = rng.uniform(0.15, 0.5, rng.integers(3, 9))
    for i, size in enumerate(sizes):
        place = np.zeros(3)
        for _ in range(100):  # tries to find room; then it stands in another
            place[[0, 2]] = rng.uniform(-0.9, 0.9, 2)
            apart = [np.hypot(*(place - middle)[[0, 2]]) for middle in middles]
            if all(apart > 0.75 * (size + sizes[: len(apart)])):
                break
        category = CATEGORIES[rng.integers(len(CATEGORIES))]
        vertices, triangles = shape(category)
        color = rc.Material(diffuse=tuple(rng.uniform(0.1, 0.9, 3)), name=f"{category} {i}")
        body = rc.Scene.from_arrays(vertices, triangles, materials=[color])
        turn = rng.uniform(0, 2 * np.pi)
        c, s = size * np.cos(turn), size * np.sin(turn)
        matrix = np.array([[c, 0, s, place[0]], [0, size, 0, 0], [-s, 0, c, place[2]], [0, 0, 0, 1]])
        scene = scene.with_instance(body, matrix, name=f"{category} {i}")
        categories.append(category)
        middles.append(place + np.array([0, size / 2, 0]))
    height, turn = rng.uniform(0.3, 1), rng.uniform(0, 2 * np.pi)
    sun = (np.cos(turn), -height, np.sin(turn))
    scene = scene.with_environment(tuple(rng.uniform(500, 3000) * np.array([0.8, 0.9, 1])))
    return scene.with_sun(sun, (60000, 56000, 50000)), categories, np.array(middles)


def random_camera(rng: np.random.Generator, size: tuple[int, int]) -> rc.Camera:
    """Any of the lenses, stopped down and focused somewhere, that looks at the middle of the floor."""
    lens = rc.Lens.load(LENSES[rng.integers(len(LENSES))])
    lens = lens.stopped_down(float(lens.first_order().f_number * rng.uniform(1, 3)))
    film = rc.Film.for_lens(lens, resolution=size)
    camera = rc.Camera(lens, film=film, iso=100)
    # So far away that about two metres fill the picture's width; a fisheye stands nearer than that.
    half_angle = np.radians(min(camera.field_of_view_deg.horizontal, 120) / 2)
    distance = max(0.6, rng.uniform(0.8, 1.3) / np.tan(half_angle))
    turn, rise = rng.uniform(0, 2 * np.pi), rng.uniform(0.15, 0.9)
    away = np.array([np.cos(rise) * np.sin(turn), np.sin(rise), np.cos(rise) * np.cos(turn)])
    target = rng.uniform([-0.2, 0.05, -0.2], [0.2, 0.3, 0.2])
    lens = lens.focused(max(1.05 * lens.nearest_focus_m, float(distance * rng.uniform(0.8, 1.2))))
    roll = rng.uniform(-0.2, 0.2)
    return camera.replace(
        lens=lens, position=tuple(target + distance * away), look_at=tuple(target), up=(np.sin(roll), 1, 0)
    )


def make(order: Order) -> int:
    """Renders and labels one picture. Its .json comes last, so that it says that the picture is whole."""
    rng = np.random.default_rng([order.seed, order.number])
    scene, categories, middles = random_scene(rng)
    camera = random_camera(rng, order.size).metered(scene, device=order.device)
    image = rc.render(
        scene,
        camera,
        spp=order.spp,
        seed=order.number,
        device=order.device,
        threads=order.threads,
        layers=["depth_middle", "object_id"],
        effects=(),
    )
    image.save(order.file(".png"))
    image.save(order.file(".exr"))
    fisheye = camera.field_of_view_deg.diagonal > 120
    label = rc.camera_json(camera, [rc.fit_camera_model(camera, "fisheye" if fisheye else "opencv8")])
    label["objects"] = list(objects_of(image, categories, camera.project(middles)))
    order.file(".json").write_text(json.dumps(label, indent=1))
    return order.number


def objects_of(image: rc.Image, categories: list[str], middles: np.ndarray):
    """Of each body that is seen: its box [x, y, width, height] and area in pixels, and where its middle projects to."""
    ids = image.layers["object_id"]
    for i, (category, middle) in enumerate(zip(categories, middles, strict=True), start=2):
        rows, columns = np.nonzero(ids == i)
        if len(rows):
            x, y = int(columns.min()), int(rows.min())
            yield {
                "id": i,
                "name": image.object_names[i],
                "category": category,
                "box": [x, y, int(columns.max()) + 1 - x, int(rows.max()) + 1 - y],
                "area": len(rows),
                "middle": [None, None] if np.isnan(middle).any() else middle.tolist(),
            }


def write_index(folder: Path, count: int) -> None:
    """dataset.json: images, annotations and categories as COCO has them."""
    images, annotations = [], []
    for number in range(count):
        label = json.loads((folder / f"{number:05d}.json").read_text())
        images.append(
            {"id": number, "file_name": f"{number:05d}.png", "width": label["width"], "height": label["height"]}
        )
        for seen in label["objects"]:
            annotations.append(
                {
                    "id": len(annotations) + 1,
                    "image_id": number,
                    "category_id": CATEGORIES.index(seen["category"]) + 1,
                    "bbox": seen["box"],
                    "area": seen["area"],
                    "iscrowd": 0,
                }
            )
    categories = [{"id": i, "name": name} for i, name in enumerate(CATEGORIES, start=1)]
    index = {"images": images, "annotations": annotations, "categories": categories}
    (folder / "dataset.json").write_text(json.dumps(index))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", type=Path, default=Path("out/dataset"))
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--size", default="480x320", help="columns x rows (default: 480x320)")
    parser.add_argument("--spp", type=int, default=64, help="samples of each pixel (default: 64)")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    size = tuple(map(int, options.size.split("x")))
    options.output.mkdir(parents=True, exist_ok=True)
    on_gpu = any(device.name.startswith("cuda") for device in rc.devices())
    workers = 1 if on_gpu else len(os.sched_getaffinity(0))
    device, threads = ("cuda", 0) if on_gpu else ("cpu", 1)
    orders = [Order(i, options.seed, size, options.spp, device, threads, options.output) for i in range(options.count)]
    missing = [order for order in orders if not order.file(".json").exists()]
    start = time.perf_counter()
    # Processes are started afresh: a fork would copy threads that hold locks.
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        for done, future in enumerate(as_completed([pool.submit(make, order) for order in missing]), start=1):
            future.result()
            each = (time.perf_counter() - start) / done
            print(f"\r{done} of {len(missing)} pictures, {each:.2f} s each", end="", flush=True)
    write_index(options.output, options.count)
    print(f"\n{options.output / 'dataset.json'} lists {options.count} pictures")


if __name__ == "__main__":
    main()
