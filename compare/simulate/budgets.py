"""What a disagreement of MuJoCo with the closed form is made of, for any kind of case."""

from collections.abc import Callable, Mapping
from typing import TypeAlias, overload

from analytic import Case, Readings
from analytic.space import SpatialCase, SpatialReadings, solve_space
from compare.explain.budget import Budget
from compare.explain.changes import controlled_changes
from compare.explain.motion import MotionBudget, slower_and_finer, slower_and_finer_of_model
from compare.explain.split_space import Parts, split_space
from compare.sense.given import checked
from compare.simulate.controlled import budget_at_rest
from compare.simulate.dispatch import simulate, softened
from compare.simulate.moving import budget_in_motion, budget_of_model
from mujoco_models.motion import Motion
from mujoco_models.settings import Settings
from mujoco_models.space.settings import SpatialSettings
from mujoco_models.user_model.names import OwnModel

AnyBudget: TypeAlias = Budget | MotionBudget | Parts
_SPLIT = 3  # sweeps in space: the one in question, another number of segments, another stiffness


@overload
def measure_budget(
    case: Case,
    settings: Settings | None = None,
    advance: Callable[[], None] = lambda: None,
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
) -> tuple[Parts, Mapping[str, SpatialReadings]]: ...


@overload
def measure_budget(
    case: Case | SpatialCase,
    settings: Settings | SpatialSettings | None = None,
    advance: Callable[[], None] = lambda: None,
    *,
    motion: Motion | None = None,
    model: OwnModel | None = None,
) -> tuple[AnyBudget, Mapping[str, Readings] | Mapping[str, SpatialReadings]]: ...


def measure_budget(
    case: Case | SpatialCase,
    settings: Settings | SpatialSettings | None = None,
    advance: Callable[[], None] = lambda: None,
    *,
    motion: Motion | None = None,
    model: OwnModel | None = None,
) -> tuple[AnyBudget, Mapping[str, Readings] | Mapping[str, SpatialReadings]]:
    """Measure what MuJoCo's disagreement with the closed form is made of, by controlled changes.

    Parameters
    ----------
    case : Case or SpatialCase
        The problem, in the plane or in space.
    settings : Settings or SpatialSettings, optional
        Of the sweep whose disagreement it is.
    advance : callable, optional
        Called after every sweep, `sweeps_of_budget` times in all.
    motion : Motion, optional
        How the foot moves: then parts are of speed, damping, time step and contacts.
    model : OwnModel, optional
        A user's model, in that motion, in place of our beam.

    Returns
    -------
    found : Budget, MotionBudget or Parts
        At rest in the plane, in motion, and in space; each has ``to_dict()``.
    sweeps : mapping of Readings or SpatialReadings
        All sweeps by name; ``"base"`` is the one in question.

    Raises
    ------
    InputError
        If the settings cannot be refined from, or the sweeps have no station in common.
    DivergedError
        If a sweep that the budget cannot do without is not a number any more.
    """
    if isinstance(case, SpatialCase):
        chosen = SpatialSettings() if settings is None else settings
        return _in_space(case, checked("settings", chosen, SpatialSettings, _REMEDY), advance)
    chosen = Settings() if settings is None else settings
    planar = checked("settings", chosen, Settings, _REMEDY)
    if motion is None:
        return budget_at_rest(case, planar, advance)
    if model is not None:
        return budget_of_model(case, model, motion, planar, advance)
    return budget_in_motion(case, motion, planar, softened(planar, motion), advance)


_REMEDY = "take Settings in the plane, SpatialSettings in space"


def sweeps_of_budget(
    settings: Settings | SpatialSettings,
    motion: Motion | None = None,
    model: OwnModel | None = None,
) -> int:
    """How many sweeps a budget takes."""
    if isinstance(settings, SpatialSettings):
        return _SPLIT
    if motion is None:
        return len(set(controlled_changes(settings).values()))
    if model is not None:
        return len(slower_and_finer_of_model(model, motion)) + 1
    return len(slower_and_finer(motion)) + 1


def _in_space(
    case: SpatialCase, settings: SpatialSettings, advance: Callable[[], None]
) -> tuple[Parts, Mapping[str, SpatialReadings]]:
    runs: dict[str, SpatialReadings] = {}

    def sweep(chosen: SpatialSettings) -> SpatialReadings:
        found = simulate(case, chosen)
        name = "base" if not runs else f"N={chosen.segments}, k={chosen.contact_stiffness:g}"
        runs[name] = found
        advance()
        return found

    base = sweep(settings)
    return split_space(solve_space(case), base, settings, sweep), runs
