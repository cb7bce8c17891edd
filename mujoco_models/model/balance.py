"""What the rest solver asks of an engine: its balance of moments, its contacts, its clamp.

MuJoCo answers it by `BeamModel`; any other engine that computes the same chain of rigid links can.
"""

from typing import Protocol

from analytic.problem.arrays import Booleans, Floats, Integers
from mujoco_models.beams.layout import Layout
from mujoco_models.model.clamp import Clamp
from mujoco_models.model.contacts import Contacts
from mujoco_models.model.lookout import Lookout
from mujoco_models.obstacles.protocol import Obstacle


class Mechanics(Protocol):
    """Springs, levers and contacts of one configuration: what a step of Newton's method needs."""

    layout: Layout
    """Where joints and beads are."""
    obstacle: Obstacle
    """What the beam is swept past."""
    contact_stiffness: float
    """Force over penetration at every bead [EI/L^3]."""

    def stiffness(self, angles: Floats) -> Floats:
        """Derivative of each joint's elastic moment by its angle.

        Parameters
        ----------
        angles : array, shape (n_joints,)
            Joint angles [rad].

        Returns
        -------
        array, shape (n_joints,)
            Stiffnesses [EI/L].
        """

    def elastic_moments(self) -> Floats:
        """The beam's own moment at each joint.

        Returns
        -------
        array, shape (n_joints,)
            Moments [EI/L].
        """

    def contact_curvature(self, slope: Floats) -> Floats:
        """Curvature of the contour that the beads' centres feel.

        Parameters
        ----------
        slope : array, shape (n,)
            Slope angles [rad].

        Returns
        -------
        array, shape (n,)
            Curvatures [1/L].
        """

    def joint_positions(self) -> Floats:
        """Where the joints are.

        Returns
        -------
        array, shape (n_joints, 2)
            Positions [L].
        """

    def slides(self, contacts: Contacts) -> Booleans:
        """Which contacts are of a link whose beads slide.

        Parameters
        ----------
        contacts : Contacts
            Of the last evaluated configuration.

        Returns
        -------
        array of bool, shape (n,)
            None, if beads never do.
        """


class Balance(Mechanics, Protocol):
    """An engine's model of the beam and the obstacle, at rest; dimensionless, L = EI = 1."""

    lookout: Lookout
    """What takes part in collisions."""
    evaluations: int
    """How often `imbalance` was called."""

    def imbalance(self, foot_x: float, angles: Floats) -> Floats:
        """Moment out of balance at each joint, at rest; what else is asked is of that state.

        Parameters
        ----------
        foot_x : float
            Foot position [L].
        angles : array, shape (n_joints,)
            Joint angles [rad].

        Returns
        -------
        array, shape (n_joints,)
            Moments of springs and contacts [EI/L].

        Raises
        ------
        DivergedError
            If one is not finite.
        """

    def relieved(self) -> Floats:
        """Moment out of balance at each joint, but for what rounding of depths makes of it.

        Returns
        -------
        array, shape (n_joints,)
            Moments of the state last evaluated [EI/L].
        """

    def contacts(self) -> Contacts:
        """The contacts that are loaded or nearly so.

        Returns
        -------
        Contacts
            Of watched beads.
        """

    def contact_places(self) -> Floats:
        """Where the engine has each of these contacts.

        Returns
        -------
        array, shape (n_contacts, 2)
            On the obstacle's surface or between the two surfaces [L].
        """

    def bead_positions(self, beads: Integers) -> Floats:
        """Where beads are.

        Parameters
        ----------
        beads : array of int, shape (n,)
            Their numbers.

        Returns
        -------
        array, shape (n, 2)
            Positions of their centres [L].
        """

    def slide_beads(self, contacts: Contacts) -> bool:
        """Let a bead be where the beam is tangential, if beads are too far apart for the contour.

        Parameters
        ----------
        contacts : Contacts
            Of the last evaluated configuration.

        Returns
        -------
        bool
            True if beads have been moved: the engine's answer is then out of date.
        """

    def hold_beads(self) -> bool:
        """Let all beads be where they were at first.

        Returns
        -------
        bool
            Whether any was elsewhere.
        """

    def clamp(self) -> Clamp:
        """The clamp's action on the vibrissa, as the engine's own sensor or reaction has it.

        Returns
        -------
        Clamp
            In the world frame, at the foot [EI/L^2, EI/L].
        """

    def discrepancy(self) -> float:
        """By how much the clamp's reading differs from contacts and elasticity.

        Returns
        -------
        float
            The worst of all [EI/L^2, EI/L].
        """

    def extension(self) -> float:
        """By how much the beam is longer than it should be, over its length.

        Returns
        -------
        float
            Difference in length [L].
        """
