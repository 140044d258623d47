"""Error messages for wrong arguments: signatures in Python's types, and one sentence on the argument at fault.

The extension hands its functions to this module while it is loaded (`explain_wrong_arguments`).
"""

from __future__ import annotations

import ast
import difflib
import functools
import inspect
import operator
import re
import reprlib
from collections.abc import Callable, Mapping, Sequence
from types import ModuleType
from typing import Any

NUMBERS = ("no", "one", "two", "three", "four", "five", "six")
# pybind11's spellings of types (patterns), and the spellings shown to users.
SPELLINGS = (
    (r"typing\.SupportsFloat \| typing\.SupportsIndex", "float"),
    (r"typing\.SupportsInt \| typing\.SupportsIndex", "int"),
    (r"(?:typing\.Annotated\[)?numpy\.typing\.ArrayLike, (?:numpy\.|realcam::)\w+\]", "ArrayLike"),
    (r"numpy\.ndarray\[numpy\.\w+\]", "ArrayLike"),
    (r"numpy\.typing\.NDArray\[numpy\.(\w+)\]", r"NDArray[\1]"),
    (r"realcam\._core\.|collections\.abc\.|typing_extensions\.", ""),
    (r"\(arg0: ", "(self: "),
)
FIXED_SIZE = re.compile(r'(?:typing\.)?Annotated\[(?:Sequence|list)\[(\w+)\], "?FixedSize\((\d)\)"?\]')


def explain_wrong_arguments(core: ModuleType) -> list[type]:
    """Replaces the functions and methods of the extension by Python functions that raise ArgumentError if no signature
    accepts their arguments. Returns the classes of the extension.

    As Python functions they also pickle by their names: executor.map(rc.Lens.load, paths).
    """

    def replace(owner: ModuleType | type, name: str, prefix: str) -> None:
        function = getattr(owner, name)
        function = getattr(function, "__func__", function)
        if not inspect.isbuiltin(function):
            return
        call = _explaining(function, prefix + name, core.ArgumentError)
        is_static = isinstance(inspect.getattr_static(owner, name), staticmethod)
        setattr(owner, name, staticmethod(call) if is_static else call)

    classes = [value for value in vars(core).values() if type(value).__name__ == "pybind11_type"]
    for owner in (core, *classes):
        for name in list(vars(owner)):
            # Special methods are called by Python itself, and _pybind11_conduit_v1_ by other extensions.
            if name == "__init__" or not name.startswith(("__", "_pybind11_")):
                replace(owner, name, f"{owner.__name__}." if isinstance(owner, type) else "")
    return classes


def _explaining(function: Callable[..., Any], qualified_name: str, error_type: type[Exception]) -> Callable[..., Any]:
    """Returns a Python function that calls `function` and converts its TypeError to error_type with a better
    message."""
    doc = cleaned(function.__doc__ or "")

    @functools.wraps(function)
    def call(*arguments: Any, **named: Any) -> Any:
        try:
            return function(*arguments, **named)
        except TypeError as error:
            text = str(error)
            if "(): incompatible " not in text or "Invoked with:" not in text:
                raise
            try:
                problem = complaint(doc, arguments, named)
            except Exception:  # a signature that cannot be parsed, or a repr that fails
                raise error from None
        raise error_type(problem)

    call.__qualname__ = qualified_name
    call.__doc__ = doc
    return call


def cleaned(doc: str) -> str:
    """Returns a docstring of pybind11 with its signature in readable Python types."""
    signature, *rest = doc.split("\n")
    for pattern, spelling in SPELLINGS:
        signature = re.sub(pattern, spelling, signature)
    signature = FIXED_SIZE.sub(lambda m: f"tuple[{', '.join([m[1]] * int(m[2]))}]", signature)
    return "\n".join([signature, *rest])


def complaint(doc: str, arguments: tuple[Any, ...], named: dict[str, Any]) -> str:
    """Returns the error message for a call whose arguments do not match the signature in the docstring."""
    function = _definition(doc.split("\n")[0])
    is_method = function.args.args and function.args.args[0].arg == "self"
    owner = function.args.args[0].annotation if is_method else None
    name = f"{ast.unparse(owner)}()" if owner and function.name == "__init__" else f"{function.name}()"
    parameters = _parameters(function)
    problem = _wrong_names(name, parameters, arguments, named)
    if problem:
        return problem
    bound = inspect.Signature(list(parameters)).bind(*arguments, **named).arguments
    if function.name == "__init__":
        del bound["self"]  # not constructed yet, so it has no repr
    annotations = {p.name: p.annotation for p in parameters}
    for check in (_expected_if_wrong, _out_of_range):
        for argument, value in bound.items():
            expected = check(annotations[argument], value)
            if expected:
                return f"{argument} must be {expected}; it is {_text(value)}"
    return f"{name} cannot take {', '.join(f'{k}={_text(v)}' for k, v in bound.items())}"


def _definition(signature: str) -> ast.FunctionDef:
    """Parses a signature of pybind11. Raises SyntaxError."""
    # Default values appear as their repr, which may not be valid Python, and property getters have no name.
    text = re.sub(r"<[^<>]*>", "None", signature)
    tree = ast.parse(f"def {'property' if text.startswith('(') else ''}{text}: ...")
    node = tree.body[0]
    assert isinstance(node, ast.FunctionDef)
    return node


def _parameters(function: ast.FunctionDef) -> Sequence[inspect.Parameter]:
    """Returns the parameters; their annotations are syntax trees, and all defaults are None."""
    arguments = function.args
    required = len(arguments.args) - len(arguments.defaults)

    def parameter(argument: ast.arg, kind: Any, is_required: bool) -> inspect.Parameter:
        default = inspect.Parameter.empty if is_required else None
        return inspect.Parameter(argument.arg, kind, default=default, annotation=argument.annotation)

    positional = [
        parameter(a, inspect.Parameter.POSITIONAL_OR_KEYWORD, i < required) for i, a in enumerate(arguments.args)
    ]
    by_name = [
        parameter(a, inspect.Parameter.KEYWORD_ONLY, default is None)
        for a, default in zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True)
    ]
    return [*positional, *by_name]


def _counted(count: int) -> str:
    return NUMBERS[count] if count < len(NUMBERS) else str(count)


def _text(value: Any) -> str:
    """Returns a short repr of a value. Reprs of realcam's own objects are short already."""
    try:
        return repr(value) if type(value).__module__.startswith("realcam") else reprlib.repr(value)
    except ValueError:  # Python refuses to print integers of thousands of digits
        return f"one of the type {type(value).__name__}"


def _wrong_names(
    function: str, parameters: Sequence[inspect.Parameter], arguments: tuple[Any, ...], named: dict[str, Any]
) -> str | None:
    """Returns the message if arguments are unknown, duplicate, missing or too many; None if they fit the parameters."""
    positional = [p.name for p in parameters if p.kind is inspect.Parameter.POSITIONAL_OR_KEYWORD]
    names = [p.name for p in parameters]
    for name in named:
        if name not in names:
            near = difflib.get_close_matches(name, names, 1)
            return f"{function} has no argument {name}" + (f"; is {near[0]} meant?" if near else "")
        if name in positional[: len(arguments)]:
            return f"{function} has the argument {name} twice"
    if len(arguments) > len(positional):
        has_self = positional[:1] == ["self"]
        limit, count = len(positional) - has_self, len(arguments) - has_self
        keyword_only = ", ".join(p.name for p in parameters if p.kind is inspect.Parameter.KEYWORD_ONLY)
        return (
            f"{function} takes at most {_counted(limit)} argument{'' if limit == 1 else 's'} without a name, "
            f"and {_counted(count)} are given" + (f"; by name there are {keyword_only}" if keyword_only else "")
        )
    present = {*positional[: len(arguments)], *named}
    missing = [p.name for p in parameters if p.default is inspect.Parameter.empty and p.name not in present]
    return f"{function} needs the argument {' and '.join(missing)}" if missing else None


def _expected_if_wrong(annotation: ast.expr | None, value: Any) -> str | None:
    """Returns the description of the expected type if a value does not match the annotation; None if it does."""
    if isinstance(annotation, ast.BinOp):
        expected = [_expected_if_wrong(side, value) for side in (annotation.left, annotation.right)]
        return f"{expected[0]} or {expected[1]}" if expected[0] and expected[1] else None
    if isinstance(annotation, ast.Constant):  # None
        return None if value is None else "None"
    if isinstance(annotation, ast.Subscript):
        return _expected_items_if_wrong(annotation, value)
    kind = annotation.id if isinstance(annotation, ast.Name) else "object"
    if kind in SCALARS:
        description, fits = SCALARS[kind]
        return None if fits(value) else description
    if kind in UNCHECKED or type(value).__name__ == kind:
        return None
    return f"{'an' if kind[0] in 'AEIO' else 'a'} {kind}"


def _expected_items_if_wrong(annotation: ast.Subscript, value: Any) -> str | None:
    """Implements _expected_if_wrong for annotations with items, such as list[float] or tuple[int, int]."""
    outer = ast.unparse(annotation.value)
    items = annotation.slice.elts if isinstance(annotation.slice, ast.Tuple) else [annotation.slice]
    if outer in ("Optional", "Union"):  # spelling of pybind11 before version 3
        options = [*items, ast.Constant(None)] if outer == "Optional" else items
        expected = [_expected_if_wrong(option, value) for option in options]
        return None if None in expected else " or ".join(map(str, expected))
    if outer in ("Mapping", "dict"):
        return None if isinstance(value, Mapping) and all(_all_fit(items, pair) for pair in value.items()) else "a dict"
    if outer not in ("Sequence", "Iterable", "list", "tuple"):  # the function itself checks the value
        return None
    if outer == "tuple":
        words = SCALARS[ast.unparse(items[0])][0].split(" ", 1)[-1]
        return None if _all_fit(items, value) else f"{NUMBERS[len(items)]} {words}s"
    listed = _listed(value)
    if listed is not None and all(_expected_if_wrong(items[0], item) is None for item in listed):
        return None
    return f"a list of items, each {_expected_if_wrong(items[0], _MatchesNothing())}"


class _MatchesNothing:
    """A value that matches no type, for which _expected_if_wrong returns the description of every type."""


def _listed(value: Any) -> list[Any] | None:
    """Returns the items of an iterable; None for texts and values that are not iterable."""
    if isinstance(value, (str, bytes)):
        return None
    try:
        return list(value)
    except TypeError:
        return None


def _all_fit(annotations: Sequence[ast.expr], value: Any) -> bool:
    listed = _listed(value)
    return (
        listed is not None
        and len(listed) == len(annotations)
        and all(_expected_if_wrong(a, v) is None for a, v in zip(annotations, listed, strict=True))
    )


def _succeeds(convert: Callable[[Any], object], value: Any) -> bool:
    try:
        convert(value)
    except (TypeError, ValueError, OverflowError):
        return False
    return True


def _is_number(value: Any) -> bool:
    return not isinstance(value, (str, bytes)) and _succeeds(float, value)


def _is_array(value: Any) -> bool:
    import numpy as np

    return _succeeds(lambda v: np.asarray(v, dtype=float), value)


# Annotations of values that the function itself converts.
UNCHECKED = ("object", "Any", "DTypeLike")
# Descriptions of types, and functions that return True for a value of the type, by annotation.
SCALARS: dict[str, tuple[str, Callable[[Any], bool]]] = {
    "float": ("a number", _is_number),
    "complex": ("a number", lambda value: not isinstance(value, (str, bytes)) and _succeeds(complex, value)),
    "int": ("a whole number", lambda value: _succeeds(operator.index, value)),
    "bool": ("True or False", lambda value: isinstance(value, bool) or type(value).__name__ in ("bool_", "bool")),
    "str": ("a text", lambda value: isinstance(value, str)),
    "ArrayLike": ("an array of numbers", _is_array),
}


def _out_of_range(annotation: ast.expr | None, value: Any) -> str | None:
    """Returns the permitted range if an int argument exceeds the 32 bits of C++'s int; None if it fits."""
    limit = 2**31
    values = _listed(value) or [value]
    is_int = annotation is not None and re.search(r"\bint\b", ast.unparse(annotation))
    if is_int and any(isinstance(v, int) and not -limit <= v < limit for v in values):
        return f"a whole number between {-limit} and {limit - 1}"
    return None
