"""What a comparison, and its budget if there is one, come to: a sentence to act on."""

from collections.abc import Iterator

from analytic import CLAMP_READINGS
from compare.comparison import Comparison
from compare.explain.budget import Budget
from compare.show.budgets import left_over
from compare.show.numbers import short

_NEARLY_ALL = 0.95  # of the compared stations: with fewer, the budget is about another disagreement


def worst_reading(comparison: Comparison) -> str:
    """The clamp reading whose rms disagreement goes farthest beyond its limit, or nearest to it."""
    limit = comparison.tolerances.of
    found = comparison.disagreement
    return max(CLAMP_READINGS, key=lambda name: found[name].rms - limit(name, "rms"))


def verdict(comparison: Comparison, budget: Budget | None = None) -> str:
    """How far the candidate can be used, and what would make it better."""
    candidate, reference = comparison.candidate.source, comparison.reference.source
    if comparison.worst is None:
        name = worst_reading(comparison)
        found, allowed = comparison.disagreement[name], comparison.tolerances.of(name, "rms")
        noise = comparison.noise.level[name]
        beside = "" if found.rms <= allowed else f" beside noise of {short(noise)}"
        much = (
            f"{short(found.rms)} rms ({name}, the worst, over {comparison.stations} stations; "
            f"{short(allowed)} is allowed{beside})"
        )
        said = f"Readings of {candidate} and of {reference} agree to within {much}"
        if _is_mujoco(comparison):
            said = f"Readings of {candidate} can be used in place of {reference} to within {much}"
    else:
        others = len(comparison.exceeded) - 1
        more = f"{others} more limit{'s' * (others > 1)} exceeded, " if others else ""
        said = f"Readings of {candidate} disagree with those of {reference}"
        if _is_mujoco(comparison):
            said = f"Do not use readings of {candidate} in place of {reference} yet"
        said = f"{said}: {comparison.worst.clause} ({more}over {comparison.stations} stations)"
    if budget is not None:
        said = f"{said}; {_advice(comparison, budget)}{_doubt(comparison, budget)}"
    return f"{said}."


def why(comparison: Comparison, budget: Budget | None = None) -> str:
    """What a disagreement is likely made of, or how to find that out."""
    if budget is not None:
        doubt = ", but the budget is undecided" if budget.undecided else ""
        return f"by its budget the largest part is {budget.blame}{doubt}"
    if comparison.likely is not None:
        return f"likely: {comparison.likely}"
    unknown = "the readings alone do not show why"
    rig = "check its units and columns, the vibrissa's length and rigidity, the object's place"
    advice = {
        "mujoco ": "`vibrissa run CASE --budget` measures the parts of a MuJoCo model",
        "model ": "`vibrissa inspect` names the model's faults, --budget measures the parts",
        "measured": rig,
        "": "of a simulator, refine one thing at a time (elements, time step, contact, obstacle) "
        f"and see which makes them agree; of a rig, {rig}",
    }
    source = comparison.candidate.source
    if "others" in comparison.reference.provenance:  # no budget past several objects
        source = ""
    return f"{unknown}; {next(to for who, to in advice.items() if source.startswith(who))}"


def absent_transitions(comparison: Comparison) -> Iterator[str]:
    """Why a sweep has no beginning or end of Phase B, where it has none."""
    for which, judged in comparison.judged.items():
        source = judged.readings.source
        if not (judged.phase == "tangent").any():
            if (judged.phase == "tip").any():
                yield f"{source} has no Phase B: the contact stays at the tip"
            continue
        if getattr(comparison.transitions["phase_b_start"], which) is None:
            yield f"{source} has no start of Phase B: the first contact is tangential already"
        if getattr(comparison.transitions["phase_b_end"], which) is None:
            yield f"{source} has no end of Phase B: the last contact is tangential still"


def scope(comparison: Comparison) -> Iterator[str]:
    """What an agreement of MuJoCo at rest verifies, and what it does not."""
    if _is_mujoco(comparison) and not comparison.candidate.source.endswith("in motion"):
        yield (
            "This verifies MuJoCo's balance of such a beam, with contacts and rest as this testbed "
            "makes them. A model with MuJoCo's own contacts may be off by half: `vibrissa inspect` "
            "measures yours."
        )


def _is_mujoco(comparison: Comparison) -> bool:
    return comparison.candidate.source.startswith("mujoco ")


def _doubt(comparison: Comparison, budget: Budget) -> str:
    """What the budget leaves open, and where it is about fewer stations than the comparison."""
    said = ""
    if budget.undecided or not (budget.closes or budget.blame == "unexplained"):
        undecided = "the budget is undecided: " if budget.undecided else ""
        said = f", but {undecided}{left_over(budget)} stays unexplained"
    compared = comparison.stations
    if budget.stations < _NEARLY_ALL * compared:
        said += f" (over the {budget.stations} of {compared} stations that all its sweeps share)"
    return said


def _advice(comparison: Comparison, budget: Budget) -> str:
    """What the largest part of the disagreement is, and what lowers it."""
    name = max(CLAMP_READINGS, key=lambda name: budget.parts[budget.blame][name].rms)
    size = budget.parts[budget.blame][name].rms
    settings = comparison.candidate.provenance.get("settings", {})
    if budget.blame == "unexplained":
        for first in budget.suspects[:1]:
            return (
                f"the numerics do not explain it, but {first.name} does if it is "
                f"{first.size} off in {comparison.candidate.source}: check it"
            )
        if budget.undecided:
            return "the numerics are too uncertain to explain it: refine them"
        return "neither the numerics nor a known fault of the physics explains it: look for one"
    if budget.blame == "discretisation" and "segments" in settings:
        n, better = settings["segments"], size / 2**budget.order
        return (
            f"the largest part is the beam's discretisation, which {2 * n} segments instead of {n} "
            f"would bring to about {short(better)}"
        )
    return f"the largest part is {budget.blame} ({short(size)}), which {_REMEDIES[budget.blame]}"


_REMEDIES = {
    "discretisation": "more segments lower",
    "facets": "more points of the mesh's contour lower",
    "softness": "a stiffer contact lowers in proportion",
    "corner": "a smaller corner_radius lowers in proportion",
    "unrest": "a smaller tolerance of rest lowers",
    "sensor": "is the sensors' own: compare them with the sum of the contacts",
    "extension": "a beam that cannot be stretched would not have",
}
