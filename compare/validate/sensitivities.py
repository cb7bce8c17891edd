"""What uncertain inputs do to the readings: derivatives of the closed form, and samples of it."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from analytic import CLAMP_READINGS, Case, InputError, Sweep, solve_sweep
from analytic.numerics.arrays import Floats
from compare.validate.stated import GAINS, INPUTS, Uncertainties, possible


@dataclass(frozen=True)
class Swept:
    """What a sensor reads of a case, over the stations of the nominal one."""

    readings: Floats  # shape (3, stations); NaN where the vibrissa is free or has no trusted state
    snap_off: float | None  # its foot position [length]


def swept(case: Case, changes: Mapping[str, float] | None = None) -> Swept:
    """The closed form's sweep of a case whose inputs are off, over the stations of the case."""
    changes = {} if changes is None else changes
    start, stop = (float(x) + changes.get("foot_x", 0.0) for x in case.foot_x[[0, -1]])
    varied = replace(case, sweep=Sweep(2, direction=case.sweep.direction))
    gains = np.ones((len(CLAMP_READINGS), 1))
    for name, by in changes.items():
        if name in GAINS:
            gains[GAINS.index(name)] += by
        elif name != "foot_x" and by != 0:
            varied = INPUTS[name].larger(varied, by)
    # A sweep has to start clear of the object: stations are put before the first one.
    number = case.sweep.stations
    step = (stop - start) / (number - 1)
    before = max(0, math.ceil((float(varied.foot_x[0]) - start) / -step))
    sweep = Sweep(number + before, start - before * step, stop, case.sweep.direction)
    found = solve_sweep(replace(varied, sweep=sweep))
    known = found.trusted & (found.table["phase"] != "free").to_numpy()
    readings = np.stack([np.where(known, found.values(n), np.nan) for n in CLAMP_READINGS])
    away = changes.get("foot_x", 0.0)
    return Swept(
        (gains * readings)[:, before:], None if found.snap_off is None else found.snap_off - away
    )


_STEP = 1e-4  # of an input's unit: derivatives are good to 1e-4 of their largest, next to a fold
_MOST_FAILED = 0.1  # fraction of the samples that may be of no solvable problem


@dataclass(frozen=True)
class Sensitivities:
    """What the inputs of a case do to its readings, over its stations."""

    foot_x: Floats  # shape (stations,); [length]
    # Shape (inputs, 3, stations); Derivative of the readings by each input, times its standard
    # uncertainty; NaN where the vibrissa is free.
    readings: Floats
    # Shape (inputs,); The same of the snap-off's foot position [length]; 0 where there is none.
    snap_off: Floats
    # Shape (samples, 3, stations); Change of the readings with all inputs off at once, drawn from
    # what is stated; NaN where the vibrissa is free.
    samples: Floats
    predicted: Floats  # shape (samples, 3, stations); What the derivatives make of the same draws

    def at(self, foot_x: Floats) -> "Sensitivities":
        """The same at other foot positions, interpolated."""
        order = np.argsort(self.foot_x)

        def between(values: Floats) -> Floats:
            rows = values.reshape(-1, len(order))[:, order]
            there = [np.interp(foot_x, self.foot_x[order], row) for row in rows]
            return np.reshape(there, (*values.shape[:-1], len(foot_x)))

        return replace(
            self,
            foot_x=foot_x,
            readings=between(self.readings),
            samples=between(self.samples),
            predicted=between(self.predicted),
        )


def sensitivities(case: Case, stated: Uncertainties, samples: int) -> Sensitivities:
    """Solve the case with its inputs changed, one by one and all at once."""
    nominal = swept(case)
    slopes = [_slope(case, name, nominal) for name in stated.inputs]
    shape = (len(slopes), *nominal.readings.shape)
    readings = np.array([slope for slope, _ in slopes]).reshape(shape)
    draws = stated.draws(samples, np.random.default_rng(0)) if slopes else np.zeros((0, 0))
    changed, drawn, failure = [], [], None
    for draw in draws.tolist():
        errors = {n: possible(case, n, x) for n, x in zip(stated.inputs, draw, strict=True)}
        try:
            one = swept(case, errors)
        except (InputError, ArithmeticError) as error:
            failure = error
            continue
        changed.append(one.readings - nominal.readings)
        drawn.append([*errors.values()])
    if len(draws) - len(drawn) > _MOST_FAILED * len(draws):
        what = f"so large that {len(draws) - len(drawn)} of {len(draws)} cases cannot be solved"
        remedy = f"state less, or check the units ({failure})"
        raise InputError("[uncertainty]", what, "of cases that can", remedy)
    drawn_ = np.array(drawn).reshape(len(drawn), len(slopes))
    standard = stated.standard
    return Sensitivities(
        case.foot_x,
        readings * standard[:, None, None],
        np.array([snap for _, snap in slopes]) * standard,
        np.array(changed).reshape(len(drawn), *nominal.readings.shape),
        np.tensordot(drawn_, readings, axes=1),
    )


def _slope(case: Case, name: str, nominal: Swept) -> tuple[Floats, float]:
    """Derivative of the readings and of the snap-off by an input, on both sides if there are."""
    if name in GAINS:
        only = np.zeros_like(nominal.readings)
        only[GAINS.index(name)] = nominal.readings[GAINS.index(name)]
        return np.where(np.isnan(nominal.readings), np.nan, only), 0.0
    kind = INPUTS[name]
    step = _STEP * kind.unit(case)
    after = swept(case, {name: step})
    one_sided = kind.positive and kind.value(case) < step
    before = nominal if one_sided else swept(case, {name: -step})
    width = step if one_sided else 2 * step
    snap = 0.0
    if after.snap_off is not None and before.snap_off is not None:
        snap = (after.snap_off - before.snap_off) / width
    return (after.readings - before.readings) / width, snap
