"""Texts of calibration files that are written. Numbers have as many digits as their last bit needs."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any
from xml.sax.saxutils import escape, quoteattr

import numpy as np


def number(value: float) -> str:
    """Returns a number with a point or without an exponent, as YAML 1.1 needs it: 1.0e-05 instead of 1e-05."""
    text = repr(float(value)) if not isinstance(value, int | np.integer) else str(int(value))
    mantissa, exponent, power = text.partition("e")
    return f"{mantissa}.0e{power}" if exponent and "." not in mantissa else text


def numbers(values: Any) -> str:
    """Returns numbers of an array or list of any shape, separated by blanks."""
    return " ".join(map(number, np.asarray(values, dtype=float).ravel()))


def plain(value: Any) -> Any:
    """Returns a value with lists in place of arrays, for JSON and YAML."""
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    if isinstance(value, Mapping):
        return {str(key): plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [plain(entry) for entry in value]
    return value


def json_content(values: Any) -> bytes:
    """Returns a JSON file."""
    return (json.dumps(plain(values), indent=1) + "\n").encode()


def yaml_content(values: Mapping[str, Any], head: str = "") -> bytes:
    """Returns a YAML file with a mapping. head: lines in front of it."""
    return (head + "\n".join(_yaml_lines(plain(values), "")) + "\n").encode()


def _yaml_lines(values: Mapping[str, Any], indent: str) -> list[str]:
    lines = []
    for key, value in values.items():
        if isinstance(value, Mapping) and value:
            lines += [f"{indent}{_yaml_scalar(key)}:", *_yaml_lines(value, f"{indent}  ")]
        else:
            lines.append(f"{indent}{_yaml_scalar(key)}: {_yaml_flow(value)}")
    return lines


def _yaml_flow(value: Any) -> str:
    if isinstance(value, list):
        return f"[{', '.join(map(_yaml_flow, value))}]"
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_yaml_scalar(key)}: {_yaml_flow(entry)}" for key, entry in value.items()) + "}"
    return _yaml_scalar(value)


def _yaml_scalar(value: Any) -> str:
    if value is None or isinstance(value, bool):
        return json.dumps(value)
    if isinstance(value, int | float):
        return number(value)
    text = str(value)
    # A text in double quotes means the same in JSON and in YAML; a plain word needs no quotes.
    is_word = text.isascii() and text.replace("_", "a").isidentifier() and text.lower() not in _YAML_WORDS
    return text if is_word else json.dumps(text)


_YAML_WORDS = ("y", "n", "yes", "no", "true", "false", "on", "off", "null", "nan", "inf")


def xml_elements(values: Mapping[str, Any], indent: str) -> str:
    """Returns one line with an XML element for each value."""
    return "".join(f"{indent}<{key}>{escape(xml_text(value))}</{key}>\n" for key, value in values.items())


def xml_attributes(values: Mapping[str, Any]) -> str:
    """Returns attributes of an XML element, with a blank in front of each."""
    return "".join(f" {key}={quoteattr(xml_text(value))}" for key, value in values.items())


def xml_text(value: Any) -> str:
    """Returns a value as the text of an XML element, not escaped. Characters that XML forbids are left out."""
    if isinstance(value, str):
        return "".join(c for c in value if c >= " " or c in "\t\n")
    if isinstance(value, Sequence | np.ndarray):
        return numbers(value)
    return number(value)
