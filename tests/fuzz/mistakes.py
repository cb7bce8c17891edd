"""Mistakes of a rig or a simulator, planted in random sweeps: how often each is named rightly.

``python -m tests.fuzz.mistakes SEEDS [FIRST]`` prints a row a mistake: how often its own name was
given, how often none, and which wrong ones. Every sweep is past a contour of its own, with the
smooth error that a chain has and white noise of up to 0.5 %.
"""

import sys
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace

import numpy as np
import pandas as pd

from analytic import (
    CLAMP_READINGS,
    SENSED,
    Case,
    InputError,
    Readings,
    Sweep,
    catenary,
    circle,
    ellipse,
    parabola,
    solve_sweep,
    two_circles,
)
from compare import compare
from compare.sense.noise import with_noise

_OWN_ERROR = (3e-4, 1.2e-3)  # of a reading's largest magnitude: a chain of 40 segments and more
_NOISE = 5e-3
_SEGMENTS = 40
SOFT = 8.0  # EI/L; a clamp that is known to give way


def random_case(rng: np.random.Generator) -> Case:
    """A smooth contour, and a sweep past it."""
    height = rng.uniform(0.35, 0.65)
    contour = (
        lambda: catenary(rng.uniform(0.3, 1.0), height - 1),
        lambda: parabola(rng.uniform(0.2, 1.0), height),
        lambda: circle(rng.uniform(0.3, 2.0), (0.0, height)),
        lambda: ellipse((rng.uniform(0.5, 2.0), rng.uniform(0.5, 1.5)), (0.0, height)),
        lambda: two_circles(rng.uniform(0.5, 2.0), rng.uniform(0.5, 2.0), (0.0, height)),
    )[rng.integers(5)]
    return Case(profile=contour(), sweep=Sweep(int(rng.integers(100, 260))))


def with_own_error(sweep: Readings, rng: np.random.Generator, size: float) -> Readings:
    """The readings of a model that is a little off, smoothly, and from segment to segment."""
    progress = np.linspace(0, 1, len(sweep.table))
    columns = {}
    for name in CLAMP_READINGS:
        values = sweep.values(name)
        waves = sum(
            rng.normal() * np.cos(k * np.pi * progress + rng.uniform(0, 2 * np.pi))
            for k in range(1, 5)
        )
        steps = np.sin(2 * np.pi * _SEGMENTS * progress + rng.uniform(0, 2 * np.pi))
        shape = np.where(values != 0, waves + 0.5 * steps, 0.0)
        scale = size * np.nanmax(np.abs(values)) / np.sqrt(np.mean(shape**2))
        columns[name] = values + scale * shape
    return replace(sweep, table=sweep.table.assign(**columns))


Swept = Callable[[Case, np.random.Generator], Readings]
Sensor = Callable[[Readings, np.random.Generator], Readings]


def _of(case: Case, earlier: float = 0.0, **beam: float) -> Readings:
    """The sweep of another vibrissa, begun clear of the object, which claims to be the case's."""
    start, stop = (float(x) for x in case.foot_x[[0, -1]])
    sweep = replace(case.sweep, start=start + earlier, stop=stop)
    wrong = solve_sweep(replace(case, beam=replace(case.beam, **beam), sweep=sweep))
    return replace(wrong, beam=case.beam)


def _between(rng: np.random.Generator, low: float, high: float) -> float:
    """A size of either sign."""
    return float(rng.uniform(low, high) * rng.choice([-1, 1]))


def _beam(name: str, low: float, high: float, sign: bool = True) -> Swept:
    """A number of the beam that is off by a fraction of it."""

    def swept(case: Case, rng: np.random.Generator) -> Readings:
        by = _between(rng, low, high) if sign else float(rng.uniform(low, high))
        return _of(case, 0.05, **{name: getattr(case.beam, name) * (1 + by)})

    return swept


def _held(**support: tuple[float, float]) -> Swept:
    """The sweep of a vibrissa held otherwise, of which nothing is said."""

    def swept(case: Case, rng: np.random.Generator) -> Readings:
        numbers = {name: float(rng.uniform(*limits)) for name, limits in support.items()}
        return solve_sweep(replace(case, **numbers))

    return swept


def _softer(case: Case, rng: np.random.Generator) -> Readings:
    return solve_sweep(replace(case, clamp_stiffness=SOFT * (1 + _between(rng, 0.1, 0.3))))


def _curved(case: Case, rng: np.random.Generator) -> Readings:
    return _of(case, 0.3, natural_curvature=_between(rng, 0.05, 0.4))


def _tapered(case: Case, rng: np.random.Generator) -> Readings:
    return _of(case, 0.3, tip_radius=float(rng.uniform(0.5, 0.95)) * case.beam.radius)


def _columns(sweep: Readings, **columns: np.ndarray) -> Readings:
    return replace(sweep, table=sweep.table.assign(**columns))


def _on(name: str, act: Callable[[np.ndarray, np.random.Generator], np.ndarray]) -> Sensor:
    """A mistake in a column of that name."""
    return lambda sweep, rng: _columns(sweep, **{name: act(sweep.values(name), rng)})


def _one(act: Callable[[np.ndarray, np.random.Generator], np.ndarray]) -> Sensor:
    """A mistake in one reading, drawn at random."""

    def made(sweep: Readings, rng: np.random.Generator) -> Readings:
        name = str(rng.choice(CLAMP_READINGS))
        return _columns(sweep, **{name: act(sweep.values(name), rng)})

    return made


def _each(act: Callable[[np.ndarray, np.random.Generator], np.ndarray]) -> Sensor:
    """The same in every reading."""
    return lambda sweep, rng: _columns(
        sweep, **{name: act(sweep.values(name), rng) for name in CLAMP_READINGS}
    )


def _largest(values: np.ndarray) -> float:
    return float(np.abs(values).max())


def _gain(low: float, high: float) -> Callable[[np.ndarray, np.random.Generator], np.ndarray]:
    return lambda values, rng: values * (1 + _between(rng, low, high))


def _zero(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    return values + _between(rng, 0.03, 0.1) * _largest(values)


def _drifting(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    by = _between(rng, 0.05, 0.2) * _largest(values)
    return values + by * np.linspace(0, 1, len(values))


def _swapped(sweep: Readings, rng: np.random.Generator) -> Readings:
    return _columns(sweep, force_x=sweep.values("force_y"), force_y=sweep.values("force_x"))


def _turned(sweep: Readings, rng: np.random.Generator) -> Readings:
    angle = np.radians(_between(rng, 3, 10))
    x, y, c, s = sweep.values("force_x"), sweep.values("force_y"), np.cos(angle), np.sin(angle)
    return _columns(sweep, force_x=c * x + s * y, force_y=c * y - s * x)


def _displaced(sweep: Readings, rng: np.random.Generator) -> Readings:
    lever = _between(rng, 0.03, 0.1)
    return _columns(sweep, moment_z=sweep.values("moment_z") + lever * sweep.values("force_x"))


def _all_units(sweep: Readings, rng: np.random.Generator) -> Readings:
    factor = rng.choice([1000.0, 9.80665, 1 / 9.80665])
    return _columns(sweep, **{name: factor * sweep.values(name) for name in CLAMP_READINGS})


def _opposite(case: Case, rng: np.random.Generator) -> Readings:
    return solve_sweep(replace(case, sweep=Sweep(case.sweep.stations, direction="right")))


def _rows(sweep: Readings, rows: Iterable[int]) -> Readings:
    return replace(sweep, table=sweep.table.iloc[list(rows)].reset_index(drop=True))


def _reversed(sweep: Readings, rng: np.random.Generator) -> Readings:
    return _rows(sweep, range(len(sweep.table))[::-1])


def _shuffled(sweep: Readings, rng: np.random.Generator) -> Readings:
    return _rows(sweep, rng.permutation(len(sweep.table)))


def _repeated(sweep: Readings, rng: np.random.Generator) -> Readings:
    rows = len(sweep.table)
    return _rows(sweep, np.sort(np.append(np.arange(rows), rng.choice(rows, rows // 10, False))))


def _stretch(sweep: Readings, rng: np.random.Generator) -> slice:
    """Amid contact, 5 to 15 % of the sweep."""
    rows = len(sweep.table)
    begin = int(rng.uniform(0.25, 0.6) * rows)
    return slice(begin, begin + int(rng.uniform(0.05, 0.15) * rows))


def _lost(value: float) -> Sensor:
    def made(sweep: Readings, rng: np.random.Generator) -> Readings:
        table = sweep.table.copy()
        table.loc[table.index[_stretch(sweep, rng)], list(CLAMP_READINGS)] = value
        return replace(sweep, table=table)

    return made


def _spiked(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """One to three single values far off, amid contact."""
    values, rows = values.copy(), len(values)
    at = int(rng.uniform(0.3, 0.5) * rows) + 5 * np.arange(rng.integers(1, 4))
    values[at] += rng.choice([-1, 1]) * rng.uniform(1, 100) * _largest(values)
    return values


def _clipped(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    limit = np.quantile(np.abs(values), rng.uniform(0.7, 0.9))
    return np.clip(values, -limit, limit)


def _two(sweep: Readings, rng: np.random.Generator) -> Readings:
    """Two gains and a zero that have nothing to do with each other."""
    x, m = sweep.values("force_x"), sweep.values("moment_z")
    return _columns(sweep, force_x=1.08 * x, moment_z=m + 0.06 * _largest(m))


def _exchanged(sweep: Readings, rng: np.random.Generator) -> Readings:
    force = str(rng.choice(["force_x", "force_y"]))
    return _columns(sweep, **{force: sweep.values("moment_z"), "moment_z": sweep.values(force)})


def _later(values: np.ndarray, by: float) -> np.ndarray:
    rows = np.arange(len(values))
    return np.interp(rows - by, rows, values)


def _late(sweep: Readings, rng: np.random.Generator) -> Readings:
    """A delay of all channels alike."""
    by = float(rng.uniform(2, 6))
    return _columns(sweep, **{name: _later(sweep.values(name), by) for name in CLAMP_READINGS})


def _cubic(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    return values * (1 + _between(rng, 0.05, 0.3) * (values / _largest(values)) ** 2)


def _crosstalk(sweep: Readings, rng: np.random.Generator) -> Readings:
    onto, of = rng.permutation(CLAMP_READINGS)[:2]
    values, other = sweep.values(onto), sweep.values(of)
    by = _between(rng, 0.05, 0.2) * _largest(values) / _largest(other)
    return _columns(sweep, **{onto: values + by * other})


def _humming(sweep: Readings, rng: np.random.Generator) -> Readings:
    turns = 2 * np.pi * np.arange(len(sweep.table)) / rng.uniform(2.5, 12)
    return _columns(
        sweep,
        **{
            name: sweep.values(name)
            + rng.uniform(0.02, 0.05)
            * _largest(sweep.values(name))
            * np.sin(turns + rng.uniform(0, 6))
            for name in CLAMP_READINGS
        },
    )


def _stepped(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    step = rng.uniform(0.03, 0.08) * _largest(values)
    return step * np.round(values / step)


def _jittering(sweep: Readings, rng: np.random.Generator) -> Readings:
    """The foot is not where the stage says."""
    x = sweep.values("foot_x")
    order = np.argsort(x)
    there = x + rng.uniform(0.003, 0.01) * rng.standard_normal(len(x))
    return _columns(
        sweep,
        **{n: np.interp(there, x[order], sweep.values(n)[order]) for n in CLAMP_READINGS},
    )


def _raised(case: Case, rng: np.random.Generator) -> Readings:
    start, stop = (float(x) for x in case.foot_x[[0, -1]])
    there = case.profile.raised(_between(rng, 0.005, 0.02))
    return solve_sweep(
        replace(case, profile=there, sweep=replace(case.sweep, start=start + 0.05, stop=stop))
    )


def _sized(case: Case, rng: np.random.Generator) -> Readings:
    """An object of the same shape, larger or smaller about its lowest point, which is at x = 0."""
    start, stop = (float(x) for x in case.foot_x[[0, -1]])
    by, lowest = _between(rng, 0.05, 0.2), float(case.outline(1000)[1].min())
    there = case.profile.scaled(1 + by).raised(-by * lowest)
    sweep = replace(case.sweep, start=start + 0.2, stop=stop)
    return solve_sweep(replace(case, profile=there, sweep=sweep))


def _ended(sweep: Readings, rng: np.random.Generator) -> Readings:
    """The vibrissa lets go well before it should."""
    table = sweep.table.copy()
    touching = np.flatnonzero(np.abs(sweep.values("force_y")) > 0.02)
    last = touching[int(rng.uniform(0.6, 0.9) * len(touching))]
    table.loc[table.index[last:], list(CLAMP_READINGS)] = 0.0
    return replace(sweep, table=table)


def _whole_first_cell(case: Case, rng: np.random.Generator) -> Readings:
    """A hinge at the clamp that gives way like all others: half a cell too much."""
    return solve_sweep(replace(case, clamp_stiffness=2.0 * float(rng.integers(10, 41))))


def _rigid_first_half(case: Case, rng: np.random.Generator) -> Readings:
    """No hinge in the first half cell."""
    by = 0.5 / float(rng.integers(10, 41))
    start, stop = (float(x) for x in case.foot_x[[0, -1]])
    rest = replace(case, beam=replace(case.beam, length=1 - by), profile=case.profile.raised(-by))
    sweep = solve_sweep(replace(rest, sweep=replace(case.sweep, start=start + 0.05, stop=stop)))
    moment = sweep.values("moment_z") - by * sweep.values("force_x")
    return replace(_columns(sweep, moment_z=moment), beam=case.beam)


def _softer_and_rubbing(case: Case, rng: np.random.Generator) -> Readings:
    softer = case.beam.flexural_rigidity * (1 + _between(rng, 0.1, 0.3))
    beam = replace(case.beam, flexural_rigidity=softer)
    swept = solve_sweep(replace(case, beam=beam, friction=float(rng.uniform(0.05, 0.2))))
    return replace(swept, beam=case.beam)


def _both(first: Sensor, second: Sensor) -> Sensor:
    return lambda sweep, rng: second(first(sweep, rng), rng)


def _coarse(sweep: Readings, rng: np.random.Generator) -> Readings:
    return with_own_error(sweep, rng, rng.uniform(0.01, 0.03))


def _loud(sweep: Readings, rng: np.random.Generator) -> Readings:
    level = dict.fromkeys(CLAMP_READINGS, float(rng.uniform(0.02, 0.04)))
    return with_noise(sweep, level, int(rng.integers(1 << 30)))


@dataclass(frozen=True)
class Mistake:
    """What is planted, and the words that name it, apart by "&"; none where nothing should be.

    What need not be named has `must` False.
    `swept` is a sweep that is wrong itself, `sensed` what the sensor makes of it before its noise,
    and `recorded` what the file makes of that. `stated` is what the case says of the support.
    """

    named: str | None
    swept: Swept | None = None
    sensed: Sensor | None = None
    recorded: Sensor | None = None
    must: bool = True
    stated: dict[str, float] = field(default_factory=dict)


_OFFSET = _on("foot_x", lambda v, rng: v + _between(rng, 0.01, 0.03))
# A stage that counts its way the other way, from an origin of its own or the world's.
_BACKWARDS = _on("foot_x", lambda v, rng: rng.choice([0.0, rng.uniform(-0.5, 0.5)]) - v)
MISTAKES: dict[str, Mistake] = {
    "flexural rigidity": Mistake("flexural rigidity", _beam("flexural_rigidity", 0.03, 0.3)),
    "length": Mistake("length of the vibrissa", _beam("length", 0.01, 0.03)),
    "radius": Mistake("radius of the vibrissa", _beam("radius", 1.5, 5, sign=False)),
    "soft clamp": Mistake("clamp stiffness", _held(clamp_stiffness=(5.0, 50.0))),
    "clamp stiffness": Mistake("clamp stiffness", _softer, stated={"clamp_stiffness": SOFT}),
    "friction": Mistake("friction", _held(friction=(0.05, 0.2))),
    "friction stated": Mistake("friction", _held(friction=(0.3, 0.5)), stated={"friction": 0.2}),
    "natural curvature": Mistake("natural curvature", _curved),
    "taper": Mistake("tip radius", _tapered),
    "offset of the stage": Mistake("foot_x", sensed=_OFFSET),
    "gain": Mistake("gain of", sensed=_one(_gain(0.05, 0.3))),
    "zero": Mistake("zero of", sensed=_one(_zero)),
    "gravity": Mistake("constant load", sensed=_each(_zero)),
    "drift": Mistake("drift of", sensed=_one(_drifting)),
    "axes swapped": Mistake("force_x and force_y swapped", sensed=_swapped),
    "one sign": Mistake("opposite sign of", sensed=_one(lambda v, rng: -v)),
    "all signs": Mistake(
        "all three readings have the opposite sign", sensed=_each(lambda v, rng: -v)
    ),
    "sensor turned": Mistake("sensor turned by", sensed=_turned),
    "sensor displaced": Mistake("along the vibrissa off the clamp", sensed=_displaced),
    "unit of one": Mistake(
        "in another unit",
        sensed=_one(lambda v, rng: v * rng.choice([1000.0, 0.001, 9.80665, 1 / 9.80665])),
    ),
    "unit of all": Mistake("all readings in another unit", sensed=_all_units),
    "dead channel": Mistake("dead channel", sensed=_one(lambda v, rng: 0 * v)),
    "opposite direction": Mistake("opposite direction of travel", _opposite),
    "reversed rows": Mistake("rows reversed", recorded=_reversed),
    "foot_x backwards": Mistake("foot_x counts the other way", recorded=_BACKWARDS),
    "shuffled rows": Mistake("rows out of order", recorded=_shuffled),
    "repeated rows": Mistake("repeat the row before", recorded=_repeated),
    "gap": Mistake("lack a number", recorded=_lost(np.nan)),
    "dropout": Mistake("filled with zeros", recorded=_lost(0.0)),
    "spikes": Mistake("single stations", recorded=_one(_spiked)),
    "saturation": Mistake("cut off at the extreme", recorded=_one(_clipped)),
    "no contact": Mistake("never touches", recorded=_each(lambda v, rng: 0 * v)),
    "noise": Mistake("noise: differences jump", sensed=_loud),
    "two at once": Mistake("gain of force_x & zero of moment_z", sensed=_two),
    "exchanged with the moment": Mistake("and moment_z swapped", sensed=_exchanged),
    "delay of one": Mistake("lags", sensed=_one(lambda v, rng: _later(v, rng.uniform(2, 6)))),
    "delay of all": Mistake("or a lag", sensed=_late),
    "drift of all": Mistake("drift of all", sensed=_each(_drifting)),
    "gain and zero": Mistake(
        "gain of & zero of", sensed=_one(lambda v, rng: _zero(_gain(0.05, 0.3)(v, rng), rng))
    ),
    "cubic": Mistake("cubic", sensed=_one(_cubic)),
    "crosstalk": Mistake("crosstalk", sensed=_crosstalk),
    "hum": Mistake("hum", sensed=_humming),
    "steps": Mistake("quantised", recorded=_one(_stepped)),
    "jitter of the foot": Mistake("jitter", sensed=_jittering),
    "scale of the stage": Mistake("scale of the stage", sensed=_on("foot_x", _gain(0.01, 0.04))),
    "object raised": Mistake("height of the object", _raised),
    "object size": Mistake("size of the object", _sized),
    "contact ends early": Mistake("ends early", recorded=_ended),
    "whole first cell": Mistake("half a cell", _whole_first_cell),
    "rigid first half cell": Mistake("rigid over its first", _rigid_first_half),
    "rigidity and friction": Mistake("flexural rigidity & friction", _softer_and_rubbing),
    "soft clamp and offset": Mistake(
        "clamp stiffness & foot_x", _held(clamp_stiffness=(5.0, 20.0)), sensed=_OFFSET
    ),
    "gain and drift": Mistake(
        "gain of force_y & drift of moment_z",
        sensed=_both(
            _on("force_y", _gain(0.05, 0.3)),
            _on("moment_z", _drifting),
        ),
    ),
    "sign and zero": Mistake(
        "opposite sign of force_x & zero of force_y",
        sensed=_both(_on("force_x", lambda v, rng: -v), _on("force_y", _zero)),
    ),
    "swap and rigidity": Mistake(
        "swapped & flexural rigidity", _beam("flexural_rigidity", 0.05, 0.3), _swapped
    ),
    "a coarse model": Mistake(None, sensed=_coarse, must=False),
}


def named(mistake: Mistake, seed: int) -> str | None:
    """What the comparison calls a mistake planted at random; None if it names nothing."""
    rng = np.random.default_rng(seed)
    while True:
        case = replace(random_case(rng), **mistake.stated)
        reference = solve_sweep(case)
        try:
            sweep = reference if mistake.swept is None else mistake.swept(case, rng)
            break
        except InputError:  # the vibrissa as it really is does not come past that object
            continue
    sweep = with_own_error(sweep, rng, rng.uniform(*_OWN_ERROR))
    noise = dict.fromkeys(CLAMP_READINGS, float(rng.uniform(0, _NOISE)) * rng.integers(2))
    if mistake.sensed is not None:
        sweep = mistake.sensed(sweep, rng)
    sweep = with_noise(sweep, noise, seed)
    if mistake.recorded is not None:
        sweep = mistake.recorded(sweep, rng)
    candidate = Readings(sweep.table[list(SENSED)], case.beam, "rig")
    found = compare(reference, candidate)
    return found.likely or "; ".join(found.records["candidate"].defects()) or None


def confusion(seeds: Iterable[int]) -> pd.DataFrame:
    """A row a mistake: how often it was named rightly, not at all, and wrongly, and as what."""
    rows = []
    for kind, mistake in MISTAKES.items():
        right, silent, wrong = 0, 0, Counter[str]()
        for seed in seeds:
            said = named(mistake, seed)
            if said is None:
                silent += 1
            elif mistake.named and all(word in said for word in mistake.named.split(" & ")):
                right += 1
            else:
                wrong[f"{seed}: {said[:60]}"] += 1
        print(f"{kind}: {right} right, {silent} silent", file=sys.stderr, flush=True)
        rows.append((kind, right, silent, wrong.total(), "; ".join(wrong)))
    return pd.DataFrame(rows, columns=["mistake", "right", "silent", "wrong", "as"])


def main() -> None:
    """Print the table, and the shares."""
    seeds, first = (*map(int, sys.argv[1:]), *(10, 0)[len(sys.argv) - 1 :])
    table = confusion(range(first, first + seeds))
    print(table.to_string(index=False, max_colwidth=None))
    known = [mistake.must for mistake in MISTAKES.values()]
    trials = seeds * sum(known)
    print(f"named rightly: {table[known]['right'].sum() / trials:.1%} of {trials}")
    print(
        f"named wrongly: {table['wrong'].sum() / (seeds * len(table)):.1%} of {seeds * len(table)}"
    )


if __name__ == "__main__":
    main()
