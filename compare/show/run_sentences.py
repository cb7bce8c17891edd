"""What was found, in words: every sentence follows from the numbers by a rule."""

import math
from collections.abc import Callable, Mapping, Sequence

from compare.explain.budget import UNRESOLVED, Budget
from compare.explain.split import ROUNDING
from compare.read.runs import EnginesRecord, RunRecord
from compare.show.numbers import short


def overview(runs: Sequence[RunRecord]) -> str:
    """All runs in a paragraph."""
    worst = max(runs, key=lambda run: run.error)
    largest = (
        f"No station could be compared in {_case_and_beam(worst)}."
        if math.isinf(worst.error)
        else f"The largest rms is {short(worst.error)} of the largest magnitude "
        f"({worst.worst}, {_case_and_beam(worst)})."
    )
    said = [f"{_agreeing(runs, _case_and_beam)} {largest}"]
    with_budget = [run for run in runs if run.budget is not None]
    if with_budget:
        said.append(_closure(with_budget, _case_and_beam))
        said.append(_allowance(with_budget))
    return " ".join(said)


def sentences(runs: Sequence[RunRecord]) -> str:
    """The runs of one case, in two to four sentences."""
    said = [f"{_agreeing(runs, _beam)} {_ranking(runs)}"]
    with_budget = [run for run in runs if run.budget is not None]
    if with_budget:
        said += [_blame(with_budget), _closure(with_budget, _beam)]
    said.append(_events(runs))
    return " ".join(said)


def split_overview(records: Sequence[EnginesRecord]) -> str:
    """What of the disagreements is implementation, and what is the model, over all cases."""
    splits = [(one.case, one.split) for one in records if one.split is not None]
    if not splits:
        return ""
    apart = {case: _worst(split.implementation) for case, split in splits}
    model = max(_worst(split.model) for _, split in splits)
    subject, twin = splits[0][1].subject, splits[0][1].twin
    faulty = [case for case, worst in apart.items() if worst > ROUNDING]
    largest = short(max(apart.values()))
    if not faulty:
        said = (
            f"{subject} computes its model right: it and its twin {twin} are at most {largest} "
            f"apart. The model is the rod to {short(model)}."
        )
    else:
        said = (
            f"{subject} and its twin {twin} are up to {largest} apart, above rounding in "
            f"{', '.join(faulty)}; the twin's model is the rod to {short(model)}."
        )
    others = {
        name: max(_worst(split.others[name]) for _, split in splits if name in split.others)
        for name in dict.fromkeys(name for _, split in splits for name in split.others)
    }
    return " ".join(
        [said, *(f"{name}'s is it to {short(worst)}." for name, worst in others.items())]
    )


def _agreeing(runs: Sequence[RunRecord], named: Callable[[RunRecord], str]) -> str:
    failing = [run for run in runs if not run.agrees]
    n, fulfilled = len(runs), "with the closed form within the tolerances"
    if n == 1:
        how = "does not agree" if failing else "agrees"
        return f"The {runs[0].beam} {how} {fulfilled}."
    if not failing:
        return f"{'Both' if n == 2 else f'All {n}'} sweeps agree {fulfilled}."
    if len(failing) == n:
        return f"{'Neither' if n == 2 else f'None of the {n} sweeps'} agrees {fulfilled}."
    exceptions = "; ".join(named(run) for run in failing)
    return f"{n - len(failing)} of {n} sweeps agree {fulfilled}, all but: {exceptions}."


def _ranking(runs: Sequence[RunRecord]) -> str:
    ordered = sorted(runs, key=lambda run: run.error)
    best, last = ordered[0], ordered[-1]
    if math.isinf(best.error):
        return "No station could be compared."
    size = f"{short(best.rms[best.worst])} rms in {best.worst}"
    if len(runs) == 1:
        return f"Its worst reading is off by {size}."
    return (
        f"The {best.beam} is the closest ({size}, its worst reading), "
        f"the {last.beam} the farthest ({short(last.rms[last.worst])} in {last.worst})."
    )


def _blame(runs: Sequence[RunRecord]) -> str:
    parts: dict[str, list[RunRecord]] = {}
    for run in runs:
        parts.setdefault(_budget(run).blame, []).append(run)
    shares = [
        f"{part} for {_list([f'the {run.beam}' for run in group])} "
        f"({_span([run.part(part) or 0.0 for run in group], short)}{_order(group, part)})"
        for part, group in parts.items()
    ]
    suspects = [
        f"in the {run.beam} {first.name} seems {first.size} off"
        for run in runs
        for first in _budget(run).suspects[:1]
    ]
    doubt = f"; {_list(suspects)}" if suspects else ""
    return f"The largest part of the disagreement is {_list(shares)}{doubt}."


def _order(runs: Sequence[RunRecord], part: str) -> str:
    if part != "discretisation":
        return ""
    return f", of observed order {_span([_budget(run).order for run in runs], '{:.2f}'.format)}"


def _closure(runs: Sequence[RunRecord], named: Callable[[RunRecord], str]) -> str:
    rest = short(max(run.part("unexplained") or 0.0 for run in runs))
    still_open = [run for run in runs if not _budget(run).closes]
    if not still_open:
        subject = "The budget closes" if len(runs) == 1 else "Every budget closes"
        return f"{subject}: at most {rest} is unexplained."
    if len(runs) == 1:
        how = "is undecided" if _budget(runs[0]).undecided else "does not close"
        return f"The budget {how}: {rest} is unexplained."
    which = "; ".join(
        f"{named(run)}{': undecided' if _budget(run).undecided else ''}" for run in still_open
    )
    count = f"{len(still_open)} of {len(runs)} budgets do not close ({which})"
    return f"{count}: up to {rest} is unexplained."


def _allowance(runs: Sequence[RunRecord]) -> str:
    kept = sum((run.part("unexplained") or 0.0) <= UNRESOLVED for run in runs)
    return f"No more than {short(UNRESOLVED)} is unexplained in {kept} of {len(runs)}."


def _events(runs: Sequence[RunRecord]) -> str:
    shifts = [run.snap_off for run in runs]
    known = [abs(shift) for shift in shifts if shift is not None]
    if len(known) == len(runs):
        said = f"The snap-off is found within {short(max(known))} L"
    elif known:
        said = f"The snap-off is missing in {len(runs) - len(known)} of {len(runs)} comparisons"
    else:
        said = "No snap-off is found in both sweeps"
    right = [run.phases_right for run in runs if run.phases_right is not None]
    if not right:
        return f"{said}."
    share = "every station" if min(right) == 1 else f"at least {100 * min(right):.1f} % of stations"
    return f"{said}, and the clamp readings give the right phase of {share}."


def _budget(run: RunRecord) -> Budget:
    assert run.budget is not None
    return run.budget


def _case_and_beam(run: RunRecord) -> str:
    return f"{run.case}, {run.beam}"


def _beam(run: RunRecord) -> str:
    return run.beam


def _span(values: Sequence[float], write: Callable[[float], str]) -> str:
    low, high = write(min(values)), write(max(values))
    return low if low == high else f"{low} to {high}"


def _list(words: Sequence[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def _worst(rms: Mapping[str, float]) -> float:
    """Of the readings that could be compared."""
    return max((one for one in rms.values() if not math.isnan(one)), default=0.0)
