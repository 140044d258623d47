"""Distortion models of lensfun's database: ptlens, poly3 and poly5. First pixel: 0.

Source: lensfun 0.3, libs/lensfun/mod-coord.cpp: the undistorted distance of a pixel from the centre is 1 at
hypot(W - 1, H - 1) / 2 / sqrt(aspect_ratio^2 + 1) * crop_camera / crop_lens pixels. Undistorted pictures are those of a
pinhole camera with the nominal focal length.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..files.document import Document
from ..files.entries import Entries, element_entries
from ..files.output import xml_attributes, xml_elements
from ..models.central import CentralModel, camera_matrix
from ..models.distortion import BrownConrady
from ..models.projections import Perspective
from ..models.radial import RationalRadius
from ..models.terms import Inexpressible, terms_of
from ..stated_camera import StatedCamera
from .format import Cameras, Format, Options, Saved, Writer, stated_size

DIAGONAL_MM = float(np.hypot(36, 24))  # of a film with crop factor 1


class _Lens(NamedTuple):
    """A lens with one of its calibrated focal lengths."""

    entries: Entries
    distortion: Entries
    focal_length_mm: float


def _factor(entries: Entries) -> tuple[float, ...]:
    """Returns the coefficients of the distorted distance over the undistorted one, by ascending powers."""
    model = entries.choice("model", ("ptlens", "poly3", "poly5"))
    if model == "ptlens":
        a, b, c = (entries.number(key, 0.0) for key in "abc")
        return 1 - a - b - c, c, b, a
    k1, k2 = entries.number("k1", 0.0), entries.number("k2", 0.0)
    return (1 - k1, 0.0, k1) if model == "poly3" else (1.0, 0.0, k1, 0.0, k2)


def _aspect_ratio(entries: Entries) -> float:
    """Returns the ratio of width and height of the pictures that the lens was calibrated with."""
    if "aspect-ratio" not in entries:
        return 1.5
    width, _, height = entries.text("aspect-ratio").partition(":")
    parts = Entries(entries.document, {"aspect-ratio": width, "height": height or "1"}, entries.where)
    return parts.positive("aspect-ratio") / parts.positive("height")


def _camera(lens: _Lens, name: str, options: Options) -> StatedCamera:
    size = stated_size(lens.entries.document, options)
    lens_crop = lens.entries.positive("cropfactor") if "cropfactor" in lens.entries else 1.0
    crop = options.crop_factor or lens_crop
    diagonal = float(np.hypot(size[0] - 1, size[1] - 1))
    unit = diagonal / 2 / float(np.hypot(_aspect_ratio(lens.entries), 1)) * crop / lens_crop
    focal = lens.focal_length_mm / (DIAGONAL_MM / crop) * diagonal
    # The polynomial is a function of the tangent times this ratio.
    ratio = focal / unit
    factor = tuple(value * ratio**power for power, value in enumerate(_factor(lens.distortion)))
    if factor[0] <= 0:
        lens.distortion.fail("model", "a factor that is positive in the centre of the picture")
    model = CentralModel(
        Perspective(), BrownConrady(RationalRadius(factor)), camera_matrix(focal, focal, size[0] / 2, size[1] / 2)
    )
    own = {key: value for key, value in lens.entries.values.items() if key in LENS_KEYS and value}
    film = [side * DIAGONAL_MM / crop / float(np.hypot(*size)) for side in size]
    return StatedCamera(
        model,
        size,
        lens.distortion.text("model"),
        name=name,
        format="lensfun",
        pixel_origin=0.0,
        file_values={"lens": own, "distortion": dict(lens.distortion.values)},
        film_mm=(film[0], film[1]),
    )


def _lenses(document: Document) -> dict[str, _Lens]:
    """Returns the lenses by their model, with the focal length if there are several."""
    found: dict[str, _Lens] = {}
    for element in document.xml.iter("lens"):
        entries = element_entries(document, element)
        distortions = [element_entries(document, d) for d in element.iterfind("calibration/distortion")]
        for distortion in distortions:
            focal = distortion.positive("focal")
            name = entries.text("model")
            found[f"{name} @ {focal:g} mm" if distortions[1:] else name] = _Lens(entries, distortion, focal)
    return found


def cameras(document: Document, options: Options) -> Cameras:
    if options.crop_factor is not None and not 0.01 <= options.crop_factor <= 100:
        document.fail(f"crop_factor is {options.crop_factor}; expected a number from 0.01 to 100")
    return {
        name: lambda lens=lens, name=name: _camera(lens, name, options)  # type: ignore[misc]
        for name, lens in _lenses(document).items()
    }


LENS_KEYS = ("maker", "model", "mount", "cropfactor", "aspect-ratio", "type")


def _values(camera: StatedCamera) -> Mapping[str, Any]:
    terms = terms_of(camera)
    terms.projected_by(Perspective)
    terms.without("bottom", "tangential", "prism", "tilt")
    fx, fy, cx, cy = terms.pixel_matrix(0.5)
    width, height = camera.size
    if max(abs(fx - fy), abs(cx - width / 2), abs(cy - height / 2)) > 1e-10:
        raise Inexpressible("has square pixels and the principal point in the centre of the picture")
    crop = DIAGONAL_MM / float(np.hypot(*camera.film_mm)) if camera.film_mm else 1.0
    aspect = max(width, height) / min(width, height)
    diagonal = float(np.hypot(width - 1, height - 1))
    unit = diagonal / 2 / float(np.hypot(aspect, 1))
    powers = [k * (unit / fx) ** power for power, k in enumerate(terms.top, start=1)]
    distortion, scale = _distortion(powers)
    focal = fx / scale / diagonal * DIAGONAL_MM / crop
    lens = {"maker": "realcam", "model": camera.name or "lens", "mount": "Generic", "cropfactor": crop}
    return {
        "lens": {**lens, "aspect-ratio": aspect},
        "distortion": {"model": distortion.pop("model"), "focal": focal, **distortion},
    }


def _distortion(powers: Sequence[float]) -> tuple[dict[str, Any], float]:
    """Returns the model of 1 + sum powers_i r^i and its factor in the centre of the picture. Raises Inexpressible."""
    p1, p2, p3, p4, *others = [*powers, *[0.0] * 4]
    if any(others) or (p4 and (p1 or p3)):
        raise Inexpressible("has only polynomials to the third power, or to the even fourth one")
    if not p1 and not p3:
        return {"model": "poly5", "k1": p2, "k2": p4}, 1.0
    # ptlens is s + c r + b r^2 + a r^3 with s = 1 - a - b - c, in a unit of r that is s times the paraxial one.
    roots = np.polynomial.Polynomial([-1.0, 1.0, p1, p2, p3]).roots()
    real = [float(root.real) for root in roots if abs(root.imag) < 1e-12 and root.real > 0]
    if not real:
        raise Inexpressible("has no ptlens polynomial for this distortion")
    s = min(real, key=lambda root: abs(root - 1))
    return {"model": "ptlens", "a": p3 * s**4, "b": p2 * s**3, "c": p1 * s**2}, s


def _content(cameras: Sequence[Saved], path: Path) -> Mapping[Path, bytes]:
    mounts = dict.fromkeys(str(saved.values["lens"].get("mount", "Generic")) for saved in cameras)
    parts = [f"<mount>{xml_elements({'name': mount}, '').strip()}</mount>\n" for mount in mounts]
    for _, values, _ in cameras:
        lens = {"mount": "Generic", **values["lens"]}
        distortion = f"<distortion{xml_attributes(values['distortion'])}/>"
        parts.append(f"<lens>\n{xml_elements(lens, '')}<calibration>{distortion}</calibration>\n</lens>\n")
    return {path: f'<lensdatabase version="1">\n{"".join(parts)}</lensdatabase>\n'.encode()}


FORMAT: Format = Format(
    "lensfun",
    lambda d: d.syntax == "xml" and d.xml.tag == "lensdatabase",
    cameras,
    Writer(("*lensfun*.xml", "*lenses*.xml", "*.xml"), _values, _content),
)
