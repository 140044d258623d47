#!/usr/bin/env python3
"""Write tests/truth/peer_rays.json.gz: first-order data and rays of random and bundled lenses by Optiland and
ray-optics.

    pip install -e '.[dev,truth]'
    python tools/make_peer_rays.py

The tests compare realcam with that file, and with the programs themselves where they are installed.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))


from tests.centred_lenses import CENTRED
from tests.truth import backends, peer_file, peers, random_lenses, random_rays

RANDOM_LENSES = range(1, 201)  # seeds of the random lenses
RANDOM_RAYS = 20  # rays through each random lens
BUNDLED_RAYS = 40  # rays through each bundled lens


def main() -> None:
    versions = {name: peers.version(name) for name in peers.PEERS}
    absent = [name for name, version in versions.items() if version is None]
    if absent:
        sys.exit(f"{' and '.join(absent)} not installed: pip install -e '.[truth]'")
    inputs = []
    for seed in RANDOM_LENSES:
        random = random_lenses.random_lens(seed)
        rng = np.random.default_rng([seed, 1])
        lens = random.prescription
        inputs.append((lens, random_rays.from_the_scene(lens, random.half_field_deg, RANDOM_RAYS, rng)))
    for name in CENTRED:
        rays = random_rays.from_the_film(name, BUNDLED_RAYS, np.random.default_rng(1))
        inputs.append((backends.of_bundled_lens(name), rays))
    cases = []
    for lens, (origins, directions) in inputs:
        rays = random_rays.unit(origins, directions)
        opinions = {
            name: peer_file.Opinion(peer.first_order(lens), peer.trace(lens, rays))
            for name, peer in peers.PEERS.items()
        }
        cases.append(peer_file.case_to_json(lens, origins, directions, opinions))
    peer_file.write(versions, cases)
    print(f"{peer_file.FILE}: {len(cases)} lenses, {peer_file.FILE.stat().st_size} bytes")


if __name__ == "__main__":
    main()
