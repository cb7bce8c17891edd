"""The command ``float32``: what single precision makes of MuJoCo's states at rest."""

from typing import Annotated

import typer

from analytic.problem.errors import InputError
from compare.commands.options import (
    AGREES,
    DISAGREES,
    CaseName,
    Changes,
    Out,
    Segments,
    Stations,
)
from compare.commands.output import output_folder
from mujoco_models.allowed import CONTACT_STIFFNESSES

_WARP = "mujoco-warp>=4.0,<5"


def float32(
    case: CaseName,
    out: Out = None,
    stations: Stations = None,
    segments: Segments = None,
    stiffnesses: Annotated[
        str,
        typer.Option(
            "--contact-stiffness",
            metavar="A,B,...",
            help="What is looked at beside the case's own [EI/L^3].",
        ),
    ] = "1e4,1e5,1e6,1e7,1e8,1e9",
) -> int:
    """Evaluate MuJoCo's states at rest in MuJoCo Warp, in single precision.

    Reports where contacts are lost and how far off the forces are, over the contact stiffness, and
    beside them what float32's resolution predicts. Contacts that are lost at the case's own contact
    stiffness are a disagreement.
    """
    job = Changes(stations=stations, segments=segments).job_at_rest(case, "float32")
    own = float(job.settings.contact_stiffness)
    wanted = sorted({own, *_numbers(stiffnesses)})
    from engines.found import installed

    version, trouble = installed(_WARP)
    if trouble is not None:
        raise InputError("mujoco-warp", version or "missing", _WARP, trouble)
    folder = Changes(stations=stations, segments=segments).folder(out, f"{job.case.name}-float32")
    with output_folder(folder) as place:
        from analytic.problem.files import write_whole
        from compare.commands import terminal
        from compare.show.float32 import picture, sentence
        from compare.show.page import save_figure
        from engines.warp.gate import by_stiffness, gate

        steps = len(wanted) * job.case.sweep.stations
        with terminal.progress("single precision", steps) as advance:
            table = gate(job.case, job.settings, wanted, advance)
        found = by_stiffness(table)
        terminal.print_float32(found, job.case.name)
        terminal.print_line(sentence(found, version or ""))
        for name, rows in (("stations", table), ("float32", found)):
            path = write_whole(place / f"{name}.csv", rows.to_csv(index=False))
            terminal.print_written(path)
        terminal.print_written(save_figure(picture(found, job.case.name), place / "float32.png"))
        lost = found.loc[found["contact_stiffness"] == own, "lost"].sum()
        return DISAGREES if lost else AGREES


def _numbers(words: str) -> list[float]:
    least, largest = CONTACT_STIFFNESSES
    try:
        found = [float(word) for word in words.split(",")]
    except ValueError:
        found = []
    if not found or not all(least <= one <= largest for one in found):
        raise InputError(
            "--contact-stiffness",
            repr(words),
            f"numbers between commas, each between {least:g} and {largest:g}",
            "correct it",
        )
    return found
