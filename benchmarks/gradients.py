"""Gradient of a spot size by all radii, thicknesses and indices of a lens: realcam, and reverse mode in PyTorch.

    python benchmarks/gradients.py

Prints CPU times over all threads. PyTorch differentiates the sequential float64 ray trace of spheres below, which
stands in for differentiable ray tracers such as DeepLens. Both programs trace the same rays from in front of the lens.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
import realcam as rc


def variables_of(lens: rc.Lens) -> list[rc.Variable]:
    """All radii, thicknesses, and indices of glass, in this order."""
    count = len(lens.surfaces)
    refracting = [i for i in range(count) if lens.surfaces[i].type == "refracting"]
    return [
        *(rc.Variable.radius(i) for i in refracting),
        *(rc.Variable.thickness(i) for i in range(count - 1)),
        *(rc.Variable.index(i) for i in refracting if lens.surfaces[i].material.index(lens.wavelength_nm) > 1.1),
    ]


def by_realcam(lens: rc.Lens, variables: list[rc.Variable], origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """(V,): gradient of the RMS spot radius by realcam. origins, directions: (N, 3), rays in front of the lens, mm."""
    rays = lens.trace(origins, directions, start="scene")
    film = sum(s.thickness_mm for s in lens.surfaces[:-1]) + lens.film_distance_mm
    film_by = np.array([float(v.quantity == "thickness") for v in variables])  # the film follows the last vertex
    o, d = rays.origins_mm, rays.directions
    slopes, distances = d[:, :2] / d[:, 2:], film - o[:, 2:]
    points = o[:, :2] + distances * slopes
    errors = points - points.mean(0)
    # Derivatives of the RMS radius by the film points, and from them by the film's position and the rays.
    by_points = errors / (len(points) * np.sqrt((errors**2).sum(1).mean()))
    by_film = (by_points * slopes).sum(1, keepdims=True)
    found = rc.backpropagate_rays(
        lens,
        origins,
        directions,
        variables,
        of_origins=np.hstack([by_points, -by_film]),
        of_directions=distances / d[:, 2:] * np.hstack([by_points, -by_film]),
        start="scene",
    )
    return found.by + by_film.sum() * film_by


def by_torch(lens: rc.Lens, origins: np.ndarray, directions: np.ndarray) -> Callable[[], np.ndarray]:
    """Returns a function that computes the same gradient by PyTorch. Raises ImportError without torch."""
    import torch

    torch.set_num_threads(1)  # a thread that waits for the others would count as busy
    surfaces = lens.surfaces
    refracting = [i for i, s in enumerate(surfaces) if s.type == "refracting"]
    nm = lens.wavelength_nm
    glass = [i for i in refracting if surfaces[i].material.index(nm) > 1.1]
    start, start_directions = torch.from_numpy(origins), torch.from_numpy(directions)

    def gradient() -> np.ndarray:
        numbers = {  # curvatures, thicknesses and indices
            "c": torch.tensor(
                [surfaces[i].curvature_per_mm for i in refracting], dtype=torch.float64, requires_grad=True
            ),
            "t": torch.tensor([s.thickness_mm for s in surfaces[:-1]], dtype=torch.float64, requires_grad=True),
            "n": torch.tensor([surfaces[i].material.index(nm) for i in glass], dtype=torch.float64, requires_grad=True),
        }
        # Ray origins (N, 3) in the frame of the current surface's vertex, directions (N, 3), and the index before it.
        o, d, before = start, start_directions, torch.tensor(1.0, dtype=torch.float64)
        for i, surface in enumerate(surfaces):
            if i > 0:
                o = torch.stack([o[:, 0], o[:, 1], o[:, 2] - numbers["t"][i - 1]], 1)
            if surface.type != "refracting":
                o = o - (o[:, 2:] / d[:, 2:]) * d
                continue
            c = numbers["c"][refracting.index(i)]
            f = c * (o * o).sum(1) - 2 * o[:, 2]
            g = d[:, 2] - c * (o * d).sum(1)
            t = f / (g + torch.sqrt(g * g - c * f))
            o = o + t[:, None] * d
            normal = torch.stack([-c * o[:, 0], -c * o[:, 1], 1 - c * o[:, 2]], 1)
            after = numbers["n"][glass.index(i)] if i in glass else torch.tensor(1.0, dtype=torch.float64)
            mu, cosine = before / after, (d * normal).sum(1)
            d = mu * d + (torch.sqrt(1 - mu * mu * (1 - cosine * cosine)) - mu * cosine)[:, None] * normal
            before = after
        points = o[:, :2] + ((lens.film_distance_mm - o[:, 2]) / d[:, 2])[:, None] * d[:, :2]
        rms = torch.sqrt(((points - points.mean(0)) ** 2).sum(1).mean())
        rms.backward()
        return np.concatenate([numbers[name].grad.numpy() for name in "ctn"])  # type: ignore[union-attr]

    return gradient


def best_cpu_ms(work: Callable[[], object], repeats: int = 40) -> float:
    """Smallest CPU time of several runs, ms."""
    times = []
    for _ in range(repeats):
        begin = time.process_time()
        work()
        times.append(time.process_time() - begin)
    return 1e3 * min(times)


def main() -> None:
    lens = rc.Lens.load("double-gauss-50mm")
    variables = variables_of(lens)
    for count in (128, 1024, 16384):
        angle, radius = 2.399963 * np.arange(count), 10 * np.sqrt((np.arange(count) + 0.5) / count)
        origins = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.zeros(count)])
        directions = np.tile([0.0, np.sin(0.03), np.cos(0.03)], (count, 1))
        ours = by_realcam(lens, variables, origins, directions)
        ms = best_cpu_ms(lambda: by_realcam(lens, variables, origins, directions))  # noqa: B023
        line = f"{count} rays, {len(variables)} variables: realcam {ms:.2f} ms"
        try:
            theirs = by_torch(lens, origins, directions)
        except ImportError:
            print(line + "; PyTorch is not installed")
            continue
        difference = np.abs(theirs() - ours).max() / np.abs(ours).max()
        torch_ms = best_cpu_ms(theirs)
        print(line + f", PyTorch {torch_ms:.2f} ms ({torch_ms / ms:.1f} times), gradients differ by {difference:.1e}")


if __name__ == "__main__":
    main()
