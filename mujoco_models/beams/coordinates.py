"""Coordinates of a beam on ball joints whose configuration lies in the plane of the sweep."""

import mujoco
import numpy as np

from analytic.problem.arrays import Floats


class Balls:
    """What a beam on balls knows of its planar angles: each ball then turns about z alone.

    A ball's quaternion is (cos a/2, axis sin a/2); its generalised forces are moments about the
    link's own axes, the third of which stays along z.
    """

    def place(self, data: mujoco.MjData, angles: Floats) -> None:
        """Every ball turns about z."""
        data.qpos[:] = 0
        data.qpos[0::4] = np.cos(angles / 2)
        data.qpos[3::4] = np.sin(angles / 2)

    def angles(self, data: mujoco.MjData) -> Floats:
        """Turns of the balls about z."""
        return np.asarray(2 * np.arctan2(data.qpos[3::4], data.qpos[0::4]))

    def moments(self, force: Floats) -> Floats:
        """Those of the balls about z."""
        return force[2::3]
