"""What MuJoCo Warp, in single precision, says of a configuration that MuJoCo brought to rest."""

from collections.abc import Iterator
from contextlib import contextmanager
from copy import copy
from dataclasses import dataclass

import mujoco
import mujoco_warp
import numpy as np
import warp

from analytic.problem.arrays import Floats
from mujoco_models.model.model import BeamModel
from mujoco_models.obstacles.protocol import GEOM

_CONTACTS, _ROWS = 256, 256  # that Warp has room for; the beads that are near are fewer


@dataclass(frozen=True)
class Evaluated:
    """Contacts and forces of one configuration, dimensionless: L = EI = 1."""

    # Shape (n_beads,); Of each bead's surface from the obstacle; infinite where Warp reports no
    # contact [L].
    distance: Floats
    force: Floats  # shape (2,); Of the obstacle on the beam [EI/L^2]
    imbalance: float  # largest moment out of balance at a joint [EI/L]


@contextmanager
def _quiet() -> Iterator[None]:
    """Not a line for each kernel that is compiled."""
    before, warp.config.log_level = warp.config.log_level, warp.LOG_ERROR
    try:
        yield
    finally:
        warp.config.log_level = before


@_quiet()
def evaluate(model: BeamModel) -> Evaluated:
    """Evaluate the configuration that a model of MuJoCo's is in, at rest.

    Warp's own kinematics, collisions, springs and constraints. The force of a contact is that of
    its constraint at zero acceleration, stiffness times depth. A step of Warp's would let
    the contact accelerate, and show a part of that only.
    """
    compiled = _for_warp(model)
    there = mujoco_warp.put_model(compiled)
    state = mujoco_warp.put_data(compiled, model.data, nconmax=_CONTACTS, njmax=_ROWS)
    mujoco_warp.fwd_position(there, state)
    mujoco_warp.fwd_velocity(there, state)
    number = int(state.nacon.numpy()[0])
    contact = state.contact
    geoms, gaps = contact.geom.numpy()[:number], contact.dist.numpy()[:number].astype(float)
    normal = contact.frame.numpy()[:number, 0, :2].astype(float)
    distance = np.full(len(model.beads), np.inf)
    bead_of = {geom: i for i, geom in enumerate(model.beads.tolist())}
    rows, efc = contact.efc_address.numpy()[:number, 0], state.efc
    push = np.maximum((efc.D.numpy() * efc.aref.numpy())[0].astype(float), 0)
    push[int(state.nefc.numpy()[0]) :] = 0
    force = np.zeros(2)
    for i, pair in enumerate(geoms.tolist()):
        second = pair[1] in bead_of  # Warp's normal is from the first geom to the second
        distance[bead_of[pair[1] if second else pair[0]]] = gaps[i]
        if rows[i] >= 0:
            force += (1 if second else -1) * push[rows[i]] * normal[i]
    jacobian = efc.J.numpy()[0, : len(push), : model.model.nv].astype(float)
    moments = state.qfrc_passive.numpy()[0].astype(float) + push[: len(jacobian)] @ jacobian
    return Evaluated(distance, force, float(np.abs(moments).max()))


def _for_warp(model: BeamModel) -> mujoco.MjModel:
    """A copy with what Warp needs, and without the option that it refuses.

    Its broad phase goes by the boxes of geoms, which MuJoCo has from before the cylinder was
    placed.
    """
    compiled = copy(model.model)
    compiled.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_MIDPHASE)
    cylinder = compiled.geom(GEOM).id
    radius, half_length = compiled.geom_size[cylinder, :2]
    compiled.geom_aabb[cylinder] = [0, 0, 0, radius, radius, half_length]
    return compiled
