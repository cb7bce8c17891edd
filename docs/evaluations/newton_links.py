"""Newton: capsules on revolute joints; ``python -m docs.evaluations.newton_links CSV``."""

from importlib.metadata import version

import newton
import numpy as np
import warp as wp
from newton.solvers import SolverMuJoCo

from docs.evaluations.bench import circle_of, measure, out
from engines import State, hinges

_UP = wp.quat_from_axis_angle(wp.vec3(1.0, 0.0, 0.0), -np.pi / 2)  # a capsule's own axis is z
_STILL = wp.quat_identity()


class Links:
    """By its MuJoCo solver; springs are the joints' own drives."""

    def __init__(
        self, case, count, step=1 / 240, friction=None, stiffness=None, chosen=False, **solver
    ):
        self.layout, (self.centre, radius) = hinges(case, count), circle_of(case)
        self.dt, self.chosen, chords = step, chosen, self.layout.chords
        springs = 1 / self.layout.compliances
        turn = (step / 0.5) ** 2 * float(springs[1])
        self.period = 8 * count if chosen else round(1.8 / step)
        damping = 4 * np.pi / self.period * turn / step if chosen else 0.05 * springs
        builder = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
        shape = newton.ModelBuilder.ShapeConfig(density=0.0, collision_group=-1)
        if friction is not None:
            shape.mu = friction
        if stiffness is not None:
            shape.ke, shape.kd = stiffness, 2 * np.sqrt(stiffness * 0.1 * turn)
        heights = np.diff(self.layout.joints, prepend=0.0)
        before, joints = -1, []
        for i, (y, length) in enumerate(zip(heights.tolist(), chords.tolist(), strict=True)):
            mass = 0.1 * turn if chosen else length
            inertia = np.eye(3) * (turn if chosen else length**3 / 12)
            middle = wp.vec3(0.0, 0.0 if chosen else length / 2, 0.0)
            body = builder.add_link(mass=mass, com=middle, inertia=inertia.tolist(),
                                    lock_inertia=True)  # fmt: skip
            builder.add_shape_capsule(
                body, xform=wp.transform(wp.vec3(0.0, length / 2, 0.0), _UP), radius=case.radius,
                half_height=length / 2, cfg=shape,
            )  # fmt: skip
            joints.append(
                builder.add_joint_revolute(
                    before, body, axis=wp.vec3(0.0, 0.0, 1.0), armature=0.0,
                    parent_xform=wp.transform(wp.vec3(0.0, y, 0.0), _STILL),
                    child_xform=wp.transform(wp.vec3(0.0, 0.0, 0.0), _STILL),
                    target_q=0.0, target_ke=float(springs[i]),
                    target_kd=float(np.broadcast_to(damping, count)[i]), target_qd=0.0,
                )
            )  # fmt: skip
            before = body
        builder.add_articulation(joints)
        ball = builder.add_body(is_kinematic=True, mass=1.0)
        shape.collision_group = 1
        self.ball = builder.add_shape_sphere(ball, radius=radius, cfg=shape)
        self.model = builder.finalize()
        self.solver = SolverMuJoCo(self.model, **solver)
        self.now, self.next = self.model.state(), self.model.state()
        self.control, self.contacts = self.model.control(), self.model.contacts()
        self.seen = self.solver.observables({"contact_f", "body_parent_f"}, contacts=self.contacts)
        newton.eval_fk(self.model, self.model.joint_q, self.model.joint_qd, self.now)

    def step(self, foot_x):
        places = self.now.joint_q.numpy()
        places[-7:-4] = [*(self.centre - [foot_x, 0.0]), 0.0]
        self.now.joint_q.assign(places)
        self.solver.step(
            self.now, self.next, self.control, self.contacts, self.dt, observables=self.seen
        )
        self.now, self.next = self.next, self.now

    def look(self):
        headings = np.cumsum(self.now.joint_q.numpy()[:-7].astype(float))
        ways = self.layout.chords * np.array([-np.sin(headings), np.cos(headings)])
        base = self.layout.base[0]
        joints = np.vstack([base, base + np.cumsum(ways, axis=1).T])
        seen = self.contacts
        count = int(seen.rigid_contact_count.numpy()[0])
        first, second = seen.rigid_contact_shape0.numpy(), seen.rigid_contact_shape1.numpy()
        push = self.seen.contact_f.numpy()[:, :2].astype(float)
        points, forces = [], []
        for i in np.flatnonzero(np.abs(push[:count]).max(axis=1, initial=0.0)):
            on_first = second[i] == self.ball
            link = first[i] if on_first else second[i]
            local = seen.rigid_contact_point0 if on_first else seen.rigid_contact_point1
            (x, y), angle = local.numpy()[i, :2], headings[link]
            cos, sin = np.cos(angle), np.sin(angle)
            points.append(joints[link] + [cos * x - sin * y, sin * x + cos * y])
            forces.append(push[i] if on_first else -push[i])
        fx, fy, _, _, _, moment = self.seen.body_parent_f.numpy()[0].astype(float)
        at = joints[0] if self.chosen else (joints[0] + joints[1]) / 2  # the link's centre of mass
        return State(
            joints,
            np.array([fx, fy, moment + at[0] * fy - at[1] * fx]),
            np.reshape(points, (-1, 2)),
            np.reshape(forces, (-1, 2)),
        )


def on_cpu(**settings):
    return lambda case, count: Links(case, count, use_mujoco_cpu=True, **settings)


if __name__ == "__main__":
    measure(
        out(),
        f"Newton {version('newton')}",
        {
            "defaults": on_cpu(),
            "friction 1e-3": on_cpu(friction=1e-3),
            "friction 1e-3, contacts 1e4": on_cpu(friction=1e-3, stiffness=1e4),
        },
        {},
        swings=4,
    )
