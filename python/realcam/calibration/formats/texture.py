"""Look-up textures of Omniverse (OmniLensDistortionLutAPI) in OpenEXR files beside the USD file.

USD's camera looks along -z with y up: rows of octahedral coordinates begin at the bottom.
"""

from __future__ import annotations

from pathlib import PurePosixPath

import numpy as np

from ..arrays import Array
from ..files.document import Document
from ..files.exr import exr_content, exr_values
from ..models.texture_model import TextureModel, octahedral_directions
from ..resampling import pixel_centres
from ..stated_camera import StatedCamera

TO_USD = np.array([1.0, -1.0, -1.0])  # from realcam's camera axes


def lut_model(document: Document, enter: str, exit_: str, size: tuple[int, int]) -> TextureModel:
    """Returns the model of a ray_enter_direction and a ray_exit_position texture for a picture's size."""
    directions = _texture(document, enter, 3)
    positions = _texture(document, exit_, 2)
    return TextureModel(directions * TO_USD, positions[::-1], np.diag([size[0], size[1], 1.0]))


def lut_contents(camera: StatedCamera) -> tuple[bytes, bytes]:
    """Returns the files of the ray_enter_direction and the ray_exit_position texture.

    Both are as large as the picture, as smaller ones are wrong by pixels when they are read bilinearly.
    """
    model = camera.camera_model
    if not isinstance(model, TextureModel) or not np.array_equal(model.matrix, np.diag([*camera.size, 1.0])):
        model = TextureModel(_directions(camera), _positions(camera), np.diag([*camera.size, 1.0]))
    return exr_content(model.directions * TO_USD, "RGB"), exr_content(model.positions[::-1], "RG")


def _directions(camera: StatedCamera) -> Array:
    rays, _ = camera.camera_model.ray(pixel_centres(camera.size))
    rays[np.isnan(rays[:, 0])] = (0, 0, -1)  # the mark of texels without a ray
    directions: Array = rays.reshape(camera.size[1], camera.size[0], 3)
    return directions


def _positions(camera: StatedCamera) -> Array:
    side = max(camera.size)
    pixels, status = camera.camera_model.project(octahedral_directions(side))
    positions = pixels / np.array(camera.size, dtype=float)
    with np.errstate(invalid="ignore"):
        # Positions somewhat beside the picture let readers interpolate up to its edges; far ones do not matter.
        is_hidden = (status != 0) | ~((positions >= 0) & (positions < 2)).all(axis=1)
    positions[is_hidden] = -1
    texture: Array = positions.reshape(side, side, 2)
    return texture


def _texture(document: Document, name: str, channels: int) -> Array:
    relative = PurePosixPath(name)
    if relative.is_absolute() or ".." in relative.parts or "\\" in name or ":" in name:
        document.fail(f'the texture "{name:.60}" must lie in the folder of the file, or below it')
    path = document.path.parent / relative
    if not path.resolve().is_relative_to(document.path.parent.resolve()):
        document.fail(f'the texture "{name:.60}" must lie in the folder of the file, or below it')
    return exr_values(path, channels, lambda reason: document.fail(f'the texture "{name:.60}": {reason}'))
