"""Cameras as a function of the parameters of rc.render_gradient: rc.CameraParameters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from .._core import Camera, InputError, Lens, RenderSettings, Scene
from ..render import render
from ..vision.rig import pose_of
from .dual_array import Doubles
from .picture import PARAMETERS, Floats, Parameter, are_distinct, final_settings, render_gradient, ring_rates
from .variable import SETTABLE, Variable, check_surface_exists, with_values

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .._core import _SettingsKwargs

_POSITION = ("right_m", "up_m", "backward_m")
_ROTATION = ("pitch_deg", "yaw_deg", "roll_deg")
_SHIFT = ("film_shift_right_mm", "film_shift_up_mm")
_RINGS = ("focus_distance_m", "f_number")
_RIMS = "rim_scale"


@dataclass(frozen=True)
class CameraParameters:
    """A camera whose parameters, as in rc.render_gradient, have values.

    parameters: names of rc.render_gradient except film tilts, focal_length_mm and exposure_time_s, and Variables that
      Variable.set supports. Their values:
      right_m, up_m, backward_m: translation along the axes of `camera`, which has 0;
      pitch_deg, yaw_deg, roll_deg: rotation vector along the same axes;
      film_shift_right_mm, film_shift_up_mm, focus_distance_m, f_number: themselves, with the rings of `camera`;
      rim_scale: factor of the clear semi-diameters of all surfaces of `camera` but the stop;
      Variables: themselves at the focus of `camera`; if the ring moves a distance, both changes are added.
    Raises InputError for parameters that cannot be set, and at values for which there is no camera.
    """

    camera: Camera
    parameters: tuple[Parameter, ...]

    def __init__(self, camera: Camera, parameters: Parameter | Sequence[Parameter]) -> None:
        listed = (parameters,) if isinstance(parameters, (str, Variable)) else tuple(parameters)
        settable = (*_POSITION, *_ROTATION, *_SHIFT, *_RINGS, _RIMS)
        for parameter in listed:
            if isinstance(parameter, Variable):
                if parameter.quantity not in SETTABLE:
                    raise InputError(f"the {parameter} cannot be set; expected one of {', '.join(SETTABLE)}")
                check_surface_exists(camera.lens, parameter.surface)
            elif parameter not in settable:
                raise InputError(
                    f"{parameter} cannot be set"
                    if parameter in PARAMETERS
                    else f"unknown parameter {parameter!r:.60}; expected a Variable or one of {', '.join(settable)}"
                )
        if not listed or not are_distinct(listed):
            raise InputError("parameters must be distinct, and at least one")
        object.__setattr__(self, "camera", camera)
        object.__setattr__(self, "parameters", listed)

    @property
    def values(self) -> Doubles:
        """(P,): values of the camera."""
        return np.array([self._value_of(p) for p in self.parameters])

    def camera_at(self, values: ArrayLike) -> Camera:
        """Returns the camera with these values, (P,)."""
        at = self._named(values)
        camera, lens = self.camera, self._turned(at)
        if at.get(_RIMS, 1.0) != 1:
            lens = with_rims(lens, at[_RIMS])
        variables = [p for p in self.parameters if isinstance(p, Variable)]
        if variables:
            shifted = [v.of(lens.surfaces[v.surface]) + at[v] - self._value_of(v) for v in variables]
            lens = with_values(lens, variables, shifted)
        if lens is not camera.lens:
            camera = camera.replace(lens=lens)
        if any(name in at for name in _SHIFT):
            right, up = (at.get(name, old) for name, old in zip(_SHIFT, camera.film.shift_mm, strict=True))
            camera = camera.replace(film=camera.film.replace(shift_mm=(right, up)))
        if any(name in at for name in (*_POSITION, *_ROTATION)):
            pose = pose_of(camera)
            axes, position = pose[:3, :3], pose[:3, 3]
            turned = axes @ rotation_matrix(self._rotation(at))
            moved = position + axes @ [at.get(name, 0.0) for name in _POSITION]
            camera = camera.replace(position=tuple(moved), look_at=tuple(moved - turned[:, 2]), up=tuple(turned[:, 1]))
        return camera

    def render(
        self,
        scene: Scene,
        values: ArrayLike,
        *,
        device: str = "auto",
        settings: RenderSettings | None = None,
        **changes: Unpack[_SettingsKwargs],
    ) -> Floats:
        """Returns the picture with these values, as rc.render_gradient differentiates it: lux seconds, (H, W, 3).

        device: as for rc.render.
        """
        final = final_settings(settings, changes).with_(light_tracing="off")
        return render(scene, self.camera_at(values), final, device=device).pixels

    def gradient(
        self, scene: Scene, values: ArrayLike, adjoint: ArrayLike | None = None, **arguments: Any
    ) -> NDArray[np.floating]:
        """Returns the derivatives by the values, at these values: (P,) with an adjoint, else (P, H, W, 3).

        adjoint, arguments: as for rc.render_gradient.
        """
        camera = self.camera_at(values)
        return render_gradient(scene, camera, self._directions(values, camera), adjoint, **arguments)

    def directions(self, values: ArrayLike) -> list[dict[Parameter, float]]:
        """Returns the parameters of rc.render_gradient, at the camera of these values, that are its derivatives by the
        values."""
        return self._directions(values, self.camera_at(values))

    def _directions(self, values: ArrayLike, camera: Camera) -> list[dict[Parameter, float]]:
        """See directions. camera: that of the values."""
        at = self._named(values)
        rotation = self._rotation(at)
        of_position, of_rotation = rotation_matrix(rotation).T, right_jacobian(rotation)
        # The rings' scales are those of the lens of `self.camera`, whose surfaces are not changed.
        nominal = self._turned(at)
        rings = {p: ring_rates(nominal, p) for p in self.parameters if p in _RINGS}
        moves_stop = any(of_stop for _, of_stop in rings.values())
        by_f_number = ring_rates(camera.lens, "f_number")[1] if moves_stop else 1.0

        def direction(parameter: Parameter) -> dict[Parameter, float]:
            for names, matrix in ((_POSITION, of_position), (_ROTATION, of_rotation)):
                if parameter in names:
                    return dict(zip(names, matrix[:, names.index(parameter)].tolist(), strict=True))
            if parameter in rings:
                of_distances, of_stop = rings[parameter]
                rates: dict[Parameter, float] = dict(of_distances.items())
                return rates | ({"f_number": of_stop / by_f_number} if of_stop else {})
            # rc.render_gradient differentiates by a factor of the rims at these values.
            return {parameter: 1 / at[_RIMS] if parameter == _RIMS else 1.0}

        return [direction(parameter) for parameter in self.parameters]

    def _value_of(self, parameter: Parameter) -> float:
        """Value of a parameter of `camera`."""
        lens = self.camera.lens
        if isinstance(parameter, Variable):
            return parameter.of(lens.surfaces[parameter.surface])
        if parameter in _SHIFT:
            return self.camera.film.shift_mm[_SHIFT.index(parameter)]
        return {"focus_distance_m": lens.focus_distance_m, "f_number": lens.f_number, _RIMS: 1.0}.get(parameter, 0.0)

    def _named(self, values: ArrayLike) -> dict[Parameter, float]:
        """Values by parameter. Raises InputError."""
        listed = np.asarray(values, float)
        if listed.shape != (len(self.parameters),) or not np.isfinite(listed).all():
            raise InputError(f"values must be {len(self.parameters)} finite numbers, one for each parameter")
        return dict(zip(self.parameters, listed.tolist(), strict=True))

    def _turned(self, at: dict[Parameter, float]) -> Lens:
        """The lens of `camera` with its rings at the values."""
        lens = self.camera.lens
        if "focus_distance_m" in at:
            lens = lens.focused(at["focus_distance_m"])
        return lens.stopped_down(at["f_number"]) if "f_number" in at else lens

    def _rotation(self, at: dict[Parameter, float]) -> Doubles:
        """Rotation vector, (3,), radians."""
        return np.radians([at.get(name, 0.0) for name in _ROTATION])


def with_rims(lens: Lens, scale: float) -> Lens:
    """Returns the lens with the clear semi-diameters of all surfaces but the stop scaled. Raises InputError if that
    lens cannot be built."""
    return lens.with_surfaces(
        {
            i: s.replace(clear_semi_diameter_mm=scale * s.clear_semi_diameter_mm)
            for i, s in enumerate(lens.surfaces)
            if i != lens.stop_index
        }
    )


def rotation_matrix(vector: Doubles) -> Doubles:
    """Returns the rotation by a rotation vector, radians."""
    return np.asarray(Rotation.from_rotvec(vector).as_matrix())


def right_jacobian(vector: Doubles) -> Doubles:
    """Returns the derivative of the rotation, as a rotation vector along the rotated axes, by its rotation vector
    (Sola et al., A micro Lie theory, 2018, on SO(3))."""
    x, y, z = vector
    angle, cross = float(np.linalg.norm(vector)), np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    # (1 - cos(a)) / a^2 = (sin(a / 2) / (a / 2))^2 / 2 does not cancel at small angles, where (a - sin(a)) / a^3 does.
    third = 1 / 6 if angle < 1e-4 else (angle - np.sin(angle)) / angle**3
    return np.asarray(np.eye(3) - np.sinc(angle / 2 / np.pi) ** 2 / 2 * cross + third * cross @ cross)
