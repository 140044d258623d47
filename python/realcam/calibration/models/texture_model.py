"""A camera model given by two textures: directions of pixels, and pixels of directions."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..arrays import Array, Booleans, Integers
from ..status import PointStatus
from .central import camera_matrix_near_axis


@dataclass(frozen=True)
class TextureModel:
    """Directions and pixels, interpolated bilinearly.

    directions: (h, w, 3) in camera axes (y down, z forward) over the picture, texel centres on the picture's
    coordinates from 0 to 1; a direction against the axis, (0, 0, -1), means no ray. positions: (n, m, 2), coordinates
    in the picture from 0 to 1, over octahedral coordinates with the axis in the middle; negative if there is none.
    matrix: (3, 3), from these coordinates to pixels. Projections start from `positions` and are refined until
    `directions` agree, so that both maps are inverses of each other.
    """

    directions: Array
    positions: Array
    matrix: Array

    @property
    def is_extrapolated(self) -> bool:
        return False

    @cached_property
    def largest_angle(self) -> float:
        """The smallest angle at which the texture of positions has no pixel."""
        directions = octahedral_directions(*self.positions.shape[:2])
        is_empty = (self.positions < 0).any(axis=2).ravel()
        angles = np.arccos(np.clip(directions[:, 2], -1, 1))
        return float(angles[is_empty].min()) if is_empty.any() else np.pi

    @property
    def camera_matrix(self) -> Array:
        return camera_matrix_near_axis(self.project)

    def project(self, points: Array) -> tuple[Array, Integers]:
        length = np.linalg.norm(points, axis=1)
        with np.errstate(invalid="ignore", divide="ignore"):
            unit = points / length[:, None]
        is_valid = np.isfinite(unit).all(axis=1)
        coordinates = np.full((len(points), 2), np.nan)
        octahedral = (_to_octahedral(unit[is_valid]) + 1) / 2
        # At the edge of the lens's picture some texels are not set; the others are near enough to start from.
        is_set: Booleans = np.logical_and.reduce(self.positions >= 0, axis=2)
        start, is_whole = _bilinear(self.positions, octahedral, is_set)
        found, is_solved = self._refined(start, unit[is_valid])
        coordinates[is_valid] = np.where((is_whole | is_solved)[:, None], found, np.nan)
        pixels = coordinates @ self.matrix[:2, :2].T + self.matrix[:2, 2]
        status = np.where(np.isnan(pixels[:, 0]), PointStatus.NO_PROJECTION, PointStatus.OK).astype(np.intp)
        return pixels, status

    def ray(self, pixels: Array) -> tuple[Array, Integers]:
        coordinates = np.linalg.solve(self.matrix[:2, :2], (pixels - self.matrix[:2, 2]).T).T
        directions = np.full((len(pixels), 3), np.nan)
        inside = ((coordinates >= 0) & (coordinates <= 1)).all(axis=1)
        directions[inside] = self._direction(coordinates[inside])
        status = np.where(np.isnan(directions[:, 0]), PointStatus.NO_PROJECTION, PointStatus.OK).astype(np.intp)
        return directions, status

    def transformed(self, matrix: Array) -> TextureModel:
        return replace(self, matrix=matrix @ self.matrix)

    def _direction(self, coordinates: Array) -> Array:
        values, is_whole = _bilinear(self.directions, coordinates, self.directions[:, :, 2] > -0.9999)
        length = np.linalg.norm(values, axis=1)
        is_whole &= length > 0
        return np.where(is_whole[:, None], values / np.where(length > 0, length, 1)[:, None], np.nan)

    def _refined(self, start: Array, unit: Array) -> tuple[Array, Booleans]:
        """Newton's method on the components of the direction across `unit`.

        Returns the coordinates, which are `start` where it does not converge, and True where it does.
        """
        across, along = _basis(unit)
        texel = 1.0 / np.array([self.directions.shape[1], self.directions.shape[0]])
        coordinates, step = start.copy(), 1e-3 * texel
        for _ in range(30):
            residual = self._across(coordinates, across, along)
            columns = [
                (self._across(coordinates + h, across, along) - self._across(coordinates - h, across, along))
                / (2 * h.sum())
                for h in (np.array([step[0], 0]), np.array([0, step[1]]))
            ]
            determinant = columns[0][:, 0] * columns[1][:, 1] - columns[1][:, 0] * columns[0][:, 1]
            with np.errstate(invalid="ignore", divide="ignore"):
                change = (
                    np.column_stack(
                        [
                            columns[1][:, 1] * residual[:, 0] - columns[1][:, 0] * residual[:, 1],
                            columns[0][:, 0] * residual[:, 1] - columns[0][:, 1] * residual[:, 0],
                        ]
                    )
                    / (determinant[:, None])
                )
            # A step of more than some texels leaves the cell for which the slopes are right.
            coordinates = coordinates - np.clip(change, -4 * texel, 4 * texel)
        with np.errstate(invalid="ignore"):
            is_solved = np.abs(self._across(coordinates, across, along)).max(axis=1) < 1e-9
            is_solved &= np.sum(self._direction(coordinates) * unit, axis=1) > 0
        return np.where(is_solved[:, None], coordinates, start), is_solved

    def _across(self, coordinates: Array, across: Array, along: Array) -> Array:
        direction = self._direction(coordinates)
        return np.stack([np.sum(direction * across, axis=1), np.sum(direction * along, axis=1)], axis=1)


def octahedral_directions(height: int, width: int | None = None) -> Array:
    """Returns the unit directions of the texels of a texture of positions, row by row. width: None: the height."""
    width = height if width is None else width
    v, u = np.meshgrid((np.arange(height) + 0.5) / height, (np.arange(width) + 0.5) / width, indexing="ij")
    return _from_octahedral(np.column_stack([u.ravel(), v.ravel()]) * 2 - 1)


def _bilinear(texture: Array, coordinates: Array, is_set: Booleans) -> tuple[Array, Booleans]:
    """Returns the means of the set texels about coordinates from 0 to 1, and True where all four are set.

    Weights are bilinear; beyond the centres of the outermost texels values are extrapolated.
    """
    height, width = texture.shape[:2]
    position = np.nan_to_num(coordinates) * [width, height] - 0.5
    cell = np.clip(np.floor(position), 0, [width - 2, height - 2]).astype(int)
    share = position - cell
    values = np.zeros((len(coordinates), texture.shape[2]))
    total = np.zeros(len(coordinates))
    whole: Booleans = np.logical_and.reduce(np.isfinite(coordinates), axis=1)
    for row in (0, 1):
        for column in (0, 1):
            x, y = cell[:, 0] + column, cell[:, 1] + row
            weight = np.where(column, share[:, 0], 1 - share[:, 0]) * np.where(row, share[:, 1], 1 - share[:, 1])
            weight = np.where(is_set[y, x], weight, 0.0)
            total += weight
            values += weight[:, None] * texture[y, x]
            whole &= is_set[y, x]
    with np.errstate(invalid="ignore", divide="ignore"):
        return values / total[:, None], whole


def _basis(unit: Array) -> tuple[Array, Array]:
    """Returns two unit vectors across each direction."""
    helper = np.where(np.abs(unit[:, :1]) < 0.8, [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]])
    first = np.cross(unit, helper)
    first /= np.linalg.norm(first, axis=1)[:, None]
    return first, np.cross(unit, first)


def _to_octahedral(unit: Array) -> Array:
    """Returns octahedral coordinates in [-1, 1]^2 (Z. H. Cigolle et al., JCGT 3 (2014) 1), the axis in the middle."""
    x, y, z = (unit / np.abs(unit).sum(axis=1)[:, None]).T
    fold_x, fold_y = (1 - np.abs(y)) * np.where(x < 0, -1, 1), (1 - np.abs(x)) * np.where(y < 0, -1, 1)
    return np.column_stack([np.where(z < 0, fold_x, x), np.where(z < 0, fold_y, y)])


def _from_octahedral(coordinates: Array) -> Array:
    x, y = coordinates.T
    z = 1 - np.abs(x) - np.abs(y)
    fold_x, fold_y = (1 - np.abs(y)) * np.where(x < 0, -1, 1), (1 - np.abs(x)) * np.where(y < 0, -1, 1)
    directions = np.column_stack([np.where(z < 0, fold_x, x), np.where(z < 0, fold_y, y), z])
    unit: Array = directions / np.linalg.norm(directions, axis=1)[:, None]
    return unit
