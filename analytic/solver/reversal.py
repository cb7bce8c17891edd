"""Hysteresis of a vibrissa that rubs: the limits of stiction, and a sweep that turns round.

A vibrissa that sticks is followed from sliding on to sliding back; it may only roll.
"""

from typing import Literal, NamedTuple

import numpy as np
import pandas as pd

from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.numerics.newton import Jacobian, Misses, solve
from analytic.numerics.panel import POINTS, WEIGHTS
from analytic.problem.case import Case
from analytic.problem.columns import CLAMP_READINGS, COLUMNS, CONTACT, STATUS_NUMBER
from analytic.problem.contours.contour import Contour
from analytic.problem.errors import InputError, require
from analytic.problem.numbers import finite, whole
from analytic.problem.rest import first_touch
from analytic.problem.table import as_table, mirrored_table
from analytic.solver.general.balance import states_at
from analytic.solver.general.columns import ReadingColumns, Units, columns_at_rest, to_columns
from analytic.solver.general.path import Path, follow
from analytic.solver.general.states import States, Vibrissa
from analytic.solver.general.stations import solve_places
from analytic.solver.residuals import without_inexact

_FIRST, _LARGEST, _SMALLEST = 1e-3, 0.02, 1e-9  # L; steps of the foot
_NEAR = 0.1  # by how much a state may differ from what the step before lets expect
_STEP = 1e-6  # of differences
_BALANCED = 1e-11  # L, rad


class Sticking(NamedTuple):
    """States of a vibrissa that sticks while its foot goes back; arrays of shape (m, ...)."""

    # contour parameter, normal force, excess, and the force's angle off the contour's normal,
    # arctan(mu) at first [rad]; shape (m, 4).
    z: Floats
    foot_x: Floats  # rising [L]
    # from the last one on: at the angle -arctan(mu) it slides back; it may stick until the foot
    # stops; or it would slide on again, or has no state beside the last one, and lets go.
    then: Literal["slides back", "stops", "unsolved"]


def stick(contour: Contour, vibrissa: Vibrissa, start: Floats, until: float) -> Sticking:
    """Let the foot go back, to the right, while nothing slides."""
    limit = float(np.arctan(vibrissa.friction))
    z = [np.append(start, limit)]
    foot_x = [float(_held_states(contour, vibrissa, z[0][None]).foot_x[0])]
    step, rate = _FIRST, np.zeros(4)
    while foot_x[-1] < until:
        ahead = min(foot_x[-1] + step, until)
        guess = z[-1] + (ahead - foot_x[-1]) * rate
        found, missed = _at_foot(contour, vibrissa, z[0], np.array([ahead]), guess[None])
        change = np.abs(found[0] - guess) / np.maximum(1.0, np.abs(z[-1]))
        if not (missed[0] <= _BALANCED and change.max() < _NEAR):
            step /= 2
            if step < _SMALLEST:
                return Sticking(np.array(z), np.array(foot_x), "unsolved")
            continue
        if found[0, 3] > limit + _NEAR * limit:
            return Sticking(np.array(z), np.array(foot_x), "unsolved")
        if found[0, 3] <= -limit:
            return _ended(contour, vibrissa, z, foot_x, found[0])
        rate = (found[0] - z[-1]) / (ahead - foot_x[-1])
        z.append(found[0])
        foot_x.append(ahead)
        step = min(2 * step, _LARGEST)
    return Sticking(np.array(z), np.array(foot_x), "stops")


def _ended(
    contour: Contour, vibrissa: Vibrissa, z: list[Floats], foot_x: list[float], beyond: Floats
) -> Sticking:
    """The way to the state that starts to slide back, before one whose angle is beyond it."""
    limit = float(np.arctan(vibrissa.friction))
    share = (z[-1][3] + limit) / (z[-1][3] - beyond[3])
    guess = z[-1] + share * (beyond - z[-1])

    def misses(at: Floats, _: Integers) -> Floats:
        return _misses(contour, vibrissa, z[0], np.column_stack([at, [-limit]]))

    last, missed = solve(misses, _differences(misses), guess[None, :3])
    if not missed[0] <= _BALANCED:
        raise ArithmeticError("the state that starts to slide back is lost")
    end = np.append(_in_phase(last)[0], -limit)
    place = float(_held_states(contour, vibrissa, end[None]).foot_x[0])
    return Sticking(np.array([*z, end]), np.array([*foot_x, place]), "slides back")


def between(contour: Contour, vibrissa: Vibrissa, known: Sticking, foot_x: Floats) -> Floats:
    guess = np.stack([np.interp(foot_x, known.foot_x, column) for column in known.z.T], axis=1)
    found, missed = _at_foot(contour, vibrissa, known.z[0], foot_x, guess)
    if not (missed <= _BALANCED).all():
        place = foot_x[int(np.argmax(missed))]
        raise ArithmeticError(f"the sticking vibrissa is lost at foot_x = {place:.6g} L")
    return found


def _at_foot(
    contour: Contour, vibrissa: Vibrissa, start: Floats, foot_x: Floats, guess: Floats
) -> tuple[Floats, Floats]:
    """States that stick since `start` at foot positions, shape (n, 4), and what they miss."""

    def misses(at: Floats, which: Integers) -> Floats:
        missed = _misses(contour, vibrissa, start, at)
        apart = _held_states(contour, vibrissa, at).foot_x - foot_x[which]
        return np.column_stack([missed, apart])

    z, missed = solve(misses, _differences(misses), guess)
    return np.column_stack([_in_phase(z), z[:, 3]]), missed


def _misses(contour: Contour, vibrissa: Vibrissa, start: Floats, z: Floats) -> Floats:
    """What states miss at the clamp's slope, at the contact's height and by sliding."""
    here = _held_states(contour, vibrissa, z)
    slid = _slid(contour, vibrissa, start, z)
    return np.stack([here.slope_residual, here.height_residual, slid], axis=1)


def _differences(misses: Misses) -> Jacobian:
    """Derivatives by central differences: they decide how fast a solution comes, not which."""

    def jacobian(z: Floats, which: Integers) -> Floats:
        columns = []
        for k in range(z.shape[1]):
            step = np.zeros_like(z)
            step[:, k] = _STEP * np.maximum(1.0, np.abs(z[:, k]))
            change = misses(z + step, which) - misses(z - step, which)
            columns.append(change / (2 * step[:, k : k + 1]))
        return np.stack(columns, axis=2)

    return jacobian


def _held_states(contour: Contour, vibrissa: Vibrissa, z: Floats) -> States:
    return states_at(contour, _in_phase(z), vibrissa._replace(friction=np.tan(z[:, 3])))


def _in_phase(z: Floats) -> Floats:
    """Parameter, force and excess: no force is negative, no excess is nothing in Phase B."""
    t, force, excess = z[:, :3].T
    return np.column_stack([t, np.maximum(force, 0.0), excess])


def _slid(contour: Contour, vibrissa: Vibrissa, start: Floats, z: Floats) -> Floats:
    """By how much vibrissa and object would have slid on each other since `start` [L]."""
    radius, rest = vibrissa.radius, vibrissa.unloaded

    def on_vibrissa(excess: Floats) -> Floats:
        s = vibrissa.arc_length(excess)
        front = rest.side(s)
        back = 2 * np.cos(rest.lean) * (1 - s) - front
        beyond = np.where(vibrissa.side(excess) > 0, back, -front)
        return np.asarray(radius * vibrissa.turned(excess) + beyond)

    turned = contour.at(z[:, 0]).alpha - contour.at(start[:1]).alpha
    way = np.array([_way(contour, float(start[0]), float(t)) for t in z[:, 0]])
    return np.asarray(way - radius * turned - on_vibrissa(z[:, 2]) + on_vibrissa(start[2:3]))


def _way(contour: Contour, begin: float, end: float) -> float:
    """Arc length of the contour between two parameters [L]."""
    low, high = min(begin, end), max(begin, end)
    breaks = contour.breaks()
    ends = np.concatenate([[low], breaks[(breaks > low) & (breaks < high)], [high]])
    widths = np.diff(ends)
    rate = contour.at(ends[:-1, None] + widths[:, None] * POINTS).stretch
    length = float(widths @ (rate @ WEIGHTS))
    return length if end >= begin else -length


def stiction_limits(case: Case) -> tuple[pd.DataFrame, pd.DataFrame]:
    """The two ends of the interval of equilibria at each foot position of a case.

    At the one end the vibrissa is about to slide on, as its foot moves in the sweep's direction, at
    the other to slide back. Between them the force's angle off the contour's normal has any value
    from arctan(mu) to -arctan(mu): which one, depends on what was before.

    Parameters
    ----------
    case : Case
        With friction.

    Returns
    -------
    onward, back : pandas.DataFrame
        A row a station, with the columns of `Readings.table` but for ``status`` and with
        ``friction_angle`` [rad]; NaN and ``"free"`` where the branch has no state. The states that
        slide back let go at another foot position.

    Raises
    ------
    InputError
        If the case has no friction.
    ArithmeticError
        If the states of a branch are lost, or not exact.
    """
    _check(case)
    if case.sweep.direction == "right":
        onward, back = (_mirrored(table) for table in stiction_limits(case.mirrored()))
        return onward, back
    foot_x = case.foot_x / case.beam.length
    tables = []
    for sense in (1.0, -1.0):
        path = _sliding(case, sense)
        columns = _unloaded(case, case.foot_x)
        held = _holds(path, foot_x)
        if held.any():
            angle = np.full(int(held.sum()), sense * np.arctan(case.friction))
            _fill(columns, held, case, _states(path, case, foot_x[held]), angle)
        tables.append(_table(columns))
    return tables[0], tables[1]


def turn_back(case: Case, turn_at: float, stations: int = 100) -> pd.DataFrame:
    """The way back of a sweep that turns round.

    When the foot turns, the vibrissa sticks to the object: contact and object do not slide on each
    other until the force has turned through friction's cone, from arctan(mu) on one side of the
    contour's normal to arctan(mu) on the other. From there on it slides back, with the friction of
    the other sense, until it leaves the object where it first touched it.

    Parameters
    ----------
    case : Case
        With friction; its sweep says the direction of the way on, and where it starts.
    turn_at : float
        Foot position at which the foot turns round [length].
    stations : int
        Of the way back, equally spaced from there to the start of the sweep.

    Returns
    -------
    pandas.DataFrame
        A row a station, with the columns of `Readings.table` but for ``status``; and with
        ``friction_angle``, that of the force off the contour's normal [rad], and ``sliding``:
        ``"on"`` at the first station, ``"sticks"``, ``"back"``, or ``"free"``. It is
        ``"unsolved"``, without readings, where the sticking vibrissa has let go: a tip held on the
        object's far side may slip off there, or swing to the other side of its foot, when the foot
        turns round shortly before the snap-off.

    Raises
    ------
    InputError
        If the case has no friction, or the vibrissa does not touch where it is to turn.
    ArithmeticError
        If the states are lost on the way, or not exact.
    """
    _check(case)
    turn_at, stations = finite("turn_at", turn_at), whole("stations", stations, 2, 100_000)
    if case.sweep.direction == "right":
        return _mirrored(turn_back(case.mirrored(), -turn_at, stations))
    length = case.beam.length
    onward, back = _sliding(case, 1.0), _sliding(case, -1.0)
    first, last = onward.p[0], onward.p[onward.snap_off]
    if not last <= turn_at / length < first:
        snap_off = f"{last * length:.6g}, where the vibrissa snaps off"
        allowed = f"from {snap_off}, to {first * length:.6g}, where it first touches"
        raise InputError("turn_at", turn_at, allowed, "it turns round while it touches")
    foot = np.linspace(turn_at, case.foot_x[0], stations)
    foot_x = foot / length
    turning = _states(onward, case, foot_x[:1])
    way = stick(case.centreline, onward.vibrissa, turning[0], float(foot_x[-1]))
    columns = _unloaded(case, foot)
    sliding = np.full(stations, "free", dtype="<U8")
    sticks = (foot_x > foot_x[0]) & (foot_x < way.foot_x[-1])
    slides = (foot_x >= way.foot_x[-1]) & _holds(back, foot_x) & (way.then == "slides back")
    unsolved = (foot_x >= way.foot_x[-1]) & (way.then == "unsolved")
    limit = np.arctan(case.friction)
    on = np.arange(stations) == 0
    _fill(columns, on, case, turning, np.array([limit]))
    if sticks.any():
        z = between(case.centreline, onward.vibrissa, way, foot_x[sticks])
        _fill(columns, sticks, case, z[:, :3], z[:, 3])
    if slides.any():
        angle = np.full(int(slides.sum()), -limit)
        _fill(columns, slides, case, _states(back, case, foot_x[slides]), angle)
    for name in (*CLAMP_READINGS, *CONTACT):
        columns[name][unsolved] = np.nan
    for word, which in (("on", on), ("sticks", sticks), ("back", slides), ("unsolved", unsolved)):
        sliding[which] = word
    return _table(columns).assign(sliding=sliding)


def _check(case: Case) -> None:
    require("case", case, Case, "as Case(profile=..., friction=0.3)")
    case.require_sweep("a sweep that turns round")
    if case.friction == 0:
        raise InputError("friction", 0.0, "positive", "without friction nothing sticks")


def _sliding(case: Case, sense: float) -> Path:
    """The states that slide on (1), or back (-1), in a sweep to the left."""
    vibrissa = Vibrissa.of_case(case)._replace(friction=sense * case.friction)
    touch = first_touch(case.centreline, case.reach, vibrissa.at_rest.shape)
    path = follow(case.centreline, vibrissa, touch, case.reach, case.poses)
    if not path.complete:
        place = path.p[-1] * case.beam.length
        raise ArithmeticError(f"the equilibria are lost beyond foot_x = {place:.6g}")
    return path


def _holds(path: Path, foot_x: Floats) -> Booleans:
    return np.asarray((foot_x < path.p[0]) & (foot_x >= path.p[path.snap_off]))


def _states(path: Path, case: Case, foot_x: Floats) -> Floats:
    z, known = solve_places(path, case.poses, foot_x)
    if not known.all():
        place = foot_x[int(np.argmin(known))] * case.beam.length
        raise ArithmeticError(f"no state is found at foot_x = {place:.6g}")
    return z


def _unloaded(case: Case, foot: Floats) -> ReadingColumns:
    """The readings of a vibrissa that touches nothing, with no angle of friction."""
    columns = columns_at_rest(Vibrissa.of_case(case), foot, Units.of(case.beam))
    return {**columns, "friction_angle": np.full(foot.size, np.nan)}


def _table(columns: ReadingColumns) -> pd.DataFrame:
    return as_table(columns).drop(columns="status")


def _fill(columns: ReadingColumns, where: Booleans, case: Case, z: Floats, angle: Floats) -> None:
    units, held = Units.of(case.beam), Vibrissa.of_case(case)._replace(friction=np.tan(angle))
    found = states_at(case.centreline, z, held)
    solved = without_inexact(to_columns(found, units), held, units)
    if (inexact := solved["status"] == STATUS_NUMBER["diverged"]).any():
        place = columns["foot_x"][where][inexact][0]
        raise ArithmeticError(f"the state at foot_x = {place:.6g} is not exact")
    for name in COLUMNS[1:]:
        columns[name][where] = solved[name]
    columns["friction_angle"][where] = angle


def _mirrored(table: pd.DataFrame) -> pd.DataFrame:
    return mirrored_table(table).assign(friction_angle=0.0 - table["friction_angle"])
