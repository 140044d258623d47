"""Adobe's lens profiles (.lcp). First pixel: 0.5 (inferred: the centre 0.5 is the picture's).

Source: Adobe Lens Profile Creator's technical report, "Camera model"; the polynomials map ideal to distorted points.
Focal lengths are in units of the longer side, centres in units of the width and height.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from ..files.document import Document
from ..files.entries import Entries
from ..files.output import xml_elements
from ..models.central import camera_matrix
from ..models.opencv_models import fisheye_coefficients, fisheye_model, opencv_coefficients, pinhole_model
from ..models.projections import Equidistant
from ..models.terms import terms_of
from ..stated_camera import StatedCamera
from .format import Cameras, Format, Options, Saved, Writer, unknown_model

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
    stated = {"kind": kind, "profile": _texts(profile), "model": _texts(model)}
    return StatedCamera(camera_model, (width, height), kind, name=name, format="lcp", file_values=stated)


def _texts(entries: Entries) -> dict[str, str]:
    """Returns the values that are no structures, whose text is empty, and no attributes of XML."""
    return {key: value for key, value in entries.values.items() if value and ":" not in key}


def cameras(document: Document, options: Options) -> Cameras:
    found: dict[str, Callable[[], StatedCamera]] = {}
    for profile, model in _profiles(document):
        stated = (str(profile.values.get(key, "")) for key in ("FocalLength", "FocusDistance", "ApertureValue"))
        name = " ".join(text for text in (str(profile.values.get("Lens", "camera")), *stated) if text)
        found[name] = lambda p=profile, m=model, name=name: _camera(p, m, name)  # type: ignore[misc]
    return found


def _matches(document: Document) -> bool:
    return document.syntax == "xml" and document.xml.tag == "x:xmpmeta" and "CameraProfiles" in document.text


def _stated(camera: StatedCamera) -> Mapping[str, Any]:
    terms = terms_of(camera)
    is_fisheye = isinstance(terms.projection, Equidistant)
    if is_fisheye:
        terms.within_90_degrees()
        radial, tangential = fisheye_coefficients(terms, 2), [0.0, 0.0]
    else:
        k1, k2, p1, p2, k3 = opencv_coefficients(terms, (5,))
        radial, tangential = [k1, k2, k3], [p2, p1]
    fx, fy, cx, cy = terms.pixel_matrix(0.5)
    width, height = camera.size
    longer = max(width, height)
    model = {
        "Version": 2,
        "FocalLengthX": fx / longer,
        "FocalLengthY": fy / longer,
        "ImageXCenter": cx / width,
        "ImageYCenter": cy / height,
        **{f"RadialDistortParam{i}": value for i, value in enumerate(radial, start=1)},
    }
    if any(tangential):
        model |= {f"TangentialDistortParam{i}": value for i, value in enumerate(tangential, start=1)}
    profile: dict[str, Any] = {"Author": "realcam", "CameraRawProfile": "True", "Lens": camera.name or "lens"}
    profile |= {"ImageWidth": width, "ImageLength": height}
    return {"kind": "FisheyeModel" if is_fisheye else "PerspectiveModel", "profile": profile, "model": model}


def _content(cameras: Sequence[Saved], path: Path) -> Mapping[Path, bytes]:
    profiles = "".join(_profile(saved.values) for saved in cameras)
    return {path: _FILE.format(profiles=profiles).encode()}


def _profile(values: Mapping[str, Any]) -> str:
    named = [{f"{PREFIX}{key}": value for key, value in values[part].items()} for part in ("profile", "model")]
    kind = f"{PREFIX}{values['kind']}"
    return (
        f'<rdf:li rdf:parseType="Resource">\n{xml_elements(named[0], "")}'
        f'<{kind} rdf:parseType="Resource">\n{xml_elements(named[1], "")}</{kind}>\n</rdf:li>\n'
    )


_FILE = """<x:xmpmeta xmlns:x="adobe:ns:meta/">
<rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#">
<rdf:Description rdf:about="" xmlns:photoshop="http://ns.adobe.com/photoshop/1.0/" \
xmlns:stCamera="http://ns.adobe.com/photoshop/1.0/camera-profile">
<photoshop:CameraProfiles>
<rdf:Seq>
{profiles}</rdf:Seq>
</photoshop:CameraProfiles>
</rdf:Description>
</rdf:RDF>
</x:xmpmeta>
"""

FORMAT: Format = Format("lcp", _matches, cameras, Writer(("*.lcp",), _stated, _content))
