"""Derivatives of pictures by the lens, its focus and stop, and the camera's pose: rc.render_gradient."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from .._core import Camera, InputError, Lens, RenderSettings, Scene
from ..settings import settings_of
from .dual_array import Doubles
from .variable import Variable, checked

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .._core import _SettingsKwargs

Parameter = str | Variable
Floats = NDArray[np.float32]

# Numbers of a camera behind those of the lens, as the core orders them: _PictureGradient.
_FILM, _POSE, _STOP, _OTHERS = 0, 6, 12, 13
_PER_M, _PER_DEG = 1000.0, math.pi / 180

#: Parameters that are one number of the camera: its index, and its factor.
_SINGLE = {
    "right_m": (_POSE, _PER_M),
    "up_m": (_POSE + 1, _PER_M),
    "backward_m": (_POSE + 2, _PER_M),
    "pitch_deg": (_POSE + 3, _PER_DEG),
    "yaw_deg": (_POSE + 4, _PER_DEG),
    "roll_deg": (_POSE + 5, _PER_DEG),
    # The film's axes are opposite to those of the picture.
    "film_shift_right_mm": (_FILM, -1.0),
    "film_shift_up_mm": (_FILM + 1, -1.0),
    "film_tilt_x_deg": (_FILM + 3, _PER_DEG),
    "film_tilt_y_deg": (_FILM + 4, _PER_DEG),
}
PARAMETERS = (*_SINGLE, "focus_distance_m", "f_number")


@dataclass(frozen=True)
class _Numbers:
    """The numbers of a camera on which parameters depend.

    variables: of the lens. directions: (P, N), derivatives of the numbers by the parameters.
    """

    variables: list[Variable]
    directions: Doubles

    @property
    def move_camera(self) -> bool:
        """True if a parameter changes the pose."""
        first = len(self.variables) + _POSE
        return bool(np.any(self.directions[:, first : first + 6] != 0))


def render_gradient(
    scene: Scene,
    camera: Camera,
    parameters: Parameter | Sequence[Parameter],
    adjoint: ArrayLike | None = None,
    *,
    filter: str = "tent",
    outline_spp: int | None = None,
    control_spp: int | None = None,
    settings: RenderSettings | None = None,
    device: str = "auto",
    **changes: Unpack[_SettingsKwargs],
) -> NDArray[np.floating]:
    """Derivatives of a picture by parameters of its camera: unbiased, with occlusion, shadows and vignetting.

    parameters: one or some of these (P in all):
      a Variable of the lens (but film_distance moves the lens: the film keeps its position in the scene);
      "right_m", "up_m", "backward_m": position of the camera along its own axes;
      "pitch_deg", "yaw_deg", "roll_deg": rotation about its axes right, up and backward, counterclockwise as seen
        against the axis, through the film's centre;
      "film_shift_right_mm", "film_shift_up_mm": Film.shift_mm; "film_tilt_x_deg", "film_tilt_y_deg": rotation of the
        film about its own axes;
      "focus_distance_m", "f_number": settings of the lens's rings.
    adjoint: (H, W, 3), derivatives of a function of the picture's exposure (lux seconds) by its pixels; returns the
      derivatives of the function by the parameters, (P,). None: returns those of the picture, (P, H, W, 3).
    filter: pixel filter of the picture, "tent" (two pixels wide) or "gaussian" (three pixels wide, standard deviation
      half a pixel); the box, whose derivative has no finite variance, is refused.
    outline_spp: samples per pixel on the outline of the pupil, by default spp / 4. control_spp: samples per pixel, of
      other random numbers, of a first picture that serves as control variate for the pose, by default spp / 4; 0: none.
    settings, changes: settings of rc.render; the samples on the film are those of rc.render with the same seed.
      Derivatives take no noise goal, and no effect but dispersion. They trace no lights, so that the images of point
      lights and suns themselves are missing.
    device: as in rc.render, but a single GPU. Only derivatives with an adjoint run on GPUs, for lenses without freeform
      surfaces; "auto" takes the CPU for all others. Both devices have the same samples, but for roundings.

    The derivative is taken at fixed rays of the scene (docs/picture-derivatives.md). Raises InputError for what is not
    supported, by name.
    """
    if isinstance(parameters, (str, Variable)):
        parameters = [parameters]
    final = _final_settings(settings, changes)
    numbers = _numbers_of(camera.lens, parameters)
    if adjoint is None and device == "auto":
        device = "cpu"
    of_picture = _core._PictureGradient(
        scene, camera, final, filter, [variable.as_tuple() for variable in numbers.variables], device
    )
    spp = _spp_of(final)
    control_count = max(1, spp // 4) if control_spp is None else control_spp
    samples: dict[str, Any] = {
        "seed": final.seed,
        "spp": spp,
        "outline_spp": max(1, spp // 4) if outline_spp is None else outline_spp,
    }
    uses_control = control_count > 0 and numbers.move_camera
    control = _control(of_picture, final.seed, control_count) if uses_control else None
    if adjoint is not None:
        of_pixels = np.asarray(adjoint, np.float32)
        gradient: Doubles = numbers.directions @ of_picture.reverse(of_pixels, control, **samples)
        return gradient
    return of_picture.forward(numbers.directions, control, **samples)


def render_filtered(
    scene: Scene,
    camera: Camera,
    *,
    filter: str = "tent",
    settings: RenderSettings | None = None,
    device: str = "auto",
    **changes: Unpack[_SettingsKwargs],
) -> Floats:
    """The picture that render_gradient differentiates: exposure in lux seconds, (H, W, 3).

    filter: "tent" or "gaussian". The samples are those of rc.render with the same seed. Each counts for all pixels
    whose filters it reaches; samples beyond the film's border count for the pixels at the border. device: as in
    render_gradient.
    Raises InputError as render_gradient.
    """
    final = _final_settings(settings, changes)
    of_picture = _core._PictureGradient(scene, camera, final, filter, [], device)
    return of_picture.picture(seed=final.seed, spp=_spp_of(final))


def _final_settings(settings: RenderSettings | None, changes: _SettingsKwargs) -> RenderSettings:
    """The settings of a derivative. Raises InputError."""
    final = settings_of(settings, changes)
    return final.with_(effects=()) if tuple(final.effects) == ("auto",) else final


def _spp_of(settings: RenderSettings) -> int:
    """Samples per pixel. Raises InputError for a noise goal."""
    if not isinstance(settings.spp, int):
        raise InputError("derivatives of pictures need a number of samples per pixel, spp, and take no noise goal")
    return settings.spp


def _control(of_picture: _core._PictureGradient, seed: int, spp: int) -> Floats:
    """Mean radiance of the light of each pixel and channel, from samples of their own."""
    samples: dict[str, Any] = {"seed": (seed + 0x9E3779B9) % 2**32, "spp": spp}
    even = of_picture.picture(**samples, uniform=True)
    return np.where(even > 0, of_picture.picture(**samples) / np.where(even > 0, even, 1), 0)


def _numbers_of(lens: Lens, parameters: Sequence[Parameter]) -> _Numbers:
    """Derivatives of the camera's numbers by the parameters. Raises InputError."""
    if not parameters:
        raise InputError(f"parameters must have at least one Variable or name: {', '.join(PARAMETERS)}")
    if len({p if isinstance(p, str) else p.as_tuple() for p in parameters}) < len(parameters):
        raise InputError("parameters must be distinct")
    rates: list[tuple[dict[tuple[str, int, int, int], float], dict[int, float]]] = []
    variables: dict[tuple[str, int, int, int], Variable] = {}
    for parameter in parameters:
        if isinstance(parameter, Variable):
            checked(lens, [parameter])
            variables.setdefault(parameter.as_tuple(), parameter)
            rates.append(({parameter.as_tuple(): 1.0}, {}))
        elif parameter in _SINGLE:
            index, factor = _SINGLE[parameter]
            rates.append(({}, {index: factor}))
        elif parameter == "focus_distance_m":
            of_focus = _focus_rates(lens)
            for variable in of_focus:
                variables.setdefault(variable.as_tuple(), variable)
            rates.append(({variable.as_tuple(): rate for variable, rate in of_focus.items()}, {}))
        elif parameter == "f_number":
            rates.append(({}, {_STOP: _stop_rate(lens)}))
        else:
            raise InputError(
                f"unknown parameter {parameter!r:.60}; expected a Variable or one of {', '.join(PARAMETERS)}"
            )
    order = {key: index for index, key in enumerate(variables)}
    directions = np.zeros((len(parameters), len(order) + _OTHERS))
    for row, (of_lens, of_others) in zip(directions, rates, strict=True):
        for key, rate in of_lens.items():
            row[order[key]] = rate
        for index, rate in of_others.items():
            row[len(order) + index] = rate
    return _Numbers(list(variables.values()), directions)


def _rate(function: Callable[[float], NDArray[np.float64]], at: float) -> NDArray[np.float64]:
    """Derivative of a smooth function by differences of fourth order: exact to about 1e-9 of itself."""
    step = 2e-3 * at
    near, far = function(at + step) - function(at - step), function(at + 2 * step) - function(at - 2 * step)
    return (8 * near - far) / (12 * step)


def _focus_rates(lens: Lens) -> dict[Variable, float]:
    """Derivatives of the lens's distances by its focus distance in metres: those of the solution of the focusing
    equation, by the implicit function theorem."""
    if not math.isfinite(lens.focus_distance_m):
        raise InputError("the derivative by focus_distance_m does not exist at infinity; focus the lens nearer")
    last = len(lens.surfaces) - 1

    def distances(focus_m: float) -> NDArray[np.float64]:
        focused = lens.focused(focus_m)
        return np.array([s.thickness_mm for s in focused.surfaces[:-1]] + [focused.film_distance_mm])

    rates = _rate(distances, lens.focus_distance_m)
    variables = [Variable.thickness(i) for i in range(last)] + [Variable.film_distance()]
    return {v: float(rate) for v, rate in zip(variables, rates, strict=True) if rate != 0}


def _stop_rate(lens: Lens) -> float:
    """Derivative of the diaphragm's radius by the f-number, mm."""
    if lens.stop_semi_diameter_mm >= lens.surfaces[lens.stop_index].clear_semi_diameter_mm:
        raise InputError("the derivative by f_number does not exist wide open; stop the lens down first")
    return float(_rate(lambda n: np.array(lens.stopped_down(n).stop_semi_diameter_mm), lens.f_number))
