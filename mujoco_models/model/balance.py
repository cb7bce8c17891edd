"""What the rest solver asks of an engine: its balance of moments, its contacts, its clamp.

MuJoCo answers it by `BeamModel`; any other engine that computes the same chain of rigid links can.
All is dimensionless, L = EI = 1, in the plane of the sweep, and of the configuration that was
evaluated last. Arrays have a row for each joint, bead or contact.
"""

from typing import Protocol

import numpy as np

from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.problem.clamp_path import Pose
from mujoco_models.beams.layout import Layout
from mujoco_models.model.clamp import Clamp
from mujoco_models.model.contacts import Contacts
from mujoco_models.model.lookout import Lookout
from mujoco_models.obstacles.protocol import Obstacle


class Mechanics(Protocol):
    """Springs, levers and contacts of one configuration: what a step of Newton's method needs."""

    layout: Layout
    """Where joints and beads are."""
    pose: Pose
    """Of the clamp, in the configuration that was evaluated last."""
    obstacle: Obstacle
    """What the beam is swept past."""
    radius: float
    """Of the vibrissa at its clamp [L]."""
    contact_stiffness: float
    """Force over penetration at every bead [EI/L^3]."""

    def stiffness(self, angles: Floats) -> Floats:
        """Derivative of each joint's elastic moment by its angle [EI/L]."""

    def elastic_moments(self) -> Floats:
        """The beam's own moment at each joint [EI/L]."""

    def contact_curvature(self, slope: Floats) -> Floats:
        """Curvature that the beads' centres feel where the contour has these slope angles [1/L]."""
        curvature = self.obstacle.curvature(slope)
        return np.asarray(curvature / (1 + self.radius * curvature))

    def joint_positions(self) -> Floats:
        """Where the joints are, shape (n_joints, 2) [L]."""

    def slides(self, contacts: Contacts) -> Booleans:
        """Which contacts are of a link whose beads slide; none, if beads never do."""
        return np.zeros(len(contacts.link), dtype=bool)


class Balance(Mechanics, Protocol):
    """An engine's model of the beam and the obstacle, at rest, whose beads stay where they are."""

    lookout: Lookout
    """What takes part in collisions."""
    evaluations: int
    """How often `imbalance` was called."""

    def imbalance(self, pose: Pose, angles: Floats) -> Floats:
        """Moment of springs and contacts at each joint; DivergedError if one is not finite."""

    def relieved(self) -> Floats:
        """The same, but for what rounding of depths makes of it."""

    def contacts(self) -> Contacts:
        """Those of watched beads that are loaded or nearly so."""

    def contact_places(self) -> Floats:
        """Where the engine has each of them, on the obstacle or between the two surfaces [L]."""

    def bead_positions(self, beads: Integers) -> Floats:
        """Where the centres of beads are, shape (n, 2) [L]."""

    def slide_beads(self, contacts: Contacts) -> bool:
        """Let a bead be where the beam is tangential, if beads are too far apart for the contour.

        If any has been moved, the engine's answer is out of date.
        """
        return False

    def hold_beads(self) -> bool:
        """Let all beads be where they were at first; whether any was elsewhere."""
        return False

    def clamp(self) -> Clamp:
        """The clamp's action on the vibrissa, as the engine's own sensor or reaction has it."""

    def discrepancy(self) -> float:
        """By how much that differs from contacts and elasticity, the worst of all."""

    def extension(self) -> float:
        """By how much the beam is longer than it should be, over its length."""
