"""The command ``methods``: every way to find the contact, on the same readings."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from analytic.problem.errors import InputError
from compare.commands.given import require_readings
from compare.commands.options import AGREES, out_folder
from compare.commands.output import output_folder
from compare.read.suffixes import TABLES

if TYPE_CHECKING:
    from analytic import Readings


def methods(
    case: Annotated[
        str, typer.Argument(help="A case, for its closed form, or a model's file of readings.")
    ],
    out: Annotated[Path | None, out_folder("results/CASE-methods")] = None,
    method: Annotated[
        str | None,
        typer.Option(metavar="A,B,...", help="Which methods; all if left out.", show_default=False),
    ] = None,
    noise: Annotated[
        str, typer.Option(metavar="A,B,...", help="Noise over each reading's largest magnitude.")
    ] = "0,0.001,0.01",
    on: Annotated[
        str,
        typer.Option(
            metavar="A,B,...",
            help="Readings of what, while the methods take it for a straight vibrissa in a rigid "
            "clamp without friction: exact, curved, tapered, soft-clamp, friction, mujoco; or all.",
        ),
    ] = "exact",
) -> int:
    """How well every method finds the contact from the clamp."""
    levels = _levels(noise)
    if Path(case).suffix.lower() in TABLES:
        require_readings([Path(case)])
    else:
        from compare.read.case import load_job

        load_job(case)
    from analytic.from_clamp.earlier.methods import NAMES
    from compare.commands import terminal
    from compare.measure.methods import INFORMED, KNOWN, method_errors

    names = NAMES if method is None else [word.strip() for word in method.split(",")]
    for one in names:
        if one not in NAMES:
            raise InputError("--method", repr(one), f"of {', '.join(NAMES)}", "correct it")
    asked = [word.strip() for word in on.split(",")]
    with output_folder(_folder(out, case)) as folder:
        import pandas as pd

        from analytic.problem.files import write_whole
        from compare.show.figures.methods import picture, side_by_side
        from compare.show.page import save_figure

        tables = []
        for which, truth, believed, name in _truths(case, asked, folder):
            found = method_errors(believed, names, levels)
            unlike = believed.beam != truth.beam or believed.provenance != truth.provenance
            if unlike:
                knowing = method_errors(truth, ["elastica"], levels)
                knowing = knowing.assign(method=INFORMED, needs=knowing["needs"] + KNOWN)
                found = pd.concat([found, knowing], ignore_index=True)
            found.insert(0, "readings", which)
            found.insert(0, "case", name)
            tables.append(found)
            terminal.print_methods(found, f"{name} ({which if len(asked) > 1 else truth.source})")
        every = pd.concat(tables, ignore_index=True)
        terminal.print_written(write_whole(folder / "methods.csv", every.to_csv(index=False)))
        title = f"{name} ({truth.source})" if len(tables) == 1 else name
        drawn = picture(tables[0], title) if len(tables) == 1 else side_by_side(every, title)
        terminal.print_written(save_figure(drawn, folder / "methods.png"))
    return AGREES


def _folder(out: Path | None, case: str) -> Path:
    name = Path(case).stem if Path(case).suffix else case
    return out or Path("results") / f"{name}-methods"


def _truths(
    case: str, asked: list[str], folder: Path
) -> Iterator["tuple[str, Readings, Readings, str]"]:
    """Readings with their true contacts, what of, as the methods get them, and whose case."""
    from analytic import Readings, solve_sweep
    from compare.measure.conditions import CONDITIONS, SIMULATED, as_believed, chosen_conditions

    path = Path(case)
    if path.suffix.lower() in TABLES:
        if asked != ["exact"]:
            raise InputError("--on", ", ".join(asked), "left out beside a file", "name a case")
        truth = Readings.read(path)
        yield "exact", truth, truth, path.stem
        return
    from compare.commands.engines import simulated
    from compare.read.case import load_job

    conditions = chosen_conditions(asked)
    job = load_job(case)
    job.case.require_plain("the table of methods")
    for name in conditions:
        if name == SIMULATED:
            truth = simulated(job, folder)
        else:
            truth = solve_sweep(CONDITIONS[name].true(job.case))
        yield name, truth, as_believed(truth, job.case), job.case.name


def _levels(text: str) -> list[float]:
    try:
        levels = [float(word) for word in text.split(",")]
    except ValueError:
        levels = []
    if not levels or len(levels) > 3 or not all(0 <= level < 1 for level in levels):
        raise InputError(
            "--noise", repr(text), "one to three numbers from 0 up to 1", "as 0,0.001,0.01"
        )
    return levels
