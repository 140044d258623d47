#!/usr/bin/env python3
"""Write tests/truth/ray_optics_analysis.json.gz: aberrations of the bundled lenses by ray-optics.

pip install -e '.[dev,truth]'
python tools/make_ray_optics_analysis.py
"""

from __future__ import annotations

import sys
from importlib import metadata
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import realcam as rc

from tests.centred_lenses import CENTRED
from tests.truth import backends, ray_optics_analysis


def main() -> None:
    opinions = {}
    for name in CENTRED:
        if name in ray_optics_analysis.ABSENT:
            continue
        lens = rc.Lens.load(name)
        bundles = rc.analysis.Bundles(lens, 1e-3 * ray_optics_analysis.OBJECT_MM)
        field = round(float(rc.analysis.field_angles_deg(lens, [ray_optics_analysis.FIELD], bundles)[0]), 1)
        prescription = backends.of_bundled_lens(name)
        opinions[name] = field, ray_optics_analysis.analysed(prescription, lens.film_distance_mm, field)
        print(f"{name}, {field} deg")
    ray_optics_analysis.write(metadata.version("rayoptics"), opinions)


if __name__ == "__main__":
    main()
