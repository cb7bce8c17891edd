"""What a disagreement of MuJoCo with the closed form is made of, for any kind of case."""

from collections.abc import Callable, Mapping
from typing import TypeAlias, overload

from analytic import Case, Readings
from analytic.space import SpatialCase, SpatialReadings, solve_space
from compare.explain.budget import Budget
from compare.explain.motion import MotionBudget
from compare.explain.split_space import Parts, split_space
from compare.sense.given import checked
from compare.simulate.controlled import budget_at_rest
from compare.simulate.dispatch import softened
from compare.simulate.moving import budget_in_motion, budget_of_model
from mujoco_models import simulate_space
from mujoco_models.motion import Motion
from mujoco_models.settings import Settings
from mujoco_models.space.settings import SpatialSettings
from mujoco_models.user_model.names import OwnModel

AnyBudget: TypeAlias = Budget | MotionBudget | Parts


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
        Called after every sweep.
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


def _in_space(
    case: SpatialCase, settings: SpatialSettings, advance: Callable[[], None]
) -> tuple[Parts, Mapping[str, SpatialReadings]]:
    runs: dict[str, SpatialReadings] = {}

    def sweep(chosen: SpatialSettings) -> SpatialReadings:
        found = simulate_space(case, chosen)
        name = "base" if not runs else f"N={chosen.segments}, k={chosen.contact_stiffness:g}"
        runs[name] = found
        advance()
        return found

    base = sweep(settings)
    return split_space(solve_space(case), base, settings, sweep), runs
