"""What dry friction of either sign would do to the readings, at all frictionless stations."""

from dataclasses import replace

import numpy as np

from analytic.problem.case import Case
from analytic.problem.clamp_path import along_x
from analytic.problem.columns import COLUMNS, CONTACT, PHASE_NUMBER
from analytic.problem.errors import InputError
from analytic.problem.readings import Readings
from analytic.problem.recorder import facing, leftward
from analytic.problem.table import as_table, says
from analytic.solver.general.balance import states_at
from analytic.solver.general.columns import Units, to_columns, unloaded_columns, without
from analytic.solver.general.states import INSIDE, Vibrissa
from analytic.solver.general.stations import solve_near
from analytic.solver.sweep import solve_sweep

_STEPS = 4  # from none to all friction


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
        case.require_plain("friction of either sign")
    return facing(case, _leftward(leftward(case), coefficient))


def _leftward(case: Case, coefficient: float) -> Readings:
    exact, beam, contour = solve_sweep(case), case.beam, case.centreline
    phase = exact.table["phase"]
    touching, tangent = ~says(phase, "free"), says(phase, "tangent")
    alpha, free = exact.values("contact_angle"), exact.values("contact_arc_length") / beam.length
    leant = np.maximum(exact.values("tip_angle") - alpha, 0.0)
    excess = np.where(tangent, np.minimum(free - 1, INSIDE), leant)
    force = np.hypot(exact.values("force_x"), exact.values("force_y")) / beam.force_unit
    start = np.stack([contour.parameter(alpha[touching]), force[touching], excess[touching]], -1)

    foot_x, z = case.foot_x[touching] / beam.length, start
    for part in np.linspace(0, 1, _STEPS + 1)[1:]:
        vibrissa = Vibrissa.of_case(case)._replace(friction=part * coefficient)
        z, found = solve_near(contour, vibrissa, along_x(0.0).at(foot_x), z)
    solved = to_columns(states_at(contour, z, vibrissa), Units.of(beam))
    solved = without(solved, ~found, "diverged")
    columns = unloaded_columns(case.foot_x)
    for name in COLUMNS[1:]:
        columns[name][touching] = solved[name]
    lost = touching.copy()
    lost[touching] = ~found
    for name in CONTACT:
        columns[name][lost] = np.nan
    columns["phase"][lost] = np.where(tangent[lost], PHASE_NUMBER["tangent"], PHASE_NUMBER["tip"])
    provenance = {name: value for name, value in exact.provenance.items() if name != "events"}
    source = f"analytic, friction {coefficient:g}"
    return replace(exact, table=as_table(columns), source=source, provenance=provenance)
