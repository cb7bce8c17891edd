"""What dry friction would do to the clamp readings, which the paper's theory leaves out.

Sliding on, the object holds the vibrissa back along its tangent with mu times the normal force.
There is no closed form then: the elastica is integrated from the contact to the clamp, by the
classical Runge-Kutta method, and three unknowns (where on the contour, how strong, and the free arc
length or slope) are found by Newton's method from the frictionless state.
"""

from dataclasses import replace

import numpy as np

from analytic.problem.arrays import Booleans, Floats
from analytic.problem.case import Case
from analytic.problem.columns import CLAMP_READINGS
from analytic.problem.contours.contour import Contour
from analytic.problem.errors import InputError
from analytic.problem.mirror import solve_either_way
from analytic.problem.readings import Readings
from analytic.solver.sweep import solve_sweep

_STEPS = 200  # of Runge and Kutta's: 1e-9 of the readings at the largest curvatures met
_ITERATIONS = 12
_CLOSE = 1e-9  # L, rad; residual of the three conditions at the clamp
_DIFFERENCE = 1e-6  # relative step of the Jacobian's differences


def with_friction(case: Case, coefficient: float) -> Readings:
    """The sweep with Coulomb friction between a sliding vibrissa and the object.

    Parameters
    ----------
    case : Case
        The problem.
    coefficient : float
        Friction coefficient mu, from -0.5 to 0.5; negative to push the vibrissa on.

    Returns
    -------
    Readings
        The frictionless sweep with new clamp readings. Each station keeps its phase; where it has
        no state with friction, its readings are NaN.

    Raises
    ------
    InputError
        If the coefficient is out of range.
    """
    if not abs(coefficient) <= 0.5:
        raise InputError("friction coefficient", coefficient, "from -0.5 to 0.5", "0.1 is usual")
    return solve_either_way(case, lambda leftward: _leftward(leftward, coefficient))


def _leftward(case: Case, coefficient: float) -> Readings:
    exact = solve_sweep(case)
    beam, length = case.beam, case.beam.length
    table = exact.table.copy()
    touching = (table["phase"] != "free").to_numpy() & exact.trusted
    tangent = (table["phase"] == "tangent").to_numpy()[touching]

    def known(name: str) -> Floats:
        return exact.values(name)[touching]

    force = np.hypot(known("force_x"), known("force_y")) / beam.force_unit
    free = np.where(tangent, known("contact_arc_length") / length, known("tip_angle"))
    t = case.centreline.parameter(known("contact_angle"))
    clamp = _solve(
        case, coefficient, case.foot_x[touching] / length, tangent, np.stack([t, force, free], -1)
    )
    units = (beam.force_unit, beam.force_unit, beam.moment_unit)
    for name, values, unit in zip(CLAMP_READINGS, clamp.T, units, strict=True):
        table.loc[touching, name] = values * unit
    return replace(exact, table=table, source=f"analytic, friction {coefficient:g}")


def _solve(
    case: Case, coefficient: float, foot_x: Floats, tangent: Booleans, unknowns: Floats
) -> Floats:
    """Clamp readings, shape (n, 3), NaN where Newton's method did not get there."""

    def shoot(at: Floats) -> tuple[Floats, Floats]:
        return _shoot(case.centreline, case.radius, coefficient, foot_x, tangent, at)

    missed, clamp = shoot(unknowns)
    for _ in range(_ITERATIONS):
        jacobian = np.empty((*unknowns.shape, 3))
        for i in range(3):
            step = np.zeros(3)
            step[i] = _DIFFERENCE
            size = np.maximum(np.abs(unknowns[:, i]), 1e-3)[:, None]
            jacobian[:, :, i] = (shoot(unknowns + size * step)[0] - missed) / (_DIFFERENCE * size)
        with np.errstate(all="ignore"):
            regular = np.abs(np.linalg.det(jacobian)) > 0
            move = np.zeros_like(unknowns)
            move[regular] = np.linalg.solve(jacobian[regular], missed[regular][:, :, None])[..., 0]
        largest = 0.1 * np.maximum(1, np.abs(unknowns))
        unknowns = unknowns - np.clip(move, -largest, largest)
        missed, clamp = shoot(unknowns)
    clamp[~(np.abs(missed).max(axis=1) < _CLOSE)] = np.nan
    return clamp


def _shoot(
    centreline: Contour,
    radius: float,
    coefficient: float,
    foot_x: Floats,
    tangent: Booleans,
    unknowns: Floats,
) -> tuple[Floats, Floats]:
    """What is missed at the clamp, and the clamp readings there; both of shape (n, 3)."""
    t, force, free = unknowns.T
    alpha, xi, eta, _, _ = centreline.at(t)
    push = np.stack([np.sin(alpha), -np.cos(alpha)]) + coefficient * np.stack(
        [np.cos(alpha), np.sin(alpha)]
    )
    push *= force
    at_contact = -coefficient * radius * force  # friction acts on the surface, not on the axis
    span = np.where(tangent, free, 1.0)

    def rate(state: Floats) -> Floats:
        x, y, theta = state
        moment = at_contact + (xi - x) * push[1] - (eta - y) * push[0]
        return np.stack([np.cos(theta), np.sin(theta), moment])

    state = np.stack([xi, eta, np.where(tangent, alpha, free)])
    h = -span / _STEPS
    for _ in range(_STEPS):
        k1 = rate(state)
        k2 = rate(state + h / 2 * k1)
        k3 = rate(state + h / 2 * k2)
        k4 = rate(state + h * k3)
        state = state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    x, y, theta = state
    moment = at_contact + (xi - x) * push[1] - (eta - y) * push[0]
    missed = np.stack([x - foot_x, y, theta - np.pi / 2], axis=-1)
    return missed, np.stack([-push[0], -push[1], -moment], axis=-1)
