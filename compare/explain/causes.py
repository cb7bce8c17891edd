"""What a disagreement looks like: faults that leave a signature in the readings alone."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy.interpolate import CubicSpline

from analytic import CLAMP_READINGS
from analytic.problem.arrays import Floats
from compare.explain.signatures import contour_signatures
from compare.measure.disagreement import before_snap_off
from compare.measure.measurement import Measurement
from compare.sense.noise import scatter

_CONVINCING = 0.9  # share of the disagreement, its scatter apart, that one cause must explain
_DISTINCT = 2.0  # the next cause must leave so many times the square that the best one leaves
_SCATTERED = 0.5  # share of the disagreement's square that jumps from station to station
_UNSURE = 1.3  # times the scatter's square, to be on the safe side of its estimate
_FEWEST = 10  # stations


@dataclass(frozen=True)
class Cause:
    """A fault and what it does to the readings.

    Attributes
    ----------
    told : str
        The fault, with ``{size}`` for how large it is.
    signature : array, shape (3, stations)
        What a fault of size 1 adds to the readings, over their largest magnitudes.
    one_sided : bool
        Whether the size cannot be negative.
    """

    told: str
    signature: Floats
    one_sided: bool = False


def likely_cause(found: Measurement, window: float) -> str | None:
    """The one known fault that explains nearly all of the disagreement; None if none stands out.

    Unrest is told by the candidate's own ``residual``, facets and noise by differences that jump
    from station to station, everything else by fitting the size of each fault's signature.
    """
    table = found.alignment.table
    near = before_snap_off(
        found.reference,
        table["foot_x"].to_numpy(),
        found.snap_off,
        window,
    )
    table = table[~near].reset_index(drop=True)
    if len(table) < _FEWEST:
        return None
    scale = np.array([found.disagreement[name].scale for name in CLAMP_READINGS])
    told = _values(table, "reference") / scale[:, None]
    error = _values(table, "candidate") / scale[:, None] - told
    jumps = np.array([scatter(row) for row in error])
    return (
        _unrest(found, error)
        or _scattered(found, error, jumps, scale)
        or _signed(list(_causes(found, table, told, scale)), error, jumps)
    )


def _unrest(found: Measurement, error: Floats) -> str | None:
    candidate = found.candidate
    residual = candidate.values("residual")[candidate.trusted]
    if not np.isfinite(residual).any():
        return None
    typical = float(np.sqrt(np.nanmean(residual**2)))
    moment = found.disagreement["moment_z"].scale / candidate.beam.moment_unit
    if typical / moment < float(np.sqrt(np.mean(error**2))):
        return None
    return f"unrest: the stations are out of balance by {typical:.1e} EI/L (rms of `residual`)"


def _scattered(found: Measurement, error: Floats, jumps: Floats, scale: Floats) -> str | None:
    if np.sum(jumps**2) < _SCATTERED * np.sum(np.mean(error**2, axis=1)):
        return None
    size = f"differences jump from station to station by {jumps.max():.1e}"
    free = found.judged["candidate"].phase == "free"
    if free.sum() < 2:
        return f"facets of a coarse mesh, or noise: {size}"
    idle = np.stack([found.candidate.values(n)[free] for n in CLAMP_READINGS])
    resting = np.median(np.abs(idle / scale[:, None]), axis=1)
    if (resting > jumps / 3).all():
        return f"noise: {size}, and without contact they do too; see `noise`"
    return f"facets of a coarse mesh: {size}, but not without contact"


def _causes(
    found: Measurement, table: pd.DataFrame, told: Floats, scale: Floats
) -> Iterator[Cause]:
    length = found.reference.beam.length
    yield Cause("flexural rigidity {size:+.2%} off: all readings scale alike", told)
    slope = _slopes(table, told)
    yield Cause(
        "foot_x {size:+.2e} off, the same at all stations: an offset (or a lag); see `offset`",
        -slope,
    )
    for i, name in enumerate(CLAMP_READINGS):
        only = np.zeros_like(told)
        only[i] = told[i]
        yield Cause(f"gain of {name} {{size:+.2%}} off, the other readings are right", only)
        only = np.zeros_like(told)
        only[i] = 1.0
        yield Cause(
            f"zero of {name} off by {{size:+.2e}} of its largest magnitude at all stations", only
        )
    changes = contour_signatures(found.reference, table["foot_x"].to_numpy())
    if changes is None:
        return
    scaled = {name: change / scale[:, None] for name, change in changes.items()}
    yield Cause("length of the vibrissa {size:+.2%} off", scaled["length"])
    yield Cause(
        f"radius of the vibrissa {{size:+.2e}} off (it is {found.reference.beam.radius:.2e}),"
        " or the object's surface as much too low",
        scaled["radius"] / length,
    )
    yield Cause(
        "discretisation of first order: the vibrissa is rigid over its first {size:.2%}, as with a "
        "whole rigid segment at the clamp",
        scaled["clamp"],
        one_sided=True,
    )
    force = np.hypot(*_values(table, "reference")[:2])
    yield Cause(
        "softness: the contact gives way by up to {size:.1e} L",
        -scaled["radius"] * force / force.max(),
        one_sided=True,
    )


def _signed(causes: list[Cause], error: Floats, jumps: Floats) -> str | None:
    """The cause whose signature the error bears, if one fits clearly best."""
    known = np.isfinite([cause.signature for cause in causes]).all(axis=(0, 1))
    if known.sum() < _FEWEST:
        return None
    e = error[:, known].ravel()
    noise = float(np.sum(jumps**2) * known.sum())
    fits = []
    for cause in causes:
        s = cause.signature[:, known].ravel()
        size = float(s @ e / (s @ s))
        if cause.one_sided and size < 0:
            continue
        fits.append((float(np.sum((e - size * s) ** 2)), size, cause))
    (least, size, best), (next_, *_) = sorted(fits, key=lambda fit: fit[0])[:2]
    all_ = float(e @ e)
    left, next_left = max(least - _UNSURE * noise, 0.0), next_ - _UNSURE * noise
    if all_ - least < _CONVINCING * (all_ - noise) or next_left <= _DISTINCT * left:
        return None
    return best.told.format(size=size)


def _slopes(table: pd.DataFrame, told: Floats) -> Floats:
    """Derivative of the readings by the foot position, phase by phase; NaN in a short one."""
    slope = np.full_like(told, np.nan)
    phase = table["phase"].to_numpy()
    stretch = np.cumsum(np.append(False, phase[1:] != phase[:-1]))
    for one in np.unique(stretch):
        here = np.flatnonzero(stretch == one)
        if len(here) < 4:
            continue
        order = here[np.argsort(table["foot_x"].to_numpy()[here])]
        x = table["foot_x"].to_numpy()[order]
        slope[:, order] = CubicSpline(x, told[:, order], axis=1)(x, 1)
    return slope


def _values(table: pd.DataFrame, which: str) -> Floats:
    return np.stack([table[f"{name}_{which}"].to_numpy() for name in CLAMP_READINGS])
