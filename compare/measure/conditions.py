"""What readings may be of that a method does not know: other vibrissae, supports and contacts."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

from analytic import Case, InputError, Readings
from analytic.problem.quantities import QUANTITIES


@dataclass(frozen=True)
class Condition:
    """A case as it is in truth, while a method takes it for the paper's vibrissa."""

    what: str  # in a few words, with its size
    true: Callable[[Case], Case]  # the true case, from the one that the method believes in


def _with(name: str, size: float) -> Callable[[Case], Case]:
    """The case with another value of a quantity, in its unit."""
    quantity = QUANTITIES[name]
    return lambda case: quantity.at(case, size * quantity.unit(case))


CONDITIONS: dict[str, Condition] = {
    "exact": Condition("the paper's vibrissa", lambda case: case),
    "curved": Condition("natural curvature -0.2/L", _with("natural_curvature", -0.2)),
    "tapered": Condition(
        "a cone whose tip has 0.8 of the radius",
        lambda case: QUANTITIES["tip_radius"].at(case, 0.8 * case.beam.radius),
    ),
    "soft-clamp": Condition("clamp of stiffness 10 EI/L", _with("clamp_compliance", 0.1)),
    "friction": Condition("friction 0.2", _with("friction", 0.2)),
}
"""By name. Sizes are moderate: each bends or turns a vibrissa by less than a contact does."""

SIMULATED = "mujoco"
"""Name of readings that a simulator made."""


def chosen_conditions(names: Iterable[str]) -> list[str]:
    """Conditions by name, without repetition."""
    every = (*CONDITIONS, SIMULATED)
    found: dict[str, None] = {}
    for name in names:
        if name not in (*every, "all"):
            raise InputError(
                "readings", repr(name), f"all, or of {', '.join(every)}", "correct the name"
            )
        found |= dict.fromkeys(every if name == "all" else [name])
    return list(found)


def as_believed(readings: Readings, case: Case) -> Readings:
    """The readings as a method gets them: of the paper's vibrissa, as far as anybody knows."""
    provenance = {name: x for name, x in readings.provenance.items() if name != "support"}
    return replace(readings, beam=case.beam, provenance=provenance)
