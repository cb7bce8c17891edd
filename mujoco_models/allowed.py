"""What settings may be: checks that those of every kind share, one line for what is wrong.

The command line needs no more of the settings before it knows what to do.
"""

from numbers import Integral, Real
from typing import Literal, TypeAlias, get_args

from analytic.problem.errors import InputError, unknown

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


def check_number(
    name: str, value: object, low: float, high: float, remedy: str, whole: bool = False
) -> None:
    """Refuse what is no number, or out of its range."""
    is_number = isinstance(value, Integral if whole else Real) and not isinstance(value, bool)
    if not (is_number and low <= value <= high):  # type: ignore[operator]
        number = "a whole number" if whole else "a number"
        raise InputError(name, value, f"{number} between {low:g} and {high:g}", remedy)


def check_numbers(kind: str, values: object, limits: Limits) -> None:
    """Refuse an object of which a field is out of its range; one that may be left out, if given."""
    for name, (low, high, remedy) in limits.items():
        value = getattr(values, name)
        if value is not None or getattr(type(values), name) is not None:
            check_number(f"{kind}.{name}", value, low, high, remedy, isinstance(low, int))
