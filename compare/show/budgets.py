"""What a disagreement is made of, in tables and sentences."""

from collections.abc import Iterator, Mapping, Sequence

from analytic import CLAMP_READINGS, PHASES
from compare.explain.budget import Budget
from compare.explain.motion import MotionBudget
from compare.explain.parts import Parted
from compare.explain.suspects import Suspect
from compare.show.document import Block, Items, Table, Text
from compare.show.numbers import percent, short, words
from compare.show.style import PHASE_LETTERS

_RMS = "relative to each reading's largest magnitude"


def left_over(found: Parted) -> str:
    return f"{short(found.left.rms)} +- {short(found.left.uncertainty)}"


def headline(found: Parted) -> str:
    """What a budget comes to, in one sentence."""
    rest = left_over(found)
    if found.closes:
        remains = f"at most {rest} stays unexplained, and the budget closes"
    elif found.undecided:
        remains = f"the budget is undecided: {rest} stays unexplained"
    else:
        remains = f"{rest} stays unexplained, too much for the budget to close"
    return f"The largest part is {found.blame}; {remains}"


def budget_summary(found: Parted) -> Iterator[Block]:
    """The parts, what they come to, and the suspects."""
    yield _parts_table(found)
    yield Text("", strong=f"{headline(found)}.")
    if isinstance(found, Budget) and found.suspects:
        yield Items([_suspect(one) for one in found.suspects])
    if isinstance(found, MotionBudget):
        yield Text(f"Observed order in the speed, of three speeds: {found.order:.2f}.")
        if found.left_out:
            yield Text(f"Diverged, and left out: {', '.join(found.left_out)}.")


def _parts_table(found: Parted) -> Table:
    """The parts with their uncertainties, the whole, and what the closed form says of some."""
    rows: list[Sequence[str]] = [
        (name, *(f"{short(one.rms)} ± {short(one.uncertainty)}" for one in parts.values()))
        for name, parts in found.parts.items()
    ]
    rows.append(("disagreement", *map(short, found.disagreement.values())))
    checks = found.checks if isinstance(found, Budget) else {}
    for name, sizes in checks.items():
        rows.append((f"{name}, closed form alone", *map(short, sizes.values())))
    near = " (next to the snap-off, too)" if isinstance(found, Budget) else ""
    return Table(
        f"Root mean square and uncertainty over {found.stations} stations{near}, {_RMS}",
        ("part", *found.disagreement),
        rows,
        blamed=[i for i, name in enumerate(found.parts) if name == found.blame],
        whole=[len(found.parts)],
    )


def phases_table(found: Budget) -> Table:
    there = {p for sizes in found.by_phase.values() for by in sizes.values() for p in by}
    phases = [phase for phase in PHASES if phase in there]
    return Table(
        "The same in each phase (A: tip contact, B: tangential contact), root mean square",
        ("part", *(f"{r}, {PHASE_LETTERS[p]}" for r in CLAMP_READINGS for p in phases)),
        [
            (name, *(short(sizes[r].get(p)) for r in CLAMP_READINGS for p in phases))
            for name, sizes in found.by_phase.items()
        ],
        blamed=[i for i, name in enumerate(found.by_phase) if name == found.blame],
    )


def convergence_table(found: Mapping[int, Mapping[str, float]]) -> Table:
    return Table(
        f"Root mean square, {_RMS}",
        ("segments", *CLAMP_READINGS),
        [(str(n), *(short(rms[r]) for r in CLAMP_READINGS)) for n, rms in found.items()],
    )


def _suspect(one: Suspect) -> str:
    found = f"Suspect: {words(one.name)}, {one.size} in the candidate"
    return f"{found}, accounts for {percent(one.share)} of the unexplained."
