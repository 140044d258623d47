"""Numbers, arrays and polynomials as OSL source text."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import zip_longest

import numpy as np


def float_text(value: float) -> str:
    """Number with nine digits, which preserve a float32."""
    return f"{value:.9g}"


def array_text(values: Sequence[float] | np.ndarray) -> str:
    """Initialiser of an array, with six digits."""
    return "{" + ", ".join(f"{value:.6g}" for value in values) + "}"


def horner(coefficients: Sequence[float] | np.ndarray, variable: str) -> str:
    """Polynomial in Horner's form. coefficients: the constant first."""
    text = float_text(coefficients[-1])
    for coefficient in reversed(coefficients[:-1]):
        text = f"{float_text(coefficient)} + {variable} * ({text})"
    return text


def estrin(coefficients: Sequence[float] | np.ndarray, variable: str) -> tuple[list[str], str]:
    """Polynomial in Estrin's form, which has shorter chains of dependent operations than Horner's.

    Returns the declarations of the powers that it needs, and the polynomial.
    """
    parts, powers, name, power = [float_text(c) for c in coefficients], [], variable, 1
    while len(parts) > 1:
        if power > 1:
            powers.append(f"float {variable}{power} = {name} * {name};")
            name = f"{variable}{power}"
        pairs = zip_longest(parts[::2], parts[1::2])
        parts = [f"({low} + {name} * {high})" if high else low for low, high in pairs]
        power *= 2
    return powers, parts[0]
