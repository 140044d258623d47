"""A lens as a plain table, in no program's own types, and rays as plain arrays: what all the programs are given."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, field

import numpy as np


@dataclass(frozen=True)
class Row:
    """A surface and what lies behind it. Lengths in mm; a radius is positive where its centre lies on the film's side.

    `index` is that of the medium behind, for mirrors, stops and apertures too.
    """

    type: str  # "refracting", "mirror", "stop" or "aperture"
    semi_diameter: float
    radius: float = math.inf
    thickness: float = 0.0
    index: float = 1.0
    conic: float = 0.0
    coefficients: dict[int, float] = field(default_factory=dict)  # power of the radial distance: mm^(1 - power)
    inner_semi_diameter: float = 0.0

    @property
    def curvature(self) -> float:
        return 1 / self.radius


@dataclass(frozen=True)
class Prescription:
    """Air lies in front of the first surface; light travels to +z, and back behind an odd number of mirrors."""

    name: str
    rows: tuple[Row, ...]

    @property
    def stop(self) -> int:
        return next(i for i, row in enumerate(self.rows) if row.type == "stop")

    @property
    def vertices(self) -> list[float]:
        z = [0.0]
        for row in self.rows[:-1]:
            z.append(z[-1] + row.thickness)
        return z

    @property
    def is_aspheric(self) -> bool:
        return any(row.coefficients for row in self.rows)


@dataclass(frozen=True)
class Rays:
    """Origins (N, 3) in mm, from the first vertex; unit directions (N, 3)."""

    origins: np.ndarray
    directions: np.ndarray

    def __len__(self) -> int:
        return len(self.origins)

    def __getitem__(self, chosen: np.ndarray | list[int]) -> Rays:
        return Rays(self.origins[chosen], self.directions[chosen])


@dataclass(frozen=True)
class Traced:
    """Rays behind the last surface. Optical paths count from the origins to the last surface.

    `fates` are "ok", "missed", "vignetted" or "total internal reflection"; figures of a ray that is not ok are nan.
    """

    positions: np.ndarray
    directions: np.ndarray
    optical_paths: np.ndarray
    fates: np.ndarray
    ended_at: np.ndarray  # surface, from 0; the last one of a ray that is ok

    @property
    def ok(self) -> np.ndarray:
        return self.fates == "ok"

    def __getitem__(self, chosen: np.ndarray | list[int]) -> Traced:
        return Traced(
            self.positions[chosen],
            self.directions[chosen],
            self.optical_paths[chosen],
            self.fates[chosen],
            self.ended_at[chosen],
        )

    @classmethod
    def none_yet(cls, count: int, surfaces: int) -> Traced:
        """For a program to write its rays into."""
        nothing = np.full((count, 7), np.nan)
        fates = np.full(count, "ok", dtype="<U26")
        return cls(nothing[:, :3], nothing[:, 3:6], nothing[:, 6], fates, np.full(count, surfaces - 1))


DEFAULTS = asdict(Row("", 0.0))


def to_json(prescription: Prescription) -> dict:
    rows = [{key: v for key, v in asdict(row).items() if v != DEFAULTS[key]} for row in prescription.rows]
    return {"name": prescription.name, "surfaces": rows}


def from_json(plain: dict) -> Prescription:
    rows = []
    for row in plain["surfaces"]:
        powers = {int(power): value for power, value in row.get("coefficients", {}).items()}
        rows.append(Row(**{**row, "coefficients": powers}))
    return Prescription(plain["name"], tuple(rows))
