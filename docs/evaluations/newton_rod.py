"""Newton: its rod, by vertex block descent; ``python -m docs.evaluations.newton_rod CSV``."""

from importlib.metadata import version

import newton
import numpy as np
import warp as wp
from newton.solvers import SolverVBD

from docs.evaluations.bench import circle_of, measure, out
from engines import State, hinges
from engines.agreement import resultant

_STEP = 1 / 240
_DAMPING = 0.5  # of the spring; with a tenth of it the rod swings for many seconds
_STRETCH = 1e6  # EI/L^2


class Rod:
    """Capsules, the first of which stands; the clamp holds the contacts and the first spring."""

    def __init__(self, case, count, friction=None):
        self.layout, (self.centre, radius) = hinges(case, count), circle_of(case)
        self.period, self.spring = round(1.8 / _STEP), 1 / float(self.layout.compliances[0])
        ends = np.concatenate([[0.0], self.layout.joints, [1.0]])
        self.lengths = np.diff(ends)
        builder = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
        shape = newton.ModelBuilder.ShapeConfig(density=1 / (np.pi * case.radius**2))
        shape.collision_group = -1
        if friction is not None:
            shape.mu = friction
        self.bodies, _ = builder.add_rod(
            rod=newton.Rod([(0.0, y, 0.0) for y in ends.tolist()], radius=case.radius), cfg=shape,
            stretch_stiffness=_STRETCH, bend_stiffness=self.spring,
            bend_damping=_DAMPING * self.spring,
        )  # fmt: skip
        foot = self.bodies[0]
        builder.body_mass[foot] = builder.body_inv_mass[foot] = 0.0
        builder.body_inertia[foot] = builder.body_inv_inertia[foot] = wp.mat33(0.0)
        self.ball = builder.add_body(is_kinematic=True, mass=1.0)
        shape.collision_group, shape.density = 1, 0.0
        # Along z: nothing but contact keeps the rod in its plane, and from a ball it slides off.
        self.on_ball = builder.add_shape_capsule(
            self.ball, radius=radius, half_height=0.5, cfg=shape
        )
        builder.color()
        self.model = builder.finalize()
        self.pipeline = newton.CollisionPipeline(self.model)
        self.solver = SolverVBD(self.model)
        self.now, self.next = self.model.state(), self.model.state()
        self.control, self.contacts = self.model.control(), self.pipeline.contacts()
        self.seen = self.solver.observables({"contact_f"}, contacts=self.contacts)

    def step(self, foot_x):
        place = wp.transform(*(self.centre - [foot_x, 0.0]), 0.0, 0.0, 0.0, 0.0, 1.0)
        for state in (self.now, self.next):
            state.body_q[self.ball : self.ball + 1].fill_(place)
        self.pipeline.collide(self.now, self.contacts)
        self.solver.step(
            self.now, self.next, self.control, self.contacts, _STEP, observables=self.seen
        )
        self.now, self.next = self.next, self.now

    def look(self):
        poses = self.now.body_q.numpy()[self.bodies].astype(float)
        x, y, z, w = poses[:, 3:].T
        along = np.column_stack([2 * (x * z + w * y), 2 * (y * z - w * x)])  # a capsule's axis is z
        headings = np.arctan2(-along[:, 0], along[:, 1])
        half = self.lengths[:, None] / 2 * along
        starts, tip = poses[1:, :2] - half[1:], poses[-1:, :2] + half[-1:]
        points, forces = [], []
        push = self.seen.contact_f.numpy()[:, :2].astype(float)
        seen, bodies = self.contacts, self.model.shape_body.numpy()
        first, second = seen.rigid_contact_shape0.numpy(), seen.rigid_contact_shape1.numpy()
        for i in range(int(seen.rigid_contact_count.numpy()[0])):
            on_first = second[i] == self.on_ball
            link = bodies[first[i] if on_first else second[i]]
            local = seen.rigid_contact_point0 if on_first else seen.rigid_contact_point1
            at = wp.transform(*self.now.body_q.numpy()[link])
            points.append(wp.transform_point(at, wp.vec3(local.numpy()[i]))[:2])
            forces.append(push[i] if on_first else -push[i])
        points, forces = np.reshape(points, (-1, 2)), np.reshape(forces, (-1, 2))
        base, turns = self.layout.base[0], np.diff(headings)
        fx, fy, _ = -resultant(points, forces)
        moment = -turns[0] * self.spring + base[0] * fy - base[1] * fx
        return State(np.vstack([starts, tip]), np.array([fx, fy, moment]), points, forces, turns)


def frictionless(case, count):
    return Rod(case, count, friction=0.0)


if __name__ == "__main__":
    measure(
        out(),
        f"Newton {version('newton')}, rod",
        {"as it is": Rod, "friction 0": frictionless},
        {},
        swings=2,
    )
