"""Faults of the vibrissa, the stage and the sensor that leave a signature in the readings."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np
import pandas as pd

from analytic import CLAMP_READINGS
from analytic.problem.arrays import Floats
from analytic.problem.quantities import QUANTITIES
from compare.align.stations import interpolant
from compare.explain.signatures import Fault, Resolved, unit_of
from compare.measure.measurement import Measurement

_STEP = 1e-3  # of a length, and so on: the size that a signature is taken from
_FEWEST = 4  # stations of a stretch whose slope is worth something

# What a fault is called, and the least and the largest value that it leaves, in its unit: what is
# off by more would hardly be the same experiment.
_SOLVED: dict[Fault, tuple[str, float, float]] = {
    "length": ("length of the vibrissa {size:+.2%} off", 0.8, 1.2),
    "radius": (
        "radius of the vibrissa {size:+.2e} L off (it is {stated:.2e} L), or the object's surface "
        "as much too low",
        -math.inf,
        math.inf,
    ),
    "clamp": (
        "discretisation of first order: the vibrissa is rigid over its first {size:.2%}, as with a "
        "whole rigid segment at the clamp",
        0.0,
        0.2,
    ),
    "clamp_compliance": (
        "clamp stiffness about {inverse:.3g} EI/L, not {stated_inverse:.3g}: the clamp gives way "
        "otherwise than stated",
        0.0,
        math.inf,
    ),
    "friction": (
        "friction about {value:.3g}, not {stated:.3g}: the object rubs otherwise than stated",
        0.0,
        1.0,
    ),
    "natural_curvature": (
        "natural curvature about {value:+.3g} /L, not {stated:.3g}: the vibrissa at rest is bent "
        "otherwise than stated",
        -1.5,
        1.5,
    ),
    "tip_radius": (
        "tip radius about {value:.2e} L, not {stated:.2e}: the vibrissa is a cone, or another one",
        -1.0,
        -0.05,
    ),
}
_LARGEST = {"radius": 0.1, "clamp_compliance": 2.0}  # of which only the change is limited


@dataclass(frozen=True)
class Cause:
    """A fault and what it does to the readings."""

    text: Callable[[float], str]  # the fault in words, by its size
    # Shape (3, stations); What a small fault adds to the readings for its size, over their largest
    # magnitudes.
    signature: Floats
    lowest: float  # sizes that such a fault can have
    highest: float
    # What a fault of a size adds, of the signature's shape, where that is more than linear and can
    # be solved; None if that size cannot.
    change: Callable[[float], Floats | None] | None = None


def causes(found: Measurement, table: pd.DataFrame, true: Floats, scale: Floats) -> Iterator[Cause]:
    """The known faults, those that need the contour last."""
    # A radius that is a third off makes the rigidity 0.2 to 3.2 times what it should be.
    yield Cause("flexural rigidity {:+.2%} off: all readings scale alike".format, true, -0.8, 2.2)
    text = (
        "foot_x {:+.2e} L off, the same at all stations: an offset (or a lag), see `--offset auto`"
    )
    # Farther off the readings are no longer linear in it; `offset` is there for that.
    length = found.reference.beam.length
    yield Cause(text.format, -length * slopes(table, true), -0.1, 0.1)
    of_largest = "of its largest magnitude"
    for one, name, row in zip(np.eye(3), CLAMP_READINGS, true, strict=True):
        only = one[:, None]
        text = f"gain of {name} {{:+.2%}} off, the other readings are right"
        yield Cause(text.format, only * row, -0.8, 2.0)
        text = f"zero of {name} off by {{:+.2e}} {of_largest} at all stations"
        yield Cause(text.format, only * np.ones_like(row), -2.0, 2.0)
        text = f"drift of {name} by {{:+.2e}} {of_largest} over the sweep"
        yield Cause(text.format, only * np.linspace(0, 1, len(row)), -2.0, 2.0)
    exact = Resolved.of(found.reference, table["foot_x"].to_numpy())
    if exact is not None:
        yield from _solved(exact, table, scale)


def _solved(exact: Resolved, table: pd.DataFrame, scale: Floats) -> Iterator[Cause]:
    """The faults whose signatures the closed form gives, where it can be solved with them."""
    for fault, (_, least, most) in _SOLVED.items():
        stated, unit = _stated(exact, fault)
        lowest, highest = least - stated / unit, most - stated / unit
        if fault in _LARGEST:
            lowest, highest = max(lowest, -_LARGEST[fault]), _LARGEST[fault]
        if not lowest < highest:
            continue  # what varies along the vibrissa has no such number
        change = partial(_change, exact, fault, scale)
        # Bent to one side, a vibrissa may lean over the object and not be solved.
        steps = ((step, change(step)) for step in (_STEP, -_STEP))
        slope = next((added / step for step, added in steps if added is not None), None)
        if slope is None:
            continue
        yield Cause(partial(_text, exact, fault), slope, lowest, highest, change)
        if fault == "radius":
            force = np.hypot(*table[["force_x_reference", "force_y_reference"]].to_numpy().T)
            text = "softness: the contact gives way by up to {:.1e} L"
            yield Cause(text.format, -slope * force / force.max(), 0.0, 0.1)


def _stated(exact: Resolved, fault: Fault) -> tuple[float, float]:
    """What the reference has of it, and its unit."""
    if fault == "clamp":
        return 0.0, 1.0
    return QUANTITIES[fault].value(exact.case), unit_of(fault, exact.case) or math.nan


def _text(exact: Resolved, fault: Fault, size: float) -> str:
    """In units of L and EI, as all that is said of a sweep."""
    stated, unit = _stated(exact, fault)
    ours = exact.case.beam.length if fault == "tip_radius" else abs(unit)
    value, stated = (stated + size * unit) / ours, stated / ours
    inverse, stated_inverse = (1 / x if x > 0 else math.inf for x in (value, stated))
    return _SOLVED[fault][0].format(
        size=size,
        value=value,
        stated=stated,
        inverse=inverse,
        stated_inverse=stated_inverse,
    )


def _change(exact: Resolved, fault: Fault, scale: Floats, size: float) -> Floats | None:
    added = exact.change(fault, size)
    return None if added is None else added / scale[:, None]


def slopes(table: pd.DataFrame, true: Floats) -> Floats:
    """Derivative of the readings by the foot position, phase by phase."""
    slope = np.full_like(true, np.nan)
    phase, x = table["phase"].to_numpy(), table["foot_x"].to_numpy()
    for here in np.split(np.arange(len(x)), np.flatnonzero(phase[1:] != phase[:-1]) + 1):
        if len(here) >= _FEWEST and np.ptp(x[here]) > 0:
            slope[:, here] = interpolant(x[here], true[:, here])(x[here], 1)
    return slope
