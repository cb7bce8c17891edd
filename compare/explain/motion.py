"""The budget of a sweep in motion: what speed and time step add to what is there at rest."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from analytic import CLAMP_READINGS, InputError, Readings
from analytic.problem.arrays import Floats
from compare.explain.budget import UNRESOLVED, Part, common_stations
from compare.judge.tolerances import Tolerances
from compare.sense.noise import scales
from mujoco_models.motion import Motion

PARTS = ("rate", "time step", "at rest", "unexplained")
_SAFETY = 1.25  # Roache's, of an extrapolation from three
_ORDERS = (0.5, 2.0)  # in the speed: of the dampers' moment one, of inertia two, of bounces less
_LEFT = 0.1  # of the disagreement; what may stay unexplained


@dataclass(frozen=True)
class MotionBudget:
    """What the disagreement of a sweep in motion with the closed form is made of.

    Attributes
    ----------
    parts : dict
        `Part` by name and reading: ``rate``, what a slower sweep does not have; ``time step``, what
        a shorter one does not have; ``at rest``, of the same model and contacts; ``unexplained``.
    disagreement : dict
        Root mean square by reading, over the stations in contact and trusted in all sweeps.
    order : float
        Observed order in the speed, halved twice.
    closes : bool
        Whether what is unexplained lies within the uncertainty of the parts, or is less than a
        tenth of the disagreement.
    blame : str
        The part that dominates.
    stations : int
        Compared stations.
    """

    parts: dict[str, dict[str, Part]]
    disagreement: dict[str, float]
    order: float
    closes: bool
    blame: str
    stations: int

    def to_dict(self) -> dict[str, Any]:
        """What ``motion-budget.json`` holds.

        Returns
        -------
        dict
            JSON can hold it.
        """
        return asdict(self)


def slower_and_finer(motion: Motion) -> dict[str, Motion]:
    """The motions of all sweeps by name; ``base`` is the one that the budget is of.

    Parameters
    ----------
    motion : Motion
        Of the base.

    Returns
    -------
    dict of Motion
        ``half`` and ``quarter`` of its speed; ``fine``, a quarter of its speed and half of its time
        step, with contacts of the same stiffness.
    """
    same = motion
    if motion.solref is None:
        same = replace(motion, contact_stiffness=motion.stiffness)
    quarter = replace(same, speed=motion.speed / 4)
    return {
        "base": motion,
        "half": replace(same, speed=motion.speed / 2),
        "quarter": quarter,
        "fine": replace(quarter, timestep=motion.timestep / 2),
    }


def motion_budget(
    exact: Readings, runs: Mapping[str, Readings], tolerances: Tolerances | None = None
) -> MotionBudget:
    """Split the disagreement of ``runs["base"]`` with `exact` into its parts.

    Parameters
    ----------
    exact : Readings
        The reference.
    runs : mapping
        Sweeps by the names of `slower_and_finer`, and ``rest``, over the same stations.
    tolerances : Tolerances, optional
        Only its window before the snap-off is used.

    Returns
    -------
    MotionBudget
        The parts, and what they come to.

    Raises
    ------
    InputError
        If no station is in contact and trusted in all sweeps.
    """
    window = (tolerances or Tolerances()).snap_off_window
    kept = common_stations(exact, [*runs.values()], window)
    if not kept.any():
        raise InputError("stations common to all sweeps of the budget", 0, "some",
                         "see their status: a sweep that chatters has none")  # fmt: skip
    scale = scales(exact)

    def signal(readings: Readings) -> Floats:
        return np.stack([readings.values(name)[kept] / scale[name] for name in CLAMP_READINGS])

    truth, run = signal(exact), {name: signal(readings) for name, readings in runs.items()}
    coarse, fine = run["base"] - run["half"], run["half"] - run["quarter"]
    with np.errstate(divide="ignore", invalid="ignore"):
        observed = np.log2(np.linalg.norm(coarse) / np.linalg.norm(fine))
    order = float(np.clip(np.nan_to_num(observed, nan=1.0), *_ORDERS))
    limit = run["quarter"] - fine / (2**order - 1)
    signals = {
        "rate": run["base"] - limit,
        "time step": 2 * (run["quarter"] - run["fine"]),  # of first order, as its contacts are
        "at rest": run["rest"] - truth,
    }
    total = run["base"] - truth
    signals["unexplained"] = total - np.sum(list(signals.values()), axis=0)
    rms = {name: _rms(part) for name, part in signals.items()}
    uncertainty = {
        "rate": _SAFETY * _rms(run["quarter"] - limit),
        "time step": rms["time step"],
        "at rest": np.zeros(3),
    }
    uncertainty["unexplained"] = np.sqrt(np.sum([u**2 for u in uncertainty.values()], axis=0))
    allowed = np.hypot(UNRESOLVED, np.maximum(uncertainty["unexplained"], _LEFT * _rms(total)))
    return MotionBudget(
        {
            name: {
                reading: Part(float(rms[name][i]), float(uncertainty[name][i]))
                for i, reading in enumerate(CLAMP_READINGS)
            }
            for name in PARTS
        },
        dict(zip(CLAMP_READINGS, _rms(total).tolist(), strict=True)),
        order,
        bool((rms["unexplained"] <= allowed).all()),
        max(PARTS, key=lambda name: float(np.linalg.norm(rms[name]))),
        int(kept.sum()),
    )


def _rms(signals: Floats) -> Floats:
    return np.asarray(np.sqrt(np.mean(signals**2, axis=-1)))
