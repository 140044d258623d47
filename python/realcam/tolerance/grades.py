"""Tolerances by grade, as published by optical shops.

Radius and thickness: Edmund Optics, "Understanding Optical Specifications" (its typical, precision and high quality).
Index and Abbe number: Optimax, "Manufacturing Tolerance Chart" (commercial, precision). For grade "high" they are
assumed: the uncertainty that remains when melt data of four digits are used. Planes, irregularity and wedge are
assumed. The charts end at the element: tilt and decentre of elements in their mount are assumed, for turned barrels
(commercial), better barrels (precision) and individually centred cells (high).
"""

from __future__ import annotations

from typing import Any

GRADES: dict[str, dict[str, Any]] = {
    "commercial": {
        "radius_percent": 0.5,
        "radius_fringes": 5.0,
        "thickness_mm": 0.2,
        "index": 1e-3,
        "abbe_percent": 0.8,
        "wedge_arcmin": 3.0,
        "element_tilt_arcmin": 6.0,
        "element_decentre_mm": 0.1,
        "irregularity_fringes": 2.0,
    },
    "precision": {
        "radius_percent": 0.1,
        "radius_fringes": 3.0,
        "thickness_mm": 0.05,
        "index": 5e-4,
        "abbe_percent": 0.5,
        "wedge_arcmin": 1.0,
        "element_tilt_arcmin": 2.0,
        "element_decentre_mm": 0.03,
        "irregularity_fringes": 0.5,
    },
    "high": {
        "radius_percent": 0.01,
        "radius_fringes": 1.0,
        "thickness_mm": 0.01,
        "index": 1e-4,
        "abbe_percent": 0.2,
        "wedge_arcmin": 0.5,
        "element_tilt_arcmin": 0.5,
        "element_decentre_mm": 0.01,
        "irregularity_fringes": 0.1,
    },
}
