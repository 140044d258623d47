"""realcam's lenses as sensors of Mitsuba 3: `import realcam.mitsuba` registers the sensor `realcam`.

    import mitsuba as mi
    import realcam.mitsuba

    mi.set_variant("llvm_ad_rgb")
    sensor = mi.load_dict({"type": "realcam", "lens": "double-gauss-50mm", "focus_distance_m": 4.0, "f_number": 2.8})

docs/mitsuba.md lists the properties. Requires the package mitsuba.
"""

from __future__ import annotations

import importlib
import sys

try:
    import mitsuba
except ImportError:
    raise ImportError("realcam.mitsuba needs Mitsuba 3: pip install 'realcam[mitsuba]'") from None


def _register(variant: str | None) -> None:
    """Registers the sensor. A class belongs to a variant, so the module is reloaded for each, as Mitsuba's own are."""
    if variant:
        name = f"{__name__}.sensor"
        sensor = importlib.reload(sys.modules[name]) if name in sys.modules else importlib.import_module(name)
        mitsuba.register_sensor("realcam", sensor.RealcamSensor)


_register(mitsuba.variant())
mitsuba.detail.add_variant_callback(lambda _, new: _register(new))
