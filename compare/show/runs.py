"""One page about all runs in a folder, every word of it from measured numbers."""

import math
from collections.abc import Iterator, Sequence
from itertools import groupby
from pathlib import Path

from analytic import CLAMP_READINGS, InputError
from compare.explain.budget import Budget
from compare.explain.parts import UNRESOLVED, Parted
from compare.read.runs import EnginesRecord, RunRecord, read_engines, read_runs
from compare.show.budgets import left_over
from compare.show.document import Block, Document, Image, Items, Table, Text, Verdict, sections
from compare.show.numbers import percent, short
from compare.show.side_by_side import outcomes_table, parts_table, reasons


def runs_document(folder: Path) -> Document:
    runs, engines = read_runs(folder), read_engines(folder)
    if not runs and not engines:
        allowed = "the folder of a run or a study, or a folder with runs in it"
        remedy = "make one: vibrissa run CASE --budget --out DIR/CASE"
        raise InputError("DIR", folder, allowed, remedy)
    agree = [run.agrees for run in runs]
    agree += [engine.agrees for one in engines for engine in one.engines]
    by_case = enumerate(groupby(runs, key=lambda run: run.case), 1)
    return Document(
        "Findings",
        f"{len(runs) + len(engines)} runs in the folder {folder.resolve().name}.",
        Verdict(
            all(agree),
            f"{sum(agree)} of {len(agree)} sweeps agree with the closed form.",
            " ".join(_overview(runs)),
        ),
        sections(
            ("runs", "Runs", _runs(runs)),
            *((f"case-{number}", case, _case([*of])) for number, (case, of) in by_case),
            ("engines", "Engines", _engines(engines)),
            ("made", "Made with", [Items([*dict.fromkeys(run.engine for run in runs)])]),
        ),
    )


def _overview(runs: Sequence[RunRecord]) -> Iterator[str]:
    """The worst of all runs, and how many budgets close."""
    compared = [run for run in runs if run.worst[0] < math.inf]
    if compared:
        run = max(compared, key=lambda run: run.worst[0])
        error, name = run.worst
        where = f"{name}, {run.case}, {run.beam}"
        yield f"The largest rms is {short(error)} of the largest magnitude ({where})."
    budgets = [run.budget for run in runs if run.budget is not None]
    if budgets:
        most = left_over(max(budgets, key=lambda one: one.left.rms))
        closed = f"{sum(one.closes for one in budgets)} of {len(budgets)} budgets close"
        yield f"{closed}; at most {most} is unexplained."


def _runs(runs: Sequence[RunRecord]) -> Iterator[Block]:
    if not runs:
        return
    components = dict.fromkeys(CLAMP_READINGS)
    components |= dict.fromkeys(name for run in runs for name in run.rms)
    rows = [
        (
            run.case,
            run.beam,
            str(run.settings.get("segments", "?")),
            *(short(run.rms[name]) if name in run.rms else "" for name in components),
            short(run.snap_off, " rad" if run.running == "clamp_angle" else ""),
            "none" if run.phases_right is None else percent(run.phases_right),
            *_largest_and_left(run.budget),
            "" if run.seconds_a_station is None else f"{1e3 * run.seconds_a_station:.2g}",
        )
        for run in runs
    ]
    head = (
        "case", "beam", "segments", *components, "snap-off apart / L", "phases right",
        "largest part", "unexplained", "ms a station",
    )  # fmt: skip
    yield Table("Each run against its closed form", head, rows, words=(0, 1, len(head) - 3))
    yield Text(
        "Disagreements are rms over the stations in contact, of each reading's largest magnitude. "
        "A budget closes if what is unexplained is small and within its uncertainty (and "
        f"{short(UNRESOLVED)}).",
        aside=True,
    )


def _case(runs: Sequence[RunRecord]) -> Iterator[Block]:
    yield Text(f"{runs[0].profile}.")
    for run in runs:
        if run.budget is not None:
            shows = f"Budget of the {run.beam}: {run.budget.blame} is the largest part"
            caption = f"{run.beam}, {run.settings.get('segments', '?')} segments, {run.engine}"
            yield Image(run.folder / "budget.png", shows, caption)


def _largest_and_left(budget: Parted | None) -> tuple[str, str]:
    if budget is None:
        return "not measured", "not measured"
    said = budget.blame
    if budget.blame == "discretisation":
        said += f" of order {budget.order:.2f}"
    suspects = budget.suspects if isinstance(budget, Budget) else ()
    said += "".join(f", suspect: {one.name} {one.size} off" for one in suspects[:1])
    if not budget.closes:
        said += "; undecided" if budget.undecided else "; does not close"
    return said, left_over(budget)


def _engines(records: Sequence[EnginesRecord]) -> Iterator[Block]:
    if not records:
        return
    splits = {one.case: one.split for one in records if one.split is not None}
    yield Items([f"{case}: {found.sentence}" for case, found in splits.items()])
    yield outcomes_table({one.case: one.engines for one in records})
    yield from reasons(engine for one in records for engine in one.engines)
    if splits:
        yield parts_table({case: found.parts() for case, found in splits.items()})
    yield Text(
        "What is implementation, engine against twin, and what is model, twin against the closed "
        "form; another model's own disagreement stands beside it.",
        aside=True,
    )
