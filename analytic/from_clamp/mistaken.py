"""Mistakes of signs, axes and units that would explain readings of no such vibrissa."""

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
_UNITS = (9.80665, 1e3, 1e6)  # by which units are mistaken: kgf and N, milli, micro
_LARGE = 0.9  # quantile that is called the size of a reading
# Of 1,300 random sweeps it is 0.03 to 0.7; of a force that is a thousand times too large, whatever
# the others are, all contacts would be at the tip.
_LEAST_ARM, _LONGEST_ARM = 0.01, 1.1
# Times the stated flexural rigidity, where it is to be found; then times the best one of these.
_RIGIDITIES = np.geomspace(0.7, 1.4, 13), np.geomspace(0.965, 1.035, 8)
_MANY = 0.3  # of the stations that a rigidity near the right one makes contacts
_OF_A_SENSOR = _UNITS[:2]  # by which those of its two forces differ
_FORCES = CLAMP_READINGS[:2]


@dataclass(frozen=True)
class _Mistake:
    """What is said of it, and what undoes it: factors of the readings, after two are swapped."""

    of: str
    by: str = ""
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
    found: dict[str, list[str]] = {}
    for one in mistakes:
        right = one.undone(readings)
        far = _LEAST_ARM < _arm(right, loaded) < _LONGEST_ARM
        if far and _explains(right, loaded, unsure):
            found.setdefault(one.of, []).append(one.by)
    # Of a unit that more than one size explains, none is said.
    return [of + (sizes[0] if len(sizes) == 1 else "") for of, sizes in found.items()]


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
    yield _Mistake("all signs", " (the vibrissa's action on the clamp)", every)
    for swapped in combinations(CLAMP_READINGS, 2):
        yield _Mistake(f"{' and '.join(swapped)}, swapped", swapped=swapped)
    for name in _FORCES:
        turned = "the sensor's axes, turned by 90 degrees"
        yield _Mistake(turned, factors={name: -1.0}, swapped=_FORCES)
    yield from _of_units(_FORCES, "both forces")
    yield from _of_units(("moment_z",), "moment_z")
    yield from _of_units(CLAMP_READINGS, "all three readings, or of the flexural rigidity")


def _of_one_force() -> Iterator[_Mistake]:
    for name in _FORCES:
        yield from _of_units((name,), name, _OF_A_SENSOR)


def _of_units(
    names: tuple[str, ...], called: str, units: tuple[float, ...] = _UNITS
) -> Iterator[_Mistake]:
    of = f"the unit of {called}"
    for unit in units:
        for factor, way in ((1 / unit, "large"), (unit, "small")):
            yield _Mistake(of, f" ({unit:.4g} times too {way})", dict.fromkeys(names, factor))
