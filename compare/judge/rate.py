"""How far from rest a sweep in motion may be, by its speed: what its limits grow by."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from analytic.problem.numbers import is_finite_number

if TYPE_CHECKING:  # limits are checked before pandas is needed
    from analytic import Readings
    from analytic.space import SpatialReadings

# (beta L)^4/(2 pi)^2 of a cantilever's first vibration: its mass per length [EI T1^2/L^4].
_MASS = 1.8751040687119611**4 / (2 * math.pi) ** 2


@dataclass(frozen=True)
class Rate:
    """What the speed of the foot does to a sweep; L = T1 = 1, T1 the vibrissa's first period."""

    speed: float  # of the foot [L/T1]
    damping_ratio: float  # of the first vibration, by dampers in proportion to the stiffness
    average: float = 0.0  # of the way between two stations, over which readings are means

    @classmethod
    def of(cls, readings: "Readings | SpatialReadings") -> "Rate | None":
        motion = readings.provenance.get("motion")
        if not isinstance(motion, Mapping):
            return None
        measured = readings.provenance.get("measured")
        of_the_model: Mapping[str, Any] = measured if isinstance(measured, Mapping) else {}
        speed = motion.get("speed")
        damping = of_the_model.get("damping_ratio", motion.get("damping_ratio"))
        if is_finite_number(speed) and is_finite_number(damping) and min(speed, damping) >= 0:
            average = motion.get("average")
            return cls(speed, damping, average if is_finite_number(average) else 0.0)
        return None

    @property
    def lag(self) -> float:
        """Travel of the foot by which dampers delay the moments [L].

        A joint's moment is k (theta + tau theta'), with tau = 2 zeta/omega_1 = zeta T1/pi.
        """
        return self.damping_ratio * self.speed / math.pi

    @property
    def inertia(self) -> float:
        """What the vibrissa's mass at that speed makes of a moment, m v^2 L^2 [EI/L]."""
        return _MASS * self.speed**2

    @property
    def lateness(self) -> float:
        """How late it lets go [L].

        Near the fold M q'' + C q' = a d + b q^2, with d = v t the distance past it: until q runs
        away, d grows to (M v^2)^(2/5) where inertia rules and to (C v)^(2/3) where dampers do, a
        and b of the order of the stiffness K, M = K/omega_1^2, C = K tau. Both at most add.
        """
        inertial: float = (self.speed / (2 * math.pi)) ** 0.8
        damped: float = self.lag ** (2 / 3)
        return inertial + damped


def free_fraction(readings: "Readings") -> float:
    """Fraction of the trusted stations at which nothing touches, as the source recorded."""
    if "phase" not in readings.table or not readings.trusted.any():
        return 0.0
    return float(np.mean(readings.table["phase"][readings.trusted] == "free"))


def soft_tip_fraction(readings: "Readings") -> float:
    """Fraction of the trusted stations whose contact, in Phase B, takes in the tip as well.

    A contact that has sunk in by p spreads over sqrt(2 p R) to either side, R the radius of
    curvature of what it is pressed on, here L. If the tip is that near, the source may call
    tangential what the clamp feels as a contact of the tip.
    """
    table, length = readings.table, readings.beam.length
    if (
        not {"phase", "penetration", "contact_arc_length"} <= set(table)
        or not readings.trusted.any()
    ):
        return 0.0
    short = length - readings.values("contact_arc_length")
    spread = np.sqrt(2 * np.maximum(readings.values("penetration"), 0.0) * length)
    near = (table["phase"] == "tangent").to_numpy() & (short < spread)
    return float(np.mean(near[readings.trusted]))
