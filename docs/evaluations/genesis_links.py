"""Genesis: capsules on hinges, as an MJCF; ``python -m docs.evaluations.genesis_links CSV``."""

import tempfile
from importlib.metadata import version
from pathlib import Path

import genesis as gs
import numpy as np

from docs.evaluations.bench import circle_of, measure, out
from engines import State, hinges
from engines.agreement import resultant

_LINK = """
<body name="link{i}" pos="0 {at} 0">
<joint name="hinge{i}" type="hinge" axis="0 0 1" stiffness="{spring}" damping="{damping}"/>
<inertial pos="0 {middle} 0" mass="{mass}" diaginertia="{turn} {turn} {turn}"/>
<geom type="capsule" fromto="0 0 0 0 {length} 0" size="{radius}" {friction}/>"""


class Links:
    """Springs are the joints' own; the clamp holds the contacts' forces and the first spring."""

    def __init__(self, case, count, step=0.01, friction=None, chosen=False, precision="32"):
        if gs._initialized:
            gs.destroy()
        gs.init(backend=gs.cpu, precision=precision, logging_level="error")
        self.layout, (self.centre, radius) = hinges(case, count), circle_of(case)
        springs = 1 / self.layout.compliances
        turn = (step / 0.5) ** 2 * float(springs[1])
        self.period = 8 * count if chosen else round(1.8 / step)
        damping = 4 * np.pi / self.period * turn / step if chosen else 0.05 * springs
        damping = np.broadcast_to(damping, count)
        heights = np.diff(self.layout.joints, prepend=0.0)
        links = "".join(
            _LINK.format(
                i=i, at=heights[i], spring=springs[i], damping=damping[i], length=length,
                middle=0.0 if chosen else length / 2, mass=0.1 * turn if chosen else length,
                turn=turn if chosen else length**3 / 12, radius=case.radius,
                friction="" if friction is None else f'friction="{friction}"',
            ) for i, length in enumerate(self.layout.chords.tolist())
        )  # fmt: skip
        self.scene = gs.Scene(
            sim_options=gs.options.SimOptions(dt=step, gravity=(0.0, 0.0, 0.0)),
            rigid_options=gs.options.RigidOptions(enable_self_collision=False),
            show_viewer=False,
        )
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "links.xml"
            file.write_text(
                f'<mujoco><compiler angle="radian"/><worldbody>{links}{"</body>" * count}'
                "</worldbody></mujoco>"
            )
            self.rod = self.scene.add_entity(gs.morphs.MJCF(file=str(file)))
            self.ball = self.scene.add_entity(
                gs.morphs.Sphere(radius=radius, pos=(*self.centre.tolist(), 0.0), fixed=True),
                material=None if friction is None else gs.materials.Rigid(friction=friction),
            )
            self.scene.build()

    def step(self, foot_x):
        self.ball.set_pos((float(self.centre[0]) - foot_x, float(self.centre[1]), 0.0))
        self.scene.step()

    def look(self):
        turns = self.rod.get_dofs_position().numpy().astype(float)
        headings, base = np.cumsum(turns), self.layout.base[0]
        ways = self.layout.chords * np.array([-np.sin(headings), np.cos(headings)])
        joints = np.vstack([base, base + np.cumsum(ways, axis=1).T])
        seen = self.rod.get_contacts(with_entity=self.ball)
        points = seen["position"].numpy()[:, :2].astype(float)
        on_ball = (seen["link_a"] == self.ball.base_link_idx).numpy()[:, None]
        forces = np.where(on_ball, seen["force_b"].numpy(), seen["force_a"].numpy())[:, :2]
        fx, fy, _ = -resultant(points, forces.astype(float))
        moment = -turns[0] / self.layout.compliances[0] + base[0] * fy - base[1] * fx
        return State(joints, np.array([fx, fy, moment]), points, forces.astype(float))


def tuned(**back):
    settings = {"friction": 0.01, "chosen": True, "precision": "64"}  # it refuses less friction
    return lambda case, count: Links(case, count, **(settings | back))


if __name__ == "__main__":
    measure(
        out(),
        f"Genesis {version('genesis-world')}",
        {
            "tuned": tuned(),
            "defaults": Links,
            "friction as it is": tuned(friction=None),
            "inertia of the rod": tuned(chosen=False),
            "single precision": tuned(precision="32"),
        },
        {"tuned": (10, 20)},
    )
