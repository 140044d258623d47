"""Image simulation: a flat picture, imaged through a lens by its real rays and its point spread functions."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.fft import irfft2, next_fast_len, rfft2
from scipy.interpolate import CubicSpline, RectBivariateSpline
from scipy.ndimage import map_coordinates, shift

from .. import image_file
from .._core import InputError, Lens, RayBundle, RayStatus, __version__, _film_of_white, develop
from ..fields import STOP_PROBES
from ..rec709 import linear_of_srgb
from ..short_text import ShortText

Doubles = NDArray[np.float64]
Floats = NDArray[np.float32]
Points = tuple[Doubles, Doubles]

FLIPS = {"none": (1, 1), "horizontal": (1, -1), "vertical": (-1, 1), "both": (-1, -1)}  # steps over rows and columns
PROJECTIONS = ("tangent", "angle")
WAVELENGTHS_NM = (440.0, 480.0, 520.0, 560.0, 600.0, 640.0)
_WIDEST_TANGENT_DEG = 70.0  # rectilinear lenses reach 63 degrees, fisheyes begin at 78
_MAX_KERNEL_RADIUS = 511  # radius of a kernel about the chief ray, in pixels
_MAX_LOSS = 0.25  # fraction of a point's light that may land outside a kernel of the largest radius
# Limits of Lens.psf's method "direct", which sums over the rays for each sample; larger spots are geometric.
_MAX_DIRECT_SIZE = 131  # samples across; the time of the direct sum grows with the fourth power
_MAX_DIRECT_SPOT = 20.0  # diameter of the geometric spot in units of wavelength x f-number
_DIFFRACTION_TAIL = 16.0  # radius in units of wavelength x f-number; 1.3% of an Airy pattern's light falls outside
_TILE = 512  # smallest limit of a tile's width and height, in pixels
_PSF_SAMPLES = 65  # samples across each point spread function of ImageSimulation.psfs


@dataclass(frozen=True, repr=False)
class ImageSimulation(ShortText):
    """Result of image_simulation(): a flat picture as imaged by a lens.

    pixels: (H, W, 3) float32, film exposure in linear Rec. 709, where the picture's white on the axis is 1; row 0 at
      the top. The image is upright, as a developed picture, unless flipped by `flip`.
    x_mm: (W,), y_mm: (H,), film coordinates of the pixel centres: x to the right, y up, as in the developed image.
    illumination: (H, W) float32, illuminance from a uniform white object relative to the film's centre; 0 where no
      light arrives.
    psfs: (Y, X, S, S, 3) float32, point spread functions at the nodes of a grid over the whole film: fraction of the
      light per um^2 in the channels R, G and B, row 0 at the top, without `flip`. Nodes without light are 0.
    psf_x_mm: (X,), psf_y_mm: (Y,), film coordinates of the nodes; rows from the top. psf_pitch_um: sample spacing.
    height_deg: angle that the picture's height spans, seen from the entrance pupil.
    projection: "tangent" for a flat object, or "angle" for a picture in which distances from the centre are field
      angles.
    wavelengths_nm: (N,); weights: (N, 3), weight of each wavelength in the channels R, G and B.
    """

    pixels: Floats
    x_mm: Doubles
    y_mm: Doubles
    illumination: Floats
    psfs: Floats
    psf_x_mm: Doubles
    psf_y_mm: Doubles
    psf_pitch_um: float
    height_deg: float
    projection: str
    wavelengths_nm: Doubles
    weights: Doubles
    lens_name: str

    def developed(self) -> NDArray[np.uint8]:
        """(H, W, 3) uint8 sRGB: 1 becomes 255, and more than 1 is clipped."""
        return srgb_codes(self.pixels)

    def psf_sheet(self, height: int) -> NDArray[np.uint8]:
        """(height, W, 3) uint8 sRGB: the grid of point spread functions, each normalised to its own peak."""
        rows, columns, size = self.psfs.shape[:3]
        peaks = np.maximum(self.psfs.max(axis=(2, 3, 4), keepdims=True), 1e-30)
        framed = np.zeros((rows, columns, size + 1, size + 1, 3), np.float32)
        framed[:, :, 1:, 1:] = self.psfs / peaks
        framed[:, :, 0], framed[:, :, :, 0] = 0.1, 0.1
        sheet = framed.swapaxes(1, 2).reshape(rows * (size + 1), columns * (size + 1), 3)
        width = max(1, round(height * sheet.shape[1] / sheet.shape[0]))
        # Indices of the nearest row and column of `sheet` for each row and column of the result.
        nearest = [
            ((np.arange(count) + 0.5) * sheet_count / count).astype(int)
            for count, sheet_count in zip((height, width), sheet.shape[:2], strict=True)
        ]
        return srgb_codes(sheet[np.ix_(*nearest)])

    def save(self, path: str | os.PathLike[str], *, psfs: bool = False) -> None:
        """Writes the developed picture as .png, .jpg, .tif or .webp.

        psfs: True appends the grid of point spread functions on the right. Raises ImageFileError.
        """
        codes = self.developed()
        if psfs:
            codes = np.concatenate([codes, self.psf_sheet(codes.shape[0])], axis=1)
        entries = {"realcam:version": __version__, "realcam:lens": self.lens_name}
        image_file.write_codes(np.ascontiguousarray(codes), path, entries)


def image_simulation(
    lens: Lens,
    picture: ArrayLike | str | os.PathLike[str],
    *,
    height_deg: float | None = None,
    height_m: float | None = None,
    projection: str | None = None,
    object_distance_m: float | None = None,
    resolution: Sequence[int] | None = None,
    pixel_um: float | None = None,
    crop: Sequence[int] | None = None,
    flip: str = "none",
    falloff: bool = True,
    psf_grid: Sequence[int] = (7, 5),
    wavelengths_nm: ArrayLike | None = None,
    progress: Callable[[float], object] | None = None,
) -> ImageSimulation:
    """Images a flat picture through a lens: blur, distortion, lateral colour, falloff and diffraction.

    picture: a file, or an array (h, w, 3) or (h, w): uint8 or uint16 are sRGB codes, floats are linear Rec. 709 with
      white as 1. Its centre is the object point of the film's centre, its plane is perpendicular to the axis, and its
      surroundings are black.
    height_deg: angle of the picture's height, seen from the entrance pupil. height_m: its height in metres, for an
      object at a finite distance. Without either: the largest height at which the whole picture fits the film, by the
      scale at the film's centre.
    projection: "tangent" for a flat object, "angle" for distances from the centre that are field angles, which may
      exceed 90 degrees. None: "tangent" if the film's corners look at most 70 degrees off axis.
    object_distance_m: object plane to front vertex, inf allowed; None is the plane in focus.
    resolution: (width, height) of the film in pixels; None: the picture's, or as many as fit the film at pixel_um.
    pixel_um: pixel pitch; None: the largest at which the resolution fits on the film.
    crop: (left, top, width, height) in pixels of the film, before `flip`: the part that is computed.
    flip: "horizontal", "vertical" or "both" mirrors the result; "both" is the image as it lies on the film.
    falloff: False omits relative illumination, but points without light stay black.
    psf_grid: (X, Y), nodes over the film at which point spread functions are computed; they are interpolated between.
    wavelengths_nm: None: 440 to 640 in steps of 40, or the design wavelength alone for a lens that is not made for
      visible light. Each represents the part of the film's sensitivity to white (D65) that is nearest to it.
    progress: called with the fraction done, 0 to 1.
    Raises InputError if the arguments contradict each other, if no light reaches the film's centre, or if more than a
    quarter of the light of a point lands farther than 511 pixels away; ImageFileError for a file that cannot be read.
    """
    source = _linear(picture)
    if flip not in FLIPS:
        raise InputError(f'unknown flip "{flip}"; expected one of {", ".join(FLIPS)}')
    if len(psf_grid) != 2 or min(psf_grid) < 2:
        raise InputError("psf_grid must be at least 2 along x and along y")
    film = _film_of(lens, source, resolution, pixel_um)
    left, top, columns, rows = _checked_crop(crop, film)
    wavelengths, weights = _bands(lens, wavelengths_nm)
    light = _FieldLight(lens, object_distance_m, wavelengths, weights, film.half_mm)
    kind = _projection(projection, light, height_m)
    centre, scale = light.centre(kind, film.pitch_mm)
    extent = _object_height(light, kind, height_deg, height_m)  # of the picture, in tangents or radians
    if extent is None:
        extent = float(min(film.width * scale[0] * source.shape[0] / source.shape[1], film.height * scale[1]))

    def report(fraction: float) -> None:
        if progress is not None:
            progress(fraction)

    # Computing the kernels counts as the first half of the work.
    kernels = _Kernels(light, (int(psf_grid[0]), int(psf_grid[1])), film, lambda fraction: report(0.5 * fraction))

    def source_points(u: Doubles, v: Doubles, channel: int) -> Points:
        """Picture positions (row, column) that the lens images to film points; nan if a point has no object point."""
        x, y = (light.object_points(-u, v, channel, kind) - centre[:, None, None]) * (source.shape[0] / extent)
        return 0.5 * source.shape[0] - 0.5 - y, 0.5 * source.shape[1] - 0.5 + x

    pixels = np.empty((rows, columns, 3), np.float32)
    illumination = np.empty((rows, columns), np.float32)
    tiles = list(_tiles(film, (left, top, columns, rows), kernels.grid, max(_TILE, 2 * kernels.radius)))
    for k, tile in enumerate(tiles):
        tile_pixels = np.s_[tile.y0 - top : tile.y1 - top, tile.x0 - left : tile.x1 - left]
        tile_illumination = light.illumination(-film.u(tile.x0, tile.x1)[None, :], film.v(tile.y0, tile.y1)[:, None])
        illumination[tile_pixels] = tile_illumination
        for channel in range(3):
            sharp = _warped(source[..., channel], film, tile, kernels.radius, partial(source_points, channel=channel))
            pixels[tile_pixels][..., channel] = kernels.convolved(sharp, channel, tile)
        pixels[tile_pixels] *= (tile_illumination if falloff else (tile_illumination > 0))[..., None]
        report(0.5 + 0.5 * (k + 1) / len(tiles))
    row_step, column_step = FLIPS[flip]
    return ImageSimulation(
        np.ascontiguousarray(pixels[::row_step, ::column_step]),
        film.u(left, left + columns)[::column_step],
        -film.v(top, top + rows)[::row_step],
        np.ascontiguousarray(illumination[::row_step, ::column_step]),
        *kernels.sampled_psfs(),
        math.degrees(extent) if kind == "angle" else math.degrees(2 * math.atan(0.5 * extent)),
        kind,
        wavelengths,
        weights,
        lens.name,
    )


@dataclass(frozen=True)
class _Film:
    """Pixels of the film. u and v are mm from its centre to the right and downwards, as in the developed image."""

    width: int
    height: int
    pitch_mm: float

    @property
    def half_mm(self) -> Doubles:
        """(2,): half of the film's width and height."""
        return 0.5 * self.pitch_mm * np.array([self.width, self.height])

    def u(self, begin: int, end: int) -> Doubles:
        """(end - begin,): u of the centres of columns."""
        return self._along(begin, end, self.width)

    def v(self, begin: int, end: int) -> Doubles:
        """(end - begin,): v of the centres of rows."""
        return self._along(begin, end, self.height)

    def _along(self, begin: int, end: int, count: int) -> Doubles:
        return np.asarray((np.arange(begin, end) + 0.5 - 0.5 * count) * self.pitch_mm, np.float64)


@dataclass(frozen=True)
class _Tile:
    """Columns x0 to x1 and rows y0 to y1 of the film (ends exclusive), within a cell (column, row) of the PSF grid."""

    cell: tuple[int, int]
    x0: int
    x1: int
    y0: int
    y1: int


class _FieldLight:
    """Imaging properties over the film: directions of the object points, relative illumination and lateral colour.

    Film points are (x, y) in mm in the film's own frame, which the developed image shows rotated by 180 degrees. An
    object point is identified by the film point of its chief ray at the design wavelength.
    wavelengths: (N,), nm; weights: (N, 3), as in ImageSimulation. half_mm: (2,), half of the film's width and height.
    distance_m: object plane to front vertex; from_pupil_m: object plane to entrance pupil.
    corner_deg: largest field angle of the illuminated film.
    Raises InputError if no light reaches the film's centre.
    """

    def __init__(
        self, lens: Lens, object_distance_m: float | None, wavelengths: Doubles, weights: Doubles, half_mm: Doubles
    ) -> None:
        self.lens, self.wavelengths, self.weights, self.half_mm = lens, wavelengths, weights, half_mm
        self.distance_m = _distance_in_focus(lens) if object_distance_m is None else object_distance_m
        if not self.distance_m > 0:
            raise InputError("object_distance_m must be positive, or inf")
        pupil = lens.first_order().entrance_pupil_position_mm if lens.is_rotational else 0.0
        self.from_pupil_m = self.distance_m + (1e-3 * pupil if math.isfinite(pupil) else 0.0)
        self.central_illuminance = self._illuminance((0.0, 0.0))
        if not self.central_illuminance > 0 or np.isnan(self.direction((0.0, 0.0))).any():
            raise InputError(f'no light through lens "{lens.name}" reaches the centre of the film')
        for nm in wavelengths:  # raises if a glass has no data at the wavelength
            self.chief_ray_mm((0.0, 0.0), float(nm))
        if lens.is_rotational:
            self._sample_radius()
        else:
            self._sample_film()
        # Field angles of film points along both diagonals, for the largest illuminated one.
        along = np.linspace(-1, 1, 21)
        angles = np.abs(self.angles(np.outer(half_mm[0], along), np.outer([half_mm[1], -half_mm[1]], along), 1))
        is_lit = self.illumination(np.outer(half_mm[0], along), np.outer([half_mm[1], -half_mm[1]], along)) > 0
        self.corner_deg = float(np.degrees(np.max(np.hypot(*angles)[is_lit])))

    def direction(self, point: tuple[float, float]) -> Doubles:
        """(2,): direction of the object point, as its angle to the axis in radians along x and y; nan without light."""
        try:
            rays = self.lens.aim(STOP_PROBES, film_mm=point, object_distance_m=self.distance_m)
        except InputError:
            return np.full(2, np.nan)
        passing = np.flatnonzero(rays.status == RayStatus.OK)
        if not passing.size:
            return np.full(2, np.nan)
        (x, y, z), ray = rays.origins_mm[passing[0]], rays.directions[passing[0]]
        if math.isinf(self.distance_m):
            across, along = -ray[:2], float(ray[2])
        elif ray[2] <= 0:  # the ray does not come from the object plane
            return np.full(2, np.nan)
        else:  # the intersection with the object plane, seen from the entrance pupil
            across = np.array([x, y]) - (1e3 * self.distance_m + z) / ray[2] * ray[:2]
            along = 1e3 * self.from_pupil_m
        radius = float(np.hypot(*across))
        angles: Doubles = across * (math.atan2(radius, along) / radius if radius > 0 else 1.0)
        return angles

    def _illuminance(self, point: tuple[float, float]) -> float:
        """Illuminance at a film point from a uniform object of luminance 1; 0 if no light arrives."""
        try:
            return float(self.lens.film_pupil(point).irradiance)
        except InputError:
            return 0.0

    def shifts(self, point: tuple[float, float]) -> Doubles:
        """(N, 2), mm: film points of the wavelengths' chief rays, relative to the design wavelength's; nan without
        light."""
        if len(self.wavelengths) == 1 and self.wavelengths[0] == self.lens.wavelength_nm:
            return np.zeros((1, 2))
        if np.isnan(self.direction(point)).any():
            return np.full((len(self.wavelengths), 2), np.nan)
        try:
            ends = [self.chief_ray_mm(point, float(nm)) for nm in self.wavelengths]
        except InputError:
            return np.full((len(self.wavelengths), 2), np.nan)
        return np.array(ends) - point

    def chief_ray_mm(self, point: tuple[float, float], nm: float) -> tuple[float, float]:
        """Film point of the chief ray at a wavelength. Raises InputError if no light arrives."""
        try:
            return self.lens.spot(
                film_mm=point, wavelength_nm=nm, object_distance_m=self.distance_m, pupil=[[0.0, 0.0]]
            ).chief_ray_mm
        except InputError:  # the centre of the stop is obstructed or vignetted
            return self.bundle(point, nm, arms=8, nodes=2).chief_ray_mm

    def bundle(self, point: tuple[float, float], nm: float, **size: int) -> RayBundle:
        """Ray bundle of a film point. size: arms and nodes of Lens.bundle. Raises InputError if no light arrives."""
        return self.lens.bundle(film_mm=point, wavelength_nm=nm, object_distance_m=self.distance_m, **size)

    def _sample(self, point: tuple[float, float]) -> Doubles:
        """(7,): angles (x, y) of the object points that are imaged to a film point in R, G and B; its illumination."""
        by_channel = self.weights.T @ np.nan_to_num(self.shifts(point))
        points = [(point[0] - float(dx), point[1] - float(dy)) for dx, dy in by_channel]
        found = {p: self.direction(p) for p in set(points)}  # evaluated once if channels share a point
        angles = [found[p] for p in points]
        return np.array([*np.concatenate(angles), self._illuminance(point) / self.central_illuminance])

    def _sample_radius(self) -> None:
        """Tabulates rotationally symmetric lenses over the distance from the axis.

        Angles are splines through 97 samples, continued linearly beyond the last sample with light.
        """
        corner = float(np.hypot(*self.half_mm))
        radii = np.linspace(0, corner, 97)
        values = np.array([self._sample((0.0, float(r))) for r in radii])
        dense = np.linspace(0, 1.01 * corner, 4097)
        table = []
        for k in (1, 3, 5):  # angles along y in R, G and B, because the samples lie on the y axis
            is_finite = np.isfinite(values[:, k])
            has_curve = is_finite.sum() > 1
            curve = CubicSpline(radii[is_finite], values[is_finite, k]) if has_curve else CubicSpline([0, 1], [0, 0])
            last = radii[is_finite][-1]
            table.append(curve(np.minimum(dense, last)) + curve(last, 1) * np.maximum(dense - last, 0))
        end = self._end_of_light(radii, values[:, 6])
        inner = radii <= end
        illumination = np.interp(
            dense, [*radii[inner], max(end, radii[inner][-1] + 1e-9)], [*values[inner, 6], values[inner, 6][-1]]
        )
        self._radii, self._angle_table = dense, np.array(table)
        self._illumination_table = np.where(dense <= end, illumination, 0.0)

    def _end_of_light(self, radii: Doubles, light: Doubles) -> float:
        """Radius of the illuminated field, by bisection between the samples; inf if all samples have light."""
        unlit = np.flatnonzero(~(light > 0))
        if not unlit.size:
            return math.inf
        low, high = float(radii[unlit[0] - 1]), float(radii[unlit[0]])
        for _ in range(12):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self._illuminance((0.0, middle)) > 0 else (low, middle)
        return low

    def _sample_film(self) -> None:
        """Tabulates lenses without rotational symmetry over x and y on the film, refined by splines."""
        x, y = (half * np.linspace(-1, 1, n) for half, n in zip(self.half_mm, (17, 11), strict=True))
        values = np.array([[self._sample((float(a), float(b))) for a in x] for b in y])
        is_lit = np.isfinite(values[..., :6]).all(axis=2)
        if not is_lit.all():  # extrapolates angles beyond the illuminated field by a polynomial
            powers = np.meshgrid(x / x[-1], y / y[-1])
            terms = np.stack([powers[0] ** i * powers[1] ** k for i in range(4) for k in range(4)], axis=-1)
            values[~is_lit, :6] = terms[~is_lit] @ np.linalg.lstsq(terms[is_lit], values[is_lit, :6], rcond=None)[0]
            values[~is_lit, 6] = 0
        degrees = [3] * 6 + [
            3 if is_lit.all() else 1
        ]  # linear, because a cubic would overshoot at the edge of the light
        fine_x, fine_y = np.linspace(x[0], x[-1], 385), np.linspace(y[0], y[-1], 257)
        self._film_table = np.array([
            RectBivariateSpline(y, x, values[..., k], kx=degree, ky=degree)(fine_y, fine_x)
            for k, degree in enumerate(degrees)
        ])  # fmt: skip

    def _on_film(self, x: Doubles, y: Doubles, k: int) -> Doubles:
        """Component k of `_sample`, interpolated bilinearly in the table of _sample_film."""
        rows, columns = self._film_table.shape[1:]
        x, y = np.broadcast_arrays(x, y)
        positions = [(y / self.half_mm[1] + 1) * 0.5 * (rows - 1), (x / self.half_mm[0] + 1) * 0.5 * (columns - 1)]
        values: Doubles = map_coordinates(self._film_table[k], positions, order=1, mode="nearest")
        return values

    def angles(self, x: Doubles, y: Doubles, channel: int) -> Doubles:
        """(2, ...): directions, as in `direction`, of the object points that a channel images to film points."""
        x, y = np.broadcast_arrays(x, y)
        if not self.lens.is_rotational:
            return np.stack([self._on_film(x, y, 2 * channel), self._on_film(x, y, 2 * channel + 1)])
        radius = np.hypot(x, y)
        ratio = np.interp(radius, self._radii, self._angle_table[channel]) / np.maximum(radius, 1e-12)
        return np.stack([x * ratio, y * ratio])

    def illumination(self, x: Doubles, y: Doubles) -> Doubles:
        """Illuminance at film points from a uniform white object, relative to the film's centre."""
        if not self.lens.is_rotational:
            return np.maximum(self._on_film(x, y, 6), 0)
        light: Doubles = np.interp(np.hypot(x, y), self._radii, self._illumination_table)
        return light

    def object_points(self, x: Doubles, y: Doubles, channel: int, projection: str) -> Doubles:
        """(2, ...): object points as tangents, or as angles in radians; nan for tangents from 90 degrees on."""
        angles = self.angles(x, y, channel)
        if projection == "angle":
            return angles
        size = np.hypot(*angles)
        tangent = np.where(size < 0.5 * math.pi, np.tan(np.minimum(size, 1.57)), np.nan)
        points: Doubles = angles * np.where(size > 0, tangent / np.maximum(size, 1e-30), 1.0)
        return points

    def centre(self, projection: str, pitch_mm: float) -> tuple[Doubles, Doubles]:
        """The object point of the film's centre, (2,), and its displacement per pixel to the right and down, (2,), in
        tangents or radians."""
        step = np.array([0.0, 1.0, -1.0, 0.0, 0.0]) * 4 * pitch_mm
        points = self.object_points(step, step[[0, 3, 3, 1, 2]], 1, projection)
        moves = (np.hypot(*(points[:, k] - points[:, k + 1])) / 8 for k in (1, 3))
        return points[:, 0], np.array(list(moves))


class _Node(NamedTuple):
    """Kernels of a node of the PSF grid in the channels R, G and B, upright as developed; each sums to 1."""

    kernels: Floats  #: (3, s, s), at pixel pitch
    fine: Floats  #: (3, S, S), at fine_pitch_um
    fine_pitch_um: float


class _Kernels:
    """Pixel kernels of the channels' point spread functions at the nodes of a film grid, upright as developed.

    grid: number of nodes along x and y. radius: largest kernel radius of all nodes, in pixels.
    report: called with the fraction of the nodes done. Raises InputError if a kernel would be too large.
    """

    def __init__(
        self, light: _FieldLight, grid: tuple[int, int], film: _Film, report: Callable[[float], object]
    ) -> None:
        self.light, self.film, self.pitch_um, self.grid = light, film, 1e3 * film.pitch_mm, grid
        self.x, self.y = (half * np.linspace(-1, 1, n) for half, n in zip(light.half_mm, grid, strict=True))
        lens = light.lens
        # A rotationally symmetric lens with a circular stop is symmetric about x and y: a quarter of the film suffices.
        self.is_symmetric = lens.is_rotational and lens.iris_blades == 0
        points = sorted({self._key(float(x), float(y)) for x in self.x for y in self.y})
        nodes: dict[tuple[float, float], _Node] = {}
        for k, point in enumerate(points):
            node = self._computed(point)
            if node is not None:
                nodes[point] = node
            report((k + 1) / len(points))
        if not nodes:  # all nodes lie outside the illuminated field
            node = self._computed((0.0, 0.0))
            assert node is not None
            nodes[0.0, 0.0] = node
        self._nodes = nodes
        self.radius = max((node.kernels.shape[1] // 2 for node in nodes.values()), default=0)
        self._window_um = max((node.fine.shape[1] * node.fine_pitch_um for node in nodes.values()), default=1.0)

    def _key(self, x: float, y: float) -> tuple[float, float]:
        """Film point whose node is computed for (x, y): the mirrored one in the first quadrant if symmetry allows."""
        x, y = round(x, 9) + 0.0, round(y, 9) + 0.0
        return (abs(x), abs(y)) if self.is_symmetric else (x, y)

    def _computed(self, point: tuple[float, float]) -> _Node | None:
        """Computes the node at a film point. Returns None if no light arrives."""
        light = self.light
        shifts = light.shifts(point)
        if np.isnan(shifts).any():
            return None
        try:
            bundles = [light.bundle(point, float(nm), arms=32, nodes=6) for nm in light.wavelengths]
        except InputError:
            return None
        # Largest displacement of a wavelength from its channel's mean: lateral colour within a channel.
        colour_um = 1e3 * np.abs(shifts[:, None] - light.weights.T @ shifts)[np.abs(light.weights) > 0.01].max(
            initial=0.0
        )
        # Wavelength x f-number along x and y, in um: the finest detail that diffraction leaves.
        details = [1e-3 * b.wavelength_nm / b.index / np.ptp(b.edge_slopes.reshape(-1, 2), axis=0) for b in bundles]
        spot_um = max(_spot_radius_um(bundle) for bundle in bundles) + colour_um
        finest, coarsest = min(float(d.min()) for d in details), max(float(d.max()) for d in details)
        radius = max(1, math.ceil((spot_um + _DIFFRACTION_TAIL * coarsest) / self.pitch_um))
        # Fine samples per pixel along each side: an odd number, so that a sample lies in the pixel's centre.
        oversampling = max(3, 2 * math.ceil(0.5 * (self.pitch_um / finest - 1)) + 1)
        is_direct = 2 * spot_um <= _MAX_DIRECT_SPOT * finest and oversampling * (2 * radius + 1) <= _MAX_DIRECT_SIZE
        if not is_direct:
            radius = min(radius, max(math.ceil(spot_um / self.pitch_um) + 1, 12))
            oversampling = 5 if radius < 32 else 3 if radius < 64 else 1
        if radius > _MAX_KERNEL_RADIUS:
            radius = _MAX_KERNEL_RADIUS
            required = max(_spot_radius_um(bundle, 1 - _MAX_LOSS) for bundle in bundles) / self.pitch_um
            if required > radius:
                raise InputError(
                    f"the blur at the film point ({point[0]:.4g}, {point[1]:.4g}) mm reaches {required:.0f} pixels "
                    f"from the chief ray; at most {radius} can be simulated: use larger pixels or a smaller stop"
                )
        size, pitch_um = oversampling * (2 * radius + 1), self.pitch_um / oversampling
        fine = np.zeros((3, size, size))
        for nm, chief_shift, weights, detail in zip(light.wavelengths, shifts, light.weights, details, strict=True):
            psf = light.lens.psf(
                film_mm=point,
                wavelength_nm=float(nm),
                object_distance_m=light.distance_m,
                method="direct" if is_direct else "geometric",
                size=size,
                pitch_um=pitch_um,
            )
            values = psf.values if is_direct else _diffracted(psf.values, detail / pitch_um)
            values = values[:, ::-1] / values.sum()  # x to the right, y down
            for channel in range(3):
                if abs(weights[channel]) > 1e-4:
                    dx, dy = 1e3 * (chief_shift - light.weights[:, channel] @ shifts) / pitch_um
                    fine[channel] += weights[channel] * shift(values, (dy, -dx), order=1, mode="grid-constant")
        fine /= fine.sum(axis=(1, 2), keepdims=True)
        kernels = fine.reshape(3, 2 * radius + 1, oversampling, 2 * radius + 1, oversampling).sum(axis=(2, 4))
        return _Node(kernels.astype(np.float32), fine.astype(np.float32), pitch_um)

    def node(self, column: int, row: int) -> _Node | None:
        """Node of the grid: columns from the left, rows from the top of the developed image; None without light."""
        x, y = float(-self.x[column]), float(self.y[row])
        node = self._nodes.get(self._key(x, y))
        if node is None or not self.is_symmetric:
            return node
        across, down = (-1 if x < 0 else 1), (-1 if y < 0 else 1)
        return _Node(node.kernels[:, ::down, ::across], node.fine[:, ::down, ::across], node.fine_pitch_um)

    def kernel(self, column: int, row: int, channel: int) -> Floats:
        """(2 radius + 1, 2 radius + 1), sum 1. A node without light uses the kernel of the nearest node with light."""
        nodes = [(c, r) for r in range(self.grid[1]) for c in range(self.grid[0]) if self.node(c, r) is not None]
        nearest = min(nodes, key=lambda n: (n[0] - column) ** 2 + (n[1] - row) ** 2, default=None)
        node = self.node(*nearest) if nearest else self._nodes[0.0, 0.0]
        assert node is not None
        kernel = node.kernels[channel]
        return np.pad(kernel, self.radius - kernel.shape[0] // 2)

    def convolved(self, sharp: Floats, channel: int, tile: _Tile) -> Floats:
        """Blurs a tile by kernels that are interpolated between the four nodes of its cell.

        sharp: the sharp tile with a border of `radius` pixels. Returns the tile without the border.
        """
        (column, row), rows, columns = tile.cell, tile.y1 - tile.y0, tile.x1 - tile.x0
        along_x = (np.arange(tile.x0, tile.x1) + 0.5) / self.film.width * (self.grid[0] - 1) - column
        along_y = (np.arange(tile.y0, tile.y1) + 0.5) / self.film.height * (self.grid[1] - 1) - row
        shape = [next_fast_len(n, real=True) for n in sharp.shape]
        transform = rfft2(sharp, shape)
        blurred = np.zeros((rows, columns), np.float32)
        for c, weight_x in ((0, 1 - along_x), (1, along_x)):
            for r, weight_y in ((0, 1 - along_y), (1, along_y)):
                kernel = rfft2(self.kernel(column + c, row + r, channel), shape)
                whole = irfft2(transform * kernel, shape)
                first = 2 * self.radius
                part = whole[first : first + rows, first : first + columns]
                blurred += (weight_y[:, None] * weight_x).astype(np.float32) * part
        return blurred

    def sampled_psfs(self) -> tuple[Floats, Doubles, Doubles, float]:
        """Returns psfs, psf_x_mm, psf_y_mm and psf_pitch_um of ImageSimulation."""
        pitch = self._window_um / _PSF_SAMPLES
        psfs = np.zeros((self.grid[1], self.grid[0], _PSF_SAMPLES, _PSF_SAMPLES, 3), np.float32)
        offsets = (np.arange(_PSF_SAMPLES) - _PSF_SAMPLES // 2) * pitch  # um, from the centre of each function
        for row in range(self.grid[1]):
            for column in range(self.grid[0]):
                node = self.node(column, row)
                if node is not None:
                    indices = np.meshgrid(*2 * [offsets / node.fine_pitch_um + node.fine.shape[1] // 2], indexing="ij")
                    for channel in range(3):
                        values = map_coordinates(node.fine[channel], indices, order=1, mode="grid-constant")
                        psfs[row, column, ..., channel] = values / node.fine_pitch_um**2
        return psfs, self.x, -self.y, pitch


def _spot_radius_um(bundle: RayBundle, fraction: float = 0.999) -> float:
    """Distance from the chief ray within which a fraction of the light lands.

    The default is below 1, so that a few outlying rays do not enlarge the kernels.
    """
    distances = np.hypot(*(bundle.points_mm - bundle.chief_ray_mm).T)
    order = np.argsort(distances)
    enclosed = np.cumsum(bundle.energy[order])
    return float(1e3 * distances[order][np.searchsorted(enclosed, fraction * enclosed[-1])])


def _diffracted(values: Doubles, details: Doubles) -> Doubles:
    """Convolves a geometric spot with the diffraction pattern of a circular aperture, by its transfer function.

    details: wavelength x f-number along x and y, in samples of the array.
    """
    shape = [next_fast_len(2 * n, real=True) for n in values.shape]
    across, down = np.fft.rfftfreq(shape[1]) * details[0], np.fft.fftfreq(shape[0]) * details[1]
    nu = np.minimum(np.hypot(down[:, None], across), 1)
    transfer = 2 / math.pi * (np.arccos(nu) - nu * np.sqrt(1 - nu**2))
    spread: Doubles = irfft2(rfft2(values, shape) * transfer, shape)[: values.shape[0], : values.shape[1]]
    return np.maximum(spread, 0)


def _warped(
    source: Floats, film: _Film, tile: _Tile, border: int, source_points: Callable[[Doubles, Doubles], Points]
) -> Floats:
    """Resamples the picture for a tile and its border: each pixel is the mean over its footprint in the picture.

    border: in pixels. source_points: returns the picture positions (row, column) of film points (u, v) in mm.
    """
    u = film.u(tile.x0 - border, tile.x1 + border)[None, :]
    v = film.v(tile.y0 - border, tile.y1 + border)[:, None]
    down, across = source_points(u, v)
    steps = [np.nanmax(np.abs(np.diff(p, axis=axis)), initial=0.0) for p in (down, across) for axis in (0, 1)]
    samples = int(min(max(1, math.ceil(max(steps) - 0.25)), 16))
    offsets = ((np.arange(samples) + 0.5) / samples - 0.5) * film.pitch_mm  # of the subsamples of a pixel
    total = np.zeros(down.shape, np.float32)
    for dv in offsets:
        for du in offsets:
            down, across = source_points(u + du, v + dv)
            total += _interpolated(source, np.nan_to_num(down, nan=-9.0), np.nan_to_num(across, nan=-9.0))
    total /= samples**2
    return total


def _interpolated(source: Floats, down: Doubles, across: Doubles) -> Floats:
    """Interpolates the picture bilinearly at rows `down` and columns `across`, which are clipped in place.

    Values are 0 outside the picture. Only the part of the picture that is needed is read.
    """
    ends = []
    for positions, n in ((down, source.shape[0]), (across, source.shape[1])):
        np.clip(positions, -9, n + 9, out=positions)
        low, high = max(0, math.floor(positions.min()) - 1), min(n, math.ceil(positions.max()) + 2)
        if low >= high:
            return np.zeros(down.shape, np.float32)
        ends.append((low, high))
    part = source[slice(*ends[0]), slice(*ends[1])]
    values: Floats = map_coordinates(part, [down - ends[0][0], across - ends[1][0]], order=1, mode="grid-constant")
    return values


def _tiles(film: _Film, crop: tuple[int, int, int, int], grid: tuple[int, int], largest: int) -> Iterator[_Tile]:
    """Yields tiles of the crop, each within one cell of the PSF grid.

    crop: left, top, width, height in pixels. grid: nodes along x and y. largest: limit of a tile's sides, in pixels.
    """

    def parts(first: int, count: int, size: int, nodes: int) -> list[tuple[int, int, int]]:
        """(cell, begin, end) of the tiles along one axis, for `count` of the film's `size` pixels from `first` on."""
        found = []
        for cell in range(nodes - 1):
            # Pixels whose centre lies in the cell.
            begin, end = (math.ceil(c * size / (nodes - 1) - 0.5) for c in (cell, cell + 1))
            begin, end = max(begin, first), min(end, first + count)
            found += [(cell, start, min(start + largest, end)) for start in range(begin, end, largest)]
        return found

    left, top, columns, rows = crop
    for row, y0, y1 in parts(top, rows, film.height, grid[1]):
        for column, x0, x1 in parts(left, columns, film.width, grid[0]):
            yield _Tile((column, row), x0, x1, y0, y1)


def _linear(picture: ArrayLike | str | os.PathLike[str]) -> Floats:
    """Returns a picture as (h, w, 3) float32, linear. Raises InputError, ImageFileError."""
    if isinstance(picture, (str, os.PathLike)):
        return np.asarray(image_file.read_picture(picture), np.float32)
    array = np.asarray(picture)
    if array.ndim == 2:
        array = np.repeat(array[..., None], 3, axis=2)
    if array.ndim != 3 or array.shape[2] != 3 or array.size == 0 or array.dtype.kind not in "uf":
        raise InputError("picture must be a file, or an array (h, w, 3) or (h, w) of uint8, uint16 or floats")
    if array.dtype.kind == "u":
        if array.dtype.itemsize > 2:
            raise InputError(f"picture must be of uint8, uint16 or floats; its dtype is {array.dtype}")
        linear = linear_of_srgb(np.linspace(0, 1, 256**array.dtype.itemsize))
        return np.asarray(linear[array], np.float32)
    if not np.isfinite(array).all():
        raise InputError("picture must hold finite numbers")
    return array.astype(np.float32)


def srgb_codes(linear: Floats) -> NDArray[np.uint8]:
    """8-bit sRGB of linear values. develop() renders 10 / ISO lux seconds as middle grey, which is 18% of white."""
    codes: NDArray[np.uint8] = develop(linear * np.float32(10 / 100 / 0.18), 100, "linear")
    return codes


def _film_of(lens: Lens, source: Floats, resolution: Sequence[int] | None, pixel_um: float | None) -> _Film:
    """Film of image_simulation's arguments. Raises InputError."""
    if pixel_um is not None and not 0 < pixel_um < math.inf:
        raise InputError("pixel_um must be a positive number")
    if resolution is None:
        if pixel_um is None:
            resolution = (source.shape[1], source.shape[0])
        else:
            resolution = (int(1e3 * lens.film_mm[0] / pixel_um + 1e-6), int(1e3 * lens.film_mm[1] / pixel_um + 1e-6))
    width, height = (int(n) for n in resolution)
    if not (1 <= width <= 100000 and 1 <= height <= 100000):
        raise InputError(f"the film would have {width} x {height} pixels; expected 1 to 100000 along each side")
    pitch = min(lens.film_mm[0] / width, lens.film_mm[1] / height) if pixel_um is None else 1e-3 * pixel_um
    return _Film(width, height, float(pitch))


def _checked_crop(crop: Sequence[int] | None, film: _Film) -> tuple[int, int, int, int]:
    """Returns left, top, width and height of the crop; None: the whole film. Raises InputError."""
    if crop is None:
        return 0, 0, film.width, film.height
    if len(crop) != 4:
        raise InputError("crop must be left, top, width and height in pixels of the film")
    left, top, columns, rows = (int(n) for n in crop)
    if min(left, top) < 0 or min(columns, rows) < 1 or left + columns > film.width or top + rows > film.height:
        raise InputError(
            f"crop: {columns} x {rows} pixels from ({left}, {top}) on do not lie within the film's "
            f"{film.width} x {film.height} pixels"
        )
    return left, top, columns, rows


def _bands(lens: Lens, wavelengths_nm: ArrayLike | None) -> tuple[Doubles, Doubles]:
    """Returns the wavelengths, (N,), nm, and their weights in the channels, (N, 3), whose columns sum to 1."""
    if wavelengths_nm is None:
        is_visible = WAVELENGTHS_NM[0] < lens.wavelength_nm < WAVELENGTHS_NM[-1]
        wavelengths_nm = WAVELENGTHS_NM if is_visible else lens.wavelength_nm
    nm = np.unique(np.atleast_1d(np.asarray(wavelengths_nm, float)))
    if nm.ndim != 1 or nm.size == 0 or not (np.isfinite(nm) & (nm > 0)).all():
        raise InputError("wavelengths_nm must be positive numbers, at least one")
    cells = _film_of_white("D65")  # cells of equal probability: their ends in nm, and the film's R, G and B
    nearest = np.abs(cells[:, :2].mean(axis=1)[:, None] - nm).argmin(axis=1)
    weights = np.array([cells[nearest == k, 2:].sum(axis=0) for k in range(len(nm))])
    return nm, weights / weights.sum(axis=0)


def _distance_in_focus(lens: Lens) -> float:
    """Distance from the plane in focus to the front vertex, m."""
    return float(lens.focus_distance_m - 1e-3 * lens.film_frame[3, 2])


def _projection(projection: str | None, light: _FieldLight, height_m: float | None) -> str:
    """Returns the projection, "tangent" or "angle"; None selects it by the field angle of the film's corner. Raises
    InputError if it does not apply to the lens or to height_m."""
    corner = light.corner_deg
    kind = projection or ("tangent" if corner <= _WIDEST_TANGENT_DEG or height_m is not None else "angle")
    if kind not in PROJECTIONS:
        raise InputError(f'unknown projection "{kind}"; expected tangent or angle')
    if height_m is not None and corner >= 90:
        raise InputError(
            f"height_m: the film sees {corner:.3g} deg from the axis, where a flat object has no height; "
            'use height_deg with the projection "angle"'
        )
    if height_m is not None and kind == "angle":
        raise InputError('height_m requires the projection "tangent"; use height_deg')
    if kind == "angle" and corner >= 90 and math.isfinite(light.distance_m):
        raise InputError(
            f"the film sees {corner:.3g} deg from the axis, but an object at a finite distance ends before 90 deg; "
            "use an object distance of inf"
        )
    return kind


def _object_height(light: _FieldLight, kind: str, height_deg: float | None, height_m: float | None) -> float | None:
    """The picture's height in tangents or radians; None if neither height is specified."""
    if height_m is not None:
        if height_deg is not None:
            raise InputError("height_deg and height_m exclude each other")
        if not 0 < height_m < math.inf:
            raise InputError("height_m must be a positive number")
        if math.isinf(light.distance_m):
            raise InputError("height_m: the object is at infinity; use height_deg, or a finite object distance")
        return height_m / light.from_pupil_m
    if height_deg is None:
        return None
    limit_deg = 180 if kind == "tangent" else 360
    if not 0 < height_deg < limit_deg:
        raise InputError(f'height_deg must lie between 0 and {limit_deg} for the projection "{kind}"')
    return 2 * math.tan(math.radians(0.5 * height_deg)) if kind == "tangent" else math.radians(height_deg)
