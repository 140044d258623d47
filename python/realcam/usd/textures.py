"""Textures of UsdPreviewSurface: UsdUVTexture nodes and the pictures that glTF needs in their place.

glTF has fixed channels (roughness in green, metallic in blue, opacity in the alpha of the colour), colours in sRGB, and
neither scale nor bias. Where a UsdUVTexture fits, its file is used as it is; otherwise a picture is computed.
"""

from __future__ import annotations

import math
import tempfile
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..rec709 import linear_of_srgb
from .assets import Asset
from .glb import Glb, Json

Floats = NDArray[np.float64]

_CHANNELS = {"r": 0, "g": 1, "b": 2, "a": 3}
_WRAPS = {"repeat": 10497, "clamp": 33071, "mirror": 33648}
_MAX_PIXELS = 1 << 28  # kMaxTexturePixels of cpp/io/scene/decoded_image.hpp


@dataclass(frozen=True)
class Mapping:
    """Mapping of a primvar to a picture. primvar: name of the texture coordinates. scale, rotation_deg, translation:
    UsdTransform2d, applied in this order. wraps: "repeat", "clamp" or "mirror" along s and t."""

    primvar: str
    scale: tuple[float, float] = (1.0, 1.0)
    rotation_deg: float = 0.0
    translation: tuple[float, float] = (0.0, 0.0)
    wraps: tuple[str, str] = ("repeat", "repeat")

    def transform(self) -> Json:
        """Returns KHR_texture_transform. glTF measures v downwards, so that v = 1 - t."""
        angle = math.radians(self.rotation_deg)
        sine, cosine = math.sin(angle), math.cos(angle)
        (_, scale_t), (shift_s, shift_t) = self.scale, self.translation
        offset = [shift_s - scale_t * sine, 1 - shift_t - scale_t * cosine]
        return {"scale": list(self.scale), "rotation": angle, "offset": offset}


class Picture:
    """A picture file as a stage reads it."""

    def __init__(self, asset: Asset) -> None:
        self.asset = asset

    @cached_property
    def values(self) -> NDArray[np.uint8] | NDArray[np.float32]:
        """The stored values, (H, W, 4). Raises ImageFileError."""
        return _core._read_texture(self.asset.path, self.asset.data)

    @cached_property
    def channel_count(self) -> int:
        """Number of channels of the file: 1 for grey, 3 for RGB."""
        values = self.values  # a broken file must not reach OpenImageIO
        import OpenImageIO as oiio

        if self.asset.data:
            return 3 if (values[..., 0] != values[..., 1]).any() else 1
        opened = oiio.ImageInput.open(self.asset.path)
        return int(opened.spec().nchannels) if opened else 3

    def is_srgb(self, space: str) -> bool:
        """True if sourceColorSpace decodes the picture from sRGB. "auto": pictures of 8 bits with three or four
        channels."""
        if space != "auto":
            return space == "sRGB"
        return self.values.dtype == np.uint8 and self.channel_count >= 3


@dataclass(frozen=True)
class Sampled:
    """An output of a UsdUVTexture. output: "rgb", "r", "g", "b" or "a". scale, bias: of the four channels."""

    picture: Picture
    output: str
    mapping: Mapping
    scale: tuple[float, ...] = (1.0,) * 4
    bias: tuple[float, ...] = (0.0,) * 4
    space: str = "auto"

    @property
    def channels(self) -> list[int]:
        return [0, 1, 2] if self.output == "rgb" else [_CHANNELS[self.output]]

    def has_identity(self) -> bool:
        """True if scale and bias change nothing in the channels of the output."""
        return all(self.scale[c] == 1 and self.bias[c] == 0 for c in self.channels)

    def linear(self) -> Floats:
        """Returns the linear values of the output, (H, W, 1 or 3)."""
        values = self.picture.values[..., self.channels].astype(np.float64)
        if self.picture.values.dtype == np.uint8:
            values /= 255
        if self.picture.is_srgb(self.space):
            is_colour = np.array(self.channels) < 3  # alpha is always linear
            values = np.where(is_colour, linear_of_srgb(values), values)
        return np.asarray(values * np.array(self.scale)[self.channels] + np.array(self.bias)[self.channels])


@dataclass
class Pictures:
    """Pictures of the document, each added once."""

    glb: Glb
    _files: dict[Asset, Picture] = field(default_factory=dict)
    _images: dict[Any, int] = field(default_factory=dict)
    _samplers: dict[tuple[str, str], int] = field(default_factory=dict)

    def picture(self, asset: Asset) -> Picture:
        return self._files.setdefault(asset, Picture(asset))

    def file_texture(self, sampled: Sampled, uv_set: int) -> Json:
        """Returns glTF's textureInfo for the file of a texture, unchanged."""
        asset = sampled.picture.asset
        if asset not in self._images:
            if asset.data:
                self._images[asset] = self._embedded(asset.data, asset.name)
            else:
                self._images[asset] = self.glb.add("images", {"uri": asset.path})
        return self._info(self._images[asset], sampled.mapping, uv_set)

    def computed_texture(self, key: Any, values: Floats, name: str, mapping: Mapping, uv_set: int) -> Json:
        """Returns glTF's textureInfo for computed values from 0 to 1, (H, W, 3 or 4). key: identifies them."""
        if key not in self._images:
            self._images[key] = self._embedded(_png(values), name)
        return self._info(self._images[key], mapping, uv_set)

    def _embedded(self, data: bytes, name: str) -> int:
        kind = "image/png" if data.startswith(b"\x89PNG") else "image/jpeg"
        return self.glb.add("images", {"bufferView": self.glb.view(data), "mimeType": kind, "name": name})

    def _info(self, image: int, mapping: Mapping, uv_set: int) -> Json:
        if mapping.wraps not in self._samplers:
            wrap_s, wrap_t = (_WRAPS[wrap] for wrap in mapping.wraps)
            self._samplers[mapping.wraps] = self.glb.add("samplers", {"wrapS": wrap_s, "wrapT": wrap_t})
        texture = self.glb.add("textures", {"source": image, "sampler": self._samplers[mapping.wraps]})
        info: Json = {"index": texture, "texCoord": uv_set}
        if mapping.transform() != Mapping("").transform():
            info["extensions"] = {"KHR_texture_transform": mapping.transform()}
        return info


def same_size(parts: list[Floats]) -> list[Floats]:
    """Returns pictures, (H, W, C), with the size of the largest one; others repeat their nearest pixels."""
    height, width = max(p.shape[0] for p in parts), max(p.shape[1] for p in parts)

    def scaled(part: Floats) -> Floats:
        rows = (np.arange(height) + 0.5) * part.shape[0] / height
        columns = (np.arange(width) + 0.5) * part.shape[1] / width
        return np.asarray(part[rows.astype(int)][:, columns.astype(int)])

    if height * width > _MAX_PIXELS:
        raise ValueError("a computed texture would be too large")
    return [scaled(part) for part in parts]


def _png(values: Floats) -> bytes:
    """Returns values from 0 to 1 as a PNG of 16 bits."""
    import OpenImageIO as oiio

    height, width, channels = values.shape
    with tempfile.TemporaryDirectory(prefix="realcam-") as folder:
        path = Path(folder, "texture.png")
        output = oiio.ImageOutput.create("png")
        spec = oiio.ImageSpec(width, height, channels, "uint16")
        spec.attribute("oiio:UnassociatedAlpha", 1)
        spec.attribute("png:compressionLevel", 1)
        codes = np.round(np.clip(np.nan_to_num(values), 0, 1) * 65535).astype(np.uint16)
        if not output or not output.open(str(path), spec) or not output.write_image(codes) or not output.close():
            raise OSError("a computed texture cannot be written")
        return path.read_bytes()
