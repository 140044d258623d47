import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from enum import IntEnum
from os import PathLike
from types import EllipsisType
from typing import Any, ClassVar, Generic, Literal, NamedTuple, Protocol, TypeAlias, TypedDict, final, overload

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike, DTypeLike, NDArray
from typing_extensions import Self, TypeVar, Unpack

from .derivatives import Gradient, Variable
from .image import Image
from .raw_image import RawImage

__version__: str
_STATE_FORMAT: int

_Path: TypeAlias = str | PathLike[str]
_Triple: TypeAlias = Sequence[float] | NDArray[np.floating[Any]] | NDArray[np.integer[Any]]
_PoseKey: TypeAlias = tuple[float, _Triple, _Triple] | tuple[float, _Triple, _Triple, _Triple]
_Material: TypeAlias = float | tuple[float, float] | str | Glass | None
_Table: TypeAlias = Sequence[Sequence[float]]
_CoatingMaterial: TypeAlias = complex | tuple[float, float] | Sequence[tuple[float, float, float]] | str | Glass
_Coating: TypeAlias = str | Coating
_Progress: TypeAlias = Callable[[float], bool | None]

# Arrays of numpy, but for rays in a GPU's memory.
_Doubles = TypeVar("_Doubles", default=NDArray[np.float64])
_Floats = TypeVar("_Floats", default=NDArray[np.float32])
_Integers = TypeVar("_Integers", default=NDArray[np.int32])

class _CudaArray(Protocol):
    @property
    def __cuda_array_interface__(self) -> dict[str, Any]: ...

# Nothing changes a value: its copies are the same object.
class _Value:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...

class _LargeValue(_Value):
    __hash__: ClassVar[None]  # type: ignore[assignment]

def one_line(message: str) -> str: ...
def _form_terms() -> tuple[str, ...]: ...
def _record_inputs(is_on: bool) -> None: ...
def _check_no_input(output: bytes) -> None: ...

class RealcamError(Exception): ...
class InputError(RealcamError, ValueError): ...
class ArgumentError(InputError, TypeError): ...
class NothingToPlan(InputError): ...  # noqa: N818

class LensFileError(RealcamError):
    file: str
    line: int
    surface: int
    glass: str
    candidate: str
    can_be_forced: bool

class SceneFileError(RealcamError): ...
class ImageFileError(RealcamError): ...
class DeviceError(RealcamError): ...
class Cancelled(RealcamError): ...  # noqa: N818

class RayStatus(IntEnum):
    OK = 0
    MISSED = 1
    VIGNETTED = 2
    TOTAL_INTERNAL_REFLECTION = 3
    NO_CONVERGENCE = 4
    BAD_INPUT = 5

class ProjectionStatus(IntEnum):
    OK = 0
    OUTSIDE_PICTURE = 1
    BLOCKED = 2
    BEHIND = 3
    BAD_INPUT = 4

@final
class Glass(_Value):
    @staticmethod
    def constant(index: float) -> Glass: ...
    @staticmethod
    def from_abbe_number(n_d: float, abbe_number: float) -> Glass: ...
    @staticmethod
    def cauchy(coefficients: Sequence[float]) -> Glass: ...
    @staticmethod
    def sellmeier(B: Sequence[float], C: Sequence[float]) -> Glass: ...
    @staticmethod
    def table(points: Sequence[tuple[float, float]]) -> Glass: ...
    @staticmethod
    def named(name: str) -> Glass: ...
    def index(self, wavelength_nm: float) -> float: ...
    @property
    def label(self) -> str: ...

@final
class CoatingResponse:
    @property
    def reflectance_s(self) -> NDArray[np.float64]: ...
    @property
    def reflectance_p(self) -> NDArray[np.float64]: ...
    @property
    def transmittance_s(self) -> NDArray[np.float64]: ...
    @property
    def transmittance_p(self) -> NDArray[np.float64]: ...
    @property
    def absorptance_s(self) -> NDArray[np.float64]: ...
    @property
    def absorptance_p(self) -> NDArray[np.float64]: ...
    @property
    def r_s(self) -> NDArray[np.complex128]: ...
    @property
    def r_p(self) -> NDArray[np.complex128]: ...
    @property
    def t_s(self) -> NDArray[np.complex128]: ...
    @property
    def t_p(self) -> NDArray[np.complex128]: ...

@final
class CoatingLayer(_Value):
    def __init__(
        self,
        material: _CoatingMaterial,
        *,
        thickness_nm: float | None = None,
        thickness_waves: float | None = None,
        design_wavelength_nm: float | None = None,
    ) -> None: ...
    @property
    def thickness_nm(self) -> float: ...
    def index(self, wavelength_nm: float) -> complex: ...

@final
class Coating(_Value):
    def __init__(
        self,
        layers: Sequence[CoatingLayer] = [],
        *,
        metal: _CoatingMaterial | None = None,
        reflectance: float | None = None,
        name: str = "",
    ) -> None: ...
    @staticmethod
    def named(name: str) -> Coating: ...
    @staticmethod
    def quarter_wave(material: _CoatingMaterial = 1.38, design_wavelength_nm: float = 550.0) -> Coating: ...
    @property
    def name(self) -> str: ...
    @property
    def kind(self) -> str: ...
    @property
    def layers(self) -> list[CoatingLayer]: ...
    def response(
        self,
        angle_deg: ArrayLike,
        wavelength_nm: ArrayLike,
        *,
        outside: _Material = None,
        inside: _Material = None,
        from_inside: bool = False,
    ) -> CoatingResponse: ...

@final
class Surface(_Value):
    def __init__(
        self,
        *,
        radius_of_curvature_mm: float = ...,
        thickness_mm: float = 0.0,
        material: _Material = None,
        clear_semi_diameter_mm: float,
        conic: float = 0.0,
        aspheric_coefficients: Mapping[int, float] = {},
        inner_semi_diameter_mm: float = 0.0,
        type: str = "refracting",
        coating: _Coating = "unknown",
        decentre_mm: Sequence[float] = ...,
        tilt_deg: Sequence[float] = ...,
        returns: bool = False,
        form: str | None = None,
        radius_of_curvature_x_mm: float | None = None,
        conic_x: float | None = None,
        radial_terms: Mapping[int, float] | None = None,
        xy_terms: Mapping[tuple[int, int], float] | None = None,
        zernike: Mapping[str, Any] | None = None,
        forbes: Mapping[str, Any] | None = None,
        superconic: Mapping[str, Any] | None = None,
        aperture: Mapping[str, Any] | None = None,
        obscurations: Sequence[Mapping[str, Any]] | None = None,
    ) -> None: ...
    @property
    def radius_of_curvature_mm(self) -> float: ...
    @property
    def curvature_per_mm(self) -> float: ...
    @property
    def thickness_mm(self) -> float: ...
    @property
    def material(self) -> Glass: ...
    @property
    def clear_semi_diameter_mm(self) -> float: ...
    @property
    def inner_semi_diameter_mm(self) -> float: ...
    @property
    def conic(self) -> float: ...
    @property
    def aspheric_coefficients(self) -> dict[int, float]: ...
    @property
    def type(self) -> str: ...
    @property
    def coating(self) -> Coating: ...
    @property
    def decentre_mm(self) -> tuple[float, float, float]: ...
    @property
    def tilt_deg(self) -> tuple[float, float, float]: ...
    @property
    def returns(self) -> bool: ...
    @property
    def form(self) -> str: ...
    @property
    def radius_of_curvature_x_mm(self) -> float: ...
    @property
    def conic_x(self) -> float: ...
    @property
    def radial_terms(self) -> dict[int, float]: ...
    @property
    def xy_terms(self) -> dict[tuple[int, int], float]: ...
    @property
    def zernike(self) -> dict[str, Any]: ...
    @property
    def forbes(self) -> dict[str, Any]: ...
    @property
    def superconic(self) -> dict[str, Any]: ...
    @property
    def aperture(self) -> dict[str, Any]: ...
    @property
    def obscurations(self) -> list[dict[str, Any]]: ...
    def sag_mm(self, radius_mm: float) -> float: ...
    def sag_at_mm(self, x_mm: float, y_mm: float) -> float: ...
    def replace(
        self,
        *,
        radius_of_curvature_mm: float | None = None,
        thickness_mm: float | None = None,
        material: _Material | EllipsisType = ...,
        clear_semi_diameter_mm: float | None = None,
        conic: float | None = None,
        aspheric_coefficients: Mapping[int, float] | None = None,
        inner_semi_diameter_mm: float | None = None,
        type: str | None = None,
        coating: _Coating | None = None,
        decentre_mm: Sequence[float] | None = None,
        tilt_deg: Sequence[float] | None = None,
        returns: bool | None = None,
        form: str | None = None,
        radius_of_curvature_x_mm: float | None = None,
        conic_x: float | None = None,
        radial_terms: Mapping[int, float] | None = None,
        xy_terms: Mapping[tuple[int, int], float] | None = None,
        zernike: Mapping[str, Any] | None = None,
        forbes: Mapping[str, Any] | None = None,
        superconic: Mapping[str, Any] | None = None,
        aperture: Mapping[str, Any] | None = None,
        obscurations: Sequence[Mapping[str, Any]] | None = None,
    ) -> Surface: ...

@final
class FirstOrder(_Value):
    @property
    def effective_focal_length_mm(self) -> float: ...
    @property
    def back_focal_distance_mm(self) -> float: ...
    @property
    def front_focal_distance_mm(self) -> float: ...
    @property
    def f_number(self) -> float: ...
    @property
    def entrance_pupil_position_mm(self) -> float: ...
    @property
    def entrance_pupil_diameter_mm(self) -> float: ...
    @property
    def exit_pupil_position_mm(self) -> float: ...
    @property
    def exit_pupil_diameter_mm(self) -> float: ...
    @property
    def image_index(self) -> float: ...

@final
class Meridian(_Value):
    @property
    def azimuth_deg(self) -> float: ...
    @property
    def focal_length_mm(self) -> float: ...
    @property
    def back_focal_distance_mm(self) -> float: ...
    @property
    def f_number(self) -> float: ...
    @property
    def entrance_pupil_diameter_mm(self) -> float: ...

@final
class DeviceArray:
    @property
    def shape(self) -> tuple[int, ...]: ...
    @property
    def dtype(self) -> np.dtype[Any]: ...
    @property
    def device(self) -> str: ...
    def numpy(self) -> NDArray[Any]: ...
    def __array__(self, dtype: DTypeLike | None = None, *, copy: bool | None = None) -> NDArray[Any]: ...
    def __len__(self) -> int: ...
    @property
    def __cuda_array_interface__(self) -> dict[str, Any]: ...
    def __dlpack__(
        self,
        *,
        stream: int | None = None,
        max_version: tuple[int, int] | None = None,
        dl_device: tuple[int, int] | None = None,
        copy: bool | None = None,
    ) -> Any: ...
    def __dlpack_device__(self) -> tuple[int, int]: ...

@final
class TraceResult(Generic[_Doubles, _Integers]):
    @property
    def origins_mm(self) -> _Doubles: ...
    @property
    def directions(self) -> _Doubles: ...
    @property
    def optical_path_mm(self) -> _Doubles: ...
    @property
    def status(self) -> _Integers: ...
    @property
    def surface_index(self) -> _Integers: ...
    @property
    def transmission(self) -> NDArray[np.float64] | None: ...

@final
class Seidel(_LargeValue):
    @property
    def wavelength_nm(self) -> float: ...
    @property
    def lagrange_invariant_mm(self) -> float: ...
    @property
    def marginal_height_mm(self) -> NDArray[np.float64]: ...
    @property
    def marginal_slope(self) -> NDArray[np.float64]: ...
    @property
    def marginal_invariant(self) -> NDArray[np.float64]: ...
    @property
    def chief_height_mm(self) -> NDArray[np.float64]: ...
    @property
    def chief_slope(self) -> NDArray[np.float64]: ...
    @property
    def chief_invariant(self) -> NDArray[np.float64]: ...
    @property
    def spherical_mm(self) -> NDArray[np.float64]: ...
    @property
    def tangential_coma_mm(self) -> NDArray[np.float64]: ...
    @property
    def tangential_astigmatism_mm(self) -> NDArray[np.float64]: ...
    @property
    def sagittal_astigmatism_mm(self) -> NDArray[np.float64]: ...
    @property
    def petzval_mm(self) -> NDArray[np.float64]: ...
    @property
    def distortion_mm(self) -> NDArray[np.float64]: ...
    @property
    def axial_colour_mm(self) -> NDArray[np.float64]: ...
    @property
    def lateral_colour_mm(self) -> NDArray[np.float64]: ...
    @property
    def petzval_curvature_per_mm(self) -> NDArray[np.float64]: ...
    @property
    def seidel_mm(self) -> NDArray[np.float64]: ...
    @property
    def colour_mm(self) -> NDArray[np.float64]: ...
    @property
    def coefficients_waves(self) -> NDArray[np.float64]: ...

@final
class Ghost(_Value):
    @property
    def first(self) -> int: ...
    @property
    def second(self) -> int: ...
    @property
    def effective_focal_length_mm(self) -> float: ...
    @property
    def back_focal_distance_mm(self) -> float: ...
    @property
    def share(self) -> float | None: ...

@final
class FilmPupil(_LargeValue):
    @property
    def irradiance(self) -> float: ...
    @property
    def outline(self) -> NDArray[np.float64]: ...

@final
class AimedRays:
    @property
    def origins_mm(self) -> NDArray[np.float64]: ...
    @property
    def directions(self) -> NDArray[np.float64]: ...
    @property
    def status(self) -> NDArray[np.int32]: ...

@final
class Wavefront(_LargeValue):
    @property
    def opd_waves(self) -> NDArray[np.float64]: ...
    @property
    def pupil(self) -> NDArray[np.float64]: ...
    @property
    def weights(self) -> NDArray[np.float64]: ...
    @property
    def status(self) -> NDArray[np.int32]: ...
    def map_waves(self) -> NDArray[np.float64]: ...
    @property
    def rms_waves(self) -> float: ...
    @property
    def peak_to_valley_waves(self) -> float: ...
    @property
    def strehl(self) -> float: ...
    @property
    def strehl_marechal(self) -> float: ...
    @property
    def centre_mm(self) -> tuple[float, float, float]: ...
    @property
    def reference_radius_mm(self) -> float: ...
    @property
    def stop_radius_mm(self) -> float: ...
    @property
    def wavelength_nm(self) -> float: ...

@final
class PSF(_LargeValue):
    @property
    def values(self) -> NDArray[np.float64]: ...
    @property
    def pitch_um(self) -> float: ...
    @property
    def x_um(self) -> NDArray[np.float64]: ...
    @property
    def y_um(self) -> NDArray[np.float64]: ...
    @property
    def centre_mm(self) -> tuple[float, float]: ...
    @property
    def wavelength_nm(self) -> float: ...
    @property
    def wavelengths_nm(self) -> NDArray[np.float64]: ...
    @property
    def weights(self) -> NDArray[np.float64]: ...
    @property
    def strehl(self) -> float: ...
    @property
    def rays(self) -> int: ...
    @property
    def energy(self) -> float: ...
    def energy_inside(self, radius_um: float, about_um: tuple[float, float] = (0.0, 0.0)) -> float: ...
    def mtf(
        self, frequencies_per_mm: ArrayLike | None = None
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]: ...

@final
class RayBundle:
    @property
    def entry_mm(self) -> NDArray[np.float64]: ...
    @property
    def energy(self) -> NDArray[np.float64]: ...
    @property
    def points_mm(self) -> NDArray[np.float64]: ...
    @property
    def directions(self) -> NDArray[np.float64]: ...
    @property
    def slopes(self) -> NDArray[np.float64]: ...
    @property
    def path_mm(self) -> NDArray[np.float64]: ...
    @property
    def amplitude(self) -> NDArray[np.float64]: ...
    @property
    def edge_entry_mm(self) -> NDArray[np.float64]: ...
    @property
    def edge_slopes(self) -> NDArray[np.float64]: ...
    @property
    def chief_ray_mm(self) -> tuple[float, float]: ...
    @property
    def tangential_focus_mm(self) -> float: ...
    @property
    def sagittal_focus_mm(self) -> float: ...
    @property
    def film_distance_mm(self) -> float: ...
    @property
    def wavelength_nm(self) -> float: ...
    @property
    def index(self) -> float: ...
    @property
    def mirrored(self) -> bool: ...

@final
class Spot(_LargeValue):
    @property
    def points_mm(self) -> NDArray[np.float64]: ...
    @property
    def directions(self) -> NDArray[np.float64]: ...
    @property
    def pupil(self) -> NDArray[np.float64]: ...
    @property
    def weights(self) -> NDArray[np.float64]: ...
    @property
    def status(self) -> NDArray[np.int32]: ...
    @property
    def centroid_mm(self) -> tuple[float, float]: ...
    @property
    def chief_ray_mm(self) -> tuple[float, float]: ...
    @property
    def rms_radius_mm(self) -> float: ...
    @property
    def max_radius_mm(self) -> float: ...
    @property
    def rms_radius_about_chief_ray_mm(self) -> float: ...
    @property
    def max_radius_about_chief_ray_mm(self) -> float: ...

@final
class Lens(_Value):
    def __init__(
        self,
        *,
        surfaces: Sequence[Surface],
        name: str = "",
        film_distance_mm: float | None = None,
        film_mm: tuple[float, float] = (36.0, 24.0),
        wavelength_nm: float = 587.5618,
        iris_blades: int = 0,
        iris_rounding: float = 0.0,
        iris_rotation_deg: float = 0.0,
        focus_group: tuple[int, int] | None = None,
        nearest_focus_m: float = 0.0,
        allow_overlap: bool = False,
        film_radius_of_curvature_mm: float = ...,
    ) -> None: ...
    @staticmethod
    def load(
        name_or_path: _Path,
        *,
        glass: Mapping[str, _Material] | None = None,
        force: bool = False,
        pbrt_thickness: str | None = None,
        glass_catalogue: _Path | Sequence[_Path] | None = None,
    ) -> Lens: ...
    def save(self, path: _Path) -> None: ...
    @staticmethod
    def _load_with_light(
        name_or_path: _Path,
        *,
        glass: Mapping[str, _Material] | None = None,
        force: bool = False,
        pbrt_thickness: str | None = None,
        glass_catalogue: _Path | Sequence[_Path] | None = None,
    ) -> tuple[Lens, list[float], list[float]]: ...
    @staticmethod
    def _load_with_notes(path: _Path) -> tuple[Lens, list[str]]: ...
    def _file_content(self, path: _Path) -> tuple[bytes, list[str]]: ...
    @property
    def zoom_positions(self) -> list[str]: ...
    @property
    def zoom_position(self) -> str | None: ...
    @property
    def zoom_focal_lengths_mm(self) -> list[float]: ...
    def zoomed(self, position: str | float) -> Lens: ...
    def with_rings(
        self,
        *,
        zoom: str | float | None = None,
        f_number: float | None = None,
        focus_m: float | None = None,
        opens_as_far_as_it_can: bool = False,
    ) -> Lens: ...
    def wide_open(self) -> Lens: ...
    def draw(
        self,
        rays: int = 7,
        *,
        plane: str = "yz",
        rays_from: str = "object",
        fields: Sequence[float] = (0.0, 0.7, 1.0),
        fields_deg: Sequence[float] | None = None,
        wavelengths_nm: Sequence[float] | None = None,
        object_distance_m: float | None = None,
        radius_colours: bool = False,
        marks: bool = False,
        insets: bool = True,
        ghost: Lens | None = None,
        theme: str = "light",
        width_px: int = 1600,
    ) -> Figure: ...
    def first_order(self, wavelength_nm: float | None = None) -> FirstOrder: ...
    def meridians(self, wavelength_nm: float | None = None) -> tuple[Meridian, Meridian]: ...
    def focused(self, focus_distance_m: float) -> Lens: ...
    @property
    def f_number(self) -> float: ...
    def stopped_down(self, f_number: float) -> Lens: ...
    def best_focus_mm(self, object_distance_m: float | None = None, wavelength_nm: float | None = None) -> float: ...
    @overload
    def trace(
        self,
        origins_mm: _CudaArray,
        directions: _CudaArray,
        *,
        wavelength_nm: float | None = None,
        start: str = "film",
        dtype: DTypeLike = "float64",
        surface_count: int | None = None,
        device: str | None = None,
        transmission: bool = False,
    ) -> TraceResult[DeviceArray, DeviceArray]: ...
    @overload
    def trace(
        self,
        origins_mm: ArrayLike,
        directions: ArrayLike,
        *,
        wavelength_nm: float | None = None,
        start: str = "film",
        dtype: DTypeLike = "float64",
        surface_count: int | None = None,
        device: str | None = None,
        transmission: bool = False,
    ) -> TraceResult: ...
    def transmission(
        self,
        field_deg: float = 0.0,
        wavelength_nm: float | None = None,
        *,
        object_distance_m: float | None = None,
        polarisation: str = "traced",
        pattern: str = "rings",
        samples: int = 8,
        pupil: ArrayLike | None = None,
    ) -> float: ...
    @property
    def t_stop(self) -> float: ...
    @property
    def unknown_coatings(self) -> list[int]: ...
    def with_coating(self, coating: _Coating, surfaces: Sequence[int] | None = None) -> Lens: ...
    def seidel(
        self,
        field_deg: float,
        *,
        object_distance_m: float | None = None,
        wavelength_nm: float | None = None,
        colours_nm: tuple[float, float] = (486.1327, 656.2725),
    ) -> Seidel: ...
    def ghost(self, first: int, second: int, *, wavelength_nm: float | None = None) -> Ghost: ...
    def ghosts(self, *, film_reflectance: float = 0) -> list[Ghost]: ...
    def gradient(
        self,
        quantity: str,
        variables: Sequence[Variable],
        *,
        field_deg: float = 0.0,
        object_distance_m: float | None = None,
        film_mm: tuple[float, float] | None = None,
        wavelength_nm: float | None = None,
        frequency_per_mm: float | None = None,
        remove: str | None = None,
        samples: int = 6,
    ) -> Gradient: ...
    def _ray_derivatives(
        self,
        origins_mm: ArrayLike,
        directions: ArrayLike,
        variables: Sequence[tuple[str, int, int, int]],
        *,
        wavelength_nm: float | None = None,
        start: str = "film",
        frame: str = "lens",
        surface_count: int | None = None,
        rims: bool = True,
    ) -> tuple[NDArray[np.int32], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]: ...
    def _backpropagate_rays(
        self,
        origins_mm: ArrayLike,
        directions: ArrayLike,
        variables: Sequence[tuple[str, int, int, int]],
        of_origins: ArrayLike,
        of_directions: ArrayLike,
        of_optical_paths: ArrayLike,
        *,
        wavelength_nm: float | None = None,
        start: str = "film",
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]: ...
    def aim(
        self,
        pupil: ArrayLike,
        field_deg: float = 0.0,
        *,
        object_distance_m: float | None = None,
        film_mm: tuple[float, float] | None = None,
        wavelength_nm: float | None = None,
    ) -> AimedRays: ...
    def wavefront(
        self,
        field_deg: float = 0.0,
        *,
        object_distance_m: float | None = None,
        film_mm: tuple[float, float] | None = None,
        wavelength_nm: float | None = None,
        film_distance_mm: float | None = None,
        reference: str = "chief",
        exit_pupil: str = "real",
        remove: str | None = None,
        pattern: str = "grid",
        samples: int = 64,
        pupil: ArrayLike | None = None,
    ) -> Wavefront: ...
    def spot(
        self,
        field_deg: float = 0.0,
        *,
        object_distance_m: float | None = None,
        film_mm: tuple[float, float] | None = None,
        wavelength_nm: float | None = None,
        film_distance_mm: float | None = None,
        pattern: str = "hexapolar",
        samples: int = 6,
        pupil: ArrayLike | None = None,
    ) -> Spot: ...
    def psf(
        self,
        field_deg: float = 0.0,
        wavelength_nm: float | Sequence[float] | None = None,
        *,
        method: str = "direct",
        size: int = 128,
        pitch_um: float | None = None,
        object_distance_m: float | None = None,
        film_mm: tuple[float, float] | None = None,
        film_distance_mm: float | None = None,
        centre: str = "chief",
        rays: int | None = None,
        weights: Sequence[float] | None = None,
    ) -> PSF: ...
    def bundle(
        self,
        field_deg: float = 0.0,
        *,
        object_distance_m: float | None = None,
        film_mm: tuple[float, float] | None = None,
        wavelength_nm: float | None = None,
        film_distance_mm: float | None = None,
        arms: int = 64,
        nodes: int = 6,
    ) -> RayBundle: ...
    def film_pupil(
        self, film_mm: tuple[float, float] = (0.0, 0.0), wavelength_nm: float | None = None
    ) -> FilmPupil: ...
    def film_points(
        self,
        field_deg: float = 0.0,
        count: int = 1000000,
        *,
        object_distance_m: float | None = None,
        film_mm: tuple[float, float] | None = None,
        wavelength_nm: float | None = None,
        film_distance_mm: float | None = None,
        pattern: str = "even",
        dtype: DTypeLike = "float32",
    ) -> NDArray[np.float32]: ...
    @property
    def name(self) -> str: ...
    @property
    def title(self) -> str: ...
    @property
    def source(self) -> str: ...
    @property
    def surfaces(self) -> list[Surface]: ...
    @property
    def wavelength_nm(self) -> float: ...
    @property
    def allow_overlap(self) -> bool: ...
    def overlaps(self) -> list[tuple[int, int, float, float]]: ...
    @property
    def film_distance_mm(self) -> float: ...
    @property
    def film_radius_of_curvature_mm(self) -> float: ...
    @property
    def film_position_mm(self) -> float: ...
    @property
    def film_mm(self) -> tuple[float, float]: ...
    @property
    def surface_frames(self) -> NDArray[np.float64]: ...
    @property
    def film_frame(self) -> NDArray[np.float64]: ...
    @property
    def vertices_mm(self) -> list[float]: ...
    @property
    def focus_distance_m(self) -> float: ...
    @property
    def nearest_focus_m(self) -> float: ...
    @property
    def stop_index(self) -> int: ...
    @property
    def stop_semi_diameter_mm(self) -> float: ...
    @property
    def is_rotational(self) -> bool: ...
    @property
    def iris_blades(self) -> int: ...
    @property
    def iris_rounding(self) -> float: ...
    @property
    def iris_rotation_deg(self) -> float: ...
    @property
    def focus_group(self) -> tuple[int, int] | None: ...
    def with_iris(self, blades: int, rounding: float | None = None, rotation_deg: float | None = None) -> Lens: ...
    def with_surfaces(self, surfaces: Mapping[int, Surface]) -> Lens: ...
    def with_film(self, width_mm: float, height_mm: float) -> Lens: ...
    def with_film_radius(self, radius_of_curvature_mm: float) -> Lens: ...
    def shifted(self, x_mm: float = 0.0, y_mm: float = 0.0) -> Lens: ...
    def tilted(self, x_deg: float = 0.0, y_deg: float = 0.0, *, pivot_mm: float = 0.0) -> Lens: ...
    def scaled(self, factor: float) -> Lens: ...
    def reversed(self, film_distance_mm: float | None = None) -> Lens: ...
    def inserted(self, index: int, surfaces: Sequence[Surface], *, gap_mm: float | None = None) -> Lens: ...
    def removed(self, first: int, last: int | None = None) -> Lens: ...
    def with_element_tilted(
        self,
        first: int,
        last: int | None = None,
        *,
        x_deg: float = 0.0,
        y_deg: float = 0.0,
        z_deg: float = 0.0,
        decentre_x_mm: float = 0.0,
        decentre_y_mm: float = 0.0,
        decentre_z_mm: float = 0.0,
        pivot_mm: float = 0.0,
    ) -> Lens: ...
    def with_surface(
        self,
        index: int,
        *,
        radius_of_curvature_mm: float | None = None,
        thickness_mm: float | None = None,
        material: _Material | EllipsisType = ...,
        clear_semi_diameter_mm: float | None = None,
        conic: float | None = None,
        aspheric_coefficients: Mapping[int, float] | None = None,
        inner_semi_diameter_mm: float | None = None,
        type: str | None = None,
        coating: _Coating | None = None,
        decentre_mm: Sequence[float] | None = None,
        tilt_deg: Sequence[float] | None = None,
        returns: bool | None = None,
        form: str | None = None,
        radius_of_curvature_x_mm: float | None = None,
        conic_x: float | None = None,
        radial_terms: Mapping[int, float] | None = None,
        xy_terms: Mapping[tuple[int, int], float] | None = None,
        zernike: Mapping[str, Any] | None = None,
        forbes: Mapping[str, Any] | None = None,
        superconic: Mapping[str, Any] | None = None,
        aperture: Mapping[str, Any] | None = None,
        obscurations: Sequence[Mapping[str, Any]] | None = None,
    ) -> Lens: ...

@final
class Film(_Value):
    def __init__(
        self,
        width_mm: float = 36.0,
        height_mm: float = 24.0,
        resolution: tuple[int, int] = (960, 640),
        shift_mm: tuple[float, float] = (0.0, 0.0),
    ) -> None: ...
    @staticmethod
    def for_lens(
        lens: Lens, size_mm: Sequence[float] | None = None, resolution: Sequence[int] | None = None
    ) -> Film: ...
    def replace(
        self,
        *,
        width_mm: float | None = None,
        height_mm: float | None = None,
        resolution: tuple[int, int] | None = None,
        shift_mm: tuple[float, float] | None = None,
    ) -> Film: ...
    @property
    def width_mm(self) -> float: ...
    @property
    def height_mm(self) -> float: ...
    @property
    def resolution(self) -> tuple[int, int]: ...
    @property
    def shift_mm(self) -> tuple[float, float]: ...
    @property
    def principal_point(self) -> tuple[float, float]: ...

@final
class Sensor(_Value):
    @staticmethod
    def load(name_or_path: _Path = "ideal") -> Sensor: ...
    def replace(
        self,
        *,
        name: str | None = None,
        pixel_pitch_um: float | None = None,
        resolution: tuple[int, int] | None = None,
        color_filter_array: str | None = None,
        quantum_efficiency: _Table | None = None,
        cover_glass: _Table | None = None,
        angular_response: _Table | None = None,
        gain_dn_per_e: float | None = None,
        largest_gain_db: float | None = None,
        saturation_capacity_e: float | None = None,
        adc_bits: int | None = None,
        black_level_dn: float | None = None,
        converter_noise_dn: float | None = None,
        read_noise_e: float | None = None,
        row_noise_e: float | None = None,
        dark_current_e_per_s: float | None = None,
        dark_current_temperature_c: float | None = None,
        dark_current_doubling_k: float | None = None,
        dsnu_e: float | None = None,
        prnu_percent: float | None = None,
        hot_pixel_share: float | None = None,
        hot_pixel_current_e_per_s: float | None = None,
    ) -> Sensor: ...
    def film(self) -> Film: ...
    def electrons_per_um2(self, illuminant: str = "D65") -> NDArray[np.float64]: ...
    def iso_range(self, pixel_pitch_um: float | None = None) -> tuple[float, float]: ...
    def expose(
        self,
        image: Image,
        *,
        iso: float | None = None,
        seed: int = 0,
        serial: int = 0,
        temperature_c: float | None = None,
        threads: int = 0,
    ) -> RawImage: ...
    @property
    def title(self) -> str: ...
    @property
    def source(self) -> str: ...
    @property
    def assumptions(self) -> tuple[str, ...]: ...
    @property
    def full_well_e(self) -> float: ...
    @property
    def name(self) -> str: ...
    @property
    def pixel_pitch_um(self) -> float | None: ...
    @property
    def resolution(self) -> tuple[int, int] | None: ...
    @property
    def color_filter_array(self) -> str: ...
    @property
    def quantum_efficiency(self) -> tuple[tuple[float, ...], ...]: ...
    @property
    def cover_glass(self) -> tuple[tuple[float, float], ...]: ...
    @property
    def angular_response(self) -> tuple[tuple[float, float], ...]: ...
    @property
    def gain_dn_per_e(self) -> float: ...
    @property
    def largest_gain_db(self) -> float: ...
    @property
    def saturation_capacity_e(self) -> float: ...
    @property
    def adc_bits(self) -> int: ...
    @property
    def black_level_dn(self) -> float: ...
    @property
    def converter_noise_dn(self) -> float: ...
    @property
    def read_noise_e(self) -> float: ...
    @property
    def row_noise_e(self) -> float: ...
    @property
    def dark_current_e_per_s(self) -> float: ...
    @property
    def dark_current_temperature_c(self) -> float: ...
    @property
    def dark_current_doubling_k(self) -> float: ...
    @property
    def dsnu_e(self) -> float: ...
    @property
    def prnu_percent(self) -> float: ...
    @property
    def hot_pixel_share(self) -> float: ...
    @property
    def hot_pixel_current_e_per_s(self) -> float: ...

@final
class CameraRays(Generic[_Doubles, _Floats, _Integers]):
    @property
    def origins_m(self) -> _Doubles: ...
    @property
    def directions(self) -> _Floats: ...
    @property
    def weights(self) -> _Floats: ...
    @property
    def pixels(self) -> _Integers: ...
    @property
    def wavelengths_nm(self) -> _Floats: ...
    @property
    def times_s(self) -> _Doubles: ...

@final
class RayChunks(Generic[_Doubles, _Floats, _Integers]):
    def __iter__(self) -> Self: ...
    def __next__(self) -> CameraRays[_Doubles, _Floats, _Integers]: ...

class FieldOfView(NamedTuple):
    horizontal: float
    vertical: float
    diagonal: float

@final
class Camera(_Value):
    def __init__(
        self,
        lens: Lens,
        *,
        film: Film | None = None,
        position: _Triple = [0.0, 0.0, 0.0],
        look_at: _Triple = [0.0, 0.0, -1.0],
        up: _Triple = [0.0, 1.0, 0.0],
        exposure_time_s: float = 0.008,
        iso: float = 100.0,
        model: str = "full",
        shutter_opens_s: float = 0.0,
        readout_time_s: float = 0.0,
        motion: Sequence[_PoseKey] = [],
    ) -> None: ...
    def replace(
        self,
        *,
        lens: Lens | None = None,
        film: Film | None = None,
        position: _Triple | None = None,
        look_at: _Triple | None = None,
        up: _Triple | None = None,
        exposure_time_s: float | None = None,
        iso: float | None = None,
        model: str | None = None,
        shutter_opens_s: float | None = None,
        readout_time_s: float | None = None,
        motion: Sequence[_PoseKey] | None = None,
    ) -> Camera: ...
    def framing(
        self,
        scene: Scene,
        *,
        position: _Triple | None = None,
        look_at: _Triple | None = None,
        up: _Triple = [0.0, 1.0, 0.0],
        focus_distance_m: float | None = None,
        scene_camera: str = "",
    ) -> Camera: ...
    def metered(
        self, scene: Scene, *, device: str = "auto", max_bounces: int | str = "auto", progress: _Progress | None = None
    ) -> Camera: ...
    @property
    def field_of_view_deg(self) -> FieldOfView: ...
    @property
    def entrance_pupil_position_m(self) -> tuple[float, float, float] | None: ...
    @property
    def film_centre_m(self) -> tuple[float, float, float]: ...
    @overload
    def generate_rays(
        self,
        *,
        spp: int = 1,
        seed: int = 0,
        device: Literal["cpu"] = "cpu",
        wavelengths_nm: tuple[float, float] | None = None,
    ) -> CameraRays: ...
    @overload
    def generate_rays(
        self,
        *,
        spp: int = 1,
        seed: int = 0,
        device: str = "cpu",
        wavelengths_nm: tuple[float, float] | None = None,
    ) -> CameraRays[Any, Any, Any]: ...
    @overload
    def ray_chunks(
        self,
        *,
        spp: int = 1,
        seed: int = 0,
        device: Literal["cpu"] = "cpu",
        wavelengths_nm: tuple[float, float] | None = None,
        max_rays: int = 4194304,
    ) -> RayChunks: ...
    @overload
    def ray_chunks(
        self,
        *,
        spp: int = 1,
        seed: int = 0,
        device: str = "cpu",
        wavelengths_nm: tuple[float, float] | None = None,
        max_rays: int = 4194304,
    ) -> RayChunks[Any, Any, Any]: ...
    @overload
    def project(
        self, points_m: ArrayLike, *, through: str = "light", return_status: Literal[True]
    ) -> tuple[NDArray[np.float64], NDArray[np.int32]]: ...
    @overload
    def project(
        self, points_m: ArrayLike, *, through: str = "light", return_status: Literal[False] = False
    ) -> NDArray[np.float64]: ...
    @overload
    def ray(
        self, pixels: ArrayLike, *, through: str = "light", return_light: Literal[True]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]: ...
    @overload
    def ray(
        self, pixels: ArrayLike, *, through: str = "light", return_light: Literal[False] = False
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
    @property
    def camera_matrix(self) -> NDArray[np.float64]: ...
    @property
    def world_to_camera(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
    @property
    def lens(self) -> Lens: ...
    @property
    def film(self) -> Film: ...
    @property
    def position(self) -> tuple[float, float, float]: ...
    @property
    def look_at(self) -> tuple[float, float, float]: ...
    @property
    def up(self) -> tuple[float, float, float]: ...
    @property
    def exposure_time_s(self) -> float: ...
    @property
    def iso(self) -> float: ...
    @property
    def shutter_opens_s(self) -> float: ...
    @property
    def readout_time_s(self) -> float: ...
    def pose_at(
        self, time_s: float
    ) -> tuple[tuple[float, float, float], tuple[float, float, float], tuple[float, float, float]]: ...
    @property
    def motion(
        self,
    ) -> tuple[
        tuple[float, tuple[float, float, float], tuple[float, float, float], tuple[float, float, float]], ...
    ]: ...
    @property
    def model(self) -> str: ...

@final
class Material(_Value):
    def __init__(
        self,
        *,
        diffuse: _Triple = [0.5, 0.5, 0.5],
        specular: _Triple = [0.0, 0.0, 0.0],
        shininess: float = 0.0,
        mirror: _Triple = [0.0, 0.0, 0.0],
        fresnel: bool = True,
        filter: _Triple = [1.0, 1.0, 1.0],
        shadow_catcher: bool = False,
        shininess_texture: ArrayLike | None = None,
        name: str = "",
        emission: _Triple = [0.0, 0.0, 0.0],
        transmission: float = 0.0,
        ior: float = 1.5,
        absorption: _Triple = [0.0, 0.0, 0.0],
        thin: bool = False,
        normal_scale: float = 1.0,
        opacity: float = 1.0,
        opacity_cutoff: float = 0.0,
        double_sided: bool = False,
        texture: ArrayLike | None = None,
        specular_texture: ArrayLike | None = None,
        emission_texture: ArrayLike | None = None,
        transmission_texture: ArrayLike | None = None,
        opacity_texture: ArrayLike | None = None,
        normal_map: ArrayLike | None = None,
    ) -> None: ...
    @staticmethod
    def metallic_roughness(
        *,
        base_color: _Triple = [1.0, 1.0, 1.0],
        specular_color: _Triple = [1.0, 1.0, 1.0],
        metallic: float = 0.0,
        roughness: float = 1.0,
        specular_weight: float = 1.0,
        clearcoat: float = 0.0,
        clearcoat_roughness: float = 0.0,
        clearcoat_normal_scale: float = 1.0,
        metallic_roughness_texture: ArrayLike | None = None,
        specular_weight_texture: ArrayLike | None = None,
        clearcoat_texture: ArrayLike | None = None,
        clearcoat_roughness_texture: ArrayLike | None = None,
        clearcoat_normal_map: ArrayLike | None = None,
        name: str = "",
        emission: _Triple = [0.0, 0.0, 0.0],
        transmission: float = 0.0,
        ior: float = 1.5,
        absorption: _Triple = [0.0, 0.0, 0.0],
        thin: bool = False,
        normal_scale: float = 1.0,
        opacity: float = 1.0,
        opacity_cutoff: float = 0.0,
        double_sided: bool = False,
        texture: ArrayLike | None = None,
        specular_texture: ArrayLike | None = None,
        emission_texture: ArrayLike | None = None,
        transmission_texture: ArrayLike | None = None,
        opacity_texture: ArrayLike | None = None,
        normal_map: ArrayLike | None = None,
    ) -> Material: ...
    def replace(
        self,
        *,
        diffuse: _Triple | None = None,
        specular: _Triple | None = None,
        shininess: float | None = None,
        emission: _Triple | None = None,
        texture: ArrayLike | EllipsisType | None = ...,
        name: str | None = None,
        metallic: float | None = None,
        roughness: float | None = None,
        transmission: float | None = None,
        ior: float | None = None,
        opacity: float | None = None,
    ) -> Material: ...
    @property
    def model(self) -> str: ...
    @property
    def diffuse(self) -> tuple[float, float, float]: ...
    @property
    def specular(self) -> tuple[float, float, float]: ...
    @property
    def shininess(self) -> float: ...
    @property
    def emission(self) -> tuple[float, float, float]: ...
    @property
    def mirror(self) -> tuple[float, float, float]: ...
    @property
    def transmission(self) -> float: ...
    @property
    def filter(self) -> tuple[float, float, float]: ...
    @property
    def absorption(self) -> tuple[float, float, float]: ...
    @property
    def ior(self) -> float: ...
    @property
    def thin(self) -> bool: ...
    @property
    def fresnel(self) -> bool: ...
    @property
    def metallic(self) -> float: ...
    @property
    def roughness(self) -> float: ...
    @property
    def specular_weight(self) -> float: ...
    @property
    def clearcoat(self) -> float: ...
    @property
    def clearcoat_roughness(self) -> float: ...
    @property
    def normal_scale(self) -> float: ...
    @property
    def clearcoat_normal_scale(self) -> float: ...
    @property
    def opacity(self) -> float: ...
    @property
    def opacity_cutoff(self) -> float: ...
    @property
    def double_sided(self) -> bool: ...
    @property
    def shadow_catcher(self) -> bool: ...
    @property
    def texture(self) -> NDArray[np.uint8] | NDArray[np.float32] | None: ...
    @property
    def specular_texture(self) -> NDArray[np.uint8] | NDArray[np.float32] | None: ...
    @property
    def emission_texture(self) -> NDArray[np.uint8] | NDArray[np.float32] | None: ...
    @property
    def metallic_roughness_texture(self) -> NDArray[np.uint8] | NDArray[np.float32] | None: ...
    @property
    def transmission_texture(self) -> NDArray[np.uint8] | NDArray[np.float32] | None: ...
    @property
    def specular_weight_texture(self) -> NDArray[np.uint8] | NDArray[np.float32] | None: ...
    @property
    def clearcoat_texture(self) -> NDArray[np.uint8] | NDArray[np.float32] | None: ...
    @property
    def clearcoat_roughness_texture(self) -> NDArray[np.uint8] | NDArray[np.float32] | None: ...
    @property
    def clearcoat_normal_map(self) -> NDArray[np.uint8] | NDArray[np.float32] | None: ...
    @property
    def opacity_texture(self) -> NDArray[np.uint8] | NDArray[np.float32] | None: ...
    @property
    def normal_map(self) -> NDArray[np.uint8] | NDArray[np.float32] | None: ...
    @property
    def name(self) -> str: ...

@final
class Scene(_LargeValue):
    @staticmethod
    def load(path: _Path, *, scale: float = 1.0, objects: Sequence[str] = []) -> Scene: ...
    @staticmethod
    def from_arrays(
        vertices_m: ArrayLike,
        triangles: ArrayLike,
        *,
        normals: ArrayLike | None = None,
        uvs: ArrayLike | None = None,
        triangle_materials: ArrayLike | None = None,
        materials: Sequence[Material] = [],
        colors: ArrayLike | None = None,
    ) -> Scene: ...
    def with_environment(
        self,
        radiance: float | _Triple | ArrayLike | str | os.PathLike[str],
        *,
        scale: float = 1.0,
        rotation_deg: float = 0.0,
        layer: str = "",
    ) -> Scene: ...
    def with_sun(self, direction: _Triple, illuminance: _Triple) -> Scene: ...
    def with_point_light(self, position_m: _Triple, intensity: _Triple) -> Scene: ...
    def with_spot_light(
        self,
        position_m: _Triple,
        direction: _Triple,
        intensity: _Triple,
        *,
        inner_cone_deg: float = 0.0,
        outer_cone_deg: float = 45.0,
    ) -> Scene: ...
    def with_daylight(self, camera: Camera) -> Scene: ...
    def with_material(self, which: int | str, material: Material) -> Scene: ...
    def with_texture(self, material: int | str, pixels: ArrayLike) -> Scene: ...
    def with_instance(self, object: Scene, scene_from_object: ArrayLike | None = None, *, name: str = "") -> Scene: ...
    def moved(
        self, instance: int | str, scene_from_object: ArrayLike, times_s: Sequence[float] | None = None
    ) -> Scene: ...
    def at_time(self, time_s: float) -> Scene: ...
    @property
    def instances(self) -> tuple[tuple[str, NDArray[np.float64]], ...]: ...
    @property
    def motions(self) -> tuple[tuple[tuple[float, ...], NDArray[np.float64]] | None, ...]: ...
    @property
    def triangle_count(self) -> int: ...
    @property
    def materials(self) -> dict[str, Material]: ...
    @property
    def material_count(self) -> int: ...
    @property
    def has_light(self) -> bool: ...
    @property
    def cameras(self) -> tuple[tuple[str, NDArray[np.float64], float], ...]: ...
    @property
    def bounds_m(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]: ...
    @property
    def warnings(self) -> list[str]: ...

@final
class RenderStats(_Value):
    @property
    def seconds(self) -> float: ...
    @property
    def setup_seconds(self) -> float: ...
    @property
    def lens_seconds(self) -> float: ...
    @property
    def scene_seconds(self) -> float: ...
    @property
    def other_seconds(self) -> float: ...
    @property
    def sampled_rays(self) -> int: ...
    @property
    def passed_rays(self) -> int: ...
    @property
    def scene_rays(self) -> int: ...
    @property
    def device(self) -> str: ...

@final
class _ToleranceEvaluator:
    def __init__(
        self,
        lens: Lens,
        fields_rad: NDArray[np.float64],
        object_distance_m: float | None,
        colours: NDArray[np.float64],
        frequencies: Sequence[float],
        rings: int,
        refocus: bool,
        film_tilt: bool,
        sharp_at: float | None,
        shift: tuple[int, int, bool, float] | None,
    ) -> None: ...
    def judge(
        self, errors: Sequence[tuple[str, int, int]], sizes: NDArray[np.float64]
    ) -> dict[str, NDArray[np.float64]]: ...
    def copy(
        self,
        errors: Sequence[tuple[str, int, int]],
        sizes: NDArray[np.float64],
        film_shift_mm: float,
        film_slope: tuple[float, float],
        element_shift_mm: tuple[float, float, float],
    ) -> Lens: ...

def _read_environment(path: bytes, layer: str) -> tuple[NDArray[np.float32], list[str]]: ...
def _read_film(path: bytes) -> tuple[NDArray[np.float32], list[tuple[str, str]]]: ...
def _write_picture(path: bytes, image: object, film_tone: bool) -> None: ...
def _write_codes(path: bytes, codes: NDArray[np.uint8], entries: list[tuple[str, str]]) -> None: ...
def _run_command(words: list[bytes]) -> int: ...
def _listed_commands() -> list[tuple[list[str], str, list[tuple[list[str], str, str]]]]: ...
def _help_text(
    usage: str, description: str, sections: list[tuple[str, list[tuple[str, str]]]], examples: list[str]
) -> str: ...
def _did_you_mean(name: str, candidates: list[str]) -> str: ...
def _metadata(
    camera: Camera, settings: RenderSettings, spp: int, seed: int, plan: str, denoiser: str
) -> dict[str, str]: ...
def _expose(
    sensor: Sensor,
    exposure: NDArray[np.float32],
    pixel_pitch_um: float,
    film_pitch_um: float,
    exit_pupil_distance_mm: float,
    exposure_time_s: float,
    iso: float,
    illuminant: str,
    temperature_c: float | None,
    seed: int,
    serial: int,
    threads: int,
) -> NDArray[np.uint16]: ...
def _sensor_gain(sensor: Sensor, pixel_pitch_um: float, iso: float) -> float: ...
def _sensor_color(
    sensor: Sensor, illuminant: str
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]: ...
def _film_of_white(illuminant: str) -> NDArray[np.float64]: ...

@final
class CameraKey(_Value):
    def __init__(
        self,
        time_s: float,
        *,
        lens: Lens | None = None,
        focus_m: float | None = None,
        focal_length_mm: float | None = None,
        f_number: float | None = None,
        blades: int | None = None,
        blade_rounding: float | None = None,
        blade_rotation_deg: float | None = None,
        exposure_time_s: float | None = None,
        iso: float | None = None,
        film_shift_mm: tuple[float, float] | None = None,
        interpolation: str = "linear",
    ) -> None: ...
    @property
    def time_s(self) -> float: ...
    @property
    def lens(self) -> Lens | None: ...
    @property
    def focus_m(self) -> float | None: ...
    @property
    def focal_length_mm(self) -> float | None: ...
    @property
    def f_number(self) -> float | None: ...
    @property
    def blades(self) -> int | None: ...
    @property
    def blade_rounding(self) -> float | None: ...
    @property
    def blade_rotation_deg(self) -> float | None: ...
    @property
    def exposure_time_s(self) -> float | None: ...
    @property
    def iso(self) -> float | None: ...
    @property
    def film_shift_mm(self) -> tuple[float, float] | None: ...
    @property
    def interpolation(self) -> str: ...

@final
class Shake(_Value):
    def __init__(
        self,
        *,
        rms_deg: float = 0.0,
        rms_mm: float = 0.0,
        corner_hz: float = 1.0,
        seed: int = 0,
        curve: Sequence[tuple[float, _Triple, _Triple]] = [],
    ) -> None: ...
    @staticmethod
    def load(path: _Path) -> Shake: ...
    def at(self, times_s: Sequence[float] | NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
    @property
    def rms_deg(self) -> float: ...
    @property
    def rms_mm(self) -> float: ...
    @property
    def corner_hz(self) -> float: ...
    @property
    def seed(self) -> int: ...
    @property
    def curve(
        self,
    ) -> tuple[tuple[float, tuple[float, float, float], tuple[float, float, float]], ...]: ...

def _check_camera_keys(camera: Camera, keys: Sequence[CameraKey]) -> None: ...
def _camera_at(camera: Camera, keys: Sequence[CameraKey], shake: Shake | None, opens_s: float) -> Camera: ...
def _frames_to_plan(
    numbers: Sequence[int], camera: Camera, keys: Sequence[CameraKey], frames_per_second: float
) -> list[int]: ...
def _frame_seed(seed: int, number: int) -> int: ...
def _followed_isos(
    scene: Scene,
    camera: Camera,
    keys: Sequence[CameraKey],
    settings: RenderSettings,
    numbers: Sequence[int],
    frames_per_second: float,
    smoothing_s: float,
    device: str,
) -> list[float]: ...
def _read_toml(text: str, file: str) -> tuple[dict[str, Any], dict[str, int]]: ...
def _shot_keys() -> list[tuple[str, str | None, str, str, str]]: ...
def _read_shot(
    path: str | os.PathLike[str],
    changes: str,
    words: Mapping[str, str],
    scene: Scene | None,
    lens: Lens | None,
    denoises: bool,
    device: str,
) -> tuple[_Shot, bool]: ...

class _SettingWords(TypedDict, total=False):
    spp: int | str
    noise: float | None
    noise_codes: float | None
    seconds: float | None
    max_spp: int | None
    seed: int
    max_bounces: int | str
    transport: str
    clamp_cd_m2: float
    threads: int
    layers: str | Iterable[str]
    effects: str | Iterable[str]
    quality: str
    threshold_px: float | None
    threshold_codes: float | None
    illuminant: str | float | Sequence[tuple[float, float]] | None
    pupil_sampling: str
    light_tracing: str

@final
class RenderSettings(_Value):
    def __init__(
        self,
        *,
        spp: int | str = 64,
        noise: float | None = None,
        noise_codes: float | None = None,
        seconds: float | None = None,
        max_spp: int | None = None,
        seed: int = 0,
        max_bounces: int | str = "auto",
        transport: str = "paths",
        clamp_cd_m2: float = 0.0,
        threads: int = 0,
        layers: str | Iterable[str] = (),
        effects: str | Iterable[str] = ("auto",),
        quality: str = "photo",
        threshold_px: float | None = None,
        threshold_codes: float | None = None,
        illuminant: str | float | Sequence[tuple[float, float]] | None = None,
        pupil_sampling: str = "outline",
        light_tracing: str = "weighted",
    ) -> None: ...
    def with_(self, **changes: Unpack[_SettingWords]) -> RenderSettings: ...
    @property
    def spp(self) -> int | Literal["auto"]: ...
    @property
    def noise(self) -> float | None: ...
    @property
    def noise_codes(self) -> float | None: ...
    @property
    def seconds(self) -> float | None: ...
    @property
    def max_spp(self) -> int | None: ...
    @property
    def seed(self) -> int: ...
    @property
    def max_bounces(self) -> int | Literal["auto"]: ...
    @property
    def transport(self) -> str: ...
    @property
    def clamp_cd_m2(self) -> float: ...
    @property
    def threads(self) -> int: ...
    @property
    def layers(self) -> tuple[str, ...]: ...
    @property
    def effects(self) -> tuple[str, ...]: ...
    @property
    def threshold_px(self) -> float: ...
    @property
    def threshold_codes(self) -> float: ...
    @property
    def illuminant(self) -> str | None: ...
    @property
    def pupil_sampling(self) -> str: ...
    @property
    def light_tracing(self) -> str: ...

class _Picture(TypedDict):
    pixels: NDArray[np.float32]
    depth: NDArray[np.float32]
    spp: int
    stats: RenderStats
    layers: dict[str, NDArray[np.float32] | NDArray[np.uint32]]
    object_names: tuple[str, ...]
    material_names: tuple[str, ...]
    shortfall: str

class _Shot(TypedDict):
    scene: Scene
    camera: Camera
    settings: RenderSettings
    tone: str
    keys: tuple[CameraKey, ...]
    shake: Shake | None
    iso_follows_s: float | None

class _Reached(TypedDict):
    noise: float
    is_reached: bool
    spp_wanted: float

@final
class EffectInfo(_Value):
    @property
    def name(self) -> str: ...
    @property
    def what(self) -> str: ...
    @property
    def needs(self) -> str: ...
    @property
    def usage(self) -> str: ...
    @property
    def is_on(self) -> bool: ...
    @property
    def parameter(self) -> float | None: ...
    @property
    def has_wavelengths(self) -> bool: ...
    @property
    def needs_full_lens(self) -> bool: ...
    @property
    def needs_coatings(self) -> bool: ...
    @property
    def shows_in_previews(self) -> bool: ...
    @property
    def cpu_time(self) -> float: ...
    @property
    def gpu_time(self) -> float: ...
    @property
    def description(self) -> str: ...

@final
class Device(_Value):
    @property
    def name(self) -> str: ...
    @property
    def description(self) -> str: ...

def _render(
    scene: Scene,
    camera: Camera,
    settings: RenderSettings,
    device: str,
    progress: _Progress | None,
    keeps_stopped: bool,
) -> _Picture: ...
def _effect_notices(lens: Lens, settings: RenderSettings) -> list[str]: ...

@final
class PlanDecision(_Value):
    @property
    def effect(self) -> str: ...
    @property
    def size(self) -> float: ...
    @property
    def unit(self) -> str: ...
    @property
    def threshold(self) -> float: ...
    @property
    def is_kept(self) -> bool: ...
    @property
    def by(self) -> str: ...
    @property
    def time_share(self) -> float | None: ...
    @property
    def reason(self) -> str: ...

@final
class Plan(_Value):
    @property
    def model(self) -> str: ...
    @property
    def effects(self) -> list[str]: ...
    @property
    def max_bounces(self) -> int: ...
    @property
    def decisions(self) -> list[PlanDecision]: ...
    @property
    def summary(self) -> str: ...

def _plan(scene: Scene, camera: Camera, settings: RenderSettings, device: str, times: bool) -> Plan: ...
def _number_text(value: float, digits: int) -> str: ...
def _resolve_film(
    scene: Scene, camera: Camera, others: list[Camera], settings: RenderSettings, device: str
) -> tuple[str, RenderSettings, str, str]: ...

@final
class LiveFrame:
    @property
    def codes(self) -> NDArray[np.uint8]: ...
    @property
    def ready(self) -> bool: ...
    @property
    def samples(self) -> int: ...

@final
class _LiveView:
    def __init__(self, scene: Scene, device: str) -> None: ...
    def shoot(self, camera: Camera, settings: RenderSettings, tone: str) -> LiveFrame: ...
    def show(self, scene: Scene) -> None: ...
    def picture(self) -> tuple[DeviceArray | NDArray[np.float32], DeviceArray | NDArray[np.float32]]: ...
    def image(self, camera: Camera, settings: RenderSettings) -> _Picture: ...
    def cancel(self) -> None: ...

_Region: TypeAlias = tuple[int, int, int, int]  # column, row, width, height
_PIXEL_SUM: np.dtype[np.void]
_LAYER_SUM: np.dtype[np.void]
_SAMPLES_PER_SUM: int
_TRACED_LIGHTS: int
_SHARING_TILE_SIDE: int
_SAMPLED_LAYERS: set[str]

class _RegionSums(TypedDict):
    pixels: NDArray[np.void]
    stats: dict[str, float]

class _Splats(TypedDict):
    light: int
    sums: NDArray[np.int64]
    blocks: list[int]
    units_per_lux: float

def _developed_exposure(
    pixels: NDArray[np.void], splats: list[_Splats], settings: RenderSettings, exposure_time_s: float
) -> NDArray[np.float32]: ...
def _traced_exposure(splats: list[_Splats], exposure_time_s: float) -> NDArray[np.float32]: ...

@final
class _Rounds:
    def __init__(
        self,
        settings: RenderSettings,
        iso: float,
        exposure: NDArray[np.float32],
        samples: NDArray[np.int64],
        traced: NDArray[np.float32],
    ) -> None: ...
    @staticmethod
    def first_samples(settings: RenderSettings) -> int: ...
    def next(self) -> NDArray[np.uint32]: ...
    @property
    def traces_lights(self) -> bool: ...
    def add(self, exposure: NDArray[np.float32], counts: NDArray[np.uint32], traced: NDArray[np.float32]) -> None: ...
    def left(self) -> float: ...
    def shortfall(self) -> str: ...

@final
class _Session:
    def __init__(self, scene: Scene, camera: Camera, settings: RenderSettings, device: str) -> None: ...
    def set(self, scene: Scene, camera: Camera, settings: RenderSettings) -> None: ...
    def add(self, spp: int) -> None: ...
    def add_until(self, wanted: RenderSettings) -> _Reached: ...
    def picture(self) -> _Picture: ...
    def expose_region(
        self, region: _Region, first: int, count: int, counts: NDArray[np.uint32] | None = None
    ) -> _RegionSums: ...
    def see_region(self, region: _Region, first: int, count: int) -> NDArray[np.void]: ...
    def expose_splats(self, first: int, count: int) -> list[_Splats]: ...
    def picture_of(
        self,
        pixels: NDArray[np.void],
        layers: NDArray[np.void] | None,
        splats: list[_Splats],
        stats: dict[str, float],
    ) -> _Picture: ...
    def cancel(self) -> None: ...
    @property
    def device(self) -> str: ...
    @property
    def samples(self) -> NDArray[np.int64]: ...
    @property
    def scene(self) -> Scene: ...
    @property
    def camera(self) -> Camera: ...

@final
class _Denoiser:
    def __init__(self, device: str, threads: int, library: str) -> None: ...
    def denoised(
        self,
        exposure: NDArray[np.float32],
        albedo: NDArray[np.float32],
        normal: NDArray[np.float32],
        fast: bool,
        progress: _Progress | None = None,
    ) -> NDArray[np.float32]: ...
    @property
    def name(self) -> str: ...

def _gpu_hit_rates(scene: Scene, camera: Camera, device: str) -> dict[str, float]: ...
def _gpu_lens_ray_rates(camera: Camera, device: str) -> dict[str, float]: ...
def _lens_ray_rates(lens: Lens, seconds: float) -> dict[str, float]: ...
def develop(exposure: ArrayLike, iso: float, tone: str = "film") -> NDArray[np.uint8]: ...
def _metered_exposure(exposure: ArrayLike) -> float: ...
def effects() -> list[EffectInfo]: ...
def devices() -> list[Device]: ...
def _name_cuda_plugin(path: bytes) -> None: ...
def lens_names() -> list[str]: ...
def glass_names() -> list[str]: ...
def sensor_names() -> list[str]: ...
def pupil_setup(lens: Lens, film_radius_mm: float, on_one_core: bool = False) -> float: ...
def _pupil_table(
    lens: Lens, film_radius_mm: float, wavelengths_nm: list[float]
) -> tuple[NDArray[np.float32], NDArray[np.float32], float]: ...
def _iris_apothem_mm(lens: Lens) -> float | None: ...
