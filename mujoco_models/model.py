"""The compiled chain and obstacle: what MuJoCo says of a configuration at rest."""

from typing import NamedTuple

import mujoco
import numpy as np

from analytic.problem.arrays import Floats, Integers
from mujoco_models.chain import Layout, chain_spec
from mujoco_models.obstacle import MESH_PREFIX, Obstacle

_IMPEDANCE = 0.9  # MuJoCo's d; with the stiffness set below it cancels out of the law at rest


class Contacts(NamedTuple):
    """The contacts that MuJoCo reports, loaded or within the gap; arrays of n contacts."""

    bead: Integers
    normal: Floats
    """Away from the obstacle, shape (n, 2)."""
    distance: Floats
    """Negative where the contact is loaded [L]."""


class Clamp(NamedTuple):
    """The clamp's action on the vibrissa, in the world frame, at the foot."""

    force_x: float
    force_y: float
    moment_z: float


class ChainModel:
    """MuJoCo's model and state; everything physical is asked of it.

    Parameters
    ----------
    layout : Layout
        Joints and beads.
    radius : float
        Of the vibrissa [L].
    obstacle : Obstacle
        What it is swept past.
    contact_stiffness : float
        Force over penetration at every bead [EI/L^3].
    """

    def __init__(
        self, layout: Layout, radius: float, obstacle: Obstacle, contact_stiffness: float
    ) -> None:
        self.layout = layout
        self.obstacle = obstacle
        self.contact_stiffness = contact_stiffness
        self.evaluations = 0
        self.model = chain_spec(layout, radius, obstacle).compile()
        self.data = mujoco.MjData(self.model)
        model = self.model
        self._windows = np.array(
            [model.geom(f"{MESH_PREFIX}{i}").id for i in range(len(obstacle.centres))]
        )
        self._beads = np.flatnonzero(model.geom_type == mujoco.mjtGeom.mjGEOM_SPHERE)
        self._bead_of = np.full(model.ngeom, -1)
        self._bead_of[self._beads] = np.arange(len(self._beads))
        self._set_contact_stiffness()
        curvature = obstacle.curvature
        self.contact_curvature = curvature / (1 + radius * curvature)
        """Of the contour that the beads' centres feel, by vertex of the obstacle [1/L]."""
        self.window = -1
        self.use_window(0)
        self._trail: tuple[float, ...] = ()
        self.watched: frozenset[int] = frozenset()
        self.watch(frozenset(range(len(self._beads))))

    def _set_contact_stiffness(self) -> None:
        """The same stiffness at every bead, whatever the time step.

        At rest MuJoCo's contact force is -k/((1 - d) A) times the distance, with solref = (-k, -b),
        impedance d and A the body's `invweight0`: solved here for k.
        """
        weight = self.model.body_invweight0[self.model.geom_bodyid[self._beads], 0]
        k = self.contact_stiffness * (1 - _IMPEDANCE) * weight
        self.model.geom_solref[self._beads] = np.column_stack([-k, -2 * np.sqrt(k)])
        self.model.geom_solimp[self._beads] = [_IMPEDANCE, _IMPEDANCE, 1e-3, 0.5, 2]

    def use_window(self, window: int) -> None:
        """Let the obstacle's mesh with this window, and no other, take part in collisions."""
        if window != self.window:
            self.model.geom_contype[self._windows] = 0
            self.model.geom_contype[self._windows[window]] = 1
            self.window = window

    def anticipate_window(self) -> None:
        """Use the window towards which the contact has been moving."""
        if len(self._trail) == 2:
            before, last = self._trail
            self.use_window(self.obstacle.window_of(2 * last - before))

    def leave_trail(self, vertex: float) -> None:
        """Remember where the contact rests, for `anticipate_window`."""
        self._trail = (*self._trail[-1:], vertex)

    def watch(self, beads: frozenset[int]) -> None:
        """Let these beads, and no others, take part in collisions."""
        if beads != self.watched:
            self.model.geom_conaffinity[self._beads] = 0
            self.model.geom_conaffinity[self._beads[sorted(beads)]] = 1
            self.watched = beads

    def imbalance(self, foot_x: float, angles: Floats) -> Floats:
        """Moment out of balance at each joint, shape (n_joints,) [EI/L], at rest.

        Springs and contacts only: with zero velocity nothing else acts. Contacts and clamp
        readings are then those of this configuration.
        """
        data = self.data
        data.mocap_pos[0, 0] = foot_x
        data.qpos[:] = angles
        data.qvel[:] = 0
        mujoco.mj_forward(self.model, data)
        self.evaluations += 1
        return np.asarray(data.qfrc_passive + data.qfrc_constraint)

    def slide(self, foot_x: float, angles: Floats, far: float, steps: int) -> Floats:
        """Angles after MuJoCo's own motion without momentum, until it rests or `steps` are over.

        `far` is how far a link must have turned for the steps to become ten times longer [rad].
        """
        model, data = self.model, self.data
        model.opt.integrator, model.opt.timestep = mujoco.mjtIntegrator.mjINT_DISCRETE, 1e-3
        data.mocap_pos[0, 0] = foot_x
        data.qpos[:] = angles
        for _ in range(steps):
            before = data.qpos.copy()
            data.qvel[:] = 0
            mujoco.mj_step(model, data)
            if np.abs(data.qpos - before).max() < 1e-10:
                break
            if np.abs(np.cumsum(data.qpos - angles)).max() > far:
                model.opt.timestep = 1e-2
        model.opt.integrator = mujoco.mjtIntegrator.mjINT_EULER
        return np.array(data.qpos)

    def contacts(self) -> Contacts:
        """All reported contacts of the last evaluated configuration."""
        contact = self.data.contact
        if self.data.ncon == 0:
            return Contacts(np.zeros(0, dtype=int), np.zeros((0, 2)), np.zeros(0))
        beads = self._bead_of[contact.geom]
        outward = np.where(beads[:, 0] >= 0, -1.0, 1.0)[:, None]
        return Contacts(beads.max(axis=1), outward * contact.frame[:, :2], contact.dist.copy())

    def joint_positions(self) -> Floats:
        """Shape (n_joints, 2) [L]."""
        return np.asarray(self.data.xanchor[:, :2])

    def bead_positions(self, beads: Integers) -> Floats:
        """Shape (n, 2) [L]."""
        return np.asarray(self.data.geom_xpos[self._beads[beads], :2])

    def clamp(self) -> Clamp:
        """MuJoCo's force and torque sensors at the clamp, turned into the paper's frame.

        The site sits at the foot on the clamped link, its axes those of the world: what it
        transmits to the chain is what the clamp does to the vibrissa.
        """
        fx, fy, _, _, _, mz = self.data.sensordata
        return Clamp(float(fx), float(fy), float(mz))
