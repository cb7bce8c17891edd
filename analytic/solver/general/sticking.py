"""A vibrissa that sticks: all between sliding on and sliding back, from which it may only roll."""

from typing import Literal, NamedTuple

import numpy as np

from analytic.numerics.newton import Jacobian, Misses, solve
from analytic.numerics.panel import POINTS, WEIGHTS
from analytic.problem.arrays import Floats, Integers
from analytic.problem.contours.contour import Contour
from analytic.solver.general.states import States, Vibrissa, states_at

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
    foot_x = [float(_states(contour, vibrissa, z[0][None]).foot_x[0])]
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
    place = float(_states(contour, vibrissa, end[None]).foot_x[0])
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
        apart = _states(contour, vibrissa, at).foot_x - foot_x[which]
        return np.column_stack([missed, apart])

    z, missed = solve(misses, _differences(misses), guess)
    return np.column_stack([_in_phase(z), z[:, 3]]), missed


def _misses(contour: Contour, vibrissa: Vibrissa, start: Floats, z: Floats) -> Floats:
    """What states miss at the clamp's slope, at the contact's height and by sliding."""
    here = _states(contour, vibrissa, z)
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


def _states(contour: Contour, vibrissa: Vibrissa, z: Floats) -> States:
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
