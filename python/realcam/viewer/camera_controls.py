"""What the user has set on the camera, as one value of which the Camera is made."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

from .._core import Camera, Film, InputError, Lens
from .pose import Pose
from .ring_scales import ISO, SHUTTER_S, Ring, aperture_ring


class Mount(NamedTuple):
    """A lens as edits have made it, and the film behind it."""

    lens: Lens
    film: Film


def of_width(film: Film, width: int) -> Film:
    """A film with so many pixels across; how many there are upwards follows from its size."""
    return film.replace(resolution=(width, max(1, round(width * film.height_mm / film.width_mm))))


@dataclass(frozen=True)
class CameraControls:
    """A lens as it was made, and how its rings and the camera's dials stand.

    lens: the body of the lens, focused as its file says and wide open; edits change it. f_number: None for wide open; a
    smaller one than the lens has means wide open, too, so that the ring stays where it is while lenses change.
    """

    lens: Lens
    film: Film
    pose: Pose
    zoom: str | None = None
    f_number: float | None = None
    focus_m: float = math.inf
    exposure_time_s: float = 0.008
    iso: float = 100.0
    compensation_ev: float = 0.0
    is_automatic: bool = False  #: the exposure time follows the light
    model: str = "full"

    @classmethod
    def of(cls, camera: Camera, *, is_automatic: bool = False) -> CameraControls:
        """How a camera stands. A camera that moves while it exposes is taken where it is at first."""
        return cls(
            lens=opened(camera.lens.focused(math.inf)),
            film=camera.film,
            pose=Pose(camera.position, camera.look_at, camera.up),
            zoom=camera.lens.zoom_position,
            f_number=camera.lens.focused(math.inf).first_order().f_number,  # as engraved
            focus_m=camera.lens.focus_distance_m,
            exposure_time_s=camera.exposure_time_s,
            iso=camera.iso,
            is_automatic=is_automatic,
            model=camera.model,
        )

    @cached_property
    def body(self) -> Lens:
        """The lens at its zoom position, at its design's focus, wide open."""
        return self.lens if self.zoom is None else self.lens.zoomed(self.zoom)

    @cached_property
    def set_lens(self) -> Lens:
        """With its rings set. Raises InputError where the lens cannot be focused so, or is none."""
        # The stop first: f-numbers are of the lens at infinity, and a focusing group that has moved makes another lens.
        lens = self.body
        if self.f_number is not None and self.f_number > lens.first_order().f_number:
            lens = lens.stopped_down(self.f_number)
        return lens.focused(self.focus_m)

    @cached_property
    def lens_on_film(self) -> Lens:
        """With its rings set, and the camera's film in place of its own: what is drawn and measured of both.

        A film that is shifted is taken for the smallest one about the axis that holds it. Raises InputError.
        """
        right, up = self.film.shift_mm
        return self.set_lens.with_film(self.film.width_mm + 2 * abs(right), self.film.height_mm + 2 * abs(up))

    @cached_property
    def camera(self) -> Camera:
        """Raises InputError."""
        return Camera(
            self.set_lens,
            film=self.film,
            position=self.pose.position_m,
            look_at=self.pose.look_at_m,
            up=self.pose.up,
            exposure_time_s=self.exposure_time_s,
            iso=self.iso,
            model=self.model,
        )

    @property
    def apertures(self) -> Ring:
        """The aperture ring of the lens."""
        return aperture_ring(self.body.first_order().f_number)

    @property
    def seen_height_m(self) -> float:
        """What the picture's height shows at the distance of what is looked at."""
        return self.pose.distance_m * self.film.height_mm / abs(self.body.first_order().effective_focal_length_mm)

    def focusing_shift_mm(self, surface: int) -> float:
        """By how much the focus ring has lengthened what is behind a surface."""
        surfaces = self.set_lens.surfaces, self.body.surfaces
        if not 0 <= surface < len(self.body.surfaces):
            return 0.0
        return surfaces[0][surface].thickness_mm - surfaces[1][surface].thickness_mm

    def turned(self, ring: str, steps: int) -> CameraControls:
        """Turns "aperture" (closes), "shutter" (longer) or "iso" by thirds of a stop. Raises InputError."""
        if ring == "aperture":
            widest = self.apertures.values[0]
            return replace(self, f_number=self.apertures.turned(max(self.f_number or 0.0, widest), steps))
        if ring == "shutter":
            return replace(self, exposure_time_s=SHUTTER_S.turned(self.exposure_time_s, steps), is_automatic=False)
        if ring == "iso":
            return replace(self, iso=ISO.turned(self.iso, steps))
        raise InputError(f'there is no ring "{ring:.40}"')

    @property
    def mount(self) -> Mount:
        return Mount(self.lens, self.film)

    def with_mount(self, mount: Mount) -> CameraControls:
        """Another lens with its film, of as many pixels across as now."""
        return replace(self.with_lens(mount.lens), film=of_width(mount.film, self.film.resolution[0]))

    def with_lens(self, lens: Lens) -> CameraControls:
        """Another lens or an edited one; its zoom position stays where it has one of that name."""
        zoom = self.zoom if self.zoom in lens.zoom_positions else lens.zoom_position
        return replace(self, lens=lens, zoom=zoom)

    def focused_within_reach(self) -> CameraControls:
        """At the nearest focus that the lens has, if the ring stands before it. Raises InputError where it has none."""
        try:
            self.set_lens  # noqa: B018
        except InputError:
            nearest = self.body.nearest_focus_m
            if not nearest > self.focus_m:
                raise
            return replace(self, focus_m=nearest)
        return self


def opened(lens: Lens) -> Lens:
    """With the diaphragm as wide as its opening. Of a zoom lens each position has an opening of its own: these stay."""
    opening = lens.surfaces[lens.stop_index].clear_semi_diameter_mm
    if lens.zoom_positions or lens.stop_semi_diameter_mm >= opening:
        return lens
    # The pupil grows with the diaphragm; the last digits must not ask for more than there is.
    widest = lens.first_order().f_number * lens.stop_semi_diameter_mm / opening
    return lens.stopped_down(widest * (1 + 1e-12))
