"""Memory per triangle of realcam and Mitsuba 3 after a first picture: of the process, or of the GPU.

    python benchmarks/memory.py [--device cpu|cuda] [--triangles 2000000] [--output memory.json]

Each program runs in a separate process, once with a small scene and once with a large one of the same kind (the spheres
of `realcam bench frame`, without normals, under a lamp); the memory per triangle is the difference over the additional
triangles. "resident": memory of the process after the picture; "peak": its maximum. On a GPU: memory that the driver
reports as used. The input arrays of the scenes (12 bytes per vertex and per triangle in both programs) are included.
Needs Mitsuba; on the CPU also DRJIT_LIBLLVM_PATH.
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
SMALL = 2  # spheres of the small scene


def render_picture(program: str, device: str, spheres: int) -> None:
    """Renders 64 x 64 pixels with one sample each, and prints the memory in use as JSON."""
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
    print(json.dumps(bytes_in_use(device)))


def bytes_in_use(device: str) -> dict[str, int]:
    """Memory of this process, or of the GPU, in bytes: "resident", and on the CPU also "peak"."""
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
    """Memory of a program in a child process."""
    completed = subprocess.run(
        [sys.executable, __file__, "--device", device, "--child", program, str(spheres)],
        env=os.environ | {"PYTHONPATH": os.pathsep.join([str(Path(__file__).parent), *sys.path])},
        capture_output=True,
        text=True,
        check=False,
    )
    if completed.returncode:
        raise SystemExit(f"{program}: {completed.stderr}")
    return json.loads(completed.stdout.splitlines()[-1])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--device", default="cpu", choices=["cpu", "cuda"])
    parser.add_argument("--triangles", type=int, default=2_000_000)
    parser.add_argument("--output", type=Path)
    parser.add_argument("--child", nargs=2, metavar=("PROGRAM", "SPHERES"), help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.child:
        render_picture(arguments.child[0], arguments.device, int(arguments.child[1]))
        return
    spheres = max(SMALL + 1, arguments.triangles // SPHERE_TRIANGLES)
    result = {}
    for program in PROGRAMS:
        small, large = (measured(program, arguments.device, count) for count in (SMALL, spheres))
        result[program] = {
            kind: round((large[kind] - small[kind]) / ((spheres - SMALL) * SPHERE_TRIANGLES), 1) for kind in small
        }
        print(f"{program}: bytes per triangle: {result[program]}")
    if arguments.output:
        arguments.output.write_text(
            json.dumps({"device": arguments.device, "triangles": spheres * SPHERE_TRIANGLES, "bytes": result}, indent=2)
            + "\n"
        )


if __name__ == "__main__":
    main()
