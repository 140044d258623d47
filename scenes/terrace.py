"""What lies behind the table: a terrace at dusk, a house, and garlands of lamps."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pictures
from glb import Glb
from shapes import Mesh, ball, box, disc, joined, lathe, quad, rod


def add(glb: Glb, rng: np.random.Generator) -> None:
    stone = glb.material("tiles", roughness=0.6, texture=glb.picture(pictures.png(pictures.tiles(rng))))
    brick = glb.material("bricks", texture=glb.picture(pictures.png(pictures.bricks(rng))))
    dark = glb.material("dark wood", (0.055, 0.035, 0.025), roughness=0.6)
    clay = glb.material("clay", (0.28, 0.105, 0.055))
    leaf = glb.material("leaves", (0.028, 0.065, 0.022), roughness=0.7)
    pane = glb.material("window", emission=(95, 58, 24))

    floor = quad([-9, -0.76, 1], [18, 0, 0], [0, 0, -11], (8, 5))
    wall = quad([-9, -0.76, -9.6], [18, 0, 0], [0, 5, 0], (9, 3))
    glb.place("terrace", glb.mesh("terrace", [(floor, stone), (wall, brick)]))

    bars = [box(0.07, 1.66, 0.08).moved(x, -0.03, 0) for x in (-0.62, 0, 0.62)]
    bars += [box(1.31, 0.07, 0.08).moved(0, y, 0) for y in (-0.05, 0.5, 1.05, 1.6)]
    window = [(quad([-0.6, 0, 0.01], [1.2, 0, 0], [0, 1.6, 0]), pane), (joined(*bars), dark)]
    shape = glb.mesh("window", window)
    for x in (-2.35, 0.55, 3.0):
        glb.place("window", shape, (x, -0.35, -9.55))

    posts = [
        box(0.11, 3.4, 0.11).moved(x, -0.76, z) for x, z in ((-1.72, -4.4), (1.86, -4.4), (-2.5, -7.8), (2.6, -7.8))
    ]
    glb.place("posts", glb.mesh("posts", [(joined(*posts), dark)]))

    glow = glb.material("lantern", emission=(900, 520, 190))
    lantern = joined(
        *(quad([-0.055, 0.02, 0.055], [0.11, 0, 0], [0, 0.17, 0]).turned("y", a) for a in (0, 90, 180, 270))
    )
    cap = joined(box(0.13, 0.02, 0.13), box(0.13, 0.03, 0.13).moved(0, 0.19, 0))
    shape = glb.mesh("lantern", [(lantern, glow), (cap, dark)])
    for x, z, turn in [
        (-2.15, -7.0, 10),
        (-0.42, -8.6, 30),
        (0.62, -6.3, 55),
        (1.3, -8.8, 20),
        (2.9, -8.2, 0),
        (-3.3, -8.9, 0),
    ]:
        glb.place("lantern", shape, (x, -0.76, z), turn)

    pot = lathe(
        [
            (0, 0),
            (0.15, 0),
            None,
            (0.2, 0.36),
            None,
            (0.225, 0.36),
            None,
            (0.225, 0.42),
            None,
            (0.17, 0.42),
            None,
            (0, 0.38),
        ],
        32,
    )
    for number, (x, z, size) in enumerate([(-1.15, -5.4, 1.0), (2.15, -6.2, 1.25), (-3.1, -8.3, 1.4)]):
        crown = [
            ball(float(r), 12).moved(*(float(v) for v in p))
            for r, p in zip(
                rng.uniform(0.1, 0.2, 26) * size,
                rng.normal(0, 0.19, (26, 3)) * size + [0, 0.95 * size, 0],
                strict=True,
            )
        ]
        trunk = box(0.04, 0.8 * size, 0.04)
        glb.place(
            f"tree {number}",
            glb.mesh(f"tree {number}", [(pot, clay), (joined(*crown), leaf), (trunk, dark)]),
            (x, -0.76, z),
        )


def add_garlands(glb: Glb, rng: np.random.Generator) -> None:
    """Lamps on slack cables. Flat, and turned to the table: round ones would look the same from there, and
    waste most of the light samples of a renderer on what no one sees."""
    cable = glb.material("cable", (0.02, 0.02, 0.02))
    warm = glb.material("lamp warm", emission=(3000, 1950, 900))
    amber = glb.material("lamp amber", emission=(2600, 1150, 280))
    cool = glb.material("lamp cool", emission=(900, 1500, 2300))
    rose = glb.material("lamp rose", emission=(2300, 620, 760))
    lamps: dict[int, list[Mesh]] = {warm: [], amber: [], cool: [], rose: []}
    cables = []
    for start, end, slack, count, radius, mix in [
        ((-1.72, 1.02, -4.3), (1.86, 1.10, -4.3), 0.55, 11, 0.020, 0.0),
        ((-2.5, 1.30, -7.7), (1.86, 1.10, -4.3), 0.50, 11, 0.026, 0.1),
        ((-1.72, 1.02, -4.3), (2.6, 1.42, -7.7), 0.62, 11, 0.026, 0.1),
        ((-3.6, 1.20, -9.2), (3.6, 1.34, -9.2), 0.72, 17, 0.033, 0.35),
        ((-3.4, 0.10, -9.3), (3.8, 0.18, -9.3), 0.26, 19, 0.022, 0.9),
    ]:
        t = np.linspace(0, 1, 60)[:, None]
        curve = (1 - t) * np.array(start) + t * np.array(end)
        curve[:, 1] -= 4 * slack * (t * (1 - t))[:, 0]
        cables += [rod(a, b, 0.006) for a, b in pairwise(curve)]
        for i in range(count):
            s = (i + 0.5) / count
            at = np.array([np.interp(s, t[:, 0], curve[:, k]) for k in range(3)])
            colours = [warm, amber, cool, rose]
            material = warm if rng.random() > mix else colours[int(rng.integers(1, 4))]
            lamps[material].append(disc(radius).moved(at[0], at[1] - radius - 0.012, at[2] + 0.012))
    parts = [(joined(*meshes), material) for material, meshes in lamps.items() if meshes]
    glb.place("garlands", glb.mesh("garlands", [(joined(*cables), cable), *parts]))
