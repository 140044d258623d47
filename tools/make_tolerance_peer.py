"""Writes tests/truth/tolerance_peer.json.gz: copies of a lens with the same errors as Optiland judges them.

python tools/make_tolerance_peer.py     needs Optiland 0.6 (github.com/optiland/optiland), and realcam for the errors

Optiland's tolerancing applies the errors, refocuses by its optimiser on the RMS spots, and its geometric MTF, which it
scales by the limit of diffraction, is taken at three fields.
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
STOP = 3  # in front of this row's surface, at no distance
APERTURE_MM, FIELDS_DEG, WAVELENGTH_UM, FREQUENCY = 10.0, (0.0, 7.0, 14.0), 0.5875618, 20.0
COPIES, SEED = 60, 5
RADIUS_PERCENT, THICKNESS_MM, INDEX, TILT_ARCMIN = 0.2, 0.05, 5e-4, 3.0


def errors() -> list[tuple[str, int, float]]:
    """Kind, surface and limit."""
    found = []
    for k, (radius, _, index) in enumerate(ROWS):
        found.append(("radius", k, abs(radius) * RADIUS_PERCENT / 100))
        if k + 1 < len(ROWS):
            found.append(("thickness", k, THICKNESS_MM))
        if index > 1:
            found.append(("index", k, INDEX))
        found += [("surface_tilt_x", k, TILT_ARCMIN / 60), ("surface_tilt_y", k, TILT_ARCMIN / 60)]
    return found


def optic():
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
    from optiland.mtf import GeometricMTF

    found = GeometricMTF(lens, num_rays=64, num_points=401, max_freq=2 * FREQUENCY, scale=True)
    at = int(np.argmin(np.abs(np.asarray(found.freq) - FREQUENCY)))
    return [[float(tangential[at]), float(sagittal[at])] for tangential, sagittal in found.mtf]


def main() -> None:
    from optiland.tolerancing.core import Tolerancing
    from optiland.tolerancing.perturbation import BaseSampler

    class Listed(BaseSampler):
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
    found = []
    for _ in range(COPIES):
        study.reset()
        for perturbation in study.perturbations:
            perturbation.apply()
        study.apply_compensators()
        found.append(mtfs(lens))
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
        "mtf": found,
    }
    with gzip.GzipFile(TARGET, "wb", mtime=0) as file:
        file.write(json.dumps(content).encode())


if __name__ == "__main__":
    main()
