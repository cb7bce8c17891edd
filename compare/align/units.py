"""Units that two sweeps do not share: found before anything is aligned, by what they make fit."""

from dataclasses import replace

import numpy as np

from analytic import CLAMP_READINGS, InputError, Readings
from analytic.numerics.arrays import Booleans, Floats
from compare.align.offset import NoOffsetError, offset_fits
from compare.sense.phases import Classification, classify

# One unit of length in another: mm, cm, dm, m and inches, the larger in the smaller.
_LENGTHS = (10.0, 100.0, 1000.0, 25.4, 2.54, 39.3701)
_SUSPICIOUS = 4.0  # times as large: no error of a model, but half a sweep may be as much shorter
_FARTHEST = 12.0  # decades; beyond, it is no unit, and numbers overflow
_LOADED = 0.1  # of the largest force; the stations whose magnitudes are compared
_LARGE = 0.9  # quantile of a reading's magnitudes; a spike does not count
_FITS, _BETTER = 0.1, 0.5  # rms over the largest magnitude, and times that of the unit as given


def in_units_of(reference: Readings, candidate: Readings) -> Readings:
    """The candidate, a clamp reading in a far smaller or larger unit put right."""
    with np.errstate(divide="ignore", invalid="ignore"):  # a dead channel has no unit
        decades = np.log10(_magnitudes(candidate)) - np.log10(_magnitudes(reference))
    far = (np.abs(decades) > np.log10(_SUSPICIOUS)) & (np.abs(decades) < _FARTHEST)
    if not far.any():
        return candidate
    changed = {
        name: candidate.values(name) / 10.0 ** np.round(size)
        for name, size, is_far in zip(CLAMP_READINGS, decades, far, strict=True)
        if is_far
    }
    return replace(candidate, table=candidate.table.assign(**changed))


def check_unit_of_length(
    reference: Readings, candidate: Readings, reference_phase: Classification
) -> None:
    """Refuse foot positions in another unit than the reference's.

    Where the foot travels much more or much less than the reference's, its positions are tried in
    the units of length that make it travel as far.
    """
    loaded = [sweep.running_values[_loaded(sweep)] for sweep in (reference, candidate)]
    spans = [float(np.ptp(x)) if len(x) else 0.0 for x in loaded]
    if not min(spans) > 0 or max(spans) <= _SUSPICIOUS * min(spans):
        return
    ratio = spans[1] / spans[0]
    tried = {
        factor: _misfit(reference, candidate, reference_phase, factor)
        for factor in (*_LENGTHS, *(1 / length for length in _LENGTHS))
        if max(ratio / factor, factor / ratio) <= _SUSPICIOUS
    }
    best = min(tried, key=lambda factor: tried[factor], default=1.0)
    as_given = _misfit(reference, candidate, reference_phase, 1.0)
    if tried and tried[best] < min(_FITS, _BETTER * as_given):
        raise InputError(
            f"foot_x of {candidate.source}",
            f"spans {spans[1]:.4g} against {spans[0]:.4g} of the reference",
            f"in the same unit: they differ by {max(best, 1 / best):g}",
            "convert it; of a file give the unit, as --column foot_x=COLUMN:mm, and a case or beam "
            "with units beside it",
        )


def _magnitudes(readings: Readings) -> Floats:
    """Large magnitudes of the clamp readings under load, shape (3,)."""
    loaded = _loaded(readings)
    values = np.abs([readings.values(name)[loaded] for name in CLAMP_READINGS])
    return np.quantile(values, _LARGE, axis=1) if values.shape[1] else np.zeros(len(values))


def _loaded(readings: Readings) -> Booleans:
    force = np.hypot(readings.values("force_x"), readings.values("force_y"))
    force = np.where(readings.trusted, force, 0.0)
    return np.asarray((force > 0) & (force > _LOADED * np.quantile(force, 0.99)), dtype=bool)


def _misfit(
    reference: Readings, candidate: Readings, reference_phase: Classification, factor: float
) -> float:
    """How badly the candidate fits at its best offset, its foot positions divided by `factor`."""
    table = candidate.table.assign(**{candidate.running: candidate.running_values / factor})
    scaled = replace(candidate, table=table)
    try:
        return offset_fits(reference, scaled, reference_phase, classify(scaled))[0].misfit
    except NoOffsetError:  # too few stations in contact
        return np.inf
