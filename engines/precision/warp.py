"""What MuJoCo Warp, in single precision, says of states that MuJoCo brought to rest."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from copy import copy

import mujoco
import mujoco_warp
import numpy as np
import warp

from engines.precision.state import Evaluated, State, evaluated
from mujoco_models.obstacles.protocol import GEOM

_CONTACTS, _ROWS = 256, 256  # that Warp has room for; the beads that are near are fewer


@contextmanager
def _quiet() -> Iterator[None]:
    """Not a line for each kernel that is compiled."""
    before, warp.config.log_level = warp.config.log_level, warp.LOG_ERROR
    try:
        yield
    finally:
        warp.config.log_level = before


@_quiet()
def evaluate(states: Sequence[State]) -> list[Evaluated]:
    """By Warp's own kinematics, collisions, springs and constraints."""
    return [_evaluate(state) for state in states]


def _evaluate(state: State) -> Evaluated:
    model, data = _for_warp(state.model), mujoco.MjData(state.model)
    data.qpos[:] = state.angles
    mujoco.mj_forward(model, data)
    there = mujoco_warp.put_model(model)
    found = mujoco_warp.put_data(model, data, nconmax=_CONTACTS, njmax=_ROWS)
    mujoco_warp.fwd_position(there, found)
    mujoco_warp.fwd_velocity(there, found)
    number, efc = int(found.nacon.numpy()[0]), found.efc
    contact = found.contact
    geoms, gaps = contact.geom.numpy()[:number], contact.dist.numpy()[:number].astype(float)
    normal = contact.frame.numpy()[:number, 0, :2].astype(float)
    rows = contact.efc_address.numpy()[:number, 0]
    push = np.maximum((efc.D.numpy() * efc.aref.numpy())[0].astype(float), 0)
    push[int(found.nefc.numpy()[0]) :] = 0
    jacobian = efc.J.numpy()[0, : len(push), : model.nv].astype(float)
    moments = found.qfrc_passive.numpy()[0].astype(float) + push[: len(jacobian)] @ jacobian
    return evaluated(state, geoms, gaps, normal, np.where(rows < 0, 0.0, push[rows]), moments)


def _for_warp(model: mujoco.MjModel) -> mujoco.MjModel:
    """A copy with what Warp needs, and without the option that it refuses.

    Its broad phase goes by the boxes of geoms, which MuJoCo has from before the cylinder was
    placed.
    """
    compiled = copy(model)
    compiled.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_MIDPHASE)
    cylinder = compiled.geom(GEOM).id
    radius, half_length = compiled.geom_size[cylinder, :2]
    compiled.geom_aabb[cylinder] = [0, 0, 0, radius, radius, half_length]
    return compiled
