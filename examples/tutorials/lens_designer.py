"""
Draw, judge and improve a triplet
=================================

For lens designers and students of optics. This page draws a lens, finds which surface causes what, spoils a radius and
lets least squares repair it.
"""

# %%
# The lens
# --------
#
# A lens is its prescription: surfaces with radius, thickness, material and clear semi-diameter, all in mm. The Cooke
# triplet has three elements, and the stop between them.

import matplotlib.pyplot as plt
import realcam as rc
from realcam.drawing import draw_cross_section

lens = rc.Lens.load("cooke-triplet-50mm")
for index, surface in enumerate(lens.surfaces):
    print(index, surface)

# %%
# Light comes from the left. Each colour is one point far away; on the right is the film.

figure, axes = plt.subplots(figsize=(9, 4), layout="constrained")
section = draw_cross_section(lens, axes)

# %%
# First order
# -----------
#
# Rays close to the axis give focal length, f-number and pupils.

data = lens.first_order()
print(f"focal length {data.effective_focal_length_mm:.4f} mm, f/{data.f_number:.3f}")
print(f"back focal distance {data.back_focal_distance_mm:.4f} mm")

# %%
# Which surface does what
# -----------------------
#
# Seidel sums are the aberrations of third order, surface by surface. Large bars of opposite sign cancel each other;
# that is how a triplet works, and why it is sensitive.

figure, axes = plt.subplots(figsize=(9, 3.6), layout="constrained")
rc.analysis.plot_seidel_bars(rc.analysis.seidel_bars(lens), axes)

# %%
# Spoil it, and repair it
# -----------------------
#
# ``with_surface`` makes another lens with one number changed. The spot is the RMS radius of real rays on the film.

fields_deg = (0, 10, 18)


def spots_um(lens: rc.Lens) -> str:
    return ", ".join(f"{1000 * lens.spot(field).rms_radius_mm:.1f}" for field in fields_deg)


bent = lens.with_surface(1, radius_of_curvature_mm=0.9 * lens.surfaces[1].radius_of_curvature_mm)
print(f"as designed: {spots_um(lens)} um")
print(f"bent:        {spots_um(bent)} um")

# %%
# ``rc.optimised`` is a local search by least squares. It may change the radii of the last element here, and the film is
# where the axis is sharpest.

last = len(lens.surfaces) - 1
found = rc.optimised(
    bent,
    [rc.Variable.radius(0), rc.Variable.radius(last - 1), rc.Variable.radius(last)],
    rc.Targets(fields_deg=fields_deg, focal_length_mm=50),
)
print(f"repaired:    {spots_um(found.lens)} um")
print(f"focal length {found.lens.first_order().effective_focal_length_mm:.3f} mm")

# %%
# Contrast
# --------
#
# MTF is the contrast that is left of fine lines, here over the field of the picture, as designed and as repaired.

figure, columns = plt.subplots(1, 2, figsize=(10, 3.6), layout="constrained")
for axes, shown, title in zip(columns, (lens, found.lens), ("as designed", "repaired"), strict=True):
    rc.analysis.plot_mtf_over_field(rc.analysis.mtf_over_field(shown, [10, 20, 40]), axes)
    axes.set_title(title)

# %%
# ``found.lens.save("mine.toml")`` keeps it, and ``.zmx`` or ``.seq`` take it to another program
# (:doc:`lens files </docs/lens-files>`). ``rc.analysis`` has all other plots (:doc:`analysis </docs/analysis>`).
