"""How the vibrissa is held, how the object rubs, what is recorded of it, and who refuses what."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from analytic.problem.along import Along
from analytic.problem.beam import Beam, Unloaded, Varying
from analytic.problem.clamp_path import ClampWay, Sweep
from analytic.problem.contours.contour import Contour
from analytic.problem.errors import InputError, require
from analytic.problem.numbers import floats, within
from analytic.problem.rod import AtRest, RodProperties, at_rest

_MOST_FRICTION = 1.0
_SOFTEST = 0.01  # EI/L, of the clamp
_MOST_LEANT = 1.55  # rad; the vibrissa of a clamp that leans more lies along the foot's line
_MOST_TURNED = math.pi / 2  # rad; beyond, the vibrissa at rest leans over itself
_HEAVIEST = 20.0  # EI/L^3; an upright vibrissa buckles under 7.84


class Support(NamedTuple):
    """How a vibrissa is held, and how the object rubs."""

    clamp_stiffness: float = math.inf  # moment by angle [force length/rad]
    friction: float = 0.0  # Coulomb's coefficient
    clamp_angle: float = 0.0  # by which the clamp leans to the left of the upright [rad]
    weight: tuple[float, float] = (0.0, 0.0)  # of the vibrissa along x and y, by length

    @property
    def is_plain(self) -> bool:
        """Whether the clamp is the paper's, rigid and upright, and nothing rubs."""
        return self == UPRIGHT

    def mirrored(self) -> "Support":
        weight = 0.0 - self.weight[0], self.weight[1]
        return self._replace(clamp_angle=0.0 - self.clamp_angle, weight=weight)

    def unloaded(self, beam: Beam) -> Unloaded:
        """A vibrissa without weight in this clamp, dimensionless."""
        return replace(beam.unloaded, angle=self.clamp_angle)

    def carried(self, beam: Beam) -> tuple[float, float]:
        """Weight of the whole vibrissa along x and y [force]."""
        return self.weight[0] * beam.length, self.weight[1] * beam.length

    def at_rest(self, beam: Beam) -> AtRest:
        """A vibrissa that touches nothing, under its weight, dimensionless."""
        unloaded = self.unloaded(beam)
        if not any(self.weight):
            return AtRest(unloaded, 0.0, stands=True)
        rod = RodProperties.of(beam, unloaded, self.weight)
        return at_rest(rod, beam.moment_unit / self.clamp_stiffness)


UPRIGHT = Support()  # the paper's clamp, no friction and no weight
_WEIGHT = ("weight_x", "weight_y")
RECORDED = {*Support._fields, *_WEIGHT} - {"weight"}  # names of what provenance says of all that


def check_support(held: Support, beam: Beam, signed: bool = False) -> None:
    clamp_stiffness, friction, clamp_angle, weight = held
    if not (isinstance(clamp_stiffness, float) and clamp_stiffness == math.inf):
        remedy = "it is moment by angle, at least a hundredth of EI/L; a rigid clamp has none"
        within("clamp_stiffness", clamp_stiffness, _SOFTEST * beam.moment_unit, remedy=remedy)
    least = -_MOST_FRICTION if signed else 0.0
    within("friction", friction, least, _MOST_FRICTION, "0.1 to 0.5 is usual")
    within("clamp_angle", clamp_angle, -_MOST_LEANT, _MOST_LEANT, "it is in rad, from the upright")
    unit = beam.force_unit / beam.length
    for value, name in zip(weight, "xy", strict=True):
        remedy = "it is force by length: gravity times mass by length"
        within(f"weight.{name}", value, -_HEAVIEST * unit, _HEAVIEST * unit, remedy)
    rest = held.at_rest(beam)
    turned = rest.shape.most_turned
    if not (rest.stands and (turned <= _MOST_TURNED or not any(weight))):
        fall = f"turns it by {turned:.6g} rad" if rest.stands else "buckles it"
        what = f"{tuple(weight)}, which {fall} at rest"
        allowed = f"such that it stands and turns by at most {_MOST_TURNED:.6g} rad"
        remedy = "lessen it: upright and uniform it stands below 7.837 EI/L^3"
        raise InputError("weight", what, allowed, remedy)
    if clamp_angle and turned > _MOST_TURNED:
        what = f"{clamp_angle:g}, where the vibrissa at rest turns by up to {turned:.6g} rad"
        allowed = f"such that it turns by at most {_MOST_TURNED:.6g} rad"
        raise InputError("clamp_angle", what, allowed, "beyond, it overhangs at rest")
    if turned > _MOST_TURNED * (1 + 1e-12):
        what = f"{beam.natural_curvature:g}, which turns the vibrissa by {turned:.6g} rad"
        allowed = f"such that it turns by at most {_MOST_TURNED:.6g} rad"
        raise InputError("beam.natural_curvature", what, allowed, "beyond, it overhangs at rest")


def is_plain(beam: Beam, held: Support) -> bool:
    """Whether a vibrissa is the paper's: straight, uniform, held upright, not rubbed."""
    return beam.natural_curvature == 0 and not beam.varies and held.is_plain


def require_uniform(who: str, beam: Beam) -> None:
    for name in ("flexural_rigidity", "natural_curvature"):
        value = getattr(beam, name)
        if isinstance(value, Along):
            allowed = f"a number: {who} cannot take it into account"
            raise InputError(f"beam.{name}", value, allowed, "give a mean")
    if beam.varies:
        refuse(who, "beam.tip_radius", beam.tip_radius, beam.radius)


def require_weightless(who: str, held: Support) -> None:
    for name, value in zip(_WEIGHT, held.weight, strict=True):
        refuse(who, name, value, 0.0)


def require_plain(who: str, beam: Beam, held: Support = UPRIGHT) -> None:
    require_uniform(who, beam)
    for name, (value, plain) in _numbers(beam, held).items():
        refuse(who, name, value, plain)


def refuse(who: str, name: str, value: object, plain: float) -> None:
    if value != plain:
        allowed = f"{plain:g}: {who} cannot take it into account"
        raise InputError(name, value, allowed, "leave it out")


def beyond_the_paper(beam: Beam, held: Support) -> dict[str, Varying]:
    """What of a vibrissa, its clamp and its contact is not the paper's, by what it is."""
    found = {name: value for name, (value, plain) in _numbers(beam, held).items() if value != plain}
    return {name.removeprefix("beam.").replace("_", " "): value for name, value in found.items()}


def _numbers(beam: Beam, held: Support) -> dict[str, tuple[Varying, float]]:
    """What may not be the paper's, by name, and what is that."""
    tip_radius = beam.radius if beam.tip_radius is None else beam.tip_radius
    return {
        "beam.tip_radius": (tip_radius, beam.radius),
        "beam.natural_curvature": (beam.natural_curvature, 0.0),
        "clamp_stiffness": (held.clamp_stiffness, math.inf),
        "friction": (held.friction, 0.0),
        "clamp_angle": (held.clamp_angle, 0.0),
        **{name: (w, 0.0) for name, w in zip(_WEIGHT, held.weight, strict=True)},
    }


def support_record(held: Support) -> dict[str, Any]:
    if held.is_plain:
        return {}
    stiffness = held.clamp_stiffness if held.clamp_stiffness < math.inf else None
    leant = {"clamp_angle": held.clamp_angle} if held.clamp_angle else {}
    heavy = dict(zip(_WEIGHT, held.weight, strict=True)) if any(held.weight) else {}
    return {"support": {"clamp_stiffness": stiffness, "friction": held.friction, **leant, **heavy}}


def support_of(provenance: Mapping[str, Any]) -> Support:
    held = provenance.get("support", {})
    stiffness = float(held.get("clamp_stiffness") or math.inf)
    friction, angle = (float(held.get(name) or 0.0) for name in ("friction", "clamp_angle"))
    w_x, w_y = (float(held.get(name) or 0.0) for name in _WEIGHT)
    return Support(stiffness, friction, angle, (w_x, w_y))


def given_contour(profile: Contour, beam: Beam) -> Contour:
    """What the centreline feels, a cone's at its tip, in units of the vibrissa's length."""
    require("profile", profile, Contour, "as catenary(0.5, -0.8), or a case's profile")
    require("beam", beam, Beam, "as Beam(length=..., flexural_rigidity=...)")
    return profile.scaled(1 / beam.length).offset(beam.unloaded.tip_radius)


class OfVibrissa:
    """What is of a vibrissa in a clamp: a case, or its readings."""

    beam: Beam

    @property
    def support(self) -> Support:
        raise NotImplementedError

    @property
    def beyond_the_paper(self) -> dict[str, Varying]:
        return beyond_the_paper(self.beam, self.support)

    def require_sweep(self, who: str) -> object:
        """Refuse a clamp that turns or leaves its line on its way, for who cannot do with that."""
        raise NotImplementedError

    def require_plain(self, who: str) -> None:
        """Refuse what is not of the paper's vibrissa, for who can take nothing else."""
        require_plain(who, self.beam, self.support)
        self.require_sweep(who)


class AnyCase(OfVibrissa):
    sweep: ClampWay
    others: tuple[Contour, ...]

    @property
    def is_plain(self) -> bool:
        """Whether vibrissa and object are the paper's: straight, uniform, upright, one contour."""
        one = not self.others and isinstance(self.sweep, Sweep)
        return one and is_plain(self.beam, self.support)

    def require_upright(self, who: str) -> None:
        """Refuse a clamp that leans, turns or leaves its line, and a weight."""
        self.require_sweep(who)
        require_weightless(who, self.support)
        refuse(who, "clamp_angle", self.support.clamp_angle, 0.0)

    def require_sweep(self, who: str) -> Sweep:
        """Refuse several objects, and a clamp that turns or leaves its line on its way."""
        self.require_one_object(who)
        return self.require_line(who)

    def require_one_object(self, who: str) -> None:
        if self.others:
            allowed = f"1: {who} can take no more"
            remedy = "solve it in closed form (exact), sweep MuJoCo in motion, or sweep past one"
            raise InputError("number of objects", 1 + len(self.others), allowed, remedy)

    def require_line(self, who: str) -> Sweep:
        """Refuse a clamp that turns or leaves its line on its way."""
        if not isinstance(self.sweep, Sweep):
            what = "of a clamp that turns" if self.sweep.running == "clamp_angle" else "of any path"
            allowed = f"a Sweep, with the foot along its line: {who} can do no other"
            remedy = "take the closed form or MuJoCo"
            raise InputError("way of the clamp", what, allowed, remedy)
        return self.sweep


def check_provenance(provenance: Mapping[str, Any]) -> None:
    for name, known in (("events", None), ("support", RECORDED)):
        value = provenance.get(name, {})
        fits = isinstance(value, Mapping) and (known is None or set(value) <= known)
        if not fits or not all(_is_number(x) for x in value.values()):
            allowed = "numbers or null by name"
            raise InputError(f"provenance.{name}", f"{value!r}"[:80], allowed, "drop it")
    contour, others = provenance.get("contour", [[], []]), provenance.get("others", [])
    for one in (contour, *(others if isinstance(others, list) else [others])):
        floats("provenance.contour", one, (2, None), "two lists of as many coordinates")


def recorded_contours(contours: Sequence[Any]) -> dict[str, Any]:
    """What the provenance says of the contours of objects, the first one and others."""
    named = {"contour": contours[0]} if contours else {}
    return named | ({"others": [*contours[1:]]} if contours[1:] else {})


def _is_number(value: object) -> bool:
    return value is None or (isinstance(value, int | float) and not isinstance(value, bool))
