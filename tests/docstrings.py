"""Public functions and methods whose docstring lacks something: ``python -m tests.docstrings``.

Every public function and method of the three packages has a numpydoc docstring: all its
parameters, each described, arrays with their shape, and what it returns. Exempt are properties, a
method that a documented base class or protocol of the same package has too, pytest's hooks and the
functions behind the commands, whose docstring is what ``--help`` shows.
"""

import inspect
import re
import sys
from collections import Counter
from collections.abc import Iterator
from functools import reduce
from importlib import import_module
from inspect import getmembers, isclass, isfunction
from pkgutil import walk_packages
from types import FunctionType, ModuleType
from typing import get_type_hints

from numpydoc.validate import validate
from typer.models import ArgumentInfo, OptionInfo

PACKAGES = ("analytic", "mujoco_models", "engines", "compare")
EXTRAS = ("pydrake", "exudyn", "mujoco_warp")
# No docstring; parameters: undocumented, unknown, not described; nothing of what is returned or
# yielded; no description of it.
CHECKS = {"GL08", "PR01", "PR02", "PR07", "RT01", "RT03", "YD01"}
# "x : array" or "array" as a whole line, where ", shape (n,)" or ", any shape" should follow.
_SHAPELESS = re.compile(r"^ *(?:[\w, ]+ : )?array(?: of \w+)?(?:, optional)?$", re.M)


def modules() -> Iterator[ModuleType]:
    """All public modules."""
    for package in PACKAGES:
        top = import_module(package)
        yield top
        for found in walk_packages(top.__path__, f"{package}."):
            if any(part.startswith("_") for part in found.name.split(".")):
                continue
            try:
                module = import_module(found.name)
            except ModuleNotFoundError as error:  # of an extra; its own environment has it
                if (error.name or "").split(".")[0] not in EXTRAS:
                    raise
                continue
            yield module


def functions() -> Iterator[tuple[str, str]]:
    """Module and name in it of every public function and method that is not exempt."""
    found = list(modules())
    protocols = [
        c for m in found for c in vars(m).values() if isclass(c) and getattr(c, "_is_protocol", 0)
    ]
    promised = {name for c in protocols for name in vars(c) if not name.startswith("_")}
    for module in found:
        commands = ".commands." in module.__name__
        for name, thing in getmembers(module):
            if name.startswith("_") or getattr(thing, "__module__", "") != module.__name__:
                continue
            if isfunction(thing) and not name.startswith("pytest_"):
                if not (commands and _is_command(thing)):
                    yield module.__name__, name
            elif isclass(thing):
                for method in _methods(thing):
                    if thing in protocols or method not in promised:
                        yield module.__name__, f"{name}.{method}"


def _methods(of: type) -> Iterator[str]:
    for name, thing in vars(of).items():
        inherited = any(name in vars(base) for base in of.__mro__[1:])
        if isinstance(thing, classmethod | staticmethod):
            thing = thing.__func__
        if isinstance(thing, FunctionType) and not name.startswith("_") and not inherited:
            yield name


def _is_command(function: FunctionType) -> bool:
    """Whether all parameters of `function` are options and arguments of the command line."""
    try:
        hints = get_type_hints(function, include_extras=True)
    except NameError:  # of what only type checkers import: no command asks for that
        return False
    kinds = (OptionInfo, ArgumentInfo)
    return all(
        any(isinstance(x, kinds) for x in getattr(hint, "__metadata__", ()))
        for name, hint in hints.items()
        if name != "return"
    )


def _returns(module: str, name: str) -> bool:
    """Whether the annotation says that something is returned."""
    function = reduce(getattr, name.split("."), import_module(module))
    kind = str(inspect.signature(function).return_annotation)
    generator = "Iterator[" in kind or "Generator[" in kind  # numpydoc asks these for Yields
    return not generator and kind not in ("None", "<class 'NoneType'>")


def offences() -> list[str]:
    """A line for each function that lacks something, room by room."""
    lines = []
    for module, name in functions():
        found = validate(f"{module}.{name}")
        lacking = {code: text for code, text in found["errors"] if code in CHECKS}
        if _returns(module, name) and "\nReturns\n---" not in found["docstring"]:
            lacking["RT01"] = (
                "no Returns"  # a protocol's methods, too, which have no return in them
            )
        if _SHAPELESS.search(found["docstring"]):
            lacking["shape"] = "an array without its shape"
        if lacking:
            lines.append(f"{module}.{name}: {'; '.join(lacking.values())}")
    return sorted(set(lines))


def room(line: str) -> str:
    """The folder that a line is about."""
    where = line.split(":")[0].split(".")
    return ".".join(where[:2])


if __name__ == "__main__":
    wanted = sys.argv[1] if len(sys.argv) > 1 else ""
    lines = [line for line in offences() if line.startswith(wanted)]
    print("\n".join(lines))
    for where, count in sorted(Counter(map(room, lines)).items()):
        print(f"{count:4d} {where}")
    print(f"{len(lines):4d} in all")
    sys.exit(bool(lines))
