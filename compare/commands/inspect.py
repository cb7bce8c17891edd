"""The command ``inspect``: what beam a MuJoCo model is, and what single precision makes of one."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeAlias

import typer

from analytic.problem.errors import InputError
from analytic.problem.files import regular_file
from compare.commands.options import Changes, For, flag, option, out_folder, require_use, words
from compare.commands.output import check_own, output_folder
from compare.read.case import load_case
from compare.read.job import AnyJob, Job
from compare.read.kinds import MODEL, PLANE
from mujoco_models.allowed import CONTACT_STIFFNESSES

if TYPE_CHECKING:
    from compare.simulate.inspection import Inspection

FILE, SINGLE = "a model's own file", "single precision"
_OF_A_FILE, _IN_SINGLE = For((FILE,)), For((SINGLE,))
Name: TypeAlias = str | None


def inspect(
    context: typer.Context,
    model: Annotated[
        str,
        typer.Argument(
            metavar="MODEL",
            help="An MJCF or URDF file, a shipped model, or a case with a [model]; with --float32 "
            "any case at rest in the plane.",
        ),
    ],
    float32: Annotated[
        bool,
        flag(
            "--float32", "Evaluate the states at rest in MuJoCo Warp's or MJX's single precision."
        ),
    ] = False,
    foot: Annotated[Name, option("The body that holds the vibrissa.", "BODY"), _OF_A_FILE] = None,
    force: Annotated[Name, option("The force sensor at its clamp.", "NAME"), _OF_A_FILE] = None,
    torque: Annotated[Name, option("The torque sensor at its clamp.", "NAME"), _OF_A_FILE] = None,
    geoms: Annotated[
        Name, option("The vibrissa's geoms, as 'whisker*,tip'.", "NAMES"), _OF_A_FILE
    ] = None,
    site: Annotated[
        Name, option("A site at its clamp, where sensors are added.", "NAME"), _OF_A_FILE
    ] = None,
    beam: Annotated[
        Path | None,
        option("TOML file whose [beam] is what the model should be.", "FILE"),
        _OF_A_FILE,
    ] = None,
    stations: Annotated[
        int | None, option("Stations of the sweep.", "N", "the case's"), _IN_SINGLE
    ] = None,
    segments: Annotated[
        int | None, option("Segments of MuJoCo's beam.", "N", "the case's"), _IN_SINGLE
    ] = None,
    contact_stiffness: Annotated[
        str, option("What is looked at beside the case's own [EI/L^3].", "A,B,..."), _IN_SINGLE
    ] = "1e4,1e5,1e6,1e7,1e8,1e9",
    write: Annotated[
        Path | None,
        option("Write the model without its faults, and case.toml beside it.", "FILE"),
        _OF_A_FILE,
    ] = None,
    out: Annotated[Path | None, out_folder("none; with --float32 results/CASE-float32")] = None,
) -> bool:
    """Measure what beam a MuJoCo model is and what is wrong.

    With --write: a copy of its file with just these settings, and the case that it is a model of.

    With --float32: where contacts are lost in single precision, and how far off the forces are,
    over the contact stiffness, beside what float32's resolution predicts. Contacts that are lost at
    the case's own stiffness are a disagreement.
    """
    if float32:
        require_use(context, SINGLE)
        changes = Changes(stations=stations, segments=segments)
        job = changes.made(changes.load(model))
        place = changes.folder(out, f"{job.case.name}-float32")
        return _in_single_precision(job, place, contact_stiffness)
    from analytic.problem.named import NAMED_TABLES

    is_case = model in NAMED_TABLES or model.endswith(".toml")
    require_use(context, MODEL if is_case else FILE)
    if is_case:
        inspection = _of_a_case(model)
    else:
        names = {"foot": foot, "force": force, "torque": torque, "geoms": geoms, "site": site}
        inspection = _of_a_file(_path(model), names, beam)
    from compare.commands import terminal

    for line in inspection.lines():
        terminal.print_line(line)
    if write is not None:
        from compare.simulate.fixing import CASE_MARK, case_of, fix

        check_own(write.with_name("case.toml"), CASE_MARK)
        with output_folder(write.parent):
            fixed = fix(_path(model), names, inspection, write)
            for line in fixed.lines():
                terminal.print_line(line)
            text = case_of(fixed.inspection.found, write, names)
            terminal.keep(write.with_name("case.toml"), text)
    if out is not None:
        with output_folder(out) as folder:
            terminal.keep(folder / "inspection.json", inspection.to_dict())
            from compare.simulate.profile import picture

            picture(inspection.found).savefig(folder / "profile.png", dpi=120)
    return inspection.sound


def _path(model: str) -> Path:
    from mujoco_models.user_model.shipped import find_model

    return regular_file(find_model(model), "model", sys.maxsize)


def _of_a_file(path: Path, names: dict[str, str | None], beam: Path | None) -> "Inspection":
    from compare.simulate.inspection import Inspection
    from mujoco_models import inspect_model

    stated = None
    if beam is not None:
        from compare.read.tables import read_beam

        stated = read_beam(beam)[0]
    return Inspection(inspect_model(path, **names), stated)


def _of_a_case(case: str) -> "Inspection":
    job = load_case(case)
    if not isinstance(job, Job) or job.model is None:
        raise InputError("MODEL", case, "a model, or a case with one", "or ask for --float32")
    from compare.simulate.inspection import Inspection, measured_beam

    return Inspection(measured_beam(job.model), job.case.beam)


def _in_single_precision(job: AnyJob, folder: Path, stiffnesses: str) -> bool:
    """Evaluate the states at rest by what is installed for it, over the contact stiffness."""
    if not isinstance(job, Job) or job.kind != PLANE:
        raise InputError("--float32", "given", f"for {PLANE}", f"this is {job.kind}")
    own = float(job.settings.contact_stiffness)
    wanted = sorted({own, *_numbers(stiffnesses)})
    from engines.precision.gate import by_stiffness, evaluators, gate

    there = evaluators()
    with output_folder(folder) as place:
        from compare.commands import terminal
        from compare.show.float32 import losses_table, picture, sentence

        steps = len(wanted) * job.case.sweep.stations
        with terminal.progress("single precision", steps) as advance:
            table = gate(job.case, job.settings, there, wanted, advance)
        found = by_stiffness(table)
        for name, rows in found.groupby("evaluator", sort=False):
            terminal.show(losses_table(str(name), rows, job.case.name))
            terminal.print_line(sentence(str(name), rows))
        for name, rows in (("stations", table), ("float32", found)):
            terminal.keep(place / f"{name}.csv", rows)
        terminal.keep(place / "float32.png", picture(found, job.case.name))
        lost = found.loc[found["contact_stiffness"] == own, "lost"].sum()
        return not lost


def _numbers(text: str) -> list[float]:
    least, largest = CONTACT_STIFFNESSES
    try:
        found = [float(word) for word in words(text)]
    except ValueError:
        found = []
    if not found or not all(least <= one <= largest for one in found):
        allowed = f"numbers between commas, each between {least:g} and {largest:g}"
        raise InputError("--contact-stiffness", repr(text), allowed, "correct it")
    return found
