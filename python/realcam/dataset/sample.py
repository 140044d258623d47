"""One picture of a data set with its labels."""

from __future__ import annotations

import io
import json
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._core import Camera, RenderSettings, Sensor
from ..calibration import Calibration
from ..image import Image
from ..render import render
from ..vision import CameraModelFit, camera_json, fit_camera_model, flow
from .pictures import png_bytes
from .recipe import Recipe
from .scenes import RandomScene, random_cameras, random_scene

LAYERS = {"depth": "depth_middle", "mask": "object_id", "motion": "motion"}
SEED_OFFSET = 2**31  # difference of the seeds of a picture and the next one, whose noise must be independent
CAMERA_SEED_OFFSET = 2**21  # above the largest number of pictures: each camera of a rig has noise of its own
MAX_TANGENT_MODEL_DEG = 120.0  # largest diagonal field of view that is fitted with a model of the angle's tangent


def make_sample(recipe: Recipe, number: int, device: str, threads: int) -> dict[str, bytes]:
    """Renders a picture with its labels. Returns its files by their suffix, the part after the key and a dot."""
    rng = np.random.default_rng([recipe.seed, number])
    seen = random_scene(recipe, rng)
    cameras = random_cameras(recipe, seen, rng)
    first = next(iter(cameras))
    exposure_time_s = cameras[first].metered(seen.scene, device=device).exposure_time_s
    files: dict[str, bytes] = {}
    for serial, (name, camera) in enumerate(cameras.items()):
        camera = camera.replace(exposure_time_s=exposure_time_s)
        one = _Picture(recipe, seen, camera, recipe.calibrations.get(name if recipe.rig else recipe.calibration_camera))
        prefix = "" if name == first else f"{name}."
        made = one.files(number, serial, device, threads)
        files.update({prefix + suffix: content for suffix, content in made.items()})
    return files


@dataclass(frozen=True)
class _Picture:
    """A camera in a random scene. calibration: that of the camera; None: a model is fitted for its label."""

    recipe: Recipe
    seen: RandomScene
    camera: Camera
    calibration: Calibration | None

    def files(self, number: int, serial: int, device: str, threads: int) -> dict[str, bytes]:
        """Renders the picture with its labels, and returns its files by their suffix. serial: index of the camera."""
        recipe, camera, scene = self.recipe, self.camera, self.seen.scene
        layers = {"object_id", *(LAYERS[label] for label in recipe.labels if label in LAYERS)}
        wants_flow = "flow" in recipe.labels
        own_seed = number + serial * CAMERA_SEED_OFFSET

        def rendered(picture_camera: Camera, seed: int) -> Image:
            all_layers = layers.union(flow.LAYERS) if wants_flow else layers
            settings = RenderSettings(spp=recipe.spp, seed=seed, threads=threads, layers=sorted(all_layers), effects=())
            return render(scene, picture_camera, settings, device=device)

        image = rendered(camera, own_seed)
        files = {"png": png_bytes(_sensed(recipe, image, own_seed, serial))}
        for label in recipe.labels:
            if label == "flow":
                next_seed = (own_seed + SEED_OFFSET) % 2**32
                next_image = rendered(camera.replace(shutter_opens_s=recipe.next_after_s), next_seed)
                to_next = flow.flow_between(image, next_image, scene)
                files["next.png"] = png_bytes(_sensed(recipe, next_image, next_seed, serial))
                files["flow.npy"] = _npy(to_next.pixels)
                files["flow_visible.png"] = png_bytes(np.where(to_next.visible, 255, 0).astype(np.uint8))
            elif label == "mask":
                files["mask.png"] = png_bytes(image.layers["object_id"].astype(np.uint8))
            elif label == "depth" and recipe.depth == "ray":
                files["depth.npy"] = _npy(_distances_along_rays(image).astype(np.float32))
            else:
                files[f"{label}.npy"] = _npy(image.layers[LAYERS[label]].astype(np.float32))
        files["json"] = json.dumps(_labels(self, image)).encode()
        return files


def _distances_along_rays(image: Image) -> np.ndarray:
    """Returns the distances (H, W) in metres of the visible points from the centre of projection.

    They follow from depths along the axis, which do not depend on the camera's motion; inf and NaN stay.
    """
    camera = image.camera.replace(motion=[], position=(0, 0, 0), look_at=(0, 0, -1), up=(0, 1, 0))
    depth = image.layers["depth_middle"].astype(float)
    height, width = depth.shape
    centres = np.stack(np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5), axis=-1).reshape(-1, 2)
    origins, directions = camera.ray(centres)
    distances: np.ndarray = depth.ravel().copy()
    is_near = np.isfinite(distances) & (np.abs(directions[:, 2]) > 1e-9)  # a ray across the axis has no such depth
    from_origin = (-distances[is_near] - origins[is_near, 2]) / directions[is_near, 2]
    points = origins[is_near] + from_origin[:, None] * directions[is_near]
    distances[is_near] = np.linalg.norm(points - np.array(camera.entrance_pupil_position_m), axis=1)
    result: np.ndarray = distances.reshape(height, width)
    return result


def _sensed(recipe: Recipe, image: Image, seed: int, serial: int) -> np.ndarray:
    """Simulates the sensor at the camera's ISO, or the closest ISO that the sensor has, and develops its raw image.

    seed: of the noise. serial: index of the camera, each of which has its own fixed-pattern noise.
    """
    film = image.camera.film
    pitch_um = 1000 * film.width_mm / film.resolution[0]
    sensor = Sensor.load(recipe.sensor)
    if sensor.pixel_pitch_um is not None:  # same noise model, but with the film's pixel pitch
        sensor = sensor.replace(pixel_pitch_um=pitch_um, resolution=film.resolution)
    lowest, highest = sensor.iso_range(pitch_um)
    iso = image.camera.iso if lowest == 0 else float(np.clip(image.camera.iso, 1.001 * lowest, 0.999 * highest))
    raw = sensor.expose(image, iso=iso, seed=seed, serial=serial)
    return raw.developed("film", iso=image.camera.iso, demosaic="bilinear")


def _npy(array: np.ndarray) -> bytes:
    """Returns the content of an .npy file."""
    content = io.BytesIO()
    np.save(content, array)
    return content.getvalue()


def _labels(picture: _Picture, image: Image) -> dict[str, Any]:
    """Returns the content of the label file: the camera, its calibration or fitted model, the objects and the board."""
    recipe, seen, camera = picture.recipe, picture.seen, picture.camera
    label = camera_json(camera, _fits(camera) if picture.calibration is None else (), picture.calibration)
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


def _fits(camera: Camera) -> list[CameraModelFit]:
    is_wide = camera.field_of_view_deg.diagonal > MAX_TANGENT_MODEL_DEG
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return [fit_camera_model(camera.replace(motion=[]), "fisheye" if is_wide else "opencv5")]


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
