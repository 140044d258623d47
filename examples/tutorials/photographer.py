"""
Aperture, depth of field and the look of a lens
===============================================

For photographers. You know f-numbers, shutter times and ISO; here they are numbers of a program. This page takes one
picture at three apertures, asks how deep the field is, and changes the lens.
"""

# %%
# A shot
# ------
#
# A *shot file* describes a photograph: the scene, its light, the camera and where it stands. The demo is a chess board
# at dusk with lamps behind it. Its camera has a 50 mm lens of 1954, focused at 1.05 m on the king.

import matplotlib.pyplot as plt
import realcam as rc

shot = rc.Shot.load("scenes/demo.toml")
film = shot.camera.film.replace(resolution=(240, 160))  # small pictures, so that they take a second each
camera = shot.camera.replace(film=film)
print(camera.lens)
print(f"1/{1 / camera.exposure_time_s:.0f} s at ISO {camera.iso:.0f}")


# %%
# Three apertures
# ---------------
#
# Cameras are *values*: ``replace`` makes a new one with something changed. Closing the aperture by two stops lets a
# quarter of the light pass, so each picture is exposed for as much longer as its aperture is smaller.


def stopped_down(f_number: float) -> rc.Camera:
    longer = (f_number / 2.1) ** 2
    return camera.replace(lens=camera.lens.stopped_down(f_number), exposure_time_s=longer * shot.camera.exposure_time_s)


def photograph(camera: rc.Camera) -> rc.Image:
    return rc.render(shot.scene, camera, shot.settings, spp=48, effects=())


f_numbers = (2.1, 4, 8)
images = {f_number: photograph(stopped_down(f_number)) for f_number in f_numbers}

figure, columns = plt.subplots(1, 3, figsize=(10, 2.6), layout="constrained")
for axes, (f_number, image) in zip(columns, images.items(), strict=True):
    axes.imshow(image.developed())
    axes.set_title(f"f/{f_number}")
    axes.axis("off")

# %%
# The board in front and the lamps behind are discs at f/2.1. At f/8 they are nearly points. The brightness is the same,
# as on a camera.
#
# How deep is the field?
# ----------------------
#
# ``rc.depth_of_field`` sends real rays through the lens and asks where their spots are small enough. Next to it is what
# the formula of the textbooks says of a lens without aberrations. Distances are in metres from the film.

for f_number in f_numbers:
    depth = rc.depth_of_field(stopped_down(f_number).lens)
    real, formula = depth.real, depth.formula
    print(
        f"f/{f_number}: sharp from {real.near_m:.3f} to {real.far_m:.3f} m; "
        f"by formula from {formula.near_m:.3f} to {formula.far_m:.3f} m"
    )

# %%
# Another lens
# ------------
#
# The look of the lamps depends on the lens. This is the Sonnar of 1935 in the same place, also at f/2.1. Both are
# 50 mm lenses, so the picture is framed alike. Look at the shapes of the discs towards the corners.

sonnar = rc.Lens.load("sonnar-50mm").focused(1.05).stopped_down(2.1)
other = photograph(camera.replace(lens=sonnar))

figure, columns = plt.subplots(1, 2, figsize=(8, 2.9), layout="constrained")
for axes, image, name in zip(columns, (images[2.1], other), ("double Gauss", "Sonnar"), strict=True):
    axes.imshow(image.developed())
    axes.set_title(name)
    axes.axis("off")

# %%
# Ask the light meter
# -------------------
#
# ``metered`` chooses the exposure time that makes the average of the picture middle grey.

metered = camera.replace(iso=400).metered(shot.scene)
print(f"at ISO 400 the meter says 1/{1 / metered.exposure_time_s:.0f} s")

# %%
# ``image.save("photograph.png")`` writes a picture. Next: :doc:`the command line </docs/command-line>` does all this
# without a program, and :doc:`the lens bench </docs/lens-bench>` with the mouse.
