"""A calibration file, parsed once. Parsed data are plain values; nothing in a file is executed or looked up."""

from __future__ import annotations

import codecs
import json
import os
import re
import xml.etree.ElementTree as ET
from functools import cached_property
from pathlib import Path
from typing import Any, NoReturn

from ...files import record_input
from ..errors import CalibrationFileError
from .markup import parsed_xml, parsed_yaml

LARGEST_FILE = 64 << 20  # bytes; nerfstudio's files of tens of thousands of frames stay below it
LARGEST_YAML = 1 << 20  # PyYAML reads some 100 kB a second


class Document:
    """The content of a file. syntax: "json", "xml", "yaml", "usda", "text" or "binary"."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        record_input(path)
        try:
            with self.path.open("rb") as file:
                self.content = file.read(LARGEST_FILE + 1)
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            raise CalibrationFileError(f"{os.fspath(path)}: cannot be read: {reason}") from None
        if len(self.content) > LARGEST_FILE:
            self.fail(f"is larger than {LARGEST_FILE >> 20} MiB, the limit for calibration files")
        if not self.content.removeprefix(codecs.BOM_UTF8).strip():
            self.fail("is empty")

    def fail(self, reason: str) -> NoReturn:
        """Raises CalibrationFileError with the file's name in front of the reason."""
        raise CalibrationFileError(f"{self.path}: {reason}")

    @property
    def suffix(self) -> str:
        """Suffix of the file name in lower case, with its dot."""
        return self.path.suffix.lower()

    @cached_property
    def text(self) -> str:
        """The content as text."""
        try:
            return self.content.decode("utf-8-sig")
        except UnicodeDecodeError as error:
            self.fail(f"byte {error.start} is not UTF-8 text")

    @cached_property
    def syntax(self) -> str:
        """The syntax of the content, by its first characters."""
        if b"\0" in self.content[:4096] or not _is_text(self.content):
            return "binary"
        start = self.text.lstrip()
        if start.startswith("#usda"):
            return "usda"
        if start.startswith(("{", "[")):
            return "json"
        if start.startswith("<"):
            return "xml"
        first = next((line for line in start.splitlines() if line.strip() and not line.startswith(("#", "%"))), "")
        return "yaml" if re.match(r"(---|[\w\"'./ -]+:(\s|$))", first) else "text"

    @cached_property
    def data(self) -> Any:
        """The values of a JSON or YAML file; None for other syntaxes, such as XML."""
        if self.syntax == "json":
            return self._json()
        if self.syntax == "yaml":
            if len(self.content) > LARGEST_YAML:
                self.fail(f"is larger than {LARGEST_YAML >> 20} MiB, the limit for YAML files")
            return parsed_yaml(self.text, self.fail)
        return None

    @cached_property
    def xml(self) -> ET.Element:
        """The root element of an XML file."""
        return parsed_xml(self.content, self.fail)

    def mapping(self) -> dict[str, Any]:
        """Returns the data if they are a mapping, and an empty one otherwise."""
        return self.data if isinstance(self.data, dict) else {}

    def _json(self) -> Any:
        try:
            return json.loads(self.text)
        except json.JSONDecodeError as error:
            self.fail(f"line {error.lineno}: {error.msg}")
        except (RecursionError, ValueError):
            self.fail("holds values that are nested too deeply, or a number that is too long")


def _is_text(content: bytes) -> bool:
    try:
        content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return False
    return True
