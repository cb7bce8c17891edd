"""Mistakes of signs, axes and units that would explain readings of no such vibrissa."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from itertools import combinations

import numpy as np

from analytic.from_clamp.phases import judge_phases
from analytic.numerics.arrays import Booleans
from analytic.problem.columns import CLAMP_READINGS
from analytic.problem.readings import Readings

_LOOKED_AT = 200  # stations; more say nothing new
_EXPLAINS = 0.95  # of the stations: a few lie between two phases, or are spikes
# Units in those that they are taken for, or that are taken for them.
_OF_FORCE = {"uN": 1e-6, "mN": 1e-3, "kgf": 9.80665, "gf": 9.80665e-3, "lbf": 4.448222}
_OF_MOMENT = {**_OF_FORCE, "mN mm": 1e-6, "N mm or mN m": 1e-3, "N cm": 1e-2}
_OF_ARM = {("N mm", "N cm"): 10.0, ("mm", "inches"): 25.4}
_LARGE = 0.9  # quantile that is called the size of a reading
# Of 1,300 random sweeps it is 0.03 to 0.7; of a force that is a thousand times too large, whatever
# the others are, all contacts would be at the tip.
_LEAST_ARM, _LONGEST_ARM = 0.01, 1.1
# Times the stated flexural rigidity, where it is to be found; then times the best one of these.
_RIGIDITIES = np.geomspace(0.7, 1.4, 13), np.geomspace(0.965, 1.035, 8)
_MANY = 0.3  # of the stations that a rigidity near the right one makes contacts
_OF_A_SENSOR = 9.80665, 1 / 9.80665, 1e3, 1e-3  # by which those of its two forces differ
_FORCES = CLAMP_READINGS[:2]


@dataclass(frozen=True)
class _Mistake:
    """What is said of it, and what undoes it: factors of the readings, after two are swapped."""

    of: str
    by: str = ""
    size: float = 1.0  # of a unit: how many times too large
    factors: dict[str, float] = field(default_factory=dict)
    swapped: tuple[str, ...] = ()

    def undone(self, readings: Readings) -> Readings:
        source = dict(zip(CLAMP_READINGS, CLAMP_READINGS, strict=True))
        source |= zip(self.swapped, reversed(self.swapped), strict=True)
        right = {n: self.factors.get(n, 1.0) * readings.values(source[n]) for n in CLAMP_READINGS}
        return replace(readings, table=readings.table.assign(**right))


@np.errstate(over="ignore", invalid="ignore")  # of 1e300 a unit makes what is no number
def likely_mistakes(
    readings: Readings, counted: Booleans, most: bool, unsure: bool = False
) -> list[str]:
    """What may have been mistaken, if that makes contacts of what is none, as `most` may be.

    Of an `unsure` flexural rigidity it is nothing if another one makes contacts of them.
    """
    thin = np.arange(0, len(counted), len(counted) // _LOOKED_AT + 1)
    if len(thin) < 2 or not counted[thin].any():
        return []
    some = replace(readings, table=readings.table.iloc[thin].reset_index(drop=True))
    loaded = counted[thin]
    if unsure and _explains(some, loaded, unsure):
        return []
    # The unit of one force explains much: what is far too large is of a tip, whatever the others
    # are. It is named only where most readings need one and nothing else does.
    found = _explaining(_mistakes(), some, loaded, unsure)
    return found or (_explaining(_of_one_force(), some, loaded, unsure) if most else [])


def _explaining(
    mistakes: Iterable[_Mistake], readings: Readings, loaded: Booleans, unsure: bool
) -> list[str]:
    found: dict[str, dict[float, str]] = {}
    for one in mistakes:
        right = one.undone(readings)
        far = _LEAST_ARM < _arm(right, loaded) < _LONGEST_ARM
        if far and _explains(right, loaded, unsure):
            found.setdefault(one.of, {})[one.size] = one.by
    # Of a unit that more than one size explains, none is said.
    likely = {of: decimal_first(sizes) for of, sizes in found.items()}
    return [of + (found[of][one[0]] if len(one) == 1 else "") for of, one in likely.items()]


def _explains(readings: Readings, loaded: Booleans, unsure: bool) -> bool:
    """Whether nearly all are contacts, by the flexural rigidity that makes most of them ones."""
    ratio, best = 1.0, 0.0
    for ratios in _RIGIDITIES if unsure else ([1.0],):
        for one in ratio * np.asarray(ratios):
            beam = readings.beam.scaled(rigidity=float(one))
            share = judge_phases(replace(readings, beam=beam)).explained[loaded].mean()
            ratio, best = (float(one), share) if share > best else (ratio, best)
        if not _MANY < best < _EXPLAINS:
            break
    return bool(best >= _EXPLAINS)


def _arm(readings: Readings, loaded: Booleans) -> float:
    """The lever arm about the clamp by which a force of the size read makes such a moment [L]."""
    moment = np.quantile(np.abs(readings.values("moment_z")[loaded]), _LARGE)
    force = np.quantile(np.hypot(*(readings.values(name)[loaded] for name in _FORCES)), _LARGE)
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(moment / force / readings.beam.length)


def _mistakes() -> Iterator[_Mistake]:
    for name in ("moment_z", "force_x", "force_y"):
        yield _Mistake(f"the sign of {name}", factors={name: -1.0})
    for pair in (_FORCES, ("force_y", "moment_z")):  # a sensor that is turned over
        yield _Mistake(f"the signs of {' and '.join(pair)}", factors=dict.fromkeys(pair, -1.0))
    every = dict.fromkeys(CLAMP_READINGS, -1.0)
    yield _Mistake("all signs", " (the vibrissa's action on the clamp)", factors=every)
    for swapped in combinations(CLAMP_READINGS, 2):
        yield _Mistake(f"{' and '.join(swapped)}, swapped", swapped=swapped)
    for name in _FORCES:
        turned = "the sensor's axes, turned by 90 degrees"
        yield _Mistake(turned, factors={name: -1.0}, swapped=_FORCES)
    yield from _of_units(_FORCES, "both forces", unit_factors())
    yield from _of_units(("moment_z",), "moment_z", unit_factors(of_moment=True))
    together = "all three readings, or of the flexural rigidity"
    yield from _of_units(CLAMP_READINGS, together, unit_factors())


def _of_one_force() -> Iterator[_Mistake]:
    for name in _FORCES:
        yield from _of_units((name,), name, _OF_A_SENSOR)


def _of_units(names: tuple[str, ...], called: str, sizes: Iterable[float]) -> Iterator[_Mistake]:
    for size in sizes:
        by = f" ({max(size, 1 / size):.4g} times too {'large' if size > 1 else 'small'})"
        yield _Mistake(f"the unit of {called}", by, size, dict.fromkeys(names, 1 / size))


def unit_factors(of_moment: bool = False) -> dict[float, str]:
    """What a reading is larger by in another unit, and which was taken for which."""
    newton, units = ("N m", _OF_MOMENT) if of_moment else ("N", _OF_FORCE)
    pairs = {(name, newton): 1 / size for name, size in units.items()}
    pairs |= _OF_ARM if of_moment else {}
    pairs |= {(taken_for, name): 1 / factor for (name, taken_for), factor in pairs.items()}
    return {factor: f"{name} taken for {taken_for}" for (name, taken_for), factor in pairs.items()}


def decimal_first(factors: Iterable[float]) -> list[float]:
    """Of the factors that explain readings the powers of ten; all of them if there are none."""
    found = list(factors)
    return [one for one in found if round(math.log10(one), 9).is_integer()] or found
