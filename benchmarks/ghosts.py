"""How long ghosts take to be free of noise: all 45 of a bare double Gauss, one lamp, noise below one 8-bit code.

    python benchmarks/ghosts.py [--device cpu] [--threads 1]

640 x 640 pixels of black with a far lamp in the frame. The exposure is such that the brightest thousandth of the pixels
begins at a quarter of white. Noise is the root mean square, over pixels and channels, of the difference in sRGB's codes
to a picture of 64 times the samples at least. The time is that of the samples, without that of a picture that has no
ghosts.
"""

from __future__ import annotations

import argparse
import time
import warnings

import numpy as np
import realcam as rc
from machine import machine
from srgb import srgb_codes

SIDE = 640


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--threads", type=int, default=1, help="of the CPU")
    words = parser.parse_args()
    warnings.simplefilter("ignore", UserWarning)
    threads = words.threads if words.device == "cpu" else 0
    triangle = np.array([[0.0, 0.0, 1e5], [1.0, 0.0, 1e5], [0.0, 1.0, 1e5]])
    scene = rc.Scene.from_arrays(triangle, [[0, 1, 2]]).with_point_light((1500.0, 1000.0, -10000.0), (1e8, 1e8, 1e8))
    lens = rc.Lens.load("double-gauss-50mm").with_coating("bare")
    camera = rc.Camera(lens, film=rc.Film(24, 24, (SIDE, SIDE)), exposure_time_s=1)
    taking = {"device": words.device, "threads": threads}
    reference = rc.render(scene, camera, spp=8192 if words.device != "cpu" else 2048, effects="ghosts=0", **taking)
    white = 4 * float(np.quantile(reference.pixels.max(axis=2), 0.999))
    expected = srgb_codes(reference.pixels.astype(np.float64) / white)
    where = machine()
    print(f"{where['processor']}, {words.device}; realcam {where['commit']}; {where['date']}.", end=" ")
    print("Made by benchmarks/ghosts.py.\n")
    print("| samples per pixel | ms of ghosts | noise, codes |")
    print("|---|---|---|")
    sessions = [rc.Session(scene, camera, **taking, effects=effects) for effects in ("ghosts=0", None)]
    for session in sessions:
        session.add(1)
    for spp in (1, 2, 4, 8, 16, 32, 64, 128):
        least = []
        for session in sessions:
            times = []
            for _ in range(5):
                start = time.perf_counter()
                session.add(spp)
                times.append(time.perf_counter() - start)
            least.append(min(times))
        picture = rc.render(scene, camera, spp=spp, effects="ghosts=0", seed=1, **taking)
        noise = float(np.sqrt(np.mean((srgb_codes(picture.pixels.astype(np.float64) / white) - expected) ** 2)))
        print(f"| {spp} | {1e3 * (least[0] - least[1]):.2f} | {noise:.2f} |", flush=True)
        if noise < 1:
            break


if __name__ == "__main__":
    main()
