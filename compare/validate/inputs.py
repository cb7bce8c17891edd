"""The inputs of a case that may be uncertain, and the case with one of them changed."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from analytic import CLAMP_READINGS, Case

GAINS = tuple(f"gain_{name}" for name in CLAMP_READINGS)
"""Of each reading's sensor, relative: its calibration."""


@dataclass(frozen=True)
class Kind:
    """An input of a case."""

    dimension: str  # SI unit of its dimension; empty for a plain number
    # Its value in a case; 0 for a place, which is not known relative to anything, and not finite if
    # the case has no such number.
    nominal: Callable[[Case], float]
    unit: Callable[[Case], float]  # what it is compared with: a small change is small against that
    # The case with the input changed by so much; None if the foot's positions change instead.
    changed: Callable[[Case, float], Case] | None
    positive: bool = False  # whether it cannot be negative


def _length(case: Case) -> float:
    return case.beam.length


def _rigidity(case: Case) -> float:
    return case.beam.base_rigidity


def _natural(case: Case) -> float:
    natural = case.beam.natural_curvature
    return natural if isinstance(natural, float) else math.nan


def _tip_radius(case: Case) -> float:
    return math.nan if case.beam.tip_radius is None else case.beam.tip_radius


def _stiffer(case: Case, by: float) -> Case:
    return replace(case, beam=case.beam.scaled(rigidity=1 + by / _rigidity(case)))


def _longer(case: Case, by: float) -> Case:
    return replace(case, beam=case.beam.scaled(length=1 + by / case.beam.length))


def _thicker(case: Case, by: float) -> Case:
    return replace(case, beam=replace(case.beam, radius=case.beam.radius + by))


def _thicker_at_its_tip(case: Case, by: float) -> Case:
    return replace(case, beam=replace(case.beam, tip_radius=_tip_radius(case) + by))


def _bent(case: Case, by: float) -> Case:
    return replace(case, beam=replace(case.beam, natural_curvature=_natural(case) + by))


INPUTS: dict[str, Kind] = {
    "flexural_rigidity": Kind("N m^2", _rigidity, _rigidity, _stiffer, positive=True),
    "length": Kind("m", _length, _length, _longer, positive=True),
    "radius": Kind("m", lambda case: case.beam.radius, _length, _thicker, positive=True),
    "tip_radius": Kind("m", _tip_radius, _length, _thicker_at_its_tip, positive=True),
    "natural_curvature": Kind("1/m", _natural, lambda case: 1 / case.beam.length, _bent),
    "clamp_stiffness": Kind(
        "N m",
        lambda case: case.clamp_stiffness,
        lambda case: case.clamp_stiffness,
        lambda case, by: replace(case, clamp_stiffness=case.clamp_stiffness + by),
        positive=True,
    ),
    "friction": Kind(
        "",
        lambda case: case.friction,
        lambda case: 1.0,
        lambda case, by: replace(case, friction=case.friction + by),
        positive=True,
    ),
    "foot_x": Kind("m", lambda case: 0.0, _length, None),
    "height": Kind(
        "m",
        lambda case: 0.0,
        _length,
        lambda case, by: replace(case, profile=case.profile.raised(by)),
    ),
}
"""By name. The rigidity is that at the clamp, and what varies along the vibrissa goes along with it
and with its length; ``height`` is that of the object above the foot's line."""


def possible(case: Case, name: str, error: float) -> float:
    """An input's error that it can have: what would be negative has the other sign.

    So friction that is 0 by the case and uncertain is at most as large as stated.
    """
    if name in GAINS or not INPUTS[name].positive:
        return error
    nominal = INPUTS[name].nominal(case)
    return abs(nominal + error) - nominal
