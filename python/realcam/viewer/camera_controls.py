"""The user's camera settings as one immutable value, from which the Camera is built."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

from .._core import CalibratedGeometry, Camera, Film, InputError, Lens
from .pose import Pose
from .ring_scales import ISO, SHUTTER_S, Ring, aperture_ring, zoom_ring

_ZOOM_KEY_STEPS = 10  # steps of the zoom ring per key press


class Mount(NamedTuple):
    """An edited lens, the film behind it, and the setting of its zoom ring (see CameraControls)."""

    lens: Lens
    film: Film
    zoom: str | float | None


def of_width(film: Film, width: int, pixel_aspect: float = 1.0) -> Film:
    """Returns the film with a picture `width` pixels wide, whose height follows from the film's size.

    pixel_aspect: width of a pixel over its height, on the film.
    """
    return film.replace(resolution=(width, max(1, round(width * film.height_mm / film.width_mm * pixel_aspect))))


@dataclass(frozen=True)
class CameraControls:
    """An unadjusted lens, and the settings of its rings and of the camera's dials.

    lens: the lens at its file's focus and wide open; edits change it. zoom: one of its zoom positions, or a focal
    length in mm between them; None: it does not zoom. f_number: None: wide open; a value below the lens's smallest also
    means wide open, so that the setting is retained while lenses change. focus_m: distance in focus, from the film.
    compensation_ev: exposure compensation in stops, positive for brighter. model: a camera model, as for Camera.
    geometry: that of a calibration, which keeps its film; None: that of the lens. pixel_aspect: see of_width.
    """

    lens: Lens
    film: Film
    pose: Pose
    zoom: str | float | None = None
    f_number: float | None = None
    focus_m: float = math.inf
    exposure_time_s: float = 0.008
    iso: float = 100.0
    compensation_ev: float = 0.0
    is_automatic: bool = False  #: automatic exposure sets the exposure time
    shutter_opens_s: float = 0.0
    readout_time_s: float = 0.0
    model: str = "full"
    geometry: CalibratedGeometry | None = None
    pixel_aspect: float = 1.0

    @classmethod
    def of(cls, camera: Camera, *, is_automatic: bool = False) -> CameraControls:
        """Returns the controls of a camera. An animated camera is taken at its pose at shutter open."""
        lens = camera.lens.focused(math.inf)
        data = lens.first_order()
        position = lens.zoom_position
        zoom: str | float | None = position
        if position is not None:
            position_mm = lens.zoom_focal_lengths_mm[lens.zoom_positions.index(position)]
            if not math.isclose(data.effective_focal_length_mm, position_mm, rel_tol=1e-5):
                zoom = data.effective_focal_length_mm
            lens = lens.zoomed(position)
        width, height = camera.film.resolution
        # The pixels of other shots are squares: the picture's height follows from that of the film.
        pixel_aspect = camera.film.width_mm / width * height / camera.film.height_mm if camera.geometry else 1.0
        return cls(
            lens=lens.wide_open(),
            film=camera.film,
            pose=Pose(*camera.pose_at(camera.shutter_opens_s)),
            zoom=zoom,
            f_number=data.f_number,  # as engraved
            focus_m=camera.lens.focus_distance_m,
            exposure_time_s=camera.exposure_time_s,
            iso=camera.iso,
            is_automatic=is_automatic,
            shutter_opens_s=camera.shutter_opens_s,
            readout_time_s=camera.readout_time_s,
            model=camera.model,
            geometry=camera.geometry,
            pixel_aspect=pixel_aspect,
        )

    @cached_property
    def body(self) -> Lens:
        """The lens at the current zoom, at its design focus, wide open. Raises InputError."""
        return self.lens if self.zoom is None else self.lens.zoomed(self.zoom)

    @cached_property
    def set_lens(self) -> Lens:
        """The lens at the current zoom, focus and f-number. Raises InputError if it is invalid or cannot be focused
        there."""
        return self.body.with_rings(f_number=self.f_number, focus_m=self.focus_m, opens_as_far_as_it_can=True)

    @cached_property
    def lens_on_film(self) -> Lens:
        """`set_lens` with the camera's film in place of its own, for drawings and plots.

        A shifted film is replaced by the smallest centred one that contains it. Raises InputError.
        """
        right, up = self.film.shift_mm
        return self.set_lens.with_film(self.film.width_mm + 2 * abs(right), self.film.height_mm + 2 * abs(up))

    @cached_property
    def camera(self) -> Camera:
        """The camera with these settings. Raises InputError."""
        return Camera(
            self.set_lens,
            film=self.film,
            position=self.pose.position_m,
            look_at=self.pose.look_at_m,
            up=self.pose.up,
            exposure_time_s=self.exposure_time_s,
            iso=self.iso,
            model=self.model,
            shutter_opens_s=self.shutter_opens_s,
            readout_time_s=self.readout_time_s,
            geometry=self.geometry,
        )

    def shot_values(self) -> dict[str, Any]:
        """Returns the settings but the lens by the keys of shot files; without values that are the default or a
        property of the lens."""
        values: dict[str, Any] = {
            "model": self.model,
            "focus_m": self.focus_m,
            "film_mm": [self.film.width_mm, self.film.height_mm],
            "film_shift_mm": list(self.film.shift_mm),
            "resolution": list(self.film.resolution),
            "position_m": list(self.pose.position_m),
            "look_at_m": list(self.pose.look_at_m),
            "up": list(self.pose.up),
            "exposure_time_s": self.exposure_time_s,
            "iso": self.iso,
        }
        if self.zoom is not None:
            values["zoom" if isinstance(self.zoom, str) else "focal_length_mm"] = self.zoom
        if self.f_number is not None and self.f_number > self.body.f_number:
            values["f_number"] = self.f_number
        for key in ("shutter_opens_s", "readout_time_s"):
            if getattr(self, key) != 0:
                values[key] = getattr(self, key)
        if self.geometry is not None:
            del values["film_shift_mm"]  # follows from the calibration
        return values

    @cached_property
    def zooms(self) -> Ring | None:
        """The zoom ring of the lens, by focal lengths in mm; None: the lens has no continuous zoom."""
        return zoom_ring(self.lens)

    @property
    def focal_length_mm(self) -> float:
        """Focal length at the current zoom and the design focus."""
        return self.body.first_order().effective_focal_length_mm

    def zoomed(self, focal_length_mm: float) -> CameraControls:
        """Returns the controls with the zoom at a focal length; at the focal length of a position, with that
        position."""
        position_mm = self.lens.zoom_focal_lengths_mm
        if focal_length_mm in position_mm:
            return replace(self, zoom=self.lens.zoom_positions[position_mm.index(focal_length_mm)])
        return replace(self, zoom=focal_length_mm)

    @property
    def apertures(self) -> Ring:
        """The aperture ring of the lens."""
        return aperture_ring(self.body.first_order().f_number)

    @property
    def seen_height_m(self) -> float:
        """Height of the field of view at the distance of the look-at point, in metres."""
        return self.pose.distance_m * self.film.height_mm / abs(self.body.first_order().effective_focal_length_mm)

    def focusing_shift_mm(self, surface: int) -> float:
        """Change of the thickness behind a surface by focusing, mm; 0 if there is no such surface."""
        focused, unfocused = self.set_lens.surfaces, self.body.surfaces
        if not 0 <= surface < len(unfocused):
            return 0.0
        return focused[surface].thickness_mm - unfocused[surface].thickness_mm

    def turned(self, ring: str, steps: int) -> CameraControls:
        """Returns the controls with a ring turned by steps: "aperture" (stops down), "shutter" (longer) or "iso" by
        thirds of a stop, or "zoom" (longer focal length) by a thirtieth of its ring. Raises InputError.
        """
        if ring == "aperture":
            widest = self.apertures.values[0]
            return replace(self, f_number=self.apertures.turned(max(self.f_number or 0.0, widest), steps))
        if ring == "shutter":
            return replace(self, exposure_time_s=SHUTTER_S.turned(self.exposure_time_s, steps), is_automatic=False)
        if ring == "iso":
            return replace(self, iso=ISO.turned(self.iso, steps))
        if ring == "zoom":
            zooms = self.zooms
            return self.zoomed(zooms.turned(self.focal_length_mm, _ZOOM_KEY_STEPS * steps)) if zooms else self
        raise InputError(f'unknown ring "{ring:.40}"; expected aperture, shutter, iso or zoom')

    @property
    def mount(self) -> Mount:
        """Lens, film and zoom: the settings that undo and redo restore."""
        return Mount(self.lens, self.film, self.zoom)

    def film_for(self, lens: Lens) -> Film:
        """Returns the film behind another lens: its own, or that of the calibration."""
        return self.film if self.geometry is not None else Film.for_lens(lens)

    def with_mount(self, mount: Mount) -> CameraControls:
        """Returns the controls with another lens and its film; the picture's width in pixels is retained."""
        film = of_width(mount.film, self.film.resolution[0], self.pixel_aspect)
        return replace(self, lens=mount.lens, zoom=mount.zoom, film=film)

    def with_lens(self, lens: Lens) -> CameraControls:
        """Returns the controls with another or edited lens; the zoom is retained if the lens has that position, or
        clamped to its range."""
        changed = replace(self, lens=lens, zoom=self.zoom if self.zoom in lens.zoom_positions else lens.zoom_position)
        if isinstance(self.zoom, float) and changed.zooms:
            ends = sorted(changed.zooms.values)
            return changed.zoomed(min(max(self.zoom, ends[0]), ends[-1]))
        return changed

    def focused_within_reach(self) -> CameraControls:
        """Returns the controls, with the focus at the nearest focus of the lens if it is closer than that. Raises
        InputError if the lens cannot be focused and has no nearest focus."""
        try:
            self.set_lens  # noqa: B018
        except InputError:
            nearest = self.body.nearest_focus_m
            if not nearest > self.focus_m:
                raise
            return replace(self, focus_m=nearest)
        return self
