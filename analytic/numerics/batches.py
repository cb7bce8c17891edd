"""Tuples of arrays, each element one of a batch: some of them, and others in their place."""

from typing import Any, TypeVar

import numpy as np

from analytic.numerics.arrays import Booleans, Integers

_Batch = TypeVar("_Batch", bound=tuple[Any, ...])


def take(values: _Batch, which: Booleans | Integers | slice) -> _Batch:
    """Some elements of all arrays of a tuple, or of tuples in it; what is no array stays."""
    found = [_taken(value, which) for value in values]
    return values._make(found) if hasattr(values, "_make") else type(values)(found)


def put(values: tuple[Any, ...], where: Booleans | Integers, new: tuple[Any, ...]) -> None:
    for old, value in zip(values, new, strict=True):
        if isinstance(old, tuple):
            put(old, where, value)
        elif isinstance(old, np.ndarray):
            old[where] = value


def _taken(value: Any, which: Booleans | Integers | slice) -> Any:  # noqa: ANN401
    if isinstance(value, np.ndarray):
        return value[which]
    return take(value, which) if isinstance(value, tuple) else value
