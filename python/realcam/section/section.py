"""The function cross_section(), which computes the meridional section of a lens as arrays for drawing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from .._core import InputError, Lens
from ..fields import Field, fields_along, fields_at, fields_of_angles
from ..short_text import ShortText
from .cut import PLANES, Cut, Points
from .marks import FocusGroup, Mark, focus_group_of, marks_of
from .outlines import Blocker, Element, Face, Overlap, blockers_of, elements_of, faces_of, overlaps_of
from .ray_paths import RayBundle, bundles_from_film, bundles_from_object


@dataclass(frozen=True, repr=False)
class CrossSection(ShortText):
    """A lens cut along its axis. Outlines are (N, 2) arrays of (z, y), or (z, x) for the plane "xz"; paths are (N, 3)
    arrays of (x, y, z). All in mm, lens frame."""

    lens: Lens
    elements: tuple[Element, ...]
    faces: tuple[Face, ...]
    blockers: tuple[Blocker, ...]
    overlaps: tuple[Overlap, ...]
    marks: tuple[Mark, ...]
    focus_group: FocusGroup | None
    film_z_mm: float
    film: Points  #: the film's outline
    plane: str
    fields: tuple[Field, ...]
    bundles: tuple[RayBundle, ...]  #: by wavelength, then by field

    def drawn_paths(self, bundle: RayBundle) -> Points:
        """Returns the paths of a bundle, projected onto the drawing's plane, (rays, points, 2).

        For a lens with tilted or decentred surfaces, points on stops and apertures are left out, because such a plane
        may lie at a mirror, where the drawn path would go back and forth.
        """
        if Cut(self.lens).is_in_place:
            return self.drawn(bundle.paths_mm)
        bending = [1 + i for i, surface in enumerate(self.lens.surfaces) if surface.type in ("refracting", "mirror")]
        return self.drawn(bundle.paths_mm[:, [0, *bending, -1]])

    def drawn(self, paths_mm: Points) -> Points:
        """Projects points (..., 3) of the lens frame onto the drawing's plane, (..., 2)."""
        return paths_mm[..., [2, PLANES[self.plane]]]

    @property
    def wavelengths_nm(self) -> tuple[float, ...]:
        """Wavelengths of the bundles, in the order of the request."""
        return tuple(dict.fromkeys(bundle.wavelength_nm for bundle in self.bundles))


def cross_section(
    lens: Lens,
    *,
    plane: str = "yz",
    rays: int = 7,
    rays_from: str = "object",
    fields: Sequence[float] = (0.0, 0.7, 1.0),
    fields_deg: Sequence[float] | None = None,
    wavelengths_nm: Sequence[float] | None = None,
    object_distance_m: float | None = None,
) -> CrossSection:
    """Returns the section of a lens with its rays, in the plane x = 0 or y = 0.

    plane: "yz", or "xz", which differs only for lenses without rotational symmetry.
    rays: number of rays per bundle; 0: no rays.
    rays_from: "object": each bundle comes from an object point, so that aberrations show at the film; or "film": rays
      traced backwards from film points, as the camera samples them.
    fields: fractions of the height of the film's corner, or, if the film is larger than the image circle, of the
      largest height that receives at least a quarter as many rays as the axis.
    fields_deg: field angles instead, as in Lens.spot; only with rays from the object.
    wavelengths_nm: None: the design wavelength.
    object_distance_m: from object plane to front vertex, inf allowed; None: the plane in focus.
    Raises InputError if no light passes the lens, or the arguments are invalid or contradictory.
    """
    cut = Cut(lens, plane)
    if rays_from not in ("object", "film"):
        raise InputError(f'rays_from is "{rays_from}"; expected object or film')
    if rays < 0:
        raise InputError("the number of rays must be 0 or more")
    if rays_from == "film" and fields_deg is not None:
        raise InputError('fields_deg requires rays_from="object"')
    wavelengths = [lens.wavelength_nm] if wavelengths_nm is None else list(dict.fromkeys(wavelengths_nm))
    field_points: tuple[Field, ...] = ()
    bundles: tuple[RayBundle, ...] = ()
    if rays > 0:
        # Length of the rays in front of the lens.
        reach_mm = 0.25 * (lens.film_position_mm - min(lens.vertices_mm))
        if not lens.is_rotational or plane == "xz":
            if rays_from == "film" or fields_deg is not None:
                raise InputError(
                    'rays_from="film" and fields_deg require a rotationally symmetric lens and the plane "yz"; use '
                    'rays_from="object" and fields'
                )
            field_points = fields_along(lens, fields, cut.axis)
        elif fields_deg is not None:
            field_points = fields_of_angles(lens, fields_deg, object_distance_m)
        else:
            field_points = fields_at(lens, fields, object_distance_m)
        if rays_from == "object":
            bundles = bundles_from_object(cut, field_points, wavelengths, rays, reach_mm, object_distance_m)
        else:
            bundles = bundles_from_film(lens, field_points, wavelengths, rays, reach_mm)
    return CrossSection(
        lens,
        elements_of(cut),
        faces_of(cut),
        blockers_of(cut),
        overlaps_of(lens) if cut.is_in_place else (),
        marks_of(lens) if cut.is_in_place else (),
        focus_group_of(lens),
        lens.film_position_mm,
        cut.film,
        plane,
        field_points,
        bundles,
    )
