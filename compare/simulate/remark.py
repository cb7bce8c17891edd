"""A line on a model, and what is too much of more than one subject."""

from dataclasses import dataclass
from typing import Literal

from mujoco_models.fix.edit import Edit, Insert

# Each moves a reading by about one per cent of its largest magnitude.
RIGIDITY = 0.01
"""Relative; forces and moments are proportional to EI."""
SINKS = 2e-3
"""Depth of a contact [L]."""
SINKS_RUBBING = 4e-3
"""The same with friction, by which harder ones chatter."""
RADIUS = 2e-3
"""Of thickness [L]: the contour that the axis feels is the radius away."""
FORCE = 3.0
"""The largest of a usual sweep [EI/L^2]."""
# Stiffness [EI/L^3] and rate of the damper [1/T1] of a contact that rubs, times its coefficient
# squared, at damping ratios of 0.25 to 1: of 60 stations at most 4 chatter up to 8.0e3, 10 to 20
# at 8.6e3 to 35e3, 57 at 9e5. Lighter damping rings, at some stiffnesses.
HARDEST_RUBBING = 7e3
EXPLICIT = ("euler", "implicit", "implicitfast", "rk4")
"""Integrators that are explicit in the springs."""

_SHOWN = 4  # edits of a remark


@dataclass(frozen=True)
class Remark:
    # A ``"fault"`` moves readings by about a per cent or more; a ``"note"`` is good to know.
    kind: Literal["fault", "note"]
    subject: str  # as ``"clamp"``
    text: str  # in a sentence
    remedy: str = ""  # what to do, beside edits
    edits: tuple[Edit | Insert, ...] = ()  # that fix it

    def __str__(self) -> str:
        said = [f"set {edit}" for edit in self.edits if f"{edit}"]
        if len(said) > _SHOWN:
            said[_SHOWN - 1 :] = [f"and {len(said) - _SHOWN + 1} more, which --write sets"]
        said = [f"{self.kind}, {self.subject}: {self.text}", self.remedy, *said]
        return "; ".join(filter(None, said))
