"""Writes cpp/scene/materials/loss_tables.hpp: what single scattering loses at rough borders, and metals under coats.

    python tools/make_loss_tables.py    # a minute; after make_ggx_tables.py, whose tables it reads

A rough border between two dielectrics reflects and lets through; what meets a second facet is lost. The loss, in both
together, depends on cosine, roughness and index. It is stored as a factor of `loss_scale`, which has the sharp dips of
small roughness already. Two tables: seen from outside (the lesser index), and from inside. Layers: cosines of the
critical angle, evenly. Rows: square roots of alpha, as in ggx_tables.hpp. Columns: square roots of the cosine.

A coat over rough metal hides it from the eye and from the light. The lesser of the two shares is taken (bsdf.hpp), so
that light is lost where the light meets more of the coat than the eye. The table holds that loss for a coat of weight
1 and a metal that reflects all. Layers: square roots of the coat's alpha, rows: of the metal's, from 0.

Losses by Gauss-Legendre quadrature over the visible facets on a grid some times as fine as the tables. These are not
samples of it but fitted below it: what a table says above the loss is light from nowhere, and counts a hundred times
as much as what it says below. Means, over the cosines: of what the tables say, as the program interpolates it. So the
lobe of what was lost has the energy that it should have, whatever the errors of the tables. A border's mean stands
over alpha^2, with which it grows on smooth surfaces; between the rows it is no straight line.
"""

import re
from pathlib import Path

import numpy as np
from make_ggx_tables import SMOOTHEST, smith_lambda, stretched, text_of, visible_facets

LAYERS, ROWS, COLUMNS = 16, 16, 24
MEAN_ROWS = 2 * ROWS - 1
LEAST_CRITICAL, MOST_CRITICAL = 0.3, np.sqrt(1 - 1 / 9)  # indices of 1.048 to 3
COAT_LAYERS, COAT_ROWS, COAT_COLUMNS = 8, 14, 24
COAT_F0 = 0.04
NODES = 80


def gauss(nodes: int) -> tuple[np.ndarray, np.ndarray]:
    x, w = np.polynomial.legendre.leggauss(nodes)
    return (x + 1) / 2, w / 2


class GgxTable:
    """The table that cpp/scene/materials/ggx_albedo.hpp reads: the albedo for all cosines at one alpha."""

    def __init__(self) -> None:
        text = Path("cpp/scene/materials/ggx_tables.hpp").read_text()
        self.rows, self.columns = (int(re.search(rf"GGX_{name} (\d+)", text)[1]) for name in ("ROWS", "COLUMNS"))

        def numbers(name: str) -> np.ndarray:
            body = re.search(rf"#define REALCAM_GGX_{name} ((?:.*\\\n)+.*)", text)[1]
            return np.array([float(v) for v in re.findall(r"([\d.]+)f", body)])

        self.all, self.grazing = (numbers(n).reshape(self.rows, self.columns) for n in ("ALBEDO", "SCHLICK"))
        self.mean_loss = numbers("MEAN_LOSS")

    def _row(self, alpha: float) -> tuple[int, float]:
        place = (np.sqrt(alpha) - np.sqrt(SMOOTHEST)) / (1 - np.sqrt(SMOOTHEST)) * (self.rows - 1)
        index = int(np.clip(place, 0, self.rows - 2))
        return index, float(np.clip(place - index, 0, 1))

    def albedo(self, cosines: np.ndarray, alpha: float) -> tuple[np.ndarray, np.ndarray]:
        i, f = self._row(alpha)
        at = np.arange(self.columns)

        def read(table: np.ndarray, places: np.ndarray) -> np.ndarray:
            return np.interp(places * (self.columns - 1), at, (1 - f) * table[i] + f * table[i + 1])

        everything = read(self.all, stretched(cosines, alpha) ** (2 / 3))
        return everything, everything * read(self.grazing, np.sqrt(cosines))

    def mean_lost(self, alpha: float) -> float:
        i, f = self._row(alpha)
        return float(alpha**2 * ((1 - f) * self.mean_loss[i] + f * self.mean_loss[i + 1]))


def fresnel(cosine: np.ndarray, eta: float) -> np.ndarray:
    sine2 = (1 - cosine**2) / eta**2
    beyond = np.sqrt(np.maximum(0, 1 - sine2))
    parallel = (eta * cosine - beyond) / (eta * cosine + beyond)
    perpendicular = (cosine - eta * beyond) / (cosine + eta * beyond)
    return np.where(sine2 < 1, (parallel**2 + perpendicular**2) / 2, 1.0)


class SeenFacets:
    """The facets that a direction sees, and what becomes of light from there: points of a quadrature."""

    def __init__(self, cosine: float, alpha: float, nodes: int = NODES) -> None:
        x, w = gauss(nodes)
        u, v = np.meshgrid(x, x / 2, indexing="ij")  # half of the turn: the rest is its mirror
        self.weight, self.alpha, self.cosine = np.outer(w, w), alpha, max(cosine, 1e-5 * alpha)
        eye = np.array([np.sqrt(1 - self.cosine**2), 0.0, self.cosine])
        self.h = visible_facets(eye, alpha, u, v)
        self.facing = np.minimum(np.tensordot(eye, self.h, 1), 1)
        self.mirrored_z = 2 * self.facing * self.h[2] - self.cosine

    def share(self, z: np.ndarray) -> np.ndarray:
        """Of light to a cosine z that no second facet catches; none below the surface."""
        mine = smith_lambda(np.asarray(self.cosine), self.alpha)
        return np.where(z > 0, (1 + mine) / (1 + mine + smith_lambda(np.where(z > 0, z, 1), self.alpha)), 0.0)

    def border_loss(self, eta: float) -> float:
        reflected = fresnel(self.facing, eta)
        sine2 = (1 - self.facing**2) / eta**2
        through_z = np.sqrt(np.maximum(0, 1 - sine2)) * self.h[2] - (self.facing * self.h[2] - self.cosine) / eta
        kept = reflected * self.share(self.mirrored_z) + (1 - reflected) * self.share(through_z)
        return 1 - float(np.sum(self.weight * kept))


def hats(places: np.ndarray, count: int) -> np.ndarray:
    """The matrix of linear interpolation in a table of `count` at these places, 0 to 1."""
    at = np.clip(places, 0, 1) * (count - 1)
    index = np.minimum(at.astype(int), count - 2)
    out = np.zeros((len(at), count))
    out[np.arange(len(at)), index] = 1 - (at - index)
    out[np.arange(len(at)), index + 1] += at - index
    return out


def fitted_below(target: np.ndarray, scale: np.ndarray, axes: list[np.ndarray]) -> np.ndarray:
    """The table that, interpolated and times scale, comes near the target, and rarely above it."""
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
    return 1 - ggx.albedo(cosines, alpha)[0] + 0.5 * alpha


def border_tables(ggx: GgxTable) -> tuple[list[float], list[float]]:
    """Losses from outside, then from inside, and their means."""
    roots = np.linspace(np.sqrt(SMOOTHEST), 1, 4 * ROWS - 3)
    # Between 0.01 and 1 evenly where the tables are read, and some below.
    cosines = np.concatenate([np.linspace(0.01, 0.1, 5) ** 2, np.linspace(0.1, 1, 4 * COLUMNS) ** 2])
    critical = np.linspace(LEAST_CRITICAL, MOST_CRITICAL, 2 * LAYERS - 1)
    etas = 1 / np.sqrt(1 - critical**2)
    losses = np.empty((2, len(critical), len(roots), len(cosines)))
    for r, root in enumerate(roots):
        for c, cosine in enumerate(cosines):
            seen = SeenFacets(cosine, root**2)
            for k, eta in enumerate(etas):
                losses[:, k, r, c] = seen.border_loss(eta), seen.border_loss(1 / eta)
    scale = np.array([loss_scale(cosines, root**2, ggx) for root in roots])[None]
    axes = [
        hats(np.linspace(0, 1, len(critical)), LAYERS),
        hats(np.linspace(0, 1, len(roots)), ROWS),
        hats(np.sqrt(cosines), COLUMNS),
    ]
    tables = [fitted_below(side, scale, axes) for side in losses]
    x, w = gauss(256)
    nodes, weights = x**2, 2 * x**2 * 2 * x * w
    mean_roots = np.linspace(0, 1, MEAN_ROWS)
    alphas = (np.sqrt(SMOOTHEST) + mean_roots * (1 - np.sqrt(SMOOTHEST))) ** 2
    scales = np.array([loss_scale(nodes, a, ggx) for a in alphas])
    rows, columns = hats(mean_roots, ROWS), hats(x, COLUMNS)
    scales /= alphas[:, None] ** 2
    means = [np.einsum("rn,n,rj,nk,ijk->ir", scales, weights, rows, columns, t, optimize=True) for t in tables]
    return [float(v) for t in tables for v in t.ravel()], [float(v) for m in means for v in m.ravel()]


def coat_albedo(cosines: np.ndarray, alpha: float, ggx: GgxTable) -> np.ndarray:
    """FacetReflectance::albedo of microfacet_reflection.hpp."""
    if alpha < SMOOTHEST:
        return COAT_F0 + (1 - COAT_F0) * (1 - cosines) ** 5
    everything, grazing = ggx.albedo(cosines, alpha)
    lost = ggx.mean_lost(alpha)
    mean = (20 * COAT_F0 + 1) / 21
    several = (1 - lost) * mean**2 / (1 - lost * mean)
    return (everything - grazing) * COAT_F0 + grazing + (1 - everything) * several


def coat_tables(ggx: GgxTable) -> tuple[list[float], list[float]]:
    coats, metals = np.linspace(0, 1, 2 * COAT_LAYERS - 1), np.linspace(0, 1, 2 * COAT_ROWS - 1)
    cosines = np.concatenate([[0.001], np.linspace(0.1, 1, 64) ** 2])
    losses = np.zeros((len(coats), len(metals), len(cosines)))
    x, w = gauss(128)
    nodes, weights = x**2, 2 * x**2 * 2 * x * w
    for m, metal in enumerate(metals):
        alpha = metal**2
        if alpha < SMOOTHEST:
            continue  # a mirror, which has the same cosine twice
        lost = ggx.mean_lost(alpha)
        again = weights * (1 - ggx.albedo(nodes, alpha)[0]) / lost
        for c, cosine in enumerate(cosines):
            seen = SeenFacets(cosine, alpha, 48)
            reflected = seen.weight * seen.share(seen.mirrored_z)
            mine = 1 - ggx.albedo(np.array([cosine]), alpha)[0][0]
            for k, coat in enumerate(coats):
                here = coat_albedo(np.array([cosine]), coat**2, ggx)[0]
                more = np.maximum(0, coat_albedo(np.clip(seen.mirrored_z, 0, 1), coat**2, ggx) - here)
                more_again = np.maximum(0, coat_albedo(nodes, coat**2, ggx) - here)
                losses[k, m, c] = np.sum(reflected * more) + mine * np.sum(again * more_again)
    axes = [hats(coats, COAT_LAYERS), hats(metals, COAT_ROWS), hats(np.sqrt(cosines), COAT_COLUMNS)]
    table = fitted_below(losses, np.ones_like(losses), axes)
    means = np.einsum("n,nk,ijk->ij", weights, hats(x, COAT_COLUMNS), table)
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
