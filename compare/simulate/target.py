"""The coarsest settings with a wanted error, by the parts of a budget, and what comes of them."""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any

from analytic import Case, InputError, Readings, solve_sweep
from compare.explain.budget import Budget, largest_rms
from mujoco_models import simulate_sweep
from mujoco_models.allowed import CONTACT_STIFFNESSES
from mujoco_models.settings import Settings

_FRACTION = 0.9  # of the target that is planned for; the rest is for what a power law leaves out
_SOFTNESS = 0.3  # of the target that a contact may give way
_BEAM = 0.8  # of what is left of its square; the facets get the rest, for they cost little
# Facets' normals fall with their number, their chords with its square: the slower where there are
# to be more, the faster where there are to be fewer.
_MORE_FACETS, _FEWER_FACETS = 1, 2
_SEGMENTS, _POINTS = (5, 1000), (100, 25_600)


@dataclass(frozen=True)
class Followed:
    """Settings for a wanted error, and what came of them."""

    target: float  # the wanted error
    settings: Settings
    predicted: float  # the error: the largest rms of the three readings
    error: float  # the same as measured
    seconds_a_station: float  # of that sweep

    @property
    def reached(self) -> bool:
        return self.error <= self.target

    def to_dict(self) -> dict[str, Any]:
        return {**asdict(self), "reached": self.reached}


def follow_advice(
    case: Case, found: Budget, runs: Mapping[str, Readings], target: float
) -> Followed:
    """Choose settings, sweep with them, and measure."""
    settings, predicted = advised(found, runs, target)
    made = simulate_sweep(case, settings)
    seconds = float(made.provenance["seconds"]) / len(made.table)
    return Followed(target, settings, predicted, largest_rms(solve_sweep(case), made), seconds)


def advised(found: Budget, runs: Mapping[str, Readings], target: float) -> tuple[Settings, float]:
    """The coarsest settings that should reach `target`, and the error to expect of them.

    The parts add as squares. Contacts become stiffer if they give way too much. What nothing here
    lowers is taken off, and the beam gets most of what is left, the facets the rest; each part
    follows its power law.
    """
    base = Settings(**runs["base"].provenance["settings"])
    sizes = {name: max(one.rms for one in part.values()) for name, part in found.parts.items()}
    harder = max(1.0, sizes["softness"] / (_SOFTNESS * target))
    stiffness = min(harder * base.contact_stiffness, CONTACT_STIFFNESSES[1])
    softness = sizes["softness"] * base.contact_stiffness / stiffness
    rest = math.hypot(softness, sizes["unexplained"], sizes.get("corner", 0.0))
    spare = (_FRACTION * target) ** 2 - rest**2
    shares = [math.sqrt(max(spare, 0.0) * of) for of in (_BEAM, 1 - _BEAM)]

    def finer(
        now: int, part: str, share: float, order: float, allowed: tuple[int, int]
    ) -> tuple[int, float]:
        """How many of them, and what they leave of their part."""
        wanted = now * (sizes[part] / share) ** (1 / order) if share > 0 else math.inf
        number = math.ceil(min(max(wanted, allowed[0]), allowed[1]))
        return number, sizes[part] * (now / number) ** order

    segments, bent = finer(base.segments, "discretisation", shares[0], found.order, _SEGMENTS)
    points, cut = base.contour_points, sizes["facets"]
    if runs["smooth"].provenance["settings"]["obstacle"] != base.obstacle:  # else none are known
        order = _MORE_FACETS if cut > shares[1] else _FEWER_FACETS
        points, cut = finer(points, "facets", shares[1], order, _POINTS)
    error = math.hypot(rest, bent, cut)
    if error > target:
        least = f"at least {error / _FRACTION:.1e}, the smallest that this budget can predict"
        remedy = "begin with a finer run: more --segments, whose budget is surer"
        raise InputError("--target", target, least, remedy)
    chosen = replace(base, segments=segments, contour_points=points, contact_stiffness=stiffness)
    return chosen, error
