"""The vibrissa and its contact with a convex contour, in closed form.

`analytic.problem` states the problem (beam, profile, case, readings); `analytic.solver` solves it.
"""

from analytic.checks.certificate import certify
from analytic.from_clamp.reconstruct import reconstruct, reconstruct_by_decision, relative_noise
from analytic.from_clamp.shape import curvatures, deflected_shapes
from analytic.from_clamp.sideways import sideways_stiffness
from analytic.problem.beam import Beam
from analytic.problem.case import Case, Direction, Sweep
from analytic.problem.contours.contour import Contour
from analytic.problem.contours.families import catenary, circle, ellipse, parabola, two_circles
from analytic.problem.contours.mesh_section import mesh_section
from analytic.problem.contours.polygon import polygon
from analytic.problem.contours.profile import Profile
from analytic.problem.contours.through_points import through_points
from analytic.problem.errors import InputError
from analytic.problem.named import CASE_NAMES, NAMED_PROFILES, named_case
from analytic.problem.readings import CLAMP_READINGS, COLUMNS, PHASES, SENSED, Readings
from analytic.solver.branch import surplus
from analytic.solver.contact import solve_contact
from analytic.solver.events import Event, Events, find_events
from analytic.solver.friction import with_friction
from analytic.solver.sweep import solve_sweep
from analytic.solver.tilt import slip_off

__all__ = [
    "CASE_NAMES",
    "CLAMP_READINGS",
    "COLUMNS",
    "NAMED_PROFILES",
    "PHASES",
    "SENSED",
    "Beam",
    "Case",
    "Contour",
    "Direction",
    "Event",
    "Events",
    "InputError",
    "Profile",
    "Readings",
    "Sweep",
    "catenary",
    "certify",
    "circle",
    "curvatures",
    "deflected_shapes",
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
    "surplus",
    "through_points",
    "two_circles",
    "with_friction",
]
