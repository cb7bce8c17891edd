"""The clamp's action on the vibrissa, by three accounts that must agree."""

from typing import NamedTuple

import mujoco
import numpy as np

from analytic.problem.arrays import Booleans, Floats


class Clamp(NamedTuple):
    """The clamp's action on the vibrissa, in the world frame, at the foot [EI/L^2, EI/L]."""

    force_x: float
    force_y: float
    moment_z: float


def by_sensors(data: mujoco.MjData) -> Clamp:
    """MuJoCo's force and torque sensors at the clamp.

    Their site sits at the foot, its axes are those of the world: what it transmits to the beam is
    what the clamp does to the vibrissa.

    Parameters
    ----------
    data : mujoco.MjData
        An evaluated configuration.

    Returns
    -------
    Clamp
        What the sensors read.
    """
    fx, fy, _, _, _, mz = data.sensordata
    return Clamp(float(fx), float(fy), float(mz))


def by_contacts(data: mujoco.MjData, foot: Floats, moves: Booleans) -> Clamp:
    """The wrench at the foot that holds all contact forces.

    Parameters
    ----------
    data : mujoco.MjData
        An evaluated configuration; its contacts are frictionless.
    foot : array, shape (2,)
        Position of the foot [L].
    moves : array of bool, shape (ngeom,)
        Whether each geom is one of the beam's.

    Returns
    -------
    Clamp
        By equilibrium of the whole vibrissa.
    """
    contact = data.contact
    carries = contact.efc_address >= 0  # others carry nothing
    force = data.efc_force[contact.efc_address[carries]]
    force = np.where(moves[contact.geom[carries, 1]], force, -force)
    x, y = contact.frame[carries, :2].T
    across, along = (contact.pos[carries, :2] - foot).T
    return Clamp(*(-float(force @ part) for part in (x, y, across * y - along * x)))


def discrepancy(sensed: Clamp, required: Clamp, first_joint: Floats, moment: float) -> float:
    """By how much three accounts of the clamp differ, the worst of all.

    Parameters
    ----------
    sensed, required : Clamp
        By the sensors and by the contacts.
    first_joint : array, shape (2,)
        Where the beam's first joint is, seen from the foot: the sensors' wrench is carried there
        [L].
    moment : float
        The beam's own elastic moment there [EI/L].

    Returns
    -------
    float
        Largest difference [EI/L^2, EI/L].
    """
    by_contact = max(abs(a - b) for a, b in zip(sensed, required, strict=True))
    x, y = first_joint.tolist()
    at_joint = sensed.moment_z + y * sensed.force_x - x * sensed.force_y
    return float(max(by_contact, abs(at_joint - moment)))
