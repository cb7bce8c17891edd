"""The vibrissa as MuJoCo's composite cable with the plugin `mujoco.elasticity.cable`: 3.x only.

The plugin bends ball joints with the stiffness EI/h, and the composite's first segment is rigid on
its parent: a naive cable is of first order. Here that segment straddles the clamp, from -h/2 to
+h/2, so that all joints sit half a cell off, as the chain's do. The plugin takes balls only; in the
plane of the sweep they turn about z alone, and by symmetry nothing pushes them out of it but
rounding.
"""

import mujoco
import numpy as np

from analytic.problem.arrays import Floats
from mujoco_models.beams.coordinates import Balls
from mujoco_models.beams.layout import Layout, vertices
from mujoco_models.beams.protocol import FOOT
from mujoco_models.settings import Settings

_XML = """
<mujoco>
  <extension><plugin plugin="mujoco.elasticity.cable"/></extension>
  <worldbody>
    <body name="{foot}">
      <composite type="cable" vertex="{vertices}" initial="none">
        <plugin plugin="mujoco.elasticity.cable">
          <config key="bend" value="{young!r}"/>
          <config key="twist" value="{shear!r}"/>
        </plugin>
        <joint kind="main" armature="{armature!r}"/>
        <geom type="capsule" size="{radius!r}" contype="0" conaffinity="0" mass="1e-5"/>
      </composite>
    </body>
  </worldbody>
</mujoco>
"""


class Cable(Balls):
    """A composite cable; see `mujoco_models.beams.protocol.Beam`.

    Parameters
    ----------
    settings : Settings
        Number of segments, and which clamp.
    spacing : float
        Of the beads, at most [L].
    twist : float
        GJ/EI. At rest nothing twists the vibrissa, so that any would do; but the plugin's moments
        derive from an energy only if it resists twisting as it does bending. At GJ = 0.1 EI or
        10 EI the stiffness of a bent cable sideways is wrong by 2 % at N = 40, of second order in
        1/N.
    """

    def __init__(self, settings: Settings, spacing: float, twist: float = 1.0) -> None:
        self._twist = twist
        self._vertices = vertices(settings)
        self._cell = float(self._vertices[1] - self._vertices[0])
        joints = self._vertices[1:-1]
        self.layout = Layout.of(joints, np.full(len(joints), self._cell), spacing)

    def spec(self, radius: float) -> mujoco.MjSpec:
        """The foot and the cable on it; only XML makes a composite."""
        area_moment = np.pi * radius**4 / 4
        xml = _XML.format(
            foot=FOOT,
            vertices=" ".join(f"0 {s!r} 0" for s in self._vertices.tolist()),
            young=1 / area_moment,
            shear=self._twist / (2 * area_moment),
            armature=1e-4 / self._cell,
            radius=radius,
        )
        spec = mujoco.MjSpec.from_string(xml)
        for i in range(len(self.layout.joints)):
            spec.body(self._name(i)).pos = [self._cell, 0, 0]  # was in single precision
        spec.body("B_first").pos = [0, self._vertices[0], 0]
        return spec

    def _name(self, link: int) -> str:
        return "B_last" if link == len(self.layout.joints) - 1 else f"B_{link + 1}"

    def mount(self, spec: mujoco.MjSpec, link: int, s: float) -> tuple[mujoco.MjsBody, Floats]:
        """The segment itself, which lies along its own x axis."""
        return spec.body(self._name(link)), np.array([s - self.layout.joints[link], 0, 0])

    def stiffness(self, angles: Floats) -> Floats:
        """EI/h."""
        return 1 / self.layout.cells
