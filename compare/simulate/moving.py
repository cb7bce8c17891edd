"""The budget of a sweep in motion: all the sweeps that it takes, on all cores."""

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import replace
from typing import Any

from analytic import Case, Readings, solve_sweep
from compare.explain.motion import (
    OPTIONAL,
    MotionBudget,
    motion_budget,
    slower_and_finer,
    slower_and_finer_of_model,
)
from compare.simulate.dispatch import simulate
from compare.simulate.inspection import measured_beam
from compare.simulate.means import sweep_as_means
from compare.simulate.rigidity import by_its_clamp
from compare.simulate.workers import running
from mujoco_models.errors import DivergedError
from mujoco_models.inspect.measured import MeasuredBeam
from mujoco_models.motion import Motion
from mujoco_models.settings import Settings
from mujoco_models.user_model.names import OwnModel

_TRUSTED = 0.75  # of the stations; a sweep with fewer would cost the budget most of them


def budget_in_motion(
    case: Case,
    motion: Motion,
    settings: Settings,
    at_rest: Settings,
    advance: Callable[[], None] = lambda: None,
) -> tuple[MotionBudget, Mapping[str, Readings]]:
    """The budget of a sweep in motion, and its sweeps."""
    motions = slower_and_finer(motion)
    sweeps = {name: (simulate, case, settings, one) for name, one in motions.items()}
    runs = _swept({**sweeps, "rest": (sweep_as_means, case, at_rest, motion.average)}, advance)
    left_out = tuple(name for name in motions if name not in runs)
    return replace(motion_budget(solve_sweep(case), runs), left_out=left_out), runs


def budget_of_model(
    case: Case,
    model: OwnModel,
    motion: Motion,
    settings: Settings,
    advance: Callable[[], None] = lambda: None,
) -> tuple[MotionBudget, Mapping[str, Readings]]:
    """The same of a user's own model; nothing of its files is changed.

    ``at rest`` is of our chain with as many links. ``beam`` is the closed form of the vibrissa that
    was measured less that of the one that is stated.
    """
    found = measured_beam(model)
    # What is soft about the model's contacts is a part of its own.
    at_rest = replace(settings, segments=max(len(found.joints), 2))
    of_model = slower_and_finer_of_model(model, motion)
    sweeps = {
        name: (simulate, case, settings, moved, changed)
        for name, (changed, moved) in of_model.items()
    }
    runs = _swept({**sweeps, "rest": (sweep_as_means, case, at_rest, motion.average)}, advance)
    no_ours = "ours" in sweeps and "ours" not in runs
    if "stiff" in runs and (no_ours or runs["stiff"].trusted.mean() < _TRUSTED):
        del runs["stiff"]
    if not case.beam.varies:
        runs["beam"] = solve_sweep(_as_measured(case, found))
    left_out = tuple(name for name in of_model if name not in runs)
    budget = motion_budget(solve_sweep(case), runs, of_our_chain=True)
    return replace(budget, left_out=left_out), runs


def _as_measured(case: Case, found: MeasuredBeam) -> Case:
    """The case of the vibrissa that was measured, at the same stations."""
    beam = replace(
        case.beam,
        length=found.length,
        flexural_rigidity=by_its_clamp(found),
        natural_curvature=found.natural_curvature,
    )
    ends = float(case.foot_x[0]), float(case.foot_x[-1])
    return replace(case, beam=beam).between(*ends)


def _swept(
    sweeps: Mapping[str, tuple[Any, ...]], advance: Callable[[], None]
) -> dict[str, Readings]:
    """All sweeps, but for optional ones that diverge."""
    with running(sweeps, advance) as swept:
        runs = {}
        for name, sweep in swept.items():
            with suppress(*[DivergedError] * (name in OPTIONAL)):
                runs[name] = sweep.result()
        return runs
