#!/usr/bin/env python3
"""Write tests/truth/free_rays.json.gz: rays through tilted, decentred and freeform surfaces by Optiland and ray-optics.

pip install -e '.[dev,truth]'
python tools/make_free_rays.py
"""

from __future__ import annotations

import gzip
import json
import sys
from importlib import metadata
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from tests.truth import free_lenses, free_peers

FILE = Path(__file__).resolve().parents[1] / "tests" / "truth" / "free_rays.json.gz"
RAYS = 24  # through each lens
HALF_WIDTH_MM, HALF_ANGLE_DEG = 6.0, 6.0  # ranges of the rays' origins and directions


def main() -> None:
    versions = {"Optiland": metadata.version("optiland"), "ray-optics": metadata.version("rayoptics")}
    cases = []
    for seed, (name, rows) in enumerate(free_lenses.all_lenses().items()):
        rays = free_lenses.rays(RAYS, HALF_WIDTH_MM, HALF_ANGLE_DEG, seed)
        traced_by = {peer: trace(rows, rays) for peer, trace in free_peers.PEERS.items()}
        cases.append(
            {
                "name": name,
                "rows": free_lenses.to_json(rows),
                "rays": rays.tolist(),
                "said": {peer: traced.round(13).tolist() for peer, traced in traced_by.items() if traced is not None},
            }
        )
    text = json.dumps({"versions": versions, "lenses": cases}, separators=(",", ":"))
    FILE.write_bytes(gzip.compress(text.encode(), compresslevel=9, mtime=0))
    print(f"{FILE}: {len(cases)} lenses, {FILE.stat().st_size} bytes")


if __name__ == "__main__":
    main()
