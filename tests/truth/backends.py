"""realcam as one more program that traces rays through a prescription, for comparison with the peers and the oracle."""

from __future__ import annotations

import numpy as np
import realcam as rc

from .prescription import Prescription, Rays, Row, Traced

# Available backends, with the arguments of Lens.trace that select them.
BACKENDS: dict[str, dict] = {"Embree": {"device": "cpu"}}
if any(device.name.startswith("cuda:") for device in rc.devices()):
    BACKENDS["CUDA"] = {"device": "cuda"}

FATES = {
    rc.RayStatus.OK: "ok",
    rc.RayStatus.MISSED: "missed",
    rc.RayStatus.VIGNETTED: "vignetted",
    rc.RayStatus.TOTAL_INTERNAL_REFLECTION: "total internal reflection",
    rc.RayStatus.NO_CONVERGENCE: "no convergence",
    rc.RayStatus.BAD_INPUT: "bad input",
}


def realcam_lens(prescription: Prescription) -> rc.Lens:
    surfaces = [
        rc.Surface(
            type=row.type,
            radius_of_curvature_mm=row.radius,
            thickness_mm=row.thickness,
            material=row.index if row.type == "refracting" else None,
            clear_semi_diameter_mm=row.semi_diameter,
            inner_semi_diameter_mm=row.inner_semi_diameter,
            conic=row.conic,
            aspheric_coefficients=row.coefficients,
        )
        for row in prescription.rows
    ]
    # A film distance spares the search for the best focus; no ray here reaches a film.
    return rc.Lens(surfaces=surfaces, name=prescription.name, film_distance_mm=10.0)


def of_bundled_lens(name: str) -> Prescription:
    """With the indices at the lens's own wavelength, so that no glass catalogue takes part."""
    lens = rc.Lens.load(name)
    rows, index = [], 1.0
    for s in lens.surfaces:
        if s.type == "refracting":
            index = s.material.index(lens.wavelength_nm)
        rows.append(
            Row(
                type=s.type,
                semi_diameter=s.clear_semi_diameter_mm,
                radius=s.radius_of_curvature_mm,
                thickness=s.thickness_mm,
                index=index,
                conic=s.conic,
                coefficients=s.aspheric_coefficients,
                inner_semi_diameter=s.inner_semi_diameter_mm,
            )
        )
    return Prescription(name, tuple(rows))


def trace(prescription: Prescription, rays: Rays, backend: str, start: str = "scene") -> Traced:
    out = realcam_lens(prescription).trace(
        rays.origins, rays.directions, start=start, dtype="float64", **BACKENDS[backend]
    )
    fates = np.array([FATES[rc.RayStatus(status)] for status in out.status], dtype="<U26")
    return Traced(out.origins_mm, out.directions, out.optical_path_mm, fates, out.surface_index)


def first_order(prescription: Prescription) -> dict[str, float]:
    """With the rear focal length, n' over the lens's power, which the other programs call the effective one, and with
    the f-number by it. They differ where the film lies in glass or water."""
    figures = realcam_lens(prescription).first_order()
    said = {name: getattr(figures, name) for name in dir(figures) if not name.startswith("_")}
    index = said.pop("image_index")
    return said | {name: index * said[name] for name in ("effective_focal_length_mm", "f_number")}
