"""No two modules of the Python package need each other, neither directly nor by way of others; and its core, the
modules directly in python/realcam, needs none of the packages of tools, the folders beside them.
"""

from __future__ import annotations

import ast
import subprocess
import sys
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

PYTHON = Path(__file__).resolve().parents[2] / "python"
TOOLS = {f"realcam.{folder.parent.name}" for folder in (PYTHON / "realcam").glob("*/__init__.py")}
# Libraries that only tools use, or only some functions of the core; each takes longer to import than the core.
LIBRARIES = {"matplotlib", "scipy", "rich", "typer", "OpenImageIO"}


def modules_of(root: Path) -> dict[str, Path]:
    """Names and files of modules, extensions by their stubs."""
    found = {}
    for path in sorted(root.rglob("*.py*")):
        if path.suffix in (".py", ".pyi"):
            parts = path.relative_to(root).with_suffix("").parts
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imported_by(name: str, path: Path, modules: dict[str, Path]) -> set[str]:
    """The members of `modules` that a module imports, including imports in functions and for type checkers.

    Parent packages that an import loads implicitly do not count, because otherwise every module would need `realcam`.
    """
    package = name.split(".") if path.stem == "__init__" else name.split(".")[:-1]
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            above = package[: len(package) + 1 - node.level] if node.level else []
            base = ".".join([*above, *([node.module] if node.module else [])])
            members = {f"{base}.{alias.name}" for alias in node.names}
            found |= members & modules.keys()
            if members - modules.keys():
                found.add(base)
    return (found & modules.keys()) - {name}


def imports_under(root: Path) -> dict[str, set[str]]:
    modules = modules_of(root)
    # A stub names the types that Python gives to an extension, which is below all of Python.
    return {name: imported_by(name, path, modules) for name, path in modules.items() if path.suffix == ".py"}


def circle_in(imports: dict[str, set[str]]) -> list[str] | None:
    try:
        TopologicalSorter(imports).prepare()
    except CycleError as error:
        return list(reversed(error.args[1]))
    return None


def test_python_modules_import_in_one_direction() -> None:
    imports = imports_under(PYTHON)
    assert "realcam.image" in imports["realcam.render"]
    circle = circle_in(imports)
    assert circle is None, " imports ".join(circle or ())


@pytest.mark.parametrize(
    "text",
    [
        "from .a import f",
        "from . import a",
        "import lib.a",
        "from lib import a",
        "def f():\n    from .a import g",
        "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from . import a",
    ],
)
def test_a_circle_is_found(tmp_path: Path, text: str) -> None:
    files = {
        "__init__": "from .c import f",
        "a": "from ._ext import g\nfrom .b import f",
        "b": "from .c import f",
        "c": text,
    }
    (tmp_path / "lib").mkdir()
    for name, code in files.items():
        (tmp_path / "lib" / f"{name}.py").write_text(code)
    circle = circle_in(imports_under(tmp_path))
    assert circle is not None and set(circle) == {"lib.a", "lib.b", "lib.c"}
    (tmp_path / "lib" / "c.py").write_text("from __future__ import annotations")
    assert circle_in(imports_under(tmp_path)) is None


def test_the_core_imports_no_package_of_tools() -> None:
    """realcam/__init__.py alone names them: for type checkers, and to import them on first use."""
    assert {"realcam.analysis", "realcam.job", "realcam.viewer"} <= TOOLS
    core = {name: users for name, users in imports_under(PYTHON).items() if name.startswith("realcam.")}
    core = {name: users for name, users in core.items() if package_of(name) not in TOOLS}
    assert "realcam.render" in core
    wrong = {name: tools for name, users in core.items() if (tools := {u for u in users if package_of(u) in TOOLS})}
    assert wrong == {}


def package_of(module: str) -> str:
    return ".".join(module.split(".")[:2])


def test_importing_realcam_loads_no_package_of_tools() -> None:
    """Public names of the tools are available nevertheless; their packages are imported on first use."""
    script = """
import sys, realcam as rc
print(*sys.modules)
for name in rc.__all__:
    getattr(rc, name)
rc.Lens.draw, rc.Lens.gradient
print(*sys.modules)
"""
    printed = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True).stdout
    at_first, after_use = (set(line.split()) for line in printed.splitlines())
    assert at_first & (TOOLS | LIBRARIES) == set()
    assert {"realcam.analysis", "realcam.drawing", "realcam.job", "realcam.vision"} <= after_use


def test_no_folder_has_more_than_forty_source_files() -> None:
    folders = [folder for root in (PYTHON, PYTHON.parent / "tests") for folder in (root, *root.rglob("*"))]
    assert {str(f): n for f in folders if f.is_dir() and (n := len([*f.glob("*.py"), *f.glob("*.pyi")])) > 40} == {}
