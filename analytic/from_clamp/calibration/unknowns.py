"""What of a vibrissa, its clamp and its sweep a calibration can find."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from analytic.numerics.arrays import Floats
from analytic.problem.along import Along
from analytic.problem.case import Case
from analytic.problem.contours.contour import Contour
from analytic.problem.errors import InputError
from analytic.problem.quantities import QUANTITIES

_THINNEST = 0.05  # radius of the tip over that at the clamp; thinner ones are hardly determined
_SOFTEST = 20.0  # L/EI; a clamp so soft holds nothing
_MOST_BENT = 1.5  # 1/L, at rest
_MOST_RIGID = 100.0  # times what the readings' magnitudes suggest
_MOST_LEANT = 0.5  # rad
_LONGEST_LAG = 0.1  # L
_AT_THE_END = 1e-6  # from an end of what a number can be

LAG = "lag"
OFFSET = "offset"
LEVER = "lever"
LENGTH = "length"
OF_THE_FOOT = (OFFSET, LAG)  # unknowns that are none of the case but of its foot position


@dataclass(frozen=True)
class Sought:
    """The vibrissa that is tried: a case, and by how much the readings' foot positions are off."""

    case: Case
    offset: float = 0.0  # foot positions of the readings less the true ones [length]
    lag: float = 0.0  # the way that the foot goes until a reading is there [length]
    lever: float = 0.0  # how far along the vibrissa off the clamp the moment is taken [length]


@dataclass(frozen=True)
class Number:
    """A dimensionless number on which the readings depend smoothly."""

    name: str
    lowest: float  # what it can be
    highest: float  # what it can be
    starts: tuple[float, ...] = ()  # from which a fit starts, beside that of the case
    # Whether what it stands for can be as at either end: a clamp can be rigid, a side flat.
    possible: tuple[bool, bool] = (False, False)

    @property
    def called(self) -> str:
        """What a user calls it."""
        return self.name

    def is_no_such(self, number: float) -> bool:
        """Whether it is at an end of what it can be that what it stands for has not."""
        ends = zip((self.lowest, self.highest), self.possible, strict=True)
        return any(
            not possible and abs(number - end) < _AT_THE_END * max(1.0, abs(end))
            for end, possible in ends
        )


@dataclass(frozen=True)
class Family:
    """Contours of one kind, by numbers over L."""

    name: str
    kinds: tuple[Number, ...]
    profile: Callable[[Floats], Contour]  # over L
    # The numbers at which it is the contour of simpler ones, from these: where a fit starts.
    start: Callable[[Floats], Floats]
    simpler: tuple[str, ...] = ()  # the families of which these may be


@dataclass(frozen=True, kw_only=True)
class Unknown(Number):
    """A fitted quantity of the case, by its name in `QUANTITIES`, or an offset or a lag."""

    unit: Callable[[Case], float]  # of the quantity, in the case as it was given
    widest: float = 0.25  # half an interval that says something
    said: str = ""  # what a user calls the quantity, if that is another one

    @property
    def called(self) -> str:
        return self.said or self.name

    def now(self, sought: Sought, given: Case) -> float:
        return self._of(sought, self.name) / self.unit(given)

    def tried(self, sought: Sought, given: Case, number: float) -> Sought:
        value = number * self.unit(given)
        if self.name not in QUANTITIES:
            changed: dict[str, Any] = {self.name: value}
            return replace(sought, **changed)
        return replace(sought, case=QUANTITIES[self.name].at(sought.case, value))

    def value(self, sought: Sought) -> float:
        """The quantity, in the case's units."""
        return self._of(sought, self.said or self.name)

    def _of(self, sought: Sought, name: str) -> float:
        if name not in QUANTITIES:
            return float(getattr(sought, name))
        return QUANTITIES[name].value(sought.case)


UNKNOWNS: dict[str, Unknown] = {
    "flexural_rigidity": Unknown(
        "flexural_rigidity",
        1 / _MOST_RIGID,
        _MOST_RIGID,
        unit=lambda given: given.beam.base_rigidity,
    ),
    "clamp_stiffness": Unknown(
        "clamp_compliance",
        0.0,
        _SOFTEST,
        (0.05, 0.2, 0.8),
        unit=lambda given: 1 / given.beam.moment_unit,
        possible=(True, False),
        said="clamp_stiffness",
    ),
    "natural_curvature": Unknown(
        "natural_curvature",
        -_MOST_BENT,
        _MOST_BENT,
        (-0.6, -0.2, 0.2, 0.6),
        unit=lambda given: 1 / given.beam.length,
    ),
    "clamp_angle": Unknown(
        "clamp_angle",
        -_MOST_LEANT,
        _MOST_LEANT,
        (-0.1, 0.1),
        unit=lambda given: 1.0,
        widest=0.0087,  # half a degree: clamps lean by one or two
    ),
    "tip_radius": Unknown(
        "tip_radius",
        _THINNEST,
        1.0,
        (0.3, 0.6, 0.9),
        unit=lambda given: given.beam.radius,
        possible=(False, True),
    ),
    "friction": Unknown(
        "friction", 0.0, 1.0, (0.1, 0.4), unit=lambda given: 1.0, possible=(True, False)
    ),
    OFFSET: Unknown(  # a stage counts from anywhere
        OFFSET, -math.inf, math.inf, (-0.05, 0.05), unit=lambda given: given.beam.length
    ),
    LAG: Unknown(LAG, -_LONGEST_LAG, _LONGEST_LAG, unit=lambda given: given.beam.length),
    LENGTH: Unknown(LENGTH, 0.5, 2.0, (0.97, 1.03), unit=lambda given: given.beam.length),
}
"""By name. The rigidity is that at the clamp; what varies along the vibrissa goes along with it.

The clamp is fitted by its compliance, of which a rigid one is an end, ``offset`` is by how much
``foot_x`` is too large, and ``lag`` by how much it is too large along the motion.
"""

LOOK_LIKE_LAG: dict[str, Unknown] = {
    LENGTH: UNKNOWNS[LENGTH],
    LEVER: Unknown(LEVER, -0.5, 0.5, unit=lambda given: given.beam.length),
}
"""Mistakes that passes both ways past an unknown object may show as a lag."""


def checked_unknowns(names: object, case: Case) -> tuple[str, ...]:
    if isinstance(names, str):
        names = (names,)
    known = ", ".join(UNKNOWNS)
    if not isinstance(names, Sequence) or not names:
        raise InputError("unknowns", repr(names)[:80], f"some of {known}", "name what is to be fit")
    for i, name in enumerate(names):
        if not isinstance(name, str) or name not in UNKNOWNS:
            raise InputError("unknowns", repr(name)[:80], f"of {known}", "correct the name")
        if name in names[:i]:
            raise InputError("unknowns", f"{name} twice", "each once", "leave one out")
    beam = case.beam
    if "natural_curvature" in names and isinstance(beam.natural_curvature, Along):
        what = "natural_curvature, which varies along the case's vibrissa"
        remedy = "give the case a constant one, or fit something else"
        raise InputError("unknowns", what, "a number of the case", remedy)
    if "tip_radius" in names and (isinstance(beam.flexural_rigidity, Along) or beam.radius == 0):
        what = "tip_radius of a vibrissa whose rigidity does not follow it"
        remedy = "give the case a radius and a flexural rigidity that is a number"
        raise InputError("unknowns", what, "of a cone", remedy)
    return tuple(names)
