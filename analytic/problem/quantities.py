"""The numbers of a case by name, and the case with one of them changed."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from analytic.problem.along import Along
from analytic.problem.case import Case
from analytic.problem.clamp_path import Sweep, TurningWay


def between(case: Case, start: float, stop: float, stations: int | None = None) -> Case:
    """The same sweep between other positions of the foot [length]."""
    sweep = case.require_line("a sweep between other positions of the foot")
    number = sweep.stations if stations is None else stations
    return replace(case, sweep=replace(sweep, stations=number, start=start, stop=stop))


def shifted(case: Case, x: float = 0.0, angle: float = 0.0) -> Case:
    """The case over its own stations, whatever else is changed of it then, or beside them."""
    if not isinstance(case.sweep, Sweep):
        return replace(case, sweep=case.sweep.shifted(x, angle))
    start, stop = (float(foot) + x for foot in case.foot_x[[0, -1]])
    return replace(between(case, start, stop), clamp_angle=case.clamp_angle + angle)


@dataclass(frozen=True)
class Quantity:
    """A number of a case: of its vibrissa, its clamp, its object or its sweep."""

    dimension: str  # its SI unit; empty for a plain number
    # Its value in a case; 0 for a place, which is not known relative to anything, and NaN where it
    # varies along the vibrissa.
    value: Callable[[Case], float]
    unit: Callable[[Case], float]  # what it is compared with: a small change is small against that
    larger: Callable[[Case, float], Case]  # the case in which it is larger by so much
    positive: bool = False  # whether it cannot be negative

    def at(self, case: Case, value: float) -> Case:
        return self.larger(case, value - self.value(case))


def _rigidity(case: Case) -> float:
    return case.beam.base_rigidity


def _stiffer(case: Case, by: float) -> Case:
    return replace(case, beam=case.beam.scaled(rigidity=1 + by / case.beam.base_rigidity))


def _longer(case: Case, by: float) -> Case:
    return replace(case, beam=case.beam.scaled(length=1 + by / case.beam.length))


def _thicker(case: Case, by: float) -> Case:
    return replace(case, beam=replace(case.beam, radius=case.beam.radius + by))


def _tip_radius(case: Case) -> float:
    beam = case.beam
    if isinstance(beam.flexural_rigidity, Along):
        return math.nan
    return beam.radius if beam.tip_radius is None else beam.tip_radius


def _thicker_at_its_tip(case: Case, by: float) -> Case:
    radius = _tip_radius(case) + by
    cylinder = math.isclose(radius, case.beam.radius, rel_tol=1e-12)
    return replace(case, beam=replace(case.beam, tip_radius=None if cylinder else radius))


def _natural_curvature(case: Case) -> float:
    natural = case.beam.natural_curvature
    return natural if isinstance(natural, float) else math.nan


def _more_curved(case: Case, by: float) -> Case:
    """All along, where it varies."""
    beam, natural = case.beam, case.beam.natural_curvature
    curved = natural + by if isinstance(natural, float) else lambda s: beam.curvature_at(s) + by
    return replace(case, beam=replace(beam, natural_curvature=curved))


def _softer(case: Case, by: float) -> Case:
    compliance = 1 / case.clamp_stiffness + by
    return replace(case, clamp_stiffness=1 / compliance if compliance > 0 else math.inf)


def _leaning(case: Case, by: float) -> Case:
    if isinstance(case.sweep, TurningWay):
        return shifted(case, angle=by)
    return replace(case, clamp_angle=case.clamp_angle + by)


def _length(case: Case) -> float:
    return case.beam.length


QUANTITIES: dict[str, Quantity] = {
    "flexural_rigidity": Quantity("N m^2", _rigidity, _rigidity, _stiffer, positive=True),
    "length": Quantity("m", _length, _length, _longer, positive=True),
    "radius": Quantity("m", lambda case: case.beam.radius, _length, _thicker, positive=True),
    "tip_radius": Quantity("m", _tip_radius, _length, _thicker_at_its_tip, positive=True),
    "natural_curvature": Quantity(
        "1/m", _natural_curvature, lambda case: 1 / case.beam.length, _more_curved
    ),
    "clamp_stiffness": Quantity(
        "N m",
        lambda case: case.clamp_stiffness,
        lambda case: case.clamp_stiffness,
        lambda case, by: replace(case, clamp_stiffness=case.clamp_stiffness + by),
        positive=True,
    ),
    "clamp_compliance": Quantity(
        "1/(N m)",
        lambda case: 1 / case.clamp_stiffness,
        lambda case: 1 / case.beam.moment_unit,
        _softer,
        positive=True,
    ),
    "friction": Quantity(
        "",
        lambda case: case.friction,
        lambda case: 1.0,
        lambda case, by: replace(case, friction=case.friction + by),
        positive=True,
    ),
    "clamp_angle": Quantity("rad", lambda case: case.clamp_angle, lambda case: 1.0, _leaning),
    "foot_x": Quantity("m", lambda case: 0.0, _length, shifted),
    "height": Quantity(
        "m",
        lambda case: 0.0,
        _length,
        lambda case, by: replace(case, profile=case.profile.raised(by)),
    ),
}
"""By name. The rigidity is that at the clamp, and what varies along the vibrissa goes along with it
and with its length; the clamp has a stiffness or its inverse, which is 0 where it is rigid;
``height`` is that of the object above the foot's line."""
