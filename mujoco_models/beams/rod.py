"""The vibrissa as MuJoCo's one-dimensional flex with elasticity, a discrete elastic rod: 4.x only.

Its coordinates are the places of its vertices. Bending acts at the vertices with the energy
(2 EI/h) tan^2(theta/2); edges keep their length by an equality constraint, which is a stiff spring
at rest. Two pinned vertices make the clamp: with the first edge from -h/2 to +h/2 the rod is of
second order, with that edge beginning at the clamp (the naive rod) of first.

MuJoCo leaves the contacts of a flex out of what its force sensors feel. So the flex itself does not
collide: spheres on the bodies of its vertices do, and the sensors at the clamp read right.
"""

import mujoco
import numpy as np

from analytic.problem.arrays import Floats
from mujoco_models.beams.layout import Layout
from mujoco_models.beams.protocol import FOOT
from mujoco_models.beams.strip import half_cell_off
from mujoco_models.settings import Settings

_AXIAL_STIFFNESS = 3e6  # EA in EI/L^2; the largest loads, near 20, stretch the rod by 7e-6 L
_IMPEDANCE = 0.9  # MuJoCo's d; with the stiffness set below it cancels out of the law at rest
_XML = """
<mujoco>
  <worldbody>
    <body name="{foot}" mocap="true">
      <flexcomp name="rod" type="direct" dim="1" radius="{radius!r}" mass="1e-3"
                point="{points}" element="{elements}">
        <pin id="0 1"/>
        <edge equality="true"/>
        <elasticity young="{young!r}"/>
        <contact contype="0" conaffinity="0" selfcollide="none"/>
      </flexcomp>
    </body>
  </worldbody>
</mujoco>
"""


class Rod:
    """A one-dimensional flex; see `mujoco_models.beams.protocol.Beam`."""

    def __init__(self, settings: Settings) -> None:
        self._vertices = half_cell_off(settings)
        cell = float(self._vertices[1] - self._vertices[0])
        self.layout = Layout.of(self._vertices[1:-1], cell, beads_a_link=1)

    def spec(self, radius: float) -> mujoco.MjSpec:
        """The foot and the rod on it; only XML makes a flex with elasticity.

        The slides across the plane and the bodies that twist the edges are removed.
        """
        n = len(self._vertices)
        xml = _XML.format(
            foot=FOOT,
            points=" ".join(f"0 {s!r} 0" for s in self._vertices.tolist()),
            elements=" ".join(f"{i} {i + 1}" for i in range(n - 1)),
            young=1 / (np.pi * radius**4 / 4),
            radius=radius,
        )
        spec = mujoco.MjSpec.from_string(xml)
        for body in list(spec.bodies):
            if body.name.startswith("rod_twist"):
                spec.delete(body)
        for joint in list(spec.joints):
            if joint.axis[2] != 0:
                spec.delete(joint)
        return spec

    def mount(self, spec: mujoco.MjSpec, link: int, s: float) -> tuple[mujoco.MjsBody, Floats]:
        """The body of the vertex at the link's end."""
        return spec.body(f"rod_{link + 2}"), np.zeros(3)

    def stiffen(self, model: mujoco.MjModel) -> None:
        """Give the edges their axial stiffness, whatever the time step.

        At rest MuJoCo's force in an edge is k/((1 - d) A) times its extension, with
        solref = (-k, -b), impedance d and A the edge's `flexedge_invweight0`: solved here for k.
        """
        weight = model.flexedge_invweight0[-1]
        k = self._edge_stiffness * (1 - _IMPEDANCE) * weight
        model.eq_solref[:] = [-k, -2 * np.sqrt(k)]
        model.eq_solimp[:] = [_IMPEDANCE, _IMPEDANCE, 1e-3, 0.5, 2]

    @property
    def _edge_stiffness(self) -> float:
        return _AXIAL_STIFFNESS / self.layout.cell

    def place(self, data: mujoco.MjData, angles: Floats, tension: Floats) -> None:
        """Lay edge after edge, each as long as its tension makes it."""
        heading = np.pi / 2 + np.cumsum(angles)
        length = self.layout.cell + tension / self._edge_stiffness
        edges = length[:, None] * np.column_stack([np.cos(heading), np.sin(heading)])
        places = np.cumsum(edges, axis=0)
        places[:, 1] -= self.layout.cell * np.arange(1, len(angles) + 1)
        data.qpos[:] = places.ravel()

    def balance(self, data: mujoco.MjData, force: Floats) -> Floats:
        """Moments at the vertices, then h times the forces along the edges."""
        vertices = self._positions(data)
        force = force.reshape(-1, 2)
        beyond = np.cumsum(force[::-1], axis=0)[::-1]
        edges = np.diff(vertices, axis=0)
        # The moment at a vertex is that at the next one and that of all forces beyond on the edge.
        over_edge = edges[:, 0] * beyond[:, 1] - edges[:, 1] * beyond[:, 0]
        moments = np.cumsum(over_edge[::-1])[::-1]
        return np.concatenate([moments, (edges * beyond).sum(axis=1)])

    def stiffness(self, angles: Floats) -> Floats:
        """Second derivative of (2 EI/h) tan^2(theta/2)."""
        t = np.tan(angles / 2)
        return np.asarray((1 + t**2) * (1 + 3 * t**2) / self.layout.cell)

    def joint_positions(self, data: mujoco.MjData) -> Floats:
        """Shape (n_joints, 2) [L]."""
        return self._positions(data)[:-1]

    def _positions(self, data: mujoco.MjData) -> Floats:
        """The last pinned vertex and the free ones, shape (n_joints + 1, 2) [L]."""
        free = data.xpos[2:, :2]
        pinned = data.xpos[1, :2] + [0, self.layout.joints[0]]
        return np.vstack([pinned, free])
