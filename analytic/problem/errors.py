"""The one exception for input that cannot be used."""

import difflib
from collections.abc import Callable, Iterable
from pathlib import PurePath
from typing import TypeAlias, TypeVar

_Kind = TypeVar("_Kind")
Place: TypeAlias = Callable[[int], str]
"""Where a row of a table stands, in words: ``"line 17 of rig.csv"``."""


class InputError(ValueError):
    """Input that states no solvable problem, reported in one line.

    Parameters
    ----------
    name : str
        What was given, as the user knows it (``"beam.length"``).
    value : object
        The value that was given.
    allowed : str
        What would be allowed (``"a positive finite number"``).
    remedy : str, optional
        What to do about it.
    """

    def __init__(self, name: str, value: object, allowed: str, remedy: str = "correct it") -> None:
        self.name, self.given = name, (name, _written(value), allowed, remedy)
        line = f"{name} = {self.given[1]}: must be {allowed}; {remedy}"
        super().__init__(" ".join(line.split()))

    def __reduce__(self) -> tuple[type["InputError"], tuple[str, str, str, str]]:
        return type(self), self.given  # so that another process can hand it back


def called(error: InputError, name: str) -> InputError:
    """The same of what is known by another name, as a key of a file."""
    return InputError(name, *error.given[1:])


def because(error: InputError, remedy: str) -> InputError:
    """The same with another remedy, where more is known of the cause."""
    return InputError(*error.given[:3], remedy)


def _written(value: object) -> str:
    try:
        text = str(value)
        if isinstance(value, str | PurePath) and not (text.strip() and text.isprintable()):
            return ascii(text)  # a name of blanks or of signs that do not show
        return text
    except ValueError:  # Python refuses to write thousands of digits
        return "an integer of thousands of digits"


def near(word: object, known: Iterable[str], otherwise: str = "choose one") -> str:
    """What to do about a word that is none of those known: take the one that is nearest."""
    found = difflib.get_close_matches(str(word), [*known], n=1, cutoff=0.65)
    return f"did you mean {found[0]}?" if found else otherwise


def unknown(
    name: str, word: object, known: Iterable[str], *, more: str = "", remedy: str = "choose one"
) -> InputError:
    known = [*known]
    allowed = f"one of {', '.join(known)}{more}"
    return InputError(name, repr(word)[:120], allowed, near(word, known, remedy))


def require(name: str, value: object, kind: type[_Kind], remedy: str) -> _Kind:
    """The value; refuse what is of another kind, before something inside stumbles over it."""
    if not isinstance(value, kind):
        found = repr(value) if isinstance(value, str) else kind_of(value)
        raise InputError(name, found[:80], _with_article(kind), remedy)
    return value


def kind_of(value: object) -> str:
    """What a value is, where it is not said itself: ``"an int"``."""
    return _with_article(type(value))


def _with_article(kind: type) -> str:
    return f"{'an' if kind.__name__[0] in 'aeiouAEIOU' else 'a'} {kind.__name__}"


def row_number(row: int) -> str:
    return f"row {row}"
