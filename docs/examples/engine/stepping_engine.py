"""An engine that only steps, in fifty lines: links on hinges past a circle, by a soft contact.

Nothing of time shows at rest, nor do masses: every joint has the same inertia, and the
step is implicit in the springs and in the contact.
"""

import numpy as np

from analytic.problem.errors import InputError
from engines import State, hinges, sweep_stepping


class Links:
    """A vibrissa of links; see `engines.stepping.Stepper`. Its state is angles and their speeds."""

    def __init__(self, case, count=20, contact_stiffness=1e5):
        circle = case.profile.scaled(1 / case.beam.length)
        point = circle.at(circle.parameter(np.linspace(-1.0, 1.0, 3)))
        radii = point.stretch / point.turning
        if np.ptp(radii) > 1e-9 * radii[1]:
            raise InputError("object for links", case.profile.label, "a circle", "take another")
        self.centre = np.array([point.xi[1], point.eta[1] + radii[1]])
        self.reach, self.radius = radii[1] + case.radius, case.radius  # of the links' axis
        self.layout, self.contact_stiffness = hinges(case, count), contact_stiffness
        self.springs = np.diag(1 / self.layout.compliances)
        self.inertia, self.damping = 5.0, 0.3  # of a joint, in a step
        self.period = 80
        self.angles, self.speeds, self.foot_x = np.zeros(len(self.springs)), 0.0, 10.0

    def joints(self):
        """Where the joints are, and the tip."""
        headings = self.layout.headings + np.cumsum(self.angles)
        links = self.layout.chords * np.array([-np.sin(headings), np.cos(headings)])
        return np.vstack([self.layout.base[0], self.layout.base[0] + np.cumsum(links, axis=1).T])

    def contact(self):
        """How deep the links are at most, at which place of the axis, and the normal there."""
        joints, centre = self.joints(), self.centre - [self.foot_x, 0.0]
        begins, ways = joints[:-1], np.diff(joints, axis=0)
        along = ((centre - begins) * ways).sum(axis=1) / (ways**2).sum(axis=1)
        places = begins + np.clip(along, 0, 1)[:, None] * ways
        apart = np.hypot(*(places - centre).T)
        link = int(apart.argmin())
        return self.reach - apart[link], places[link], (places[link] - centre) / apart[link], link

    def step(self, foot_x):
        self.foot_x = foot_x
        depth, place, normal, link = self.contact()
        arms = (place - self.joints()[:-1]) * (np.arange(len(self.angles)) <= link)[:, None]
        lever = arms[:, 0] * normal[1] - arms[:, 1] * normal[0]  # of the normal, at every joint
        stiffness = self.contact_stiffness * (depth > 0)
        forces = stiffness * depth * lever - self.springs @ self.angles
        inertia = self.inertia * np.eye(len(self.angles)) + self.springs
        inertia += stiffness * np.outer(lever, lever)
        pull = forces + self.inertia * (1 - self.damping) * self.speeds
        self.speeds = np.linalg.solve(inertia, pull)
        self.angles = self.angles + self.speeds

    def look(self):
        depth, place, normal, _ = self.contact()
        force = self.contact_stiffness * max(depth, 0.0) * normal
        point = place - self.radius * normal
        moment = -float(self.angles[0] * self.springs[0, 0])  # of the first spring, at its hinge
        x, y = self.layout.base[0]
        clamp = np.array([*-force, moment - x * force[1] + y * force[0]])
        return State(self.joints(), clamp, point[None], force[None])

    def keep(self):
        return self.angles, self.speeds, self.foot_x

    def go_back(self, kept):
        self.angles, self.speeds, self.foot_x = kept


class Engine:
    """See `engines.engine.Engine`."""

    name = "links"
    role = "other model"
    requires = "numpy>=2.0"
    tuned = "contact stiffness 1e5 EI/L^3"

    def sweep(self, case, settings, advance=lambda: None):
        about = {"engine": f"links of NumPy {np.__version__}", "settings": {}}
        return sweep_stepping(case, lambda c: Links(c, settings.segments), "links", about, advance)


ENGINE = Engine()
