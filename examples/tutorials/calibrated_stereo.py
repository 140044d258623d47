"""
Stereo pictures of your own camera
==================================

For vision engineers who have calibrated a camera. From the file that OpenCV wrote, this page makes 50 pairs of noisy
pictures with depth and optical flow, and shows that points are in them where the calibration projects them.
"""

# %%
# The calibration
# ---------------
#
# ``cv2.FileStorage`` writes files of this kind after ``cv2.calibrateCamera``. Yours takes the place of this one, in any
# of the :doc:`formats </docs/calibration>` that realcam reads.

import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import realcam as rc
from realcam import dataset
from scipy.ndimage import gaussian_filter

folder = Path(tempfile.mkdtemp())
(folder / "camera.yml").write_text("""%YAML:1.0
---
image_width: 320
image_height: 240
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 271.4, 0., 163.2, 0., 270.8, 117.6, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [ -0.2104, 0.0673, 0.0006, -0.0004, 0. ]
""")
calibration = rc.Calibration.load(folder / "camera.yml")
print(calibration)

# %%
# The camera
# ----------
#
# A calibration says where points are, and not how sharp and how bright they are. That comes from a real lens of a
# similar field; its rays are moved so that the geometry is exactly that of the calibration. ``"auto"`` finds the
# bundled lens whose directions are the nearest.

camera = calibration.camera("machine-vision-10mm")
error = calibration.geometry_error(camera)
print(f"{camera.lens.name}, {error.everywhere_px:.5f} pixels off at most")
print(f"its own pupil wanders by {error.pupil_shift_mm:.3f} mm, which is left out")

# %%
# The data set
# ------------
#
# A recipe names the calibration, and the distance to the second camera. The sensor adds its noise; so small a picture
# has large pixels, which a low ISO would fill. Each picture has a chessboard somewhere, whose corners are labelled.
# Without an executor, ``make`` uses processes, one for each core.

(folder / "recipe.toml").write_text("""format = 1
count = 50
calibration = "camera.yml"
lenses = ["machine-vision-10mm"]
stereo_m = 0.12
sensor = "sony-imx071-color"
iso = [3200, 6400]
f_stops = [2, 4]
speed_m_s = [0, 1]
board = [6, 4]
square_m = 0.12
labels = ["depth", "mask", "flow"]
depth = "ray"
spp = 8
""")
with ThreadPoolExecutor() as executor:
    dataset.make(dataset.Recipe.load(folder / "recipe.toml"), folder / "pictures", executor)
pairs = list(dataset.samples(folder / "pictures"))

first = pairs[0]
figure, axes = plt.subplots(2, 2, figsize=(7, 5.4), layout="constrained")
axes[0, 0].imshow(first["png"])
axes[0, 1].imshow(first["right.png"])
axes[1, 0].imshow(1 / first["depth.npy"], cmap="viridis")
axes[1, 1].imshow(np.linalg.norm(first["flow.npy"], axis=-1), cmap="magma")
for axis, title in zip(axes.flat, ("left", "right", "inverse depth", "length of the flow"), strict=True):
    axis.set_title(title)
    axis.axis("off")

# %%
# The proof
# ---------
#
# ``Calibration.project`` does what ``cv2.projectPoints`` does. It projects the corners of the chessboards, whose
# positions in the scene the labels state. In the pictures, corners are searched for without regard to labels: grey
# values near a corner form a saddle, whose middle is found by fitting a polynomial of the second degree.


def saddle_near(grey, pixel, radius=3):
    """Returns the saddle of the grey values near a pixel position, (2,); NaN if they form none."""
    column, row = np.floor(pixel).astype(int)
    if not (radius <= column < grey.shape[1] - radius and radius <= row < grey.shape[0] - radius):
        return np.full(2, np.nan)
    window = grey[row - radius : row + radius + 1, column - radius : column + radius + 1]
    y, x = np.mgrid[-radius : radius + 1, -radius : radius + 1].reshape(2, -1)
    terms = np.stack([x * x, x * y, y * y, x, y, np.ones(x.size)], axis=1)
    (xx, xy, yy, along_x, along_y, _), *_ = np.linalg.lstsq(terms, window.ravel(), rcond=None)
    if 4 * xx * yy - xy * xy > -1:  # in squares of grey levels per pixel squared: no saddle, or a faint one
        return np.full(2, np.nan)
    offset = np.linalg.solve([[2 * xx, xy], [xy, 2 * yy]], [-along_x, -along_y])
    return np.array([column, row]) + 0.5 + offset if np.abs(offset).max() < 2 else np.full(2, np.nan)


distances = []
for pair in pairs:
    for side in ("", "right."):
        label, grey = pair[side + "json"], gaussian_filter(pair[side + "png"].mean(axis=-1), 1.0)
        pose, board = label["pose"]["world_to_camera"], label["board"]
        in_camera = np.array(board["corners_m"]) @ np.array(pose["rotation"]).T + pose["translation_m"]
        projected, status = calibration.project(in_camera)
        for pixel, visible in zip(projected, board["corners_visible"], strict=True):
            if visible and np.isfinite(pixel).all():
                distances.append(saddle_near(grey, pixel) - pixel)
distances = np.array(distances)
distances = distances[np.isfinite(distances).all(axis=1)]
print(f"{len(distances)} corners: median offset {np.median(distances, axis=0).round(3)} pixels")
print(f"median distance {np.median(np.linalg.norm(distances, axis=1)):.3f} pixels")

figure, axis = plt.subplots(figsize=(4, 4), layout="constrained")
axis.plot(*distances.T, ".", color="#4a78d6")
axis.set(xlim=(-1, 1), ylim=(-1, 1), xlabel="pixels to the right", ylabel="pixels down")
axis.set_title("found corner minus projection")

# %%
# The distances are those of finding corners in noise and blur. A rig of different cameras, such as a camchain of
# Kalibr, is ``rig = "camchain.yaml"`` in the recipe, or :doc:`rc.Rig.of_calibrations </docs/rigs>` in Python.
