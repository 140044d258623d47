"""Radiance and OpenEXR files, written byte by byte as their formats describe them."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from pathlib import Path

import numpy as np


def rgbe(light: np.ndarray) -> np.ndarray:
    """(..., 3) light as (..., 4) bytes: mantissas below 256 times 2 to the exponent - 136."""
    most = light.max(axis=-1)
    _, power = np.frexp(np.maximum(most, 1e-38))
    mantissas = np.floor(light * np.exp2(8.0 - power)[..., None]).clip(0, 255)
    exponent = np.where(most > 0, power + 128, 0)
    return np.concatenate([mantissas, exponent[..., None]], axis=-1).astype(np.uint8)


def channels_in_runs(line: np.ndarray) -> bytes:
    """The newer run lengths: each of the four channels by itself, here with runs of one value and copies mixed."""
    data = struct.pack(">BBH", 2, 2, len(line))
    for channel in line.T:
        i = 0
        while i < len(channel):
            run = 1
            while i + run < len(channel) and run < 127 and channel[i + run] == channel[i]:
                run += 1
            data += bytes([128 + run, channel[i]]) if run > 1 else bytes([1, channel[i]])
            i += run
    return data


def pixels_in_runs(line: np.ndarray) -> bytes:
    """The older run lengths: 1 1 1 n repeats the pixel before, the next one in a row 256 times as often."""
    data, i = b"", 0
    while i < len(line):
        run = 1
        while i + run < len(line) and (line[i + run] == line[i]).all():
            run += 1
        data += line[i].tobytes()
        if run > 1:
            low, high = (run - 1) % 256, (run - 1) // 256
            data += bytes([1, 1, 1, low]) + (bytes([1, 1, 1, high]) if high else b"")
        i += run
    return data


def write_radiance(
    path: Path,
    light: np.ndarray,
    *,
    lines: Sequence[str] = (),
    resolution: str = "",
    kind: str = "rgbe",
    packed: str = "flat",
    first: str = "#?RADIANCE",
) -> None:
    """light: (lines, pixels of a line, 3), as they follow each other in the file."""
    height, width = light.shape[:2]
    header = [first, f"FORMAT=32-bit_rle_{kind}", *lines, "", resolution or f"-Y {height} +X {width}", ""]
    pack = {"flat": np.ndarray.tobytes, "channels": channels_in_runs, "pixels": pixels_in_runs}[packed]
    path.write_bytes("\n".join(header).encode() + b"".join(pack(line) for line in rgbe(light)))


def write_exr(
    path: Path,
    pixels: np.ndarray,
    *,
    data: tuple[int, int] = (0, 0),
    display: tuple[int, int, int, int] | None = None,
    chromaticities: Sequence[float] = (),
    envmap: int | None = None,
    texts: dict[str, bytes] | None = None,
) -> None:
    """(H, W, 3) as floats without compression. data: column and row of the first pixel; display: first and last column
    and row, as OpenEXR has them (x0, y0, x1, y1).
    """

    def attribute(name: str, kind: str, value: bytes) -> bytes:
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    height, width = pixels.shape[:2]
    window = (data[0], data[1], data[0] + width - 1, data[1] + height - 1)
    channels = b"".join(name + b"\0" + struct.pack("<iBBBBii", 2, 0, 0, 0, 0, 1, 1) for name in (b"B", b"G", b"R"))
    header = attribute("channels", "chlist", channels + b"\0") + attribute("compression", "compression", b"\0")
    header += attribute("dataWindow", "box2i", struct.pack("<4i", *window))
    header += attribute("displayWindow", "box2i", struct.pack("<4i", *(display or window)))
    header += attribute("lineOrder", "lineOrder", b"\0") + attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    header += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    header += attribute("screenWindowWidth", "float", struct.pack("<f", 1))
    if chromaticities:
        header += attribute("chromaticities", "chromaticities", struct.pack("<8f", *chromaticities))
    if envmap is not None:
        header += attribute("envmap", "envmap", bytes([envmap]))
    for name, text in (texts or {}).items():
        header += attribute(name, "string", text)
    begin = struct.pack("<ii", 20000630, 2) + header + b"\0"
    rows = [
        struct.pack("<ii", window[1] + y, 12 * width) + row[:, ::-1].T.astype("<f4").tobytes()
        for y, row in enumerate(pixels)
    ]
    offsets = np.cumsum([len(begin) + 8 * height] + [len(row) for row in rows[:-1]])
    path.write_bytes(begin + offsets.astype("<u8").tobytes() + b"".join(rows))


def write_exr_parts(path: Path, parts: Sequence[tuple[str, dict[str, np.ndarray]]]) -> None:
    """Parts of a name and channels, each an (H, W) array of float32 or uint32, through OpenImageIO; one part without a
    name is a file of a single part.
    """
    import OpenImageIO as oiio

    specs = []
    for name, channels in parts:
        first = next(iter(channels.values()))
        spec = oiio.ImageSpec(first.shape[1], first.shape[0], len(channels), str(first.dtype).replace("32", ""))
        spec.channelnames = tuple(channels)
        if name:
            spec.attribute("oiio:subimagename", name)
        specs.append(spec)
    output = oiio.ImageOutput.create(str(path))
    assert output.open(str(path), tuple(specs)) if len(specs) > 1 else output.open(str(path), specs[0])
    for i, (spec, (_, channels)) in enumerate(zip(specs, parts, strict=True)):
        if i > 0:
            assert output.open(str(path), spec, "AppendSubimage")
        assert output.write_image(np.stack(list(channels.values()), axis=-1))
    assert output.close()
