"""Writes tests/truth/tolerance_peer.json.gz: MTF of perturbed copies of a lens, computed by Optiland.

python tools/make_tolerance_peer.py     needs Optiland 0.6 (github.com/optiland/optiland)

Optiland's tolerancing applies the errors and refocuses by minimising the RMS spots. Its geometric MTF, scaled by the
diffraction limit, is recorded at three fields.
"""

from __future__ import annotations

import gzip
import json
from pathlib import Path

import numpy as np

TARGET = Path(__file__).resolve().parent.parent / "tests/truth/tolerance_peer.json.gz"
# A Cooke triplet of f/5 without rims: radius, thickness, index, mm (W. J. Smith, "Modern Lens Design", scaled).
ROWS = [
    (22.01359, 3.25896, 1.62041),
    (-435.76044, 6.00755, 1.0),
    (-22.21328, 0.99997, 1.61659),
    (20.29192, 4.75041, 1.0),
    (79.6836, 2.95208, 1.62041),
    (-18.39533, 42.20778, 1.0),
]
STOP = 3  # index of the surface with the stop
# Entrance-pupil diameter, fields, wavelength, and frequency of the MTF in periods per mm.
APERTURE_MM, FIELDS_DEG, WAVELENGTH_UM, FREQUENCY = 10.0, (0.0, 7.0, 14.0), 0.5875618, 20.0
COPIES, SEED = 60, 5
# Limits of the errors.
RADIUS_PERCENT, THICKNESS_MM, INDEX, TILT_ARCMIN = 0.2, 0.05, 5e-4, 3.0


def errors() -> list[tuple[str, int, float]]:
    """Returns kind, surface (from 0) and limit of each error, in mm or degrees."""
    limits = []
    for k, (radius, _, index) in enumerate(ROWS):
        limits.append(("radius", k, abs(radius) * RADIUS_PERCENT / 100))
        if k + 1 < len(ROWS):
            limits.append(("thickness", k, THICKNESS_MM))
        if index > 1:
            limits.append(("index", k, INDEX))
        limits += [("surface_tilt_x", k, TILT_ARCMIN / 60), ("surface_tilt_y", k, TILT_ARCMIN / 60)]
    return limits


def optic():
    """The nominal lens in Optiland."""
    from optiland.materials import IdealMaterial
    from optiland.optic import Optic

    lens = Optic()
    lens.surfaces.add(index=0, radius=np.inf, thickness=np.inf)
    for k, (radius, thickness, index) in enumerate(ROWS):
        lens.surfaces.add(
            index=k + 1, radius=radius, thickness=thickness, material=IdealMaterial(index), is_stop=k == STOP
        )
    lens.surfaces.add(index=len(ROWS) + 1)
    lens.set_aperture("EPD", APERTURE_MM)
    lens.fields.set_type("angle")
    for field in FIELDS_DEG:
        lens.fields.add(y=field)
    lens.wavelengths.add(value=WAVELENGTH_UM, is_primary=True)
    return lens


def mtfs(lens) -> list[list[float]]:
    """Tangential and sagittal MTF at each field."""
    from optiland.mtf import GeometricMTF

    result = GeometricMTF(lens, num_rays=64, num_points=401, max_freq=2 * FREQUENCY, scale=True)
    index = int(np.argmin(np.abs(np.asarray(result.freq) - FREQUENCY)))
    return [[float(tangential[index]), float(sagittal[index])] for tangential, sagittal in result.mtf]


def main() -> None:
    from optiland.tolerancing.core import Tolerancing
    from optiland.tolerancing.perturbation import BaseSampler

    class Listed(BaseSampler):
        """Sampler that returns given values one after the other."""

        def __init__(self, values):
            self.values = iter(values)

        def sample(self):
            return float(next(self.values))

    kinds = errors()
    sizes = np.random.default_rng(SEED).uniform(-1, 1, (COPIES, len(kinds))) * [limit for _, _, limit in kinds]
    lens = optic()
    study = Tolerancing(lens)
    for number in range(len(FIELDS_DEG)):
        study.add_operand(
            "rms_spot_size",
            {
                "optic": lens,
                "surface_number": -1,
                "Hx": 0,
                "Hy": FIELDS_DEG[number] / FIELDS_DEG[-1],
                "num_rays": 12,
                "wavelength": WAVELENGTH_UM,
                "distribution": "hexapolar",
            },
            target=0,
        )
    for column, (kind, k, _) in enumerate(kinds):
        values = sizes[:, column]
        if kind == "radius":
            study.add_perturbation("radius", Listed(ROWS[k][0] + values), surface_number=k + 1)
        elif kind == "thickness":
            study.add_perturbation("thickness", Listed(ROWS[k][1] + values), surface_number=k + 1)
        elif kind == "index":
            study.add_perturbation("index", Listed(ROWS[k][2] + values), surface_number=k + 1, wavelength=WAVELENGTH_UM)
        else:
            study.add_perturbation("tilt", Listed(np.deg2rad(values)), surface_number=k + 1, axis=kind[-1])
    study.add_compensator("thickness", surface_number=len(ROWS))
    copies_mtf = []
    for _ in range(COPIES):
        study.reset()
        for perturbation in study.perturbations:
            perturbation.apply()
        study.apply_compensators()
        copies_mtf.append(mtfs(lens))
    study.reset()
    content = {
        "rows": ROWS,
        "stop": STOP,
        "aperture_mm": APERTURE_MM,
        "fields_deg": FIELDS_DEG,
        "wavelength_nm": 1000 * WAVELENGTH_UM,
        "frequency_per_mm": FREQUENCY,
        "errors": [[kind, k] for kind, k, _ in kinds],
        "sizes": sizes.tolist(),
        "mtf": copies_mtf,
    }
    with gzip.GzipFile(TARGET, "wb", mtime=0) as file:
        file.write(json.dumps(content).encode())


if __name__ == "__main__":
    main()
