"""The stations of a measured sweep that a calibration is from."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from analytic.from_clamp.noise import (
    checked_noise,
    known_to,
    largest,
    reading_noise,
    resting_noise,
    zero_uncertainty,
)
from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.problem.beam import Beam
from analytic.problem.clamp_path import Direction
from analytic.problem.columns import CLAMP_READINGS, SENSED, units
from analytic.problem.errors import InputError
from analytic.problem.readings import Readings

_LEAST = 1e-9  # of the largest magnitude; readings without noise count as of so much
_SIGMAS = 5.0  # of its noise; a force of less is none
_NEXT_TO_SNAP_OFF = 0.02  # of the loaded travel, where readings grow without bound: left out
_PER_UNKNOWN = 5  # loaded stations at least
_MOST_ALIKE = 1 - 1e-6  # neighbours; more would divide by nothing
_GAP = 5.0  # times the median step of the foot; less is of stations that are uneven
_DECADES = 6  # by which loads may differ from EI/L^2 and EI/L; else the units do


@dataclass(frozen=True)
class Measured:
    """Readings of one or more passes, as a fit needs them: one pass after the other."""

    foot_x: Floats  # shape (n,); Of the stations that count, in the order of each pass [length]
    readings: Floats  # shape (3, n); Force and moment at the clamp
    spread: Floats  # shape (4,); Standard deviation of the foot position and of the three readings
    rows: tuple[int, ...]  # how many stations each pass has
    ends: tuple[tuple[float, float], ...]  # where the foot of each pass starts and stops [length]
    zero: Floats  # shape (3,); standard uncertainty of the zero of each reading
    bend: Floats  # shape (3,); the same of a bend of its drift, in the middle of a pass
    # Shape (3,); of the free stretches' noise, if that counts: it may hum, or remember, so that it
    # hardly shows from row to row. 0 otherwise.
    free: Floats
    # Relative variance of the noise's square beside that of white noise of as many stations: what
    # remembers shows less of its size, where it is free and under load.
    vague: float
    # Stations off the contact, which show the size of noise that remembers; None if it is stated,
    # or a rig says it.
    rests: int | None
    jitter: float = 0.0  # of the foot position, if it stands out of the noise [length]

    @classmethod
    def of(
        cls,
        passes: Sequence[Readings],
        carried: tuple[float, float],
        noise: Mapping[str, float] | None,
        unknowns: int,
    ) -> "Measured":
        """What is under load in all passes, of one rig: the noise of each is that of all."""
        each = [measured_under_load(one, carried, noise, unknowns) for one in passes]
        pooled = {
            name: np.sqrt(np.mean([getattr(one, name) ** 2 for one in each], axis=0))
            for name in ("spread", "zero", "bend", "free")
        }
        return cls(
            foot_x=np.concatenate([one.foot_x for one in each]),
            readings=np.concatenate([one.readings for one in each], axis=1),
            rows=tuple(n for one in each for n in one.rows),
            ends=tuple(ends for one in each for ends in one.ends),
            vague=float(np.mean([one.vague for one in each])) / len(each),
            rests=None if each[0].rests is None else sum(one.rests or 0 for one in each),
            **pooled,
        )

    @property
    def passes(self) -> list[slice]:
        ends = np.cumsum(self.rows).tolist()
        return [slice(end - n, end) for n, end in zip(self.rows, ends, strict=True)]

    @property
    def along(self) -> Floats:
        """Share of each station's pass, from -1 at its start to 1, shape (n,)."""
        each = zip(self.passes, self.ends, strict=True)
        return np.concatenate([(2 * self.foot_x[x] - a - b) / (b - a) for x, (a, b) in each])

    @property
    def since(self) -> Floats:
        """How many stations each is behind the one before it: more than one behind a gap."""
        each = [np.abs(np.diff(self.foot_x[one])) for one in self.passes]
        steps = np.concatenate([np.append(0.0, way / np.median(way)) for way in each])
        return np.where(steps > _GAP, steps, 1.0)

    @property
    def ways(self) -> list[Direction]:
        """To where the foot moves in each pass."""
        moved = [self.foot_x[one][-1] - self.foot_x[one][0] for one in self.passes]
        return ["right" if way > 0 else "left" for way in moved]

    @property
    def turned(self) -> str:
        """Which passes bend the vibrissa to where the foot goes, as none does; empty if none."""
        bends = ["left" if self.readings[-1, one].sum() < 0 else "right" for one in self.passes]
        found = [f"pass {i}" for i, pair in enumerate(zip(bends, self.ways, strict=True), 1)
                 if pair[0] == pair[1]]  # fmt: skip
        return ", ".join(found)

    def slopes(self, readings: Floats) -> Floats:
        """Derivatives of some readings over the foot position, within each pass."""
        return np.concatenate(
            [
                np.gradient(readings[:, one], axis=1) / np.gradient(self.foot_x[one])
                for one in self.passes
            ],
            axis=1,
        )

    def at(self, kept: Booleans) -> "Measured":
        rows = tuple(int(kept[one].sum()) for one in self.passes)
        return replace(self, foot_x=self.foot_x[kept], readings=self.readings[:, kept], rows=rows)


def check_size(readings: Readings, beam: Beam) -> None:
    """Refuse readings that have no load, or are in other units than the vibrissa."""
    for name, unit in zip(CLAMP_READINGS, units(beam, CLAMP_READINGS), strict=True):
        size = largest(readings.values(name)[readings.trusted]) / unit
        if size == 0:
            remedy = "the vibrissa never touches, or the column is a dead channel"
            what = "zero at all stations"
            raise InputError(f"{name} of {readings.source}", what, "under load somewhere", remedy)
        if not 10.0**-_DECADES < size < 10.0**_DECADES:
            what = f"up to {size:.1e} of what the vibrissa's EI and length make its unit"
            allowed, remedy = f"within {_DECADES} decades of it", "give both in the same units"
            raise InputError(f"{name} of {readings.source}", what, allowed, remedy)


def measured_under_load(
    readings: Readings,
    carried: tuple[float, float],
    noise: Mapping[str, float] | None,
    unknowns: int,
) -> Measured:
    """The stations under load, but for those next to the snap-off; the weight carried is none."""
    stated = None if noise is None else checked_noise(noise)
    known = reading_noise(readings) if stated is None else stated
    spread = np.array([known.get(name, 0.0) for name in SENSED])
    least = [_LEAST * largest(readings.values(name)) for name in CLAMP_READINGS]
    spread[1:] = np.maximum(spread[1:], least)
    of_free = readings.provenance.get("free_noise")
    if of_free is None and stated is None:  # no rig says where it is free
        values = np.stack([readings.values(name) for name in CLAMP_READINGS])
        free = resting_noise(values[:, readings.trusted], spread[1:])
    else:
        free = np.array([(of_free or {}).get(name, 0.0) for name in CLAMP_READINGS])
    x = readings.values("foot_x")
    force = np.hypot(
        readings.values("force_x") + carried[0], readings.values("force_y") + carried[1]
    )
    level = np.hypot(*np.maximum(spread[1:3], free[:2]))
    loaded = np.flatnonzero(readings.trusted & (force > _SIGMAS * level))
    loaded = loaded[: let_go(force[loaded], _SIGMAS * level)]
    fewest = _PER_UNKNOWN * unknowns
    order = _kept(readings, loaded) if len(loaded) else loaded
    if len(order) < fewest:
        name = f"stations of {readings.source} under load, but for those next to the snap-off"
        allowed = f"{fewest} or more, {_PER_UNKNOWN} for each unknown"
        remedy = "sweep further or with more stations, state less noise, or leave the pass out"
        raise InputError(name, len(order), allowed, remedy)
    found = np.stack([readings.values(n)[order] for n in CLAMP_READINGS])
    zero = zero_uncertainty(readings, np.abs(found).max(axis=1))
    free = free if stated is None else np.zeros(3)
    # From row to row there is 1 - rho of the variance of a[i + 1] = rho a[i] + white, of which as
    # many rows say (1 - rho^2) / (1 + rho^2) times as much as of white noise.
    rho = np.minimum(1 - (spread[1:] / np.maximum(spread[1:], free)) ** 2, _MOST_ALIKE)
    unloaded = max(int(readings.trusted.sum()) - len(loaded), 1)
    repeats = np.mean(rho**2 * (1 + rho**2) / (1 - rho**2)) / len(CLAMP_READINGS)
    vague = float(repeats * (1 / len(order) + 1 / unloaded))
    spread[1:] = np.maximum(spread[1:], free)
    bend, rows = known_to("bend_uncertainty", readings), (len(order),)
    start, stop = x[readings.trusted][[0, -1]].tolist()
    ends = ((start, stop),)
    rests = unloaded if stated is None and of_free is None else None
    return Measured(x[order], found, spread, rows, ends, zero, bend, free, vague, rests)


def let_go(force: Floats, least: float) -> int:
    """How many stations there are until the force falls most, to what stays: it lets go there.

    Noise that remembers is more than its jumps say, and goes on behind that.
    """
    after = np.maximum.accumulate(np.append(least, force[:0:-1]))[::-1]
    return int(np.argmax(force / after)) + 1 if len(force) else 0


def _kept(readings: Readings, loaded: Integers) -> Integers:
    """The stations from the first loaded one to shortly before the last, as the foot passes."""
    x = readings.values("foot_x")
    first, last = x[loaded[0]], x[loaded[-1]]
    kept = readings.trusted & (x >= min(first, last)) & (x <= max(first, last))
    # Amid contact there is a load: exact zeros are a dropout's.
    kept &= np.any([readings.values(name) != 0 for name in CLAMP_READINGS], axis=0)
    if loaded[-1] < len(x) - 1:  # it lets go
        kept &= np.abs(x - last) >= _NEXT_TO_SNAP_OFF * abs(last - first)
    _, order = np.unique(np.where(kept, x, np.nan), return_index=True)
    order = order[kept[order]]
    return np.asarray(order if last > first else order[::-1])
