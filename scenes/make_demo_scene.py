#!/usr/bin/env python3
"""Makes demo.glb: a chess board on a terrace at dusk, made to be photographed with a fast 50 mm lens.

    python scenes/make_demo_scene.py [demo.glb]

Everything comes from formulas and a fixed seed; numpy is all that is needed. Metres, y up, the table top
is y = 0. demo.toml beside this file says where to put the camera and how to expose. What the scene is for:

- depth of field: things stand from 0.7 m to 11 m away, the ivory king 1.05 m from the film;
- bokeh: garlands of lamps at 2.5 to 10 m, far brighter than the table;
- distortion: the lines of the board, the ruler, the posts and the window bars are straight;
- resolution: a card with a Siemens star and line groups stands in the plane of the king.

Lit for about EV 8 at ISO 100 by a large soft lamp overhead, a warm one from the left and a cool one from
behind, all out of the frame. The dusk itself is a constant environment that the caller adds (in
demo.toml, environment_cd_m2).
"""

from __future__ import annotations

import sys
from pathlib import Path

import chess
import numpy as np
import pictures
import terrace
from glb import Glb
from shapes import Mesh, ball, box, joined, lathe, quad

SEED = 20240611


def add_table(glb: Glb, rng: np.random.Generator) -> None:
    wood = glb.material("table", roughness=0.42, texture=glb.picture(pictures.png(pictures.planks(rng))))
    top = quad([-1.1, 0, 0.9], [2.2, 0, 0], [0, 0, -1.75], (2.0, 1.6))
    edge = quad([1.1, -0.04, -0.85], [-2.2, 0, 0], [0, 0.04, 0], (2, 0.03))
    glb.place("table", glb.mesh("table", [(joined(top, edge), wood)]))

    steel = glb.material("ruler", (0.5, 0.5, 0.5), roughness=0.35, texture=glb.picture(pictures.png(pictures.ruler())))
    ruler = quad([0, 0.0012, 0], [0.3, 0, 0], [0, 0, -0.024])
    glb.place("ruler", glb.mesh("ruler", [(ruler, steel)]), (-0.06, 0, 0.325))


def add_chart(glb: Glb) -> None:
    paper = glb.material("chart", roughness=0.8, texture=glb.picture(pictures.png(pictures.test_chart())))
    back = glb.material("card", (0.75, 0.73, 0.68))
    width, height = 0.085, 0.085 * 680 / 480
    card = quad([-width / 2, 0, 0], [width, 0, 0], [0, height, 0]).turned("x", -9)
    stand = box(0.004, 0.09, 0.03).moved(0, 0, -0.038)
    glb.place("chart", glb.mesh("chart", [(card, paper), (stand, back)]), (0.225, 0, 0.075), -11)


def add_cup(glb: Glb) -> None:
    glaze = glb.material("glaze", (0.10, 0.24, 0.30), roughness=0.16)
    coffee = glb.material("coffee", (0.035, 0.014, 0.006), roughness=0.1)
    cup = lathe(
        [
            (0, 0.004), (0.021, 0.004), None, (0.023, 0.006), (0.026, 0.012), (0.0385, 0.03), (0.0415, 0.05),
            (0.0425, 0.068), (0.0418, 0.0695), (0.0405, 0.068), (0.0395, 0.05), (0.036, 0.03), (0.022, 0.011),
            (0, 0.009),
        ],
        64,
    )  # fmt: skip
    saucer = lathe(
        [
            (0, 0), (0.03, 0), None, (0.034, 0.001), (0.055, 0.0065), (0.068, 0.0115), (0.0685, 0.013),
            (0.067, 0.0132), (0.053, 0.0085), (0.03, 0.004), (0, 0.0038),
        ],
        64,
    )  # fmt: skip
    t = np.linspace(0.16, np.pi - 0.16, 25)
    path = np.column_stack([0.039 + 0.026 * np.sin(t), 0.038 - 0.021 * np.cos(t) * -1, np.zeros_like(t)])
    handle = tube(path, 0.0042)
    surface = lathe([(0.0398, 0.055), (0, 0.055)], 64)
    parts = [(joined(cup, saucer, handle), glaze), (surface, coffee)]
    glb.place("cup", glb.mesh("cup", parts), (-0.262, 0, 0.0), 205)


def tube(path: np.ndarray, radius: float, sides: int = 16) -> Mesh:
    """Round, along a curve in a plane of constant z."""
    tangent = np.gradient(path, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    across = np.column_stack([tangent[:, 1], -tangent[:, 0], np.zeros(len(path))])
    angles = np.linspace(0, 2 * np.pi, sides + 1)
    normals = np.cos(angles)[None, :, None] * across[:, None, :] + np.sin(angles)[None, :, None] * np.array([0, 0, 1.0])
    positions = path[:, None, :] + radius * normals
    i, j = np.meshgrid(np.arange(len(path) - 1), np.arange(sides), indexing="ij")
    a = (i * (sides + 1) + j).reshape(-1)
    c = a + sides + 1
    triangles = np.concatenate([np.column_stack([a, c, a + 1]), np.column_stack([a + 1, c, c + 1])])
    edges = positions.reshape(-1, 3)[triangles[0]]
    if np.dot(np.cross(edges[1] - edges[0], edges[2] - edges[0]), normals[0, 0]) < 0:
        triangles = triangles[:, ::-1]
    return Mesh(positions.reshape(-1, 3), normals.reshape(-1, 3), triangles)


def add_old_camera(glb: Glb) -> None:
    """Stands on two books, behind the board."""
    leather = glb.material("leather", (0.022, 0.02, 0.019), roughness=0.55)
    chrome = glb.material("chrome", (0.62, 0.61, 0.59), roughness=0.28, metallic=0.45)
    glass = glb.material("glass", (0.01, 0.012, 0.03), roughness=0.08)
    metal = joined(
        box(0.142, 0.012, 0.036),
        box(0.142, 0.016, 0.036).moved(0, 0.066, 0),
        box(0.044, 0.014, 0.03).moved(0, 0.082, 0),
        lathe([(0.0105, 0.082), None, (0.0105, 0.091), None, (0, 0.091)], 32).moved(0.05, 0, 0),
        lathe([(0.008, 0.082), None, (0.008, 0.094), None, (0, 0.094)], 32).moved(-0.052, 0, 0),
    )
    barrel = [
        (0.031, 0), None, (0.031, 0.012), None, (0.0285, 0.012), None, (0.0285, 0.022), None, (0.030, 0.022),
        None, (0.030, 0.034), None, (0.027, 0.036), None, (0.0235, 0.036), None, (0.021, 0.029),
    ]  # fmt: skip
    lens = lathe(barrel, 64).turned("x", 90).moved(0, 0.041, 0.018)
    front = (
        lathe([(0.0212, 0.028), (0.016, 0.0315), (0.009, 0.0335), (0, 0.0342)], 48)
        .turned("x", 90)
        .moved(0, 0.041, 0.018)
    )
    body = box(0.138, 0.054, 0.033).moved(0, 0.012, 0)
    parts = [(metal, chrome), (body, leather), (lens, chrome), (front, glass)]
    glb.place("old camera", glb.mesh("old camera", parts), (-0.235, 0.052, -0.34), 24)


def add_books(glb: Glb) -> None:
    paper = glb.material("pages", (0.72, 0.66, 0.52))
    covers = {
        "red": (0.30, 0.045, 0.035),
        "blue": (0.04, 0.09, 0.20),
        "green": (0.05, 0.14, 0.075),
        "sand": (0.5, 0.38, 0.2),
    }
    cover = {name: glb.material(f"cover {name}", colour, roughness=0.5) for name, colour in covers.items()}

    def book(name: str, width: float, thickness: float, depth: float) -> int:
        shell = joined(
            box(width, 0.003, depth),
            box(width, 0.003, depth).moved(0, thickness - 0.003, 0),
            box(width, thickness, 0.004).moved(0, 0, depth / 2),
        )
        pages = box(width - 0.01, thickness - 0.006, depth - 0.01).moved(0, 0.003, -0.003)
        return glb.mesh(f"book {name}", [(shell, cover[name]), (pages, paper)])

    glb.place("book 1", book("red", 0.21, 0.028, 0.15), (-0.235, 0, -0.345), 14)
    glb.place("book 2", book("sand", 0.19, 0.024, 0.13), (-0.235, 0.028, -0.345), 20)
    glb.place("book 3", book("blue", 0.22, 0.034, 0.16), (0.36, 0, -0.43), -16)
    glb.place("book 4", book("green", 0.20, 0.026, 0.14), (0.355, 0.034, -0.43), -9)


def add_balls(glb: Glb) -> None:
    shape = ball(1.0)
    for name, colour, roughness, metallic, radius, x, z in [
        ("red ball", (0.55, 0.03, 0.02), 0.12, 0.0, 0.019, -0.20, 0.225),
        ("steel ball", (0.65, 0.66, 0.68), 0.15, 0.6, 0.013, -0.155, 0.262),
        ("amber ball", (0.75, 0.33, 0.03), 0.12, 0.0, 0.015, 0.262, 0.19),
        ("black ball", (0.01, 0.01, 0.012), 0.1, 0.0, 0.026, 0.335, -0.02),
        ("brass ball", (0.75, 0.52, 0.18), 0.2, 0.6, 0.036, 0.355, -0.40),
    ]:
        y = radius + (0.060 if name == "brass ball" else 0.0)
        scaled = Mesh(shape.positions * radius, shape.normals, shape.triangles)
        material = glb.material(name, colour, roughness=roughness, metallic=metallic)
        glb.place(name, glb.mesh(name, [(scaled, material)]), (x, y, z))


def add_lamps(glb: Glb) -> None:
    """Out of the frame."""
    overhead = glb.material("lamp overhead", emission=(1150, 1060, 960))
    left = glb.material("lamp left", emission=(9500, 6900, 4300))
    behind = glb.material("lamp behind", emission=(4600, 5400, 6800))
    soft = quad([-0.6, 1.25, -0.6], [1.2, 0, 0], [0, 0, 1.1])
    key = quad([-0.16, -0.16, 0], [0.32, 0, 0], [0, 0.32, 0]).turned("x", 28).turned("y", 62).moved(-0.95, 0.72, 0.42)
    rim = quad([-0.12, -0.2, 0], [0.24, 0, 0], [0, 0.4, 0]).turned("x", 24).turned("y", 220).moved(0.98, 0.66, -0.82)
    glb.place("lamps", glb.mesh("lamps", [(soft, overhead), (key, left), (rim, behind)]))


def main() -> None:
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).with_name("demo.glb")
    rng = np.random.default_rng(SEED)
    glb = Glb()
    add_table(glb, rng)
    chess.add(glb)
    add_chart(glb)
    add_cup(glb)
    add_books(glb)
    add_old_camera(glb)
    add_balls(glb)
    terrace.add(glb, rng)
    terrace.add_garlands(glb, rng)
    add_lamps(glb)
    glb.write(path)
    print(f"{path}: {path.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
