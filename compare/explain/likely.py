"""What a disagreement looks like: the record first, then known mistakes and faults."""

import numpy as np
import pandas as pd

from analytic import CLAMP_READINGS
from analytic.from_clamp.noise import scatter
from analytic.problem.arrays import Booleans, Floats
from compare.explain.causes import Cause, causes
from compare.explain.fit import Explanation, fitted
from compare.explain.wiring import misread
from compare.judge.allowance import NoiseAllowance
from compare.judge.tolerances import Tolerances
from compare.measure.disagreement import before_snap_off, rms
from compare.measure.measurement import Measurement

_CONVINCING = 0.9  # fraction of the disagreement, its scatter apart, that one cause must explain
_DISTINCT = 2.0  # the next cause must leave so many times the square that the best one leaves
_REST = 0.1  # fraction of the disagreement, rms, that a named cause may leave without saying so
_ALIKE = 0.3  # fraction that a signature must explain for the fault to be solved at its size
_SECANTS, _SETTLED = 5, 1e-3  # sweeps at most for that, and the last change of its size
_BETTER = 6.0  # the same, for three constants to be preferred to one cause of one size
_SCATTERED = 0.5  # fraction of the disagreement's square that jumps from station to station
_UNSURE = 1.3  # times the scatter's square, to be on the safe side of its estimate
_FEWEST = 10  # stations
_FAR_OFF, _SELDOM = 20.0, 0.05  # times the median difference; fraction of the stations, at the most
_ROUND_OFF = 1e-12  # of the largest magnitude; nothing below has a cause


def likely_cause(found: Measurement, limits: Tolerances, noise: NoiseAllowance) -> str | None:
    """What explains nearly all of a disagreement; None if nothing stands out.

    Defects of the record come first: if the readings agree at the stations without one, they are
    the whole cause. Else the one known mistake or fault is named that explains nearly all of the
    disagreement at those stations, if the next one explains clearly less. Unrest is recognised by
    the candidate's own ``residual``, facets and noise by differences that jump from station to
    station, everything else by fitting the size of each fault's signature.
    """
    if found.order.opposite:
        return "opposite direction of travel: foot_x and moment_z run opposite to the reference's"
    notes = [note] if (note := found.order.note) else []
    notes += [x for x in found.records["candidate"].defects() if not x.startswith("rows out of")]
    if not found.alignment.counts["compared"]:
        return "; ".join(notes) or _untouched(found)
    table = found.alignment.table
    window = before_snap_off(
        found.reference, table["foot_x"].to_numpy(), found.snap_off, limits.snap_off_window
    )
    sound = found.records["candidate"].sound[table["station"].to_numpy()]
    table = table[~window & sound].reset_index(drop=True)
    if len(table) < _FEWEST:
        return "; ".join(notes) or None
    scale = np.array([found.disagreement[name].scale for name in CLAMP_READINGS])
    true, seen = (
        np.stack([table[f"{name}_{which}"] for name in CLAMP_READINGS]) / scale[:, None]
        for which in ("reference", "candidate")
    )
    error = seen - true
    short = _short(found)
    if (notes or short) and _agrees(error, limits, noise):
        return "; ".join([*notes, *short])
    at = table["foot_x"].to_numpy() / found.reference.beam.length
    cause = _lone(error, at, limits, noise)
    if cause is None and np.sqrt(np.mean(error**2)) >= _ROUND_OFF:
        jumps = np.array([scatter(row) for row in error])
        cause = (
            _unrest(found, error)
            or _scattered(found, error, jumps, scale)
            or _fitting(found, table, true, seen, scale, jumps)
        )
    return (
        "; ".join([*notes, f"beside that {cause}" if notes else cause] if cause else notes) or None
    )


def _untouched(found: Measurement) -> str | None:
    """Why no station of the candidate is in contact, if that is so by its clamp."""
    table, seen = found.candidate.table, found.judged["candidate"].phase
    idle, unknown = seen == "free", seen == ""
    if not (idle | unknown).all():
        return None
    touching = (table["phase"] != "free").to_numpy() if "phase" in table else np.zeros_like(idle)
    if (idle & touching).any():
        return (
            f"the clamp reads no load, though the candidate records a contact at "
            f"{(idle & touching).sum()} stations: the sensor measures something else, or nothing"
        )
    if unknown.any():
        return f"no station with a load is to be trusted: {unknown.sum()} of {len(idle)} are not"
    return "the candidate never touches: its clamp reads no load at any station"


def _short(found: Measurement) -> list[str]:
    """That the sweep does not cover all events of the reference."""
    if not (beyond := found.beyond()):
        return []
    foot_x = found.candidate.values("foot_x") / found.reference.beam.length
    return [
        f"too short a sweep: it covers foot_x = {foot_x.min():.4g} to {foot_x.max():.4g} L, and "
        f"{' and '.join(beyond)} of the reference lie{'s' * (len(beyond) == 1)} beyond"
    ]


def _lone(error: Floats, foot_x: Floats, limits: Tolerances, noise: NoiseAllowance) -> str | None:
    """Single stations that are far off, if all others agree or nearly all of it is theirs."""
    size = np.abs(error).max(axis=0)
    off = size > _FAR_OFF * np.median(size)
    neighbours = np.append(off[1:], False) & off
    if not off.any() or neighbours.any() or off.mean() > _SELDOM:
        return None
    agree = _agrees(error[:, ~off], limits, noise)
    if not agree and np.sum(error[:, ~off] ** 2) > (1 - _CONVINCING) * np.sum(error**2):
        return None
    worst = int(size.argmax())
    reading = CLAMP_READINGS[int(np.abs(error[:, worst]).argmax())]
    return (
        f"single stations: {off.sum()} of {len(off)} compared {'is' if off.sum() == 1 else 'are'} "
        f"off by up to {size[worst]:.1e} of the largest {reading} (at foot_x = "
        f"{foot_x[worst]:.4g} L); "
        + ("all others agree" if agree else "nearly all of the disagreement is theirs")
    )


def _agrees(error: Floats, limits: Tolerances, noise: NoiseAllowance) -> bool:
    """Whether the readings agree at some stations, by what they are off by there."""
    stations = error.shape[1]
    allowed = [noise.rms(limits.of_sweep(name), name, stations) for name in CLAMP_READINGS]
    return bool((rms(error) <= allowed).all())


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
    if "segments" not in found.candidate.provenance.get("settings", {}):
        return f"noise: {size}; see `--noise auto`"
    free = found.judged["candidate"].phase == "free"
    if free.sum() < 2:
        return f"facets of a coarse mesh, or noise: {size}"
    idle = np.stack([found.candidate.values(n)[free] for n in CLAMP_READINGS])
    resting = np.median(np.abs(idle / scale[:, None]), axis=1)
    if (resting > jumps / 3).all():
        return f"noise: {size}, and without contact they do too; see `--noise auto`"
    return f"facets of a coarse mesh: {size}, but not without contact"


def _fitting(
    found: Measurement,
    table: pd.DataFrame,
    true: Floats,
    seen: Floats,
    scale: Floats,
    jumps: Floats,
) -> str | None:
    """The one mistake or fault that fits clearly best, over the stations where all are known."""
    faults = list(causes(found, table, true, scale))
    known = np.asarray(np.isfinite([fault.signature for fault in faults]).all(axis=(0, 1)))
    if known.sum() < _FEWEST:
        return None
    true, seen = true[:, known], seen[:, known]
    error = seen - true
    tried = list(misread(true, seen, scale, found.reference.beam.length))
    tried.append(_constant(error))
    all_, noise = float(np.sum(error**2)), float(np.sum(jumps**2) * known.sum())
    fits = [_linear(fault, error, known) for fault in faults]
    best = _best([*tried, *filter(None, fits)], all_, noise)
    unclear = best is None or _rest(best, all_, noise) > _REST
    fits = [
        _exact(fault, fit, error, known) if unclear or fit is best else fit
        for fault, fit in zip(faults, fits, strict=True)
    ]
    best = _best([*tried, *filter(None, fits)], all_, noise)
    if best is None:
        return None
    rest = _rest(best, all_, noise)
    if rest <= _REST:
        return best.text
    solved = any(fault.change is not None for fault in faults)
    return f"{best.text}; {rest:.0%} of the disagreement is left" if solved else None


def _linear(fault: Cause, error: Floats, known: Booleans) -> Explanation | None:
    """A fault by its signature, over the stations that are known."""
    size, left, _ = fitted(error, fault.signature[:, known])
    return Explanation(fault.text(size), left) if fault.lowest <= size <= fault.highest else None


def _exact(
    fault: Cause, best: Explanation | None, error: Floats, known: Booleans
) -> Explanation | None:
    """A fault solved at its size, which secants find, if that explains more than its signature.

    Next to where a sweep with the fault is free, its signature stands in.
    """
    size, _, fraction = fitted(error, fault.signature[:, known])
    if fault.change is None or fraction < _ALIKE:
        return best
    last, before = 0.0, np.zeros_like(error)
    for _ in range(_SECANTS):
        size = float(np.clip(size, fault.lowest, fault.highest))
        added = fault.change(size) if size != last else None
        if added is None:
            break
        added = np.where(np.isfinite(added), added, size * fault.signature)[:, known]
        left = float(np.sum((error - added) ** 2))
        if best is None or left < best.left:
            best = Explanation(fault.text(size), left)
        step = fitted(error - added, (added - before) / (size - last)).size
        last, before = size, added
        size += step
        if abs(step) < _SETTLED * abs(size):
            break
    return best


def _constant(error: Floats) -> Explanation:
    zero = error.mean(axis=1)
    sizes = ", ".join(f"{name} {x:+.1e}" for name, x in zip(CLAMP_READINGS, zero, strict=True))
    return Explanation(
        f"constant load at all stations ({sizes} of their largest magnitudes): gravity or zero of "
        "the sensor, not taken off",
        float(np.sum((error - zero[:, None]) ** 2)),
        len(zero),
    )


def _best(tried: list[Explanation], all_: float, noise: float) -> Explanation | None:
    """The explanation that leaves least, if it is convincing and the next one leaves clearly more.

    One of several sizes has to leave less by far than those of one, and then is compared with its
    like alone.
    """
    tried = sorted(tried, key=lambda one: one.left)
    simple = [one for one in tried if one.sizes <= 1]
    best, next_ = simple[0], simple[1].left
    for one in tried:
        if one.sizes > 1 and _beyond(one, noise) * _BETTER < _beyond(best, noise):
            best, next_ = one, best.left
    if all_ - best.left < _CONVINCING * (all_ - noise):
        return None
    if next_ - _UNSURE * noise <= _DISTINCT * _beyond(best, noise):
        return None
    return best


def _rest(best: Explanation, all_: float, noise: float) -> float:
    """Fraction of the disagreement that the best explanation leaves, rms."""
    return float(np.sqrt(_beyond(best, noise) / all_))


def _beyond(one: Explanation, noise: float) -> float:
    return max(one.left - _UNSURE * noise, 0.0)
