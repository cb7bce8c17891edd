"""MuJoCo's chain in another engine, brought to rest by MuJoCo's own rest solver: a twin.

An engine that has kinematics, distances and the forces of its joints is asked for these by
`Linkage`, five methods; what the rest solver wants besides follows from them and is here. So twins
come to rest in the same way, and what is left between their readings is the difference of two
implementations.
"""

import time
from collections.abc import Callable
from dataclasses import asdict
from importlib.metadata import version

import numpy as np

from analytic.numerics.arrays import Floats, Integers
from analytic.problem.case import Case
from analytic.problem.clamp_path import Pose
from analytic.problem.errors import InputError
from analytic.problem.readings import Readings
from analytic.problem.recorder import facing, leftward
from engines.agreement import resultant
from engines.linkage import Maker
from mujoco_models.beams.layout import OF_CURVATURE
from mujoco_models.beams.protocol import Beam
from mujoco_models.errors import DivergedError
from mujoco_models.model import clamp
from mujoco_models.model.balance import Balance
from mujoco_models.model.contacts import Contacts
from mujoco_models.model.lookout import Lookout
from mujoco_models.model.surface import CONTACT_GAP
from mujoco_models.obstacles.protocol import Obstacle
from mujoco_models.settings import Settings


def sweep_twin(
    case: Case,
    settings: Settings,
    name: str,
    engine: str,
    maker: Callable[[], Maker],
    advance: Callable[[], None] = lambda: None,
) -> Readings:
    """Sweep a case with a twin.

    Parameters
    ----------
    case : Case
        The problem, whichever way its foot moves.
    settings : Settings
        The numerics, those of MuJoCo's chain.
    name : str
        What ``--engine`` calls it.
    engine : str
        Its name and version, for the provenance.
    maker : callable
        Imports the engine and returns what makes its linkage.
    advance : callable
        Called after every station.

    Returns
    -------
    Readings
        As those of MuJoCo's chain.

    Raises
    ------
    InputError
        For what only MuJoCo's links or sliding beads can touch.
    """
    from mujoco_models.model.parts import parts_at_rest
    from mujoco_models.sweep.sweep import follow
    from mujoco_models.sweep.walk import Walk

    case.require_upright(name)
    if not settings.elsewhere:
        kind = settings.beam if settings.planar else f"{settings.beam} out of the plane"
        allowed = "'chain' in the plane, on linear springs"
        raise InputError(f"beam for {name}", repr(kind), allowed, "take --beam chain")
    begun, swept = time.process_time(), leftward(case)
    beam, obstacle = parts_at_rest(swept, settings, name)
    _check(beam, obstacle, name)
    twin = Twin(maker(), beam, swept.radius, obstacle, settings.contact_stiffness)
    walk = Walk(twin, swept, settings.tolerance)
    about = {
        "engine": f"{engine}, vibrissa-testbed {version('vibrissa-testbed')}",
        "settings": asdict(settings),
    }
    return facing(case, follow(swept, walk, f"{name} chain", about, begun, advance))


class Twin(Balance):
    """See `mujoco_models.model.balance.Balance`."""

    def __init__(
        self, make: Maker, beam: Beam, radius: float, obstacle: Obstacle, contact_stiffness: float
    ) -> None:
        self.layout, self.obstacle, self._beam, self.radius = beam.layout, obstacle, beam, radius
        self.contact_stiffness, self.evaluations = contact_stiffness, 0
        self.radii = radius * self.layout.vibrissa.thickness(self.layout.beads)
        self._linkage = make(beam, self.radii, obstacle, contact_stiffness)
        self.pose, self._window = Pose(*np.zeros(3)), 0
        self._watched: frozenset[int] = frozenset()
        self._joints, self._places = self._linkage.place(0.0, np.zeros(len(self.layout.joints)))
        self._contacts = self._at_beads([])
        self.lookout = Lookout(self, obstacle, radius, self.layout)

    def show(self, window: int) -> None:
        self._window = window
        self._linkage.attend(window, self._watched)

    def collide(self, beads: frozenset[int]) -> None:
        """Let these beads, and no others, touch the obstacle."""
        self._watched = beads
        self._linkage.attend(self._window, beads)

    def imbalance(self, pose: Pose, angles: Floats) -> Floats:
        if not np.isfinite(angles).all():
            raise DivergedError("the joint angles are not finite")
        self.pose, self.evaluations = pose, self.evaluations + 1
        self._joints, self._places = self._linkage.place(float(pose.foot_x), angles)
        near = self.obstacle.near(self._places, self.radius + CONTACT_GAP).tolist()
        self._contacts = self._at_beads([i for i in near if i in self._watched])
        found, loaded = self._contacts, self._contacts.loaded
        push = -self.contact_stiffness * found.distance[:, None] * found.normal
        beads, self._forces = found.touch[loaded], push[loaded]
        self._elastic, contacts = self._linkage.moments(beads, self._forces)
        self._moments = self._elastic + contacts
        if not np.isfinite(self._moments).all():
            raise DivergedError("the moments at the joints are not finite")
        return self._moments

    def _at_beads(self, beads: list[int]) -> Contacts:
        """Contacts of beads by normal and distance, none of a link's side."""
        gaps = [self._linkage.gap(i) for i in beads]
        number, no = np.array(beads, dtype=int), np.zeros(len(beads), dtype=bool)
        outward = np.array([x for x, _ in gaps]).reshape(-1, 2)
        return Contacts(
            touch=number,
            link=self.layout.links[number],
            on_side=no,
            point=self.bead_positions(number),
            arc_length=self.layout.beads[number],
            normal=outward / np.hypot(*outward.T)[:, None],
            distance=np.array([distance for _, distance in gaps]),
            fused=no,
            passed=False,
        )

    def relieved(self) -> Floats:
        """As they are: nothing accelerates."""
        return self._moments

    def contacts(self) -> Contacts:
        return self._contacts

    def contact_places(self) -> Floats:
        """Between the two surfaces, as MuJoCo's."""
        found = self._contacts
        depth = self.radii[found.touch] + found.distance / 2
        return np.asarray(found.point - depth[:, None] * found.normal)

    def stiffness(self, angles: Floats) -> Floats:
        return self._beam.stiffness(angles)

    def elastic_moments(self) -> Floats:
        return self._elastic

    def joint_positions(self) -> Floats:
        return self._joints

    def bead_positions(self, beads: Integers) -> Floats:
        return np.asarray(self._places[beads])

    def clamp(self) -> clamp.Clamp:
        return self._linkage.clamp()

    def discrepancy(self) -> float:
        """By how much that differs from the contacts and from the first spring."""
        arm = self._contacts.point[self._contacts.loaded] - [self.pose.foot_x, 0.0]
        required = clamp.Clamp(*(-resultant(arm, self._forces)).tolist())
        first = float(self._elastic[0])
        return clamp.discrepancy(self.clamp(), required, self.layout.base[0], first)

    def extension(self) -> float:
        ends = np.vstack([self._joints, self._places[-1]])
        bent = np.hypot(*np.diff(ends, axis=0).T).sum()
        return float(bent + self.layout.joints[0] - 1 + self.layout.arched)


def _check(beam: Beam, obstacle: Obstacle, name: str) -> None:
    """Raise InputError for what only MuJoCo's links or sliding beads can touch."""
    if len(obstacle.corners):
        allowed = "smooth, or a mesh whose facets turn by less than 2e-3 rad"
        remedy = f"leave {name} out, or round the object"
        raise InputError(f"object for {name}", "with sharp corners", allowed, remedy)
    layout = beam.layout
    spacing = float((layout.lengths / np.bincount(layout.links)).max())
    least = spacing / (2 * OF_CURVATURE)
    if obstacle.largest_curvature * least > 1:
        raise InputError(
            f"smallest radius of curvature of the object for {name}",
            f"{1 / obstacle.largest_curvature:.2g} L",
            f"at least {least:.2g} L: spheres {spacing:.1g} L apart are too far apart for less",
            f"leave {name} out, or enlarge the object",
        )
