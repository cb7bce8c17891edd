"""PhysX by SAPIEN: capsules on revolute joints; ``python -m docs.evaluations.sapien_links CSV``."""

from importlib.metadata import version

import numpy as np
import sapien
from sapien import Pose, physx

from docs.evaluations.bench import circle_of, measure, out
from engines import State, hinges

_HALF = np.sqrt(0.5)
_AXIS = [_HALF, 0, -_HALF, 0]  # a joint turns about its own x; here about z
_UPRIGHT = [_HALF, 0, 0, _HALF]  # a capsule's own axis is x; here it is y


class Links:
    """Springs are PhysX's own drives, implicit in time."""

    def __init__(
        self, case, count, step=1 / 100, friction=None, sleep=None, iterations=None, armature=0.0,
        chosen=False, cleared=False,
    ):  # fmt: skip
        scene = physx.get_scene_config()
        scene.gravity = np.zeros(3)
        physx.set_scene_config(scene)
        body = physx.PhysxBodyConfig()
        if sleep is not None:
            body.sleep_threshold = sleep
        if iterations is not None:
            body.solver_position_iterations = iterations
        physx.set_body_config(body)
        self.scene = sapien.Scene([physx.PhysxCpuSystem()])
        self.scene.set_timestep(step)
        self.layout, (self.centre, radius) = hinges(case, count), circle_of(case)
        self.step_, chords = step, self.layout.chords
        springs = 1 / self.layout.compliances
        self.period = 8 * count if chosen else round(1.8 / step)
        rub = physx.PhysxMaterial(friction, friction, 0.0) if friction is not None else None
        builder = self.scene.create_articulation_builder()
        root = builder.create_link_builder()
        before = builder.create_link_builder(root)
        before.set_joint_properties("fixed", [], Pose(), Pose())
        heights = np.diff(self.layout.joints, prepend=0.0)
        for y, length in zip(heights.tolist(), chords.tolist(), strict=True):
            link = builder.create_link_builder(before)
            link.set_joint_properties(
                "revolute", [[-10, 10]], Pose([0, y, 0], _AXIS), Pose([0, 0, 0], _AXIS), 0.0, 0.0
            )
            link.add_capsule_collision(
                Pose([0, length / 2, 0], _UPRIGHT), case.radius, length / 2, material=rub,
                density=length / (np.pi * case.radius**2 * (length + 4 / 3 * case.radius)),
            )  # fmt: skip
            before = link
        self.body = builder.build(fix_root_link=True)
        turn = (step / 0.5) ** 2 * springs[1]
        for joint, k in zip(self.body.active_joints, springs.tolist(), strict=True):
            damping = 4 * np.pi / self.period * turn / step if chosen else 0.05 * k
            joint.set_drive_properties(k, damping)
            joint.set_armature(np.array([armature]))
        for link in self.body.links:
            if chosen:
                link.set_mass(0.1 * turn)
                link.set_inertia(np.full(3, turn))
                link.set_cmass_local_pose(Pose())
            if cleared:
                link.set_linear_damping(0)
                link.set_angular_damping(0)
        ball = self.scene.create_actor_builder()
        ball.add_sphere_collision(radius=radius, material=rub)
        self.ball = ball.build_kinematic()

    def step(self, foot_x):
        self.ball.set_pose(Pose([*(self.centre - [foot_x, 0]), 0]))
        self.scene.step()

    def look(self):
        poses = [link.entity_pose for link in self.body.links[2:]]
        tip = poses[-1] * Pose([0, float(self.layout.chords[-1]), 0])
        joints = np.array([pose.p[:2] for pose in [*poses, tip]], dtype=float)
        points, push = [], []
        for contact in self.scene.get_contacts():
            on_ball = contact.bodies[0].entity == self.ball
            for one in contact.points:
                points.append(one.position[:2])
                push.append((-1 if on_ball else 1) * one.impulse[:2] / self.step_)
        fx, fy, _, _, _, moment = self.body.get_link_incoming_joint_forces()[1]
        return State(
            joints,
            np.array([fx, fy, moment], dtype=float),
            np.array(points, dtype=float).reshape(-1, 2),
            np.array(push, dtype=float).reshape(-1, 2),
        )


def tuned(**back):
    settings = {"friction": 0.0, "sleep": 0.0, "iterations": 50, "chosen": True, "cleared": True}
    return lambda case, count: Links(case, count, **(settings | back))


if __name__ == "__main__":
    measure(
        out(),
        f"PhysX by SAPIEN {version('sapien')}",
        {
            "defaults": Links,
            "tuned": tuned(),
            "friction as it is": tuned(friction=None),
            "sleep as it is": tuned(sleep=None),
            "10 iterations": tuned(iterations=None),
            "damping as it is": tuned(cleared=False),
            "inertia of the rod": tuned(chosen=False),
            "the same, armature 1e-3": tuned(chosen=False, armature=1e-3),
        },
        {"tuned": (10, 20)},
    )
