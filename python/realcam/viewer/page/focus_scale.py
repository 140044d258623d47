"""Distance scale of a lens barrel, with the depth of field."""

from __future__ import annotations

import math

_WIDTH, _HEIGHT = 320, 46  # of the SVG's view box
_MARGIN = 14  # free space at both ends of the scale
_ENGRAVED_M = (0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.7, 1, 1.5, 2, 3, 5, 10, 20, 50, 100, 300, 1000, math.inf)
_CLEARANCE = 26  # minimum spacing of two labels


def focus_scale_svg(focus_m: float, near_m: float, far_m: float, nearest_m: float) -> str:
    """Returns the scale as SVG. Distances are in metres; near and far are nan if nothing is sharp.

    The scale is uniform in the inverse distance, as on a barrel.
    """

    def x(distance_m: float) -> float:
        fraction = 1 - nearest_m / distance_m if distance_m > nearest_m else 0.0
        return _MARGIN + (_WIDTH - 2 * _MARGIN) * fraction

    parts = []
    if not math.isnan(near_m):
        left, right = x(near_m), x(far_m)
        parts.append(
            f'<rect x="{left:.1f}" y="4" width="{max(1.0, right - left):.1f}" height="10" rx="2" '
            'fill="var(--rc-ray1)" opacity="0.55"/>'
        )
    parts.append(f'<line x1="{_MARGIN}" x2="{_WIDTH - _MARGIN}" y1="16" y2="16" stroke="var(--rc-line)"/>')
    last = -math.inf
    for distance in reversed(_ENGRAVED_M):
        at = x(distance)
        if distance < nearest_m or abs(at - last) < _CLEARANCE:
            continue
        last = at
        text = "∞" if math.isinf(distance) else f"{distance:g}"
        parts.append(
            f'<line x1="{at:.1f}" x2="{at:.1f}" y1="16" y2="21" stroke="var(--rc-line)"/>'
            f'<text x="{at:.1f}" y="33" text-anchor="middle" font-size="11" fill="var(--rc-text)">{text}</text>'
        )
    at = x(focus_m)
    parts.append(f'<line x1="{at:.1f}" x2="{at:.1f}" y1="1" y2="22" stroke="var(--rc-accent)" stroke-width="2.5"/>')
    parts.append(f'<text x="{_WIDTH - 2}" y="44" text-anchor="end" font-size="9" fill="var(--rc-faint)">m</text>')
    label = "Focused at {}; sharp from {} to {}".format(distance_text(focus_m), *distance_texts(near_m, far_m))
    if math.isnan(near_m):
        label = f"Focused at {distance_text(focus_m)}; nothing is sharp"
    label = label.replace("∞", "infinity")
    head = f'<svg viewBox="0 0 {_WIDTH} {_HEIGHT}" role="img" aria-label="{label}"><title>{label}</title>'
    return f"{head}{''.join(parts)}</svg>"


def distance_texts(near_m: float, far_m: float) -> tuple[str, str]:
    """Both distances as text, with enough digits to distinguish them."""
    for digits in range(3, 7):
        texts = distance_text(near_m, digits), distance_text(far_m, digits)
        if texts[0] != texts[1]:
            break
    return texts


def distance_text(metres: float, digits: int = 3) -> str:
    """Text of a distance: whole metres from 1000 m on, and ∞ for infinity."""
    return "∞" if math.isinf(metres) else f"{metres:.0f} m" if metres >= 1000 else f"{metres:.{digits}g} m"
