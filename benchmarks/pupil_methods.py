"""Efficiency of pupil sampling for every bundled lens: time of the fitted pupil outline over other methods.

    python benchmarks/pupil_methods.py [--device cpu] [--size 96] [--max-spp 64]

Prints, for each other method, its render time over that of the outline, to the error that the outline has with the most
samples. The methods are random points on the rear element (Kolb et al. 1995), stratified ones, the paraxial exit pupil,
and distributions learnt by each pixel. "never": the method loses light, so that its error remains larger.
"""

from __future__ import annotations

import argparse
import math
import warnings

import realcam as rc
from tile_samples import partly_sharp


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--size", type=int, default=96)
    parser.add_argument("--max-spp", type=int, default=64)
    parser.add_argument("--reference-spp", type=int, default=2048)
    arguments = parser.parse_args()
    warnings.simplefilter("ignore", UserWarning)
    for number, name in enumerate(rc.lens_names()):
        lens = rc.Lens.load(name)
        distance = 1.5 * max(0.3, 15 * abs(lens.first_order().effective_focal_length_mm) / 1000)
        scene, camera = partly_sharp(name, distance, 6.0)
        cost = rc.accuracy_cost(
            scene,
            camera,
            device=arguments.device,
            size=arguments.size,
            max_spp=arguments.max_spp,
            reference_spp=arguments.reference_spp,
            effects=(),
            levels=False,
        )
        if number == 0:
            heads = [f"{level.name} ({level.samples_per_second / 1e6:.2g} M/s)" for level in cost.samplings[:-1]]
            print("| lens | " + " | ".join(heads) + " |\n|---" + "|---" * len(heads) + "|")
        ours = cost.samplings[-1]
        goal = ours.pictures[-1].rmse
        ratios = {level.name: level.seconds_to(goal) / ours.seconds_to(goal) for level in cost.samplings[:-1]}
        cells = ["never" if math.isinf(ratio) else f"{ratio:.2f}" for ratio in ratios.values()]
        impossible = f" (not {', '.join(cost.impossible)})" if cost.impossible else ""
        print(f"| {name}{impossible} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
