"""The camera of a shot with a calibration."""

from __future__ import annotations

from .._core import Camera, Lens
from .calibration import Calibration
from .camera import Vignetting


def camera_of_shot(
    file: str, camera: str, vignetting: str, lens: Lens | None, film_width_mm: float | None, f_number: float | None
) -> Camera:
    """Returns the camera of a shot with a calibration; the extension module calls this.

    camera, vignetting: empty if not stated. lens: None: the bundled one that resembles the calibration most.
    Raises RealcamError.
    """
    calibration = Calibration.load(file, camera or None)
    measured = Vignetting.load(vignetting) if vignetting else None
    return calibration.camera(
        "auto" if lens is None else lens,
        film_width_mm=film_width_mm,
        f_number=f_number if lens is None else None,
        vignetting=measured,
    )
