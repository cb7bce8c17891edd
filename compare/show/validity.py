"""A validation in words: is the disagreement resolved, and what would have to be known better."""

from collections.abc import Iterator

from analytic import Beam
from compare.comparison import Comparison
from compare.show.document import Table, Text
from compare.show.numbers import percent, quantity, short, words
from compare.validate.spread import NOISE, NUMERICS
from compare.validate.stated import GAINS, INPUTS
from compare.validate.validation import Validation

_PLAIN = {NOISE: "noise of the data", NUMERICS: "the simulation's numerics"}


def validation_lines(comparison: Comparison) -> list[str]:
    found = comparison.validation
    return [] if found is None else [*_lines(found, comparison.reference.beam)]


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


def _lines(found: Validation, beam: Beam) -> Iterator[str]:
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
        yield _dominant(found, beam)
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
        return (
            f"{said}; even without it the rest hides the disagreement. All uncertainties together "
            f"would have to shrink to {found.shrink_all:.2g} of what they are."
        )
    if name not in found.standard:
        return f"{said}: it must shrink to {found.shrink:.2g} of what it is to decide."
    now = found.standard[name]
    sizes = (standard_of(name, x, beam) for x in (now, found.shrink * now))
    return f"{said}: its standard uncertainty must shrink from {' to '.join(sizes)} to decide."


def validation_tables(found: Validation, beam: Beam) -> Iterator[Table | Text]:
    """E and its uncertainty by reading, what makes the latter, and what is left out."""
    yield Table(
        "Simulation less data, E = S - D, and its uncertainty (ASME V&V 20), root mean square of "
        f"{found.stations} stations, relative to each reading's largest magnitude; E of a right "
        "model is below k u_val in 95 % of all cases",
        ("", "E", "u_num", "u_input", "u_D", "u_val", "k", "k u_val", "disagreement"),
        [
            (
                name,
                *(short(x) for x in (one.error, one.u_num, one.u_input, one.u_data, one.u_val)),
                f"{one.coverage:.2f}",
                short(one.limit),
                "resolved" if one.resolved else "not resolved",
            )
            for name, one in {**found.by_reading, "all, correlated": found.whole}.items()
        ],
        words=(0, 8),
        whole=[len(found.by_reading)],
    )
    shares = found.whole.shares
    yield Table(
        "What makes u_val squared; an input is off by the same at all stations",
        ("uncertain", "standard uncertainty", "share", *found.by_reading),
        [
            (
                words(name),
                standard_of(name, found.standard[name], beam) if name in found.standard else "",
                percent(share),
                *(percent(one.shares[name]) for one in found.by_reading.values()),
            )
            for name, share in shares.items()
        ],
        blamed=[i for i, name in enumerate(shares) if name == found.dominant],
    )
    left = found.left_out
    thinned = f", {left['thinned']} of very many" if left.get("thinned") else ""
    yield Text(
        f"Left out: {left['before_snap_off']} stations next to the snap-off, "
        f"{left['without_sensitivity']} whose sensitivity is not known{thinned}.",
        aside=True,
    )
