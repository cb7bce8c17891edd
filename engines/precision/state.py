"""A state that MuJoCo brought to rest, and what another implementation says of it."""

from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import dataclass
from typing import TypeAlias

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats, Integers
from mujoco_models.model.model import BeamModel


@dataclass(frozen=True, eq=False)
class State:
    """A state at rest by itself: the model goes on to the next station."""

    model: mujoco.MjModel  # with foot, object and watched spheres as they are at this station
    angles: Floats  # of its joints
    beads: Integers  # the geoms that may touch the object

    @classmethod
    def of(cls, model: BeamModel) -> "State":
        return cls(copy(model.model), model.data.qpos.copy(), model.beads)


@dataclass(frozen=True, eq=False)
class Evaluated:
    """Contacts and forces of one state, dimensionless: L = EI = 1."""

    # Shape (n_beads,); Of each bead's surface from the obstacle; infinite where no contact is
    # reported [L].
    distance: Floats
    force: Floats  # shape (2,); Of the obstacle on the beam [EI/L^2]
    imbalance: float  # largest moment out of balance at a joint [EI/L]


Evaluate: TypeAlias = Callable[[Sequence[State]], list[Evaluated]]
"""The force of a contact is that of its constraint at zero acceleration, stiffness times depth: a
step would let the contact accelerate, and show a part of that only."""


def evaluated(
    state: State, geoms: Integers, gaps: Floats, normal: Floats, push: Floats, moments: Floats
) -> Evaluated:
    """From contacts: pairs of geoms, distances, normals from the first to the second, forces."""
    bead_of = {geom: i for i, geom in enumerate(state.beads.tolist())}
    distance = np.full(len(state.beads), np.inf)
    force = np.zeros(2)
    for pair, gap, way, size in zip(geoms.tolist(), gaps, normal, push, strict=True):
        second = pair[1] in bead_of
        distance[bead_of[pair[1] if second else pair[0]]] = gap
        force += (1 if second else -1) * size * way
    return Evaluated(distance, force, float(np.abs(moments).max()))
