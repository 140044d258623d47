"""Mutations of text files for the fuzz targets in Python."""

from __future__ import annotations

import random
import re
from collections.abc import Sequence

NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


def mutated(text: str, draw: random.Random, words: re.Pattern[str], extremes: Sequence[str]) -> str:
    """Returns the text with a number, a word, a line or a few characters changed.

    words: pattern of the words that are exchanged. extremes: texts that take the place of numbers.
    """
    lines = text.splitlines() or [""]
    at = draw.randrange(len(lines))
    match draw.randrange(6):
        case 0 | 1:
            numbers = list(NUMBER.finditer(text))
            found = draw.choice(numbers) if numbers else None
            return text if not found else text[: found.start()] + draw.choice(extremes) + text[found.end() :]
        case 2:
            known = words.findall(text)
            return text.replace(draw.choice(known), draw.choice(known), 1) if known else text
        case 3:
            del lines[at]
        case 4:
            lines.insert(at, draw.choice(lines))
        case _:
            start = draw.randrange(len(text) or 1)
            return text[:start] + text[start + draw.randint(1, 20) :]
    return "\n".join(lines)
