"""The vibrissa and its contact with a convex contour, in closed form.

`analytic.problem` states the problem (beam, profile, case, readings); `analytic.solver` solves it.
"""

from analytic.problem.beam import Beam
from analytic.problem.case import CASE_NAMES, Case, Sweep, named_case
from analytic.problem.errors import InputError
from analytic.problem.families import catenary, circle, ellipse, parabola, two_circles
from analytic.problem.profile import Profile
from analytic.problem.readings import Readings
from analytic.solver.contact import solve_contact
from analytic.solver.events import Event, Events, find_events
from analytic.solver.reconstruct import reconstruct
from analytic.solver.sweep import solve_sweep

__all__ = [
    "CASE_NAMES",
    "Beam",
    "Case",
    "Event",
    "Events",
    "InputError",
    "Profile",
    "Readings",
    "Sweep",
    "catenary",
    "circle",
    "ellipse",
    "find_events",
    "named_case",
    "parabola",
    "reconstruct",
    "solve_contact",
    "solve_sweep",
    "two_circles",
]
