"""Sweeps in MuJoCo as the commands do them: with a progress bar, and kept as far as they came."""

from pathlib import Path

import typer

from analytic import Readings
from compare.commands.terminal import progress
from compare.read.job import Job
from compare.simulate.dispatch import at_rest, simulate


def simulated(job: Job, folder: Path) -> Readings:
    """The sweep in MuJoCo; if it ends early, the stations that there are go into `folder`."""
    name = sweep_file(job)

    def keep(partial: Readings) -> None:
        path = partial.write(folder / Path(name).with_suffix(".partial.parquet"))
        stations = f"{len(partial.table)} of {job.case.sweep.stations} stations"
        typer.echo(f"vibrissa: kept {stations} in {path}", err=True)

    what = job.settings.beam if job.model is None else job.model.file.name
    with progress(f"MuJoCo {what}", job.case.sweep.stations) as advance:
        readings = simulate(
            job.case, job.settings, job.motion, job.model, advance=advance, keep=keep
        )
    readings.write(folder / name)
    return readings


def sweep_file(job: Job) -> str:
    """What the file of a sweep in MuJoCo is called."""
    if job.model is not None:
        return "mujoco-own-model.parquet"
    return f"mujoco-{job.settings.beam}{'-in-motion' if job.motion else ''}.parquet"


def swept_at_rest(job: Job) -> Readings:
    """The sweep at rest that a sweep in motion tends to, if it is slow enough."""
    with progress("at rest", job.case.sweep.stations) as advance:
        return simulate(job.case, at_rest(job.settings, job.motion), advance=advance)
