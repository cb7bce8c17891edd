"""MuJoCo's search for contacts, at no link that is out of the obstacle's reach."""

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats
from mujoco_models.beams.layout import Layout
from mujoco_models.model.surface import CONTACT_GAP, Surface
from mujoco_models.obstacles.protocol import Obstacle


class Search:
    """Past corners all of the beam takes part in collisions, and little of it is near the obstacle.

    MuJoCo would search the whole mesh for every link whose box overlaps the mesh's: that is most of
    them, and ten times the cost. What is left out is out of its contacts' gap, too: nothing that
    MuJoCo says of a configuration depends on it.
    """

    def __init__(
        self, surface: Surface, obstacle: Obstacle, layout: Layout, model: mujoco.MjModel
    ) -> None:
        self._obstacle, self._tip = obstacle, surface.beads[-1]
        self._links = model.geom_bodyid[surface.sides]
        # No place on a link is farther from the nearer one of its ends than that link is long.
        self._reach = CONTACT_GAP + surface.radius + float(layout.lengths.max())

    def __call__(self, model: mujoco.MjModel, data: mujoco.MjData, joints: Floats) -> None:
        """Find the contacts of a configuration."""
        if len(self._links) == 0:
            mujoco.mj_collision(model, data)
            return
        ends = np.concatenate([joints, data.geom_xpos[self._tip : self._tip + 1, :2]])
        near = np.zeros(len(ends), dtype=bool)
        near[self._obstacle.near(ends, self._reach)] = True
        watched = model.body_conaffinity[self._links]
        model.body_conaffinity[self._links] = watched * (near[1:] | near[:-1])
        mujoco.mj_collision(model, data)
        model.body_conaffinity[self._links] = watched
