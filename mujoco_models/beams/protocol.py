"""What the beams have in common, and the few things in which they differ."""

from typing import Protocol

import mujoco

from analytic.problem.arrays import Floats
from mujoco_models.beams.layout import Layout

FOOT = "foot"


class Beam(Protocol):
    """One of MuJoCo's models of a slender beam, in the plane of the sweep.

    Dimensionless: L = EI = 1. Undeformed it stands along y on a body called `FOOT`. Whatever
    MuJoCo's own coordinates are, a configuration is stated by the angles of the joints, and by the
    tension of the links where these can stretch.
    """

    layout: Layout

    def spec(self, radius: float) -> mujoco.MjSpec:
        """The foot and the beam on it, with all collisions off.

        Parameters
        ----------
        radius : float
            Of the vibrissa [L].
        """

    def mount(self, spec: mujoco.MjSpec, link: int, s: float) -> tuple[mujoco.MjsBody, Floats]:
        """The body that moves with `link` at arc length `s`, and the place in its frame."""

    def stiffen(self, model: mujoco.MjModel) -> None:
        """Set what can only be set once the masses are known."""

    def place(self, data: mujoco.MjData, angles: Floats, tension: Floats) -> None:
        """Set MuJoCo's coordinates.

        Parameters
        ----------
        data : mujoco.MjData
            Its foot has been placed.
        angles : array, shape (n_joints,)
            Of the joints [rad].
        tension : array, shape (n_joints,)
            Of the links [EI/L^2].
        """

    def balance(self, data: mujoco.MjData, force: Floats) -> Floats:
        """A generalised force as moments.

        Parameters
        ----------
        data : mujoco.MjData
            The configuration.
        force : array, shape (nv,)
            In MuJoCo's coordinates.

        Returns
        -------
        array, shape (n_joints,) or longer
            Its moment at each joint, about z; then whatever else the coordinates can feel, at the
            same scale [EI/L].
        """

    def stiffness(self, angles: Floats) -> Floats:
        """Derivative of each joint's elastic moment by its angle, shape (n_joints,) [EI/L]."""

    def joint_positions(self, data: mujoco.MjData) -> Floats:
        """Shape (n_joints, 2) [L]."""
