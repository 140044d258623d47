"""Parsers of XML and YAML that refuse what could grow without limit: entities, aliases and deep nesting."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections.abc import Callable
from typing import Any, NoReturn
from xml.parsers import expat

from ..._core import InputError

Fail = Callable[[str], NoReturn]

DEEPEST = 64  # nested elements


def parsed_xml(content: bytes, fail: Fail) -> ET.Element:
    """Returns the root element. Entities are refused; external ones are never loaded. Prefixes of names stay."""
    builder = ET.TreeBuilder()
    parser = expat.ParserCreate()
    depth = 0

    def start(name: str, attributes: dict[str, str]) -> None:
        nonlocal depth
        depth += 1
        if depth > DEEPEST:
            fail(f"line {parser.CurrentLineNumber}: more than {DEEPEST} nested elements")
        builder.start(name, attributes)

    def end(name: str) -> None:
        nonlocal depth
        depth -= 1
        builder.end(name)

    def entity(*_: object) -> None:
        fail(f"line {parser.CurrentLineNumber}: declares an entity, which calibrations do not need")

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.CharacterDataHandler = builder.data
    parser.EntityDeclHandler = entity
    try:
        parser.Parse(content, True)
    except expat.ExpatError as error:
        fail(f"line {error.lineno}: {expat.ErrorString(error.code)}")
    return builder.close()


def parsed_yaml(text: str, fail: Fail) -> Any:
    """Returns the first document of a YAML text, with OpenCV's tags as mappings. Raises InputError without PyYAML."""
    try:
        import yaml
    except ImportError:
        raise InputError("reading YAML files needs PyYAML; pip install 'realcam[calibration]'") from None

    class Loader(yaml.SafeLoader):  # type: ignore[misc]
        def compose_node(self, parent: Any, index: Any) -> Any:
            if self.check_event(yaml.AliasEvent):
                mark = self.peek_event().start_mark
                raise yaml.MarkedYAMLError(problem="an alias, which calibrations do not need", problem_mark=mark)
            return super().compose_node(parent, index)

    Loader.add_multi_constructor(
        "tag:yaml.org,2002:opencv", lambda loader, _, node: loader.construct_mapping(node, deep=True)
    )
    # OpenCV before 3.3 writes the directive %YAML:1.0, which is not valid YAML.
    loader = Loader(re.sub(r"\A%YAML[^\n]*\n", "\n", text))
    try:
        return loader.get_data()
    except yaml.MarkedYAMLError as error:
        line = f"line {error.problem_mark.line + 1}: " if error.problem_mark else ""
        fail(f"{line}{error.problem}".replace("\n", " "))
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        fail(f"is not valid YAML: {error!s:.80}".replace("\n", " "))
    finally:
        loader.dispose()
