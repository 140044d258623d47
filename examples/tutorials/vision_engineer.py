"""
Where a point lands, and what a camera model misses
===================================================

For vision engineers. A camera of vision programs is a matrix and some coefficients of distortion. This page compares
them with the rays of a real wide-angle lens, in pixels.
"""

# %%
# A camera and a board
# --------------------
#
# The camera stands 1 m before a board with squares of 0.2 m. Coordinates of the scene are in metres.

import matplotlib.pyplot as plt
import numpy as np
import realcam as rc

lens = rc.Lens.load("machine-vision-10mm").focused(1.1)
width_mm, height_mm = lens.film_mm
camera = rc.Camera(
    lens,
    film=rc.Film(width_mm, height_mm, (300, round(300 * height_mm / width_mm))),
    position=(0, 0, 1.1),
    look_at=(0, 0, 0),
)

half, square = 1.2, 0.2
corners = np.array([[-half, -half, 0], [half, -half, 0], [half, half, 0], [-half, half, 0]])
count = round(2 * half / square)
squares = 40 + 190 * (np.indices((count, count)).sum(axis=0) % 2)
texture = np.kron(squares, np.ones((32, 32)))[:, :, None].repeat(3, axis=2).astype(np.uint8)
board = rc.Scene.from_arrays(
    corners,
    [[0, 1, 2], [0, 2, 3]],
    uvs=[[0, 0], [1, 0], [1, 1], [0, 1]],
    materials=[rc.Material(diffuse=(0.8, 0.8, 0.8))],
)
scene = board.with_texture(0, texture).with_environment(1000)
camera = camera.metered(scene)
image = rc.render(scene, camera, spp=32, effects=())

# %%
# Project the corners
# -------------------
#
# ``camera.project`` follows real rays; the picture is made by the same rays. ``camera.camera_matrix`` and
# ``world_to_camera`` are what the lens does to first order, without distortion.

steps = np.arange(-half + square, half, square)
points_m = np.array([[x, y, 0] for y in steps for x in steps])
pixels, status = camera.project(points_m, return_status=True)
seen = status == rc.ProjectionStatus.OK

R, t = camera.world_to_camera
ideal = (R @ points_m.T).T + t
ideal = (camera.camera_matrix @ (ideal / ideal[:, 2:]).T).T[:, :2]

figure, axes = plt.subplots(figsize=(7, 5.2), layout="constrained")
axes.imshow(image.developed(), extent=(0, *camera.film.resolution, 0))
axes.plot(*pixels[seen].T, "o", markerfacecolor="none", color="#d9493c", label="by real rays")
axes.plot(*ideal[seen].T, "+", color="#4a78d6", label="by the camera matrix")
axes.legend(loc="upper right")
axes.set_title("corners of the squares")
print(f"the matrix alone is up to {np.linalg.norm(ideal - pixels, axis=1)[seen].max():.1f} pixels off")

# %%
# Fit a model
# -----------
#
# ``rc.fit_camera_model`` fits the models of vision programs to the lens, as a perfect calibration would. The residual
# is what the model cannot describe. Of ``opencv8`` a warning would say that fewer terms are enough for this lens.

for name in ("pinhole", "opencv4", "opencv5"):
    fit = rc.fit_camera_model(camera, name)
    print(f"{name}: {fit.rms_px:.4f} pixels RMS, {fit.max_px:.3f} at most")

K, distortion = fit.opencv()  # for cv2.projectPoints
print(np.round(K, 2))
print(np.round(distortion, 4))

# %%
# Depth
# -----
#
# Layers say what each pixel sees. ``depth_middle`` is the distance from the film along the camera's axis, so that the
# board has the same everywhere. More layers are on
# :doc:`their page </docs/layers>`. :doc:`Cameras for vision </docs/vision>` has conventions, COLMAP's files and data
# sets.

layered = rc.render(scene, camera, spp=4, effects=(), layers=["depth_middle"])
depth_m = layered.layers["depth_middle"]
print(f"depth from {np.nanmin(depth_m):.3f} to {np.nanmax(depth_m):.3f} m")
