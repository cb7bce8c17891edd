"""How the vibrissa is held and how the object rubs: checks, and who cannot do with what."""

import math
from collections.abc import Mapping
from typing import Any

from analytic.problem.along import Along
from analytic.problem.beam import Beam, Varying
from analytic.problem.errors import InputError
from analytic.problem.numbers import within

_MOST_FRICTION = 1.0
_SOFTEST = 0.01  # EI/L, of the clamp
_MOST_TURNED = math.pi / 2  # rad; beyond, the vibrissa at rest leans over itself


def check_support(clamp_stiffness: object, friction: object, beam: Beam, signed: bool) -> None:
    """Refuse a clamp or a friction that cannot be."""
    if not (isinstance(clamp_stiffness, float) and clamp_stiffness == math.inf):
        remedy = "it is moment by angle, at least a hundredth of EI/L; a rigid clamp has none"
        within("clamp_stiffness", clamp_stiffness, _SOFTEST * beam.moment_unit, remedy=remedy)
    least = -_MOST_FRICTION if signed else 0.0
    within("friction", friction, least, _MOST_FRICTION, "0.1 to 0.5 is usual")
    turned = beam.unloaded.most_turned
    if turned > _MOST_TURNED * (1 + 1e-12):
        what = f"{beam.natural_curvature:g}, which turns the vibrissa by {turned:.6g} rad"
        allowed = f"such that it turns by at most {_MOST_TURNED:.6g} rad"
        raise InputError("beam.natural_curvature", what, allowed, "beyond, it overhangs at rest")


def is_plain(beam: Beam, clamp_stiffness: float, friction: float) -> bool:
    """Whether a vibrissa is the paper's: straight, uniform, rigidly clamped, without friction."""
    straight = beam.natural_curvature == 0 and not beam.varies
    return straight and clamp_stiffness == math.inf and friction == 0


def require_uniform(who: str, beam: Beam) -> None:
    """Refuse a vibrissa that varies along its length."""
    for name in ("flexural_rigidity", "natural_curvature"):
        value = getattr(beam, name)
        if isinstance(value, Along):
            allowed = f"a number: {who} cannot take it into account"
            raise InputError(f"beam.{name}", value, allowed, "give a mean")
    if beam.varies:
        allowed = f"{beam.radius:g}: {who} cannot take it into account"
        raise InputError("beam.tip_radius", beam.tip_radius, allowed, "leave it out")


def require_plain(
    who: str, beam: Beam, clamp_stiffness: float = math.inf, friction: float = 0.0
) -> None:
    """Refuse what someone cannot take into account."""
    require_uniform(who, beam)
    for name, value, plain in (
        ("beam.natural_curvature", beam.natural_curvature, 0.0),
        ("clamp_stiffness", clamp_stiffness, math.inf),
        ("friction", friction, 0.0),
    ):
        if value != plain:
            allowed = f"{plain:g}: {who} cannot take it into account"
            raise InputError(name, value, allowed, "leave it out")


def beyond_the_paper(
    beam: Beam, clamp_stiffness: float = math.inf, friction: float = 0.0
) -> dict[str, Varying]:
    """What of a vibrissa, its clamp and its contact is not the paper's."""
    tip_radius = beam.radius if beam.tip_radius is None else beam.tip_radius
    numbers: tuple[tuple[str, Varying, float], ...] = (
        ("tip radius", tip_radius, beam.radius),
        ("natural curvature", beam.natural_curvature, 0.0),
        ("clamp stiffness", clamp_stiffness, math.inf),
        ("friction", friction, 0.0),
    )
    return {name: value for name, value, plain in numbers if value != plain}


def support_record(clamp_stiffness: float, friction: float) -> dict[str, Any]:
    """What provenance says of the clamp and the contact."""
    if clamp_stiffness == math.inf and friction == 0:
        return {}
    stiffness = clamp_stiffness if clamp_stiffness < math.inf else None
    return {"support": {"clamp_stiffness": stiffness, "friction": friction}}


def support_of(provenance: Mapping[str, Any]) -> tuple[float, float]:
    """Clamp stiffness and friction that readings were made with."""
    held = provenance.get("support", {})
    return float(held.get("clamp_stiffness") or math.inf), float(held.get("friction", 0.0))
