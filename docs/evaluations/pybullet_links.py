"""PyBullet: capsules on revolute joints; ``python -m docs.evaluations.pybullet_links CSV``."""

from importlib.metadata import version

import numpy as np
import pybullet as p

from docs.evaluations.bench import circle_of, measure, out
from engines import State, hinges

_UP = [-np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)]  # a capsule's own axis is z; here it is y


class Links:
    """Springs as torques of every step: PyBullet's joints have none."""

    def __init__(
        self, case, count, step=1 / 240, friction=None, chosen=False, cleared=False, motors=False
    ):
        p.resetSimulation()
        p.setGravity(0, 0, 0)
        p.setTimeStep(step)
        self.layout, (centre, radius) = hinges(case, count), circle_of(case)
        self.centre, self.thickness, chords = centre, case.radius, self.layout.chords
        # A rod of mass 1; or links that are hard to turn and light to move.
        self.springs = 1 / self.layout.compliances
        self.period = 8 * count if chosen else round(1.8 / step)
        shapes = [
            p.createCollisionShape(
                p.GEOM_CAPSULE, radius=case.radius, height=length,
                collisionFramePosition=[0, length / 2, 0], collisionFrameOrientation=_UP,
            )
            for length in chords.tolist()
        ]  # fmt: skip
        heights = [0.0, *np.diff(self.layout.joints, prepend=0.0).tolist()]
        links = count + 1
        self.turn = (step / 0.5) ** 2 * self.springs[1] if chosen else 0.0
        masses = [1.0, *(np.full(count, 0.1 * self.turn) if chosen else chords)]
        middles = 0 * chords if chosen else chords / 2
        self.body = p.createMultiBody(
            0, -1, -1, [0, 0, 0], [0, 0, 0, 1],
            linkMasses=masses, linkCollisionShapeIndices=[-1, *shapes],
            linkVisualShapeIndices=[-1] * links, linkPositions=[[0, y, 0] for y in heights],
            linkOrientations=[[0, 0, 0, 1]] * links,
            linkInertialFramePositions=[[0, 0, 0], *([0, y, 0] for y in middles)],
            linkInertialFrameOrientations=[[0, 0, 0, 1]] * links,
            linkParentIndices=list(range(links)),
            linkJointTypes=[p.JOINT_FIXED] + [p.JOINT_REVOLUTE] * count,
            linkJointAxis=[[0, 0, 1]] * links,
        )  # fmt: skip
        self.ball = p.createMultiBody(0, p.createCollisionShape(p.GEOM_SPHERE, radius=radius))
        for link in range(links):
            if friction is not None:
                p.changeDynamics(self.body, link, lateralFriction=friction)
            if chosen and link:
                p.changeDynamics(self.body, link, localInertiaDiagonal=[self.turn] * 3)
            if cleared:
                p.changeDynamics(self.body, link, jointDamping=0, linearDamping=0, angularDamping=0)
        if friction is not None:
            p.changeDynamics(self.ball, -1, lateralFriction=friction)
        self.joints = list(range(1, links))
        self.damping = 4 * np.pi / self.period * self.turn / step if chosen else 4e-4 * self.springs
        if not motors:
            p.setJointMotorControlArray(
                self.body, self.joints, p.VELOCITY_CONTROL, forces=[0] * count
            )
        p.enableJointForceTorqueSensor(self.body, 0, True)

    def step(self, foot_x):
        p.resetBasePositionAndOrientation(
            self.ball, [*(self.centre - [foot_x, 0]), 0], [0, 0, 0, 1]
        )
        states = p.getJointStates(self.body, self.joints)
        turned, speed = np.array([s[:2] for s in states]).T
        torques = -self.springs * turned - self.damping * speed
        p.setJointMotorControlArray(
            self.body, self.joints, p.TORQUE_CONTROL, forces=torques.tolist()
        )
        p.stepSimulation()

    def look(self):
        angles = np.array([s[0] for s in p.getJointStates(self.body, self.joints)])
        headings = np.cumsum(angles)
        ways = self.layout.chords * np.array([-np.sin(headings), np.cos(headings)])
        joints = np.vstack([self.layout.base[0], self.layout.base[0] + np.cumsum(ways, axis=1).T])
        touching = p.getContactPoints(self.body, self.ball)
        points = np.array([c[5][:2] for c in touching]).reshape(-1, 2)
        push = [
            c[9] * np.array(c[7]) + c[10] * np.array(c[11]) + c[12] * np.array(c[13])
            for c in touching
        ]
        fx, fy, _, _, _, moment = p.getJointState(self.body, 0)[2]
        return State(
            joints, np.array([fx, fy, moment]), points, np.array(push).reshape(-1, 3)[:, :2]
        )


def tuned(**back):
    def make(case, count):
        return Links(case, count, **({"friction": 0.0, "chosen": True, "cleared": True} | back))

    return make


if __name__ == "__main__":
    p.connect(p.DIRECT)
    measure(
        out(),
        f"PyBullet {version('pybullet')}",
        {
            "defaults": Links,
            "tuned": tuned(),
            "friction as it is": tuned(friction=None),
            "damping as it is": tuned(cleared=False),
            "motors as they are": tuned(motors=True),
            "inertia of the rod": tuned(chosen=False),
            "the same, step 1e-3": tuned(chosen=False, step=1e-3),
        },
        {"tuned": (10, 20)},
    )
