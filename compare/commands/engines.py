"""Sweeps in MuJoCo as the commands do them: with a progress bar, and kept as far as they came."""

from pathlib import Path

import typer

from analytic import Readings
from compare.commands.terminal import progress
from compare.explain.budget import Budget
from compare.explain.changes import controlled_changes
from compare.read.case import Job
from compare.simulate.controlled import measure_budget
from mujoco_models import simulate_sweep


def simulated(job: Job, folder: Path) -> Readings:
    """The sweep in MuJoCo; if it ends early, the stations that there are go into `folder`.

    Parameters
    ----------
    job : Job
        Case and settings.
    folder : Path
        Where ``mujoco-BEAM.parquet`` is written, or ``mujoco-BEAM.partial.parquet``.

    Returns
    -------
    Readings
        All of it.

    Raises
    ------
    InputError, DivergedError
        As `mujoco_models.simulate_sweep` does.
    """
    name = f"mujoco-{job.settings.beam}"

    def keep(partial: Readings) -> None:
        path = partial.write(folder / f"{name}.partial.parquet")
        stations = f"{len(partial.table)} of {job.case.sweep.stations} stations"
        typer.echo(f"vibrissa: kept {stations} in {path}", err=True)

    with progress(f"MuJoCo {job.settings.beam}", job.case.sweep.stations) as advance:
        readings = simulate_sweep(job.case, job.settings, advance, keep)
    readings.write(folder / f"{name}.parquet")
    return readings


def measured_budget(job: Job) -> tuple[Budget, dict[str, Readings]]:
    """The budget of a job, and its sweeps.

    Parameters
    ----------
    job : Job
        Case and settings.

    Returns
    -------
    Budget, dict of Readings
        As `compare.simulate.controlled.measure_budget` returns them.
    """
    changes = len(set(controlled_changes(job.settings).values()))
    with progress("controlled changes", changes) as advance:
        return measure_budget(job.case, job.settings, advance)
