"""Faults of the vibrissa, the stage and the sensor that leave a signature in the readings."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import pandas as pd

from analytic import CLAMP_READINGS
from analytic.numerics.arrays import Booleans, Floats
from analytic.problem.quantities import QUANTITIES
from analytic.problem.table import says
from compare.align.stations import interpolant
from compare.explain.signatures import Resolved, between, unit_of
from compare.explain.wiring import LARGER, scaled_alike
from compare.measure.measurement import Measurement
from compare.sense.record import direction

FootPlace: TypeAlias = Callable[[float, Floats], Floats]
"""Where the foot is in truth, by the size of a fault and where it is said to be."""

_STEP = 1e-3  # of a length, and so on: the size that a signature is taken from
LEVERS = {("moment_z", "force_x"): "along", ("moment_z", "force_y"): "across"}
"""What a sensor off the clamp takes for a moment: by reading and force, which way it is off."""
_FEWEST = 4  # stations of a stretch whose slope is worth something

_SOLVED: dict[str, Any] = tomllib.loads(
    Path(__file__).with_name("faults.toml").read_text(encoding="utf-8")
)


@dataclass(frozen=True)
class Cause:
    text: Callable[[float], str]  # the fault in words, by its size
    # Shape (3, stations); What a small fault adds to the readings for its size, over their largest
    # magnitudes.
    signature: Floats
    lowest: float  # sizes that such a fault can have
    highest: float
    # What a fault of a size adds, of the signature's shape, where that is more than linear and can
    # be solved; None if that size cannot.
    change: Callable[[float], Floats | None] | None = None
    # What it makes, at a size, of what another fault adds at foot positions; linear in that.
    acts: Callable[[float, Floats, Floats], Floats] | None = None
    needs_contour: bool = False

    def added(self, size: float) -> Floats | None:
        """What it adds at a size: its signature where it cannot be solved, as next to an edge."""
        linear = size * self.signature
        if self.change is None:
            return linear
        solved = self.change(size)
        return None if solved is None else np.where(np.isfinite(solved), solved, linear)

    def over(self, stations: Booleans) -> Cause:
        return self._seen(lambda added: added[:, stations])

    def through(self, mixes: Floats) -> Cause:
        """The same as a sensor sees it that mixes the readings, shape (3, 3)."""
        return self._seen(lambda added: mixes @ added)

    def _seen(self, by: Callable[[Floats], Floats]) -> Cause:
        def change(size: float) -> Floats | None:
            solved = None if self.change is None else self.change(size)
            return None if solved is None else by(solved)

        return replace(
            self, signature=by(self.signature), change=None if self.change is None else change
        )


def sensor_faults(true: Floats) -> Iterator[Cause]:
    """What a sensor makes of true readings, shape (3, stations), over their largest magnitudes."""
    of_largest = "of its largest magnitude"
    for one, name, row in zip(np.eye(3), CLAMP_READINGS, true, strict=True):
        only = one[:, None]
        text = f"gain of {name} {{:+.2%}} off, the other readings are right"
        yield Cause(text.format, only * row, *LARGER, acts=partial(_scaled, only))
        text = f"zero of {name} off by {{:+.2e}} {of_largest} at all stations"
        yield Cause(text.format, only * np.ones_like(row), -2.0, 2.0)
        text = f"drift of {name} by {{:+.2e}} {of_largest} over the sweep"
        yield Cause(text.format, only * np.linspace(0, 1, len(row)), -2.0, 2.0)
        text = f"{name} is not linear: a cubic part of {{:+.1%}} at its largest magnitude"
        yield Cause(text.format, only * row**3, -1.0, 1.0)
        for other, values in zip(CLAMP_READINGS, true, strict=True):
            if name != other and (name, other) not in LEVERS:
                text = f"crosstalk: {name} takes on {{:+.1%}} of {other}, each over its largest"
                yield Cause(text.format, only * values, -0.5, 0.5)


def physical_faults(
    found: Measurement, table: pd.DataFrame, true: Floats, scale: Floats
) -> Iterator[Cause]:
    """Faults of the vibrissa and the stage, those that need the contour last."""
    every = np.ones((3, 1))
    yield Cause(
        lambda size: scaled_alike(1 + size, "readings"), true, *LARGER, acts=partial(_scaled, every)
    )
    reference, name = found.reference, found.reference.running
    size_of, unit = reference.running_unit
    x, slope = table["at"].to_numpy(), slopes(table, true)
    places, rows = (
        reference.running_values,
        np.stack([reference.values(name) for name in CLAMP_READINGS]),
    )
    if "phase" in reference.table:
        rows[:, says(reference.table["phase"], "free")] = np.nan
    if (exact := Resolved.of(reference, x)) is not None:
        places, rows = exact.swept  # at far more stations than most references have

    def displaced(
        text: Callable[[float], str], only: Floats, most: float, rate: float | Floats, at: FootPlace
    ) -> Cause:
        """Some readings are of another place of the foot, which changes with the size by `rate`."""

        def change(size: float) -> Floats:
            seen = between(at(size, x), places, rows) / scale[:, None]
            return np.where(only > 0, seen - true, 0.0)

        def acts(size: float, added: Floats, foot_x: Floats) -> Floats:
            return np.where(only > 0, between(at(size, foot_x), foot_x, added), added)

        return Cause(text, only * slope * rate, -most, most, change, acts)

    taken = found.offset.value / size_of

    def offset(size: float) -> str:
        said = f"{name} {size:+.2e} {unit} off, the same at all stations: an offset (or a lag)"
        if taken:
            known = f"{taken:+.2e} {unit} that were taken off, so {size + taken:+.2e} {unit} in all"
            return f"{said} beside the {known}: something else that is off imitates an offset"
        see = ", see `--offset auto`" if name == "foot_x" and not found.offset.unknown else ""
        return f"{said}{see}"

    # Farther off the readings are no longer linear in it; `offset` is there for that.
    yield displaced(offset, every, 0.1, -size_of, lambda size, foot_x: foot_x - size * size_of)
    text = f"scale of the stage {{:+.2%}} off: {name} is too large by that, counted from 0"
    yield displaced(text.format, every, 0.2, -x, lambda size, foot_x: foot_x / (1 + size))
    way = direction(reference) * size_of
    for one, felt in zip(np.eye(3), CLAMP_READINGS, strict=True):
        text = f"{felt} lags by {{:+.2e}} {unit} of the clamp's way: its channel is late"
        yield displaced(text.format, one[:, None], 0.1, -way, lambda size, at: at - size * way)
    if exact is not None:
        yield from _solved(exact, table, scale)


def _scaled(by: Floats, size: float, rows: Floats, _: Floats) -> Floats:
    return np.asarray(rows * (1 + size * by))


def _solved(exact: Resolved, table: pd.DataFrame, scale: Floats) -> Iterator[Cause]:
    """The faults whose signatures the closed form gives, where it can be solved with them."""
    for fault, known in _SOLVED.items():
        stated, unit = _stated(exact, fault)
        least = 0.0 if "below_zero" in known and stated == 0 else known["least"]
        lowest, highest = least - stated / unit, known["most"] - stated / unit
        if "change" in known:
            lowest, highest = max(lowest, -known["change"]), known["change"]
        if not lowest < highest:
            continue  # what varies along the vibrissa has no such number
        change = partial(_change, exact, fault, scale)
        # Bent to one side, a vibrissa may lean over the object and not be solved.
        steps = ((step, change(step)) for step in (_STEP, -_STEP))
        slope = next((added / step for step, added in steps if added is not None), None)
        if slope is None:
            continue
        named = partial(_text, exact, fault)
        yield Cause(named, slope, lowest, highest, change, needs_contour=True)
        if fault == "radius":
            force = np.hypot(*table[["force_x_reference", "force_y_reference"]].to_numpy().T)
            text = "softness: the contact gives way by up to {:.1e} L"
            yield Cause(text.format, -slope * force / force.max(), 0.0, 0.1)


def _stated(exact: Resolved, fault: str) -> tuple[float, float]:
    """What the reference has of it, and its unit."""
    if fault == "clamp":
        return 0.0, 1.0
    if fault in ("object_size", "weight"):
        # Of a weight that is not stated too much would have to be solved.
        return 1.0, 1.0 if fault == "object_size" or any(exact.case.weight) else math.nan
    return QUANTITIES[fault].value(exact.case), unit_of(fault, exact.case) or math.nan


def _text(exact: Resolved, fault: str, size: float) -> str:
    """In units of L and EI, as all that is said of a sweep."""
    stated, unit = _stated(exact, fault)
    ours = exact.case.beam.length if fault == "tip_radius" else abs(unit)
    value, stated = (stated + size * unit) / ours, stated / ours
    inverse, stated_inverse = (1 / x if x > 0 else math.inf for x in (value, stated))
    cells = abs(0.5 / (1 / inverse - 1 / stated_inverse)) if inverse != stated_inverse else 0
    known = {"size": size, "value": value, "stated": stated, "cells": cells}
    known |= {"inverse": inverse, "stated_inverse": stated_inverse}
    wrong = value < 0 and "below_zero" in _SOLVED[fault]
    return str(_SOLVED[fault]["below_zero" if wrong else "text"].format(**known))


def _change(exact: Resolved, fault: str, scale: Floats, size: float) -> Floats | None:
    added = exact.change(fault, size)
    return None if added is None else added / scale[:, None]


def slopes(table: pd.DataFrame, true: Floats) -> Floats:
    """Derivative of the readings by the foot position, phase by phase."""
    slope = np.full_like(true, np.nan)
    phase, x = table["phase"].to_numpy(), table["at"].to_numpy()
    for here in np.split(np.arange(len(x)), np.flatnonzero(phase[1:] != phase[:-1]) + 1):
        if len(here) >= _FEWEST and np.ptp(x[here]) > 0:
            slope[:, here] = interpolant(x[here], true[:, here])(x[here], 1)
    return slope
