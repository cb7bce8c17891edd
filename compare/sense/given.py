"""What a caller gave, refused if it is of another kind: a test's simulator may return anything."""

from typing import TypeVar

from analytic import InputError

_Kind = TypeVar("_Kind")


def checked(name: str, given: object, kind: type[_Kind], remedy: str) -> _Kind:
    """What was given, refused if it is of another kind."""
    if not isinstance(given, kind):
        raise InputError(name, f"a {type(given).__name__}", kind.__name__, remedy)
    return given


def checked_sweep(name: str, given: object, kind: type[_Kind]) -> _Kind:
    """A sweep, in the plane or in space."""
    return checked(name, given, kind, f"wrap a table as {kind.__name__}(table, beam)")
