"""What a comparison, its budget and its validation come to: sentences to act on."""

from collections.abc import Iterator

from analytic import CLAMP_READINGS, Beam
from compare.comparison import Comparison
from compare.explain.budget import Budget
from compare.show.budgets import left_over
from compare.show.document import Table, Text
from compare.show.numbers import percent, quantity, short, words
from compare.validate.spread import NOISE, NUMERICS
from compare.validate.stated import GAINS, INPUTS
from compare.validate.validation import Validation

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
    return comparison.why


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


_PLAIN = {NOISE: "noise of the data", NUMERICS: "the simulation's numerics"}


def validation_claim(found: Validation) -> str:
    """Whether a disagreement says anything, in a sentence."""
    is_it = "is resolved: only" if found.resolved else "is not resolved:"
    error, limit = short(found.whole.error), short(found.whole.limit)
    return f"The disagreement, {error} rms, {is_it} {limit} is uncertain."


def standard_of(name: str, value: float, beam: Beam) -> str:
    """A standard uncertainty with its unit, where that is known."""
    if name in GAINS:
        return f"{100 * value:.3g} %"
    dimension = INPUTS[name].dimension
    if dimension == "m":
        return quantity(value, "length", beam)
    return f"{value:.3g} {dimension}".rstrip() if beam.si else f"{value:.3g}"


def validation_lines(comparison: Comparison) -> Iterator[str]:
    """What a validation comes to, if there is one."""
    if (found := comparison.validation) is None:
        return
    whole = found.whole
    sizes = (
        f"E = {short(whole.error)} rms against {short(whole.limit)} = {whole.coverage:.2f} u_val "
        f"(u_num {short(whole.u_num)}, u_input {short(whole.u_input)}, u_D {short(whole.u_data)})"
    )
    if found.resolved:
        low, high = whole.error - whole.limit, whole.error + whole.limit
        yield (
            f"Validation: the disagreement is resolved, {sizes}: the model, or an input that is "
            f"not in [uncertainty], is in error by {short(low)} to {short(high)}."
        )
    else:
        yield (
            f"Validation: the disagreement is not resolved, {sizes}: it is within what is "
            "uncertain, and neither confirms nor refutes the model beyond that."
        )
    if found.simulation == "candidate":
        yield (
            "The closed form stands in for an experiment here: both sweeps have the same inputs, "
            "so this says what an experiment with such inputs could see."
        )
    if whole.u_val > 0:
        yield _dominant(found, comparison.reference.beam)
    yield (
        f"Noise: {found.noise_source}. Numerics: {found.numerics_source}. The sensitivities miss "
        f"{found.second_order:.0%} of what {found.samples} samples of the inputs do, "
        "which is counted."
    )


def _dominant(found: Validation, beam: Beam) -> str:
    name, share = found.dominant, found.whole.shares[found.dominant]
    verb = "dominates" if found.dominates else "is the largest part"
    said = f"{_PLAIN.get(name, name)} {verb} ({share:.0%} of u_val squared)"
    if found.resolved:
        return f"{said}."
    if found.shrink is None:
        without = f"{said}; its error, or what else is uncertain, may make all of E"
        if found.shrink_all is None:
            return f"{without}."
        return f"{without}; with {found.shrink_all:.2g} of all uncertainties it would be resolved."
    sizes = f"{found.shrink:.2g} of that"
    if name in found.standard:
        now = found.standard[name]
        before, after = (standard_of(name, x, beam) for x in (now, found.shrink * now))
        sizes = f"a standard uncertainty of {after} instead of {before}"
    return f"{said}; with {sizes} E would be resolved, whatever its error is."


def validation_tables(found: Validation, beam: Beam) -> Iterator[Table | Text]:
    """E and its uncertainty by reading, what makes the latter, and what is left out."""
    rows: list[tuple[str, ...]] = []
    for name, one in {**found.by_reading, "all, correlated": found.whole}.items():
        sizes = map(short, (one.error, one.u_num, one.u_input, one.u_data, one.u_val))
        said = "resolved" if one.resolved else "not resolved"
        rows.append((name, *sizes, f"{one.coverage:.2f}", short(one.limit), said))
    yield Table(
        "Simulation less data, E = S - D, and its uncertainty (ASME V&V 20), root mean square of "
        f"{found.stations} stations, relative to each reading's largest magnitude; E of a right "
        "model is below k u_val in 95 % of all cases",
        ("", "E", "u_num", "u_input", "u_D", "u_val", "k", "k u_val", "disagreement"),
        rows,
        words=(0, 8),
        whole=[len(found.by_reading)],
    )
    shares, rows = found.whole.shares, []
    for name, share in shares.items():
        known = standard_of(name, found.standard[name], beam) if name in found.standard else ""
        each = (percent(one.shares[name]) for one in found.by_reading.values())
        rows.append((words(name), known, percent(share), *each))
    yield Table(
        "What makes u_val squared; an input is off by the same at all stations",
        ("uncertain", "standard uncertainty", "share", *found.by_reading),
        rows,
        blamed=[i for i, name in enumerate(shares) if name == found.dominant],
    )
    left = found.left_out
    thinned = f", {left['thinned']} of very many" if left.get("thinned") else ""
    yield Text(
        f"Left out: {left['before_snap_off']} stations next to the snap-off, "
        f"{left['without_sensitivity']} whose sensitivity is not known{thinned}.",
        aside=True,
    )
