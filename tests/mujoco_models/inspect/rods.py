"""MuJoCo 4's rods as MJCF, with whatever is planted in them."""

from dataclasses import dataclass

import numpy as np

PLANE = 'dof="2d"'


@dataclass(frozen=True)
class Rod:
    """A flexcomp along y on a hand that slides; sound as it is, in metres and seconds."""

    edges: int = 20
    length: float = 0.1
    rigidity: float = 6.44e-4
    radius: float = 2.5e-4
    ahead: float = 0.5  # of an edge, by which the first vertex is before the clamp
    dof: str = PLANE
    edge: str = '<edge equality="true" solref="0.001 1" solimp="0.9999 0.9999 0.001"/>'
    contact: str = 'condim="1" selfcollide="none" solref="0.001 1" solimp="0.998 0.998 0.001"'
    pin: str = "0 1"
    elasticity: str = 'damping="4.4e-4"'
    site: str = ""
    gravity: str = "0 0 0"
    weld: str = 'solref="0.001 1" solimp="0.9999 0.9999 0.001"'
    hand: str = '<joint name="rail" type="slide" axis="1 0 0" armature="10"/>'
    own_tree: bool = False  # the flex hangs on the body that has the sensors

    @property
    def text(self) -> str:
        h = self.length / (self.edges - self.ahead)
        middle = self.edges * h / 2 - self.ahead * h
        young = self.rigidity / (np.pi * self.radius**4 / 4)
        inertial = '<inertial pos="0 0 0" mass="0.1" diaginertia="1e-3 1e-3 1e-3"/>'
        flex = (
            f'<flexcomp name="hair" type="grid" dim="1" {self.dof} count="{self.edges + 1} 1 1" '
            f'spacing="{h!r} 1 1" pos="0 {middle!r} 0" euler="0 0 90" radius="{self.radius!r}" '
            f'mass="1.54e-4">{self.edge}<elasticity young="{young!r}" {self.elasticity}/>'
            f'<contact {self.contact}/><pin id="{self.pin}"/></flexcomp>'
        )
        root = f'<body name="root"><freejoint/>{inertial}{flex}</body>'
        weld = f'<equality><weld body1="hand" body2="root" {self.weld}/></equality>'
        drive = '<actuator><velocity joint="rail" kv="1e5"/></actuator>'
        return (
            f'<mujoco model="rod"><option timestep="0.0005" gravity="{self.gravity}" '
            f'integrator="discrete"/><worldbody><body name="hand">{self.hand}{inertial}'
            f'<site name="clamp" {self.site}/>{flex if self.own_tree else ""}</body>'
            f"{'' if self.own_tree else root}</worldbody>{'' if self.own_tree else weld}"
            f"{drive if 'rail' in self.hand else ''}"
            '<sensor><force name="F" site="clamp"/><torque name="T" site="clamp"/></sensor>'
            "</mujoco>"
        )

    def write(self, folder):
        path = folder / "rod.xml"
        path.write_text(self.text)
        return path
