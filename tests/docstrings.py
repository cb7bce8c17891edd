"""Exported names whose docstring lacks something: ``python -m tests.docstrings``.

A name that a package exports has a numpydoc docstring, and so have its public methods: each
parameter described, arrays with their shape, and what is returned. Inside, a name explains itself.
"""

import re
import sys
from collections.abc import Iterator
from importlib import import_module
from inspect import isclass, isfunction, signature
from types import FunctionType

from numpydoc.validate import validate

PACKAGES = (
    "analytic",
    "analytic.checks",
    "analytic.space",
    "mujoco_models",
    "engines",
    "compare",
    "compare.study",
)
# No docstring; parameters: undocumented, unknown, not described; nothing of what is returned or
# yielded; no description of it.
CHECKS = {"GL08", "PR01", "PR02", "PR07", "RT01", "RT03", "YD01"}
# "x : array" or "array" as a whole line, where ", shape (n,)" or ", any shape" should follow.
_SHAPELESS = re.compile(r"^ *(?:[\w, ]+ : )?array(?: of \w+)?(?:, optional)?$", re.M)


def functions() -> Iterator[tuple[str, FunctionType]]:
    """Every exported function and every public method of an exported class."""
    for package in PACKAGES:
        top = import_module(package)
        for name in dir(top):
            thing = getattr(top, name)
            if isfunction(thing):
                yield f"{thing.__module__}.{thing.__name__}", thing
            elif isclass(thing):
                for method, defined in vars(thing).items():
                    function = getattr(defined, "__func__", defined)
                    inherited = any(method in vars(base) for base in thing.__mro__[1:])
                    if isfunction(function) and not method.startswith("_") and not inherited:
                        yield f"{thing.__module__}.{thing.__name__}.{method}", function


def offences() -> list[str]:
    """A line for each exported name that lacks something."""
    lines = set()
    for where, function in functions():
        if where.split(".")[0] not in {package.split(".")[0] for package in PACKAGES}:
            continue
        found = validate(where)
        lacking = [text for code, text in found["errors"] if code in CHECKS]
        kind = str(signature(function).return_annotation)
        returns = "Iterator[" not in kind and kind not in ("None", "<class 'NoneType'>")
        if returns and "\nReturns\n---" not in found["docstring"]:
            lacking.append("no Returns")
        if _SHAPELESS.search(found["docstring"]):
            lacking.append("an array without its shape")
        if lacking:
            lines.add(f"{where}: {'; '.join(lacking)}")
    return sorted(lines)


if __name__ == "__main__":
    print("\n".join(offences()))
    sys.exit(bool(offences()))
