"""A beam and a profile as a user gives them."""

from analytic.problem.beam import Beam
from analytic.problem.contours.contour import Contour
from analytic.problem.errors import require


def given_contour(profile: Contour, beam: Beam) -> Contour:
    """The contour that the centreline feels, in units of the vibrissa's length; both checked."""
    require("profile", profile, Contour, "as catenary(0.5, -0.8), or polygon([...])")
    require("beam", beam, Beam, "as Beam(length=..., flexural_rigidity=...)")
    return profile.scaled(1 / beam.length).offset(beam.unloaded.tip_radius)
