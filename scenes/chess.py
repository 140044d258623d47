"""The chess board and its pieces."""

from __future__ import annotations

import numpy as np
from glb import Glb
from shapes import Mesh, ball, box, joined, lathe, quad

SQUARE = 0.045
THICKNESS = 0.016
TURN_DEG = 24.0
MIDDLE = (0.0, 0.0, -0.045)

# Profiles in millimetres, from below upwards; None is a sharp edge.
BASE = [
    (0, 0),
    (17, 0),
    None,
    (17.6, 1.6),
    (17.2, 4),
    None,
    (15.4, 4.6),
    (15.2, 6.2),
    (16, 8),
    (14.6, 10.4),
    (11, 13),
]
PAWN = [*BASE, (7.6, 18), (5.6, 26), (5.2, 32), None, (8.8, 33), (9, 34.6), (6, 36), None]
STEM = [*BASE, (9.4, 17), (7.2, 26), (6.2, 38), (6.0, 50)]
COLLAR = [
    None,
    (10, 51),
    (10.6, 52.6),
    (8, 54.4),
    None,
    (7.2, 55),
    None,
    (9, 56),
    (9.2, 57.4),
    (7, 58.6),
    None,
]
BISHOP = [
    *STEM,
    *COLLAR,
    (6.4, 59),
    (9.4, 65),
    (9.2, 70),
    (6.2, 76),
    (2.4, 80.2),
    None,
    (3.0, 82.4),
    (2.2, 84.6),
    (0, 85.4),
]
ROOK = [*BASE, (11, 17), (9.4, 26), (8.8, 38), None, (11.6, 39.6), (12, 42), None, (11, 43), None, (12.4, 52),
        None, (9, 52), None, (8.6, 47), None, (0, 47)]  # fmt: skip
QUEEN = [*STEM, *COLLAR, (6.2, 60), (7, 70), (11.4, 84), None, (10, 85), (7.6, 82.6), (6, 84.4), (0, 88)]
KING = [*STEM, *COLLAR, (6.4, 60), (7.4, 72), (11, 86), None, (11.4, 87.4), (9.6, 89.4), (5, 92), (0, 93)]


def turned(profile: list[tuple[float, float] | None], scale: float = 1.0) -> Mesh:
    points = [None if p is None else (p[0] * 0.001 * scale, p[1] * 0.001 * scale) for p in profile]
    return lathe(points, 44, 4)


def king() -> Mesh:
    upright = box(0.0042, 0.0165, 0.0036).moved(0, 0.0915, 0)
    across = box(0.0125, 0.0044, 0.0036).moved(0, 0.0985, 0)
    return joined(turned(KING), upright, across)


def queen() -> Mesh:
    angles = np.linspace(0, 2 * np.pi, 9)[:-1]
    pearls = [ball(0.0021, 14).moved(0.0105 * float(np.cos(a)), 0.0858, 0.0105 * float(np.sin(a))) for a in angles]
    return joined(turned(QUEEN), ball(0.0036, 20).moved(0, 0.0905, 0), *pearls)


def rook() -> Mesh:
    merlons = [
        box(0.0046, 0.0052, 0.0034).moved(0, 0.052, 0.0107).turned("y", angle) for angle in np.arange(0, 360, 60)
    ]
    return joined(turned(ROOK), *merlons)


def pawn() -> Mesh:
    return joined(turned(PAWN), ball(0.0088, 32).moved(0, 0.0435, 0))


def board(glb: Glb) -> int:
    light = glb.material("light squares", (0.60, 0.46, 0.29), roughness=0.3)
    dark = glb.material("dark squares", (0.085, 0.034, 0.018), roughness=0.3)
    frame = glb.material("frame", (0.115, 0.045, 0.022), roughness=0.28)
    squares: list[list[Mesh]] = [[], []]
    for row in range(8):
        for column in range(8):
            corner = [(column - 4) * SQUARE, THICKNESS, (row - 3) * SQUARE]
            squares[(row + column) % 2].append(quad(corner, [SQUARE, 0, 0], [0, 0, -SQUARE]))
    width = 8 * SQUARE
    rim = 0.018
    sides = [
        box(width + 2 * rim, THICKNESS + 0.0012, rim).moved(0, 0, side * (width + rim) / 2) for side in (-1, 1)
    ] + [box(rim, THICKNESS + 0.0012, width).moved(side * (width + rim) / 2, 0, 0) for side in (-1, 1)]
    return glb.mesh("board", [(joined(*squares[0]), light), (joined(*squares[1]), dark), (joined(*sides), frame)])


def on_square(column: float, row: float) -> tuple[float, float, float]:
    """Middle of a square, columns and rows from -3.5 to 3.5, rows away from the camera."""
    angle = np.radians(TURN_DEG)
    x, z = column * SQUARE, -row * SQUARE
    return (
        MIDDLE[0] + x * float(np.cos(angle)) + z * float(np.sin(angle)),
        THICKNESS,
        MIDDLE[2] - x * float(np.sin(angle)) + z * float(np.cos(angle)),
    )


def add(glb: Glb) -> None:
    ivory = glb.material("ivory", (0.80, 0.70, 0.52), roughness=0.24)
    ebony = glb.material("ebony", (0.030, 0.020, 0.016), roughness=0.2)
    glb.place("board", board(glb), MIDDLE, TURN_DEG)
    shapes = {"king": king(), "queen": queen(), "rook": rook(), "bishop": turned(BISHOP), "pawn": pawn()}
    colours = {"ivory": ivory, "ebony": ebony}
    meshes: dict[str, int] = {}
    for name, column, row in [
        ("ivory king", 0.5, -2.5),
        ("ivory pawn", -0.5, -1.5), ("ivory pawn", 1.5, -0.5), ("ivory pawn", 2.5, -1.5),
        ("ivory queen", 0.5, -0.5), ("ivory pawn", -2.5, -1.5),
        ("ivory rook", 2.5, -3.5), ("ivory bishop", -1.5, -2.5),
        ("ebony queen", -1.5, 1.5), ("ebony king", 1.5, 3.5),
        ("ebony rook", 3.5, 3.5), ("ebony bishop", 2.5, 1.5),
        ("ebony pawn", 0.5, 1.5), ("ebony pawn", -2.5, 2.5),
        ("ebony pawn", 3.5, 1.5), ("ebony pawn", -0.5, 2.5),
        ("ebony rook", -3.5, 3.5),
    ]:  # fmt: skip
        colour, kind = name.split()
        if name not in meshes:
            meshes[name] = glb.mesh(name, [(shapes[kind], colours[colour])])
        glb.place(name, meshes[name], on_square(column, row), TURN_DEG)
    # Out of the game, beside the board.
    lying = pawn().turned("z", 82).turned("y", -35).moved(0, 0.0135, 0)
    glb.place("ebony pawn, taken", glb.mesh("pawn, taken", [(lying, ebony)]), (0.145, 0, 0.235))
