"""Pictures on disk, through OpenImageIO."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import OpenImageIO as oiio

from ._core import ImageFileError

Attributes = Mapping[str, str | int | float]


def read_texture(path: str, encoded: bytes) -> np.ndarray | None:
    """Decodes a texture from a file, or from the bytes of one where path is empty.

    Returns (H, W, 4) uint8, sRGB, row 0 at the top; None where it cannot be decoded.
    """
    if path:
        return _rgba8(oiio.ImageBuf(path)) if Path(path).is_file() else None
    # OpenImageIO's Python side reads files only.
    with tempfile.NamedTemporaryFile(suffix=_suffix_of(encoded)) as file:
        file.write(encoded)
        file.flush()
        return _rgba8(oiio.ImageBuf(file.name))


def _suffix_of(encoded: bytes) -> str:
    return ".jpg" if encoded.startswith(b"\xff\xd8") else ".png"


def _rgba8(buffer: oiio.ImageBuf) -> np.ndarray | None:
    pixels = buffer.get_pixels(oiio.UINT8) if not buffer.has_error else None
    # geterror() takes the error away; left in the buffer, it would be printed when the buffer goes.
    if buffer.geterror() or pixels is None or pixels.ndim != 3:
        return None
    channels = pixels.shape[2]
    grey = pixels[..., :1].repeat(3, axis=2)
    colour = pixels[..., :3] if channels >= 3 else grey
    alpha = pixels[..., -1:] if channels in (2, 4) else np.full_like(pixels[..., :1], 255)
    return np.ascontiguousarray(np.concatenate([colour, alpha], axis=2))


def read_environment(path: str | os.PathLike[str]) -> np.ndarray:
    """A latitude-longitude image as (H, W, 3) float32, linear. Raises ImageFileError."""
    name = os.fspath(path)
    if not Path(name).is_file():
        raise ImageFileError(f"{name}: there is no such file; an environment image (.exr, .hdr, .png) is wanted")
    buffer = oiio.ImageBuf(name)
    pixels = buffer.get_pixels(oiio.FLOAT)
    if buffer.has_error or pixels is None:
        raise ImageFileError(f"{name}: cannot be read as an image: {buffer.geterror()}")
    pixels = pixels[..., :3] if pixels.shape[2] >= 3 else pixels[..., :1].repeat(3, axis=2)
    if buffer.spec().format.basetype == oiio.UINT8:  # codes for a screen, not light
        pixels = np.where(pixels <= 0.04045, pixels / 12.92, ((pixels + 0.055) / 1.055) ** 2.4)
    return np.ascontiguousarray(pixels, dtype=np.float32)


def check_folder(path: str | os.PathLike[str]) -> None:
    """Raises ImageFileError where no file of this name can be made."""
    folder = Path(path).parent
    if not folder.is_dir():
        raise ImageFileError(f"{os.fspath(path)}: the folder {folder} does not exist")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise ImageFileError(f"{os.fspath(path)}: the folder {folder} is not writable")
    if Path(path).is_dir():
        raise ImageFileError(f"{os.fspath(path)}: is a folder; the name of a file is wanted")


def check_writable(path: str | os.PathLike[str]) -> None:
    """Raises ImageFileError where write_image could not write: before the work, not after it."""
    if Path(path).suffix.lower() not in (".png", ".exr"):
        name = os.fspath(path)
        raise ImageFileError(f"{name}: unknown suffix; .png (for the screen) or .exr (film exposure) is wanted")
    check_folder(path)


def publish(temporary: str, path: str | os.PathLike[str]) -> None:
    """Gives a finished temporary file its name, and the permissions that a new file gets."""
    umask = os.umask(0)
    os.umask(umask)
    Path(temporary).chmod(0o666 & ~umask)  # mkstemp makes private files
    Path(temporary).replace(path)


def _check_complete(temporary: str, name: str, shape: tuple[int, ...]) -> None:
    """Reads the file back: OpenImageIO does not say so when a disk is full while it writes a PNG."""
    buffer = oiio.ImageBuf(temporary)
    pixels = buffer.get_pixels()
    error = buffer.geterror()
    if error or pixels is None or pixels.shape != shape:
        raise ImageFileError(f"{name}: cannot be written completely; is the disk full?")


def write_image(
    path: str | os.PathLike[str], pixels: np.ndarray, channels: tuple[str, ...], attributes: Attributes
) -> None:
    """Writes (H, W, C) uint8 or float32 pixels with named channels.

    The file appears under its name when it is complete; nothing is left behind otherwise. Raises ImageFileError.
    """
    name = os.fspath(path)
    check_writable(name)
    spec = oiio.ImageSpec(
        pixels.shape[1],
        pixels.shape[0],
        pixels.shape[2],
        oiio.UINT8 if pixels.dtype == np.uint8 else oiio.FLOAT,
    )
    spec.channelnames = channels
    for key, value in attributes.items():
        spec.attribute(key, value)
    handle, temporary = tempfile.mkstemp(dir=Path(name).parent, prefix=".", suffix=Path(name).suffix)
    os.close(handle)
    try:
        output = oiio.ImageOutput.create(temporary)
        if output is None:
            raise ImageFileError(f"{name}: {oiio.geterror()}")
        if not (output.open(temporary, spec) and output.write_image(np.ascontiguousarray(pixels)) and output.close()):
            raise ImageFileError(f"{name}: cannot be written: {output.geterror()}")
        _check_complete(temporary, name, pixels.shape)
        publish(temporary, name)
    finally:
        Path(temporary).unlink(missing_ok=True)
