"""Time until ghosts are free of visible noise: all 45 ghosts of an uncoated double Gauss and one lamp.

    python benchmarks/ghosts.py [--device cpu] [--threads 1]

A black picture of 640 x 640 pixels with a distant lamp in the field of view. White is four times the 99.9th percentile
of the pixels. Noise is the root mean square difference, over pixels and channels, in 8-bit sRGB codes from a picture
with at least 64 times as many samples; the run ends when it is below one code. The time is that of the samples, minus
that of the same picture without ghosts.
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
    parser.add_argument("--threads", type=int, default=1, help="number of threads on the CPU")
    arguments = parser.parse_args()
    warnings.simplefilter("ignore", UserWarning)
    threads = arguments.threads if arguments.device == "cpu" else 0
    triangle = np.array([[0.0, 0.0, 1e5], [1.0, 0.0, 1e5], [0.0, 1.0, 1e5]])
    scene = rc.Scene.from_arrays(triangle, [[0, 1, 2]]).with_point_light((1500.0, 1000.0, -10000.0), (1e8, 1e8, 1e8))
    lens = rc.Lens.load("double-gauss-50mm").with_coating("bare")
    camera = rc.Camera(lens, film=rc.Film(24, 24, (SIDE, SIDE)), exposure_time_s=1)
    options = {"device": arguments.device, "threads": threads}
    reference = rc.render(scene, camera, spp=8192 if arguments.device != "cpu" else 2048, effects="ghosts=0", **options)
    white = 4 * float(np.quantile(reference.pixels.max(axis=2), 0.999))
    expected = srgb_codes(reference.pixels.astype(np.float64) / white)
    where = machine()
    print(f"{where['processor']}, {arguments.device}; realcam {where['commit']}; {where['date']}.", end=" ")
    print("Made by benchmarks/ghosts.py.\n")
    print("| samples per pixel | ms of ghosts | noise, codes |")
    print("|---|---|---|")
    sessions = [rc.Session(scene, camera, **options, effects=effects) for effects in ("ghosts=0", None)]
    for session in sessions:
        session.add(1)
    for spp in (1, 2, 4, 8, 16, 32, 64, 128):
        shortest = []
        for session in sessions:
            times = []
            for _ in range(5):
                start = time.perf_counter()
                session.add(spp)
                times.append(time.perf_counter() - start)
            shortest.append(min(times))
        picture = rc.render(scene, camera, spp=spp, effects="ghosts=0", seed=1, **options)
        noise = float(np.sqrt(np.mean((srgb_codes(picture.pixels.astype(np.float64) / white) - expected) ** 2)))
        print(f"| {spp} | {1e3 * (shortest[0] - shortest[1]):.2f} | {noise:.2f} |", flush=True)
        if noise < 1:
            break


if __name__ == "__main__":
    main()
