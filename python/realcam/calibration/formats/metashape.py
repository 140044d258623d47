"""Agisoft Metashape: exported calibrations and cameras.xml. First pixel: 0.5; cx, cy are from the picture's centre.

Source: Agisoft Metashape User Manual, Appendix D, "Camera models".
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import Array
from ..files.document import Document
from ..files.entries import Entries, element_entries
from ..files.output import numbers, xml_attributes, xml_elements
from ..models.central import CentralModel
from ..models.distortion import BrownConrady
from ..models.projections import Equidistant, Perspective, Projection
from ..models.radial import RationalRadius, even_powers
from ..models.terms import Inexpressible, terms_of
from ..stated_camera import StatedCamera
from .format import Cameras, Format, Options, Saved, Writer, sole, unknown_model

PROJECTIONS: dict[str, type[Projection]] = {"frame": Perspective, "fisheye": Equidistant}
COEFFICIENTS = ("f", "cx", "cy", "b1", "b2", "k1", "k2", "k3", "k4", "p1", "p2", "p3", "p4")


def _camera(entries: Entries, size: tuple[int, int], projection: str, name: str) -> StatedCamera:
    if projection not in PROJECTIONS:
        unknown_model(entries.document, f"{entries.where}type", projection, PROJECTIONS)
    entries.positive("f")
    f, cx, cy, b1, b2, k1, k2, k3, k4, p1, p2, p3, p4 = (entries.number(key, 0.0) for key in COEFFICIENTS)
    if p3 or p4:
        entries.fail("p3" if p3 else "p4", "0: Metashape since version 1.4 has no such coefficient")
    # p1 multiplies r^2 + 2 x^2, which OpenCV's p2 does.
    distortion = BrownConrady(RationalRadius(even_powers([k1, k2, k3, k4])), (p2, p1))
    matrix = np.array([[f + b1, b2, size[0] / 2 + cx], [0, f, size[1] / 2 + cy], [0, 0, 1]])
    stated = {"projection": projection, **{key: entries.number(key) for key in COEFFICIENTS if key in entries}}
    model = CentralModel(PROJECTIONS[projection](), distortion, matrix)
    return StatedCamera(model, size, projection, name=name, format="metashape", file_values=stated)


def _exported(document: Document) -> StatedCamera:
    entries = element_entries(document, document.xml)
    return _camera(entries, entries.size("width", "height"), entries.text("projection", "frame"), "")


def _poses(document: Document, sensor: ET.Element) -> dict[str, Array]:
    """Returns the poses of a sensor's pictures in the frame of their chunk, by their labels."""
    found: dict[str, Array] = {}
    for camera in document.xml.iter("camera"):
        if camera.get("sensor_id") == sensor.get("id") and camera.find("transform") is not None:
            label = camera.get("label") or camera.get("id") or str(len(found))
            entries = element_entries(document, camera)
            found[label] = Entries(document, entries.values, f'camera "{label:.40}": ').matrix("transform", 4, 4)
    return found


def _sensor(document: Document, sensor: ET.Element, name: str) -> StatedCamera:
    calibrations = sensor.findall("calibration")
    adjusted = [found for found in calibrations if found.get("class") == "adjusted"] or calibrations
    if not adjusted:
        document.fail(f'sensor "{name:.40}" has no calibration')
    where = adjusted[0].find("resolution")
    where = sensor.find("resolution") if where is None else where
    if where is None:
        document.fail(f'sensor "{name:.40}": resolution: expected a width and a height; it is missing')
    size = element_entries(document, where).size("width", "height")
    kind = adjusted[0].get("type") or sensor.get("type") or "frame"
    camera = _camera(element_entries(document, adjusted[0]), size, kind, name)
    return replace(camera, poses=_poses(document, sensor))


def cameras(document: Document, options: Options) -> Cameras:
    if document.xml.tag == "calibration":
        return sole(lambda: _exported(document))
    found: dict[str, Callable[[], StatedCamera]] = {}
    for sensor in document.xml.iter("sensor"):
        name = sensor.get("label") or sensor.get("id") or str(len(found))
        if name in found:
            name = f"{name} {sensor.get('id')}"
        found[name] = lambda sensor=sensor, name=name: _sensor(document, sensor, name)  # type: ignore[misc]
    return found


def _matches(document: Document) -> bool:
    if document.syntax != "xml":
        return False
    root = document.xml
    return root.find("projection") is not None if root.tag == "calibration" else root.find(".//sensor") is not None


def _values(camera: StatedCamera) -> Mapping[str, Any]:
    terms = terms_of(camera)
    terms.without("bottom", "prism", "tilt", "is_sequential")
    kinds = {kind: name for name, kind in PROJECTIONS.items()}
    if type(terms.projection) not in kinds:
        raise Inexpressible(f"has no model of the kind {type(terms.projection).__name__}")
    terms.within_90_degrees()
    (a, b2, u0), (shear, f, v0) = terms.matrix[:2].tolist()
    if shear or f <= 0:
        raise Inexpressible("has no shear of the rows")
    values = {"f": f, "cx": u0 - camera.size[0] / 2, "cy": v0 - camera.size[1] / 2, "b1": a - f, "b2": b2}
    k1, k2, k3, k4 = terms.even(terms.top, 4)
    p2, p1 = terms.tangential
    values = {**values, "k1": k1, "k2": k2, "k3": k3, "k4": k4, "p1": p1, "p2": p2}
    return {"projection": kinds[type(terms.projection)], **values}


def _content(cameras: Sequence[Saved], path: Path) -> Mapping[Path, bytes]:
    (_, values, camera), *others = cameras
    head = '<?xml version="1.0" encoding="UTF-8"?>\n'
    if others or camera.poses:
        return {path: (head + _document(cameras)).encode()}
    size = {"width": camera.size[0], "height": camera.size[1]}
    coefficients = {key: value for key, value in values.items() if key != "projection"}
    body = xml_elements({"projection": values["projection"], **size, **coefficients}, "  ")
    return {path: f"{head}<calibration>\n{body}</calibration>\n".encode()}


def _document(cameras: Sequence[Saved]) -> str:
    """Returns a document like that of the export of cameras."""
    sensors: list[str] = []
    pictures: list[str] = []
    for index, (name, values, camera) in enumerate(cameras):
        size = xml_attributes({"width": camera.size[0], "height": camera.size[1]})
        kind = values["projection"]
        coefficients = {key: value for key, value in values.items() if key != "projection"}
        sensors.append(
            f"<sensor{xml_attributes({'id': index, 'label': name, 'type': kind})}>\n<resolution{size}/>\n"
            f'<calibration type="{kind}" class="adjusted">\n<resolution{size}/>\n{xml_elements(coefficients, "")}'
            "</calibration>\n</sensor>\n"
        )
        for label, pose in camera.poses.items():
            attributes = xml_attributes({"id": len(pictures), "sensor_id": index, "label": label})
            pictures.append(f"<camera{attributes}>\n<transform>{numbers(pose)}</transform>\n</camera>\n")
    return (
        '<document version="2.0.0">\n<chunk label="Chunk 1" enabled="true">\n'
        f'<sensors next_id="{len(sensors)}">\n{"".join(sensors)}</sensors>\n'
        f'<cameras next_id="{len(pictures)}" next_group_id="0">\n{"".join(pictures)}</cameras>\n'
        "</chunk>\n</document>\n"
    )


FORMAT: Format = Format(
    "metashape", _matches, cameras, Writer(("*cameras*.xml", "*metashape*.xml", "*.xml"), _values, _content)
)
