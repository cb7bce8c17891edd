"""The clamp's action on the vibrissa, by three accounts that must agree."""

from typing import NamedTuple

import mujoco
import numpy as np

from analytic.numerics.arrays import Booleans, Floats
from analytic.numerics.vectors import cross


class Clamp(NamedTuple):
    """The clamp's action on the vibrissa, in the world frame, at the foot [EI/L^2, EI/L]."""

    force_x: float
    force_y: float
    moment_z: float

    @classmethod
    def of(cls, wrench: Floats) -> "Clamp":
        """What of force and moment, shape (2, 3), is in the plane."""
        (fx, fy, _), (_, _, mz) = wrench.tolist()
        return cls(fx, fy, mz)


WEIGHTLESS = Clamp(0.0, 0.0, 0.0)
"""What holds no weight."""


def by_sensors(data: mujoco.MjData) -> Floats:
    """Force and moment at the foot by MuJoCo's sensors, in the world frame, shape (2, 3).

    Their site, the only one, sits at the foot and leans with it: what it transmits to the beam is
    what the clamp does to the vibrissa.
    """
    return np.asarray(data.sensordata.reshape(2, 3) @ data.site_xmat[0].reshape(3, 3).T)


def by_contacts(data: mujoco.MjData, foot: Floats, moves: Booleans) -> Floats:
    """Force and moment at the foot that hold all contact forces, shape (2, 3)."""
    contact = data.contact
    carries = contact.efc_address >= 0  # others carry nothing
    force = data.efc_force[contact.efc_address[carries]]
    force = np.where(moves[contact.geom[carries, 1]], force, -force)
    outward = contact.frame[carries, :3]
    moment = cross(contact.pos[carries] - foot, outward)
    return np.array([-force @ outward, -force @ moment])


def discrepancy(
    sensed: Clamp, required: Clamp, first_joint: Floats, moment: float, base: Clamp = WEIGHTLESS
) -> float:
    """By how much three accounts of the clamp differ in the plane, the worst of all.

    `base` is what holds the weight of the rigid part at the clamp.
    """
    by_contact = max(abs(a - b) for a, b in zip(sensed, required, strict=True))
    x, y = first_joint.tolist()
    force_x, force_y, moment_z = (a - b for a, b in zip(sensed, base, strict=True))
    at_joint = moment_z + y * force_x - x * force_y
    return float(max(by_contact, abs(at_joint - moment)))
