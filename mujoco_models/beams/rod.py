"""The vibrissa as MuJoCo's one-dimensional flex with elasticity, a discrete elastic rod: 4.x only.

The flex bends at its vertices, with the energy (2 EI/h) tan^2(theta/2). Where a `flexcomp` would
give each vertex slides of its own and hold the edges' lengths by a soft constraint, here the
vertices are fixed to rigid links on hinges, as MuJoCo lets them: the edges cannot stretch at all,
loads may act anywhere along an edge and not at vertices only, and the beam stays in the plane.
MuJoCo leaves the contacts of a flex out of what its force sensors feel, but not those of links.

A first edge that is rigid in the clamp makes a naive rod of first order; one that straddles it,
from -h/2 to +h/2, makes one of second order.
"""

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats
from mujoco_models.beams.layout import Layout, turned, vertices
from mujoco_models.beams.links import HingedLinks, link_name
from mujoco_models.beams.protocol import FOOT, Furnish, bare
from mujoco_models.beams.vibrissa import Vibrissa
from mujoco_models.settings import Settings

# The law above is too stiff by (curvature h)^2/3, so segments are shorter where a clamped beam
# bends most: at N = 40 that takes the catenary's force_y from 2.7e-3 rms to 1.3e-3. Anything from
# 0.3 to 0.6 does as well.
_GRADING = 0.4
_UP = np.array([0.0, 1.0])


class Rod(HingedLinks):
    """A one-dimensional flex; see `mujoco_models.beams.protocol.Beam`."""

    def __init__(
        self, settings: Settings, spacing: float, vibrissa: Vibrissa | None = None
    ) -> None:
        self._vertices = vertices(settings, _GRADING)
        cells = (self._vertices[2:] - self._vertices[:-2]) / 2
        edges = (self._vertices[1:] + self._vertices[:-1]) / 2
        super().__init__(Layout.of(self._vertices[1:-1], cells, edges, spacing, vibrissa))

    def spec(self, radius: float, furnish: Furnish = bare) -> mujoco.MjSpec:
        """Links without springs, and the flex that bends them."""
        spec = super().spec(radius, furnish)
        flex = spec.add_flex(name="rod", dim=1, radius=radius, contype=0, conaffinity=0)
        flex.selfcollide = False
        flex.young = 1 / (np.pi * radius**4 / 4)
        if self.layout.vibrissa.is_plain:
            self._join(flex)
        else:
            self._join_in_pieces(flex)
            if self.layout.clamp_turns:
                spec.joints[0].stiffness[0] = 1 / self.layout.compliances[0]
        return spec

    def _join(self, flex: mujoco.MjsFlex) -> None:
        """One line of edges: the first is the foot's, every link has the vertex at its end."""
        count = len(self.layout.joints)
        flex.vertbody = [FOOT, FOOT, *(link_name(i) for i in range(count))]
        at = np.zeros((count + 2, 3))
        at[:, 1] = [*self._vertices[:2], *self.layout.lengths]
        flex.vert = at.ravel()
        flex.elem = [end for i in range(count + 1) for end in (i, i + 1)]

    def _join_in_pieces(self, flex: mujoco.MjsFlex) -> None:
        """Two edges at every vertex, in line when the beam is unloaded.

        The flex's energy at a vertex is EI/(l0 + l1) times the square of its discrete curvature,
        2 tan(theta/2), with l0 and l1 the lengths of its edges. Edges of their own give each vertex
        its own stiffness, and unbent ones its natural curvature; MuJoCo's own reference curvature
        forgets which way a vertex is bent. No edge is longer than its link, or a thin tip's would
        be as long as a hundred vibrissae.
        """
        layout = self.layout
        first = 1 if layout.clamp_turns else 0
        shorter = float((layout.lengths / layout.compliances)[first:].min())
        flex.young *= shorter
        vertices, bodies = [], []
        for i in range(first, len(layout.joints)):
            offset, _ = layout.step(i)
            along = float(layout.vibrissa.turn(layout.joints[i]))
            half = shorter * layout.compliances[i]
            before = layout.headings[i - 1] if i else 0.0
            vertices += [offset - half * turned(_UP, along - before), np.zeros(2)]
            vertices += [half * turned(_UP, along - layout.headings[i])]
            bodies += [link_name(i - 1) if i else FOOT, link_name(i), link_name(i)]
        flex.vertbody = bodies
        flex.vert = np.pad(vertices, ((0, 0), (0, 1))).ravel()
        flex.elem = [end for i in range(0, len(bodies), 3) for end in (i, i + 1, i + 1, i + 2)]

    def stiffness(self, angles: Floats) -> Floats:
        """Second derivative of (2 EI/h) tan^2(theta/2); the clamp's spring is linear."""
        t = np.tan(angles / 2)
        if self.layout.clamp_turns:
            t[0] = 0.0
        return np.asarray((1 + t**2) * (1 + 3 * t**2) / self.layout.compliances)
