"""The budget of a sweep in motion: all the sweeps that it takes, on all cores."""

from collections.abc import Callable, Mapping
from concurrent.futures import as_completed
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np

from analytic import CLAMP_READINGS, Case, Readings, solve_sweep
from analytic.problem.quantities import between, shifted
from compare.explain.motion import (
    OPTIONAL,
    MotionBudget,
    motion_budget,
    slower_and_finer,
    slower_and_finer_of_model,
)
from compare.simulate.dispatch import simulate, softened
from compare.simulate.inspection import measured_beam
from compare.simulate.rigidity import by_its_clamp
from compare.simulate.workers import running
from mujoco_models import simulate_sweep
from mujoco_models.errors import DivergedError
from mujoco_models.inspect.measured import MeasuredBeam
from mujoco_models.motion import Motion
from mujoco_models.settings import Settings
from mujoco_models.user_model.names import OwnModel

_TRUSTED = 0.75  # of the stations; a sweep with fewer would cost the budget most of them
_PARTS = 8  # of the distance from station to station


def budget_in_motion(
    case: Case,
    motion: Motion,
    settings: Settings,
    model: OwnModel | None = None,
    advance: Callable[[], None] = lambda: None,
) -> tuple[MotionBudget, Mapping[str, Readings]]:
    """The budget of a sweep in motion, and its sweeps.

    Of a user's own model, nothing of whose files is changed, ``at rest`` is of our chain with as
    many links, and ``beam`` is the closed form of the vibrissa that was measured less that of the
    one that is stated.
    """
    if motion.average:
        case.require_sweep("a budget in motion")
    sweeps: dict[str, tuple[Any, ...]]
    if model is None:
        resting = softened(settings, motion)
        sweeps = {name: (one,) for name, one in slower_and_finer(motion).items()}
    else:
        found = measured_beam(model)
        # What is soft about the model's contacts is a part of its own.
        resting = replace(settings, segments=max(len(found.joints), 2))
        of_model = slower_and_finer_of_model(model, motion)
        sweeps = {name: (moved, changed) for name, (changed, moved) in of_model.items()}
    # The last ones take the most steps, and are the first to be refused.
    last_first = reversed(sweeps.items())
    tasks = {name: (simulate, case, settings, *one) for name, one in last_first}
    rest = (sweep_as_means, case, resting, motion.average)
    runs: dict[str, Readings] = {}
    with running({"rest": rest, **tasks}, advance) as swept:
        names: dict[Any, str] = {sweep: name for name, sweep in swept.items()}
        for sweep in as_completed(names):
            with suppress(*[DivergedError] * (names[sweep] in OPTIONAL)):
                runs[names[sweep]] = sweep.result()
    if model is not None:
        no_ours = "ours" in sweeps and "ours" not in runs
        if "stiff" in runs and (no_ours or runs["stiff"].trusted.mean() < _TRUSTED):
            del runs["stiff"]
        if not case.beam.varies:
            runs["beam"] = solve_sweep(_as_measured(case, found))
    left_out = tuple(name for name in sweeps if name not in runs)
    budget = motion_budget(solve_sweep(case), runs, of_our_chain=model is not None)
    return replace(budget, left_out=left_out), runs


def _as_measured(case: Case, found: MeasuredBeam) -> Case:
    """The case of the vibrissa that was measured, at the same stations."""
    beam = replace(
        case.beam,
        length=found.length,
        flexural_rigidity=by_its_clamp(found),
        natural_curvature=found.natural_curvature,
    )
    return replace(shifted(case), beam=beam)


def sweep_as_means(case: Case, settings: Settings, average: float) -> Readings:
    """Sweep at rest, each station's clamp readings the means over the distance around it.

    The readings of a coarse beam have kinks where the contact passes from segment to segment, so
    that such a mean is not the value in its middle: 9e-4 rms with twenty segments, sixty stations.
    """
    if average == 0:
        return simulate_sweep(case, settings)
    first, last = (float(x) for x in case.foot_x[[0, -1]])
    stations = case.sweep.stations
    found = simulate_sweep(between(case, first, last, (stations - 1) * _PARTS + 1), settings)
    table = found.table.iloc[::_PARTS].reset_index(drop=True)
    places = np.arange(len(found.table))
    offsets = average * _PARTS * np.linspace(-0.5, 0.5, _PARTS + 1)
    wanted = np.clip(_PARTS * np.arange(stations)[:, None] + offsets, 0, places[-1])
    width = np.ptp(wanted, axis=1)
    for name in CLAMP_READINGS:
        values = np.interp(wanted, places, found.values(name))
        table[name] = np.trapezoid(values, wanted, axis=1) / width
    nowhere = table[[*CLAMP_READINGS]].isna().any(axis=1)
    table["status"] = table["status"].mask(nowhere & (table["status"] == "ok"), "unsettled")
    return replace(found, table=table)
