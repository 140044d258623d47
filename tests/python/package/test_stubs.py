"""The stub of the extension agrees with the extension, and the package passes mypy in strict mode."""

from __future__ import annotations

import ast
import inspect
import re
import subprocess
import sys
from pathlib import Path

import pytest
import realcam
from realcam import _core

ROOT = Path(__file__).resolve().parents[3]
STUB = Path(realcam.__file__).with_name("_core.pyi")
TREE = ast.parse(STUB.read_text(encoding="utf-8"))
# Private ones are for type checkers alone.
CLASSES = {node.name: node for node in TREE.body if isinstance(node, ast.ClassDef) and not node.name.startswith("_")}

# A parameter: its name, whether it is given by name only, and whether it has a default.
Parameter = tuple[str, bool, bool]


def stub_parameters(node: ast.FunctionDef) -> list[Parameter]:
    arguments = node.args
    positional = [*arguments.posonlyargs, *arguments.args]
    required = len(positional) - len(arguments.defaults)
    found = [(a.arg, False, i >= required) for i, a in enumerate(positional)]
    return found + [
        (a.arg, True, default is not None)
        for a, default in zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True)
    ]


def documented_parameters(function: object) -> list[Parameter]:
    """From the first line of the docstring, where pybind11 writes the signature in Python's own syntax; of what Python
    adds to a class, from the function itself. Static functions of pybind11 are wrapped by functions of Python."""
    function = getattr(function, "__wrapped__", function)
    if inspect.isfunction(function):
        parameters = inspect.signature(function).parameters.values()
        return [(p.name, p.kind is p.KEYWORD_ONLY, p.default is not p.empty) for p in parameters]
    line = (inspect.getdoc(function) or "").splitlines()[0]
    # Defaults are written as their repr, which need not be Python: lenses, infinity.
    line = re.sub(r"<[^<>]*>", "None", line)
    tree = ast.parse(f"def {line}: ...".replace("self: ", "self:"))
    node = tree.body[0]
    assert isinstance(node, ast.FunctionDef)
    return stub_parameters(node)


def names_of(owner: object) -> set[str]:
    return {name for name in vars(owner) if not name.startswith("_")}


def members_in_stub(node: ast.ClassDef) -> dict[str, ast.FunctionDef]:
    return {item.name: item for item in node.body if isinstance(item, ast.FunctionDef)}


def test_the_stub_is_packaged() -> None:
    assert STUB.is_file()
    assert STUB.with_name("py.typed").is_file()


def test_the_module_has_the_names_of_the_stub() -> None:
    functions = {node.name for node in TREE.body if isinstance(node, ast.FunctionDef)}
    assert {name for name in functions if not name.startswith("_")} | set(CLASSES) == names_of(_core)
    for name in functions:
        assert callable(getattr(_core, name)), name


def test_all_that_the_package_offers_exists() -> None:
    assert len(realcam.__all__) == len(set(realcam.__all__))
    for name in realcam.__all__:
        assert hasattr(realcam, name), name


@pytest.mark.parametrize("name", sorted(CLASSES))
def test_a_class_has_the_members_of_its_stub(name: str) -> None:
    real, node = getattr(_core, name), CLASSES[name]
    assert isinstance(real, type)
    if issubclass(real, Exception):
        # The bases too: callers catch by them.
        bases = [base.id for base in node.bases if isinstance(base, ast.Name)]
        assert bases == [base.__name__ for base in real.__bases__]
        return
    if issubclass(real, int):
        values = {item.targets[0].id: item.value.value for item in node.body if isinstance(item, ast.Assign)}
        assert values == {member.name: member.value for member in real}
        return
    if issubclass(real, tuple):
        fields = [item.target.id for item in node.body if isinstance(item, ast.AnnAssign)]
        assert fields == list(real._fields)
        return
    members = members_in_stub(node)
    assert {member for member in members if not member.startswith("_")} == names_of(real)
    for member, definition in members.items():
        decorators = {d.id for d in definition.decorator_list if isinstance(d, ast.Name)}
        actual = inspect.getattr_static(real, member)
        assert ("property" in decorators) == isinstance(actual, property), member
        assert ("staticmethod" in decorators) == isinstance(actual, staticmethod), member
        if "property" in decorators:
            continue
        assert stub_parameters(definition) == documented_parameters(getattr(real, member)), member


FUNCTIONS = [node for node in TREE.body if isinstance(node, ast.FunctionDef)]


@pytest.mark.parametrize("node", FUNCTIONS, ids=lambda node: node.name)
def test_a_function_has_the_parameters_of_its_stub(node: ast.FunctionDef) -> None:
    assert stub_parameters(node) == documented_parameters(getattr(_core, node.name))


def test_every_public_function_says_what_it_does() -> None:
    """pybind11's signature, and at least one line of text."""
    for name in names_of(_core):
        thing = getattr(_core, name)
        text = inspect.getdoc(thing) or ""
        lines = text.splitlines()
        assert len(lines) >= (1 if isinstance(thing, type) else 2), name


def run(*command: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", *command], cwd=ROOT, capture_output=True, text=True, check=False)


# What pybind11 makes of every class, which no stub says.
PYBIND11 = re.compile(r"metaclass differs$|__init__ is inconsistent, stub does not have \*args parameter")


@pytest.mark.slow
def test_stubtest_passes(monkeypatch: pytest.MonkeyPatch) -> None:
    """mypy's own comparison of stub and module: names, kinds, and types of constants."""
    pytest.importorskip("mypy", reason="mypy comes with the dev extra")
    monkeypatch.setenv("MYPYPATH", str(ROOT / "python"))
    result = run("mypy.stubtest", "realcam._core", "--concise")
    lines = [line for line in result.stdout.splitlines() if line and not PYBIND11.search(line)]
    assert not lines, "\n".join(lines)
    # It ran: pybind11's own differences are there.
    assert "realcam._core.Camera" in result.stdout, result.stdout + result.stderr
