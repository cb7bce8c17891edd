"""How stiff the contacts of a user's model are, where MuJoCo's step is implicit in them.

An explicit integrator takes a body's inverse mass, which the model states. ``discrete`` counts the
springs and dampers of a step as inertia, the contact's own, too, so that the same solref is up to
ten times harder: a small ball touches each geom for one step, and what MuJoCo took is read off.
"""

from pathlib import Path

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats
from mujoco_models.model.stiffness import weights_in_last_step

_NAME = "vibrissa-probe"
_SIZE = 0.5  # of a geom's radius: it touches no neighbour
_DEPTH = 1e-3  # of a geom's radius


class Probe:
    """A model with a ball that can touch it."""

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model, self._data = model, mujoco.MjData(model)
        self._ball = model.geom(_NAME).id

    def weight(self, geom: int, place: Floats, across: Floats, radius: float) -> float | None:
        """The acceleration by a unit of force that MuJoCo takes for a contact of a geom."""
        data = self._data
        mujoco.mj_resetData(self._model, data)
        size = self._model.geom_size[self._ball, 0]
        data.mocap_pos[-1] = place + (radius * (1 - _DEPTH) + size) * across
        mujoco.mj_step(self._model, data)
        friction, frictionless = self._friction(geom)
        pairs, weights = weights_in_last_step(self._model, data, 0 if frictionless else friction)
        mine = (pairs == geom).any(axis=1) & (pairs == self._ball).any(axis=1)
        return float(weights[mine][0]) if mine.any() else None

    def _friction(self, geom: int) -> tuple[float, bool]:
        """Coefficient of a contact with the ball, whose own is 1, and whether it has none."""
        model = self._model
        if geom < 0:
            rods = np.asarray(model.flex_dim) == 1
            return max(model.flex_friction[rods, 0]), max(model.flex_condim[rods]) == 1
        friction = max(model.geom_friction[[geom, self._ball], 0])
        return friction, max(model.geom_condim[[geom, self._ball]]) == 1


def probe_of(path: Path, radius: float) -> Probe | None:
    """A model with a ball, in memory, if it is stepped by ``discrete``."""
    return probe_in(mujoco.MjSpec.from_file(str(path)), radius)


def probe_in(spec: mujoco.MjSpec, radius: float) -> Probe | None:
    """The same of a model that is to be compiled."""
    if spec.option.integrator != mujoco.mjtIntegrator.mjINT_DISCRETE:
        return None
    ball = spec.worldbody.add_body(name=_NAME, mocap=True)
    ball.add_geom(
        name=_NAME, type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[_SIZE * radius, 0, 0],
        contype=1, conaffinity=1, condim=1, priority=-1,
    )  # fmt: skip
    try:
        return Probe(spec.compile())
    except (ValueError, mujoco.FatalError):
        return None
