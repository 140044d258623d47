"""PNG encoding and decoding with OpenImageIO."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
import OpenImageIO as oiio


def png_bytes(codes: np.ndarray) -> bytes:
    """Encodes (H, W) or (H, W, 3) uint8 as PNG; three channels are sRGB."""
    channels = np.ascontiguousarray(codes if codes.ndim == 3 else codes[..., None])
    height, width, count = channels.shape
    spec = oiio.ImageSpec(width, height, count, oiio.UINT8)
    spec.attribute("png:compressionLevel", 3)  # faster than the default 6, for slightly larger files
    if count == 3:
        spec.attribute("oiio:ColorSpace", "sRGB")
    with tempfile.TemporaryDirectory(prefix="realcam-") as folder:
        path = Path(folder, "picture.png")
        output = oiio.ImageOutput.create("png")
        if output is None or not (output.open(str(path), spec) and output.write_image(channels) and output.close()):
            raise OSError(0, output.geterror() if output else oiio.geterror(), str(path))
        return path.read_bytes()


def codes_of(png: bytes) -> np.ndarray:
    """Decodes a PNG file to (H, W) or (H, W, channels) uint8. Raises ValueError."""
    with tempfile.TemporaryDirectory(prefix="realcam-") as folder:
        path = Path(folder, "picture.png")
        path.write_bytes(png)
        opened = oiio.ImageInput.open(str(path))
        if opened is None:
            raise ValueError(oiio.geterror())
        codes = opened.read_image(oiio.UINT8)
        opened.close()
    if codes is None:
        raise ValueError("this is not a complete picture")
    return codes[..., 0] if codes.shape[2] == 1 else codes
