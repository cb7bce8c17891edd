"""The budget of a sweep in motion: what motion and contacts add to what is there at rest."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from analytic import Readings
from analytic.problem.arrays import Floats
from compare.explain.budget import UNRESOLVED
from compare.explain.parts import (
    SAFETY,
    Part,
    Shared,
    by_reading,
    common_stations,
    observed_order,
    parts_of,
    root_of_squares,
    with_unexplained,
)
from compare.judge.tolerances import Tolerances
from compare.measure.disagreement import rms
from mujoco_models.motion import Motion
from mujoco_models.user_model.names import OwnModel

OPTIONAL = ("undamped", "ours", "newton", "stiff")
"""Sweeps without which a budget has one part less."""
PARTS = (
    "rate",
    "damping",
    "time step",
    "contact model",
    "softness",
    "solver",
    "beam",
    "at rest",
    "unexplained",
)
THREE_SPEEDS = ("quarter", "half", "base", "double", "fourfold")
"""The three sweeps of a budget that differ in speed are next to each other here, slowest first."""
_LEAST_ORDER = 0.5  # in the speed: of the dampers' moment one, of inertia two, of bounces less
_SLOW = 0.02  # L/T1; a quarter of it takes minutes, and says no more of the limit
_STIFFER = 4  # times the contact stiffness, which half a time step stands as well
_LEFT = 0.1  # of the disagreement; what may stay unexplained


@dataclass(frozen=True)
class MotionBudget:
    """What the disagreement of a sweep in motion with the closed form is made of."""

    # `Part` by name and reading, those of `PARTS` that there are sweeps for: ``damping``, in
    # proportion to the damping ratio; ``rate``, what else a slower sweep does not have; ``time
    # step``, what a shorter one does not have; ``contact model``, of the user's contacts instead of
    # ours; ``softness``, of ours in a user's model instead of hard ones; ``solver``, of another one
    # than Newton's, or of its iterations; ``beam``, of what was measured instead of what is stated;
    # ``at rest``, of the same model and our contacts; ``unexplained``.
    parts: dict[str, dict[str, Part]]
    # Root mean square by reading, over the stations in contact and trusted in all sweeps.
    disagreement: dict[str, float]
    order: float  # observed order in the speed, halved or doubled twice
    # Whether what is unexplained lies within the uncertainty of the parts, or is less than a tenth
    # of the disagreement.
    closes: bool
    blame: str  # the part that dominates, less what it is uncertain by
    stations: int  # compared stations
    left_out: tuple[str, ...] = ()  # sweeps that diverged, and whose part there is none of

    def to_dict(self) -> dict[str, Any]:
        """What ``motion-budget.json`` holds."""
        return asdict(self)


def slower_and_finer(motion: Motion) -> dict[str, Motion]:
    """The motions of all sweeps by name; ``base`` is the one that the budget is of."""
    same = motion
    if motion.solref is None:
        same = replace(motion, contact_stiffness=motion.stiffness)
    found = {name: replace(same, speed=v) for name, v in _speeds(motion).items()}
    *_, last = found.values()
    found["fine"] = replace(last, timestep=motion.timestep / 2)
    if motion.damping_ratio > 0:
        found["undamped"] = replace(same, damping_ratio=motion.damping_ratio / 2)
    if motion.solref is not None:
        found["ours"] = replace(last, solref=None, solimp=Motion.solimp)
    if motion.solver != "newton":
        found["newton"] = replace(last, solver="newton")
    return found


def _speeds(motion: Motion) -> dict[str, float]:
    """Three of them, the one in question first [L/T1]."""
    v = motion.speed
    if v < _SLOW:
        return {"base": v, "double": 2 * v, "fourfold": 4 * v}
    return {"base": v, "half": v / 2, "quarter": v / 4}


def slower_and_finer_of_model(
    model: OwnModel, motion: Motion
) -> dict[str, tuple[OwnModel, Motion]]:
    """The same of a user's own model, in memory."""
    found = {name: (model, replace(motion, speed=v)) for name, v in _speeds(motion).items()}
    *_, (_, last) = found.values()
    found["fine"] = replace(model, timestep=0.5), last
    found["undamped"] = replace(model, damping=0.5), motion
    found["newton"] = replace(model, solver="newton"), last
    ours = replace(model, contact="ours")
    if model.contact == "own":
        found["ours"] = ours, last
    if motion.solref is None:
        found["stiff"] = replace(ours, timestep=0.5, stiffness=_STIFFER), last
    return found


def motion_budget(
    exact: Readings,
    runs: Mapping[str, Readings],
    tolerances: Tolerances | None = None,
    of_our_chain: bool = False,
) -> MotionBudget:
    """Split the disagreement of ``runs["base"]`` with `exact` into its parts."""
    window = (tolerances or Tolerances()).snap_off_window
    kept = common_stations(exact, [*runs.values()], window)
    shared = Shared(exact, kept)
    run = {name: shared.signal(readings) for name, readings in runs.items()}
    slow, middle, fast = (run[name] for name in THREE_SPEEDS if name in run)
    last = run["quarter" if "quarter" in run else "fourfold"]
    coarse, fine = fast - middle, middle - slow
    order = observed_order(coarse, fine, nominal=1.0, least=_LEAST_ORDER)
    limit = slow - fine / (2**order - 1)
    signals = {"rate": run["base"] - limit}
    unsure = {"rate": SAFETY * rms(slow - limit)}
    if "undamped" in run:
        # As much again as was measured is extrapolated, and as uncertain.
        signals["damping"] = 2 * (run["base"] - run["undamped"])
        signals["rate"] -= signals["damping"]
        unsure["damping"] = rms(run["base"] - run["undamped"])
    signals["time step"] = 2 * (last - run["fine"])  # of first order, as its contacts are
    for name, other in (("contact model", "ours"), ("solver", "newton")):
        if other in run:
            signals[name] = last - run[other]
    if "stiff" in run:  # less what half the time step does
        softer = run.get("ours", last) - (last - run["fine"])
        signals["softness"] = (softer - run["stiff"]) * _STIFFER / (_STIFFER - 1)
        unsure["softness"] = SAFETY * rms(signals["softness"]) / (_STIFFER - 1)
    if "beam" in run:
        signals["beam"] = shared.off(runs["beam"])
    signals["at rest"] = shared.off(runs["rest"])
    total = shared.off(runs["base"])
    signals = with_unexplained(total, signals)
    sizes = {name: rms(part) for name, part in signals.items()}
    uncertainty = {name: unsure.get(name, np.zeros(3)) for name in signals}
    uncertainty["time step"] = sizes["time step"]
    if of_our_chain:
        uncertainty["at rest"] = sizes["at rest"]
    # What is rate and what damping does not matter to what is left.
    left = (u for name, u in uncertainty.items() if name != "damping")
    uncertainty["unexplained"] = root_of_squares(left)
    if "damping" in uncertainty:
        uncertainty["rate"] = np.hypot(uncertainty["rate"], uncertainty["damping"])
    allowed = np.hypot(UNRESOLVED, np.maximum(uncertainty["unexplained"], _LEFT * rms(total)))
    return MotionBudget(
        parts_of((name for name in PARTS if name in sizes), sizes, uncertainty),
        by_reading(total),
        order,
        bool((sizes["unexplained"] <= allowed).all()),
        max(sizes, key=lambda name: float(np.linalg.norm(_sure(sizes[name], uncertainty[name])))),
        int(kept.sum()),
    )


def _sure(size: Floats, uncertainty: Floats) -> Floats:
    return np.maximum(size - uncertainty, 0.0)
