"""How much earlier a vibrissa slips off sideways whose clamp leans out of the plane of the sweep.

A fold of the states at some slope angle alpha > 0 of the contact replaces the loss of stability at
alpha = 0. For small tilts

    alpha = (X tilt^2/x0')^(1/3),   x0 - x0(0) = (3/2) x0' alpha,

with the reach X and the rate x0' = dx0/dalpha of the planar vibrissa at alpha = 0: a power of 2/3,
as for every imperfect column of the same kind.
"""

import numpy as np

from analytic.problem.beam import Beam
from analytic.problem.case import Case
from analytic.problem.contours.contour import Contour
from analytic.problem.errors import InputError
from analytic.problem.support import require_plain
from analytic.space.problem.bodies.prism import prism
from analytic.space.problem.case import SpatialCase
from analytic.space.problem.path import FootPath
from analytic.space.solver.branch import LAST, Branch
from analytic.space.solver.contact import Scene

_LARGEST = 0.5  # rad
_AT_LOWEST = -1e-9  # of the normal, along the sweep: a corner of the curvature may be there


def slip_off(profile: Contour, tilt: float, beam: Beam | None = None) -> float | None:
    """Foot position at which a vibrissa that leans sideways slips off the object.

    Parameters
    ----------
    profile : Contour
        The body's contour, of a prism across the plane of the sweep [length].
    tilt : float
        Angle between the tangent at the clamp and the plane of the sweep [rad].
    beam : Beam, optional
        The vibrissa; ``Beam()`` if not given.

    Returns
    -------
    float or None
        Of a sweep in the direction of decreasing foot_x [length]. None if the vibrissa leans so
        much that it swings round the tangent at its clamp steadily and not in a jump.

    Raises
    ------
    InputError
        If the tilt is zero (see `find_events`, ``out_of_plane``) or large, or the vibrissa is
        curved at rest.
    """
    if not 0 < abs(tilt) <= _LARGEST:
        raise InputError("tilt", f"{tilt} rad", f"up to {_LARGEST} rad, not zero", "it is in rad")
    beam = Beam() if beam is None else beam
    require_plain("the slip-off", beam)
    ends = [[foot_x, 0.0] for foot_x in Case(beam, profile).foot_x[[0, -1]]]
    path = FootPath(ends, tangent=(0.0, np.cos(tilt), np.sin(tilt)))
    way = SpatialCase(beam, body=prism(profile), path=path).way
    branch = Branch(Scene(way.body, path.clamp_tangent, way.radius), way, friction=0.0)
    touch = way.next_touch(0.0)
    held = None if touch is None else branch.begin(touch)
    stretch = held and held.stretch
    while stretch and stretch.event not in LAST:
        stretch = branch.after(stretch)
    if stretch is None:
        raise ArithmeticError(f"the equilibria along {profile.label} are lost")
    last = stretch.last
    if stretch.event == "release" or last.contact.spot.normal[0] < _AT_LOWEST:
        return None
    return float(way.foot(last.travel)[0]) * beam.length
