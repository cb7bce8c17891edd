"""What dry friction would do to the readings, which the theory of Will et al. leaves out.

Sliding on, the object holds the vibrissa back along its tangent with mu times the normal force.
The elastica is integrated from the contact to the clamp by the classical Runge-Kutta method, and
three unknowns (where on the contour, how strong, and the free arc length or slope) are found by
Newton's method from the frictionless state. It shares nothing with the closed form of a case with
friction (`analytic.solver.general`), and takes either sign of it at the frictionless stations: what
a budget asks.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from analytic.checks.integration import march
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
_SETTLED = 1e-9  # L, rad, EI/L^2; a step of which a millionth is left, as the Jacobian is that good


class _Problem(NamedTuple):
    """Stations to solve, n in number."""

    centreline: Contour
    radius: float
    coefficient: float
    foot_x: Floats
    tangent: Booleans


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
        At the stations at which the frictionless sweep touches. ``status`` is ``"diverged"``, and
        all but the foot position NaN or the frictionless phase, where no state was found with
        friction. Where the vibrissa snaps off with friction is not determined, so that the
        provenance names no events.

    Raises
    ------
    InputError
        If the coefficient is out of range.
    """
    if not abs(coefficient) <= 0.5:
        raise InputError("friction coefficient", coefficient, "from -0.5 to 0.5", "0.1 is usual")
    if isinstance(case, Case):
        case.require_plain("the integration with friction")
    return solve_either_way(case, lambda leftward: _leftward(leftward, coefficient))


def _leftward(case: Case, coefficient: float) -> Readings:
    exact = solve_sweep(case)
    beam, length = case.beam, case.beam.length
    table = exact.table.drop(columns=["residual_boundary", "residual_moment"])
    touching = (table["phase"] != "free").to_numpy()
    tangent = (table["phase"] == "tangent").to_numpy()[touching]

    def known(name: str) -> Floats:
        return exact.values(name)[touching]

    force = np.hypot(known("force_x"), known("force_y")) / beam.force_unit
    free = np.where(tangent, known("contact_arc_length") / length, known("tip_angle"))
    t = case.centreline.parameter(known("contact_angle"))
    foot_x = case.foot_x[touching] / length
    problem = _Problem(case.centreline, case.radius, coefficient, foot_x, tangent)
    tangent, unknowns, clamp = _in_its_phase(problem, np.stack([t, force, free], -1))
    solved = np.isfinite(clamp).all(axis=1)
    point = case.centreline.at(unknowns[:, 0])
    arc_length = np.where(tangent, unknowns[:, 2], 1.0)
    columns = {
        **dict(
            zip(
                CLAMP_READINGS,
                (clamp * [beam.force_unit, beam.force_unit, beam.moment_unit]).T,
                strict=True,
            )
        ),
        "contact_angle": point.alpha,
        "contact_arc_length": arc_length * length,
        "contact_x": (point.xi - case.radius * np.sin(point.alpha)) * length,
        "contact_y": (point.eta + case.radius * np.cos(point.alpha)) * length,
        "tip_angle": np.where(tangent, point.alpha, unknowns[:, 2]),
    }
    for name, values in columns.items():
        table.loc[touching, name] = np.where(solved, values, np.nan)
    table.loc[touching, "phase"] = np.where(tangent, "tangent", "tip")
    table.loc[touching, "status"] = np.where(solved, "ok", "diverged")
    provenance = {name: value for name, value in exact.provenance.items() if name != "events"}
    source = f"analytic, friction {coefficient:g}"
    return replace(exact, table=table, source=source, provenance=provenance)


def _in_its_phase(problem: _Problem, start: Floats) -> tuple[Booleans, Floats, Floats]:
    """Phase B, unknowns and clamp readings of each station, in the phase that it has.

    The other phase is tried where the contact lies beyond the tip, or the tip in the body.
    """
    tangent = problem.tangent.copy()
    unknowns, clamp = _solve(problem, start)
    wrong = _out_of_phase(problem, tangent, unknowns)
    if wrong.any():
        tangent[wrong] = ~tangent[wrong]
        other = problem._replace(foot_x=problem.foot_x[wrong], tangent=tangent[wrong])
        begin = unknowns[wrong]
        begin[:, 2] = np.where(tangent[wrong], 1.0, problem.centreline.at(begin[:, 0]).alpha)
        unknowns[wrong], clamp[wrong] = _solve(other, begin)
        clamp[_out_of_phase(problem, tangent, unknowns)] = np.nan
    return tangent, unknowns, clamp


def _out_of_phase(problem: _Problem, tangent: Booleans, unknowns: Floats) -> Booleans:
    t, _, free = unknowns.T
    sunk = free < problem.centreline.at(t).alpha - _CLOSE
    return np.asarray(np.where(tangent, free > 1 + _CLOSE, sunk))


def _solve(problem: _Problem, unknowns: Floats) -> tuple[Floats, Floats]:
    """Unknowns and clamp readings, shape (n, 3); these NaN where Newton's method failed."""
    n = len(unknowns)
    beside = np.concatenate([np.zeros((1, 3)), _DIFFERENCE * np.eye(3)])[:, None]
    together = problem._replace(
        foot_x=np.tile(problem.foot_x, 4), tangent=np.tile(problem.tangent, 4)
    )
    for _ in range(_ITERATIONS):
        size = np.maximum(np.abs(unknowns), 1e-3)
        # In one march: it takes as many calls of numpy for four states as for one.
        shot = _shoot(together, (unknowns + beside * size).reshape(-1, 3))[0].reshape(4, n, 3)
        jacobian = ((shot[1:] - shot[0]) / (_DIFFERENCE * size.T[:, :, None])).transpose(1, 2, 0)
        with np.errstate(all="ignore"):
            regular = np.abs(np.linalg.det(jacobian)) > 0
            move = np.zeros_like(unknowns)
            move[regular] = np.linalg.solve(jacobian[regular], shot[0][regular][:, :, None])[..., 0]
        largest = 0.1 * np.maximum(1, np.abs(unknowns))
        unknowns = unknowns - np.clip(move, -largest, largest)
        if np.abs(move).max(initial=0.0) < _SETTLED:
            break
    missed, clamp = _shoot(problem, unknowns)
    clamp[~(np.abs(missed).max(axis=1) < _CLOSE)] = np.nan
    return unknowns, clamp


def _shoot(problem: _Problem, unknowns: Floats) -> tuple[Floats, Floats]:
    """What is missed at the clamp, and the clamp readings there; both of shape (n, 3)."""
    centreline, radius, coefficient, foot_x, tangent = problem
    t, force, free = unknowns.T
    alpha, xi, eta, _, _ = centreline.at(t)
    push = np.stack([np.sin(alpha), -np.cos(alpha)]) + coefficient * np.stack(
        [np.cos(alpha), np.sin(alpha)]
    )
    push *= force
    at_contact = -coefficient * radius * force  # friction acts on the surface, not on the axis

    def moment(x: Floats, y: Floats) -> Floats:
        return np.asarray(at_contact + (xi - x) * push[1] - (eta - y) * push[0])

    def rate(state: Floats) -> Floats:
        x, y, theta = state
        return np.stack([np.cos(theta), np.sin(theta), moment(x, y)])

    begin = np.stack([xi, eta, np.where(tangent, alpha, free)])
    x, y, theta = march(rate, begin, -np.where(tangent, free, 1.0), _STEPS)[-1]
    missed = np.stack([x - foot_x, y, theta - np.pi / 2], axis=-1)
    return missed, np.stack([-push[0], -push[1], -moment(x, y)], axis=-1)
