"""What MJX, in single or double precision, says of states that MuJoCo brought to rest."""

from collections.abc import Sequence
from copy import copy
from typing import Any

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
from mujoco import mjx

from engines.precision.state import Evaluated, State, evaluated

_OF_STATE = ("body_pos", "geom_pos", "geom_size", "geom_rbound", "geom_solref")
_STAGES = ("kinematics", "com_pos", "collision", "make_constraint", "fwd_velocity")


def in_single(states: Sequence[State]) -> list[Evaluated]:
    """In 32 bits, as JAX has them unless it is asked."""
    with jax.enable_x64(False):
        return _evaluate(states)


def in_double(states: Sequence[State]) -> list[Evaluated]:
    with jax.enable_x64(True):
        return _evaluate(states)


def _evaluate(states: Sequence[State]) -> list[Evaluated]:
    """All states at once, op by op: compiling the whole takes minutes.

    Every sphere may touch, so that one structure holds all states; where MuJoCo watches fewer, the
    others are out of reach.
    """
    model = copy(states[0].model)
    model.geom_conaffinity[states[0].beads] = 1
    model.body_conaffinity[:] = 1
    model.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_MIDPHASE)
    there, start = mjx.put_model(model), mjx.put_data(model, mujoco.MjData(model))
    own = {
        key: jnp.array([getattr(state.model, key) for state in states], getattr(there, key).dtype)
        for key in _OF_STATE
    }

    def one(own: dict[str, Any], angles: Any) -> tuple[Any, ...]:  # noqa: ANN401  # JAX's arrays
        model, data = there.replace(**own), start.replace(qpos=angles)
        for stage in _STAGES:
            data = getattr(mjx, stage)(model, data)
        contact, push = data._impl.contact, jnp.maximum(data._impl.efc_D * data._impl.efc_aref, 0)
        moments = data.qfrc_passive + push @ data._impl.efc_J
        rows = push[contact.efc_address]
        return contact.geom, contact.dist, contact.frame[:, 0, :2], rows, moments

    angles = jnp.array(np.stack([state.angles for state in states]), start.qpos.dtype)
    columns = [np.asarray(column) for column in jax.vmap(one)(own, angles)]
    return [
        evaluated(state, row[0], *(figures.astype(float) for figures in row[1:]))
        for state, *row in zip(states, *columns, strict=True)
    ]
