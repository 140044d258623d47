"""Render time of a real lens in Mitsuba 3: the sensor `realcam` against Mitsuba's own thin lens, on one scene.

    pip install 'realcam[mitsuba]'
    DRJIT_LIBLLVM_PATH=/usr/lib/x86_64-linux-gnu/libLLVM-19.so python benchmarks/mitsuba_sensor.py [LENS ...]

The scene is Mitsuba's Cornell box with its integrator `path`. Both sensors alternate with compiled
kernels, and the smallest CPU time of all rounds counts, over all threads.
"""

from __future__ import annotations

import argparse
import time

import drjit as dr
import mitsuba as mi
import realcam as rc

PIXELS, SPP, ROUNDS = 512, 32, 5


def sensor(kind: str, lens: rc.Lens) -> dict[str, object]:
    """Settings of a sensor at the distance at which the Cornell box fills the picture.

    kind: "realcam" or "thinlens"; the thin lens has the focal length and the f-number of the real one.
    """
    data, side_mm = lens.first_order(), 0.62 * min(lens.film_mm)
    distance_m = 2.3 * data.effective_focal_length_mm / side_mm
    settings: dict[str, object] = {
        "to_world": mi.ScalarTransform4f().look_at(origin=[0, 0, 1 + distance_m], target=[0, 0, 0], up=[0, 1, 0]),
        "film": {"type": "hdrfilm", "width": PIXELS, "height": PIXELS, "rfilter": {"type": "box"}},
        "sampler": {"type": "independent"},
    }
    if kind == "realcam":
        return settings | {
            "type": "realcam",
            "lens": lens.name,
            "focus_distance_m": distance_m,
            "film_width_mm": side_mm,
        }
    return settings | {
        "type": "thinlens",
        "fov": 2 * 57.29578 * 0.5 * side_mm / data.effective_focal_length_mm,
        "aperture_radius": 0.0005 * data.entrance_pupil_diameter_mm,
        "focus_distance": distance_m,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lenses", nargs="*", default=["double-gauss-50mm", "sonnar-180mm", "phone-4mm-three-elements"])
    parser.add_argument("--variant", default="llvm_ad_rgb")
    arguments = parser.parse_args()
    mi.set_variant(arguments.variant)
    import realcam.mitsuba  # noqa: F401

    scene = mi.load_dict({key: value for key, value in mi.cornell_box().items() if key != "sensor"})
    for name in arguments.lenses:
        lens = rc.Lens.load(name)
        sensors = {kind: mi.load_dict(sensor(kind, lens)) for kind in ("thinlens", "realcam")}
        seconds: dict[str, list[float]] = {kind: [] for kind in sensors}
        for seed in range(ROUNDS + 1):
            for kind, loaded in sensors.items():
                cpu, wall = time.process_time(), time.perf_counter()
                dr.eval(mi.render(scene, sensor=loaded, spp=SPP, seed=seed))
                dr.sync_thread()
                cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
                if seed:  # the first compiles
                    seconds[kind].append(wall if arguments.variant.startswith("cuda") else cpu)
        thin, real = (min(seconds[kind]) for kind in ("thinlens", "realcam"))
        print(f"{name:28s} thin lens {thin:.3f} s, realcam {real:.3f} s: {real / thin:.2f} times", flush=True)


if __name__ == "__main__":
    main()
