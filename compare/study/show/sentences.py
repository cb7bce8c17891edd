"""What a study comes to, computed from its numbers: tables, and sentences."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import pandas as pd

from analytic import CLAMP_READINGS
from analytic.numerics.arrays import Floats
from compare.align.frames import COMPONENTS
from compare.show.numbers import short
from compare.study.grid.study import BEAM
from compare.study.show.results import REFINED, Line, Question, StudyResults, lines, together, words


def outcomes(found: StudyResults) -> pd.DataFrame:
    table = found.rows.groupby("outcome").agg(runs=("run", "size"), example=("reason", "first"))
    table = table.reset_index()
    if missing := len(found.plan) - len(found.rows):
        waiting: list[Any] = ["not done yet", missing, ""]
        table.loc[len(table)] = waiting
    return table


def orders(found: StudyResults) -> pd.DataFrame:
    """Determine how fast the disagreement falls as a number is refined.

    The other refined numbers are at their largest, so that their error hides the least of it.
    """
    refined = [axis for axis in REFINED if axis in found.axes]
    groups = [key for key in (*found.plain_axes, BEAM) if key in found.done and key not in refined]
    rows = []
    for axis in refined:
        done = found.done
        for other in refined:
            if other != axis and not together(done, axis, other):
                done = done[done[other] == done[other].max()]
        for values, group in _grouped(done, groups):
            for name in dict.fromkeys((*CLAMP_READINGS, *COMPONENTS)):
                metric = f"disagreement_{name}_rms"
                if metric not in group:
                    continue
                error = group.groupby(axis)[metric].median()
                if len(error) < 2 or not (error > 0).all():
                    continue
                log_n, log_e = np.log(error.index.to_numpy(dtype=float)), np.log(error.to_numpy())
                order = -np.polyfit(log_n, log_e, 1)[0]
                last = -(log_e[-1] - log_e[-2]) / (log_n[-1] - log_n[-2])
                row = {"refined": axis, **values, "reading": name, "order": order, "last": last}
                rows.append(row | {"error at the finest": error.iloc[-1]})
    return pd.DataFrame(rows)


def vanishing(found: StudyResults) -> pd.DataFrame:
    """Find where Phase B vanishes: where the contact length's minimum (eq. 21) passes 1."""
    rows = []
    if "contact_length_minimum" in found.done:
        for axis in found.plain_axes:
            others = [key for key in found.plain_axes if key != axis]
            for values, group in _grouped(found.done, others):
                line = group.groupby(axis)["contact_length_minimum"].first() - 1
                x, y = line.index.to_numpy(dtype=float), line.to_numpy()
                rows += [
                    {"axis": axis, **values, "vanishes at": float(zero)} for zero in _zeros(x, y)
                ]
    return pd.DataFrame(rows)


def pareto_front(done: pd.DataFrame, cost: str, error: str) -> pd.DataFrame:
    """Choose the runs that no other run beats in both cost and error."""
    ordered = done[[cost, error]].dropna().sort_values([cost, error])
    best = ordered[error].cummin()
    return ordered[(ordered[error] == best) & ~best.duplicated()]


def _zeros(x: Floats, y: Floats) -> Floats:
    """Where the polygon through the points changes its sign, by linear interpolation."""
    i = np.flatnonzero(np.diff(np.sign(y)))
    return np.asarray(x[i] - y[i] * (x[i + 1] - x[i]) / (y[i + 1] - y[i]))


def _grouped(
    done: pd.DataFrame, keys: Sequence[str]
) -> Iterator[tuple[dict[str, object], pd.DataFrame]]:
    if not keys:
        yield {}, done
        return
    for values, group in done.groupby(list(keys)):
        yield dict(zip(keys, values, strict=True)), group


_FLAT = 1.2  # a number that changes by less than this factor hardly depends on an axis
_POWER = 0.98  # of the variance of the logarithms that a power law has to explain


def varied(found: StudyResults) -> str:
    said = []
    for axis in found.plan.study.axes:
        for key, values in zip(axis.keys, zip(*axis.points, strict=True), strict=True):
            numbers = [v for v in values if isinstance(v, int | float) and not isinstance(v, bool)]
            if len(values) == 1:
                said.append(f"{key} = {values[0]}")
            elif len(numbers) == len(values):
                said.append(f"{key} ({len(values)} from {min(numbers):.4g} to {max(numbers):.4g})")
            else:
                said.append(f"{key} ({_listed([str(v) for v in values[:5]])})")
    return _listed(said) or "nothing"


def headline(found: StudyResults, question: Question) -> str:
    if question.name == "phase-b":
        return _phase_b(found)
    said = []
    for beam, group in found.by_beam(question.metric):
        whose = f"with the {beam}, " if beam else ""
        strongest = _strongest(found, question.metric, beam)
        if strongest is None:
            low, high = group[question.metric].abs().min(), group[question.metric].abs().max()
            said.append(f"{whose}{question.number} is {short(low)} to {short(high)}.")
        else:
            said.append(f"{whose}{_along(*strongest, question)}.")
    return " ".join(text[:1].upper() + text[1:] for text in said)


def _strongest(found: StudyResults, metric: str, beam: str) -> tuple[str, Line] | None:
    """The axis that a number depends on most, and the beam's last line over it."""
    candidates = []
    for axis in found.plain_axes:
        own = [line for line in lines(found, axis, metric) if line.beam == beam]
        if own:
            sizes = own[-1].table["median"]
            candidates.append((_ratio(sizes), axis, own[-1]))
    if not candidates:
        return None
    _, axis, line = max(candidates, key=lambda candidate: candidate[0])
    return axis, line


def _along(axis: str, line: Line, question: Question) -> str:
    """How a number goes with an axis."""
    x, y = line.table["value"].to_numpy(float), line.table["median"].to_numpy(float)
    where = f" (at {words(line.held)})" if line.held else ""
    reach = f"{axis} goes from {x[0]:.4g} to {x[-1]:.4g}{where}"
    if _ratio(pd.Series(y)) < _FLAT:
        return (
            f"{question.number} hardly depends on anything that varies: {short(y.min())} to "
            f"{short(y.max())} as {reach}"
        )
    steps = np.diff(y)
    if (steps < 0).all() or (steps > 0).all():
        verb = "falls" if y[-1] < y[0] else "grows"
        return (
            f"{question.number} {verb} from {short(y[0])} to {short(y[-1])} as {reach}{_law(x, y)}"
        )
    best, worst = int(np.argmin(y)), int(np.argmax(y))
    return (
        f"{question.number} is least, {short(y[best])}, at {axis} = {x[best]:.4g} and largest, "
        f"{short(y[worst])}, at {x[worst]:.4g}{where}"
    )


def _law(x: np.ndarray, y: np.ndarray) -> str:
    if len(x) < 3 or x.min() <= 0 or y.min() <= 0:
        return ""
    log_x, log_y = np.log(x), np.log(y)
    power = np.polyfit(log_x, log_y, 1)
    rest = log_y - np.polyval(power, log_x)
    if rest.var() > (1 - _POWER) * log_y.var():
        return ""
    law = "it" if abs(power[0] - 1) < 0.05 else f"its power {power[0]:.2g}"
    return f", roughly in proportion to {law}"


def _phase_b(found: StudyResults) -> str:
    done = found.done
    share = int((done["phase_b_exists"] == True).sum())  # noqa: E712  # may be missing
    said = f"{share} of {len(done)} runs have a Phase B"
    crossings = vanishing(found)
    if crossings.empty:
        return said + "."
    ranges = []
    for axis, group in crossings.groupby("axis", sort=False):
        low, high = group["vanishes at"].min(), group["vanishes at"].max()
        span = f"{low:.3g}" if np.isclose(low, high, rtol=5e-3) else f"{low:.3g} to {high:.3g}"
        ranges.append(f"{axis} = {span}")
    return f"{said}; the least contact length passes the vibrissa's own at {_listed(ranges, 'or')}."


def _ratio(sizes: pd.Series) -> float:
    low, high = float(sizes.min()), float(sizes.max())
    if high == 0:
        return 1.0
    return high / low if low > 0 else float("inf")


def _listed(parts: Sequence[str], last: str = "and") -> str:
    if len(parts) < 2:
        return "".join(parts)
    return f"{', '.join(parts[:-1])} {last} {parts[-1]}"
