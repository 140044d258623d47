"""The pages of the API in C++: what the headers of realcam::optics document, a page for each of their folders.

The comments are read as they stand. A declaration ends where its body begins, and a class is shown with its public
members, without their bodies. Namespaces named ..._detail and what has no comment of its own are left out.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from written import remove_others, write_text

ROOT = Path(__file__).resolve().parents[2]
SOURCES = ROOT / "cpp"
# Macros and attributes, which only compilers need.
_MACRO = re.compile(r"\b(?!REALCAM_NAMESPACE)REALCAM_\w+\s+|(?<=\s)\[\[.*?\]\]\s|\[\[.*?\]\]")
_LAMBDA = re.compile(r"\[[&=\w\s,]*\]\s*\([^()]*\)\s*\{")
_TYPE = re.compile(r"^(?:template\s*<.*>\s*)?(?:typedef\s+)?(struct|class|union|enum(?:\s+class)?)\s+(\w+)", re.DOTALL)
_OPERATOR = re.compile(r"operator\s*[^\w\s(]+")
# The beginning of a constructor's member initialiser list.
_MEMBERS = re.compile(r"\)((?:\s*(?:const|noexcept))*)\s*:(?!:)")


class Item(NamedTuple):
    """A documented declaration. text: the comment, in paragraphs."""

    name: str
    declaration: str
    text: str


def folders() -> dict[str, str]:
    """Returns the folders of realcam::optics with their contents according to ARCHITECTURE.md."""
    listed = (ROOT / "cmake" / "RealcamOptics.cmake").read_text(encoding="utf-8")
    core = re.search(r"set\(REALCAM_CORE_FOLDERS (.*?)\)", listed)
    assert core
    architecture = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
    contents = {".": "errors, and how long computations are stopped"}
    for name in core[1].split():
        inside = re.search(rf"\| in `cpp/{name}` \| \|\n\|---\|---\|\n((?:\|.*\n)+)", architecture)
        rows = [
            (part, row[1])
            for row in re.findall(r"\| (`.*?`) \| (.*?) \|", inside[1] if inside else "")
            for part in re.findall(r"`(\w+)`", row[0])
        ]
        whole = re.search(rf"\| `cpp/{name}` \| (.*?) \|", architecture)
        assert whole, name
        contents |= {f"{name}/{part}": text for part, text in rows} or {name: whole[1]}
    return contents


def items_of(header: str) -> Iterator[Item]:
    """The documented declarations of namespaces in a header's text."""
    lines = _without_details(header).splitlines()
    line = 0
    while line < len(lines):
        if not lines[line].startswith("///"):
            line += 1
            continue
        comment = []
        while line < len(lines) and lines[line].startswith("///"):
            comment.append(lines[line][3:].removeprefix(" "))
            line += 1
        declaration = _declaration("\n".join(lines[line:]))
        if declaration:
            yield Item(_name_of(declaration), declaration, "\n".join(comment))


def _without_details(header: str) -> str:
    """Without namespaces ..._detail, which are not for users."""
    while found := re.search(r"^namespace \w+_detail \{", header, re.MULTILINE):
        header = header[: found.start()] + header[_end_of_block(header, found.end() - 1) :]
    return header


def _declaration(rest: str) -> str:
    """Returns the declaration at the beginning of `rest`, without a function's body."""
    end = _end_of_head(rest)
    if end == len(rest):
        return ""
    head = _MACRO.sub("", rest[:end]).strip()
    if rest[end] == ";":
        name, equals, value = head.partition("=")
        # The body of a lambda is left out like that of a function, and with it the value that it computes.
        return f"{name}= ...;" if equals and _LAMBDA.search(value) else f"{head};"
    if _TYPE.match(head):
        return f"{head} {_MACRO.sub('', _members(rest[end : _end_of_block(rest, end)]))};"
    if "=" in head.rpartition(")")[2] and "(" not in head.partition("=")[0]:  # a constant
        value = rest[end : _end_of_block(rest, end)]
        return f"{head} {value if value.count(chr(10)) < 4 else '{ ... }'};"
    return f"{_head_of_function(head)};"


def _members(block: str) -> str:
    """The public members of a class's block, without bodies."""
    shown, at = "{", 1
    while at < len(block) - 1:
        if private := re.match(r"\s*(?:private|protected):", block[at:]):
            following = re.search(r"^public:", block[at + private.end() :], re.MULTILINE)
            if not following:
                return shown.rstrip() + "\n}"
            at += private.end() + following.end()
            continue
        end = at + _end_of_head(block[at:])
        if end >= len(block) - 1:
            return shown + block[at:]
        head = block[at:end]
        code = re.sub(r"//.*", "", head).strip()
        if block[end] == ";":
            shown, at = f"{shown}{head};", end + 1
            continue
        after = _end_of_block(block, end)
        if _TYPE.match(code):
            shown += f"{head}{_members(block[end:after])}"
        elif "(" in _OPERATOR.sub("operator", code).partition("=")[0]:
            shown += f"{_head_of_function(head.rstrip())};"
        else:
            shown += block[at:after]
        at = after
    return shown + "}"


def _head_of_function(head: str) -> str:
    """Without the initial values of a constructor's members."""
    if (members := _MEMBERS.search(head)) and "?" not in head[: members.start()]:
        head = head[: members.start()] + ")" + members[1]
    return head


def _end_of_head(text: str) -> int:
    """Returns the position of the first ";" or "{" outside of parentheses; the text's length if there is none.

    Braces that give a member its value belong to it: they come after a name or "=" and before the semicolon.
    """
    depth = at = 0
    while at < len(text):
        if text.startswith("//", at):
            at = text.find("\n", at) % (len(text) + 1)
        elif text[at] in "([":
            depth += 1
        elif text[at] in ")]":
            depth -= 1
        elif depth == 0 and text[at] == ";":
            return at
        elif depth == 0 and text[at] == "{":
            end = _end_of_block(text, at)
            code = re.sub(r"//.*", "", text[:at]).strip()
            is_value = "(" not in code.rpartition("=")[0] and not _TYPE.match(_MACRO.sub("", code)) and code
            if _MEMBERS.search(code) and re.search(r"\w$", code):  # the value of a constructor's member
                at = end
                continue
            if is_value and text[end : end + 1] == ";" and ")" not in code.rpartition("=")[2]:
                return end
            return at
        at += 1
    return len(text)


def _end_of_block(text: str, start: int) -> int:
    """Behind the brace that closes the one at `start`."""
    depth = 0
    for found in re.finditer(r"//[^\n]*|\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])'|[{}]", text[start:]):
        if found[0] == "{":
            depth += 1
        elif found[0] == "}":
            depth -= 1
            if depth == 0:
                return start + found.end()
    return len(text)


def _name_of(declaration: str) -> str:
    code = re.sub(r"//.*", "", declaration)
    if kind := _TYPE.match(code):
        return kind[2]
    head = re.sub(r"^template\s*<.*?>\s*(?=[\w:])", "", code, flags=re.DOTALL)
    if operator := re.search(r"operator\s*[^\s(]+", head):
        return operator[0]
    names = re.findall(r"(\w+)\s*(?=\(|=|;|\{|\[)", head)
    return names[0] if names else head.split()[-1]


def title_of(folder: str) -> str:
    return "realcam" if folder == "." else f"realcam/{folder}"


def file_of(folder: str) -> str:
    return title_of(folder).replace("/", "-")


def page_of(folder: str, contents: str) -> str:
    parts = [f"# {title_of(folder)}\n", f"{contents[0].upper()}{contents[1:]}.\n"]
    for header in sorted((SOURCES / folder).glob("*.hpp")):
        items = list(items_of(header.read_text(encoding="utf-8")))
        if not items:
            continue
        parts.append(f"## {header.name}\n\n```cpp\n#include <realcam/{header.relative_to(SOURCES)}>\n```\n")
        for item in items:
            parts.append(f"### {_escaped(item.name)}\n\n```cpp\n{item.declaration}\n```\n\n{_escaped(item.text)}\n")
    return "\n".join(parts)


def _escaped(text: str) -> str:
    """Plain text as Markdown, in which what stands between backticks stays."""
    pieces = re.split(r"(`[^`]*`)", text)
    return "".join(piece if piece.startswith("`") else re.sub(r"([\\*_<>\[\]|#~])", r"\\\1", piece) for piece in pieces)


def write(folder: Path) -> None:
    pages = {file_of(name): page_of(name, text) for name, text in folders().items()}
    for name, text in pages.items():
        write_text(folder / f"{name}.md", text)
    remove_others(folder, {"index", *pages})
    lines = [
        "# C++\n",
        "What the headers of `realcam::optics` document, by their folders. [The page on realcam in a C++ project]"
        "(../docs/cpp.md) has a program to begin with, and [the architecture](../ARCHITECTURE.md) the map.\n",
        *(f"- [{title_of(name)}]({file_of(name)}.md): {text}" for name, text in folders().items()),
        "\n```{toctree}\n:hidden:\n",
        *pages,
        "```\n",
    ]
    write_text(folder / "index.md", "\n".join(lines))
