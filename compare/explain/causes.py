"""Faults of the vibrissa, the stage and the sensor that leave a signature in the readings."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

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


@dataclass(frozen=True)
class Cause:
    """A fault and what it does to the readings."""

    text: Callable[[float], str]  # the fault in words, by its size
    # Shape (3, stations); What a small fault adds to the readings for its size, over their largest
    # magnitudes.
    signature: Floats
    lowest: float  # sizes that such a fault can have
    highest: float  # sizes that such a fault can have
    # What a fault of a size adds, of the signature's shape, where that is more than linear and can
    # be solved; None if that size cannot.
    change: Callable[[float], Floats | None] | None = None


def causes(found: Measurement, table: pd.DataFrame, true: Floats, scale: Floats) -> Iterator[Cause]:
    """The known faults, those that need the contour last."""
    length = found.reference.beam.length
    # A radius that is a third off makes the rigidity 0.2 to 3.2 times what it should be.
    yield Cause("flexural rigidity {:+.2%} off: all readings scale alike".format, true, -0.8, 2.2)
    # Farther off the readings are no longer linear in it; `offset` is there for that.
    yield Cause(
        "foot_x {:+.2e} off, the same at all stations: an offset (or a lag), see "
        "`--offset auto`".format,
        -slopes(table, true),
        -0.1 * length,
        0.1 * length,
    )
    progress = np.linspace(0, 1, true.shape[1])
    for i, name in enumerate(CLAMP_READINGS):
        yield Cause(
            f"gain of {name} {{:+.2%}} off, the other readings are right".format,
            _only(i, true[i], true),
            -0.8,
            2.0,
        )
        yield Cause(
            f"zero of {name} off by {{:+.2e}} of its largest magnitude at all stations".format,
            _only(i, np.ones_like(progress), true),
            -2.0,
            2.0,
        )
        yield Cause(
            f"drift of {name} by {{:+.2e}} of its largest magnitude over the sweep".format,
            _only(i, progress, true),
            -2.0,
            2.0,
        )
    exact = Resolved.of(found.reference, table["foot_x"].to_numpy())
    if exact is not None:
        yield from _solved(exact, table, scale)


def _solved(exact: Resolved, table: pd.DataFrame, scale: Floats) -> Iterator[Cause]:
    """The faults whose signatures the closed form gives, where it can be solved with them."""
    case, beam, length = exact.case, exact.case.beam, exact.case.beam.length
    held = f"{case.clamp_stiffness:.3g}" if math.isfinite(case.clamp_stiffness) else "rigid"

    def stated(fault: Fault) -> float:
        return QUANTITIES[fault].value(case) / (unit_of(fault, case) or math.nan)

    def clamp_stiffness(softer: float) -> float:
        by = softer * unit_of("clamp_compliance", case)
        return QUANTITIES["clamp_compliance"].larger(case, by).clamp_stiffness

    bent, cone = stated("natural_curvature"), -stated("tip_radius")
    said: dict[Fault, tuple[Callable[[float], str], float, float]] = {
        # What is off by more would hardly be the same experiment.
        "length": ("length of the vibrissa {:+.2%} off".format, -0.2, 0.2),
        "radius": (
            lambda size: (
                f"radius of the vibrissa {size * length:+.2e} off (it is {beam.radius:.2e}),"
                " or the object's surface as much too low"
            ),
            -0.1,
            0.1,
        ),
        "clamp": (
            "discretisation of first order: the vibrissa is rigid over its first {:.2%}, as with a "
            "whole rigid segment at the clamp".format,
            0.0,
            0.2,
        ),
        "clamp_compliance": (
            lambda size: (
                f"clamp stiffness about {clamp_stiffness(size):.3g}, not {held}:"
                " the clamp gives way otherwise than stated"
            ),
            -stated("clamp_compliance"),
            2.0,
        ),
        "friction": (
            lambda size: (
                f"friction about {case.friction + size:.3g}, not {case.friction:.3g}: the object"
                " rubs otherwise than stated"
            ),
            -case.friction,
            1.0 - case.friction,
        ),
        "natural_curvature": (
            lambda size: (
                f"natural curvature about {(bent + size) / length:+.3g}, not {bent / length:.3g}:"
                " the vibrissa at rest is bent otherwise than stated"
            ),
            -1.5 - bent,
            1.5 - bent,
        ),
        "tip_radius": (
            lambda size: (
                f"tip radius about {(cone - size) * beam.radius:.2e}, not"
                f" {cone * beam.radius:.2e}: the vibrissa is a cone, or another one"
            ),
            cone - 1.0,
            cone - 0.05,
        ),
    }
    for fault, (text, lowest, highest) in said.items():
        if not lowest < highest:
            continue  # what varies along the vibrissa has no such number

        def change(size: float, fault: Fault = fault) -> Floats | None:
            added = exact.change(fault, size)
            return None if added is None else added / scale[:, None]

        # Bent to one side, a vibrissa may lean over the object and not be solved.
        steps = ((step, change(step)) for step in (_STEP, -_STEP))
        slope = next((added / step for step, added in steps if added is not None), None)
        if slope is None:
            continue
        yield Cause(text, slope, lowest, highest, change)
        if fault == "radius":
            force = np.hypot(
                *(table[f"{name}_reference"].to_numpy() for name in CLAMP_READINGS[:2])
            )
            yield Cause(
                "softness: the contact gives way by up to {:.1e} L".format,
                -slope * force / force.max(),
                0.0,
                0.1,
            )


def slopes(table: pd.DataFrame, true: Floats) -> Floats:
    """Derivative of the readings by the foot position, phase by phase."""
    slope = np.full_like(true, np.nan)
    phase, x = table["phase"].to_numpy(), table["foot_x"].to_numpy()
    ends = np.flatnonzero(phase[1:] != phase[:-1]) + 1
    for begin, end in zip(np.append(0, ends), np.append(ends, len(x)), strict=True):
        if end - begin >= _FEWEST and np.ptp(x[begin:end]) > 0:
            here = slice(begin, end)
            slope[:, here] = interpolant(x[here], true[:, here])(x[here], 1)
    return slope


def _only(i: int, values: Floats, true: Floats) -> Floats:
    """A signature in one reading alone."""
    signature = np.zeros_like(true)
    signature[i] = values
    return signature
