"""The command ``vibrissa``."""

import math
import os
import sys
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, Literal, cast

import typer
from rich.table import Table

from analytic import (
    CASE_NAMES,
    InputError,
    Readings,
    named_case,
    relative_noise,
    solve_sweep,
)
from analytic import reconstruct as reconstruct_contour
from analytic.problem.files import write_whole
from compare.commands.study import study, study_report
from compare.commands.terminal import (
    NOTED,
    TOLD,
    progress,
    side_by_side_tables,
    tell_advice,
    tell_budget,
    tell_comparison,
    tell_written,
)
from compare.comparison import Comparison
from compare.comparison import compare as compare_readings
from compare.explain.advice import check_target
from compare.explain.budget import Budget
from compare.explain.changes import controlled_changes
from compare.read.case import Job, load_job
from compare.read.limits import read_tolerances
from compare.read.rig import read_measured
from compare.show.animation import write_animation
from compare.show.figures.geometry import reconstruction
from compare.show.figures.paper import paper_figures
from compare.show.findings import write_findings
from compare.show.page import document, save_figure
from compare.show.report import Film, budget_files, write_report
from compare.show.side_by_side import picture as side_by_side_picture
from compare.show.side_by_side import side_by_side as set_side_by_side
from compare.simulate.controlled import measure_budget
from compare.simulate.target import follow_advice

# Any wrong word on the command line; typer may bring its own copy of click, whose base this is.
_UsageError: type[Exception] = typer.BadParameter.__bases__[0]
AGREES, DISAGREES, BAD_INPUT = 0, 1, 2
_FRAMES = 48  # of a report's animation: smooth enough, and under 2 MB

app = typer.Typer(
    add_completion=False,
    no_args_is_help=True,
    help="A vibrissa swept past a convex object: the exact elastica against MuJoCo.",
    pretty_exceptions_enable=False,
)
app.command()(study)
app.command()(study_report)

CaseName = Annotated[
    str, typer.Argument(metavar="CASE", help="A named case (see `vibrissa cases`) or a TOML file.")
]
Out = Annotated[
    Path | None, typer.Option("--out", metavar="DIR", help="Folder for what is written.")
]
Stations = Annotated[int | None, typer.Option(help="Stations of the sweep, instead of the case's.")]
Segments = Annotated[int | None, typer.Option(help="Segments of MuJoCo's beam.")]
Beam = Annotated[str | None, typer.Option(help="MuJoCo's beam.")]
Obstacle = Annotated[str | None, typer.Option(help="MuJoCo's obstacle, mesh or primitive.")]
Spatial = Annotated[
    bool, typer.Option("--spatial", help="Let MuJoCo's beam leave the plane of the sweep.")
]
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
    with_budget: Annotated[
        bool, typer.Option("--budget", help="Split the disagreement into its parts too.")
    ] = False,
    obstacle: Obstacle = None,
    spatial: Spatial = False,
) -> int:
    """Sweep in both models, compare, and write the report."""
    job = _job(case, stations, segments, beam, obstacle, spatial)
    folder = _folder(out, job)
    exact = solve_sweep(job.case)
    found = None
    if with_budget:
        found, runs = _measure_budget(job)
        simulated = runs["base"]
    else:
        simulated = _simulate(job, folder)
    comparison = compare_readings(exact, simulated, job.tolerances)
    exact.write(folder / "analytic.parquet")
    simulated.write(folder / f"mujoco-{job.settings.beam}.parquet")
    if found is not None:
        tell_budget(found, job.case.name)
    with progress("frames", _FRAMES) as advance:
        gif, *stills = write_animation(exact, simulated, folder, _FRAMES, advance)
    return _finish(comparison, folder, found, Film(gif, stills[2]))


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
    job = _job(case, stations)
    folder = _folder(out, job)
    readings = solve_sweep(job.case, certified)
    drawn = paper_figures(job.case, readings) if figures else {}
    tell_written(readings.write(folder / "analytic.parquet"))
    for name, figure in drawn.items():
        tell_written(save_figure(figure, folder / f"{name}.png"))
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
    points = found.assign(foot_x=readings.values("foot_x"))
    tell_written(write_whole(folder / "points.csv", points.to_csv(index=False)))
    tell_written(save_figure(picture, folder / "reconstruction.png"))
    return AGREES


@app.command()
def simulate(
    case: CaseName,
    out: Out = None,
    stations: Stations = None,
    segments: Segments = None,
    beam: Beam = None,
    obstacle: Obstacle = None,
    spatial: Spatial = False,
) -> int:
    """Sweep in MuJoCo."""
    job = _job(case, stations, segments, beam, obstacle, spatial)
    folder = _folder(out, job)
    tell_written(_simulate(job, folder).write(folder / f"mujoco-{job.settings.beam}.parquet"))
    return AGREES


@app.command()
def view(
    case: CaseName,
    stations: Stations = None,
    segments: Segments = None,
    beam: Beam = None,
    obstacle: Obstacle = None,
) -> int:
    """Show the sweep in MuJoCo's interactive viewer."""
    from mujoco_models import view_sweep  # MuJoCo is imported only where it is used

    job = _job(case, stations, segments, beam, obstacle)
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
    obstacle: Obstacle = None,
) -> int:
    """Sweep in both models, and show it in motion: a GIF and stills."""
    job = _job(case, stations, segments, beam, obstacle)
    folder = _folder(out, job)
    exact, simulated = solve_sweep(job.case), _simulate(job, folder)
    with progress("frames", frames) as advance:
        for path in write_animation(exact, simulated, folder, frames, advance):
            tell_written(path)
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
def side_by_side(
    reference: Annotated[
        str, typer.Argument(help="A case, for its closed form, or a file of readings.")
    ],
    files: Annotated[list[Path], typer.Argument(help="Readings to hold against it.")],
    out: Out = None,
) -> int:
    """Compare any number of files of readings with one reference and with each other."""
    is_file = Path(reference).suffix in (".parquet", ".csv")
    exact = Readings.read(reference) if is_file else solve_sweep(load_job(reference).case)
    candidates = {_short(path, files): Readings.read(path) for path in files}
    if len(candidates) < len(files):
        raise InputError(
            "FILE",
            ", ".join(map(str, files)),
            "files of different names",
            "rename one, or name it once",
        )
    found = set_side_by_side(exact, candidates)
    drawn = side_by_side_picture(found)
    folder = out or Path("results") / "side-by-side"
    _make(folder)
    for table in side_by_side_tables(found)[: len(files)]:
        TOLD.print(table)
    tell_written(write_whole(folder / "side-by-side.json", document(found.to_dict())))
    tell_written(save_figure(drawn, folder / "side-by-side.png"))
    return AGREES if all(one.agrees for one in found.against.values()) else DISAGREES


@app.command()
def budget(
    case: CaseName,
    out: Out = None,
    target: Annotated[
        float | None,
        typer.Option(help="Find the cheapest settings with an rms of at most this, as 1e-3."),
    ] = None,
    stations: Stations = None,
    segments: Segments = None,
    beam: Beam = None,
    obstacle: Obstacle = None,
) -> int:
    """Split the disagreement into its parts, each measured by a change of its own."""
    if target is not None:
        check_target(target)
    job = _job(case, stations, segments, beam, obstacle)
    folder = _folder(out, job)
    found, runs = _measure_budget(job)
    advice = None if target is None else follow_advice(job.case, found, runs, target)
    contents = budget_files(found, None if advice is None else advice.to_dict())
    tell_budget(found, job.case.name)
    if advice is not None:
        tell_advice(advice)
    for name, content in contents.items():
        tell_written(write_whole(folder / name, content))
    return AGREES if found.closes and (advice is None or advice.reached) else DISAGREES


@app.command()
def findings(
    folder: Annotated[
        Path, typer.Argument(metavar="DIR", help="Folder with the folders of runs in it.")
    ],
    out: Out = None,
) -> int:
    """Write a page about all runs in a folder, there or elsewhere."""
    for path in write_findings(folder, out or folder):
        tell_written(path)
    return AGREES


@app.command()
def cases() -> int:
    """List the named cases."""
    table = Table("case", "object", "foot from", "to")
    for name in CASE_NAMES:
        case = named_case(name)
        first, last = case.foot_x[[0, -1]]
        table.add_row(name, case.profile.label, f"{first:.3f} L", f"{last:.3f} L")
    TOLD.print(table)
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
    except MemoryError as error:
        code = _refuse(f"out of memory ({error}); take fewer segments or contour points")
    except (typer.Abort, KeyboardInterrupt):
        code = _refuse("interrupted")
    except OSError as error:
        code = _refuse(f"{error.filename}: {error.strerror}; choose another folder with --out")
    sys.exit(code)


def _refuse(message: str) -> int:
    NOTED.print(f"vibrissa: {message}", soft_wrap=True, markup=False)
    return BAD_INPUT


def _job(
    name: str,
    stations: int | None,
    segments: int | None = None,
    beam: str | None = None,
    obstacle: str | None = None,
    spatial: bool = False,
) -> Job:
    job = load_job(name)
    case = job.case
    if stations is not None:
        case = replace(case, sweep=replace(case.sweep, stations=stations))
    given: dict[str, Any] = {"segments": segments, "beam": beam, "obstacle": obstacle}
    changes = {name: value for name, value in given.items() if value is not None}
    if spatial:
        changes["planar"] = False
    return replace(job, case=case, settings=replace(job.settings, **changes))


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


def _simulate(job: Job, folder: Path) -> Readings:
    """The sweep in MuJoCo; if it ends early, the stations that there are go into `folder`."""
    from mujoco_models import simulate_sweep  # MuJoCo is imported only where it is used

    def keep(partial: Readings) -> None:
        path = partial.write(folder / f"mujoco-{job.settings.beam}.partial.parquet")
        stations = f"{len(partial.table)} of {job.case.sweep.stations} stations"
        NOTED.print(f"vibrissa: kept {stations} in {path}", soft_wrap=True, markup=False)

    with progress(f"MuJoCo {job.settings.beam}", job.case.sweep.stations) as advance:
        return simulate_sweep(job.case, job.settings, advance, keep)


def _measure_budget(job: Job) -> tuple[Budget, dict[str, Readings]]:
    changes = len(set(controlled_changes(job.settings).values()))
    with progress("controlled changes", changes) as advance:
        return measure_budget(job.case, job.settings, advance)


def _short(path: Path, files: list[Path]) -> str:
    """What tells a file from the others."""
    common = os.path.commonpath([one.absolute().parent for one in files])
    return str(path.absolute().with_suffix("").relative_to(common))


def _finish(
    comparison: Comparison, folder: Path, budget: Budget | None = None, film: Film | None = None
) -> int:
    report = write_report(comparison, folder, budget, film)
    tell_comparison(comparison)
    tell_written(report)
    return AGREES if comparison.agrees else DISAGREES
