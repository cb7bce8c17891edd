"""The one exception for input that cannot be used, and what a number is."""

import math
from numbers import Real
from typing import TypeGuard


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
    remedy : str
        What to do about it.
    """

    def __init__(self, name: str, value: object, allowed: str, remedy: str) -> None:
        self._given = name, str(value), allowed, remedy
        line = f"{name} = {value}: must be {allowed}; {remedy}"
        super().__init__(" ".join(line.split()))

    def __reduce__(self) -> tuple[type["InputError"], tuple[str, str, str, str]]:
        return type(self), self._given  # so that another process can hand it back


def is_finite_number(value: object) -> TypeGuard[float]:
    """Whether a value is a real, finite number and no boolean.

    Parameters
    ----------
    value : object
        Anything.

    Returns
    -------
    bool
        True for Python's and NumPy's real scalars that fit a float.
    """
    if not isinstance(value, Real) or isinstance(value, bool):
        return False
    try:
        return math.isfinite(value)
    except OverflowError:  # an integer too large for a float
        return False
