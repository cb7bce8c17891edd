"""How well every method finds the contact, on the same readings: ``reconstruct CASE``."""

from collections.abc import Iterator
from pathlib import Path

import pandas as pd

from analytic import Readings, solve_sweep
from analytic.from_clamp.earlier.methods import NAMES
from analytic.problem.errors import InputError
from compare.commands import terminal
from compare.commands.output import output_folder
from compare.commands.sweeping import sweep_file
from compare.measure.conditions import CONDITIONS, SIMULATED, as_believed, chosen_conditions
from compare.measure.methods import INFORMED, KNOWN, method_errors
from compare.read.job import Job
from compare.show.document import Table
from compare.show.figures.methods import picture
from compare.show.numbers import short
from compare.show.style import PHASE_LETTERS
from mujoco_models import simulate_sweep


def compare_methods(
    source: Job | Path,
    out: Path | None,
    methods: list[str] | None,
    levels: list[float],
    on: list[str],
) -> None:
    """Write the errors of methods under noise, on readings whose contacts are known."""
    names = methods or list(NAMES)
    for one in names:
        if one not in NAMES:
            raise InputError("--method", repr(one), f"of {', '.join(NAMES)}", "correct it")
    called = source.stem if isinstance(source, Path) else source.case.name
    with output_folder(out or Path("results") / f"{called}-methods") as folder:
        tables = []
        for which, truth, believed in _truths(source, on, folder):
            found = method_errors(believed, names, levels)
            unlike = believed.beam != truth.beam or believed.provenance != truth.provenance
            if unlike:
                knowing = method_errors(truth, ["elastica"], levels)
                knowing = knowing.assign(method=INFORMED, needs=knowing["needs"] + KNOWN)
                found = pd.concat([found, knowing], ignore_index=True)
            found.insert(0, "readings", which)
            found.insert(0, "case", called)
            tables.append(found)
            print_methods(found, f"{called} ({which if len(on) > 1 else truth.source})")
        every = pd.concat(tables, ignore_index=True)
        terminal.keep(folder / "methods.csv", every)
        title = f"{called} ({truth.source})" if len(tables) == 1 else called
        terminal.keep(folder / "methods.png", picture(every, title))


def _truths(
    source: Job | Path, on: list[str], folder: Path
) -> Iterator[tuple[str, Readings, Readings]]:
    """Readings with their true contacts, what of, and as the methods get them."""
    if isinstance(source, Path):
        truth = Readings.read(source)
        yield "exact", truth, truth
        return
    conditions = chosen_conditions(on)
    source.case.require_plain("the table of methods")
    for name in conditions:
        if name == SIMULATED:
            with terminal.progress("MuJoCo", source.stations) as advance:
                truth = simulate_sweep(source.case, source.settings, advance)
            truth.write(folder / sweep_file(source))
        else:
            truth = solve_sweep(CONDITIONS[name].true(source.case))
        yield name, truth, as_believed(truth, source.case)


def print_methods(found: pd.DataFrame, title: str) -> None:
    """Print each method's median error by noise, and how many contacts it has an answer for."""
    levels = sorted(found["noise"].unique())
    heads = (f"noise {level:g}" if level else "no noise" for level in levels)
    rows = []
    for method, of_method in found.groupby("method", sort=False):
        name = str(method)
        for phase, by_noise in of_method.groupby("phase", sort=False):
            by = by_noise.set_index("noise")
            if not by["contacts"][levels[0]]:
                continue
            rate = f"{1 / by['seconds'].median():.0f}" if name and by["seconds"].min() > 0 else ""
            share = f"{by['answered'][levels[0]]:.0%}"
            medians = (short(by["median"][level]) for level in levels)
            rows.append((name, PHASE_LETTERS[str(phase)], share, *medians, rate))
            name = ""
    head = ("method", "phase", "answers", *heads, "contacts per s")
    terminal.show(Table(f"Median error of the contact, over L: {title}", head, rows, words=(0, 1)))
