"""Contacts that are as stiff as stated, at rest and in motion."""

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats, Integers

IMPEDANCE = 0.9
"""MuJoCo's d, unless stated; with the stiffness it cancels out of the law at rest."""


def stiffen(
    model: mujoco.MjModel,
    geoms: Integers,
    stiffness: float,
    impedance: float = IMPEDANCE,
    weight: Floats | None = None,
) -> None:
    """Make contacts critically damped, with one impedance, and as stiff as stated at rest.

    At rest MuJoCo's contact force is -k/((1 - d) A) times the distance, with solref = (-k, -b), the
    impedance d of solimp, and A the acceleration by a unit of force: MuJoCo's estimate, if no other
    weight is given.
    """
    if weight is None:
        weight = model.body_invweight0[model.geom_bodyid[geoms], 0]
    with np.errstate(over="ignore"):  # of a motion that is about to diverge
        k = stiffness * (1 - impedance) * weight
    model.geom_solref[geoms, 0] = -k
    model.geom_solref[geoms, 1] = -2 * np.sqrt(k)
    model.geom_solimp[geoms] = [impedance, impedance, 1e-3, 0.5, 2]


def weights_in_last_step(
    model: mujoco.MjModel, data: mujoco.MjData, friction: float
) -> tuple[Integers, Floats]:
    """What MuJoCo took a unit of force to accelerate contacts by in a step of ``discrete``.

    This integrator counts the springs and dampers of a step as inertia, so that with the same
    solref a contact is harder by as much: 4 to 27 times at the tip, which is light, and about twice
    elsewhere. The inertia changes slowly, with the vibrissa's shape.
    """
    h, contact = model.opt.timestep, data.contact
    solved = contact.efc_address >= 0
    rows = contact.efc_address[solved]
    k, b, d = data.efc_KBIP[rows, :3].T
    # A row's own spring and damper act at the end of the step, and count as inertia, too.
    weight = data.efc_diagA[rows] * (1 + h * b + h**2 * k * d)
    if friction and model.opt.cone == mujoco.mjtCone.mjCONE_PYRAMIDAL:
        # The row is that of a pyramid's edge.
        weight = weight * model.opt.impratio / (2 * friction**2 * (1 + friction**2))
    return contact.geom[solved], weight
