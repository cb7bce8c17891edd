"""Least squares: the numbers with which the closed form comes nearest to a sweep's readings."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import get_args

import numpy as np
from scipy.optimize import least_squares

from analytic.from_clamp.calibration.measured import Measured
from analytic.from_clamp.calibration.unknowns import OFFSET, Family, Sought, Unknown
from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.problem.case import Case
from analytic.problem.clamp_path import Direction, Sweep
from analytic.problem.columns import CLAMP_READINGS, STATUS_NUMBER
from analytic.problem.errors import InputError
from analytic.solver.general.balance import rates_at
from analytic.solver.general.columns import Units, to_columns
from analytic.solver.general.states import Vibrissa
from analytic.solver.general.stations import solve_beside
from analytic.solver.general.sweep import solve

_AT_ONCE = 4096  # stations: their intermediate results stay in the processor's cache
_MIRRORED = np.array([[-1.0], [1.0], [-1.0]])  # force_x, force_y and moment_z, x to -x

_STEP = 1e-5  # of a number, for a derivative; the solver's 1e-11 must not matter
_SETTLED = 1e-8  # relative, of the sum of squares and of the numbers: far below any noise
_AN_END = 1e-9  # a fit that stays inside comes so near to an end that is best
_MOST_SWEEPS = 40  # of a fit, without those for derivatives
_OFFSETS = 400  # that are tried, over twice the travel: 0.01 L
_LOOKED_AT = 200  # stations to either side
_SOLVED = 200  # stations over the root of the noise: lines between them err by 10^-3 of it


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

    @property
    def slope_angles(self) -> Floats:
        """Of the contour where it is touched [rad]."""
        case, _ = _to_the_left(self.case, np.empty(0))
        angles = case.centreline.at(self.places[:, 0]).alpha
        return -angles if self.case.sweep.direction == "right" else angles

    @cached_property
    def _slopes(self) -> Floats:
        case, _ = _to_the_left(self.case, np.empty(0))
        line, vibrissa = case.centreline, Vibrissa.of_case(case)
        pieces = (self.places[some] for some in _pieces(len(self.places)))
        return np.concatenate([rates_at(line, some, vibrissa)[1] for some in pieces])


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


class LeastSquaresFit:
    """The sum of squares over some numbers, each station weighed by its noise.

    The numbers are unknowns of the vibrissa and its sweep, behind those of the object's contour if
    it is of a `family` and not as given: fits then start from some `objects`.

    Noise of the foot position moves all three readings of its station along their slopes over the
    foot position; both enter the station's covariance.
    """

    def __init__(
        self,
        measured: Measured,
        given: Case,
        unknowns: Sequence[Unknown],
        family: Family | None = None,
        objects: Sequence[Floats] = (),
    ) -> None:
        self.measured, self.given, self.unknowns = measured, given, unknowns
        self.family, self.objects = family, objects
        self.kinds = (*(family.kinds if family else ()), *unknowns)
        self.lowest = np.array([kind.lowest for kind in self.kinds])
        self.highest = np.array([kind.highest for kind in self.kinds])
        self.whitening = np.asarray(np.linalg.inv(self._root(measured.readings)), dtype=float)
        # All passes to one side are solved as one sweep, whose stations are in order; where they
        # are many, at some of them.
        ways = np.repeat(measured.ways, measured.rows)
        share = float(np.min(measured.spread[1:] / np.abs(measured.readings).max(axis=1)))
        self._sweeps: dict[Sweep, tuple[Integers, Integers]] = {}
        for way in get_args(Direction):
            sign = -1 if way == "left" else 1
            here = np.flatnonzero(ways == way)
            if here.size:
                here = here[np.argsort(sign * measured.foot_x[here], kind="stable")]
                solved = np.linspace(0, len(here) - 1, min(len(here), int(_SOLVED / share**0.5)))
                sweep = Sweep(given.sweep.stations, direction=way)
                self._sweeps[sweep] = here, here[solved.astype(int)]
        self._last: tuple[Floats, list[Expected] | None] = np.empty(0), None

    @property
    def freedom(self) -> int:
        return self.measured.readings.size - len(self.kinds)

    def of_object(self, numbers: Floats) -> Floats:
        return numbers[: len(self.kinds) - len(self.unknowns)]

    def sought(self, numbers: Floats) -> Sought:
        case = self.given
        if self.family:
            profile = self.family.profile(self.of_object(numbers))
            case = replace(case, profile=profile.scaled(case.beam.length))
        found, others = Sought(case), numbers[len(self.kinds) - len(self.unknowns) :].tolist()
        for unknown, number in zip(self.unknowns, others, strict=True):
            found = unknown.tried(found, self.given, number)
        return found

    def starts(self) -> list[Floats]:
        """From objects that are alike; else the case's own, others one by one, an offset's."""
        now = np.array([one.now(Sought(self.given), self.given) for one in self.unknowns])
        if self.family:
            every = (np.append(one, now) for one in self.objects)
            return [np.clip(one, self.lowest, self.highest) for one in every]
        named, this = [one.name for one in self.unknowns], np.eye(len(now), dtype=bool)
        found = [now]
        for i, unknown in enumerate(self.unknowns):
            found += [np.where(this[i], number, now) for number in unknown.starts]
        if OFFSET in named:
            found.append(np.where(this[named.index(OFFSET)], self._offset(), now))
        return found

    def of(self, measured: Measured) -> "LeastSquaresFit":
        return LeastSquaresFit(measured, self.given, self.unknowns, self.family, self.objects)

    def expected(self, numbers: Floats) -> Floats:
        found = self._solved(numbers)
        if found is None:
            return np.full_like(self.measured.readings, np.nan)
        return self._in_passes(numbers, [one.readings for one in found])

    def touched(self, numbers: Floats) -> tuple[float, float]:
        """The least and the largest slope angle of the contour at the stations [rad]."""
        angles = np.concatenate([one.slope_angles for one in self._solved(numbers) or ()])
        return float(angles.min()), float(angles.max())

    def misses(self, numbers: Floats) -> Floats:
        """What they differ from the measured ones by, over the noise."""
        return self._missed(self.expected(numbers))

    def jacobian(self, numbers: Floats) -> Floats:
        found = self._solved(numbers)
        columns = np.zeros((self.measured.readings.size, len(numbers)))
        if found is None:
            return columns
        here = self.misses(numbers)
        for i in range(len(numbers)):
            there, cases = self._beside(numbers, i)
            beside = [one.beside(*case) for one, case in zip(found, cases, strict=True)]
            moved = self._missed(self._in_passes(there, beside)) - here
            columns[:, i] = moved / (there[i] - numbers[i])
        return columns

    def _beside(self, numbers: Floats, i: int) -> tuple[Floats, list[tuple[Case, Floats]]]:
        """The numbers with one a step to either side, and its sweeps, if there are any."""
        step = np.eye(len(numbers))[i] * _STEP
        step = step if numbers[i] + _STEP <= self.highest[i] else -step
        try:
            return numbers + step, self._cases(numbers + step)
        except InputError:  # as of an object that reaches down to the clamp
            return numbers - step, self._cases(numbers - step)

    def scaled_rigidity(self, numbers: Floats) -> Floats:
        """The same with the rigidity that fits best if nothing else depended on it."""
        named = [kind.name for kind in self.kinds]
        if "flexural_rigidity" not in named:
            return numbers
        zero = np.einsum("nij,jn->ni", self.whitening, -self.measured.readings).ravel()
        model = self.misses(numbers) - zero
        if not model.any():
            return numbers
        i = named.index("flexural_rigidity")
        factor = float(-(model @ zero) / (model @ model))
        scaled = numbers.copy()
        scaled[i] = np.clip(numbers[i] * factor, 2 * self.lowest[i], self.highest[i] / 2)
        return scaled

    def best_from(self, numbers: Floats) -> tuple[Floats, float]:
        with np.errstate(divide="ignore", invalid="ignore"):  # where nothing touches, no slope
            found = least_squares(
                self.misses,
                numbers,
                self.jacobian,
                bounds=(self.lowest, self.highest),
                x_scale="jac",
                ftol=_SETTLED,
                xtol=_SETTLED,
                gtol=None,
                max_nfev=_MOST_SWEEPS,
            )
        numbers = np.where(found.x - self.lowest < _AN_END, self.lowest, found.x)
        return numbers, 2 * float(found.cost)

    def _solved(self, numbers: Floats) -> list[Expected] | None:
        """The sweeps of the vibrissa with these numbers; None if there is no such sweep."""
        before, found = self._last  # derivatives are asked for where the misses were
        if not np.isfinite(numbers).all():
            return None
        if not np.array_equal(before, numbers):
            try:
                found = [expected_readings(*case) for case in self._cases(numbers)]
            except (InputError, ArithmeticError):
                found = None
            self._last = numbers.copy(), found
        return found

    def _cases(self, numbers: Floats) -> list[tuple[Case, Floats]]:
        """The cases of the sweeps to either side, and the foot positions where they are solved."""
        sought = self.sought(numbers)
        foot_x = self.measured.foot_x - sought.offset
        late = {"left": -sought.lag, "right": sought.lag}
        return [
            (replace(sought.case, sweep=sweep), foot_x[solved] - late[sweep.direction])
            for sweep, (_, solved) in self._sweeps.items()
        ]

    def _in_passes(self, numbers: Floats, sweeps: Sequence[Floats]) -> Floats:
        """What a sensor reads of the sweeps to either side, pass by pass."""
        found, foot_x = np.empty_like(self.measured.readings), self.measured.foot_x
        for sweep, readings in zip(self._sweeps, sweeps, strict=True):
            here, solved = self._sweeps[sweep]
            found[:, solved] = readings
            if len(solved) < len(here):
                sign = -1 if sweep.direction == "left" else 1
                places, nodes = sign * foot_x[here], sign * foot_x[solved]
                found[:, here] = [np.interp(places, nodes, row) for row in readings]
        found[2] += self.sought(numbers).lever * found[0]
        return found

    def _missed(self, found: Floats) -> Floats:
        filled = np.zeros_like(found)
        for here, _ in self._sweeps.values():
            readings, order = found[:, here], np.arange(len(here))
            known = np.isfinite(readings).all(axis=0)
            if known.any():
                filled[:, here] = [np.interp(order, order[known], row[known]) for row in readings]
        missed = filled - self.measured.readings
        return np.asarray(np.einsum("nij,jn->ni", self.whitening, missed).ravel())

    def _root(self, readings: Floats) -> Floats:
        """Root of the covariance of each station's three readings, shape (n, 3, 3)."""
        foot, *sizes = self.measured.spread
        moved = foot * self.measured.slopes(readings).T
        covariance = np.diag(np.square(sizes)) + moved[:, :, None] * moved[:, None, :]
        return np.linalg.cholesky(covariance)

    def _offset(self) -> float:
        """At which sweeps of the case as it was given, of whatever rigidity, look alike [L]."""
        x, measured = self.measured.foot_x, self.measured.readings
        measured = measured / np.abs(measured).max(axis=1, keepdims=True)
        swept = []
        for sweep, (here, _) in self._sweeps.items():
            case = replace(self.given, sweep=sweep)
            readings = np.nan_to_num(expected_readings(case, case.foot_x).readings)
            order = np.argsort(case.foot_x)
            swept.append(
                (here[:: len(here) // _LOOKED_AT + 1], case.foot_x[order], readings[:, order])
            )
        sizes = np.max([np.abs(readings).max(axis=1) for *_, readings in swept], axis=0)
        ends = np.concatenate([foot[[0, -1]] for _, foot, _ in swept])

        def alike(offset: float) -> float:
            products, squares = 0.0, np.finfo(float).tiny
            for seen, foot, readings in swept:
                for row, size, read in zip(readings, sizes, measured, strict=True):
                    there = np.interp(x[seen] - offset, foot, row, 0.0, 0.0) / size
                    products += float(there @ read[seen])
                    squares += float(there @ there)
            return float(products / np.sqrt(squares))

        tried = np.linspace(x.min() - ends.max(), x.max() - ends.min(), _OFFSETS)
        return float(max(tried.tolist(), key=alike) / self.given.beam.length)
