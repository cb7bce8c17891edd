"""Mistakes of a sensor's wiring, mounting and units: what they make of true readings."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np

from analytic import CLAMP_READINGS
from analytic.from_clamp.mistaken import decimal_first, unit_factors
from analytic.numerics.arrays import Floats
from compare.explain.fit import fitted

_SAME_UNIT = 0.02  # of the factor; as far as a model's own error may move it
_FURTHEST = 1.1  # L; a simulator may take moments about the straight vibrissa's tip
_DEAD = 0.01  # of the reading's variance: what of it a dead channel still shows
_FOLLOWS = 0.5  # fraction of a small reading's variance that follows the load, if it is alive
_ROTATION = np.radians(60)  # beyond, it is a swap of axes
_LINKS, _NO_LINK = 500, 0.1  # a chain's at most; how far from whole their number is by its errors
LARGER = -0.8, 2.2
"""By what fraction readings are larger at least and at most by a gain or a rigidity that is off.

A radius that is a third off makes the rigidity 0.2 to 3.2 times what it should be.
"""


@dataclass(frozen=True)
class Misreading:
    """What a mistake makes of true readings, over their largest magnitudes."""

    text: str
    mixes: Floats  # shape (3, 3); the readings seen, of the true ones
    sizes: int = 0  # how many numbers were fitted
    still: Floats | float = 0.0  # shape (3, 1) or (3, stations); what is added

    def of(self, true: Floats) -> Floats:
        """What is read, shape (3, stations)."""
        return np.asarray(self.mixes @ true + self.still)


def about_the_origin(true: Floats, foot_x: Floats, scale: Floats) -> Misreading:
    """A moment about the world's origin instead of the foot."""
    more = np.zeros_like(true)
    more[2] = foot_x * true[1] * scale[1] / scale[2]
    return Misreading("moment_z is about the world's origin, not the foot", np.eye(3), 0, more)


def misread(true: Floats, seen: Floats, scale: Floats, length: float) -> Iterator[Misreading]:
    """Every mistake that needs no contour, as it fits best."""
    yield from _axes(scale)
    yield from _exchanged(true, seen)
    yield from _rotated(true, seen, scale)
    yield from _displaced(true, seen, scale, length)
    yield from _units(true, seen)
    yield from _dead(true, seen)


def _axes(scale: Floats) -> Iterator[Misreading]:
    """Signs and the order of the two forces."""
    ratio = scale[1] / scale[0]
    swapped = np.array([[0, ratio, 0], [1 / ratio, 0, 0], [0, 0, 1]])
    for axes, swap in ((np.eye(3), False), (swapped, True)):
        for signs in product((1, -1), repeat=3):
            if swap or signs != (1, 1, 1):
                yield Misreading(_axes_text(signs, swap), np.array(signs)[:, None] * axes)


def _exchanged(true: Floats, seen: Floats) -> Iterator[Misreading]:
    """A force taken for the moment and the moment for it, in whatever units."""
    for force in (0, 1):
        weight = float(true[2] @ true[2])
        factor = float(seen[force] @ true[2]) / weight
        if factor == 0:
            continue
        mixes = np.eye(3)
        mixes[[force, 2]] = 0
        mixes[force, 2], mixes[2, force] = factor, 1 / factor
        yield Misreading(f"{CLAMP_READINGS[force]} and moment_z swapped", mixes, 1)


def _axes_text(signs: tuple[int, ...], swap: bool) -> str:
    negated = [name for name, sign in zip(CLAMP_READINGS, signs, strict=True) if sign < 0]
    if swap:
        turned = " (the sensor is turned by 90 degrees)" if signs[0] * signs[1] < 0 else ""
        beside = f", {' and '.join(negated)} with the opposite sign" if negated else ""
        return f"force_x and force_y swapped{beside}{turned}"
    if len(negated) == len(CLAMP_READINGS):
        return (
            "all three readings have the opposite sign: the vibrissa's action on the clamp instead "
            "of the clamp's on the vibrissa"
        )
    turned = ", or the foot moves the other way" if negated == ["force_x", "moment_z"] else ""
    return f"opposite sign of {' and '.join(negated)}{turned}"


def _rotated(true: Floats, seen: Floats, scale: Floats) -> Iterator[Misreading]:
    """A sensor that is turned about z: forces in its axes instead of the world's."""
    x, y = true[:2] * scale[:2, None]
    a, b = seen[:2] * scale[:2, None]
    angle = float(np.arctan2(np.sum(a * y - b * x), np.sum(a * x + b * y)))
    if abs(angle) > _ROTATION:
        return
    c, s, ratio = np.cos(angle), np.sin(angle), scale[1] / scale[0]
    text = f"sensor turned by {np.degrees(angle):+.3g} degrees about z: force_x and force_y mix"
    yield Misreading(text, np.array([[c, s * ratio, 0], [-s / ratio, c, 0], [0, 0, 1]]), 1)


def _displaced(true: Floats, seen: Floats, scale: Floats, length: float) -> Iterator[Misreading]:
    """A moment about a point off the clamp: along the vibrissa, or across it."""
    for force, sign, where in ((0, 1.0, "along"), (1, -1.0, "across")):
        lever = sign * scale[force] * length / scale[2]
        size = fitted(seen[2] - true[2], lever * true[force]).size
        if abs(size) <= _FURTHEST:
            mixes = np.eye(3)
            mixes[2, force] = size * lever
            text = (
                f"sensor {size:+.3g} L {where} the vibrissa off the clamp: moment_z is taken about "
                f"another point (or crosstalk of {CLAMP_READINGS[force]})"
            )
            yield Misreading(text, mixes, 1)


def _units(true: Floats, seen: Floats) -> Iterator[Misreading]:
    """One reading, both forces, or all of them, larger by what units differ by, or far larger."""
    for groups in ([[0]], [[1]], [[2]], [[0, 1]], [[0, 1, 2]], [[0, 1], [2]]):
        gains, said = np.ones(3), {}
        for rows in groups:
            weight = np.sum(true[rows] ** 2)
            factor = float(np.sum(true[rows] * seen[rows]) / weight) if weight > 0 else 0.0
            known = unit_factors(of_moment=rows == [2])
            like = decimal_first(one for one in known if abs(factor / one - 1) <= _SAME_UNIT)
            every, names = len(rows) == len(CLAMP_READINGS), [CLAMP_READINGS[i] for i in rows]
            called = "all readings" if every else " and ".join(names)
            if like:
                unit = min(like, key=lambda one: abs(factor - one))
                due = f"{factor:.4g} times what is due ({known[unit]}?)"
                said[unit] = f"{called} in another unit: {due}" + _of_links(factor) * every
            elif len(groups) > 1 or not _far(factor, true[rows], seen[rows]):
                continue
            elif every:
                said[factor] = scaled_alike(factor, "readings")
            else:
                is_ = "is" if len(rows) == 1 else "are"
                said[factor] = f"{called} {is_} {_times(factor)}: a gain, or a unit"
            gains[rows] = factor
        one_mistake = len(groups) > 1 and abs(gains[2] / gains[0] - 1) <= _SAME_UNIT
        if len(said) == len(groups) and not one_mistake:
            yield Misreading(", ".join(said.values()), np.diag(gains), 1)


def _far(factor: float, true: Floats, seen: Floats) -> bool:
    """Whether readings are so many times the true ones, and no gain or rigidity makes them so."""
    follows = np.sum(true * seen) ** 2 > _FOLLOWS * np.sum(true**2) * np.sum(seen**2)
    return bool(follows and not LARGER[0] <= abs(factor) - 1 <= LARGER[1])


def scaled_alike(factor: float, what: str) -> str:
    """What makes all of them so many times what they should be."""
    if LARGER[0] <= factor - 1 <= LARGER[1]:
        return f"flexural rigidity {factor - 1:+.2%} off: all {what} scale alike"
    return f"all {what} are {_times(factor)}: EI, or its unit{_of_links(factor)}"


def _of_links(factor: float) -> str:
    if not 1 / _LINKS <= factor < 1:
        return ""
    links = round(1 / factor)
    whole = abs(1 / factor - links) <= _NO_LINK
    return f"; or, in a chain of {links} links, a spring of EI/L in place of EI/l" if whole else ""


def _times(factor: float) -> str:
    many = f"{factor:.5g} times" if abs(factor) > 1 else f"1/{1 / factor:.5g} of"
    return f"{many} the reference's"


def _dead(true: Floats, seen: Floats) -> Iterator[Misreading]:
    """A reading that does not follow the load."""
    for i, name in enumerate(CLAMP_READINGS):
        still = float(np.mean(seen[i]))
        if np.var(seen[i]) > _DEAD * np.var(true[i]) or abs(still) > 1:
            continue
        follows = float(np.mean((seen[i] - still) * (true[i] - true[i].mean()))) ** 2
        if follows > _FOLLOWS * np.var(seen[i]) * np.var(true[i]):
            continue  # small, as in another unit, but alive
        at, one = "zero", np.eye(3)[i]
        if abs(still) > 0.05:
            at = f"{still:.2g} of its largest magnitude"
        text, mixes = f"dead channel: {name} stays at {at}", np.diag(1 - one)
        yield Misreading(text, mixes, 1, still * one[:, None])
