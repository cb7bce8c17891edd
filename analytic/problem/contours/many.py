"""Many contours at once: points of each in one call."""

from collections.abc import Iterator, Sequence
from functools import cached_property, partial
from types import MethodType
from typing import Any

import numpy as np

from analytic.problem.arrays import Floats, Integers
from analytic.problem.contours.contour import Contour, ContourPoint
from analytic.problem.contours.parallel import Parallel
from analytic.problem.contours.profile import Profile


class Contours:
    """Contours of any kinds, each with its number.

    Those of one family, as catenaries of any width and height, differ in numbers alone: their
    functions are called once, with arrays in place of the numbers. All others are called one by
    one.
    """

    def __init__(self, contours: Sequence[Contour]) -> None:
        self.contours = tuple(contours)
        if len(self.contours) == 1:
            return
        families: dict[Any, list[int]] = {}
        numbers: list[tuple[float, ...]] = []
        for i, contour in enumerate(self.contours):
            one_of_many = isinstance(contour, Profile | Parallel)
            family, own = _taken_apart(contour) if one_of_many else (i, ())
            families.setdefault(family, []).append(i)
            numbers.append(own)
        self._members = [np.array(members) for members in families.values()]
        self._numbers = [np.array([numbers[i] for i in m]).T for m in families.values()]
        self._family, self._place = np.empty((2, len(self.contours)), dtype=int)
        for family, members in enumerate(self._members):
            self._family[members], self._place[members] = family, np.arange(len(members))

    def __len__(self) -> int:
        return len(self.contours)

    @cached_property
    def lowest(self) -> Floats:
        """Parameters of the lowest points, shape (contours,)."""
        level = np.zeros(1)
        return np.concatenate([contour.parameter(level) for contour in self.contours])

    def at(self, owner: Integers, t: Floats) -> ContourPoint:
        """Points of the contours."""
        if len(self.contours) == 1:
            return self.contours[0].at(t)
        if len(self._members) == 1:
            return self._of_family(0, owner, t)
        found = ContourPoint(*(np.empty_like(t) for _ in ContourPoint._fields))
        family = self._family[owner]
        for i in range(len(self._members)):
            which = np.flatnonzero(family == i)
            if which.size:
                part = self._of_family(i, owner[which], t[which])
                for values, new in zip(found, part, strict=True):
                    values[which] = new
        return found

    def _of_family(self, family: int, owner: Integers, t: Floats) -> ContourPoint:
        members = self._members[family]
        first: Contour = self.contours[members[0]]
        if len(members) == 1:
            return first.at(t)
        numbers = iter(self._numbers[family][:, self._place[owner]])
        contour: Contour = _put_together(first, numbers)
        return contour.at(t)


def _taken_apart(value: Any) -> tuple[Any, tuple[float, ...]]:  # noqa: ANN401
    """What a profile, or a part of one, has in common with its family, and its own numbers."""
    common: Any
    parts: tuple[Any, ...]
    match value:
        case float() | int():
            return float, (float(value),)
        case tuple() if type(value) is tuple:  # a named one has more than its parts
            common, parts = "tuple", value
        case Profile() if value.radius_of_curvature is not None:
            common, parts = "profile", _curves(value)
        case Parallel():
            common, parts = "parallel", (value.of, value.radius)
        case partial() if _takes_arrays(value):
            common, parts = value.func, value.args
        case MethodType():
            common, parts = value.__func__, (value.__self__,)
        case _:
            return value if callable(value) else id(value), ()
    found = [_taken_apart(part) for part in parts]
    return (common, *(key for key, _ in found)), tuple(x for _, own in found for x in own)


def _put_together(value: Any, numbers: Iterator[Floats]) -> Any:  # noqa: ANN401
    """The same with other numbers, in the order in which `_taken_apart` found them."""
    match value:
        case float() | int():
            return next(numbers)
        case tuple() if type(value) is tuple:
            return tuple(_put_together(part, numbers) for part in value)
        case Profile() if value.radius_of_curvature is not None:
            # The parts are those of checked profiles: they are not checked again.
            profile = object.__new__(Profile)
            for name, part in zip(_PARTS, _curves(value), strict=True):
                object.__setattr__(profile, name, _put_together(part, numbers))
            return profile
        case Parallel():
            # As an array the distance is one for each point.
            below = object.__new__(Parallel)
            for name in ("of", "radius"):
                object.__setattr__(below, name, _put_together(getattr(value, name), numbers))
            return below
        case partial() if _takes_arrays(value):
            return partial(value.func, *(_put_together(part, numbers) for part in value.args))
        case MethodType():
            return MethodType(value.__func__, _put_together(value.__self__, numbers))
    return value


def _takes_arrays(function: partial[Any]) -> bool:
    """Whether arrays may stand for its numbers: of our own functions we know, of others not."""
    return not function.keywords and getattr(function.func, "__module__", None) in _FAMILIES


_FAMILIES = tuple(f"{__package__}.{name}" for name in ("families", "profile"))
_PARTS = ("xi", "eta", "alpha_range", "radius_of_curvature")


def _curves(profile: Profile) -> tuple[Any, ...]:
    return tuple(getattr(profile, name) for name in _PARTS)
