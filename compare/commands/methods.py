"""The command ``methods``: every way to find the contact, on the same readings."""

from pathlib import Path
from typing import Annotated

import typer

from analytic.problem.errors import InputError
from compare.commands.options import AGREES, out_folder
from compare.commands.output import output_folder
from compare.read.suffixes import TABLES


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
) -> int:
    """How well every method finds the contact from the clamp."""
    from analytic import Readings, solve_sweep
    from analytic.from_clamp.earlier.methods import NAMES
    from compare.commands import terminal
    from compare.measure.methods import method_errors

    path = Path(case)
    if path.suffix.lower() in TABLES:
        truth, name = Readings.read(path), path.stem
    else:
        from compare.read.case import load_job

        job = load_job(case)
        truth, name = solve_sweep(job.case), job.case.name
    names = NAMES if method is None else [word.strip() for word in method.split(",")]
    found = method_errors(truth, names, _levels(noise))
    with output_folder(out or Path("results") / f"{name}-methods") as folder:
        from analytic.problem.files import write_whole
        from compare.show.figures.methods import picture
        from compare.show.page import save_figure

        table = write_whole(folder / "methods.csv", found.to_csv(index=False))
        terminal.print_methods(found, f"{name} ({truth.source})")
        terminal.print_written(table)
        drawn = picture(found, f"{name} ({truth.source})")
        terminal.print_written(save_figure(drawn, folder / "methods.png"))
    return AGREES


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
