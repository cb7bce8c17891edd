"""What settings may be: checks that those of every kind share, one line for what is wrong.

The command line needs no more of the settings before it knows what to do.
"""

from numbers import Real
from typing import Literal, TypeAlias, get_args

from analytic.problem.errors import InputError, unknown
from analytic.problem.whole import as_whole

BeamKind: TypeAlias = Literal["chain", "rod", "cable"]
ClampKind: TypeAlias = Literal["second-order", "naive"]
ObstacleKind: TypeAlias = Literal["mesh", "primitive"]
SpringKind: TypeAlias = Literal["linear", "arc"]
BEAMS, CLAMPS, OBSTACLES = map(get_args, (BeamKind, ClampKind, ObstacleKind))
SPRINGS = get_args(SpringKind)
CONTACT_STIFFNESSES = 1e3, 1e9  # EI/L^3; the least and the largest
Limits: TypeAlias = dict[str, tuple[float, float, str]]
"""The least and the largest number that a field may be (integers: a whole one), what is usual."""


def check_word(name: str, value: object, allowed: tuple[str, ...]) -> None:
    """Refuse what is none of some words."""
    if value not in allowed:
        raise unknown(name, value, allowed)


def check_number(name: str, value: object, low: float, high: float, remedy: str) -> None:
    """Refuse what is no number, or out of its range."""
    is_number = isinstance(value, Real) and not isinstance(value, bool)
    if not (is_number and low <= value <= high):  # type: ignore[operator]
        raise InputError(name, value, f"a number between {low:g} and {high:g}", remedy)


def check_numbers(kind: str, values: object, limits: Limits) -> None:
    """Refuse an object of which a field is out of its range; one that may be left out, if given.

    What is to be whole becomes an integer, as ``40.0`` does.
    """
    for name, (low, high, remedy) in limits.items():
        value, called = getattr(values, name), f"{kind}.{name}"
        if isinstance(low, int):
            number = as_whole(value)
            if number is None or not low <= number <= high:
                allowed = f"a whole number between {low:g} and {high:g}"
                raise InputError(called, value, allowed, remedy)
            object.__setattr__(values, name, number)
        elif value is not None or getattr(type(values), name) is not None:
            check_number(called, value, low, high, remedy)
