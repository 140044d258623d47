"""
Trace rays through a lens in C++
================================

For C++ developers. ``realcam::optics`` and ``realcam::io`` are libraries without dependencies at run time. This page
compiles a program of thirty lines, and draws what it prints.
"""

# %%
# The program
# -----------
#
# It reads one of the bundled lenses, sends parallel rays along the axis and prints where they meet the film.
#
# .. literalinclude:: /examples/tutorials/trace_rays.cpp
#    :language: cpp
#
# Values such as ``LensSystem`` own memory and can be compared and copied. ``LensPath`` prepares one for rays of one
# wavelength and direction. Rays are traced in blocks of lanes; here a block is one ray. What is wrong with a ray is its
# status, and no exception.
#
# Compile it
# ----------
#
# ``./run setup`` leaves headers and libraries in ``build/dev``. A project of your own finds the installed libraries
# with CMake's ``find_package(realcam)``, as :doc:`realcam in a C++ project </docs/cpp>` says.

import os
import subprocess
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

build = Path("build/dev")
with tempfile.TemporaryDirectory() as folder:
    program = Path(folder) / "trace_rays"
    subprocess.run(
        [
            *(os.environ.get("CXX", "c++"), "-std=c++20", "-O1", f"-I{build / 'include'}", "-o", program),
            *("examples/tutorials/trace_rays.cpp", build / "librealcam_lens_io.a", build / "librealcam_optics.a"),
        ],
        check=True,
    )
    text = subprocess.run([program, "tessar-50mm"], check=True, capture_output=True, text=True).stdout
points_mm = np.array([line.split() for line in text.splitlines()], dtype=float)
print(f"{len(points_mm)} rays pass; their RMS radius is {1000 * np.sqrt(np.mean(np.sum(points_mm**2, axis=1))):.2f} um")

# %%
# The spot
# --------
#
# The Tessar's spherical aberration makes a bright core and a wide rim.

figure, axes = plt.subplots(figsize=(4.6, 4.4), layout="constrained")
axes.plot(*(1000 * points_mm.T), ".", markersize=2)
axes.set_aspect("equal")
axes.set_xlabel("x / um")
axes.set_ylabel("y / um")
axes.set_title("Tessar 50 mm f/2.8 on its axis")

# %%
# Where to read on
# ----------------
#
# ``tests/consumer`` is a complete project with CMake. :doc:`The architecture </ARCHITECTURE>` says what the folders of
# the headers are, and :doc:`the decisions </docs/decisions/README>` why rays are traced in lanes.
