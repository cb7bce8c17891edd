"""The sweeps of a job: solved, simulated, written, and printed in a line."""

from pathlib import Path
from typing import TypeAlias

from analytic import Readings, reconstruct
from analytic.space import SpatialReadings
from compare.commands import terminal
from compare.commands.output import waiting, warn
from compare.commands.space import find_body
from compare.commands.sweep_lines import print_sweep
from compare.read.job import AnyJob, Job

AnyReadings: TypeAlias = Readings | SpatialReadings


def solved(job: AnyJob, folder: Path, certified: bool, figures: bool) -> AnyReadings:
    """The closed form's sweep, written; the paper's figures of it too, if wanted."""
    with waiting("solving"):
        exact: AnyReadings = job.solve(certified)
        exact.write(folder / "analytic.parquet")
    if figures and isinstance(job, Job) and isinstance(exact, Readings):
        from compare.show.figures.geometry import reconstruction
        from compare.show.figures.paper import paper_figures

        drawn = paper_figures(job.case, exact)
        if not job.case.beam.varies:
            drawn["shapes"] = reconstruction(exact, reconstruct(exact))
        for name, figure in drawn.items():
            terminal.keep(folder / f"{name}.png", figure)
    return exact


def sweep_file(job: AnyJob) -> str:
    """What the file of a sweep in MuJoCo is called."""
    if job.model is not None:
        return "mujoco-own-model.parquet"
    return f"mujoco-{job.settings.beam}{'-in-motion' if job.motion else ''}.parquet"


def simulated(job: AnyJob, folder: Path) -> AnyReadings:
    """The sweep in MuJoCo, written; if it ends early, the stations that there are."""
    from compare.simulate.dispatch import simulate

    file = folder / sweep_file(job)

    def keep_part(part: AnyReadings) -> None:
        path = part.write(file.with_suffix(".partial.parquet"))
        warn(f"kept {len(part.table)} of {job.stations} stations in {path}")

    what = job.settings.beam if job.model is None else job.model.file.name
    with terminal.progress(f"MuJoCo {what}", job.stations) as advance:
        swept = simulate(
            job.case, job.settings, job.motion, job.model, advance=advance, keep=keep_part
        )
    swept.write(file)
    return swept


def printed(job: AnyJob, readings: AnyReadings, folder: Path, name: str | None = None) -> bool:
    """Print what a sweep found, and in space find the body from it; whether that could be."""
    print_sweep(readings)
    if name is not None:
        terminal.print_written(folder / name)
    return isinstance(readings, Readings) or find_body(
        readings, job.body, folder, 0.0, name is not None
    )
