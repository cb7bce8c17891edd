"""Many contours at once: points of each in one call."""

from collections.abc import Callable, Iterator, Sequence
from functools import cached_property, partial
from types import MethodType
from typing import Any

import numpy as np

from analytic.numerics.arrays import Floats, Integers
from analytic.problem.contours.contour import Contour, ContourPoint
from analytic.problem.contours.profile import Profile, unchecked


class Contours:
    """Contours, each with its number; of one family, as catenaries, in one call with arrays."""

    def __init__(self, contours: Sequence[Contour]) -> None:
        self.contours = tuple(contours)
        if len(self.contours) == 1:
            return
        families: dict[Any, list[int]] = {}
        numbers: list[tuple[float, ...]] = []
        for i, contour in enumerate(self.contours):
            family, own = _taken_apart(contour) if isinstance(contour, Profile) else (i, ())
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
        level = np.zeros(1)
        return np.concatenate([contour.parameter(level) for contour in self.contours])

    def at(self, owner: Integers, t: Floats) -> ContourPoint:
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


def _parts(value: Any) -> tuple[Callable[..., Any], tuple[Any, ...]] | None:  # noqa: ANN401
    """What makes a profile, or a part of one, and of what; None of what is taken as it is."""
    match value:
        case tuple() if type(value).__module__ in _FAMILIES:
            return type(value), value
        case tuple() if type(value) is tuple:
            return _tuple, value
        case Profile() if value.radius_of_curvature is not None:
            return _profile, tuple(getattr(value, name) for name in _CURVES)
        case partial() if not value.keywords and getattr(value.func, "__module__", "") in _FAMILIES:
            return partial, (value.func, *value.args)  # of our own functions, which take arrays
        case MethodType():
            return MethodType, (value.__func__, value.__self__)
    return None


def _taken_apart(value: Any) -> tuple[Any, tuple[float, ...]]:  # noqa: ANN401
    """What a profile, or a part of one, has in common with its family, and its own numbers."""
    if isinstance(value, float | int):
        return float, (float(value),)
    made = _parts(value)
    if made is None:
        return value if callable(value) else id(value), ()
    found = [_taken_apart(part) for part in made[1]]
    return (made[0], *(key for key, _ in found)), tuple(x for _, own in found for x in own)


def _put_together(value: Any, numbers: Iterator[Floats]) -> Any:  # noqa: ANN401
    """The same with other numbers, in the order in which `_taken_apart` found them."""
    if isinstance(value, float | int):
        return next(numbers)
    made = _parts(value)
    if made is None:
        return value
    make, parts = made
    return make(*(_put_together(part, numbers) for part in parts))


def _tuple(*parts: object) -> tuple[object, ...]:
    return parts


def _profile(*parts: object) -> Profile:
    return unchecked(**dict(zip(_CURVES, parts, strict=True)))


_FAMILIES = tuple(f"{__package__}.{name}" for name in ("families", "profile"))
_CURVES = ("xi", "eta", "alpha_range", "radius_of_curvature", "distance")
