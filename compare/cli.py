"""The command ``vibrissa``."""

import json
import math
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path
from typing import Annotated, Any, Literal, cast

import typer
from rich.console import Console
from rich.progress import Progress
from rich.table import Table

from analytic import (
    CASE_NAMES,
    Case,
    InputError,
    Readings,
    named_case,
    relative_noise,
    solve_sweep,
)
from analytic import reconstruct as reconstruct_contour
from analytic.problem.readings import CLAMP_READINGS
from compare.animation import write_animation
from compare.budget import Budget, controlled_changes
from compare.budget import budget as measure_budget
from compare.budget.figure import picture
from compare.budget.suspects import variations
from compare.casefile import Job, load_job
from compare.comparison import Comparison
from compare.comparison import compare as compare_readings
from compare.figures import reconstruction, save_figure
from compare.measured import read_measured, write_table, write_text
from compare.paper_figures import paper_figures
from compare.report import write_report
from compare.study.cli import study, study_report
from compare.tolerance_file import read_tolerances
from mujoco_models.settings import Settings

# Any wrong word on the command line; typer may bring its own copy of click, whose base this is.
_UsageError: type[Exception] = typer.BadParameter.__bases__[0]
AGREES, DISAGREES, BAD_INPUT = 0, 1, 2

app = typer.Typer(
    add_completion=False,
    no_args_is_help=True,
    help="A vibrissa swept past a convex object: the exact elastica against MuJoCo.",
    pretty_exceptions_enable=False,
)
app.command()(study)
app.command()(study_report)
_told = Console(highlight=False)
_noted = Console(stderr=True, highlight=False)

CaseName = Annotated[
    str, typer.Argument(metavar="CASE", help="A named case (see `vibrissa cases`) or a TOML file.")
]
Out = Annotated[
    Path | None, typer.Option("--out", metavar="DIR", help="Folder for what is written.")
]
Stations = Annotated[int | None, typer.Option(help="Stations of the sweep, instead of the case's.")]
Segments = Annotated[int | None, typer.Option(help="Segments of MuJoCo's beam.")]
Beam = Annotated[str | None, typer.Option(help="MuJoCo's beam.")]
BeamFile = Annotated[
    Path | None,
    typer.Option(help="TOML file whose [beam] table tells the vibrissa of measured data."),
]
Columns = Annotated[
    list[str] | None,
    typer.Option(help="NAME=COLUMN or NAME=COLUMN:UNIT, for a rig's own columns; repeat it."),
]


@app.command()
def run(
    case: CaseName,
    out: Out = None,
    stations: Stations = None,
    segments: Segments = None,
    beam: Beam = None,
) -> int:
    """Sweep in both models, compare, and write the report."""
    job = _job(case, stations, segments, beam)
    folder = _folder(out, job)
    exact = solve_sweep(job.case)
    simulated = _simulate(job)
    comparison = compare_readings(exact, simulated, job.tolerances)
    exact.write(folder / "analytic.parquet")
    simulated.write(folder / f"mujoco-{job.settings.beam}.parquet")
    return _finish(comparison, folder)


@app.command()
def analytic(
    case: CaseName,
    out: Out = None,
    stations: Stations = None,
    certified: Annotated[
        bool, typer.Option("--certified", help="Check each station by integration from the clamp.")
    ] = False,
    figures: Annotated[
        bool, typer.Option("--figures", help="Draw the paper's figures 12, 14, 15 and 16.")
    ] = False,
) -> int:
    """Sweep in closed form."""
    job = _job(case, stations, None, None)
    folder = _folder(out, job)
    readings = solve_sweep(job.case, certified)
    drawn = paper_figures(job.case, readings) if figures else {}
    _wrote(readings.write(folder / "analytic.parquet"))
    for name, figure in drawn.items():
        _wrote(save_figure(figure, folder / f"{name}.png"))
    return AGREES if readings.trusted.all() else DISAGREES


@app.command()
def reconstruct(
    file: Annotated[Path, typer.Argument(help="Readings, Parquet or CSV.")],
    out: Out = None,
    beam: BeamFile = None,
    column: Columns = None,
    noise: Annotated[
        float | None,
        typer.Option(help="Noise of the clamp readings over their largest magnitude, as 0.01."),
    ] = None,
) -> int:
    """Find the object from the clamp readings alone."""
    readings = read_measured(file, beam, tuple(column or ()))
    found = reconstruct_contour(
        readings, None if noise is None else relative_noise(readings, noise)
    )
    picture = reconstruction(readings, found)
    folder = out or Path("results") / f"{file.stem}-reconstructed"
    _make(folder)
    _wrote(write_table(found.assign(foot_x=readings.values("foot_x")), folder / "points.csv"))
    _wrote(save_figure(picture, folder / "reconstruction.png"))
    return AGREES


@app.command()
def simulate(
    case: CaseName,
    out: Out = None,
    stations: Stations = None,
    segments: Segments = None,
    beam: Beam = None,
) -> int:
    """Sweep in MuJoCo."""
    job = _job(case, stations, segments, beam)
    folder = _folder(out, job)
    _wrote(_simulate(job).write(folder / f"mujoco-{job.settings.beam}.parquet"))
    return AGREES


@app.command()
def view(
    case: CaseName, stations: Stations = None, segments: Segments = None, beam: Beam = None
) -> int:
    """Show the sweep in MuJoCo's interactive viewer."""
    from mujoco_models import view_sweep  # MuJoCo is imported only where it is used

    job = _job(case, stations, segments, beam)
    view_sweep(job.case, job.settings)
    return AGREES


@app.command()
def animate(
    case: CaseName,
    out: Out = None,
    frames: Annotated[int, typer.Option(help="Frames of the animation.")] = 60,
    stations: Stations = None,
    segments: Segments = None,
    beam: Beam = None,
) -> int:
    """Sweep in both models, and show it in motion: a GIF and stills."""
    job = _job(case, stations, segments, beam)
    exact, simulated = solve_sweep(job.case), _simulate(job)
    folder = _folder(out, job)
    with _progress("frames", frames) as advance:
        for path in write_animation(exact, simulated, folder, frames, advance):
            _wrote(path)
    return AGREES


@app.command()
def compare(
    reference: Annotated[Path, typer.Argument(help="Readings, Parquet or CSV.")],
    candidate: Annotated[Path, typer.Argument(help="Readings to hold against them.")],
    out: Out = None,
    column: Columns = None,
    beam: BeamFile = None,
    reference_column: Annotated[
        list[str] | None, typer.Option(help="As --column, for the reference.")
    ] = None,
    reference_beam: Annotated[
        Path | None, typer.Option(help="As --beam, for the reference.")
    ] = None,
    offset: Annotated[
        str,
        typer.Option(
            metavar="NUMBER|auto",
            help="By how much the candidate's foot_x exceeds the reference's; auto: estimate it.",
        ),
    ] = "0",
    noise: Annotated[
        str,
        typer.Option(
            metavar="NUMBER|auto",
            help="Noise of the clamp readings over their largest magnitude, as 0.01, by which the "
            "limits are widened; auto: estimate it.",
        ),
    ] = "0",
    tolerances: Annotated[
        Path | None, typer.Option(help="TOML file whose [tolerances] table has the limits.")
    ] = None,
) -> int:
    """Compare two files of readings: of two beams, engines or versions, or of a rig."""
    told = read_measured(reference, reference_beam, tuple(reference_column or ()))
    measured = read_measured(candidate, beam, tuple(column or ()), told.beam)
    comparison = compare_readings(
        told,
        measured,
        None if tolerances is None else read_tolerances(tolerances),
        offset=_number_or_auto("--offset", offset),
        noise=_number_or_auto("--noise", noise),
    )
    folder = out or Path("results") / f"{reference.stem}-{candidate.stem}"
    _make(folder)
    return _finish(comparison, folder)


@app.command()
def budget(
    case: CaseName,
    out: Out = None,
    stations: Stations = None,
    segments: Segments = None,
    beam: Beam = None,
) -> int:
    """Split the disagreement into its parts, each measured by a change of its own."""
    job = _job(case, stations, segments, beam)
    folder = _folder(out, job)
    found = measure_budget(solve_sweep(job.case), _controlled(job), variations(job.case))
    drawn = picture(found)
    _told.print(_budget_table(found, job))
    verdict = "closes" if found.closes else "does not close: more is unexplained than uncertain"
    _told.print(f"The budget {verdict}; the largest part is {found.blame}.", soft_wrap=True)
    for suspect in found.suspects:
        _told.print(
            f"  suspect: {suspect.name} differs by {suspect.change:+.2%} "
            f"(accounts for {suspect.share:.0%} of the unexplained)"
        )
    _wrote(write_text(json.dumps(found.to_dict(), indent=2), folder / "budget.json"))
    _wrote(save_figure(drawn, folder / "budget.png"))
    return AGREES if found.closes else DISAGREES


@app.command()
def cases() -> int:
    """List the named cases."""
    table = Table("case", "object", "foot from", "to")
    for name in CASE_NAMES:
        case = named_case(name)
        first, last = case.foot_x[[0, -1]]
        table.add_row(name, case.profile.label, f"{first:.3f} L", f"{last:.3f} L")
    _told.print(table)
    return AGREES


def main() -> None:
    """Run the command line; bad input is told in one line, without a traceback."""
    try:
        code = app(standalone_mode=False)
    except InputError as error:
        code = _refuse(str(error))
    except _UsageError as error:
        told = cast(Any, error).format_message().replace("\n", " ")
        code = _refuse(f"{told.rstrip('.')}; see `vibrissa --help`")
    except ArithmeticError as error:
        code = _refuse(str(error))
    except (typer.Abort, KeyboardInterrupt):
        code = _refuse("interrupted")
    except OSError as error:
        code = _refuse(f"{error.filename}: {error.strerror}; choose another folder with --out")
    sys.exit(code)


def _refuse(message: str) -> int:
    _noted.print(f"vibrissa: {message}", soft_wrap=True, markup=False)
    return BAD_INPUT


def _job(name: str, stations: int | None, segments: int | None, beam: str | None) -> Job:
    job = load_job(name)
    case, settings = job.case, job.settings
    if stations is not None:
        case = replace(case, sweep=replace(case.sweep, stations=stations))
    if segments is not None:
        settings = replace(settings, segments=segments)
    if beam is not None:
        settings = replace(settings, beam=beam)  # type: ignore[arg-type]  # validated by Settings
    return replace(job, case=case, settings=settings)


def _number_or_auto(option: str, text: str) -> float | Literal["auto"]:
    if text == "auto":
        return "auto"
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise InputError(option, repr(text), "a number or auto", "write it with a decimal point")
    return number


def _folder(out: Path | None, job: Job) -> Path:
    folder = out or Path("results") / job.case.name
    _make(folder)
    return folder


def _make(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError("--out", folder, "a folder that can be made", str(error)) from error


def _simulate(job: Job) -> Readings:
    from mujoco_models import simulate_sweep  # MuJoCo is imported only where it is used

    with _progress(f"MuJoCo {job.settings.beam}", job.case.sweep.stations) as advance:
        return simulate_sweep(job.case, job.settings, advance)


@contextmanager
def _progress(what: str, total: int) -> Iterator[Callable[[], None]]:
    """A bar on a terminal, nothing elsewhere."""
    with Progress(console=_noted, disable=not _noted.is_terminal, transient=True) as bar:
        task = bar.add_task(what, total=total)
        yield lambda: bar.advance(task)


def _controlled(job: Job) -> dict[str, Readings]:
    """The sweeps that a budget needs, one process each on all cores."""
    changes = controlled_changes(job.settings)
    with (
        ProcessPoolExecutor(mp_context=get_context("spawn")) as pool,
        _progress("controlled changes", len(changes)) as advance,
    ):
        # The longest first, so that no core waits for it at the end.
        sweeps = {
            name: pool.submit(sweep_alone, job.case, changed)
            for name, changed in sorted(changes.items(), key=lambda c: -c[1].segments)
        }
        for sweep in sweeps.values():
            sweep.add_done_callback(lambda _: advance())
        return {name: sweep.result() for name, sweep in sweeps.items()}


def sweep_alone(case: Case, settings: Settings) -> Readings:
    """One MuJoCo sweep, in a process of its own."""
    from mujoco_models import simulate_sweep

    return simulate_sweep(case, settings)


def _budget_table(found: Budget, job: Job) -> Table:
    table = Table("part", *CLAMP_READINGS, title=f"Budget of {job.case.name}, rms +- uncertainty")
    for name, readings in found.parts.items():
        cells = [f"{p.rms:.1e} +- {p.uncertainty:.0e}" for p in readings.values()]
        table.add_row(name, *cells)
    table.add_section()
    table.add_row("disagreement", *(f"{x:.1e}" for x in found.disagreement.values()))
    return table


def _finish(comparison: Comparison, folder: Path) -> int:
    report = write_report(comparison, folder)
    _told.print(_summary(comparison))
    for failure in comparison.failures:
        _told.print(f"  {failure}", soft_wrap=True, markup=False)
    if comparison.likely is not None:
        _told.print(f"  likely: {comparison.likely}", soft_wrap=True, markup=False)
    _wrote(report)
    return AGREES if comparison.agrees else DISAGREES


def _summary(comparison: Comparison) -> Table:
    verdict = "[green]agrees[/]" if comparison.agrees else "[red]disagrees[/]"
    table = Table(
        "reading", "rms", "max", "at foot_x", "phase",
        title=f"{comparison.candidate.source} {verdict} with {comparison.reference.source}",
        caption="relative to each reading's largest magnitude",
    )  # fmt: skip
    for name in CLAMP_READINGS:
        d = comparison.disagreement[name]
        table.add_row(name, f"{d.rms:.1e}", f"{d.max:.1e}", f"{d.at:.4g}", d.phase)
    table.add_section()
    shift = comparison.snap_off.difference
    agreement = comparison.phase_agreement()
    table.add_row("snap-off", "", "none" if shift is None else f"{shift:+.1e}", "", "")
    if agreement:
        table.add_row("phases", "", f"{min(agreement.values()):.1%} right", "", "")
    offset = comparison.offset
    if offset.value or offset.uncertainty:
        table.add_row("offset", "", f"{offset.value:+.4g}", f"+- {offset.uncertainty:.1g}", "")
    if any(comparison.noise.level.values()):
        table.add_row("noise", "", f"{max(comparison.noise.level.values()):.1e}", "", "")
    return table


def _wrote(path: Path) -> None:
    _told.print(f"wrote {path}", soft_wrap=True, markup=False)
