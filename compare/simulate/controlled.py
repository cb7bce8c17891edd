"""The budget of a case: all the sweeps that it takes, on all cores."""

from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import BrokenExecutor
from contextlib import contextmanager

from analytic import Case, InputError, Readings, solve_sweep
from analytic.problem.mirror import facing
from compare.explain.budget import Budget, budget
from compare.explain.changes import controlled_changes
from compare.explain.variations import on_polygon, variations
from compare.simulate.workers import SWEEPERS, Workers, available_cores
from mujoco_models import simulate_sweep
from mujoco_models.settings import Settings


def budget_at_rest(
    case: Case, settings: Settings, advance: Callable[[], None] = lambda: None
) -> tuple[Budget, dict[str, Readings]]:
    """The budget of a sweep at rest in the plane, and its sweeps."""
    smooth = has_primitive(case)
    changes = controlled_changes(settings, smooth, has_corners(case, settings))
    with _sweeping(case, changes, advance) as await_all:
        exact, varied, faceted = solve_sweep(case), variations(case), None
        if smooth and settings.obstacle == "mesh":
            past_facets = on_polygon(case, settings.contour_points)
            # A check, which must not cost the budget the stations where it has no solution.
            if (past_facets.table["status"] != "diverged").all():
                faceted = past_facets
        runs = await_all()
    return budget(exact, runs, varied, faceted), runs


def simulate_all(
    case: Case, changes: Mapping[str, Settings], advance: Callable[[], None] = lambda: None
) -> dict[str, Readings]:
    """Sweep one case with many settings, a process each; equal settings are swept once."""
    with _sweeping(case, changes, advance) as await_all:
        return await_all()


@contextmanager
def _sweeping(
    case: Case, changes: Mapping[str, Settings], advance: Callable[[], None]
) -> Iterator[Callable[[], dict[str, Readings]]]:
    """Begin all sweeps; what it yields waits for them."""
    # The longest first, so that no core waits for it at the end.
    longest_first = sorted(set(changes.values()), key=lambda s: -s.segments)
    with Workers(min(len(longest_first), available_cores()), SWEEPERS) as pool:
        sweeps = {
            # As a sweep to the left: in a mirror it is turned here, where tables are loaded.
            settings: pool.submit(simulate_sweep, _leftward(case), settings)
            for settings in longest_first
        }
        for sweep in sweeps.values():
            sweep.add_done_callback(lambda _: advance())

        def await_all() -> dict[str, Readings]:
            try:
                return {
                    name: facing(case, sweeps[settings].result())
                    for name, settings in changes.items()
                }
            except BrokenExecutor as error:
                raise MemoryError("the system ended a worker process") from error

        yield await_all


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
