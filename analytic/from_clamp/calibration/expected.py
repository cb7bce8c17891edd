"""What the clamp of a vibrissa reads at any foot positions, by the closed form."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analytic.problem.arrays import Booleans, Floats
from analytic.problem.case import Case
from analytic.problem.columns import CLAMP_READINGS, STATUS_NUMBER
from analytic.solver.columns import Units, to_columns
from analytic.solver.general.states import Vibrissa
from analytic.solver.general.stations import slopes_at, solve_beside
from analytic.solver.general.sweep import solve

_AT_ONCE = 4096  # stations: their intermediate results stay in the processor's cache
_MIRRORED = np.array([[-1.0], [1.0], [-1.0]])  # force_x, force_y and moment_z, x to -x


@dataclass(frozen=True)
class Expected:
    """Readings of the case's vibrissa at the stations of a sweep."""

    case: Case  # the problem; its direction counts, but not its own stations
    # Shape (3, n); In the case's units; zero before the first contact, NaN where the vibrissa has
    # let go or has no state that slides on.
    readings: Floats
    loaded: Booleans  # shape (n,); Where there is a state that slides on
    # Shape (m, 3); Contour parameter, normal force and excess of these, of the sweep to the left.
    places: Floats

    def beside(self, case: Case, foot_x: Floats) -> Floats:
        """The readings of nearly the same case, from the states that are known."""
        found = self.readings.copy()
        leftward, stations = _to_the_left(case, foot_x)
        beam, vibrissa = leftward.beam, Vibrissa.of_case(leftward)
        loaded = np.flatnonzero(self.loaded)
        for some in _pieces(len(loaded)):
            moved = leftward.poses.at(stations[loaded[some]] / beam.length)
            places, slopes = self.places[some], self._slopes[some]
            here = solve_beside(leftward.centreline, vibrissa, moved, places, slopes)
            columns = to_columns(here, Units.of(beam))
            found[:, loaded[some]] = [columns[name] for name in CLAMP_READINGS]
        if case.sweep.direction == "right":
            found[:, self.loaded] *= _MIRRORED
        return found

    @cached_property
    def _slopes(self) -> Floats:
        """What several cases beside this one start from."""
        case, _ = _to_the_left(self.case, np.empty(0))
        line, vibrissa = case.centreline, Vibrissa.of_case(case)
        pieces = (self.places[some] for some in _pieces(len(self.places)))
        return np.concatenate([slopes_at(line, vibrissa, some) for some in pieces])


def expected_readings(case: Case, foot_x: Floats) -> Expected:
    """Force and moment at the clamp, as the case's vibrissa has them at the stations of a sweep."""
    leftward, stations = _to_the_left(case, foot_x)
    solved = solve(leftward, stations / case.beam.length)
    columns, touching = solved.columns, solved.touching
    loaded = touching & (columns["status"] == STATUS_NUMBER["ok"])
    found = np.array([columns[name] for name in CLAMP_READINGS], dtype=float)
    first = solved.events["first_contact"]
    assert first is not None
    let_go = ~touching & (stations < first * case.beam.length)
    found[:, (touching & ~loaded) | let_go] = np.nan
    if case.sweep.direction == "right":
        found *= _MIRRORED
    return Expected(case, found, loaded, solved.places[loaded[touching]])


def _pieces(stations: int) -> Iterator[slice]:
    for first in range(0, max(stations, 1), _AT_ONCE):
        yield slice(first, first + _AT_ONCE)


def _to_the_left(case: Case, foot_x: Floats) -> tuple[Case, Floats]:
    """The same as a sweep to the left."""
    return (case.mirrored(), -foot_x) if case.sweep.direction == "right" else (case, foot_x)
