"""Look-up textures of Omniverse (OmniLensDistortionLutAPI), read from OpenEXR files beside the USD file."""

from __future__ import annotations

from pathlib import PurePosixPath

import numpy as np

from ..arrays import Array
from ..files.document import Document
from ..models.texture_model import TextureModel

LARGEST = 8192  # texels along a side


def lut_model(document: Document, enter: str, exit_: str, size: tuple[int, int]) -> TextureModel:
    """Returns the model of a ray_enter_direction and a ray_exit_position texture for a picture's size."""
    directions = _texture(document, enter, 3)
    positions = _texture(document, exit_, 2)
    # USD's camera looks along -z with y up: rows of octahedral coordinates begin at the bottom.
    return TextureModel(directions * [1.0, -1.0, -1.0], positions[::-1], np.diag([size[0], size[1], 1.0]))


def _texture(document: Document, name: str, channels: int) -> Array:
    relative = PurePosixPath(name)
    if relative.is_absolute() or ".." in relative.parts or "\\" in name or ":" in name:
        document.fail(f'the texture "{name:.60}" must lie in the folder of the file, or below it')
    path = document.path.parent / relative
    if not path.resolve().is_relative_to(document.path.parent.resolve()):
        document.fail(f'the texture "{name:.60}" must lie in the folder of the file, or below it')
    import OpenImageIO as oiio  # slow to load

    opened = oiio.ImageInput.open(str(path))
    if opened is None:
        document.fail(f'the texture "{name:.60}" cannot be read: {oiio.geterror():.80}'.replace("\n", " "))
    try:
        spec = opened.spec()
        if not (spec.nchannels >= channels and 2 <= spec.width <= LARGEST and 2 <= spec.height <= LARGEST):
            document.fail(f'the texture "{name:.60}": expected {channels} channels and 2 to {LARGEST} texels a side')
        pixels = opened.read_image(0, 0, 0, channels, oiio.FLOAT)
    finally:
        opened.close()
    if pixels is None or not np.isfinite(pixels).all():
        document.fail(f'the texture "{name:.60}" is damaged or holds values that are not finite')
    values: Array = np.asarray(pixels, dtype=float).reshape(spec.height, spec.width, channels)
    return values
