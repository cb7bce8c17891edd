"""The coarsest settings, or the fastest motion, with a wanted error, and what comes of them."""

import math
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any

from analytic import Case, InputError, Readings, solve_sweep
from compare.explain.budget import Budget, largest_rms
from compare.explain.motion import THREE_SPEEDS
from mujoco_models import simulate_sweep
from mujoco_models.allowed import CONTACT_STIFFNESSES
from mujoco_models.errors import DivergedError
from mujoco_models.settings import Settings

_FRACTION = 0.9  # of the target that is planned for; the rest is for what a power law leaves out
_SOFTNESS = 0.3  # of the target that a contact may give way
_BEAM = 0.8  # of what is left of its square; the facets get the rest, for they cost little
# Facets' normals fall with their number, their chords with its square: the slower where there are
# to be more, the faster where there are to be fewer.
_MORE_FACETS, _FEWER_FACETS = 1, 2
_SEGMENTS, _POINTS = (5, 1000), (100, 25_600)
_FAR = 0.5  # of the target; fewer segments do
_TRIES = 8
_CHATTER = 0.1  # fraction of the stations in contact; what is left of such a sweep says little
_NEAR = 1.1  # a speed that is known to within a tenth is good enough
NAIVE = 'leave clamp = "naive" out: its error falls in first order, that of the default in second'
_SPEEDS = 1e-3, 2.0  # L/T1; below it takes hours, above the vibrissa is thrown


@dataclass(frozen=True)
class Followed:
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
    """What is advised, as measured; again with fewer segments if those leave far less."""
    exact = solve_sweep(case)

    def measured(settings: Settings, predicted: float) -> Followed:
        made = simulate_sweep(case, settings)
        seconds = float(made.provenance["seconds"]) / len(made.table)
        return Followed(target, settings, predicted, largest_rms(exact, made), seconds)

    first = measured(*advised(found, runs, target))
    if first.error > _FAR * target or first.settings.clamp == "naive":
        return first
    wanted = first.settings.segments * math.sqrt(first.error / (_FRACTION * target))
    segments = max(math.ceil(wanted), _SEGMENTS[0])
    expected = first.error * (first.settings.segments / segments) ** 2
    again = measured(replace(first.settings, segments=segments), expected)
    return again if again.reached else first


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
        remedy = NAIVE if base.clamp == "naive" else "begin with a finer run: more --segments"
        raise InputError("--target", target, least, remedy)
    chosen = replace(base, segments=segments, contour_points=points, contact_stiffness=stiffness)
    return chosen, error


@dataclass(frozen=True)
class Fastest:
    target: float  # the wanted error: of the worst reading, rms relative to its largest magnitude
    speed: float  # of the fastest sweep with at most that [L/T1]
    error: float  # of that sweep; CPU time
    seconds: float  # of that sweep; CPU time
    at_rest: float  # what is left at rest
    tried: dict[float, float]  # error by speed, of all sweeps


def find_fastest(
    exact: Readings, runs: Mapping[str, Readings], move: Callable[[float], Readings], target: float
) -> Fastest:
    """Sweep at other speeds until the fastest one with a wanted error is known to a tenth."""
    known = [runs[name] for name in THREE_SPEEDS if name in runs]
    swept = {float(one.provenance["motion"]["speed"]): one for one in known}
    error = {speed: _error(exact, readings) for speed, readings in swept.items()}
    at_rest = _rms(exact, runs["rest"])
    slowest, quickest = _SPEEDS
    for _ in range(_TRIES):
        good = [v for v in error if error[v] <= target]
        bad = [v for v in error if not error[v] <= target]
        low, high = max(good, default=None), min(bad, default=None)
        if low is not None and low >= quickest:
            break
        if low is None or high is None or high <= low:
            # As many times slower or faster as an error of first order in the speed asks for.
            from_here = min(error) if low is None else max(error)
            factor = target / error[from_here] if math.isfinite(error[from_here]) else 0.25
            step = factor / 1.1 if low is None else factor * 1.1
            speed = from_here * (
                min(max(step, 0.1), 0.7) if low is None else min(max(step, 1.4), 4)
            )
        elif high / low <= _NEAR:
            break
        else:
            speed = math.sqrt(low * high)
        if speed < slowest:
            break
        speed = min(speed, quickest)
        try:
            swept[speed] = move(speed)
        except DivergedError:
            error[speed] = math.inf
        else:
            error[speed] = _error(exact, swept[speed])
    good = [v for v in error if error[v] <= target]
    if not good:
        least = min(error.values())
        raise InputError(
            "--target", target, f"at least {least:.1e}, with {at_rest:.1e} left at rest",
            "what is there at rest needs more segments, what is not a shorter time step, "
            "stiffer contacts or less damping",
        )  # fmt: skip
    best = max(good)
    seconds = float(swept[best].provenance["seconds"])
    return Fastest(target, best, error[best], seconds, at_rest, dict(sorted(error.items())))


def _error(exact: Readings, moved: Readings) -> float:
    touched = (exact.table["phase"] != "free").to_numpy()
    if (touched & ~moved.trusted).sum() > _CHATTER * touched.sum():
        return math.inf
    return _rms(exact, moved)


def _rms(exact: Readings, candidate: Readings) -> float:
    try:
        return largest_rms(exact, candidate)
    except InputError:  # no station in common
        return math.inf
