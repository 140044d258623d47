"""Writes cpp/scene/materials/ggx_tables.hpp: directional albedo of GGX microfacets with single scattering.

    python tools/make_ggx_tables.py

Computed by Gauss-Legendre quadrature over the visible facets (Heitz 2018), over which the integrands are smooth: G2/G1
for E, and G2/G1 times Schlick's (1 - cos)^5 for B. Rows: 32 square roots of alpha, uniformly from that of 0.001 to 1.

E, 48 columns: the cosine of the direction in the space that is stretched so that alpha becomes 1. Masking depends only
on that cosine, so that the dip of E at cosines close to alpha lies in the same column of all rows, and rows can be
interpolated. Columns are uniform in its power 2/3, for resolution near 0. B / E, 48 columns: square roots of the
cosine itself, on which Schlick's term depends.

Means are cosine-weighted. The mean of E is stored as (1 - E) / alpha^2, because 1 - E grows with alpha^2 on smooth
surfaces.
"""

from pathlib import Path

import numpy as np

ROWS, COLUMNS = 32, 48
SMOOTHEST = 0.001  # alpha of the first row
NODES = 96  # of the quadrature, along each axis


def stretched(cosine: np.ndarray, alpha: float) -> np.ndarray:
    """Cosine of a direction in the space in which alpha is 1."""
    return cosine / np.sqrt(cosine**2 + alpha**2 * (1 - cosine**2))


def unstretched(z: np.ndarray, alpha: float) -> np.ndarray:
    """Inverse of stretched()."""
    return alpha * z / np.sqrt(1 - z**2 + (alpha * z) ** 2)


def visible_facets(w: np.ndarray, alpha: float, u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """(3, ...): facet normals visible from the direction w, mapped from the unit square (u, v) by spherical caps (Dupuy
    and Benyoub 2023)."""
    s = np.array([alpha * w[0], 0.0, w[2]])
    s /= np.linalg.norm(s)
    z = (1 - u) * (1 + s[2]) - s[2]
    radius = np.sqrt(np.maximum(0, 1 - z * z))
    h = np.stack([radius * np.cos(2 * np.pi * v) + s[0], radius * np.sin(2 * np.pi * v), z + s[2]])
    h[:2] *= alpha
    return h / np.linalg.norm(h, axis=0)


def smith_lambda(z: np.ndarray, alpha: float) -> np.ndarray:
    """Smith's Lambda of GGX for directions of cosine z."""
    return 0.5 * (np.sqrt(1 + alpha * alpha * (1 / (z * z) - 1)) - 1)


def albedos(cosine: float, alpha: float) -> tuple[float, float]:
    """E and B for one direction."""
    cosine = max(cosine, 1e-5 * alpha)
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    u, v = np.meshgrid(
        (nodes + 1) / 2, (nodes + 1) / 4, indexing="ij"
    )  # half of the azimuths, because of mirror symmetry
    weight = np.outer(weights, weights) / 4
    w = np.array([np.sqrt(1 - cosine * cosine), 0.0, cosine])
    h = visible_facets(w, alpha, u, v)
    facing = np.tensordot(w, h, 1)
    out_z = 2 * facing * h[2] - w[2]
    above = out_z > 0
    own = smith_lambda(np.asarray(cosine), alpha)
    shadowing = np.where(above, (1 + own) / (1 + own + smith_lambda(np.where(above, out_z, 1.0), alpha)), 0.0)
    return float(np.sum(weight * shadowing)), float(np.sum(weight * shadowing * (1 - facing) ** 5))


def averages(alpha: float) -> tuple[float, float]:
    """Cosine-weighted means of E and B."""
    nodes, weights = np.polynomial.legendre.leggauss(256)
    roots, weights = (nodes + 1) / 2, weights / 2  # over the cosine's cube root, where E is smoother
    values = np.array([albedos(r**3, alpha) for r in roots])
    density = 2 * roots**3 * 3 * roots**2 * weights
    return tuple(float(x) for x in density @ values)


def text_of(name: str, values: list[float]) -> str:
    """A macro with the values, eight in a line."""
    lines = ["    " + ", ".join(f"{v:.6f}f" for v in values[i : i + 8]) + "," for i in range(0, len(values), 8)]
    return f"#define {name} \\\n" + " \\\n".join(lines).rstrip(",") + "\n"


def main() -> None:
    alphas = np.linspace(np.sqrt(SMOOTHEST), 1, ROWS) ** 2
    columns = np.linspace(0, 1, COLUMNS)
    everything = [albedos(unstretched(z, a), a)[0] for a in alphas for z in columns**1.5]
    # At grazing incidence the ratio B / E is 1, but the quadrature gives 0 / 0.
    pairs = [albedos(c, a) for a in alphas for c in np.maximum(columns, 1e-3) ** 2]
    means = [averages(a) for a in alphas]
    Path("cpp/scene/materials/ggx_tables.hpp").write_text(
        "#pragma once\n"
        "// Directional albedo of single scattering by GGX microfacets, as read by ggx_albedo.hpp and written by\n"
        "// tools/make_ggx_tables.py. Rows: the square root of alpha, from that of 0.001 to 1. ALBEDO: albedo for a\n"
        "// Fresnel term of 1; columns: the cosine on the surface stretched to alpha 1, to the power 2/3. SCHLICK:\n"
        "// albedo for the Fresnel term (1 - cosine)^5, relative to ALBEDO; columns: the square root of the cosine.\n"
        "// MEAN_LOSS: 1 - cosine-weighted mean of the albedo, divided by alpha^2. MEAN_SCHLICK: cosine-weighted\n"
        "// mean for the Fresnel term. The tables are macros, because host and device each need an array of their\n"
        "// own.\n"
        "// clang-format off\n\n"
        f"#define REALCAM_GGX_ROWS {ROWS}\n#define REALCAM_GGX_COLUMNS {COLUMNS}\n\n"
        + text_of("REALCAM_GGX_ALBEDO", everything)
        + "\n"
        + text_of("REALCAM_GGX_SCHLICK", [b / e for e, b in pairs])
        + "\n"
        + text_of("REALCAM_GGX_MEAN_LOSS", [(1 - e) / a**2 for (e, _), a in zip(means, alphas, strict=True)])
        + "\n"
        + text_of("REALCAM_GGX_MEAN_SCHLICK", [b for _, b in means])
        + "\n// clang-format on\n"
    )


if __name__ == "__main__":
    main()
