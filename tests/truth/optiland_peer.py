"""Optiland (github.com/optiland/optiland) as a second opinion on rays and first-order data."""

from __future__ import annotations

import warnings

import numpy as np

from .prescription import Prescription, Rays, Row, Traced

NAME = "Optiland"
PACKAGE = "optiland"

# Tolerance of an asphere's residual, mm. Optiland's default of 1e-6 is too loose for comparisons to 1e-9; Optiland
# itself raises a tolerance below eight roundings of the distance.
TOLERANCE = 1e-15
GAP = 10.0  # from the last surface to its image surface
WAVELENGTH_UM = 0.5875618  # of no effect: all indices are constant


def _geometry(row: Row) -> dict:
    if row.coefficients:
        highest = max(row.coefficients)
        coefficients = [row.coefficients.get(power, 0.0) for power in range(2, highest + 1, 2)]
        return {
            "surface_type": "even_asphere",
            "radius": row.radius,
            "conic": row.conic,
            "coefficients": coefficients,
            "tol": TOLERANCE,
        }
    return {"surface_type": "standard", "radius": row.radius, "conic": row.conic}


def _optic(prescription: Prescription):
    from optiland.materials import IdealMaterial
    from optiland.optic import Optic
    from optiland.physical_apertures import RadialAperture

    optic = Optic()
    optic.surfaces.add(index=0, radius=np.inf, thickness=np.inf)
    for i, row in enumerate(prescription.rows):
        optic.surfaces.add(
            index=i + 1,
            thickness=row.thickness if i + 1 < len(prescription.rows) else GAP,
            material="mirror" if row.type == "mirror" else IdealMaterial(row.index),
            aperture=RadialAperture(r_max=row.semi_diameter, r_min=row.inner_semi_diameter),
            is_stop=row.type == "stop",
            **_geometry(row),
        )
    # In the last medium, else Optiland refracts into air there.
    optic.surfaces.add(index=len(prescription.rows) + 1, material=IdealMaterial(prescription.rows[-1].index))
    optic.set_aperture("float_by_stop_size", 2 * prescription.rows[prescription.stop].semi_diameter)
    optic.fields.set_type("angle")
    optic.fields.add(y=0)
    optic.wavelengths.add(value=WAVELENGTH_UM, is_primary=True)
    return optic


def trace(prescription: Prescription, rays: Rays) -> Traced:
    """Aspheric lenses ray by ray.

    Optiland's tolerance grows with the longest distance in the batch (geometries/newton_raphson.py,
    `_effective_tolerance`), and one ray that hardly meets the base conic can have 1e14 mm: the tolerance of all is
    then 1 mm.
    """
    optic = _optic(prescription)
    out = Traced.none_yet(len(rays), len(prescription.rows))
    step = 1 if prescription.is_aspheric else max(1, len(rays))
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        # Rays that miss a surface are nan to Optiland, and aspheres complain of them.
        warnings.simplefilter("ignore")
        for first in range(0, len(rays), step):
            _trace_batch(optic, rays, slice(first, first + step), out)
    return out


def _trace_batch(optic, rays: Rays, batch: slice, out: Traced) -> None:
    from optiland.rays import RealRays

    origins, directions = rays.origins[batch], rays.directions[batch]
    ones = np.ones(len(origins))
    optic.surfaces.trace(RealRays(*origins.T.copy(), *directions.T.copy(), ones, WAVELENGTH_UM * ones))
    surfaces = optic.surfaces.surfaces[1:-1]
    fates, ended_at = out.fates[batch], out.ended_at[batch]
    for i, surface in enumerate(surfaces):
        # In the order of the light: met, inside the rim, refracted.
        for fate, ended in (
            ("missed", ~np.isfinite(surface.x + surface.y + surface.z)),
            ("vignetted", surface.intensity == 0),
            ("total internal reflection", ~np.isfinite(surface.L + surface.M + surface.N)),
        ):
            new = ended & (fates == "ok")
            fates[new] = fate
            ended_at[new] = i
    last, ok = surfaces[-1], fates == "ok"
    out.positions[batch][ok] = np.stack([last.x, last.y, last.z], axis=1)[ok]
    out.directions[batch][ok] = np.stack([last.L, last.M, last.N], axis=1)[ok]
    out.optical_paths[batch][ok] = last.opd[ok]


def first_order(prescription: Prescription) -> dict[str, float]:
    """Named and measured as realcam does: positions from the first vertex."""
    paraxial = _optic(prescription).paraxial
    image = prescription.vertices[-1] + GAP
    figures = {
        "effective_focal_length_mm": paraxial.f2(),
        "back_focal_distance_mm": paraxial.F2() + GAP,
        "front_focal_distance_mm": paraxial.F1(),
        "f_number": abs(paraxial.f2()) / abs(paraxial.EPD()),
        "entrance_pupil_position_mm": paraxial.EPL(),
        "entrance_pupil_diameter_mm": abs(paraxial.EPD()),
        "exit_pupil_position_mm": paraxial.XPL() + image,
        "exit_pupil_diameter_mm": abs(paraxial.XPD()),
    }
    return {name: float(np.squeeze(value)) for name, value in figures.items()}
