"""The budget of a sweep in motion: what motion and contacts add to what is there at rest."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from analytic import Readings
from compare.explain.parts import LEFT, SAFETY, SMALL, Account, Parted, Shared, observed_order
from compare.measure.disagreement import rms
from mujoco_models.motion import Motion
from mujoco_models.user_model.names import OwnModel

OPTIONAL = ("undamped", "ours", "newton", "stiff")
"""Sweeps without which a budget has one part less."""
THREE_SPEEDS = ("quarter", "half", "base", "double", "fourfold")
"""The three sweeps of a budget that differ in speed are next to each other here, slowest first."""
_LEAST_ORDER = 0.5  # in the speed: of the dampers' moment one, of inertia two, of bounces less
_SLOW = 0.02  # L/T1; a quarter of it takes minutes, and says no more of the limit
_STIFFER = 4  # times the contact stiffness, which half a time step stands as well


@dataclass(frozen=True, repr=False)
class MotionBudget(Parted):
    """What the disagreement of a sweep in motion with the closed form is made of.

    Its parts are those that there are sweeps for: ``damping``, in proportion to the
    damping ratio; ``rate``, what else a slower sweep does not have; ``time step``, what a shorter
    one does not have; ``contact model``, of the user's contacts instead of ours; ``softness``, of
    ours in a user's model instead of hard ones; ``solver``, of another one than Newton's, or of its
    iterations; ``beam``, of what was measured instead of what is stated; ``at rest``, of the same
    model and our contacts. The one to blame dominates less what it is uncertain by.
    """

    left_out: tuple[str, ...] = ()  # sweeps that diverged, and whose part there is none of


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
    exact: Readings, runs: Mapping[str, Readings], of_our_chain: bool = False
) -> MotionBudget:
    """Split the disagreement of ``runs["base"]`` with `exact` into its parts."""
    shared = Shared.of(exact, *runs.values())
    account = Account(shared, runs)
    run = account.run
    slow, middle, fast = (run[name] for name in THREE_SPEEDS if name in run)
    last = run["quarter" if "quarter" in run else "fourfold"]
    order = observed_order(fast - middle, middle - slow, nominal=1.0, least=_LEAST_ORDER)
    limit = slow - (middle - slow) / (2**order - 1)
    rate, slowest = run["base"] - limit, SAFETY * rms(slow - limit)
    # As much again of damping as was measured is extrapolated, and as uncertain.
    damped = run["base"] - run.get("undamped", run["base"])
    account.add("rate", rate - 2 * damped, slowest)
    if "undamped" in run:
        account.add("damping", 2 * damped)
    # Of first order, as its contacts are.
    account.add_uncertain("time step", 2 * (last - run["fine"]))
    if "ours" in run:
        account.add("contact model", last - run["ours"])
    if "stiff" in run:  # less what half the time step does
        softer = run.get("ours", last) - (last - run["fine"])
        account.add_extrapolated("softness", softer, run["stiff"], _STIFFER)
    if "newton" in run:
        account.add("solver", last - run["newton"])
    if "beam" in run:
        account.add("beam", shared.off(runs["beam"]))
    at_rest = shared.off(runs["rest"])
    account.add("at rest", at_rest, rms(at_rest) if of_our_chain else 0.0)
    left, unsure = account.settle()
    if "undamped" in run:  # what is rate and what damping does not matter to what is left
        account.add("rate", rate - 2 * damped, np.hypot(slowest, rms(damped)))
        account.add("damping", 2 * damped, rms(damped))
    allowed = np.hypot(SMALL, np.maximum(unsure, LEFT * rms(account.total)))
    return MotionBudget(
        **account.common(),
        order=order,
        closes=bool((left <= allowed).all()),
        blame=account.blame(sure=True),
    )
