"""What a rig or a simulator does wrong, in a sweep or its readings."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from analytic import CLAMP_READINGS, Case, Readings, solve_sweep
from compare.sense.noise import with_noise

_SEGMENTS = 40

Swept = Callable[[Case, np.random.Generator], Readings]
Sensor = Callable[[Readings, np.random.Generator], Readings]
Act = Callable[[np.ndarray, np.random.Generator], np.ndarray]


def with_own_error(sweep: Readings, rng: np.random.Generator, size: float) -> Readings:
    """The readings of a model that is a little off, smoothly, and from segment to segment."""
    progress = np.linspace(0, 1, len(sweep.table))

    def off(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
        waves = sum(
            rng.normal() * np.cos(k * np.pi * progress + rng.uniform(0, 2 * np.pi))
            for k in range(1, 5)
        )
        steps = np.sin(2 * np.pi * _SEGMENTS * progress + rng.uniform(0, 2 * np.pi))
        shape = np.where(values != 0, waves + 0.5 * steps, 0.0)
        scale = size * np.nanmax(np.abs(values)) / np.sqrt(np.mean(shape**2))
        return values + scale * shape

    return each(off)(sweep, rng)


def either(rng: np.random.Generator, low: float, high: float) -> float:
    """A size of either sign."""
    return float(rng.uniform(low, high) * rng.choice([-1, 1]))


def _begun(case: Case, earlier: float, **changes: Any) -> Readings:
    """The sweep of a changed case, begun clear of the object."""
    start, stop = (float(x) for x in case.foot_x[[0, -1]])
    sweep = replace(case.sweep, start=start + earlier, stop=stop)
    return solve_sweep(replace(case, sweep=sweep, **changes))


def another(case: Case, earlier: float, **beam: float) -> Readings:
    """The sweep of another vibrissa, which claims to be the case's."""
    wrong = _begun(case, earlier, beam=replace(case.beam, **beam))
    return replace(wrong, beam=case.beam)


def beam_off(name: str, low: float, high: float, sign: bool = True) -> Swept:
    """A number of the beam that is off by a fraction of it."""

    def swept(case: Case, rng: np.random.Generator) -> Readings:
        by = either(rng, low, high) if sign else float(rng.uniform(low, high))
        return another(case, 0.05, **{name: getattr(case.beam, name) * (1 + by)})

    return swept


def held(**support: tuple[float, float]) -> Swept:
    """The sweep of a vibrissa held otherwise, of which nothing is said."""

    def swept(case: Case, rng: np.random.Generator) -> Readings:
        numbers = {name: float(rng.uniform(*limits)) for name, limits in support.items()}
        return solve_sweep(replace(case, **numbers))

    return swept


def raised(case: Case, rng: np.random.Generator) -> Readings:
    return _begun(case, 0.05, profile=case.profile.raised(either(rng, 0.005, 0.02)))


def sized(case: Case, rng: np.random.Generator) -> Readings:
    """An object of the same shape, larger or smaller about its lowest point, which is at x = 0."""
    by, lowest = either(rng, 0.05, 0.2), float(case.outline(1000)[1].min())
    return _begun(case, 0.2, profile=case.profile.scaled(1 + by).raised(-by * lowest))


def rigid_first_half(case: Case, rng: np.random.Generator) -> Readings:
    """No hinge in the first half cell."""
    by = 0.5 / float(rng.integers(10, 41))
    beam = replace(case.beam, length=1 - by)
    sweep = _begun(case, 0.05, beam=beam, profile=case.profile.raised(-by))
    moment = sweep.values("moment_z") - by * sweep.values("force_x")
    return replace(columns(sweep, moment_z=moment), beam=case.beam)


def softer_and_rubbing(case: Case, rng: np.random.Generator) -> Readings:
    beam = replace(case.beam, flexural_rigidity=1 + either(rng, 0.1, 0.3))
    swept = solve_sweep(replace(case, beam=beam, friction=float(rng.uniform(0.05, 0.2))))
    return replace(swept, beam=case.beam)


def columns(sweep: Readings, **changed: np.ndarray) -> Readings:
    return replace(sweep, table=sweep.table.assign(**changed))


def on(name: str, act: Act) -> Sensor:
    """A mistake in a column of that name."""
    return lambda sweep, rng: columns(sweep, **{name: act(sweep.values(name), rng)})


def one(act: Act) -> Sensor:
    """A mistake in one reading, drawn at random."""
    return lambda sweep, rng: on(str(rng.choice(CLAMP_READINGS)), act)(sweep, rng)


def each(act: Act) -> Sensor:
    """The same in every reading."""
    return lambda sweep, rng: columns(
        sweep, **{name: act(sweep.values(name), rng) for name in CLAMP_READINGS}
    )


def both(first: Sensor, second: Sensor) -> Sensor:
    return lambda sweep, rng: second(first(sweep, rng), rng)


def largest(values: np.ndarray) -> float:
    return float(np.abs(values).max())


def gain(low: float, high: float) -> Act:
    return lambda values, rng: values * (1 + either(rng, low, high))


def zero(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    return values + either(rng, 0.03, 0.1) * largest(values)


def drifting(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    return values + either(rng, 0.05, 0.2) * largest(values) * np.linspace(0, 1, len(values))


def spiked(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """One to three single values far off, amid contact."""
    values, rows = values.copy(), len(values)
    at = int(rng.uniform(0.3, 0.5) * rows) + 5 * np.arange(rng.integers(1, 4))
    values[at] += rng.choice([-1, 1]) * rng.uniform(1, 100) * largest(values)
    return values


def clipped(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    limit = np.quantile(np.abs(values), rng.uniform(0.7, 0.9))
    return np.clip(values, -limit, limit)


def cubic(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    return values * (1 + either(rng, 0.05, 0.3) * (values / largest(values)) ** 2)


def stepped(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    step = rng.uniform(0.03, 0.08) * largest(values)
    return step * np.round(values / step)


def later(values: np.ndarray, by: float) -> np.ndarray:
    rows = np.arange(len(values))
    return np.interp(rows - by, rows, values)


def late(sweep: Readings, rng: np.random.Generator) -> Readings:
    """A delay of all channels alike."""
    by = float(rng.uniform(2, 6))
    return each(lambda values, rng: later(values, by))(sweep, rng)


def exchanged(name: str, other: str) -> Sensor:
    return lambda sweep, rng: columns(
        sweep, **{name: sweep.values(other), other: sweep.values(name)}
    )


def turned(sweep: Readings, rng: np.random.Generator) -> Readings:
    angle = np.radians(either(rng, 3, 10))
    x, y, c, s = sweep.values("force_x"), sweep.values("force_y"), np.cos(angle), np.sin(angle)
    return columns(sweep, force_x=c * x + s * y, force_y=c * y - s * x)


def displaced(sweep: Readings, rng: np.random.Generator) -> Readings:
    lever = either(rng, 0.03, 0.1)
    return columns(sweep, moment_z=sweep.values("moment_z") + lever * sweep.values("force_x"))


def about_the_tip(sweep: Readings, rng: np.random.Generator) -> Readings:
    """A simulator's moment, about where the tip of the straight vibrissa is."""
    return columns(sweep, moment_z=sweep.values("moment_z") - sweep.values("force_x"))


def times(factor: Callable[[np.random.Generator], float]) -> Sensor:
    """All readings larger by one factor."""

    def larger(sweep: Readings, rng: np.random.Generator) -> Readings:
        by = factor(rng)
        return each(lambda values, rng: by * values)(sweep, rng)

    return larger


def far(rng: np.random.Generator) -> float:
    return 10.0 ** (rng.uniform(0.8, 4) * rng.choice([-1, 1]))


def crosstalk(sweep: Readings, rng: np.random.Generator) -> Readings:
    onto, of = rng.permutation(CLAMP_READINGS)[:2]
    values, other = sweep.values(onto), sweep.values(of)
    by = either(rng, 0.05, 0.2) * largest(values) / largest(other)
    return columns(sweep, **{onto: values + by * other})


def humming(sweep: Readings, rng: np.random.Generator) -> Readings:
    turns = 2 * np.pi * np.arange(len(sweep.table)) / rng.uniform(2.5, 12)

    def hum(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
        size = rng.uniform(0.02, 0.05) * largest(values)
        return values + size * np.sin(turns + rng.uniform(0, 6))

    return each(hum)(sweep, rng)


def jittering(sweep: Readings, rng: np.random.Generator) -> Readings:
    """The foot is not where the stage says."""
    x = sweep.values("foot_x")
    order = np.argsort(x)
    there = x + rng.uniform(0.003, 0.01) * rng.standard_normal(len(x))
    return each(lambda values, rng: np.interp(there, x[order], values[order]))(sweep, rng)


def loud(sweep: Readings, rng: np.random.Generator) -> Readings:
    level = dict.fromkeys(CLAMP_READINGS, float(rng.uniform(0.02, 0.04)))
    return with_noise(sweep, level, int(rng.integers(1 << 30)))


def rows(pick: Callable[[int, np.random.Generator], np.ndarray]) -> Sensor:
    """The rows that are picked out of so many, in that order."""
    return lambda sweep, rng: replace(
        sweep, table=sweep.table.iloc[pick(len(sweep.table), rng)].reset_index(drop=True)
    )


def repeated(count: int, rng: np.random.Generator) -> np.ndarray:
    return np.sort(np.append(np.arange(count), rng.choice(count, count // 10, False)))


def block_again(count: int, rng: np.random.Generator) -> np.ndarray:
    """A twentieth of the rows, amid contact, is written twice: a log that was appended to."""
    end = int(rng.uniform(0.4, 0.6) * count)
    return np.r_[:end, end - count // 20 : count]


def lost(value: float) -> Sensor:
    """Amid contact, 5 to 15 % of the sweep."""

    def made(sweep: Readings, rng: np.random.Generator) -> Readings:
        row = np.arange(len(sweep.table))
        begin = int(rng.uniform(0.25, 0.6) * len(row))
        gone = (row >= begin) & (row < begin + int(rng.uniform(0.05, 0.15) * len(row)))
        return each(lambda values, rng: np.where(gone, value, values))(sweep, rng)

    return made


def ended(sweep: Readings, rng: np.random.Generator) -> Readings:
    """The vibrissa lets go well before it should."""
    touching = np.flatnonzero(np.abs(sweep.values("force_y")) > 0.02)
    last = touching[int(rng.uniform(0.6, 0.9) * len(touching))]
    there = np.arange(len(sweep.table)) < last
    return each(lambda values, rng: np.where(there, values, 0.0))(sweep, rng)


def held_on(least: float, most: float) -> Sensor:
    """The vibrissa does not let go for that fraction of the stations after it should."""

    def made(sweep: Readings, rng: np.random.Generator) -> Readings:
        force = np.abs(sweep.values("force_y"))
        row, last = np.arange(len(force)), np.flatnonzero(force > 0.1 * force.max())[-1]
        holds = (row > last) & (row <= last + 2 + rng.uniform(least, most) * len(row))
        return each(lambda values, rng: np.where(holds, values[last], values))(sweep, rng)

    return made


def standing(sweep: Readings, rng: np.random.Generator) -> Readings:
    """Amid contact all readings, or one, stay as they are for a tenth of the sweep."""
    row = np.arange(len(sweep.table))
    begin = int(rng.uniform(0.3, 0.5) * len(row))
    holds = (row >= begin) & (row < begin + len(row) // 10)
    which = one if rng.random() < 0.5 else each
    return which(lambda values, rng: np.where(holds, values[begin], values))(sweep, rng)
