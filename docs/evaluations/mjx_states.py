"""MuJoCo's states at rest, evaluated by MJX in 64 and 32 bits: ``python -m ...mjx_states CSV``.

All states at once, op by op: compiling the whole takes minutes. Every sphere may touch, so that one
structure holds all states; where MuJoCo watches fewer, the others are out of reach.
"""

from copy import copy
from dataclasses import replace
from importlib.metadata import version

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
import pandas as pd
from mujoco import mjx

from analytic import named_case
from docs.evaluations.bench import out
from mujoco_models import Settings
from mujoco_models.sweep.sweep import set_out

_OF_STATE = ("body_pos", "geom_pos", "geom_size", "geom_rbound", "geom_solref")
_STAGES = ("kinematics", "com_pos", "collision", "make_constraint", "fwd_velocity")


def states(name, segments, stiffnesses, stations=12):
    """Copies of model and state at rest, with all contacts' force and the depths."""
    case = replace(named_case(name), sweep=replace(named_case(name).sweep, stations=stations))
    found = []
    for stiffness in stiffnesses:
        settings = Settings(segments=segments, obstacle="primitive", contact_stiffness=stiffness)
        walk = set_out(case, settings)
        for foot_x in case.foot_x.tolist():
            walk.go_to(foot_x)
            if walk.doubt is None and walk.model.contacts().loaded.any():
                model = walk.model
                depth = model.contacts().distance
                found.append((stiffness, model, copy(model.model), copy(model.data), depth))
    return found


def evaluate(found, bits):
    """Distances, the contacts' forces, and the moments at the joints, a row a state."""
    _, ours, model, data, _ = found[0]
    model = copy(model)
    model.geom_conaffinity[ours.beads] = 1
    model.body_conaffinity[:] = 1
    model.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_MIDPHASE)
    with jax.enable_x64(bits == 64):
        there, state = mjx.put_model(model), mjx.put_data(model, data)
        own = {
            key: jnp.array([getattr(one[2], key) for one in found], getattr(there, key).dtype)
            for key in _OF_STATE
        }

        def one(own, angles):
            m, d = there.replace(**own), state.replace(qpos=angles, qvel=jnp.zeros_like(state.qvel))
            for stage in _STAGES:
                d = getattr(mjx, stage)(m, d)
            push = jnp.maximum(d._impl.efc_D * d._impl.efc_aref, 0)
            return d._impl.contact.dist, push, d.qfrc_passive + push @ d._impl.efc_J

        angles = jnp.array(np.stack([data.qpos for _, _, _, data, _ in found]), state.qpos.dtype)
        return [np.asarray(x, dtype=float) for x in jax.vmap(one)(own, angles)]


if __name__ == "__main__":
    rows = []
    for name in ("parabola", "catenary"):
        found = states(name, 10, (1e4, 1e5, 1e6, 1e7))
        for bits in (64, 32):
            distance, push, moments = evaluate(found, bits)
            seen = [
                {
                    "contact_stiffness": stiffness,
                    "depth_error": abs(distance[i].min() - depth.min()),
                    "force_error": abs(push[i].sum() - data.efc_force.sum()),
                    "load": data.efc_force.sum(),
                    "imbalance": np.abs(moments[i]).max(),
                    "lost": not (distance[i] < 0).any(),
                }
                for i, (stiffness, _, _, data, depth) in enumerate(found)
            ]
            for stiffness, group in pd.DataFrame(seen).groupby("contact_stiffness"):
                rows.append(
                    {
                        "engine": f"MJX {version('mujoco-mjx')}, JAX {jax.__version__}",
                        "case": name, "segments": 10, "bits": bits, "contact_stiffness": stiffness,
                        "states": len(group), "lost": int(group["lost"].sum()),
                        "largest_depth_error": group["depth_error"].max(),
                        "largest_force_error": group["force_error"].max() / group["load"].max(),
                        "largest_imbalance": group["imbalance"].max(),
                    }
                )  # fmt: skip
            pd.DataFrame(rows).to_csv(out(), index=False, float_format="%.3g")
