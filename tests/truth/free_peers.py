"""Optiland and ray-optics on the lenses of free_lenses.py: where a ray ends on the last surface, and its direction.

What is left out, in Optiland 0.6.3 and ray-optics 0.9.8:

- Optiland's biconic adds up two conics, each with a square root of its own, where Zemax's has one root for both.
- ray-optics has no biconics, and of (x, y), Zernike and Forbes terms none.
"""

from __future__ import annotations

import warnings

import numpy as np

from .free_lenses import Row, frames

TOLERANCE = 1e-15  # of Optiland's searches, mm; as in optiland_peer.py
STEP = 1e-13  # of ray-optics' last step, mm
WAVELENGTH_UM = 0.5875618  # of no effect: all indices are constant
OBJECT_DISTANCE = 100.0  # mm, for ray-optics


def _even_list(terms: dict[int, float]) -> list[float]:
    """From y^2 on."""
    return [terms.get(power, 0.0) for power in range(2, max(terms, default=0) + 1, 2)]


def _xy_table(terms: dict[tuple[int, int], float]) -> np.ndarray:
    size = max(max(i, j) for i, j in terms) + 1
    table = np.zeros((size, size))
    for (i, j), value in terms.items():
        table[i, j] = value
    return table


def _optiland_geometry(row: Row) -> dict:
    form, search = row.form, {"tol": TOLERANCE}
    own = {"radius": row.radius, "conic": row.conic}
    if form.get("form") == "toroid":
        terms = _even_list(form.get("aspheric_coefficients", {}))
        radii = {"radius_x": form.get("radius_of_curvature_x_mm", np.inf), "radius_y": row.radius}
        return {"surface_type": "toroidal", "conic": row.conic, "toroidal_coeffs_poly_y": terms, **radii, **search}
    if "radial_terms" in form:
        terms = [form["radial_terms"].get(k + 1, 0.0) for k in range(max(form["radial_terms"]))]
        return {"surface_type": "odd_asphere", "coefficients": terms, **own, **search}
    if "xy_terms" in form:
        return {"surface_type": "polynomial", "coefficients": _xy_table(form["xy_terms"]), **own, **search}
    if "zernike" in form:
        z = form["zernike"]
        return {
            "surface_type": "zernike",
            "zernike_type": z["order"],
            "coefficients": z["coefficients_mm"],
            "norm_radius": z["radius_mm"],
            **own,
            **search,
        }
    if "forbes" in form:
        f = form["forbes"]
        terms = dict(enumerate(f["coefficients_mm"]))
        return {"surface_type": "forbes_qbfs", "radial_terms": terms, "norm_radius": f["radius_mm"], **own, **search}
    return {"surface_type": "standard", **own}


def optiland(rows: list[Row], rays: np.ndarray) -> np.ndarray:
    """(N, 6); nan where the ray does not pass."""
    from optiland.materials import IdealMaterial
    from optiland.optic import Optic
    from optiland.rays import RealRays

    optic = Optic()
    optic.surfaces.add(index=0, radius=np.inf, thickness=np.inf)
    index = 1.0
    for i, (row, (origin, axes)) in enumerate(zip(rows, frames(rows), strict=True)):
        index = index if row.mirror else row.index
        angles = {
            "rx": np.arctan2(axes[2, 1], axes[2, 2]),
            "ry": np.arcsin(-axes[2, 0]),
            "rz": np.arctan2(axes[1, 0], axes[0, 0]),
        }
        optic.surfaces.add(
            index=i + 1,
            x=origin[0],
            y=origin[1],
            z=origin[2],
            material="mirror" if row.mirror else IdealMaterial(index),
            is_stop=i == 0,
            **angles,
            **_optiland_geometry(row),
        )
    optic.set_aperture("EPD", 1.0)
    optic.fields.set_type("angle")
    optic.fields.add(y=0)
    optic.wavelengths.add(value=WAVELENGTH_UM, is_primary=True)
    last = optic.surfaces.surfaces[len(rows)]
    out = np.full((len(rays), 6), np.nan)
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        for ray, to in zip(rays, out, strict=True):
            one = RealRays(*ray[:, None], np.ones(1), np.full(1, WAVELENGTH_UM))
            optic.surfaces.trace(one)
            to[:] = [float(np.squeeze(getattr(last, name))) for name in ["x", "y", "z", "L", "M", "N"]]
    return out


def ray_optics(rows: list[Row], rays: np.ndarray) -> np.ndarray | None:
    """The same; None: it has not all of these surfaces."""
    from rayoptics.elem import profiles
    from rayoptics.elem.surface import DecenterData
    from rayoptics.optical.opticalmodel import OpticalModel
    from rayoptics.raytr import raytrace, traceerror
    from rayoptics.raytr.opticalspec import FieldSpec, PupilSpec, WvlSpec

    if any(kind in row.form for row in rows for kind in ("xy_terms", "zernike", "forbes")):
        return None
    if any(row.decentre[2] for row in rows):
        return None
    model = OpticalModel(radius_mode=True, do_init=True)
    sequence, spec = model["seq_model"], model["optical_spec"]
    spec["pupil"] = PupilSpec(spec, key=["object", "epd"], value=1.0)
    spec["fov"] = FieldSpec(spec, key=["object", "angle"], value=1.0, flds=[0.0])
    spec["wvls"] = WvlSpec([(1000 * WAVELENGTH_UM, 1.0)], ref_wl=0)
    sequence.gaps[0].thi = OBJECT_DISTANCE
    sequence.do_apertures = False
    for i, row in enumerate(rows):
        sequence.add_surface([0.0, row.thickness, "REFL" if row.mirror else row.index])
        surface = sequence.ifcs[sequence.cur_surface]
        c, form = 0.0 if np.isinf(row.radius) else 1 / row.radius, row.form
        if form.get("form") == "toroid":
            terms = _even_list(form.get("aspheric_coefficients", {})) + [0.0] * 10
            across = 1 / form.get("radius_of_curvature_x_mm", np.inf)
            surface.profile = profiles.YToroid(c=c, cR=across, cc=row.conic, coefs=terms[:10])
        elif "radial_terms" in form:
            terms = [form["radial_terms"].get(k + 1, 0.0) for k in range(10)]
            surface.profile = profiles.RadialPolynomial(c=c, cc=row.conic, coefs=terms)
        elif row.conic:
            surface.profile = profiles.Conic(c=c, cc=row.conic)
        else:
            surface.profile = profiles.Spherical(c=c)
        if any(row.decentre) or any(row.tilt):
            kind = "dec and return" if row.returns else "decenter"
            # Its first two angles count clockwise.
            alpha, beta, gamma = -row.tilt[0], -row.tilt[1], row.tilt[2]
            surface.decenter = DecenterData(kind, row.decentre[0], row.decentre[1], alpha, beta, gamma)
            surface.decenter.update()
        if i == 0:
            sequence.set_stop()
    model.update_model()
    origin, axes = frames(rows)[-1]
    out = np.full((len(rays), 6), np.nan)
    for ray, to in zip(rays, out, strict=True):
        try:
            segments, _, _ = raytrace.trace_raw(
                sequence.path(1000 * WAVELENGTH_UM),
                ray[:3] + np.array([0, 0, OBJECT_DISTANCE]),
                ray[3:],
                1000 * WAVELENGTH_UM,
                eps=STEP,
                check_apertures=False,
                intersect_obj=False,
                first_surf=1,
                last_surf=len(rows),
            )
        except traceerror.TraceError:
            continue
        point, after, _, _ = segments[len(rows)]
        to[:3], to[3:] = origin + axes @ point, axes @ after
    return out


PEERS = {"Optiland": optiland, "ray-optics": ray_optics}
