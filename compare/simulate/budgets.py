"""What a disagreement of MuJoCo with the closed form is made of, for any kind of case."""

from collections.abc import Callable, Mapping
from typing import overload

from analytic import Case, InputError, Readings, solve_sweep
from analytic.problem.errors import require
from analytic.problem.recorder import facing, leftward
from analytic.space import SpatialCase, SpatialReadings, solve_space
from compare.explain.budget import (
    Budget,
    budget,
    budget_in_space,
    changes_in_space,
    controlled_changes,
)
from compare.explain.motion import MotionBudget
from compare.explain.parts import Parted
from compare.explain.variations import on_polygon, variations
from compare.simulate.moving import budget_in_motion
from compare.simulate.workers import SWEEPERS, running
from mujoco_models import simulate_space, simulate_sweep
from mujoco_models.motion import Motion
from mujoco_models.settings import Settings, SpatialSettings
from mujoco_models.user_model.names import OwnModel


@overload
def measure_budget(
    case: Case, settings: Settings | None = None, advance: Callable[[], None] = lambda: None
) -> tuple[Budget, Mapping[str, Readings]]: ...


@overload
def measure_budget(
    case: Case,
    settings: Settings | None = None,
    advance: Callable[[], None] = lambda: None,
    *,
    motion: Motion,
    model: OwnModel | None = None,
) -> tuple[MotionBudget, Mapping[str, Readings]]: ...


@overload
def measure_budget(
    case: SpatialCase,
    settings: SpatialSettings | None = None,
    advance: Callable[[], None] = lambda: None,
) -> tuple[Parted, Mapping[str, SpatialReadings]]: ...


def measure_budget(
    case: Case | SpatialCase,
    settings: Settings | SpatialSettings | None = None,
    advance: Callable[[], None] = lambda: None,
    *,
    motion: Motion | None = None,
    model: OwnModel | None = None,
) -> tuple[Parted, Mapping[str, Readings] | Mapping[str, SpatialReadings]]:
    """Measure what MuJoCo's disagreement with the closed form is made of, by controlled changes.

    Parameters
    ----------
    case : Case or SpatialCase
        The problem, in the plane or in space.
    settings : Settings or SpatialSettings, optional
        Of the sweep whose disagreement it is.
    advance : callable, optional
        Called after every sweep.
    motion : Motion, optional
        How the foot moves: then parts are of speed, damping, time step and contacts.
    model : OwnModel, optional
        A user's model, in that motion, in place of our beam.

    Returns
    -------
    found : Budget, MotionBudget or Parted
        At rest in the plane, in motion, and in space; each has ``to_dict()``.
    sweeps : mapping of Readings or SpatialReadings
        All sweeps by name; ``"base"`` is the one in question.

    Raises
    ------
    InputError
        If the case has friction or several objects, the settings cannot be refined from, or the
        sweeps have no station in common.
    DivergedError
        If a sweep that the budget cannot do without is not a number any more.
    """
    if case.friction:
        allowed, remedy = "0 for a budget, whose sweeps at rest know none", "take --budget away"
        raise InputError("friction", case.friction, allowed, remedy)
    if isinstance(case, SpatialCase):
        if motion is not None:  # whose disagreement nothing splits
            raise InputError("motion", "given", "none for a budget in space", "take it at rest")
        chosen = SpatialSettings() if settings is None else settings
        changes = changes_in_space(require("settings", chosen, SpatialSettings, _REMEDY))
        tasks = {name: (simulate_space, case, one) for name, one in changes.items()}
        with running(tasks, advance, SWEEPERS) as swept:
            exact = solve_space(case)
            runs = {name: one.result() for name, one in swept.items()}
        return budget_in_space(exact, runs, changes), runs
    case.require_one_object("a budget")
    chosen = Settings() if settings is None else settings
    planar = require("settings", chosen, Settings, _REMEDY)
    if motion is None:
        return budget_at_rest(case, planar, advance)
    return budget_in_motion(case, motion, planar, model, advance)


_REMEDY = "take Settings in the plane, SpatialSettings in space"


def budget_at_rest(
    case: Case, settings: Settings, advance: Callable[[], None]
) -> tuple[Budget, dict[str, Readings]]:
    smooth = has_primitive(case)
    changes = controlled_changes(settings, smooth, has_corners(case, settings))
    # Equal settings are swept once, and the longest first, so that no core waits for it at the end.
    # As a sweep to the left: in a mirror it is turned here, where tables are loaded.
    longest_first = sorted(set(changes.values()), key=lambda one: -one.segments)
    sweeps = {one: (simulate_sweep, leftward(case), one) for one in longest_first}
    with running(sweeps, advance, SWEEPERS) as swept:
        exact, varied, faceted = solve_sweep(case), variations(case), None
        if smooth and settings.obstacle == "mesh":
            past_facets = on_polygon(case, settings.contour_points)
            # A check, which must not cost the budget the stations where it has no solution.
            if (past_facets.table["status"] != "diverged").all():
                faceted = past_facets
        runs = {name: facing(case, swept[one].result()) for name, one in changes.items()}
    return budget(exact, runs, varied, faceted), runs


def has_primitive(case: Case) -> bool:
    """Whether MuJoCo's smooth primitive can stand for the case's contour."""
    from mujoco_models.obstacles.primitive import Primitive

    try:
        Primitive.of(leftward(case))
    except InputError:
        return False
    return True


def has_corners(case: Case, settings: Settings) -> bool:
    from mujoco_models.obstacles.kinds import place

    return len(place(leftward(case), settings).corners) > 0
