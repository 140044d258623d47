"""Derivatives of pictures by the lens, its focus and stop, and the camera's pose: rc.render_gradient."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from .._core import Camera, InputError, Lens, RenderSettings, Scene
from ..settings import MAX_SPP, settings_of, whole_number
from .dual_array import Doubles
from .variable import Variable, checked

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .._core import _SettingsKwargs

Parameter = str | Variable
#: A parameter, or a direction: rates of some parameters.
Direction = Parameter | Mapping[Parameter, float]
Floats = NDArray[np.float32]
_Key = tuple[str, int, int, int]  # Variable.as_tuple

# Numbers of a camera behind those of the lens, as the core orders them: _PictureGradient.
_FILM, _POSE, _STOP, _RIMS, _OTHERS = 0, 6, 12, 13, 14
_STEP = 2e-3  # of differences by settings of rings, relative
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
    "rim_scale": (_RIMS, 1.0),
}
PARAMETERS = (*_SINGLE, "focus_distance_m", "focal_length_mm", "f_number", "exposure_time_s")


@dataclass(frozen=True)
class _Numbers:
    """The numbers of a camera on which parameters depend.

    variables: of the lens. directions: (P, N), derivatives of the numbers by the parameters. growth: (P,), derivatives
    of the logarithm of the exposure by the parameters at fixed numbers.
    """

    variables: list[Variable]
    directions: Doubles
    growth: Doubles

    @property
    def move_camera(self) -> bool:
        """True if a parameter changes the camera's pose."""
        first = len(self.variables) + _POSE
        return bool(np.any(self.directions[:, first : first + 6]))


def render_gradient(
    scene: Scene,
    camera: Camera,
    parameters: Direction | Sequence[Direction],
    adjoint: ArrayLike | None = None,
    *,
    outline_spp: int | None = None,
    control_spp: int | None = None,
    device: str = "auto",
    settings: RenderSettings | None = None,
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
      "rim_scale": factor, now 1, of the rims that vignette: the clear semi-diameters of all surfaces but the stop;
      "focus_distance_m", "f_number": settings of the lens's rings; "focal_length_mm": setting of the zoom ring, as
        the focal length of the lens focused at infinity; "exposure_time_s", unless something moves;
      a dict of such parameters and their rates: a parameter by which all of these change.
    adjoint: (H, W, 3), derivatives of a function of the picture's exposure (lux seconds) by its pixels; returns the
      derivatives of the function by the parameters, (P,). None: returns those of the picture, (P, H, W, 3).
    outline_spp: samples per pixel on the outline of the pupil, by default spp / 16. control_spp: samples per pixel, of
      other random numbers, of a first picture that serves as control variate for the pose, by default the larger of
      spp / 16 and min(4, spp / 4); 0: none.
    device: as in rc.render, but a single GPU. Only derivatives with an adjoint run on GPUs, for lenses without freeform
      surfaces; "auto" takes the CPU for all others. Both devices have the same samples, but for roundings.
    settings, changes: settings of rc.render. Without settings, the filter of the pixels is the tent; the box, whose
      derivative has no finite variance, is refused. Derivatives take no noise goal, and no effect but dispersion. They
      trace no lights, so that the images of point lights and suns themselves are missing.

    The derivative is taken at fixed rays of the scene (docs/picture-derivatives.md). Raises InputError for what is not
    supported, by name.
    """
    if isinstance(parameters, (str, Variable, Mapping)):
        parameters = [parameters]
    final = final_settings(settings, changes)
    numbers = _numbers_of(camera, parameters)
    if adjoint is None and device == "auto":
        device = "cpu"
    of_picture = _core._PictureGradient(
        scene, camera, final, [variable.as_tuple() for variable in numbers.variables], device
    )
    if numbers.growth.any() and of_picture.scene_moves:
        raise InputError("the derivative by exposure_time_s needs a scene in which nothing moves during the exposure")
    spp = _spp_of(final)
    # The noise of few samples would be that of the control variate.
    default_control = max(1, spp // 16, min(4, spp // 4))
    control_count = default_control if control_spp is None else whole_number("control_spp", control_spp, 0, MAX_SPP)
    samples: dict[str, Any] = {
        "seed": final.seed,
        "spp": spp,
        "outline_spp": max(1, spp // 16) if outline_spp is None else outline_spp,
    }
    uses_control = control_count > 0 and numbers.move_camera
    control = _control(of_picture, final.seed, control_count) if uses_control else None
    picture = of_picture.picture(seed=final.seed, spp=spp).astype(float) if numbers.growth.any() else None
    if adjoint is not None:
        of_pixels = np.asarray(adjoint, np.float32)
        gradient: Doubles = numbers.directions @ of_picture.reverse(of_pixels, control, **samples)
        if picture is not None:
            gradient += numbers.growth * (of_pixels * picture).sum()
        return gradient
    pictures = of_picture.forward(numbers.directions, control, **samples)
    if picture is not None:
        pictures += np.multiply.outer(numbers.growth, picture)
    return pictures


def are_distinct(parameters: Sequence[Parameter]) -> bool:
    """True if no parameter occurs twice. Bounds do not distinguish variables."""
    return len({p if isinstance(p, str) else p.as_tuple() for p in parameters}) == len(parameters)


def final_settings(settings: RenderSettings | None, changes: _SettingsKwargs) -> RenderSettings:
    """The settings of a derivative. Raises InputError."""
    final = settings_of(settings, {"filter": "tent", **changes} if settings is None else changes)
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


def _numbers_of(camera: Camera, parameters: Sequence[Direction]) -> _Numbers:
    """Derivatives of the camera's numbers by the parameters. Raises InputError."""
    lens = camera.lens
    if not parameters:
        raise InputError(f"parameters must have at least one Variable or name: {', '.join(PARAMETERS)}")
    if not are_distinct([p for p in parameters if not isinstance(p, Mapping)]):
        raise InputError("parameters must be distinct")
    # Rates of variables of the lens, and of the numbers behind them, for each parameter.
    rows: list[tuple[dict[_Key, float], dict[int, float]]] = []
    variables: dict[_Key, Variable] = {}
    growth = np.zeros(len(parameters))
    for position, direction in enumerate(parameters):
        of_lens: dict[_Key, float] = defaultdict(float)
        of_others: dict[int, float] = defaultdict(float)
        for parameter, factor in (direction if isinstance(direction, Mapping) else {direction: 1.0}).items():
            if parameter == "exposure_time_s":
                growth[position] += factor / camera.exposure_time_s
                continue
            by_variable, by_other = _rates_of(lens, parameter)
            for variable, rate in by_variable.items():
                variables.setdefault(variable.as_tuple(), variable)
                of_lens[variable.as_tuple()] += factor * rate
            for index, rate in by_other.items():
                of_others[index] += factor * rate
        rows.append((of_lens, of_others))
    order = {key: index for index, key in enumerate(variables)}
    directions = np.zeros((len(parameters), len(order) + _OTHERS))
    for row, (of_lens, of_others) in zip(directions, rows, strict=True):
        for key, rate in of_lens.items():
            row[order[key]] = rate
        for index, rate in of_others.items():
            row[len(order) + index] = rate
    return _Numbers(list(variables.values()), directions, growth)


def _rates_of(lens: Lens, parameter: Parameter) -> tuple[dict[Variable, float], dict[int, float]]:
    """Derivatives of variables of the lens, and of the camera's other numbers, by a parameter. Raises InputError."""
    if isinstance(parameter, Variable):
        checked(lens, [parameter])
        return {parameter: 1.0}, {}
    if parameter == "rim_scale" and len(lens.surfaces) == 1:
        raise InputError("the derivative by rim_scale needs a surface besides the stop")
    if parameter in _SINGLE:
        index, factor = _SINGLE[parameter]
        return {}, {index: factor}
    if parameter in _RINGS:
        of_distances, of_stop = ring_rates(lens, parameter)
        return of_distances, {_STOP: of_stop}
    raise InputError(f"unknown parameter {parameter!r:.60}; expected a Variable or one of {', '.join(PARAMETERS)}")


def _rate(function: Callable[[float], NDArray[np.float64]], at: float, first: float) -> NDArray[np.float64]:
    """Derivative of a function that is smooth from `first` on, by differences of fourth order: exact to about 1e-9 of
    itself. They are one-sided if `first` is near."""
    step = _STEP * at
    if at - 2 * step < first:
        here = function(at)  # whose differences are exactly 0 for numbers that do not change
        weights = enumerate((48, -36, 16, -3), start=1)
        return np.asarray(sum(w * (function(at + i * step) - here) for i, w in weights) / (12 * step))
    near, far = function(at + step) - function(at - step), function(at + 2 * step) - function(at - 2 * step)
    return (8 * near - far) / (12 * step)


def ring_rates(lens: Lens, parameter: str) -> tuple[dict[Variable, float], float]:
    """Derivatives of the lens's distances and of its diaphragm's radius (mm) by a parameter that is a ring.

    Those of the solution of the ring's equation, by the implicit function theorem. Raises InputError.
    """
    set_ring, at, first = _RINGS[parameter](lens)
    last = len(lens.surfaces) - 1

    def numbers(setting: float) -> NDArray[np.float64]:
        lens = set_ring(setting)
        distances = [s.thickness_mm for s in lens.surfaces[:-1]]
        return np.array([*distances, lens.film_distance_mm, lens.stop_semi_diameter_mm])

    *rates, of_stop = _rate(numbers, at, first).tolist()
    variables = [*map(Variable.thickness, range(last)), Variable.film_distance()]
    return {v: rate for v, rate in zip(variables, rates, strict=True) if rate != 0}, of_stop


#: The function that sets a ring, the ring's current setting, and its smallest one.
_Ring = tuple[Callable[[float], Lens], float, float]


def _focus_ring(lens: Lens) -> _Ring:
    """The ring of the focus distance in metres."""
    if not math.isfinite(lens.focus_distance_m):
        raise InputError("the derivative by focus_distance_m does not exist at infinity; focus the lens nearer")
    return lens.focused, lens.focus_distance_m, lens.nearest_focus_m


def _zoom_ring(lens: Lens) -> _Ring:
    """The ring of the focal length, focused at infinity, in mm."""
    ends = lens.zoom_focal_lengths_mm
    if not ends:
        raise InputError("the derivative by focal_length_mm needs a zoom lens")
    if _is_wide_open(lens):
        raise InputError("the derivative by focal_length_mm needs a diaphragm that is stopped down")
    focal_length = lens.focused(math.inf).first_order().effective_focal_length_mm
    if not min(ends) < (1 - 2 * _STEP) * focal_length or not (1 + 2 * _STEP) * focal_length < max(ends):
        raise InputError("the derivative by focal_length_mm does not exist at the ends of the zoom range")
    return lens.zoomed, focal_length, min(ends)


def _stop_ring(lens: Lens) -> _Ring:
    """The ring of the f-number."""
    if _is_wide_open(lens):
        raise InputError("the derivative by f_number does not exist wide open; stop the lens down first")
    return lens.stopped_down, lens.f_number, lens.wide_open().f_number


def _is_wide_open(lens: Lens) -> bool:
    return lens.stop_semi_diameter_mm >= lens.surfaces[lens.stop_index].clear_semi_diameter_mm


#: Parameters that are rings of the lens.
_RINGS = {"focus_distance_m": _focus_ring, "focal_length_mm": _zoom_ring, "f_number": _stop_ring}
