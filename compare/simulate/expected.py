"""The error of a measured model's sweep, before it is swept."""

import math
from dataclasses import dataclass

import numpy as np

from compare.simulate.rigidity import (
    as_intended,
    at_its_tip,
    by_its_clamp,
    by_its_links,
    contact_stiffness,
    hand_softens,
    joint_arms,
    smooth_rigidity,
)
from mujoco_models.inspect.measured import MeasuredBeam

SPEED = 0.05
"""Of the sweep that is predicted [L/T1]."""

# What each setting costs, as the worst reading's rms: `mujoco_models/quasi-static.md`, but for the
# contact, of which a part is handed on from link to link.
_LINKS = 0.9  # over the square of their number
_CONTACT = 9.0  # over the stiffness [EI/L^3]
_STEP = 3.1  # of the square of the time step [T1]
_SPEED = 0.06  # of the speed [L/T1] to the power of 1.5
_DAMPING = 0.2  # of the damping ratio, times the speed
_REST = 3e-4
_WITHIN = 3.0  # what random models stay within: 20 of 21 swept (`make models ARGS="30 777 30"`)


@dataclass(frozen=True)
class Expected:
    """The rms of the worst reading of a sweep, relative to its largest magnitude."""

    parts: dict[str, float]

    @property
    def rms(self) -> float:
        return math.hypot(_REST, *self.parts.values())

    @property
    def interval(self) -> tuple[float, float]:
        """Within which sweeps of random models were, but for one that was better."""
        return self.rms / _WITHIN, self.rms * _WITHIN

    def __str__(self) -> str:
        low, high = self.interval
        most = max(self.parts, key=self.parts.__getitem__)
        return f"{self.rms:.1e} rms ({low:.1e} to {high:.1e}), most of it {most}"


def hurry(found: MeasuredBeam) -> float:
    """How many times as fast a uniform vibrissa is moved that lags as much.

    It is the soft end of a cone that lags: by EI at the clamp over that which the tip shows. Of a
    tube with radii of 1 to 0.3 that is 3.3; it let go 0.042 and 0.064 L late at damping ratios of
    0.046 and 0.23, 0.6 of what `Rate.lateness` gives for that, as uniform ones do.
    """
    return float(smooth_rigidity(found, np.zeros(1))[0] / as_intended(found))


def expected(found: MeasuredBeam, speed: float) -> Expected:
    """What a sweep at a speed [L/T1] is off by, of a model without faults."""
    cells = np.array([joint.cell for joint in found.joints])
    bends = cells * joint_arms(found) ** 2 / smooth_rigidity(found)
    cell = np.sqrt(bends @ cells**2 / bends.sum()) / found.length  # of what bends most
    step, speed = found.timestep / found.period, speed * hurry(found)
    own = by_its_clamp(found) / at_its_tip(found) - 1
    return Expected({
        "links": max(_LINKS * cell**2, abs(by_its_links(found) / at_its_tip(found) - 1)),
        "clamp": abs(own - hand_softens(found)),
        "contact": _CONTACT / contact_stiffness(found),
        "time step": _STEP * step**2,
        "speed": _SPEED * speed**1.5,
        "damping": _DAMPING * found.damping_ratio * speed,
    })  # fmt: skip
