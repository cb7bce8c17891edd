"""Whole numbers of any numeric type; settings ask for them before NumPy is loaded."""

from numbers import Real
from typing import Any


def as_whole(value: Any) -> int | None:  # noqa: ANN401  # of arrays it takes their number
    """A number such as 30, ``30.0`` or ``np.array(30)``; None of all else."""
    given = value.item() if getattr(value, "ndim", None) == 0 else value
    is_number = isinstance(given, Real) and not isinstance(given, bool)
    return int(given) if is_number and given % 1 == 0 else None  # not of NaN and infinity
