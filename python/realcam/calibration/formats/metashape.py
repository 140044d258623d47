"""Agisoft Metashape: exported calibrations and cameras.xml. First pixel: 0.5; cx, cy are from the picture's centre.

Source: Agisoft Metashape User Manual, Appendix D, "Camera models".
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Callable

import numpy as np

from ..files.document import Document
from ..files.entries import Entries, element_entries
from ..models.central import CentralModel
from ..models.distortion import BrownConrady
from ..models.projections import Equidistant, Perspective, Projection
from ..models.radial import RationalRadius, even_powers
from ..stated_camera import StatedCamera
from .format import Cameras, Format, Options, sole, unknown_model

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
    stated = {key: entries.number(key) for key in COEFFICIENTS if key in entries}
    model = CentralModel(PROJECTIONS[projection](), distortion, matrix)
    return StatedCamera(model, size, projection, name=name, format="metashape", file_values=stated)


def _exported(document: Document) -> StatedCamera:
    entries = element_entries(document, document.xml)
    return _camera(entries, entries.size("width", "height"), entries.text("projection", "frame"), "")


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
    return _camera(element_entries(document, adjusted[0]), size, kind, name)


def cameras(document: Document, options: Options) -> Cameras:
    if document.xml.tag == "calibration":
        return sole("camera", lambda: _exported(document))
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


FORMAT = Format("metashape", _matches, cameras)
