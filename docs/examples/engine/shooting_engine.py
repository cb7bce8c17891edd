"""An engine in a hundred lines: shooting from the clamp, past a circle.

A third model beside MuJoCo's links and Exudyn's elements: the differential equation of the rod,
integrated from the clamp by scipy, with the clamp's force as the unknown.
"""

from importlib.metadata import version
from math import cos, sin

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve

from analytic.problem.errors import InputError
from engines import Row, sweep_stations

RESIDUAL = 1e-9  # EI/L^2, L; what the two equations of a contact may leave


class Shooting:
    """The vibrissa at rest with its foot at a place; see `engines.stations.Rest`."""

    def __init__(self, case):
        circle = case.profile.scaled(1 / case.beam.length)
        point = circle.at(circle.parameter(np.linspace(-1.0, 1.0, 3)))
        radii = point.stretch / point.turning
        if np.ptp(radii) > 1e-9 * radii[1]:
            raise InputError("object for shooting", case.profile.label, "a circle", "take another")
        self.surface = radii[1]
        self.centre = np.array([point.xi[1], point.eta[1] + self.surface])
        self.reach = self.surface + case.radius  # of the rod's axis from the centre
        self.radius = case.radius
        # What is unknown: moment at the clamp, force, its direction and where it acts.
        self.last = self.found = np.array([0.0, 0.0, 0.9, 1.0])

    def rod(self, moment, force, alpha, s):
        """Place and slope at arc length s, under a force along the contour's normal."""
        fx, fy = force * np.sin(alpha), -force * np.cos(alpha)  # of the object on the rod

        def bend(_, state):
            _, _, slope, kappa = state
            return cos(slope), sin(slope), kappa, fx * sin(slope) - fy * cos(slope)

        way = solve_ivp(bend, (0, s), (0, 0, np.pi / 2, moment), "DOP853", rtol=1e-9, atol=1e-11)
        return way.y[:, -1]

    def at(self, foot_x):
        right, above = foot_x - self.centre[0], max(self.centre[1] - 1, 1e-9)
        if right > 0 and np.hypot(right, above) > self.reach:  # the object is ahead
            self.found = np.array([0.0, 0.0, np.arctan2(right, above), 1.0])
            return Row()
        for tip in (True, False):
            guess = self.last if tip else np.append(self.last[:3], min(self.last[3], 0.999))
            unknown, _, fine, _ = fsolve(self.equations, guess, (foot_x, tip), full_output=True)
            left = float(np.abs(self.equations(unknown, foot_x, tip)).max())
            if fine == 1 and left < RESIDUAL and self.holds(unknown, tip):
                self.found = unknown
                return self.row(foot_x, unknown, tip, left)
        return None

    def equations(self, unknown, foot_x, tip):
        """No moment where the force acts; that place is at the circle; its end, or its tangent."""
        _, _, alpha, s = unknown
        x, y, slope, kappa = self.rod(*unknown)
        at = self.centre + self.reach * np.array([np.sin(alpha), -np.cos(alpha)])
        end = s - 1 if tip else np.sin(slope - alpha)
        return np.array([kappa, x + foot_x - at[0], y - at[1], end])

    def holds(self, unknown, tip):
        """Pushed, not pulled, by its end and not by its side; or somewhere between the ends."""
        _, force, alpha, s = unknown
        slope = self.rod(*unknown)[2]
        return force > 0 and (np.sin(slope - alpha) > -1e-9 if tip else 0 < s <= 1)

    def row(self, foot_x, unknown, tip, left):
        moment, force, alpha, s = unknown
        x, y = self.centre + self.surface * np.array([np.sin(alpha), -np.cos(alpha)])
        return Row(
            force_x=-force * np.sin(alpha),
            force_y=force * np.cos(alpha),
            moment_z=-moment,
            tip_angle=self.rod(*unknown)[2],
            phase="tip" if tip else "tangent",
            contact_angle=alpha,
            contact_arc_length=s,
            contact_x=x,
            contact_y=y,
            residual=left,
        )

    def accept(self):
        self.last = self.found


class Engine:
    """See `engines.engine.Engine`."""

    name = "shooting"
    role = "other model"
    requires = "scipy>=1.14"
    tuned = "integration to 1e-10, which leaves the readings right to 1e-8"

    def sweep(self, case, settings, advance=lambda: None):
        case.require_plain("shooting")
        about = {"engine": f"SciPy {version('scipy')}", "settings": {}}
        return sweep_stations(case, Shooting, "shooting", about, advance)


ENGINE = Engine()
