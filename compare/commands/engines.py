"""Sweeps in MuJoCo as the commands do them: with a progress bar, and kept as far as they came."""

from dataclasses import replace
from pathlib import Path

import typer

from analytic import Readings
from compare.commands.terminal import progress
from compare.read.job import Job
from mujoco_models import simulate_model, simulate_motion, simulate_sweep
from mujoco_models.allowed import CONTACT_STIFFNESSES
from mujoco_models.motion import Motion
from mujoco_models.settings import Settings


def simulated(job: Job, folder: Path) -> Readings:
    """The sweep in MuJoCo; if it ends early, the stations that there are go into `folder`."""
    name = sweep_file(job)

    def keep(partial: Readings) -> None:
        path = partial.write(folder / Path(name).with_suffix(".partial.parquet"))
        stations = f"{len(partial.table)} of {job.case.sweep.stations} stations"
        typer.echo(f"vibrissa: kept {stations} in {path}", err=True)

    what = job.settings.beam if job.model is None else job.model.file.name
    with progress(f"MuJoCo {what}", job.case.sweep.stations) as advance:
        if job.model is not None:
            readings = simulate_model(job.case, job.model, job.motion, job.settings, advance, keep)
        elif job.motion is None:
            readings = simulate_sweep(job.case, job.settings, advance, keep)
        else:
            readings = simulate_motion(job.case, job.motion, job.settings, advance, keep)
    readings.write(folder / name)
    return readings


def sweep_file(job: Job) -> str:
    """What the file of a sweep in MuJoCo is called."""
    if job.model is not None:
        return "mujoco-own-model.parquet"
    return f"mujoco-{job.settings.beam}{'-in-motion' if job.motion else ''}.parquet"


def at_rest(job: Job) -> Readings:
    """The sweep at rest that a sweep in motion tends to, if it is slow enough."""
    settings = settings_at_rest(job)
    with progress("at rest", job.case.sweep.stations) as advance:
        return simulate_sweep(job.case, settings, advance)


def settings_at_rest(job: Job) -> Settings:
    """Those of the sweep at rest that a sweep in motion tends to."""
    if job.motion is None or job.motion.solref is not None:
        return job.settings
    return softened(job.settings, job.motion)


def softened(settings: Settings, motion: Motion) -> Settings:
    """Settings at rest with contacts as stiff as ours are in a motion."""
    least, largest = CONTACT_STIFFNESSES
    return replace(settings, contact_stiffness=min(max(motion.stiffness, least), largest))
