"""What single precision makes of MuJoCo's states at rest: ``inspect --float32``."""

from pathlib import Path

from analytic.problem.errors import InputError
from compare.commands.options import AGREES, DISAGREES, words
from compare.commands.output import output_folder
from compare.read.job import Job, SpaceJob
from compare.read.kinds import PLANE
from mujoco_models.allowed import CONTACT_STIFFNESSES


def evaluate(job: Job | SpaceJob, folder: Path, stiffnesses: str) -> int:
    """Evaluate the states by what is installed for it, over the contact stiffness."""
    if not isinstance(job, Job) or job.kind != PLANE:
        raise InputError("--float32", "given", f"for {PLANE}", f"this is {job.kind}")
    own = float(job.settings.contact_stiffness)
    wanted = sorted({own, *_numbers(stiffnesses)})
    from engines.precision.evaluators import evaluators

    there = evaluators()
    with output_folder(folder) as place:
        from compare.commands import terminal
        from compare.show.float32 import losses_table, picture, sentence
        from engines.precision.gate import by_stiffness, gate

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
        return DISAGREES if lost else AGREES


def _numbers(text: str) -> list[float]:
    least, largest = CONTACT_STIFFNESSES
    try:
        found = [float(word) for word in words(text)]
    except ValueError:
        found = []
    if not found or not all(least <= one <= largest for one in found):
        raise InputError(
            "--contact-stiffness",
            repr(text),
            f"numbers between commas, each between {least:g} and {largest:g}",
            "correct it",
        )
    return found
