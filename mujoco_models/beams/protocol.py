"""What the beams have in common, and the few things in which they differ."""

from collections.abc import Callable
from typing import Protocol, TypeAlias

import mujoco

from analytic.numerics.arrays import Floats
from mujoco_models.beams.layout import Layout

# Moved by its place in the model. Not a mocap body: 3.17's cable measures its segments before the
# places of mocap bodies are known, and its stiffness is then off, or not a number, at random.
FOOT = "foot"
Furnish = Callable[[mujoco.MjsBody, int], None]
"""Given each link's body and number, adds what the link carries."""
Law: TypeAlias = Callable[[Floats], tuple[Floats, Floats | float]]
"""Maps the joints' angles to the first two derivatives of their energies, over EI/h."""


def bare(body: mujoco.MjsBody, link: int) -> None:
    """A link that carries nothing."""


class Beam(Protocol):
    """One of MuJoCo's models of a slender beam.

    Dimensionless: L = EI = 1. Undeformed it stands along y on a fixed body called `FOOT`, and a
    configuration in the plane of the sweep is stated by the angles of its joints, shape
    (n_joints,), whatever MuJoCo's own coordinates are. All its links are rigid, so it keeps its
    length.
    """

    layout: Layout
    """Where its joints and beads are."""

    def spec(self, radius: float, furnish: Furnish = bare) -> mujoco.MjSpec:
        """The foot and the beam of a radius [L] on it, with all collisions off."""

    def body(self, spec: mujoco.MjSpec, link: int) -> mujoco.MjsBody:
        """The body of that spec that moves with a link."""

    def within(self, link: int, s: Floats) -> Floats:
        """Where on the body of a link arc lengths are, in its frame, shape (n, 3) [L]."""

    def place(self, data: mujoco.MjData, angles: Floats) -> None:
        """Set MuJoCo's coordinates."""

    def angles(self, data: mujoco.MjData) -> Floats:
        """Joint angles of MuJoCo's coordinates, in a planar configuration [rad]."""

    def moments(self, force: Floats) -> Floats:
        """Moment about z at each joint, of a generalised force of MuJoCo's [EI/L]."""

    def stiffness(self, angles: Floats) -> Floats:
        """Derivative of each joint's elastic moment by its angle [EI/L]."""


class SpatialBeam(Beam, Protocol):
    """A straight one that bends in space, and the second derivative of its energy."""

    @property
    def law(self) -> Law | None:
        """Of joints that bend alike in all directions; None of others."""

    def blocks(self, configuration: Floats) -> Floats:
        """Second derivative of each joint's energy by its d velocities, shape (n_joints, d, d)."""

    def bent(self, frame: Floats, side: Floats, angles: Floats) -> Floats:
        """MuJoCo's coordinates where the links lie in a plane with the clamp, without twist.

        They turn by angles from the clamp's tangent, the second column of the foot's frame, to a
        side across it.
        """
