"""A lens whose surfaces are unknown, by polynomials fitted to rays before and behind it."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import Camera, Film, InputError, RayPairTable
from ..archive import packed, read_archive, write_archive
from ..dispersion import LINE_D_NM
from ..files import check_target
from .passing_fit import Booleans, fitted_discs, inside, stop_near_axis
from .polynomial_fit import Array, RayPolynomials, evaluated, fitted, wavelength_terms, wavelength_variable
from .ray_file import LEAST_NM, RayPairs, read_ray_pairs
from .reference_surfaces import at_plane, at_sphere, distances, largest_distance, outermost, plane_behind

_FORMAT = "ray-pair-lens/1"
_LIMIT_BYTES = 64 << 20
_HELD_OUT = 0.2  # of the rays, to which nothing is fitted
_LEAST_PASSING = 200
_MOST_FITTED = 40000  # rays to which polynomials are fitted; their columns take 200 MB
_WORTHWHILE = 0.8  # factor by which the error of a higher degree must be smaller
_WIDE_COSINE = -0.5  # of rays to the axis: beyond 60 degrees a plane is a bad reference of positions
_FAR = 100  # times the length of the lens: an entrance pupil beyond counts as one at infinity
_FRONT_DISTANCES = (0.0, 0.1, 0.3, 1.0, 3.0)  # of the front vertex from the pupil, in lengths of the lens
_FIELD_MARGIN = 1.002  # the light may end that much beyond the outermost ray that passes
_EDGE = 0.99  # of the measured disc; if rays beyond pass, the disc may not have covered the light


@dataclass(frozen=True)
class RayPairFit:
    """Errors on rays to which nothing was fitted, and the region that was measured."""

    degree: int  # largest total power of film and pupil coordinates
    rays: int
    direction_rms_rad: float  # angle between a ray in front of the lens and the polynomials' ray
    direction_worst_rad: float
    distance_rms_mm: float  # between the two rays, at the point where the ray enters the lens
    passing_accuracy: float  # fraction of rays of which it is decided rightly whether they pass
    film_radius_mm: float  # measured film points, from the axis
    light_radius_mm: float  # radius of the image circle, or that of the measured film points
    pupil_radius_mm: float  # measured points in the plane behind the lens
    largest_angle_deg: float  # of rays in front of the lens, to the axis


@dataclass(frozen=True, eq=False)
class RayPairLens:
    """A lens that is known by rays alone, as of a confidential design: a map from rays at the film to the scene.

    It holds for the f-number, focus and zoom position of its rays; another stop needs rays and a fit of its own.
    Ghosts, diffraction, coatings and dispersion within one picture need surfaces, and are refused; the planner leaves
    them out.

    Wavelengths: each coefficient is a polynomial of 1 / (wavelength - 200 nm) through those of the measured wavelengths
    (a least-squares cubic if there are more than four). Beyond the shortest and the longest one, InputError is raised.
    What passes does not depend on the wavelength. Film points beyond the measured ones, and rays beyond the measured
    disc behind the lens, count as blocked. Transmission is that of bare surfaces without loss.
    """

    name: str
    f_number: float
    focus_distance_m: float
    film_mm: tuple[float, float]
    wavelengths_nm: tuple[float, float]  # shortest and longest that were measured
    fit_report: RayPairFit
    _film_z_mm: float
    _side_z_mm: float  # plane of film_side_mm of the file
    _last_z_mm: float  # plane of p; that of film_side_mm unless the exit pupil lies behind it
    _front_z_mm: float  # plane that stands for the front vertex
    _plane_z_mm: float  # plane of the positions, unless there are heights
    _polynomials: RayPolynomials  # of positions from the file's frame
    _discs: Array
    _last_radius_mm: float  # scale of p

    @staticmethod
    def fit(
        source: str | os.PathLike[str] | Mapping[str, Any], *, largest_degree: int = 11, seed: int = 0
    ) -> RayPairLens:
        """Fits a lens to ray pairs.

        source: an .npz file of the format ray-pairs/1, as Lens.save_rays writes it, or its arrays by name with "meta".
          Blocked rays must be among them, because what passes is fitted to them. The lens is rotationally symmetric, in
          air and without a central obstruction.
        largest_degree: largest total power of the polynomials, 3 to 15, odd; the degree is chosen by the error on a
          fifth of the rays, which `seed` selects and to which nothing is fitted.

        Raises InputError in one line if the source is malformed or has too few rays, or if its rays are not those of
        a lens.
        """
        if largest_degree not in range(3, 16, 2):
            raise InputError("largest_degree must be an odd number from 3 to 15")
        pairs = read_ray_pairs(source)
        return _fitted_lens(pairs, (largest_degree - 1) // 2, np.random.default_rng(seed).random(len(pairs.ok)))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the lens to an .npz file that RayPairLens.load reads. Raises ImageFileError."""
        check_target(path, (".npz",))
        about = {
            "format": _FORMAT,
            "degree": self._polynomials.degree,
            "report": asdict(self.fit_report),
            **{key: getattr(self, key) for key in _NUMBERS},
            **{key: list(getattr(self, key)) for key in _PAIRS},
            "name": self.name,
            "focus_distance_m": self.focus_distance_m if np.isfinite(self.focus_distance_m) else None,
        }
        arrays = {"coefficients": self._polynomials.coefficients, "discs": self._discs}
        if self._polynomials.heights is not None:
            arrays["heights"] = self._polynomials.heights
        write_archive(path, packed(about, arrays))

    @staticmethod
    def load(path: str | os.PathLike[str]) -> RayPairLens:
        """Reads a lens that save has written. Raises InputError in one line for any other file."""
        about, arrays = read_archive(Path(path).resolve(), limit_bytes=_LIMIT_BYTES)
        try:
            if about["format"] != _FORMAT:
                raise ValueError("another format")
            numbers = {key: float(about[key]) for key in _NUMBERS}
            pairs = {key: (float(about[key][0]), float(about[key][1])) for key in _PAIRS}
            report = RayPairFit(**{key: float(value) for key, value in about["report"].items()})  # type: ignore
            degree, focus = int(about["degree"]), about["focus_distance_m"]
            heights = np.asarray(arrays["heights"], float) if "heights" in arrays else None
            coefficients, discs = np.asarray(arrays["coefficients"], float), np.asarray(arrays["discs"], float)
            values = [*numbers.values(), *np.ravel(list(pairs.values())), *asdict(report).values()]
            shortest, longest = pairs["wavelengths_nm"]
            if (
                not np.isfinite(values).all()
                or not LEAST_NM <= shortest <= longest
                or coefficients.ndim != 4
                or discs.ndim != 3
            ):
                raise ValueError("a number is out of range")
            lens = RayPairLens(
                name=str(about["name"])[:200],
                focus_distance_m=np.inf if focus is None else float(focus),
                fit_report=report,
                _polynomials=RayPolynomials(degree, coefficients, heights),
                _discs=discs,
                film_mm=pairs["film_mm"],
                wavelengths_nm=pairs["wavelengths_nm"],
                **numbers,
            )
            lens.table()
            lens.table(lens.wavelengths_nm[0])
        except (KeyError, TypeError, ValueError, IndexError, OverflowError, AttributeError, ZeroDivisionError) as error:
            raise InputError(f"{os.fspath(path)}: is not a lens fitted to ray pairs ({type(error).__name__})") from None
        except InputError as error:
            raise InputError(f"{os.fspath(path)}: {error}") from None
        return lens

    def table(self, wavelength_nm: float | None = None) -> RayPairTable:
        """Returns the polynomials at a wavelength, as cameras use them.

        wavelength_nm: None: 587.56 nm, or the measured wavelength next to it. Raises InputError for a wavelength beyond
        the measured ones.
        """
        coefficients, heights = self._polynomials.at(self._variable(wavelength_nm))
        offset = self._front_z_mm
        if heights is not None:
            heights = heights.copy()
            heights[0, 0] -= offset
        at_stop = np.zeros((len(coefficients), 1, 2))
        return RayPairTable(
            name=self.name,
            wavelength_nm=self._checked(wavelength_nm),
            length_mm=self._last_z_mm - self._front_z_mm,
            film_distance_mm=self._film_z_mm - self._last_z_mm,
            focus_distance_m=self.focus_distance_m,
            film_mm=self.film_mm,
            film_radius_mm=self.fit_report.light_radius_mm,
            last_radius_mm=self._last_radius_mm,
            plane_mm=self._plane_z_mm - offset,
            degree=self._polynomials.degree,
            coefficients=np.concatenate([coefficients, at_stop], 1).astype(np.float32),
            heights=None if heights is None else heights.astype(np.float32),
            discs=self._discs.astype(np.float32),
        )

    def trace(
        self, film_mm: ArrayLike, film_side_mm: ArrayLike, *, wavelength_nm: float | None = None
    ) -> tuple[Array, Array, Booleans]:
        """Returns (origins_mm, directions, passed), (N, 3), (N, 3) and (N,), of the rays in front of the lens.

        film_mm, film_side_mm: (N, 2), points on the film and in the plane film_side_reference_z_mm, in the frame of the
        ray pairs, which is that of the results. wavelength_nm: as for table. Raises InputError.
        """
        film, side = (_points(values, name) for values, name in ((film_mm, "film_mm"), (film_side_mm, "film_side_mm")))
        if film.shape != side.shape:
            raise InputError("film_mm and film_side_mm must have the same length")
        share = (self._last_z_mm - self._side_z_mm) / (self._film_z_mm - self._side_z_mm)
        origins, directions, passed = self.table(wavelength_nm).trace(film, side + share * (film - side))
        origins[:, 2] += self._front_z_mm
        return origins, directions, passed

    def camera(
        self,
        *,
        film: Film | None = None,
        wavelength_nm: float | None = None,
        f_number: float | None = None,
        focus_m: float | None = None,
        **settings: Any,
    ) -> Camera:
        """Returns a camera with this lens, of the model "polynomial".

        film: None: that of the ray pairs. wavelength_nm: of all light, as for table. f_number, focus_m: only those of
        the ray pairs are possible. settings: as for Camera(), such as position, look_at, exposure_time_s and iso.

        Raises InputError for another f-number or focus, and for a film that reaches beyond the measured film points.
        """
        for what, asked, measured in (
            ("f-number", f_number, self.f_number),
            ("focus distance in metres", focus_m, self.focus_distance_m),
        ):
            if asked is not None and not np.isclose(asked, measured, rtol=1e-3):
                raise InputError(
                    f"the rays of this lens were measured at the {what} {measured:.4g}; {asked:.4g} needs other "
                    "measurements"
                )
        if "model" in settings or "geometry" in settings:
            raise InputError('a camera with ray pairs has the model "polynomial", and no geometry of a calibration')
        table = self.table(wavelength_nm)
        film = Film.for_lens(table.paraxial_lens) if film is None else film
        reach = float(np.hypot(film.width_mm / 2 + abs(film.shift_mm[0]), film.height_mm / 2 + abs(film.shift_mm[1])))
        if reach > self.fit_report.film_radius_mm * 1.01:
            raise InputError(
                f"the film reaches {reach:.4g} mm from the axis, but rays were measured up to "
                f"{self.fit_report.film_radius_mm:.4g} mm"
            )
        return Camera(table, film=film, model="polynomial", **settings)

    def _checked(self, wavelength_nm: float | None) -> float:
        shortest, longest = self.wavelengths_nm
        if wavelength_nm is None:
            return float(np.clip(LINE_D_NM, shortest, longest))
        if not shortest - 0.05 <= wavelength_nm <= longest + 0.05:
            raise InputError(
                f"the wavelength {wavelength_nm:.6g} nm lies outside those that were measured, {shortest:.6g} to "
                f"{longest:.6g} nm"
            )
        return float(wavelength_nm)

    def _variable(self, wavelength_nm: float | None) -> float:
        return float(wavelength_variable(*self.wavelengths_nm).at(self._checked(wavelength_nm)))

    def __repr__(self) -> str:
        report = self.fit_report
        return (
            f"<realcam.RayPairLens {self.name or 'without a name'} f/{self.f_number:.3g}, degree {report.degree}, "
            f"{1e6 * report.direction_rms_rad:.3g} microradians rms>"
        )


_NUMBERS = (
    "f_number",
    "_film_z_mm",
    "_side_z_mm",
    "_last_z_mm",
    "_front_z_mm",
    "_plane_z_mm",
    "_last_radius_mm",
)
_PAIRS = ("film_mm", "wavelengths_nm")


def _points(values: ArrayLike, name: str) -> NDArray[np.float64]:
    points = np.asarray(values, float)
    if points.ndim != 2 or points.shape[1] != 2:
        raise InputError(f"{name} must have the shape (N, 2)")
    return points


def _fitted_lens(pairs: RayPairs, largest_degree: int, random: Array) -> RayPairLens:
    ok, held_out = pairs.ok, random < _HELD_OUT
    train, test = np.flatnonzero(ok & ~held_out), np.flatnonzero(ok & held_out)
    train = train[np.argsort(random[train])[:_MOST_FITTED]]
    if len(train) < _LEAST_PASSING or not len(test):
        raise InputError(f"{ok.sum()} rays pass the lens; at least {_LEAST_PASSING / (1 - _HELD_OUT):g} are needed")
    film_radius, last_z, last = outermost(pairs.film_mm), *plane_behind(pairs)
    light_radius = min(film_radius, _FIELD_MARGIN * outermost(pairs.film_mm[ok]))
    last_radius = outermost(last[ok]) * _FIELD_MARGIN
    x, p = pairs.film_mm / light_radius, last / last_radius
    waves = np.unique(pairs.wavelength_nm)
    variable = wavelength_variable(float(waves[0]), float(waves[-1])).at(pairs.wavelength_nm)
    powers = wavelength_terms(len(waves))
    discs = fitted_discs(x[~held_out], p[~held_out], ok[~held_out])
    origin, direction = pairs.object_origin_mm, pairs.object_direction

    def fit(position: Array, degree: int, is_wide: bool) -> RayPolynomials:
        return fitted(x[train], p[train], variable[train], powers, position, direction[train], degree, is_wide=is_wide)

    # The paraxial entrance pupil, from the chief ray of a film point near the axis. In its plane, or on a sphere about
    # it, rays are near the axis at every field.
    is_wide = bool(direction[ok, 2].max() > _WIDE_COSINE)
    object_z = float(np.median(origin[ok, 2]))
    chief = 1e-3 * np.eye(1, 2), 1e-3 * stop_near_axis(x, p, ok)[0] * np.eye(1, 2)
    near_axis = fit(at_plane(origin[train], direction[train], object_z), 2, False)
    chief_point, chief_direction = (values[0] for values in evaluated(near_axis, *chief, np.zeros(1)))
    with np.errstate(divide="ignore"):
        pupil_z = float(object_z - chief_point[0] * chief_direction[2] / chief_direction[0])
    if not abs(pupil_z - object_z) < _FAR * (pairs.film_z_mm - object_z):
        pupil_z = object_z
    radius = max(abs(pupil_z - object_z), 1.2 * largest_distance(origin[ok], direction[ok], pupil_z))

    at, towards = origin[train], direction[train]
    position = at_sphere(at, towards, pupil_z, radius) if is_wide else at_plane(at, towards, pupil_z)
    best, errors = None, np.array([np.inf])
    for degree in range(1, largest_degree + 1):
        found = fit(position, degree, is_wide)
        there = evaluated(found, x[test], p[test], variable[test])[1]
        angles = np.linalg.norm(np.cross(there, direction[test]), axis=1)
        if best is None or np.sqrt((angles**2).mean()) < _WORTHWHILE * np.sqrt((errors**2).mean()):
            best, errors = found, angles
    assert best is not None
    fitted_position = evaluated(best, x[test], p[test], variable[test])[0]
    distance = distances(origin[test], direction[test], fitted_position, pupil_z)
    decided = inside(discs, x, p) & (np.hypot(*x.T) <= 1) & (np.hypot(*p.T) <= 1)
    measured_pupil = outermost(pairs.film_side_mm)
    if (np.hypot(*pairs.film_side_mm[ok].T) > _EDGE * measured_pupil).any():
        warnings.warn(
            "rays at the edge of the measured disc behind the lens pass: light beyond it was not measured, and counts "
            "as blocked",
            UserWarning,
            stacklevel=3,
        )
    report = RayPairFit(
        degree=2 * best.degree + 1,
        rays=len(ok),
        direction_rms_rad=float(np.sqrt((errors**2).mean())),
        direction_worst_rad=float(errors.max()),
        distance_rms_mm=float(np.sqrt((distance**2).mean())),
        passing_accuracy=float((decided == ok)[held_out].mean()),
        film_radius_mm=film_radius,
        light_radius_mm=light_radius,
        pupil_radius_mm=measured_pupil,
        largest_angle_deg=float(np.degrees(np.arccos(np.clip(-direction[ok, 2].max(), -1, 1)))),
    )
    lens = RayPairLens(
        name=pairs.name,
        f_number=pairs.f_number,
        focus_distance_m=pairs.focus_distance_m,
        film_mm=pairs.film_size_mm,
        wavelengths_nm=(float(waves[0]), float(waves[-1])),
        fit_report=report,
        _film_z_mm=pairs.film_z_mm,
        _side_z_mm=pairs.film_side_z_mm,
        _last_z_mm=last_z,
        _front_z_mm=object_z,
        _plane_z_mm=pupil_z,
        _polynomials=best,
        _discs=discs,
        _last_radius_mm=last_radius,
    )
    return _with_front(lens, min(object_z, pupil_z), last_z)


def _with_front(lens: RayPairLens, front_z: float, last_z: float) -> RayPairLens:
    """Returns the lens with the front vertex where its table needs it: so far in front that chief rays cross the axis
    behind it. Raises InputError if there is no such point."""
    for distance in _FRONT_DISTANCES:
        found = replace(lens, _front_z_mm=front_z - distance * (last_z - front_z))
        try:
            found.table()
        except InputError:
            if distance == _FRONT_DISTANCES[-1]:
                raise
        else:
            return found
    return lens
