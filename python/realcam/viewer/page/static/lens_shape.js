// Shape of a surface, for drawing drags before the server has answered. Lengths in mm.

/// z of a conic with an even asphere at a distance from the axis (ISO 10110-12).
export function sag(surface, h) {
  const c = surface.radius_mm ? 1 / surface.radius_mm : 0;
  const root = 1 - (1 + surface.conic) * c * c * h * h;
  let z = (c * h * h) / (1 + Math.sqrt(Math.max(0, root)));
  for (const [power, value] of Object.entries(surface.aspheric)) z += value * h ** Number(power);
  return z;
}

/// Radius of curvature for which the surface has the sag z at h; null for a plane.
export function radiusOfSag(surface, h, z) {
  const aspheric = sag({ ...surface, radius_mm: null }, h);
  const conicSag = z - aspheric;
  const curvature = (2 * conicSag) / (h * h + (1 + surface.conic) * conicSag * conicSag);
  return Math.abs(curvature) < 1e-6 ? null : 1 / curvature;
}

/// Points (z, y) of the surface's section from rim to rim.
export function profile(surface, steps = 48) {
  const points = [];
  for (let k = -steps; k <= steps; ++k) {
    const y = (k / steps) * surface.semi_diameter_mm;
    points.push([surface.z + sag(surface, y), y]);
  }
  return points;
}
