"""One picture of a data set with its labels."""

from __future__ import annotations

import io
import json
import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np

from .._core import Camera, RenderSettings, Sensor
from ..image import Image
from ..render import render
from ..vision import camera_json, fit_camera_model, flow
from .pictures import png_bytes
from .recipe import Recipe
from .scenes import RandomScene, random_camera, random_scene

LAYERS = {"depth": "depth_middle", "mask": "object_id", "motion": "motion"}
SEED_OFFSET = 2**31  # difference of the seeds of a picture and the next one, whose noise must be independent
MAX_TANGENT_MODEL_DEG = 120.0  # largest diagonal field of view that is fitted with a model of the angle's tangent


def make_sample(recipe: Recipe, number: int, device: str, threads: int) -> dict[str, bytes]:
    """Renders a picture with its labels. Returns its files by their suffix, the part after the key and a dot."""
    rng = np.random.default_rng([recipe.seed, number])
    seen = random_scene(recipe, rng)
    camera = random_camera(recipe, seen, rng).metered(seen.scene, device=device)
    layers = {"object_id", *(LAYERS[label] for label in recipe.labels if label in LAYERS)}
    wants_flow = "flow" in recipe.labels

    def rendered(picture_camera: Camera, seed: int) -> Image:
        all_layers = layers.union(flow.LAYERS) if wants_flow else layers
        settings = RenderSettings(spp=recipe.spp, seed=seed, threads=threads, layers=sorted(all_layers), effects=())
        return render(seen.scene, picture_camera, settings, device=device)

    image = rendered(camera, number)
    files = {"png": png_bytes(_sensed(recipe, image, number))}
    for label in recipe.labels:
        if label == "flow":
            next_seed = (number + SEED_OFFSET) % 2**32
            next_image = rendered(camera.replace(shutter_opens_s=recipe.next_after_s), next_seed)
            to_next = flow.flow_between(image, next_image, seen.scene)
            files["next.png"] = png_bytes(_sensed(recipe, next_image, next_seed))
            files["flow.npy"] = _npy(to_next.pixels)
            files["flow_visible.png"] = png_bytes(np.where(to_next.visible, 255, 0).astype(np.uint8))
        elif label == "mask":
            files["mask.png"] = png_bytes(image.layers["object_id"].astype(np.uint8))
        else:
            files[f"{label}.npy"] = _npy(image.layers[LAYERS[label]].astype(np.float32))
    files["json"] = json.dumps(_labels(recipe, seen, camera, image)).encode()
    return files


def _sensed(recipe: Recipe, image: Image, number: int) -> np.ndarray:
    """Simulates the sensor at the camera's ISO, or the closest ISO that the sensor has, and develops its raw image."""
    film = image.camera.film
    pitch_um = 1000 * film.width_mm / film.resolution[0]
    sensor = Sensor.load(recipe.sensor)
    if sensor.pixel_pitch_um is not None:  # same noise model, but with the film's pixel pitch
        sensor = sensor.replace(pixel_pitch_um=pitch_um, resolution=film.resolution)
    lowest, highest = sensor.iso_range(pitch_um)
    iso = image.camera.iso if lowest == 0 else float(np.clip(image.camera.iso, 1.001 * lowest, 0.999 * highest))
    raw = sensor.expose(image, iso=iso, seed=number)
    return raw.developed("film", iso=image.camera.iso, demosaic="bilinear")


def _npy(array: np.ndarray) -> bytes:
    """Returns the content of an .npy file."""
    content = io.BytesIO()
    np.save(content, array)
    return content.getvalue()


def _labels(recipe: Recipe, seen: RandomScene, camera: Camera, image: Image) -> dict[str, Any]:
    """Returns the content of the label file: the camera, its fitted model, the objects and the calibration board."""
    is_wide = camera.field_of_view_deg.diagonal > MAX_TANGENT_MODEL_DEG
    still = camera.replace(motion=[])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        label = camera_json(camera, [fit_camera_model(still, "fisheye" if is_wide else "opencv5")])
    label["objects"] = list(_objects(seen, camera, image))
    if seen.board_m is not None:
        corners = camera.project(seen.board_m)
        board_id = len(seen.categories) + 2
        label["board"] = {
            "squares": list(recipe.board),
            "square_m": recipe.square_m,
            "corners_m": seen.board_m.tolist(),
            "corners_px": [None if np.isnan(corner).any() else corner.tolist() for corner in corners],
            "corners_visible": [_shows(image, corner, board_id) for corner in corners],
        }
    return label


def _shows(image: Image, pixel: np.ndarray, object_id: int) -> bool:
    """Returns True if the object is visible at a pixel position (column, row); False outside of the picture."""
    ids = image.layers["object_id"]
    if np.isnan(pixel).any() or not (0 <= pixel[0] < ids.shape[1] and 0 <= pixel[1] < ids.shape[0]):
        return False
    return bool(ids[int(pixel[1]), int(pixel[0])] == object_id)


def _objects(seen: RandomScene, camera: Camera, image: Image) -> Iterator[dict[str, Any]]:
    """Yields a label for each visible object.

    It has the object's box [x, y, width, height] and area in pixels, the projection of its centre ("middle"), and its
    mask as COCO's run lengths.
    """
    ids = image.layers["object_id"]
    centres = camera.project(seen.centres_m)
    for i, (category, centre) in enumerate(zip(seen.categories, centres, strict=True), start=2):
        mask = ids == i
        rows, columns = np.nonzero(mask)
        if len(rows):
            x, y = int(columns.min()), int(rows.min())
            yield {
                "id": i,
                "name": image.object_names[i],
                "category": category,
                "box": [x, y, int(columns.max()) + 1 - x, int(rows.max()) + 1 - y],
                "area": len(rows),
                "middle": [None, None] if np.isnan(centre).any() else centre.tolist(),
                "run_lengths": _run_lengths(mask),
            }


def _run_lengths(mask: np.ndarray) -> list[int]:
    """Returns the lengths of the mask's runs in column-major order, starting with the background (COCO)."""
    flat = mask.ravel(order="F")
    changes = np.flatnonzero(np.diff(flat)) + 1
    ends = [*changes.tolist(), flat.size]
    lengths: list[int] = np.diff([0, *ends]).tolist()
    return [0, *lengths] if flat[0] else lengths
