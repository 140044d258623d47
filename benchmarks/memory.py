"""Memory per triangle of realcam and Mitsuba 3, after a first picture: in the process, or on the GPU.

    python benchmarks/memory.py [--device cpu|cuda] [--triangles 2000000] [--output memory.json]

Each program runs in a process of its own, once with a small scene and once with a large one of the same kind (the
spheres of `realcam bench frame`, without normals, under a lamp); the difference over the triangles is what a triangle
costs. Counted is what the process holds when the picture is done ("resident"), and the most that it ever held ("peak").
On a GPU: what the driver says that the process holds there. The arrays from which the scenes are made (12 bytes a
vertex and 12 a triangle in both) are part of it. Needs Mitsuba; on the CPU also DRJIT_LIBLLVM_PATH.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import resource
import subprocess
import sys
from pathlib import Path

PROGRAMS = ("realcam", "mitsuba")
SPHERE_TRIANGLES = 3968  # of one sphere of frame_scene_arrays, with 32 rows
SMALL = 2


def take_picture(program: str, device: str, spheres: int) -> None:
    """A picture of 64 x 64 pixels with one sample each."""
    import realcam as rc
    from frame_scene import frame_camera, frame_scene

    camera = frame_camera("pinhole", rc.Film(24, 24, (64, 64)))
    if program == "realcam":
        scene = frame_scene(spheres, boxes=0, sky=0.0)
        rc.render(scene, camera, effects=(), spp=1, max_bounces=0, device=device)
    else:
        import mitsuba as mi
        import numpy as np

        mi.set_variant("llvm_ad_rgb" if device == "cpu" else "cuda_ad_rgb")
        import mitsuba_scene

        scene = mitsuba_scene.frame_scene(spheres, boxes=0)
        sensor = mi.load_dict(mitsuba_scene.sensor("perspective", camera))
        integrator = mi.load_dict({"type": "direct", "emitter_samples": 1, "bsdf_samples": 0})
        np.array(mi.render(scene, sensor=sensor, integrator=integrator, spp=1))
    print(json.dumps(bytes_held(device)))


def bytes_held(device: str) -> dict[str, int]:
    if device != "cpu":
        listed = subprocess.run(
            ["nvidia-smi", "--query-gpu=memory.used", "--format=csv,noheader,nounits"],
            capture_output=True,
            text=True,
            check=True,
        )
        return {"resident": int(listed.stdout.split()[0]) << 20}
    status = Path("/proc/self/status").read_text()
    resident = re.search(r"VmRSS:\s+(\d+) kB", status)
    assert resident
    return {
        "resident": int(resident[1]) << 10,
        "peak": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss << 10,
    }


def measured(program: str, device: str, spheres: int) -> dict[str, int]:
    done = subprocess.run(
        [sys.executable, __file__, "--device", device, "--take", program, str(spheres)],
        env=os.environ | {"PYTHONPATH": os.pathsep.join([str(Path(__file__).parent), *sys.path])},
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode:
        raise SystemExit(f"{program}: {done.stderr}")
    return json.loads(done.stdout.splitlines()[-1])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--device", default="cpu", choices=["cpu", "cuda"])
    parser.add_argument("--triangles", type=int, default=2_000_000)
    parser.add_argument("--output", type=Path)
    parser.add_argument("--take", nargs=2, metavar=("PROGRAM", "SPHERES"), help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.take:
        take_picture(arguments.take[0], arguments.device, int(arguments.take[1]))
        return
    spheres = max(SMALL + 1, arguments.triangles // SPHERE_TRIANGLES)
    result = {}
    for program in PROGRAMS:
        small, large = (measured(program, arguments.device, count) for count in (SMALL, spheres))
        result[program] = {
            what: round((large[what] - small[what]) / ((spheres - SMALL) * SPHERE_TRIANGLES), 1) for what in small
        }
        print(f"{program}: bytes a triangle: {result[program]}")
    if arguments.output:
        arguments.output.write_text(
            json.dumps({"device": arguments.device, "triangles": spheres * SPHERE_TRIANGLES, "bytes": result}, indent=2)
            + "\n"
        )


if __name__ == "__main__":
    main()
