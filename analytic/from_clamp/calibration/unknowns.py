"""What of a vibrissa, its clamp and its sweep a calibration can find."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from analytic.problem.along import Along
from analytic.problem.case import Case
from analytic.problem.errors import InputError

_THINNEST = 0.05  # radius of the tip over that at the clamp; thinner ones are hardly determined
_SOFTEST = 20.0  # L/EI; a clamp so soft holds nothing
_MOST_BENT = 1.5  # 1/L, at rest
_MOST_RIGID = 100.0  # times what the readings' magnitudes suggest
_FARTHEST = 0.3  # L


@dataclass(frozen=True)
class Sought:
    """The vibrissa that is tried: a case, and by how much the readings' foot positions are off."""

    case: Case
    offset: float = 0.0
    """Foot positions of the readings less the true ones [length]."""


@dataclass(frozen=True)
class Unknown:
    """A fitted quantity, as a dimensionless number on which the readings depend smoothly."""

    now: Callable[[Sought, Case], float]  # the number, of what is tried
    # What is tried, with another such number; the second argument is the case as it was given,
    # which has the units.
    tried: Callable[[Sought, Case, float], Sought]
    value: Callable[[Sought], float]  # what a user calls the quantity, in the case's units
    lowest: float  # what the number can be
    highest: float  # what the number can be
    # Whether the quantity itself can be as at either end: a clamp can be rigid.
    possible: tuple[bool, bool]
    starts: tuple[float, ...]  # numbers from which a fit starts, beside that of the case


def _rigidity(sought: Sought, given: Case, number: float) -> Sought:
    beam, case = given.beam, sought.case
    factor = number * beam.base_rigidity / case.beam.base_rigidity
    return replace(sought, case=replace(case, beam=case.beam.scaled(rigidity=factor)))


def _stiffness(sought: Sought, given: Case, number: float) -> Sought:
    stiffness = given.beam.moment_unit / number if number > 0 else math.inf
    return replace(sought, case=replace(sought.case, clamp_stiffness=stiffness))


def _natural(sought: Sought) -> float:
    natural = sought.case.beam.natural_curvature
    return natural if isinstance(natural, float) else math.nan


def _bent(sought: Sought, given: Case, number: float) -> Sought:
    beam = replace(sought.case.beam, natural_curvature=number / given.beam.length)
    return replace(sought, case=replace(sought.case, beam=beam))


def _tip_radius(sought: Sought) -> float:
    beam = sought.case.beam
    return beam.radius if beam.tip_radius is None else beam.tip_radius


def _tapered(sought: Sought, given: Case, number: float) -> Sought:
    radius = None if number >= 1 else number * given.beam.radius
    return replace(
        sought, case=replace(sought.case, beam=replace(sought.case.beam, tip_radius=radius))
    )


def _rubbing(sought: Sought, given: Case, number: float) -> Sought:
    return replace(sought, case=replace(sought.case, friction=number))


UNKNOWNS: dict[str, Unknown] = {
    "flexural_rigidity": Unknown(
        lambda sought, given: sought.case.beam.base_rigidity / given.beam.base_rigidity,
        _rigidity,
        lambda sought: sought.case.beam.base_rigidity,
        1 / _MOST_RIGID,
        _MOST_RIGID,
        (False, False),
        (),
    ),
    "clamp_stiffness": Unknown(
        lambda sought, given: given.beam.moment_unit / sought.case.clamp_stiffness,
        _stiffness,
        lambda sought: sought.case.clamp_stiffness,
        0.0,
        _SOFTEST,
        (True, False),
        (0.05, 0.2, 0.8),
    ),
    "natural_curvature": Unknown(
        lambda sought, given: _natural(sought) * given.beam.length,
        _bent,
        _natural,
        -_MOST_BENT,
        _MOST_BENT,
        (False, False),
        (-0.6, -0.2, 0.2, 0.6),
    ),
    "tip_radius": Unknown(
        lambda sought, given: _tip_radius(sought) / given.beam.radius,
        _tapered,
        _tip_radius,
        _THINNEST,
        1.0,
        (False, True),
        (0.3, 0.6, 0.9),
    ),
    "friction": Unknown(
        lambda sought, given: sought.case.friction,
        _rubbing,
        lambda sought: sought.case.friction,
        0.0,
        1.0,
        (True, False),
        (0.1, 0.4),
    ),
    "offset": Unknown(
        lambda sought, given: sought.offset / given.beam.length,
        lambda sought, given, number: replace(sought, offset=number * given.beam.length),
        lambda sought: sought.offset,
        -_FARTHEST,
        _FARTHEST,
        (False, False),
        (-0.05, 0.05),
    ),
}
"""By name. The rigidity is that at the clamp; what varies along the vibrissa goes along with it.

The clamp is fitted by its compliance, of which a rigid one is an end, and ``offset`` is by how much
``foot_x`` is too large.
"""


def checked_unknowns(names: object, case: Case) -> tuple[str, ...]:
    """The names of what is to be found."""
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
        raise InputError(
            "unknowns",
            "natural_curvature, which varies along the case's vibrissa",
            "a number of the case",
            "give the case a constant one, or fit something else",
        )
    if "tip_radius" in names and (isinstance(beam.flexural_rigidity, Along) or beam.radius == 0):
        raise InputError(
            "unknowns",
            "tip_radius of a vibrissa whose rigidity does not follow it",
            "of a cone",
            "give the case a radius and a flexural rigidity that is a number",
        )
    return tuple(names)
