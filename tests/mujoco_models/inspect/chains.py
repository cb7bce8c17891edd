"""Chains of links as MJCF, with whatever is planted in them."""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Chain:
    """A chain of capsules along y; sound as it is, L = EI = 1."""

    links: int = 20
    length: float = 1.0
    rigidity: float = 1.0
    radius: float = 0.005
    first: str = "centre"  # where it first bends: centre of its cell, "start" or "end"
    stiffer: dict[int, float] = field(default_factory=dict)
    curvature: float = 0.0
    gravity: str = "0 0 0"
    solref: str = "0.02 1"
    site: str = ""
    tip: str = ""  # of the last geom
    foot: str = 'mocap="true"'
    inside_foot: str = ""
    sensors: str = '<force name="F" site="clamp"/><torque name="T" site="clamp"/>'
    beside: str = ""

    def text(self, name: str = "whisker") -> str:
        h = self.length / self.links
        lead, count = {"centre": (h / 2, self.links), "start": (0.0, self.links),
                       "end": (h, self.links - 1)}[self.first]  # fmt: skip
        stiffness = self.rigidity / h
        bodies = ""
        for i in range(1, count + 1):
            size = h / 2 if self.first == "centre" and i == count else h
            k = stiffness * self.stiffer.get(i, 1.0)
            bodies += (
                f'<body name="{name}{i}" pos="0 {lead if i == 1 else h!r} 0">'
                f'<joint axis="0 0 1" stiffness="{k!r}" damping="{0.016 * k!r}" '
                f'springref="{self.curvature * h!r}"/>'
                f'<geom name="{name}-geom{i}" fromto="0 0 0 0 {size!r} 0" '
                f'mass="{0.313 * size / self.length!r}" {self.tip if i == count else ""}/>'
            )
        rigid = f'<geom name="{name}-geom0" fromto="0 0 0 0 {lead!r} 0"/>' if lead else ""
        return (
            f'<body name="{name}-foot" {self.foot}>{self.inside_foot}'
            f'<site name="clamp" {self.site}/>{rigid}{bodies}{"</body>" * count}</body>'
        )

    def write(self, folder, *changes):
        """Into a folder, with pieces of the text that are others: `(old, new)`."""
        # Contacts of some 4e3 EI/L^3: hard enough, and it does not chatter.
        text = (
            f'<mujoco model="planted"><compiler angle="radian"/>'
            f'<option timestep="0.01" integrator="discrete" gravity="{self.gravity}"/>'
            f'<default><geom type="capsule" size="{self.radius!r}" condim="1" '
            f'solref="{self.solref}" solimp="0.98 0.98 0.001"/></default>'
            f"<worldbody>{self.text()}{self.beside}</worldbody>"
            f"<sensor>{self.sensors}</sensor></mujoco>"
        )
        for old, new, *count in changes:
            assert old in text
            text = text.replace(old, new, *count)
        path = folder / "whisker.xml"
        path.write_text(text)
        return path


@dataclass(frozen=True)
class OnRail(Chain):
    """The same on a slide that nothing drives; a mocap body has no speed, which is a fault."""

    foot: str = ""
    inside_foot: str = (
        '<joint name="rail" type="slide" axis="1 0 0" armature="10"/>'
        '<inertial pos="0 0 0" mass="1e-3" diaginertia="1e-5 1e-5 1e-5"/>'
    )
