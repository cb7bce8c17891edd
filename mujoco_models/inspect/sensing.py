"""The sensors of a model with its state."""

import mujoco
import numpy as np

from analytic.problem.arrays import Floats


class Sensing:
    """A model and its state, as far as force and torque sensors go."""

    model: mujoco.MjModel  # both of MuJoCo
    data: mujoco.MjData  # both of MuJoCo

    def sensed(self, sensor: int) -> Floats:
        """What a sensor reads."""
        first = self.model.sensor_adr[sensor]
        return np.array(self.data.sensordata[first : first + 3])

    def site(self, sensor: int) -> tuple[Floats, Floats]:
        """Where the site of a sensor is, and how it is turned."""
        site = self.model.sensor_objid[sensor]
        return np.array(self.data.site_xpos[site]), self.data.site_xmat[site].reshape(3, 3).copy()
