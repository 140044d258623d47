"""Renders the pictures of docs/datasets.md, dual-pixels.md, rigs.md and many-machines.md.

    python tools/data_pictures.py FOLDER

Writes datasets.jpg, dual-pixels.jpg, rigs.jpg and many-machines.jpg. Takes about two minutes of CPU time.
"""

from __future__ import annotations

import dataclasses
import sys
import tempfile
from itertools import product
from pathlib import Path

import numpy as np
import realcam as rc
from matplotlib import colormaps
from matplotlib.colors import hsv_to_rgb
from PIL import Image, ImageDraw
from realcam import dataset

SCENE = Path(__file__).resolve().parent.parent / "scenes" / "demo.glb"
SIZE = (330, 220)  # of the demo pictures, pixels
TILE = 55  # side of the tiles of divided(), pixels


def save(path: Path, *pictures: np.ndarray) -> None:
    """Writes pictures (H, W, 3) uint8 side by side."""
    gap = np.full((len(pictures[0]), 6, 3), 255, np.uint8)
    parts = [part for picture in pictures for part in (gap, picture)][1:]
    Image.fromarray(np.concatenate(parts, axis=1)).save(path, quality=88)


def demo() -> tuple[rc.Scene, rc.Camera]:
    """The demo scene at dusk, and a camera with a fast lens."""
    scene = rc.Scene.load(SCENE).with_environment((20.0, 28.0, 46.0))
    camera = rc.Camera(
        rc.Lens.load("fast-50mm").focused(0.9),
        film=rc.Film(36, 24, SIZE),
        position=(0.0, 0.25, 1.1),
        look_at=(0.0, 0.12, 0.0),
        exposure_time_s=0.01,
    )
    return scene, camera


def labelled() -> list[np.ndarray]:
    """A picture of a data set with bounding boxes, and its depth, mask and optical flow as colours."""
    size = (240, 180)
    recipe = dataset.Recipe(count=1, size=size, lenses=("double-gauss-50mm",), speed_m_s=(1, 2), spp=128, seed=3)
    recipe = dataclasses.replace(recipe, labels=("depth", "mask", "flow"))
    with tempfile.TemporaryDirectory() as folder:
        dataset.make(recipe, folder)
        sample = next(dataset.samples(folder))
    boxed = Image.fromarray(sample["png"])
    for visible in sample["json"]["objects"]:
        column, row, width, height = visible["box"]
        ImageDraw.Draw(boxed).rectangle((column, row, column + width - 1, row + height - 1), outline=(255, 210, 0))
    inverse_depth = 1 / sample["depth.npy"]
    depth = colormaps["viridis"](inverse_depth / inverse_depth.max())[..., :3]
    mask = colormaps["tab10"](sample["mask.png"])[..., :3]
    across, down = np.moveaxis(np.nan_to_num(sample["flow.npy"]), -1, 0)
    speed = np.hypot(across, down)
    hue = np.arctan2(down, across) / (2 * np.pi) % 1
    flow = hsv_to_rgb(np.stack([hue, np.minimum(1, speed / np.percentile(speed, 98)), np.ones_like(hue)], axis=-1))
    return [np.asarray(boxed), *(np.uint8(255 * each) for each in (depth, mask, flow))]


def halves() -> list[np.ndarray]:
    """Pictures of the left and the right half pixels, and their anaglyph: left in red, right in green and blue."""
    image = rc.render(*demo(), effects=(), spp=256, layers=["dual_pixel_left", "dual_pixel_right"])
    # Each half pixel receives half of the light.
    left, right = (
        np.asarray(dataclasses.replace(image, pixels=2 * image.layers[f"dual_pixel_{side}"]).developed())
        for side in ("left", "right")
    )
    return [left, right, np.concatenate([left[..., :1], right[..., 1:]], axis=-1)]


def stereo() -> list[np.ndarray]:
    """Left and right picture of a stereo rig."""
    scene, camera = demo()
    camera = camera.replace(lens=camera.lens.stopped_down(8), exposure_time_s=0.4)
    pictures = rc.Rig.stereo(camera, baseline_m=0.12).render(scene, spp=96, effects=())
    return [np.asarray(pictures[side].developed()) for side in ("left", "right")]


def divided() -> list[np.ndarray]:
    """A picture with half of its tiles, and the complete one with traced light."""
    session = rc.Session(*demo(), spp=96, effects=())
    tiles = list(product(range(0, SIZE[1], TILE), range(0, SIZE[0], TILE)))
    parts = [session.expose((column, row, TILE, TILE), 0, 96) for row, column in tiles]
    np.random.default_rng(1).shuffle(parts)
    traced_light = session.expose_traced_light(0, 96)
    return [
        np.asarray(session.image_of(some).developed()) for some in (parts[: len(parts) // 2], [*parts, traced_light])
    ]


def main(folder: Path) -> None:
    save(folder / "datasets.jpg", *labelled())
    save(folder / "dual-pixels.jpg", *halves())
    save(folder / "rigs.jpg", *stereo())
    save(folder / "many-machines.jpg", *divided())


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python tools/data_pictures.py FOLDER")
    main(Path(sys.argv[1]))
