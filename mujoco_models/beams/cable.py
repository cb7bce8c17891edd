"""The vibrissa as MuJoCo's composite cable with the plugin `mujoco.elasticity.cable`: 3.x only.

The plugin bends ball joints with the stiffness EI/h, and the composite's first segment is rigid on
its parent: a naive cable is of first order. Here that segment straddles the clamp, from -h/2 to
+h/2, so that all joints sit half a cell off, as the chain's do. The plugin takes balls only; in the
plane of the sweep they turn about z alone, and by symmetry nothing pushes them out of it but
rounding.
"""

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats
from mujoco_models.beams.layout import Layout, turned, vertices
from mujoco_models.beams.links import Balls, about_z
from mujoco_models.beams.protocol import FOOT, Furnish, bare
from mujoco_models.beams.vibrissa import Vibrissa
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
    """A composite cable; see `mujoco_models.beams.protocol.Beam`."""

    def __init__(
        self,
        settings: Settings,
        spacing: float,
        vibrissa: Vibrissa | None = None,
        twist: float = 1.0,
    ) -> None:
        self._twist = twist
        self._vertices = vertices(settings)
        self._cell = float(self._vertices[1] - self._vertices[0])
        joints = self._vertices[1:-1]
        edges = (self._vertices[1:] + self._vertices[:-1]) / 2
        lengths = np.full(len(joints), self._cell)
        self.layout = Layout.of(joints, lengths, edges, spacing, vibrissa)

    def spec(self, radius: float, furnish: Furnish = bare) -> mujoco.MjSpec:
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
        spec.body("B_first").pos = [0, self._vertices[0], 0]
        for i in range(self._turning, len(self.layout.joints)):
            spec.body(self._name(i)).pos = [self._cell, 0, 0]  # was in single precision
        if not self.layout.vibrissa.is_plain:
            self._shape(spec, radius)
        for i in range(len(self.layout.joints)):
            furnish(self.body(spec, i), i)
        return spec

    def _shape(self, spec: mujoco.MjSpec, radius: float) -> None:
        """Put every segment where it is on the unloaded vibrissa, as stiff as its cell.

        The plugin takes the places of the model's bodies for the unbent cable, and the stiffness
        of a joint from the radius and the length of the segments about it.
        """
        layout = self.layout
        behind = np.array([0.0, self._vertices[0]])  # from the clamp, where the first one begins
        if self._turning:
            first, heading = spec.body("B_first"), float(layout.headings[0])
            first.pos = [*turned(behind, heading), 0]
            first.quat = about_z(np.pi / 2 + heading)
            ball = first.add_joint(type=mujoco.mjtJoint.mjJNT_BALL, pos=[-behind[1], 0, 0])
            ball.stiffness[0] = 1 / layout.compliances[0]
        for i in range(self._turning, len(layout.joints)):
            offset, turn = layout.step(i)
            across, along = offset - behind if i == self._turning else offset
            body = spec.body(self._name(i))
            body.pos, body.quat = [along, -across, 0], about_z(turn)
            cell = float(np.hypot(across, along))
            body.geoms[0].size[0] = radius * (cell / layout.compliances[i]) ** 0.25

    @property
    def _turning(self) -> int:
        """How many joints are the clamp's."""
        return int(self.layout.clamp_turns)

    def _name(self, link: int) -> str:
        segment = link + 1 - self._turning
        if segment == 0:
            return "B_first"
        return "B_last" if link == len(self.layout.joints) - 1 else f"B_{segment}"

    def body(self, spec: mujoco.MjSpec, link: int) -> mujoco.MjsBody:
        """The segment itself, whose chord is along its own x axis."""
        return spec.body(self._name(link))

    def within(self, link: int, s: Floats) -> Floats:
        across, along = self.layout.within(link, s)
        if link < self._turning:
            along = along - self._vertices[0]
        return np.column_stack([along, -across, np.zeros(len(s))])

    def stiffness(self, angles: Floats) -> Floats:
        """EI/h, and the clamp's."""
        return 1 / self.layout.compliances
