"""Mistakes of a sensor's wiring, mounting and units: what they make of true readings."""

from collections.abc import Iterator
from itertools import product

import numpy as np

from analytic import CLAMP_READINGS
from analytic.problem.arrays import Floats
from compare.explain.fit import Explanation, fitted

# Units in those that they are taken for, or that are taken for them.
_FORCES = {"mN": 1e-3, "kgf": 9.80665, "gf": 9.80665e-3, "lbf": 4.448222}
_MOMENTS = {**_FORCES, "mN mm": 1e-6, "N mm or mN m": 1e-3, "N cm": 1e-2}
_LENGTHS = {("N mm", "N cm"): 10.0, ("mm", "inches"): 25.4}
_SAME_UNIT = 0.02  # of the factor; as far as a model's own error may move it
_DEAD = 0.01  # of the reading's variance: what of it a dead channel still shows
_FOLLOWS = 0.5  # fraction of a small reading's variance that follows the load, if it is alive
_ROTATION = np.radians(60)  # beyond, it is a swap of axes


def misread(true: Floats, seen: Floats, scale: Floats, length: float) -> Iterator[Explanation]:
    """Every mistake that needs no contour, with what it leaves unexplained."""
    yield from _axes(true, seen, scale)
    yield from _rotated(true, seen, scale)
    yield from _displaced(true, seen, scale, length)
    yield from _units(true, seen)
    yield from _dead(true, seen)


def _axes(true: Floats, seen: Floats, scale: Floats) -> Iterator[Explanation]:
    """Signs and the order of the two forces."""
    ratio = scale[1] / scale[0]
    swapped = np.stack([true[1] * ratio, true[0] / ratio, true[2]])
    for axes, swap in ((true, False), (swapped, True)):
        for signs in product((1, -1), repeat=3):
            if not swap and signs == (1, 1, 1):
                continue
            left = float(np.sum((seen - np.array(signs)[:, None] * axes) ** 2))
            yield Explanation(_axes_text(signs, swap), left, 0)


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
    return f"opposite sign of {' and '.join(negated)}"


def _rotated(true: Floats, seen: Floats, scale: Floats) -> Iterator[Explanation]:
    """A sensor that is turned about z: forces in its axes instead of the world's."""
    x, y = true[:2] * scale[:2, None]
    a, b = seen[:2] * scale[:2, None]
    angle = float(np.arctan2(np.sum(a * y - b * x), np.sum(a * x + b * y)))
    if abs(angle) > _ROTATION:
        return
    c, s = np.cos(angle), np.sin(angle)
    rotated = np.stack([(c * x + s * y) / scale[0], (c * y - s * x) / scale[1], true[2]])
    text = f"sensor turned by {np.degrees(angle):+.3g} degrees about z: force_x and force_y mix"
    yield Explanation(text, float(np.sum((seen - rotated) ** 2)))


def _displaced(true: Floats, seen: Floats, scale: Floats, length: float) -> Iterator[Explanation]:
    """A moment about a point off the clamp: along the vibrissa, or across it."""
    for force, sign, where in ((0, 1.0, "along the vibrissa"), (1, -1.0, "across the vibrissa")):
        signature = np.zeros_like(true)
        signature[2] = sign * true[force] * scale[force] * length / scale[2]
        size, left, _ = fitted(seen - true, signature)
        if abs(size) <= 0.5:
            text = (
                f"sensor {size:+.3g} L {where} off the clamp: moment_z is taken about another point"
            )
            yield Explanation(text, left)


def _units(true: Floats, seen: Floats) -> Iterator[Explanation]:
    """One reading, both forces, or all of them, larger by factors that units differ by."""
    for groups in ([[0]], [[1]], [[2]], [[0, 1]], [[0, 1, 2]], [[0, 1], [2]]):
        scaled, said = true.copy(), {}
        for rows in groups:
            weight = np.sum(true[rows] ** 2)
            factor = float(np.sum(true[rows] * seen[rows]) / weight) if weight > 0 else 0.0
            known = _factors(of_moment=rows == [2])
            unit = min(known, key=lambda one: abs(np.log(max(factor, 1e-99) / one)))
            if abs(factor / unit - 1) > _SAME_UNIT:
                continue
            scaled[rows] *= factor
            names = " and ".join(CLAMP_READINGS[i] for i in rows)
            names = names if len(rows) < len(CLAMP_READINGS) else "all readings"
            said[unit] = f"{names} in another unit: {factor:.4g} times what is due ({known[unit]}?)"
        if len(said) == len(groups):  # of one factor it is one mistake
            yield Explanation(", ".join(said.values()), float(np.sum((seen - scaled) ** 2)))


def _factors(of_moment: bool) -> dict[float, str]:
    """What a reading is larger by, and which unit was taken for which."""
    newton, units = ("N m", _MOMENTS) if of_moment else ("N", _FORCES)
    pairs = {(name, newton): 1 / size for name, size in units.items()}
    pairs |= _LENGTHS if of_moment else {}
    pairs |= {(taken_for, name): 1 / factor for (name, taken_for), factor in pairs.items()}
    return {factor: f"{name} taken for {taken_for}" for (name, taken_for), factor in pairs.items()}


def _dead(true: Floats, seen: Floats) -> Iterator[Explanation]:
    """A reading that does not follow the load."""
    for i, name in enumerate(CLAMP_READINGS):
        still = float(np.mean(seen[i]))
        if np.var(seen[i]) > _DEAD * np.var(true[i]) or abs(still) > 1:
            continue
        follows = float(np.mean((seen[i] - still) * (true[i] - true[i].mean()))) ** 2
        if follows > _FOLLOWS * np.var(seen[i]) * np.var(true[i]):
            continue  # small, as in another unit, but alive
        constant = true.copy()
        constant[i] = still
        at = (
            f"stays at {still:.2g} of its largest magnitude"
            if abs(still) > 0.05
            else "stays at zero"
        )
        yield Explanation(f"dead channel: {name} {at}", float(np.sum((seen - constant) ** 2)))
