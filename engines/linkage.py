"""What an engine supplies that has kinematics, distances and forces: five methods."""

from collections.abc import Callable
from typing import Protocol, TypeAlias

from analytic.numerics.arrays import Floats, Integers
from mujoco_models.beams.protocol import Beam
from mujoco_models.model.clamp import Clamp
from mujoco_models.obstacles.protocol import Obstacle


class Linkage(Protocol):
    """What an engine supplies; dimensionless, L = EI = 1, in the plane of the sweep.

    Links on hinges with springs, spheres ("beads") that touch the obstacle, and a foot.
    """

    def attend(self, window: int, beads: frozenset[int]) -> None:
        """Let the obstacle be what it has for a window, and these beads touch it.

        Parameters
        ----------
        window : int
            See `Obstacle.window_of`.
        beads : frozenset of int
            No others are asked for; an engine that touches by itself must leave out all others.
        """

    def place(self, foot_x: float, angles: Floats) -> tuple[Floats, Floats]:
        """Put foot and joints somewhere; all else is asked of that configuration.

        Parameters
        ----------
        foot_x : float
            Foot position [L].
        angles : array, shape (n_joints,)
            Of the joints [rad].

        Returns
        -------
        joints : array, shape (n_joints, 2)
            Where the joints are [L].
        beads : array, shape (n_beads, 2)
            Where the centres of beads are [L].
        """

    def gap(self, bead: int) -> tuple[Floats, float]:
        """How far a bead is from the obstacle.

        Parameters
        ----------
        bead : int
            Its number.

        Returns
        -------
        normal : array, shape (2,)
            Outwards from the obstacle.
        distance : float
            Of the bead's surface, negative inside [L].
        """

    def moments(self, beads: Integers, forces: Floats) -> tuple[Floats, Floats]:
        """Take up the contacts' forces.

        Parameters
        ----------
        beads : array of int, shape (n,)
            That are pushed.
        forces : array, shape (n, 2)
            Contact stiffness times depth, along the normal, at the beads' centres; an engine with a
            compliant contact of its own may go by that [EI/L^2].

        Returns
        -------
        springs, contacts : array, shape (n_joints,)
            Moments at the joints [EI/L].
        """

    def clamp(self) -> Clamp:
        """Read the clamp, after `moments`.

        Returns
        -------
        Clamp
            Its action on the vibrissa, at the foot, as the engine's own reaction has it.
        """


Maker: TypeAlias = Callable[[Beam, Floats, Obstacle, float], Linkage]
"""Makes it from the beam, the beads' radii [L], the obstacle, and the contact stiffness."""
