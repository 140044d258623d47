"""Adobe's lens profiles (.lcp). First pixel: 0.5 (inferred: the centre 0.5 is the picture's).

Source: Adobe Lens Profile Creator's technical report, "Camera model"; the polynomials map ideal to distorted points.
Focal lengths are in units of the longer side, centres in units of the width and height.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator

from ..files.document import Document
from ..files.entries import Entries
from ..models.central import camera_matrix
from ..models.opencv_models import fisheye_model, pinhole_model
from ..stated_camera import StatedCamera
from .format import Cameras, Format, Options, unknown_model

PREFIX = "stCamera:"
MODELS = {"PerspectiveModel": ("PerspectiveModel", 3), "FisheyeModel": ("FisheyeModel", 2)}


def _values(document: Document, element: ET.Element, where: str) -> Entries:
    """Returns the texts of children and attributes; profiles are written both ways."""
    values = {key.removeprefix(PREFIX): value for key, value in element.attrib.items()}
    for child in element:
        values[child.tag.removeprefix(PREFIX)] = (child.text or "").strip()
    return Entries(document, values, f"{where}.")


def _profiles(document: Document) -> Iterator[tuple[Entries, Entries]]:
    """Yields the entries of each profile and those of its geometric model."""
    for profile in document.xml.iter("rdf:li"):
        models = [found for name in MODELS for found in profile.iter(f"{PREFIX}{name}")]
        if not models:
            continue
        holder = models[0].find("rdf:Description")
        own = profile.find("rdf:Description")
        model = models[0].tag.removeprefix(PREFIX)
        yield (
            _values(document, profile if own is None else own, "profile"),
            _values(document, models[0] if holder is None else holder, model),
        )


def _camera(profile: Entries, model: Entries, name: str) -> StatedCamera:
    kind = model.where.rstrip(".")
    width, height = profile.size("ImageWidth", "ImageLength")
    longer = max(width, height)
    matrix = camera_matrix(
        model.positive("FocalLengthX") * longer,
        model.positive("FocalLengthY" if "FocalLengthY" in model else "FocalLengthX") * longer,
        model.number("ImageXCenter", 0.5) * width,
        model.number("ImageYCenter", 0.5) * height,
    )
    k1, k2, k3 = (model.number(f"RadialDistortParam{i}", 0.0) for i in (1, 2, 3))
    if kind == "FisheyeModel":
        camera_model = fisheye_model(matrix, [k1, k2])
    elif kind == "PerspectiveModel":
        p2, p1 = (model.number(f"TangentialDistortParam{i}", 0.0) for i in (1, 2))
        camera_model = pinhole_model(matrix, [k1, k2, p1, p2, k3])
    else:
        unknown_model(model.document, "profile", kind, MODELS)
    return StatedCamera(camera_model, (width, height), kind, name=name, format="lcp", file_values=dict(model.values))


def cameras(document: Document, options: Options) -> Cameras:
    found: dict[str, Callable[[], StatedCamera]] = {}
    for profile, model in _profiles(document):
        stated = (str(profile.values.get(key, "")) for key in ("FocalLength", "FocusDistance", "ApertureValue"))
        name = " ".join(text for text in (str(profile.values.get("Lens", "camera")), *stated) if text)
        found[name] = lambda p=profile, m=model, name=name: _camera(p, m, name)  # type: ignore[misc]
    return found


def _matches(document: Document) -> bool:
    return document.syntax == "xml" and document.xml.tag == "x:xmpmeta" and "CameraProfiles" in document.text


FORMAT = Format("lcp", _matches, cameras)
