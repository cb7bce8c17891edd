"""What readings do not distinguish, and which further sweep would."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from analytic.from_clamp.calibration.fit import LeastSquaresFit
from analytic.from_clamp.noise import DOUBLE_SIDED_95
from analytic.numerics.arrays import Floats
from analytic.problem.clamp_path import Direction, Sweep
from analytic.problem.columns import CLAMP_READINGS
from analytic.problem.errors import InputError
from analytic.solver.sweep import solve_sweep

_STATIONS = 60  # of a sweep that is tried
_NEARER = 0.1  # L, by which the object is moved
_PART = 0.1  # of the direction's largest part; smaller ones are left out


@dataclass(frozen=True)
class Undistinguished:
    """A direction along which unknowns change together, and what would show how far."""

    # By unknown, how far each is off at the end of the 95 % interval, all at once; of the clamp's
    # compliance [rad/(EI/L)], else in the unit of the case.
    along: dict[str, float]
    sweeps: dict[str, float]  # by further sweep, what it multiplies that interval by, best first

    def said(self) -> Iterator[str]:
        changes = ", ".join(f"{name} {change:+.2g}" for name, change in self.along.items())
        yield f"hardly distinguished (95 %), all at once: {changes}"
        if self.sweeps:
            best, factor = next(iter(self.sweeps.items()))
            again = "as many rows again of the same sweep: 0.71 times"
            yield f"{best} too would make that {factor:.2g} times as large ({again})"


def undistinguished(fit: LeastSquaresFit, numbers: Floats, covariance: Floats) -> Undistinguished:
    """The worst direction in the space of the unknowns, and the sweeps that would shorten it."""
    values, vectors = np.linalg.eigh(covariance)
    worst = vectors[:, -1] * np.sqrt(values[-1])
    kept = np.abs(worst) > _PART * np.abs(worst).max()
    units = [kind.unit(fit.given) for kind in fit.unknowns]
    along = {
        kind.name: float(DOUBLE_SIDED_95 * unit * part)
        for kind, unit, part, large in zip(fit.unknowns, units, worst, kept, strict=True)
        if large
    }
    known = np.linalg.inv(covariance)
    here = _information(fit, numbers)
    # Memory of the noise, jitter and the like make as much less of another sweep.
    weight = np.exp((np.linalg.slogdet(known)[1] - np.linalg.slogdet(here)[1]) / len(numbers))
    rows = len(fit.measured.foot_x) / len(fit.measured.rows)
    found = {}
    for name, other in _sweeps(fit, numbers):
        more = weight * rows / len(other.measured.foot_x) * _information(other, numbers)
        variance = vectors[:, -1] @ np.linalg.inv(known + more) @ vectors[:, -1]
        found[name] = float(np.sqrt(variance / values[-1]))
    return Undistinguished(along, dict(sorted(found.items(), key=lambda one: one[1])))


def _information(fit: LeastSquaresFit, numbers: Floats) -> Floats:
    """Inverse covariance of the numbers by white noise, the zero being known to so much."""
    jacobian, zero = fit.jacobian(numbers), fit.measured.zero
    nuisances = fit.whitening.reshape(-1, len(zero))
    cross = nuisances.T @ jacobian
    inner = nuisances.T @ nuisances + np.diag(1 / zero**2)
    return np.asarray(jacobian.T @ jacobian - cross.T @ np.linalg.solve(inner, cross))


def _sweeps(fit: LeastSquaresFit, numbers: Floats) -> Iterator[tuple[str, LeastSquaresFit]]:
    """Sweeps that would be possible, as if they had been measured."""
    case, ways = fit.given, set(fit.measured.ways)
    way = case.sweep.direction
    other: Direction = "right" if way == "left" else "left"
    tried = {
        f"the object {abs(by):.2g} of L {'nearer' if by < 0 else 'farther'}": (
            replace(case, profile=case.profile.raised(by * case.beam.length)),
            way,
        )
        for by in (-_NEARER, _NEARER)
    }
    if len(ways) == 1:
        tried[f"a sweep to the {other}"] = case, other
    for name, (changed, direction) in tried.items():
        try:
            found = LeastSquaresFit(fit.measured, changed, fit.unknowns).sought(numbers)
            sweep = Sweep(_STATIONS, direction=direction)
            swept = solve_sweep(replace(found.case, sweep=sweep))
            loaded = swept.trusted & (swept.values("force_y") > 0)
            table = swept.table[loaded].iloc[: -max(2, _STATIONS // 20)]
            readings = table[list(CLAMP_READINGS)].to_numpy().T
            foot_x = table["foot_x"].to_numpy() + found.offset
            measured = replace(fit.measured, foot_x=foot_x, readings=readings, rows=(len(table),))
            yield name, LeastSquaresFit(measured, replace(changed, sweep=sweep), fit.unknowns)
        except (InputError, ArithmeticError, ValueError):
            continue
