"""Faults of the vibrissa, the stage and the sensor that leave a signature in the readings."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pandas as pd

from analytic import CLAMP_READINGS
from analytic.problem.arrays import Floats
from compare.align.stations import interpolant
from compare.explain.signatures import contour_signatures
from compare.measure.measurement import Measurement

_FEWEST = 4  # stations of a stretch whose slope is worth something


@dataclass(frozen=True)
class Cause:
    """A fault and what it does to the readings.

    Attributes
    ----------
    text : str
        The fault, with ``{size}`` for how large it is.
    signature : array, shape (3, stations)
        What a fault of size 1 adds to the readings, over their largest magnitudes.
    lowest, highest : float
        Sizes that such a fault can have.
    """

    text: str
    signature: Floats
    lowest: float
    highest: float


def causes(found: Measurement, table: pd.DataFrame, true: Floats, scale: Floats) -> Iterator[Cause]:
    """The known faults, those that need the contour last.

    Parameters
    ----------
    found : Measurement
        Whose disagreement is to be explained.
    table : pandas.DataFrame
        The stations of its alignment that count.
    true : array, shape (3, stations)
        The reference there, relative to each reading's largest magnitude.
    scale : array, shape (3,)
        Those magnitudes.

    Yields
    ------
    Cause
        With its signature at the stations.
    """
    length = found.reference.beam.length
    # A radius that is a third off makes the rigidity 0.2 to 3.2 times what it should be.
    yield Cause("flexural rigidity {size:+.2%} off: all readings scale alike", true, -0.8, 2.2)
    # Farther off the readings are no longer linear in it; `offset` is there for that.
    yield Cause(
        "foot_x {size:+.2e} off, the same at all stations: an offset (or a lag), see "
        "`--offset auto`",
        -slopes(table, true),
        -0.1 * length,
        0.1 * length,
    )
    progress = np.linspace(0, 1, true.shape[1])
    for i, name in enumerate(CLAMP_READINGS):
        yield Cause(
            f"gain of {name} {{size:+.2%}} off, the other readings are right",
            _only(i, true[i], true),
            -0.8,
            2.0,
        )
        yield Cause(
            f"zero of {name} off by {{size:+.2e}} of its largest magnitude at all stations",
            _only(i, np.ones_like(progress), true),
            -2.0,
            2.0,
        )
        yield Cause(
            f"drift of {name} by {{size:+.2e}} of its largest magnitude over the sweep",
            _only(i, progress, true),
            -2.0,
            2.0,
        )
    changes = contour_signatures(found.reference, table["foot_x"].to_numpy())
    if changes is None:
        return
    scaled = {name: change / scale[:, None] for name, change in changes.items()}
    # The signatures are linear; so far they still fit.
    yield Cause("length of the vibrissa {size:+.2%} off", scaled["length"], -0.2, 0.2)
    yield Cause(
        f"radius of the vibrissa {{size:+.2e}} off (it is {found.reference.beam.radius:.2e}),"
        " or the object's surface as much too low",
        scaled["radius"] / length,
        -0.1 * length,
        0.1 * length,
    )
    yield Cause(
        "discretisation of first order: the vibrissa is rigid over its first {size:.2%}, as with a "
        "whole rigid segment at the clamp",
        scaled["clamp"],
        0.0,
        0.2,
    )
    force = np.hypot(*(table[f"{name}_reference"].to_numpy() for name in CLAMP_READINGS[:2]))
    yield Cause(
        "softness: the contact gives way by up to {size:.1e} L",
        -scaled["radius"] * force / force.max(),
        0.0,
        0.1,
    )


def slopes(table: pd.DataFrame, true: Floats) -> Floats:
    """Derivative of the readings by the foot position, phase by phase.

    Parameters
    ----------
    table : pandas.DataFrame
        The stations.
    true : array, shape (3, stations)
        The readings there.

    Returns
    -------
    array, shape (3, stations)
        [1/length]; NaN in a stretch of fewer than four stations.
    """
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
