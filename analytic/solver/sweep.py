"""Sweeps on given foot positions: every station solved, checked and put into one table.

Those of the paper's vibrissa are solved many at once: the accelerator of `analytic.solver.general`.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, pairwise

import numpy as np

from analytic.checks.certificate import certify
from analytic.problem.case import Case
from analytic.problem.columns import COLUMNS, STATUS_NUMBER
from analytic.problem.contours.many import Contours
from analytic.problem.errors import require
from analytic.problem.readings import Readings, are_finite
from analytic.solver.branch import trace
from analytic.solver.general import sweep as general
from analytic.solver.general.columns import Units, as_readings, to_columns, unloaded_columns
from analytic.solver.general.path import located
from analytic.solver.general.states import Vibrissa
from analytic.solver.residuals import inexact, residuals
from analytic.solver.stations import solve_stations

_ROUNDING = 4 * float(np.finfo(float).eps)  # of a foot position that stands on the snap-off

_AT_ONCE = 16_384  # stations: their intermediate results stay in the processor's cache

_CERTIFIED = 1e-9  # L and EI/L; the integration is good to 1e-12


def solve_plain(given: Sequence[Case]) -> list[Readings]:
    """Solve sweeps, those to the right as their mirror images."""
    cases = [case if case.sweep.direction == "left" else case.mirrored() for case in given]
    counts = [case.sweep.stations for case in cases]
    whose = np.repeat(np.arange(len(cases)), counts)
    units = Units.of_each([case.beam for case in cases], whose)
    radius = np.array([case.radius for case in cases])[whose]
    foot_x = np.concatenate([case.foot_x for case in cases])
    contours = Contours([case.centreline for case in cases])
    branches = trace(contours, [case.reach for case in cases])
    places = foot_x / units.length
    first = np.array([branch.foot_x[0] for branch in branches])
    last = np.array([branch.foot_x[-1] for branch in branches])
    last -= _ROUNDING * np.maximum(1.0, np.abs(last))
    touching = (places < first[whose]) & (places >= last[whose])
    columns = unloaded_columns(foot_x)
    bounds = [*pairwise([0, *accumulate(counts)])]
    if touching.any():
        held = [places[begin:end][touching[begin:end]] for begin, end in bounds]
        found = solve_stations(contours, branches, held).states(Vibrissa(radius=radius[touching]))
        solved = to_columns(found, units.part(touching))
        for name in COLUMNS[1:]:
            columns[name][touching] = solved[name]
    checked = residuals(columns, Vibrissa(radius=radius), units)
    columns["status"][inexact(checked, columns["status"])] = STATUS_NUMBER["diverged"]
    columns |= checked
    finite = are_finite(columns)
    readings = []
    for case, (begin, end), branch in zip(given, bounds, branches, strict=True):
        # Copies: readings that are kept do not keep those of all.
        own = {name: x[begin:end].copy() for name, x in columns.items()}
        events = located(branch.events(), branch.foot_x)
        readings.append(as_readings(case, own, events, finite))
    return readings


@dataclass(frozen=True)
class Unsolved:
    """What `solve_sweeps` has for a case that it could not solve.

    Attributes
    ----------
    case : object
        As it was given.
    error : Exception
        Why; `solve_sweep` of the case raises the same.
    """

    case: object
    error: Exception

    @property
    def reason(self) -> str:
        """Why, in a line."""
        return " ".join(str(self.error).split()) or type(self.error).__name__


def solve_sweeps(cases: Iterable[Case]) -> Iterator[Readings | Unsolved]:
    """The readings of many cases in closed form, as `solve_sweep` has them one by one.

    Contours and vibrissae of any kind may be mixed. Those of the paper's vibrissa are solved some
    hundred at a time, with every formula over the stations of all: several times faster than one by
    one. Cases are taken from the iterable as they are needed, and forgotten when their readings are
    handed out: a generator of a million cases takes the memory of a few hundred.

    Parameters
    ----------
    cases : iterable of Case
        The problems.

    Returns
    -------
    iterator of Readings or Unsolved
        One a case, in their order. A case that fails is an `Unsolved` that says why; the others are
        solved all the same.

    Raises
    ------
    InputError
        If `cases` is no iterable.

    Examples
    --------
    >>> from analytic import Case, Sweep, circle, solve_sweeps
    >>> cases = (Case(profile=circle(r, (0, 0.4)), sweep=Sweep(50)) for r in (0.5, 1.0, 2.0))
    >>> [f"{found.snap_off:.4f}" for found in solve_sweeps(cases)]
    ['-1.0268', '-1.2705', '-1.6674']
    """
    require("cases", cases, Iterable, "as [named_case('catenary'), named_case('parabola')]")
    return _solved(cases)


def _solved(cases: Iterable[Case]) -> Iterator[Readings | Unsolved]:
    batch: list[Case] = []
    stations = 0
    for case in cases:
        batch.append(case)
        stations += case.sweep.stations if isinstance(case, Case) else 0
        if stations >= _AT_ONCE:
            yield from _batch(batch)
            batch, stations = [], 0
    yield from _batch(batch)


def _batch(cases: list[Case]) -> Iterator[Readings | Unsolved]:
    plain = [i for i, case in enumerate(cases) if isinstance(case, Case) and case.is_plain]
    found: dict[int, Readings | Unsolved] = {}
    try:
        solved = solve_plain([cases[i] for i in plain]) if plain else []
        found |= zip(plain, solved, strict=True)
    except Exception:  # a contour's functions may raise anything; one by one, to see whose do
        found |= {i: _alone(cases[i]) for i in plain}
        if not any(isinstance(one, Unsolved) for one in found.values()):
            raise  # no case's: the batch's own
    for i, case in enumerate(cases):
        yield found[i] if i in found else _alone(case)


def _alone(case: Case) -> Readings | Unsolved:
    try:
        return solve_sweep(case)
    except Exception as error:
        return Unsolved(case, error)


def solve_sweep(case: Case, certified: bool = False) -> Readings:
    """The readings of `case` in closed form, at its stations.

    Parameters
    ----------
    case : Case
        The problem.
    certified : bool
        Whether each station is to be checked by integration from the clamp too (`certify`).

    Returns
    -------
    Readings
        In the units of the case's beam; source ``"analytic"``. The table has two more columns,
        dimensionless and zero where the vibrissa is free. ``residual_boundary`` is the largest miss
        of the contact's position, arc length, slope and direction of force, of the arc length
        beyond L and of the tip's angle below the contour's; ``residual_moment`` is that of the
        balance of moments. They come from the clamp readings by the closed form; if `certified`,
        they are the larger ones of that and of the integration. ``status`` is ``"diverged"`` where
        one exceeds 1e-11 by the closed form or 1e-9 by the integration, else ``"ok"``. Where a
        vibrissa that is curved at rest would touch the object in a second place, or one that has
        let go would lie in it, as a cone may that lets go early, it is ``"touches again"``, without
        readings. Where friction would not let it slide on as its foot moves, it
        is ``"sticks"``, with the readings of one that does: those depend on what was before.
    """
    require("case", case, Case, "named_case('catenary') makes one")
    readings = solve_plain([case])[0] if case.is_plain else _solve_general(case)
    return _with_certificate(readings) if certified else readings


def _solve_general(case: Case) -> Readings:
    leftward = case if case.direction == "left" else case.mirrored()
    columns, events = general.solve(leftward)[:2]
    columns |= leftward.way_columns
    checked = residuals(columns, Vibrissa.of_case(leftward), Units.of(case.beam))
    columns["status"][inexact(checked, columns["status"])] = STATUS_NUMBER["diverged"]
    columns |= checked
    return as_readings(case, columns, events, are_finite(columns))


def _with_certificate(readings: Readings) -> Readings:
    found = certify(readings)
    stated = readings.table["status"].isin(["ok", "sticks"])  # the others have no readings
    wrong = stated & ~(found.max(axis=1) <= _CERTIFIED)
    table = readings.table.assign(status=readings.table["status"].mask(wrong, "diverged"))
    for name in found:
        table[name] = np.fmax(table[name], found[name])
    return replace(readings, table=table)
