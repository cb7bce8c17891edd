"""How stiffly a vibrissa at rest in the plane of its sweep is held in that plane.

The obstacle is a frictionless prism along z: nothing of it holds the vibrissa sideways. What does
is that a turn about the clamp's tangent drags the contact along the contour. In closed form
(`analytic.from_clamp.sideways`) the stiffness is -force_x over the contact's distance from that
tangent, and it changes its sign where the contact passes the lowest point. Here MuJoCo's own
moments give it.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg.lapack import dpotrf

from analytic.numerics.arrays import Floats, Integers
from mujoco_models.model.model import BeamModel

_TURN = 1e-5  # rad, of the differences: good to its square, since both sides of the plane are alike
_ROUNDING = 1e-3  # EI/L; what differences and the corners of a polygon leave of a neutral turn
_ALONG_Z = 0.5  # of a joint's unit axis; it is either 0 or 1


@dataclass(frozen=True)
class Sideways:
    """Resistance of a planar equilibrium to leaving its plane."""

    stiffness: float  # force across the plane over displacement, at the contact [EI/L^3]
    stable: bool  # whether the vibrissa returns to its plane, whichever way it is turned out of it
    # Shape (n, n); Moments of the n joint axes in the plane by turns about them [EI/L].
    joints: Floats
    axes: Integers  # shape (n,); Which of MuJoCo's velocities these are

    def softest(self, count: int) -> Floats:
        """The turns that are resisted least."""
        mode = np.zeros(count)
        mode[self.axes] = np.linalg.eigh(self.joints)[1][:, 0]
        return mode


def sideways(model: BeamModel) -> Sideways:
    """How stiffly the equilibrium in which `model` is, with a loaded contact, is held in its plane.

    The derivative of MuJoCo's own moments by turns out of the plane, by differences; the model is
    left as it was.
    """
    data, count = model.data, model.model.nv
    axes = np.flatnonzero(np.abs(data.cdof[:, 2]) < _ALONG_Z)
    rest = data.qpos.copy()
    joints = np.empty((len(axes), len(axes)))
    # What carries nothing carries nothing in a turn so small either.
    contacts, watched = model.contacts(), model.lookout.watched
    model.lookout.watch(watched.intersection(contacts.touch[contacts.loaded].tolist()))
    for column, axis in enumerate(axes):
        turn = np.zeros(count)
        turn[axis] = _TURN
        model.turn(rest, turn)
        model.relieved(_TURN**2)  # by which a turn lifts a contact
        joints[:, column] = -model.moments()[axes] / _TURN
    model.lookout.watch(watched)
    model.turn(rest, np.zeros(count))
    joints = (joints + joints.T) / 2
    push = model.contact_rise()[axes]
    compliance = float(push @ np.linalg.solve(joints, push))
    _, failed_at = dpotrf(joints + _ROUNDING * np.eye(len(axes)))
    return Sideways(1 / compliance, failed_at == 0, joints, axes)
