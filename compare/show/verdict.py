"""What a comparison, and its budget if there is one, come to: a sentence to act on."""

from analytic import CLAMP_READINGS
from compare.comparison import Comparison
from compare.explain.budget import Budget
from compare.show.page import short


def worst_reading(comparison: Comparison) -> str:
    """The clamp reading whose rms disagreement goes farthest beyond its limit, or nearest to it."""
    limit = comparison.tolerances.of_sweep
    return max(CLAMP_READINGS, key=lambda name: comparison.disagreement[name].rms - limit(name))


def verdict(comparison: Comparison, budget: Budget | None = None) -> str:
    """How far the candidate can be used, and what would make it better."""
    name = worst_reading(comparison)
    found, allowed = comparison.disagreement[name], comparison.tolerances.of_sweep(name)
    candidate, reference = comparison.candidate.source, comparison.reference.source
    if comparison.agrees:
        beside = "" if found.rms <= allowed else " beside the noise"
        said = (
            f"Readings of {candidate} can be used in place of {reference} to within "
            f"{short(found.rms)} rms ({name}, the worst; {short(allowed)} is allowed{beside})"
        )
    elif found.rms > allowed:
        phase = max(found.rms_by_phase, key=lambda phase: found.rms_by_phase[phase])
        said = (
            f"Do not use readings of {candidate} in place of {reference} yet: {name} is off by "
            f"{short(found.rms)} rms where {short(allowed)} is allowed, most in phase {phase}"
        )
    else:
        said = (
            f"Do not use readings of {candidate} in place of {reference} yet: they exceed "
            f"{_count(len(comparison.failures))} of the tolerances, though not that of the rms "
            f"({name}, the worst, {short(found.rms)})"
        )
    if budget is not None:
        rest = short(max(part.rms for part in budget.parts["unexplained"].values()))
        told = budget.closes or budget.blame == "unexplained"
        doubt = "" if told else f", but {rest} stays unexplained"
        return f"{said}; {_advice(comparison, budget)}{doubt}."
    if comparison.agrees or "settings" not in comparison.candidate.provenance:
        return f"{said}."
    return f"{said}; a budget would tell why."


def _advice(comparison: Comparison, budget: Budget) -> str:
    """What the largest part of the disagreement is, and what lowers it."""
    name = max(CLAMP_READINGS, key=lambda name: budget.parts[budget.blame][name].rms)
    size = budget.parts[budget.blame][name].rms
    settings = comparison.candidate.provenance.get("settings", {})
    if budget.blame == "unexplained" and budget.suspects:
        first = budget.suspects[0]
        return (
            f"the numerics do not explain it, but {first.name} does if it is "
            f"{first.change:+.2%} off in {comparison.candidate.source}: check it"
        )
    if budget.blame == "unexplained":
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
    "unrest": "a smaller tolerance of rest lowers",
    "sensor": "is the sensors' own: hold them against the sum of the contacts",
    "extension": "a beam that cannot be stretched would not have",
}
_NUMBERS = ("none", "one", "two", "three", "four", "five", "six")


def _count(n: int) -> str:
    return _NUMBERS[n] if n < len(_NUMBERS) else str(n)
