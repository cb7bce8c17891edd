"""What a comparison, and its budget if there is one, come to: a sentence to act on."""

from analytic import CLAMP_READINGS
from compare.comparison import Comparison
from compare.explain.budget import Budget
from compare.show.page import short

_NEARLY_ALL = 0.95  # of the compared stations: with fewer, the budget is about another disagreement


def worst_reading(comparison: Comparison) -> str:
    """The clamp reading whose rms disagreement goes farthest beyond its limit, or nearest to it.

    Parameters
    ----------
    comparison : Comparison
        Of two sweeps.

    Returns
    -------
    str
        Its name.
    """
    limit = comparison.tolerances.of_sweep
    return max(CLAMP_READINGS, key=lambda name: comparison.disagreement[name].rms - limit(name))


def verdict(comparison: Comparison, budget: Budget | None = None) -> str:
    """How far the candidate can be used, and what would make it better.

    Parameters
    ----------
    comparison : Comparison
        Of two sweeps.
    budget : Budget, optional
        Of the candidate's disagreement.

    Returns
    -------
    str
        One sentence: the limit that is exceeded most, with its number, or the worst reading.
    """
    candidate, reference = comparison.candidate.source, comparison.reference.source
    if comparison.worst is None:
        name = worst_reading(comparison)
        found, allowed = comparison.disagreement[name], comparison.tolerances.of_sweep(name)
        beside = "" if found.rms <= allowed else " beside the noise"
        said = (
            f"Readings of {candidate} can be used in place of {reference} to within "
            f"{short(found.rms)} rms ({name}, the worst; {short(allowed)} is allowed{beside})"
        )
    else:
        others = len(comparison.exceeded) - 1
        more = f" ({_count(others)} more limit{'s' * (others > 1)} exceeded)" if others else ""
        said = (
            f"Do not use readings of {candidate} in place of {reference} yet: "
            f"{comparison.worst.clause}{more}"
        )
    if budget is not None:
        return f"{said}; {_advice(comparison, budget)}{_doubt(comparison, budget)}."
    if comparison.agrees or "settings" not in comparison.candidate.provenance:
        return f"{said}."
    return f"{said}; a budget would show why."


def _doubt(comparison: Comparison, budget: Budget) -> str:
    """What the budget leaves open, and where it is about fewer stations than the comparison."""
    said = ""
    if budget.undecided or not (budget.closes or budget.blame == "unexplained"):
        parts = budget.parts["unexplained"].values()
        rest, unsure = (short(max(getattr(p, n) for p in parts)) for n in ("rms", "uncertainty"))
        said = f", but {rest} stays unexplained"
        if budget.undecided:
            said = f", but the budget is undecided: {rest} +- {unsure} stays unexplained"
    compared = next(iter(comparison.disagreement.values())).stations
    if budget.stations < _NEARLY_ALL * compared:
        said += f" (over the {budget.stations} of {compared} stations that all its sweeps share)"
    return said


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
    if budget.blame == "unexplained" and budget.undecided:
        return "the numerics are too uncertain to explain it: refine them"
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
    "sensor": "is the sensors' own: compare them with the sum of the contacts",
    "extension": "a beam that cannot be stretched would not have",
}
_NUMBERS = ("none", "one", "two", "three", "four", "five", "six")


def _count(n: int) -> str:
    return _NUMBERS[n] if n < len(_NUMBERS) else str(n)
