"""A configuration of the beam, and how far two of them are apart."""

from dataclasses import dataclass

import numpy as np

from analytic.numerics.arrays import Floats
from mujoco_models.model.contact_side import Side


@dataclass(frozen=True)
class State:
    """A configuration of the beam."""

    angles: Floats  # shape (n_joints,); Joint angles [rad]
    forces: dict[int, float]  # contact force by what touches, see `Contacts` [EI/L^2]
    imbalance: float = np.inf  # largest moment out of balance at any joint [EI/L]
    # Whether that is below the tolerance, with the whole beam looking at the obstacle.
    settled: bool = False
    side: Side = Side.AHEAD  # where the beam is then relative to the object
    # Slope angle of the contour at the contact, once settled, if there is one [rad].
    slope: float | None = None

    @classmethod
    def straight(cls, joints: int) -> "State":
        """The unloaded beam."""
        return cls(np.zeros(joints), {})

    @property
    def load(self) -> float:
        """Sum of the contact forces [EI/L^2]."""
        return sum(self.forces.values())

    @property
    def loaded_bead(self) -> float:
        """Mean number of the loaded beads, weighed by their forces."""
        return sum(i * f for i, f in self.forces.items()) / self.load


def turned(angles: Floats, before: Floats) -> float:
    """The farthest that any link has turned."""
    return float(np.abs(np.cumsum(angles - before)).max())
