"""The vibrissa and its contact with a convex contour, in closed form.

`analytic.problem` states the problem (beam, profile, case, readings); `analytic.solver` solves it.
"""

from analytic.problem.beam import Beam
from analytic.problem.case import CASE_NAMES, Case, Sweep, named_case
from analytic.problem.errors import InputError
from analytic.problem.families import catenary, circle, ellipse, parabola, two_circles
from analytic.problem.mesh_section import mesh_section
from analytic.problem.polygon import polygon
from analytic.problem.profile import Profile
from analytic.problem.readings import Readings
from analytic.problem.through_points import through_points
from analytic.solver.certificate import certify
from analytic.solver.contact import solve_contact
from analytic.solver.events import Event, Events, find_events
from analytic.solver.reconstruct import reconstruct, reconstruct_by_decision, relative_noise
from analytic.solver.sideways import sideways_stiffness
from analytic.solver.sweep import solve_sweep
from analytic.solver.tilt import slip_off

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
    "certify",
    "circle",
    "ellipse",
    "find_events",
    "mesh_section",
    "named_case",
    "parabola",
    "polygon",
    "reconstruct",
    "reconstruct_by_decision",
    "relative_noise",
    "sideways_stiffness",
    "slip_off",
    "solve_contact",
    "solve_sweep",
    "through_points",
    "two_circles",
]
