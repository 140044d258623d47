"""Writes cpp/scene/materials/loss_tables.hpp: energy loss of single scattering at rough dielectrics and coated metals.

    python tools/make_loss_tables.py    # takes a minute; run make_ggx_tables.py before, whose tables it reads

Rough dielectric (called border): light that reaches a second microfacet after reflection or refraction is lost. The
total loss depends on cosine, roughness and relative index. It is stored divided by `loss_scale`, which already has the
sharp dips of small roughness. There are two tables: incidence from outside (the smaller index), and from inside.
Layers: cosine of the critical angle, uniformly. Rows: square root of alpha, as in ggx_tables.hpp. Columns: square root
of the cosine of the direction.

Coated metal: the metal below a coat is weighted by the smaller of the coat's transmittances for both directions
(bsdf.hpp), so that light is lost if the coat reflects more in the direction of the light than in that of the viewer.
The table has the loss for a coat of weight 1 and a perfectly reflecting metal. Layers: square root of the coat's alpha;
rows: of the metal's alpha, from 0; columns: square root of the cosine.

Losses are computed by Gauss-Legendre quadrature over the visible facets, on grids finer than the tables. The tables are
fitted, not sampled: a table value above the loss would create energy, so that such errors have a hundredfold weight.
The mean losses over the cosines are those of the interpolated tables, so that the compensating lobe has the correct
energy in spite of the tables' errors. The mean of a border is stored divided by alpha^2, with which it grows on smooth
surfaces.
"""

import re
from pathlib import Path

import numpy as np
from make_ggx_tables import SMOOTHEST, smith_lambda, stretched, text_of, visible_facets

LAYERS, ROWS, COLUMNS = 16, 16, 24  # of the tables of borders
MEAN_ROWS = 2 * ROWS - 1  # finer, because the mean is not linear between the rows
# Range of the cosine of the critical angle: relative indices of 1.048 to 3.
LEAST_CRITICAL, MOST_CRITICAL = 0.3, np.sqrt(1 - 1 / 9)
COAT_LAYERS, COAT_ROWS, COAT_COLUMNS = 8, 14, 24
COAT_F0 = 0.04  # reflectance of a coat at normal incidence
NODES = 80  # of the quadrature over the facets, along each axis


def gauss(nodes: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights of Gauss-Legendre quadrature on 0 ... 1."""
    x, w = np.polynomial.legendre.leggauss(nodes)
    return (x + 1) / 2, w / 2


class GgxTable:
    """Directional albedo of GGX microfacets from ggx_tables.hpp, as cpp/scene/materials/ggx_albedo.hpp reads it."""

    def __init__(self) -> None:
        text = Path("cpp/scene/materials/ggx_tables.hpp").read_text()
        self.rows, self.columns = (int(re.search(rf"GGX_{name} (\d+)", text)[1]) for name in ("ROWS", "COLUMNS"))

        def numbers(name: str) -> np.ndarray:
            body = re.search(rf"#define REALCAM_GGX_{name} ((?:.*\\\n)+.*)", text)[1]
            return np.array([float(v) for v in re.findall(r"([\d.]+)f", body)])

        self.all, self.grazing = (numbers(n).reshape(self.rows, self.columns) for n in ("ALBEDO", "SCHLICK"))
        self.mean_loss = numbers("MEAN_LOSS")

    def _row(self, alpha: float) -> tuple[int, float]:
        """Row of the tables below this alpha, and the fraction of the distance to the next one."""
        position = (np.sqrt(alpha) - np.sqrt(SMOOTHEST)) / (1 - np.sqrt(SMOOTHEST)) * (self.rows - 1)
        index = int(np.clip(position, 0, self.rows - 2))
        return index, float(np.clip(position - index, 0, 1))

    def albedo(self, cosines: np.ndarray, alpha: float) -> tuple[np.ndarray, np.ndarray]:
        """Albedos for a reflectance of 1, and for Schlick's factor (1 - cos)^5."""
        i, f = self._row(alpha)
        columns = np.arange(self.columns)

        def read(table: np.ndarray, positions: np.ndarray) -> np.ndarray:
            return np.interp(positions * (self.columns - 1), columns, (1 - f) * table[i] + f * table[i + 1])

        everything = read(self.all, stretched(cosines, alpha) ** (2 / 3))
        return everything, everything * read(self.grazing, np.sqrt(cosines))

    def mean_lost(self, alpha: float) -> float:
        """Cosine-weighted mean of 1 - albedo."""
        i, f = self._row(alpha)
        return float(alpha**2 * ((1 - f) * self.mean_loss[i] + f * self.mean_loss[i + 1]))


def fresnel(cosine: np.ndarray, eta: float) -> np.ndarray:
    """Reflectance of unpolarised light. eta: index behind the border over that in front of it."""
    sine2 = (1 - cosine**2) / eta**2
    refracted = np.sqrt(np.maximum(0, 1 - sine2))
    parallel = (eta * cosine - refracted) / (eta * cosine + refracted)
    perpendicular = (cosine - eta * refracted) / (cosine + eta * refracted)
    return np.where(sine2 < 1, (parallel**2 + perpendicular**2) / 2, 1.0)


class VisibleFacets:
    """Quadrature over the microfacets that are visible from a direction.

    cosine: of the direction to the mean normal. h: (3, nodes, nodes), facet normals; facing: cosine of the direction to
    them; mirrored_z: cosine of the reflected direction to the mean normal.
    """

    def __init__(self, cosine: float, alpha: float, nodes: int = NODES) -> None:
        x, w = gauss(nodes)
        u, v = np.meshgrid(x, x / 2, indexing="ij")  # half of the azimuths, because of mirror symmetry
        self.weight, self.alpha, self.cosine = np.outer(w, w), alpha, max(cosine, 1e-5 * alpha)
        direction = np.array([np.sqrt(1 - self.cosine**2), 0.0, self.cosine])
        self.h = visible_facets(direction, alpha, u, v)
        self.facing = np.minimum(np.tensordot(direction, self.h, 1), 1)
        self.mirrored_z = 2 * self.facing * self.h[2] - self.cosine

    def escaping(self, z: np.ndarray) -> np.ndarray:
        """Fraction G2 / G1 of the light into a direction of cosine z that no second facet blocks; 0 below the
        surface."""
        own = smith_lambda(np.asarray(self.cosine), self.alpha)
        return np.where(z > 0, (1 + own) / (1 + own + smith_lambda(np.where(z > 0, z, 1), self.alpha)), 0.0)

    def border_loss(self, eta: float) -> float:
        """Fraction of the light that is lost at a dielectric. eta: as in fresnel()."""
        reflected = fresnel(self.facing, eta)
        sine2 = (1 - self.facing**2) / eta**2
        through_z = np.sqrt(np.maximum(0, 1 - sine2)) * self.h[2] - (self.facing * self.h[2] - self.cosine) / eta
        escaping = reflected * self.escaping(self.mirrored_z) + (1 - reflected) * self.escaping(through_z)
        return 1 - float(np.sum(self.weight * escaping))


def interpolation_matrix(positions: np.ndarray, count: int) -> np.ndarray:
    """(N, count): linear interpolation in a table of `count` values over 0 ... 1 at N positions."""
    scaled = np.clip(positions, 0, 1) * (count - 1)
    index = np.minimum(scaled.astype(int), count - 2)
    matrix = np.zeros((len(scaled), count))
    matrix[np.arange(len(scaled)), index] = 1 - (scaled - index)
    matrix[np.arange(len(scaled)), index + 1] += scaled - index
    return matrix


def fitted_below(target: np.ndarray, scale: np.ndarray, axes: list[np.ndarray]) -> np.ndarray:
    """Fits a table whose interpolation times `scale` is close to the target, and rarely above it.

    axes: interpolation matrices along the three axes. Solved by 600 steps of weighted gradient descent.
    """
    from_table = "ai,bj,ck,ijk->abc"
    to_table = "ai,bj,ck,abc->ijk"

    def gather(values: np.ndarray) -> np.ndarray:
        return np.einsum(to_table, *axes, values, optimize=True)

    table = gather(scale * target) / np.maximum(gather(scale**2), 1e-12)
    for _ in range(600):
        error = scale * np.einsum(from_table, *axes, table, optimize=True) - target
        weight = np.where(error > 3e-4, 100.0, np.where(error < -6e-3, 33.0, 1.0))
        step = gather(scale * weight * error) / np.maximum(gather(scale**2 * weight), 1e-12)
        table = np.maximum(0, table - 0.5 * step)
    return table


def loss_scale(cosines: np.ndarray, alpha: float, ggx: GgxTable) -> np.ndarray:
    """Factor of the table of borders."""
    return 1 - ggx.albedo(cosines, alpha)[0] + 0.5 * alpha


def border_tables(ggx: GgxTable) -> tuple[list[float], list[float]]:
    """Table values for incidence from outside, then from inside, and their means."""
    roots = np.linspace(np.sqrt(SMOOTHEST), 1, 4 * ROWS - 3)
    # Uniform in the square root, on which the tables depend, with some additional small ones.
    cosines = np.concatenate([np.linspace(0.01, 0.1, 5) ** 2, np.linspace(0.1, 1, 4 * COLUMNS) ** 2])
    critical = np.linspace(LEAST_CRITICAL, MOST_CRITICAL, 2 * LAYERS - 1)
    etas = 1 / np.sqrt(1 - critical**2)
    losses = np.empty((2, len(critical), len(roots), len(cosines)))
    for r, root in enumerate(roots):
        for c, cosine in enumerate(cosines):
            facets = VisibleFacets(cosine, root**2)
            for k, eta in enumerate(etas):
                losses[:, k, r, c] = facets.border_loss(eta), facets.border_loss(1 / eta)
    scale = np.array([loss_scale(cosines, root**2, ggx) for root in roots])[None]
    axes = [
        interpolation_matrix(np.linspace(0, 1, len(critical)), LAYERS),
        interpolation_matrix(np.linspace(0, 1, len(roots)), ROWS),
        interpolation_matrix(np.sqrt(cosines), COLUMNS),
    ]
    tables = [fitted_below(side, scale, axes) for side in losses]
    x, w = gauss(256)
    nodes, weights = x**2, 2 * x**2 * 2 * x * w
    mean_roots = np.linspace(0, 1, MEAN_ROWS)
    alphas = (np.sqrt(SMOOTHEST) + mean_roots * (1 - np.sqrt(SMOOTHEST))) ** 2
    scales = np.array([loss_scale(nodes, a, ggx) for a in alphas])
    rows, columns = interpolation_matrix(mean_roots, ROWS), interpolation_matrix(x, COLUMNS)
    scales /= alphas[:, None] ** 2
    means = [np.einsum("rn,n,rj,nk,ijk->ir", scales, weights, rows, columns, t, optimize=True) for t in tables]
    return [float(v) for t in tables for v in t.ravel()], [float(v) for m in means for v in m.ravel()]


def coat_albedo(cosines: np.ndarray, alpha: float, ggx: GgxTable) -> np.ndarray:
    """Directional albedo of a coat, as FacetReflectance::albedo of microfacet_reflection.hpp."""
    if alpha < SMOOTHEST:
        return COAT_F0 + (1 - COAT_F0) * (1 - cosines) ** 5
    everything, grazing = ggx.albedo(cosines, alpha)
    lost = ggx.mean_lost(alpha)
    mean = (20 * COAT_F0 + 1) / 21
    multiple = (1 - lost) * mean**2 / (1 - lost * mean)
    return (everything - grazing) * COAT_F0 + grazing + (1 - everything) * multiple


def coat_tables(ggx: GgxTable) -> tuple[list[float], list[float]]:
    """Table values of coated metals, and their means."""
    coats, metals = np.linspace(0, 1, 2 * COAT_LAYERS - 1), np.linspace(0, 1, 2 * COAT_ROWS - 1)
    cosines = np.concatenate([[0.001], np.linspace(0.1, 1, 64) ** 2])
    losses = np.zeros((len(coats), len(metals), len(cosines)))
    x, w = gauss(128)
    nodes, weights = x**2, 2 * x**2 * 2 * x * w
    for m, metal in enumerate(metals):
        alpha = metal**2
        if alpha < SMOOTHEST:
            continue  # a mirror, for which both directions have the same cosine
        lost = ggx.mean_lost(alpha)
        # Distribution of multiply scattered light over the cosines.
        multiple = weights * (1 - ggx.albedo(nodes, alpha)[0]) / lost
        for c, cosine in enumerate(cosines):
            facets = VisibleFacets(cosine, alpha, 48)
            reflected = facets.weight * facets.escaping(facets.mirrored_z)
            multiple_fraction = 1 - ggx.albedo(np.array([cosine]), alpha)[0][0]
            for k, coat in enumerate(coats):
                own = coat_albedo(np.array([cosine]), coat**2, ggx)[0]
                excess = np.maximum(0, coat_albedo(np.clip(facets.mirrored_z, 0, 1), coat**2, ggx) - own)
                multiple_excess = np.maximum(0, coat_albedo(nodes, coat**2, ggx) - own)
                losses[k, m, c] = np.sum(reflected * excess) + multiple_fraction * np.sum(multiple * multiple_excess)
    axes = [
        interpolation_matrix(coats, COAT_LAYERS),
        interpolation_matrix(metals, COAT_ROWS),
        interpolation_matrix(np.sqrt(cosines), COAT_COLUMNS),
    ]
    table = fitted_below(losses, np.ones_like(losses), axes)
    means = np.einsum("n,nk,ijk->ij", weights, interpolation_matrix(x, COAT_COLUMNS), table)
    return [float(v) for v in table.ravel()], [float(v) for v in means.ravel()]


def main() -> None:
    ggx = GgxTable()
    borders, border_means = border_tables(ggx)
    coats, coat_means = coat_tables(ggx)
    sizes = {
        "INTERFACE_LAYERS": LAYERS,
        "INTERFACE_ROWS": ROWS,
        "INTERFACE_COLUMNS": COLUMNS,
        "INTERFACE_MEAN_ROWS": MEAN_ROWS,
        "COAT_LAYERS": COAT_LAYERS,
        "COAT_ROWS": COAT_ROWS,
        "COAT_COLUMNS": COAT_COLUMNS,
    }
    Path("cpp/scene/materials/loss_tables.hpp").write_text(
        "#pragma once\n"
        "// Energy that single scattering loses, as read by dielectric_interface.hpp and bsdf.hpp and written by\n"
        "// tools/make_loss_tables.py. INTERFACE_LOSS: at a rough dielectric interface, first outside, then inside,\n"
        "// relative to a function of roughness and cosine; layers: the cosine of the critical angle, rows: the\n"
        "// square root of alpha, columns: the square root of the cosine. INTERFACE_MEAN_LOSS: its cosine-weighted\n"
        "// mean, divided by alpha^2. COAT_LOSS: of a perfectly reflecting rough metal under a coat; layers: the\n"
        "// square root of the coat's alpha, rows: of the metal's, columns: of the cosine. COAT_MEAN_LOSS: its\n"
        "// cosine-weighted mean. The tables are macros, because host and device each need an array of their own.\n"
        "// clang-format off\n\n"
        + "".join(f"#define REALCAM_{name} {size}\n" for name, size in sizes.items())
        + f"#define REALCAM_INTERFACE_LEAST_CRITICAL {LEAST_CRITICAL}f\n"
        + f"#define REALCAM_INTERFACE_MOST_CRITICAL {MOST_CRITICAL:.7f}f\n\n"
        + text_of("REALCAM_INTERFACE_LOSS", borders)
        + "\n"
        + text_of("REALCAM_INTERFACE_MEAN_LOSS", border_means)
        + "\n"
        + text_of("REALCAM_COAT_LOSS", coats)
        + "\n"
        + text_of("REALCAM_COAT_MEAN_LOSS", coat_means)
        + "\n// clang-format on\n"
    )


if __name__ == "__main__":
    main()
