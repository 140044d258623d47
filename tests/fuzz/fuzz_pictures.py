"""Changes picture files, and reads them as light and as a texture: each must become pixels, or an error in one line.

See many_mutations.py. It is what the wheel reads pictures with: the core, and the Python package OpenImageIO. The
target `picture` of `./run fuzz scenes` is the same for the C++ library.
"""

from __future__ import annotations

import random
import sys
import tempfile
import traceback
import warnings
from functools import cache
from pathlib import Path

import numpy as np
from many_mutations import Target, main

# Suffix, channels, type, compression (empty: the format's own) and whether in tiles.
KINDS = (
    ("png", 4, "uint8", "", False),
    ("png", 1, "uint16", "", False),
    ("jpg", 3, "uint8", "", False),
    ("exr", 3, "half", "zip", False),
    ("exr", 4, "float", "none", False),
    ("exr", 3, "half", "piz", False),
    ("exr", 3, "half", "pxr24", True),
    ("exr", 3, "half", "b44", False),
    ("exr", 3, "half", "dwaa", False),
    ("exr", 1, "float", "rle", False),
    ("hdr", 3, "float", "", False),
    ("tif", 3, "uint8", "zip", False),
    ("tif", 4, "float", "lzw", True),
    ("tif", 1, "uint16", "none", False),
    ("bmp", 3, "uint8", "", False),
    ("tga", 4, "uint8", "rle", False),
    ("webp", 3, "uint8", "webp:90", False),
    ("webp", 4, "uint8", "lossless", False),
)
Picture = tuple[str, bytes]  # suffix and contents

OBJECT = """mtllib seed.mtl
v 0 0 0
v 1 0 0
v 0 1 0
vt 0 0
vt 1 0
vt 0 1
usemtl paper
f 1/1 2/2 3/3
"""


def seeds() -> list[Picture]:
    return [picture_of(*kind) for kind in KINDS]


def picture_of(suffix: str, channels: int, kind: str, compression: str, tiled: bool) -> Picture:
    import OpenImageIO as oiio

    spec = oiio.ImageSpec(24, 18, channels, kind)
    if compression:
        spec.attribute("compression", compression)
    if tiled:
        spec.tile_width = spec.tile_height = 16
    pixels = (0.5 + 0.4 * np.sin(0.1 * np.arange(18 * 24 * channels))).astype(np.float32)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, f"made.{suffix}")
        output = oiio.ImageOutput.create(str(path))
        if not output.open(str(path), spec) or not output.write_image(pixels.reshape(18, 24, channels)):
            raise RuntimeError(f"a seed cannot be written: {suffix}: {output.geterror()}")
        output.close()
        return suffix, path.read_bytes()


def case_of(pictures: list[Picture], seed: int, number: int) -> Picture:
    draw = random.Random(seed * 2**40 + number)
    suffix, contents = pictures[number % len(pictures)]
    changed = bytearray(contents)
    for _ in range(draw.randint(1, 8)):
        mutate(changed, draw)
    return suffix, bytes(changed)


def mutate(data: bytearray, draw: random.Random) -> None:
    if not data:
        data += b"\n"
    # Half of the mutations are in the header, which has most of the fields that a reader trusts.
    at = draw.randrange(min(len(data), 400) if draw.random() < 0.5 else len(data))
    length = draw.randint(1, 32)
    other = draw.randrange(len(data))
    match draw.randrange(8):
        case 0:
            data[at] = draw.randrange(256)
        case 1:
            data[at] ^= 1 << draw.randrange(8)
        case 2:  # a number at an extreme
            first, others = draw.choice((0, 1, 0x7F, 0x80, 0xFF)), draw.choice((0, 0xFF))
            others_count = draw.choice((0, 1, 3, 7))
            data[at : at + 1 + others_count] = bytes([first, *[others] * others_count])
        case 3:
            del data[at : at + length]
        case 4:
            data[at:at] = data[other : other + length]
        case 5:
            data[at : at + length] = data[other : other + length]
        case 6:  # a number a little larger or smaller
            data[at] = (data[at] + draw.randint(-8, 8)) % 256
        case _:
            del data[at:]


@cache
def scratch() -> tempfile.TemporaryDirectory[str]:
    """Kept until the process ends."""
    return tempfile.TemporaryDirectory(prefix="realcam-fuzz-")


def read(case: Picture) -> tuple[str, str]:
    suffix, contents = case
    folder = Path(scratch().name)
    picture = folder / f"seed.{suffix}"
    picture.write_bytes(contents)
    (folder / "seed.mtl").write_text(f"newmtl paper\nmap_Kd {picture.name}\n")
    (folder / "seed.obj").write_text(OBJECT)
    try:
        outcomes = {as_environment(picture), as_texture(folder / "seed.obj")}
    except BaseException:
        return "broken", traceback.format_exc(limit=-3)
    broken = [outcome for outcome in outcomes if outcome not in ("read", "refused")]
    return ("broken", "; ".join(broken)) if broken else ("read" if "read" in outcomes else "refused", "")


def as_environment(picture: Path) -> str:
    import realcam as rc

    with warnings.catch_warnings(record=True):
        warnings.simplefilter("always")
        try:
            pixels = rc.read_environment(picture)
        except rc.ImageFileError as error:
            return "refused" if is_one_line(str(error)) else f"a message of several lines, or a long one: {error}"
    return "read" if ((pixels >= 0) & (pixels <= 1e20)).all() else "an environment has light that is none"


def as_texture(scene: Path) -> str:
    """A picture that cannot be read leaves its material without a texture, and is told in a warning of the scene."""
    import realcam as rc

    told = rc.Scene.load(scene).warnings
    if not all(map(is_one_line, told)):
        return f"a warning of several lines, or a long one: {told}"
    return "refused" if told else "read"


def is_one_line(text: str) -> bool:
    return "\n" not in text and len(text) < 2500


if __name__ == "__main__":
    sys.exit(main(__doc__ or "", __file__, Target("pictures", seeds, case_of, read)))
