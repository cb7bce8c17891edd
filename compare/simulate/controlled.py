"""The budget of a case: all the sweeps that it takes, on all cores."""

from collections.abc import Callable

from analytic import Case, InputError, Readings, solve_sweep
from analytic.problem.mirror import facing
from compare.explain.budget import Budget, budget
from compare.explain.changes import controlled_changes
from compare.explain.variations import on_polygon, variations
from compare.simulate.workers import SWEEPERS, running
from mujoco_models import simulate_sweep
from mujoco_models.settings import Settings


def budget_at_rest(
    case: Case, settings: Settings, advance: Callable[[], None] = lambda: None
) -> tuple[Budget, dict[str, Readings]]:
    """The budget of a sweep at rest in the plane, and its sweeps."""
    smooth = has_primitive(case)
    changes = controlled_changes(settings, smooth, has_corners(case, settings))
    # Equal settings are swept once, and the longest first, so that no core waits for it at the end.
    # As a sweep to the left: in a mirror it is turned here, where tables are loaded.
    longest_first = sorted(set(changes.values()), key=lambda one: -one.segments)
    sweeps = {one: (simulate_sweep, _leftward(case), one) for one in longest_first}
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
        Primitive.of(_leftward(case))
    except InputError:
        return False
    return True


def has_corners(case: Case, settings: Settings) -> bool:
    """Whether MuJoCo's object has edges at sharp corners."""
    from mujoco_models.obstacles.kinds import place

    return len(place(_leftward(case), settings).corners) > 0


def _leftward(case: Case) -> Case:
    return case.mirrored() if case.sweep.direction == "right" else case
