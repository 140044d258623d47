"""Results of the peers, stored in a file: the peers and their dependencies are 2 GB, too much for every test run.

tools/make_peer_rays.py writes it. JSON: a list of lenses, each with its surfaces, its rays (origin and direction as
stored, not normalised), and each peer's first-order data and rays: position, direction and optical path of a ray that
passes, otherwise its fate and the surface at which it ended.
"""

from __future__ import annotations

import gzip
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from . import prescription, random_rays
from .prescription import Prescription, Rays, Traced

FILE = Path(__file__).with_name("peer_rays.json.gz")

# Half a unit of the last decimal is far below what is tested: 1e-9 mm and 1e-11.
LENGTH_DECIMALS, DIRECTION_DECIMALS = 12, 14


@dataclass(frozen=True)
class Opinion:
    """One peer's about one lens."""

    first_order: dict[str, float]
    rays: Traced


@dataclass(frozen=True)
class Case:
    lens: Prescription
    rays: Rays
    opinions: dict[str, Opinion]

    @property
    def is_random(self) -> bool:
        return self.lens.name.startswith("random-")


def _ray_to_json(traced: Traced, i: int) -> list:
    if not traced.ok[i]:
        return [str(traced.fates[i]), int(traced.ended_at[i])]
    lengths = np.append(traced.positions[i], traced.optical_paths[i]).round(LENGTH_DECIMALS).tolist()
    return [*lengths[:3], *traced.directions[i].round(DIRECTION_DECIMALS).tolist(), lengths[3]]


def _rays_from_json(rays: list[list], surfaces: int) -> Traced:
    out = Traced.none_yet(len(rays), surfaces)
    for i, ray in enumerate(rays):
        if len(ray) == 2:
            out.fates[i], out.ended_at[i] = ray
        else:
            out.positions[i], out.directions[i], out.optical_paths[i] = ray[:3], ray[3:6], ray[6]
    return out


def case_to_json(lens: Prescription, origins: np.ndarray, directions: np.ndarray, said: dict[str, Opinion]) -> dict:
    return {
        **prescription.to_json(lens),
        "rays": np.concatenate([origins, directions], axis=1).tolist(),
        "opinions": {
            name: {
                "first_order": opinion.first_order,
                "rays": [_ray_to_json(opinion.rays, i) for i in range(len(origins))],
            }
            for name, opinion in said.items()
        },
    }


def write(versions: dict[str, str], cases: list[dict]) -> None:
    text = json.dumps({"versions": versions, "lenses": cases}, separators=(",", ":"))
    # Without a time in the header, the same figures make the same file.
    FILE.write_bytes(gzip.compress(text.encode(), compresslevel=9, mtime=0))


def read() -> tuple[dict[str, str], list[Case]]:
    """The peers' versions, and the lenses."""
    content = json.loads(gzip.decompress(FILE.read_bytes()))
    cases = []
    for plain in content["lenses"]:
        lens, rays = prescription.from_json(plain), np.array(plain["rays"])
        opinions = {
            name: Opinion(said["first_order"], _rays_from_json(said["rays"], len(lens.rows)))
            for name, said in plain["opinions"].items()
        }
        cases.append(Case(lens, random_rays.unit(rays[:, :3], rays[:, 3:]), opinions))
    return content["versions"], cases
