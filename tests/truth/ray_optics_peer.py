"""ray-optics (github.com/mjhoptics/ray-optics) as a second opinion on rays and first-order data."""

from __future__ import annotations

import math

import numpy as np

from .prescription import Prescription, Rays, Row, Traced

NAME = "ray-optics"
PACKAGE = "rayoptics"

# Tolerance of an asphere's Newton step, mm. ray-optics returns the point before the last step.
TOLERANCE = 1e-13
# Object to first vertex. ray-optics carries the chief ray from the object to the lens: over its usual 1e10 mm of an
# object at infinity, a rounding grows to 5e-5 mm in the pupils.
OBJECT_DISTANCE = 100.0
GAP = 10.0  # from the last surface to its image surface
WAVELENGTH_NM = 587.5618  # of no effect: all indices are constant
PUPIL_DIAMETER = 1.0


def _profile(row: Row):
    from rayoptics.elem import profiles

    if row.coefficients:
        highest = max(row.coefficients)
        coefficients = [row.coefficients.get(power, 0.0) for power in range(2, highest + 1, 2)]
        return profiles.EvenPolynomial(c=row.curvature, cc=row.conic, coefs=coefficients)
    if row.conic:
        return profiles.Conic(c=row.curvature, cc=row.conic)
    return profiles.Spherical(c=row.curvature)


def _aperture(row: Row):
    from rayoptics.elem.surface import Circular

    class Annulus(Circular):
        """ray-optics has no apertures with a hole."""

        def point_inside(self, x: float, y: float, fuzz: float = 0.0) -> bool:
            return super().point_inside(x, y, fuzz) and math.hypot(x, y) >= row.inner_semi_diameter

    return Annulus(radius=row.semi_diameter)


def model_of(prescription: Prescription, object_distance: float = OBJECT_DISTANCE, image_distance: float = GAP):
    """ray-optics' OpticalModel. Distances in mm: object to first vertex, last vertex to the image surface."""
    from rayoptics.optical.opticalmodel import OpticalModel
    from rayoptics.raytr.opticalspec import FieldSpec, PupilSpec, WvlSpec

    model = OpticalModel(radius_mode=True, do_init=True)
    sequence, spec = model["seq_model"], model["optical_spec"]
    spec["pupil"] = PupilSpec(spec, key=["object", "epd"], value=PUPIL_DIAMETER)
    spec["fov"] = FieldSpec(spec, key=["object", "angle"], value=1.0, flds=[0.0])
    spec["wvls"] = WvlSpec([(WAVELENGTH_NM, 1.0)], ref_wl=0)
    sequence.gaps[0].thi = object_distance
    sequence.do_apertures = False
    for i, row in enumerate(prescription.rows):
        thickness = row.thickness if i + 1 < len(prescription.rows) else image_distance
        medium = "REFL" if row.type == "mirror" else row.index
        sequence.add_surface([0.0, thickness, medium])
        surface = sequence.ifcs[sequence.cur_surface]
        surface.profile = _profile(row)
        surface.clear_apertures = [_aperture(row)]
        if row.type == "stop":
            sequence.set_stop()
    model.update_model()
    return model


def trace(prescription: Prescription, rays: Rays) -> Traced:
    from rayoptics.raytr import raytrace, traceerror

    sequence = model_of(prescription)["seq_model"]
    out = Traced.none_yet(len(rays), len(prescription.rows))
    last = len(prescription.rows)  # ray-optics counts its object surface
    indices = [index[0] for index in sequence.rndx]
    for i, (origin, direction) in enumerate(zip(rays.origins, rays.directions, strict=True)):
        from_object = origin + np.array([0.0, 0.0, OBJECT_DISTANCE])
        try:
            segments, _, _ = raytrace.trace_raw(
                sequence.path(WAVELENGTH_NM),
                from_object,
                direction,
                WAVELENGTH_NM,
                eps=TOLERANCE,
                check_apertures=True,
                pt_inside_fuzz=0.0,
                intersect_obj=False,
                first_surf=1,
                last_surf=last,
            )
        except traceerror.TraceError as error:
            out.fates[i] = {
                traceerror.TraceMissedSurfaceError: "missed",
                traceerror.TraceRayBlockedError: "vignetted",
                traceerror.TraceTIRError: "total internal reflection",
            }[type(error)]
            out.ended_at[i] = error.surf - 1
            continue
        point, after, _, _ = segments[last]
        out.positions[i] = point + np.array([0.0, 0.0, prescription.vertices[-1]])
        out.directions[i] = after
        out.optical_paths[i] = sum(
            index * segment[2] for index, segment in zip(indices[:last], segments[:last], strict=True)
        )
    return out


def first_order(prescription: Prescription) -> dict[str, float]:
    """Named and measured as realcam does: positions from the first vertex."""
    parax = model_of(prescription)["analysis_results"]["parax_data"]
    data = parax.fod
    # ray-optics is told a pupil and not a stop: its pupils are scaled with its own marginal ray at the stop.
    scale = prescription.rows[prescription.stop].semi_diameter / abs(parax.ax_ray[prescription.stop + 1][0])
    diameter = 2 * data.enp_radius * scale
    chief = parax.pr_ray[len(prescription.rows)]  # height on the last surface, and slope behind it
    figures = {
        "effective_focal_length_mm": data.efl,
        "back_focal_distance_mm": data.bfl,
        "front_focal_distance_mm": data.ffl,
        "f_number": abs(data.efl) / diameter,
        "entrance_pupil_position_mm": data.enp_dist,
        "entrance_pupil_diameter_mm": diameter,
        # From ray-optics' chief ray, because its exp_dist is valid only with the image surface at the paraxial focus.
        "exit_pupil_position_mm": prescription.vertices[-1] - chief[0] / chief[1],
        "exit_pupil_diameter_mm": 2 * data.exp_radius * scale,
    }
    return {name: float(value) for name, value in figures.items()}
