"""Agreement, and a sound model, as assertions for users' own tests."""

from pathlib import Path
from typing import Literal

from analytic import Beam, InputError, Readings
from analytic.problem.errors import require
from analytic.space import SpatialReadings
from compare.align.frames import Frame
from compare.comparison import Comparison, SpatialComparison, compare
from compare.explain.budget import Budget
from compare.judge.tolerances import SpatialTolerances, Tolerances
from compare.show.verdict import why
from mujoco_models import inspect_model


def assert_agreement(
    reference: Readings | SpatialReadings,
    candidate: Readings | SpatialReadings,
    tolerances: Tolerances | SpatialTolerances | None = None,
    *,
    offset: float | Literal["auto"] = 0.0,
    noise: float | Literal["auto"] = 0.0,
    budget: Budget | None = None,
    frame: Frame = "world",
) -> Comparison | SpatialComparison:
    """Raise AssertionError unless the sweeps agree.

    Its message holds every exceeded limit in a line (which reading, which phase, where, how much,
    how much is allowed and why), and what the disagreement is likely made of.

    Parameters
    ----------
    reference, candidate, tolerances, offset, noise, frame
        As `compare` takes them, of two sweeps in the plane or in space.
    budget : Budget, optional
        Of the candidate's disagreement in the plane, measured by controlled changes; the message
        names its largest part in place of the likeness to a known fault.

    Returns
    -------
    Comparison or SpatialComparison
        If they agree.

    Raises
    ------
    AssertionError
        If they do not.
    InputError
        As `compare`, or if there is a budget of sweeps in space.
    """
    __tracebackhide__ = True  # a failing test shows its own lines, and the message
    if budget is not None and isinstance(reference, SpatialReadings):
        raise InputError("budget", "given", "for sweeps in the plane", "leave it out")
    comparison = compare(reference, candidate, tolerances, offset=offset, noise=noise, frame=frame)
    demand(comparison, budget)
    return comparison


def demand(comparison: Comparison | SpatialComparison, budget: Budget | None = None) -> None:
    __tracebackhide__ = True
    if comparison.agrees:
        return
    title = f"{comparison.candidate.source} disagrees with {comparison.reference.source}:"
    if isinstance(comparison, Comparison):
        causes = [why(comparison, budget)]
    else:
        causes = [comparison.why] if comparison.why else []
    lines = [title, *causes, *comparison.failures, *comparison.remarks]
    raise AssertionError("\n  ".join(lines))


def assert_sound(model: str | Path, stated: Beam | None = None, **names: str) -> None:
    """Raise AssertionError if a MuJoCo model has a fault, as ``vibrissa inspect`` finds it.

    Parameters
    ----------
    model : str or Path
        As `mujoco_models.inspect_model` takes it.
    stated : Beam, optional
        What the model should be, in its units.
    **names : str
        As of `mujoco_models.inspect_model`.

    Raises
    ------
    AssertionError
        Each fault is a line, with what to set.
    InputError
        As `mujoco_models.inspect_model`.
    """
    __tracebackhide__ = True
    from compare.simulate.inspection import Inspection  # loads MuJoCo

    if stated is not None:
        require("stated", stated, Beam, "as Beam(length=..., flexural_rigidity=...)")
    inspection = Inspection(inspect_model(model, **names), stated)
    if not inspection.sound:
        raise AssertionError("\n  ".join([f"{model} is not sound:", *map(str, inspection.faults)]))
