"""Budgets and fastest motions as the commands measure them, with progress bars."""

from collections.abc import Mapping
from dataclasses import replace

from analytic import Readings, solve_sweep
from compare.commands.terminal import progress
from compare.explain.budget import Budget
from compare.explain.motion import MotionBudget
from compare.read.job import Job
from compare.simulate.budgets import measure_budget, sweeps_of_budget
from compare.simulate.dispatch import simulate
from compare.simulate.fastest import Fastest, find_fastest
from mujoco_models.motion import Motion


def measured_motion_budget(job: Job) -> tuple[MotionBudget, Mapping[str, Readings]]:
    """The budget of a job in motion, and its sweeps."""
    motion = job.motion or Motion()
    sweeps = sweeps_of_budget(job.settings, motion, job.model)
    with progress("slower and finer", sweeps) as advance:
        return measure_budget(job.case, job.settings, advance, motion=motion, model=job.model)


def fastest_motion(job: Job, runs: Mapping[str, Readings], target: float) -> Fastest:
    """The fastest motion of a job with a wanted error."""
    motion = job.motion or Motion()
    if job.model is None and motion.solref is None:
        motion = replace(motion, contact_stiffness=motion.stiffness)

    def move(speed: float) -> Readings:
        other = replace(motion, speed=speed)
        with progress(f"{speed:.3g} L/T1", job.case.sweep.stations) as advance:
            return simulate(job.case, job.settings, other, job.model, advance=advance)

    return find_fastest(solve_sweep(job.case), runs, move, target)


def measured_budget(job: Job) -> tuple[Budget, Mapping[str, Readings]]:
    """The budget of a job, and its sweeps."""
    with progress("controlled changes", sweeps_of_budget(job.settings)) as advance:
        return measure_budget(job.case, job.settings, advance)
