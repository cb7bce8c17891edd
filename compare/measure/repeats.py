"""How well a rig repeats itself: passes in the same direction, held against their mean."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from scipy.interpolate import PchipInterpolator

from analytic import CLAMP_READINGS, SENSED, InputError, Readings
from analytic.from_clamp.correlated import estimate
from analytic.from_clamp.noise import known_to, zero_uncertainty
from analytic.from_clamp.passes import Consistency, as_passes, consistency
from analytic.numerics.arrays import Booleans, Floats
from compare.sense.noise import scales

_STEPS = 4  # median steps of the foot that are averaged
_FEWEST = 10  # such averages
_SLOPES = [f"{name}_slope" for name in CLAMP_READINGS]
# Of a pass's provenance, what is not of the mean.
_OF_ONE_PASS = "pass", "dropped", "rows", "lag", "free_noise"
_TOUCHING = 0.02  # of a reading's largest magnitude
_NEXT_TO_SNAP_OFF = 0.03  # of the loaded travel, where readings grow without bound
_UNLIKE = 8.0  # times the median scatter, and ...
_MIDDLE = 3  # passes that have a middle: of two, nobody knows which is another's
_STEEP = 0.03  # ... of the largest magnitude: passes of which some have let go


@dataclass(frozen=True)
class Repeats:
    names: tuple[str, ...]  # of the passes
    mean: Readings  # over stretches of the foot's travel in which half of the passes have rows
    # Shape (passes, 3); root mean squares over the largest magnitudes: drift that is left,
    # hysteresis, and half of the noise, as four stations are averaged. As they are, and without
    # what a displaced foot makes of them.
    rms: Floats
    rms_without_shift: Floats
    # By how much foot_x of a pass is larger than that of the mean for equal readings, as by play or
    # creep [length]; what is left of zero and drift, and noise that remembers, count.
    shifts: Consistency
    uncertainty: Floats  # shape (passes,); standard deviations of the shifts [length]
    # Share of the contact in which passes are so unlike that their mean is of none of them: left
    # out; and the pass that is farthest from the others there.
    left_out: float
    farthest: int
    by_noise: bool  # whether noise, and what an object's steep places do, explain what is left
    others: tuple[str, ...] = ()  # passes that are as of another object, and not in the mean


def repeats(passes: Sequence[Readings]) -> Repeats:
    """Hold passes in one direction, two or more, against their mean."""
    passes = as_passes(passes)
    names = [str(one.provenance.get("pass", one.source)) for one in passes]
    tables = [one.table.loc[one.trusted, list(SENSED)] for one in passes]
    stretches = _stretches([table["foot_x"].to_numpy() for table in tables])
    each, shared = _means(tables, stretches)
    binned = np.stack([one.loc[shared].to_numpy() for one in each])
    other = _of_another(binned[..., 1:])
    if other.any():
        alone = repeats([one for one, out in zip(passes, other, strict=True) if not out])
        apart = tuple(name for name, out in zip(names, other, strict=True) if out)
        return replace(alone, others=alone.others + apart)
    mean = binned.mean(axis=0)
    scatter = binned.std(axis=0, ddof=1)[:, 1:]
    largest = np.abs(mean[:, 1:]).max(axis=0)
    alike = np.all(scatter <= _UNLIKE * np.median(scatter, axis=0) + _STEEP * largest, axis=1)
    away = (binned - np.median(binned, axis=0))[:, ~alike, 1:] / largest
    farthest = int(np.argmax(np.sum(away**2, axis=(1, 2))))
    loaded = np.any(np.abs(mean[:, 1:]) > _TOUCHING * largest, axis=1)
    left_out = float(np.mean(~alike[loaded])) if loaded.any() else 0.0
    # Loaded beside a free one, a stretch may hold rows in contact and rows of none.
    kept = alike & ~(loaded & ~_between(loaded))
    mean, ends = mean[kept], ~_between(kept)[kept]
    # What the passes are away from the mean is averaged, not they: it is nearly straight.
    order = np.argsort(mean[:, 0])
    curve = PchipInterpolator(mean[order, 0], mean[order, 1:])
    for table in tables:
        foot = table["foot_x"].to_numpy()
        table[list(CLAMP_READINGS)] -= curve(foot)
        table[_SLOPES] = curve(foot, 1)
    each, _ = _means(tables, stretches)
    binned = np.stack([one.loc[shared[kept]].to_numpy() for one in each])
    _, away, slopes = np.split(binned, [1, 4], axis=2)
    bent = np.where(ends[:, None], 0.0, away.mean(axis=0))
    mean[:, 1:] += bent  # a mean of four stations cuts a bend short
    away -= bent
    unlike = scatter[kept] / np.sqrt(len(passes))
    scattered = np.sqrt(np.mean(unlike**2, axis=0)).tolist()
    provenance = {
        **passes[0].provenance,
        "passes": len(passes),
        "scatter": dict(zip(CLAMP_READINGS, scattered, strict=True)),  # of the mean
    }
    # Each pass has a zero of its own, but what is not seen of a bend they have alike.
    for name, among in ("zero_uncertainty", len(passes)), ("bend_uncertainty", 1):
        known = np.sqrt(np.mean([known_to(name, one) ** 2 for one in passes], axis=0) / among)
        provenance[name] = dict(zip(CLAMP_READINGS, known.tolist(), strict=True))
    rows = np.concatenate([mean, _of_some(each, shared.to_numpy(), kept, curve)])
    rows = rows[np.argsort(rows[:, 0] * np.sign(mean[-1, 0] - mean[0, 0]))]
    of_all = Readings(
        pd.DataFrame(rows, columns=list(SENSED)),
        passes[0].beam,
        f"measured, mean of {len(passes)} passes",
        {name: x for name, x in provenance.items() if name not in _OF_ONE_PASS},
    )
    scale = np.array([*scales(of_all).values()])
    touching = np.all(np.abs(mean[:, [2, 3]]) > _TOUCHING * scale[1:], axis=1)
    before = np.cumsum(~touching)  # the longest run: hum has no gaps
    touching &= before == np.argmax(np.bincount(before[touching]))
    first, last = mean[touching, 0][[0, -1]]
    touching &= ~ends & (np.abs(mean[:, 0] - last) > _NEXT_TO_SNAP_OFF * abs(last - first))
    away, slopes = away[:, touching], slopes[:, touching]
    stations, count = away.shape[1], len(passes)
    steps = np.diff(away / scale, axis=1)
    middle = np.median(steps, axis=1, keepdims=True)
    seen = np.median(np.abs(steps - middle), axis=1)
    known = max(1e-12, float(np.median(seen)))
    unit, along = scale * known, np.linspace(-1, 1, stations)[:, None, None]
    zeros = [zero_uncertainty(one, scale) for one in passes]
    own = 1 - 1 / count  # of a pass's variance, what is away from the mean of all has
    zero = np.broadcast_to(np.eye(3), (stations, 3, 3))
    found = estimate(
        (away / unit).reshape(-1, 3),
        (-slopes / unit).reshape(-1, 3, 1),
        np.tile(np.concatenate([zero, along * zero], axis=2), (count, 1, 1)),
        np.tile(np.sqrt(own * np.mean(np.square(zeros), axis=0)) / unit, 2),
        rows=[stations] * count,
    )
    shifts = consistency([(number, covariance / own) for number, covariance in found.by_pass])
    left = _rms((away + shifts.numbers[:, :, None] * slopes) / scale)
    return Repeats(
        tuple(names),
        of_all,
        _rms(away / scale),
        left,
        shifts,
        np.sqrt([covariance[0, 0] for _, covariance in found.by_pass]),
        left_out,
        farthest,
        bool(left.max() <= _UNLIKE * known + _STEEP),
    )


def _between(these: Booleans) -> Booleans:
    """Those whose neighbours both are of these; the first and the last have one."""
    beside = np.pad(these, 1, mode="edge")
    return np.asarray(beside[:-2] & beside[2:])


def _stretches(foot: Sequence[Floats]) -> list[Floats]:
    """Which stretch of the travel each row of each pass is in."""
    width = _STEPS * max(float(np.median(np.abs(np.diff(x)))) for x in foot)
    start = foot[0][0]
    return [np.floor((x - start) / width) for x in foot]


def _means(
    tables: Sequence[pd.DataFrame], stretches: Sequence[Floats]
) -> tuple[list[pd.DataFrame], pd.Index]:
    """Over stretches of the travel, of each pass, and the stretches in which all have rows."""
    means = [table.groupby(x).mean() for table, x in zip(tables, stretches, strict=True)]
    shared = sorted(set.intersection(*(set(one.index) for one in means)))
    if len(shared) < _FEWEST:
        what = f"{len(shared)} stretches of the foot's travel in which all have rows"
        remedy = "take passes over the same travel together"
        raise InputError("passes", what, f"{_FEWEST} or more", remedy)
    if tables[0]["foot_x"].iloc[0] > tables[0]["foot_x"].iloc[-1]:
        shared = shared[::-1]
    return means, pd.Index(shared)


def _of_another(values: Floats) -> Booleans:
    """Passes that are far from the middle of all nearly everywhere, as of another object."""
    middle = np.median(values, axis=0)
    largest = np.abs(middle).max(axis=0)
    loaded = np.any(np.abs(middle) > _TOUCHING * largest, axis=1)
    if len(values) < _MIDDLE or not loaded.any():
        return np.zeros(len(values), dtype=bool)
    away = np.median(np.max(np.abs(values - middle)[:, loaded] / largest, axis=2), axis=1)
    return np.asarray(away > _UNLIKE * np.median(away) + _STEEP)


def _of_some(
    each: Sequence[pd.DataFrame], shared: Floats, kept: Booleans, curve: Callable[[Floats], Floats]
) -> Floats:
    """Means where rows of less than half of the passes are lost, between means of all passes.

    Of what they are away from the curve through these.
    """
    order = np.argsort(shared)
    by_stretch = pd.concat(each).groupby(level=0)
    counts = by_stretch.size()
    some = np.setdiff1d(counts.index[2 * counts >= len(each)], shared)
    above = np.searchsorted(shared[order], some)
    inside = np.append(kept[order], False)[above] & np.append(False, kept[order])[above]
    means = by_stretch.mean().loc[some[inside]].to_numpy()
    return np.column_stack([means[:, 0], curve(means[:, 0]) + means[:, 1:4]])


def _rms(away: Floats) -> Floats:
    return np.asarray(np.sqrt(np.mean(away**2, axis=1)))
