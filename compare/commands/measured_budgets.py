"""Budgets and fastest motions as the commands measure them, with progress bars."""

from collections.abc import Mapping
from dataclasses import replace

from analytic import Readings, solve_sweep
from compare.commands.engines import softened
from compare.commands.terminal import progress
from compare.explain.budget import Budget
from compare.explain.changes import controlled_changes
from compare.explain.motion import (
    MotionBudget,
    slower_and_finer,
    slower_and_finer_of_model,
)
from compare.read.case import Job
from compare.simulate.controlled import measure_budget
from compare.simulate.fastest import Fastest, find_fastest
from compare.simulate.moving import measure_model_budget, measure_motion_budget
from mujoco_models import simulate_model, simulate_motion
from mujoco_models.motion import Motion


def measured_motion_budget(job: Job) -> tuple[MotionBudget, Mapping[str, Readings]]:
    """The budget of a job in motion, and its sweeps."""
    motion = job.motion or Motion()
    if job.model is not None:
        sweeps = len(slower_and_finer_of_model(job.model, motion)) + 1
        with progress("slower and finer", sweeps) as advance:
            return measure_model_budget(job.case, job.model, motion, job.settings, advance)
    with progress("slower and finer", len(slower_and_finer(motion)) + 1) as advance:
        return measure_motion_budget(
            job.case, motion, job.settings, softened(job.settings, motion), advance
        )


def fastest_motion(job: Job, runs: Mapping[str, Readings], target: float) -> Fastest:
    """The fastest motion of a job with a wanted error."""
    motion = job.motion or Motion()
    if job.model is None and motion.solref is None:
        motion = replace(motion, contact_stiffness=motion.stiffness)

    def move(speed: float) -> Readings:
        other = replace(motion, speed=speed)
        with progress(f"{speed:.3g} L/T1", job.case.sweep.stations) as advance:
            if job.model is not None:
                return simulate_model(job.case, job.model, other, job.settings, advance)
            return simulate_motion(job.case, other, job.settings, advance)

    return find_fastest(solve_sweep(job.case), runs, move, target)


def measured_budget(job: Job) -> tuple[Budget, dict[str, Readings]]:
    """The budget of a job, and its sweeps."""
    changes = len(set(controlled_changes(job.settings).values()))
    with progress("controlled changes", changes) as advance:
        return measure_budget(job.case, job.settings, advance)
