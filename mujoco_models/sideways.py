"""Whether a planar equilibrium would stay in its plane if nothing but the obstacle held it there.

A vibrissa of circular section, bent in a plane, can turn as a whole about the tangent at its clamp
without any change of its elastic energy. Turned by a small angle t, a contact at the distance X
from that tangent moves by t X across the plane and by -X t^2/2 along x; the obstacle, a prism along
z, pushes with f sin(alpha) along x. So the energy of this motion is f X sin(alpha) t^2/2: the
planar equilibrium is unstable wherever alpha < 0, long before the planar snap-off. At alpha = 0 the
motion is neutral, since beam and load are then both symmetric about the tangent.
"""

import mujoco
import numpy as np

from mujoco_models.model import BeamModel

_TURN = 1e-5  # rad, of the central differences


def sideways_stiffness(model: BeamModel) -> float:
    """Least stiffness of a cable at rest against leaving the plane of the sweep [EI/L].

    Parameters
    ----------
    model : BeamModel
        Of a beam on ball joints, in an equilibrium; it is left there.

    Returns
    -------
    float
        The least eigenvalue of the derivative of MuJoCo's own moments about x and y by the balls'
        turns about these axes; negative if the planar equilibrium is unstable.
    """
    data = model.data
    rest = data.qpos.copy()
    across = np.flatnonzero(np.arange(model.model.nv) % 3 != 2)
    stiffness = np.empty((len(across), len(across)))
    for column, dof in enumerate(across):
        moments = []
        for turn in (_TURN, -_TURN):
            turned, velocity = rest.copy(), np.zeros(model.model.nv)
            velocity[dof] = turn
            mujoco.mj_integratePos(model.model, turned, velocity, 1.0)
            data.qpos[:] = turned
            mujoco.mj_forward(model.model, data)
            moments.append((data.qfrc_passive + data.qfrc_constraint)[across])
        stiffness[:, column] = (moments[1] - moments[0]) / (2 * _TURN)
    data.qpos[:] = rest
    mujoco.mj_forward(model.model, data)
    return float(np.linalg.eigvalsh((stiffness + stiffness.T) / 2)[0])
