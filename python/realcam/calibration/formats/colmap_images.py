"""Poses of COLMAP's images.txt and images.bin. In the files they lead from the world to the camera's axes."""

from __future__ import annotations

import struct
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from pathlib import Path

from ..._core import InputError
from ..arrays import Array
from ..files.document import Document
from ..files.entries import Entries
from ..files.output import numbers
from ..transforms import inverse_of, quaternion, rigid
from .format import Saved

HEADS = {
    "cameras.txt": "CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]",
    "images.txt": "IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME; then a line of POINTS2D",
    "points3D.txt": "POINT3D_ID X Y Z R G B ERROR TRACK[]",
}
_Image = tuple[str, str, list[float]]  # camera, name of the picture, and QW to TZ


@lru_cache(maxsize=1)  # each camera of a file asks for its own
def poses_beside(document: Document) -> Mapping[str, Mapping[str, Array]]:
    """Returns the poses of pictures, camera to world, by camera and name; empty if there is no file of images."""
    path = document.path.with_name(f"images{document.suffix}")
    if document.suffix not in (".txt", ".bin") or not path.is_file():
        return {}
    images = Document(path)
    found: dict[str, dict[str, Array]] = {}
    for camera, name, pose in (_binary_images if document.suffix == ".bin" else _text_images)(images):
        if not any(pose[:4]):
            images.fail(f'image "{name:.60}": expected a quaternion that is not 0')
        found.setdefault(camera, {})[name] = inverse_of(rigid(pose[:4], pose[4:]))
    return found


def _text_images(document: Document) -> Iterator[_Image]:
    lines = iter(enumerate(document.text.splitlines(), 1))
    for i, line in lines:
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        next(lines, None)  # the points of the image, which may be none
        fields = line.split(maxsplit=9)
        if len(fields) < 10:
            document.fail(f"line {i}: expected IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME")
        pose = Entries(document, {"pose": fields[1:8]}, f"line {i}: ").numbers("pose", 7)
        yield fields[8], fields[9].strip(), pose


def _binary_images(document: Document) -> Iterator[_Image]:
    content = document.content
    try:
        (count,) = struct.unpack_from("<Q", content)
        position = 8
        for _ in range(count):
            _, *pose, camera = struct.unpack_from("<I7dI", content, position)
            end = content.index(b"\0", position + 64)
            name = content[position + 64 : end].decode(errors="replace")
            (points,) = struct.unpack_from("<Q", content, end + 1)
            position = end + 9 + 24 * points
            yield str(camera), name, Entries(document, {"pose": pose}, f"{name:.60}: ").numbers("pose", 7)
        if position != len(content):
            document.fail(f"expected {position} bytes for its images; it has {len(content)}")
    except (struct.error, ValueError):
        document.fail(f"ends before its last image, at byte {len(content)}")


def text_content(head: str, lines: Sequence[str]) -> bytes:
    """Returns a text file: a comment and its lines."""
    return "".join(f"{line}\n" for line in [f"# {head}", *lines]).encode()


def pose_text(camera_from_world: Array) -> str:
    """Returns QW QX QY QZ TX TY TZ."""
    return numbers([*quaternion(camera_from_world), *camera_from_world[:3, 3].tolist()])


def image_text(number: int, camera_from_world: Array, camera: int, name: str) -> str:
    """Returns the line of an image and an empty line of its points. Raises InputError for names with spaces."""
    if any(c.isspace() for c in name):
        raise InputError(f"names in COLMAP's text files must not contain spaces; one is {name!r:.60}")
    return f"{number} {pose_text(camera_from_world)} {camera} {_checked(name)}\n"


def _checked(name: str) -> str:
    if not name or "\0" in name:
        raise InputError(f"names in COLMAP's files must not be empty or contain NUL; one is {name!r:.60}")
    return name


def images_content(ids: Sequence[int], cameras: Sequence[Saved], path: Path) -> Mapping[Path, bytes]:
    """Returns the files of images and of points, which are empty, beside a file of cameras; none without poses.

    Raises InputError for names of pictures that the file cannot hold.
    """
    images = [
        (i, inverse_of(pose), number, name)
        for i, (number, name, pose) in enumerate(
            (
                (number, name, pose)
                for number, saved in zip(ids, cameras, strict=True)
                for name, pose in saved.camera.poses.items()
            ),
            start=1,
        )
    ]
    if not images:
        return {}
    if path.suffix.lower() == ".bin":
        content = b"".join(map(_binary_image, images))
        count = struct.pack("<Q", len(images))
        return {path.with_name("images.bin"): count + content, path.with_name("points3D.bin"): struct.pack("<Q", 0)}
    bodies = {"images.txt": [image_text(*image) for image in images], "points3D.txt": []}
    return {path.with_name(file): text_content(HEADS[file], lines) for file, lines in bodies.items()}


def _binary_image(image: tuple[int, Array, int, str]) -> bytes:
    number, pose, camera, name = image
    values = [*quaternion(pose), *pose[:3, 3].tolist()]
    return struct.pack("<I7dI", number, *values, camera) + _checked(name).encode() + b"\0" + struct.pack("<Q", 0)
