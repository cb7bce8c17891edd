"""How much earlier a vibrissa slips off sideways whose clamp leans out of the plane of the sweep.

Untwisted and with a moment everywhere normal to the force, the vibrissa lies in the plane of the
force F = f (sin alpha, -cos alpha, 0) and of the tangent c = (0, cos tilt, sin tilt) at its clamp
(`analytic.from_clamp.sideways`). In that plane it is the planar vibrissa of slope angle lean, the
angle between c and -F: cos(lean) = cos(alpha) cos(tilt). Its end, `up` along c and `across` along
e = (F/f + cos(lean) c)/sin(lean), is at

    eta = up cos(tilt) - across cos(alpha) sin(tilt)^2/sin(lean)
    xi - x0 = across sin(alpha)/sin(lean).

A fold of x0(alpha) at some alpha > 0 replaces the loss of stability at alpha = 0. For small tilts

    alpha = (X tilt^2/x0')^(1/3),   x0 - x0(0) = (3/2) x0' alpha,

with the reach X and the rate x0' = dx0/dalpha of the planar vibrissa at alpha = 0: a power of 2/3,
as for every imperfect column of the same kind.
"""

import numpy as np

from analytic.numerics.roots import zeros
from analytic.problem.arrays import Floats, Integers
from analytic.problem.beam import Beam
from analytic.problem.contours.contour import Contour
from analytic.problem.errors import InputError
from analytic.problem.reach import contact_range
from analytic.problem.support import given_contour, require_plain
from analytic.solver.elastica import Span, frame, span

_GRID = 801  # contour points to find the fold between; it is then exact
_LEAST = 1e-18  # rad; less than any rotation of a tip that is loaded
_LARGEST = 0.5  # rad


def slip_off(profile: Contour, tilt: float, beam: Beam | None = None) -> float | None:
    """Foot position at which a vibrissa that leans sideways slips off the object.

    Parameters
    ----------
    profile : Contour
        The body's contour [length].
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
    contour = given_contour(profile, beam)
    require_plain("the slip-off", beam)
    first = contact_range(contour)[1]
    lowest = float(contour.parameter(np.zeros(1))[0])
    grid = lowest + (first - lowest) * np.linspace(1, 0, _GRID) ** 2  # dense where the fold is
    foot_x = _foot_x(contour, grid, tilt)
    least = int(np.nanargmin(foot_x))
    if least == _GRID - 1:
        return None
    from scipy.optimize import minimize_scalar  # slow to load

    found = minimize_scalar(
        lambda t: float(_foot_x(contour, np.array([t]), tilt)[0]),
        bounds=(grid[least + 1], grid[least - 1]),
        method="bounded",
        options={"xatol": 1e-9},
    )
    return float(found.fun) * beam.length


def _foot_x(contour: Contour, t: Floats, tilt: float) -> Floats:
    """Foot position of the leaning vibrissa, shape (n,) [L]; NaN where it does not reach."""
    alpha, xi, eta = contour.at(t)[:3]
    lean = np.arccos(np.cos(alpha) * np.cos(tilt))
    sunk = np.cos(alpha) * np.sin(tilt) ** 2 / np.sin(lean)

    def rise(which: Integers | slice, loaded: Span) -> Floats:
        """The contact's height, times sqrt(f)."""
        up, across = frame(loaded, lean[which])
        return np.asarray(up * np.cos(tilt) - across * sunk[which])

    def too_high(which: Integers, rotation: Floats) -> Floats:
        loaded = span(rotation, lean[which])
        return rise(which, loaded) - eta[which] * loaded.q

    # Tangential contact if that fits on the vibrissa, else the rotation at which the tip is there.
    high = np.pi / 2 - lean
    tangential = span(high, lean)
    root_f = rise(slice(None), tangential) / eta
    tip = tangential.q > root_f
    low = np.full_like(high, _LEAST)
    reached = ~tip | (too_high(np.arange(low.size), low) > 0)
    at_tip = span(zeros(too_high, low, high), lean)
    loaded = Span(*(np.where(tip, a, b) for a, b in zip(at_tip, tangential, strict=True)))
    reach = frame(loaded, lean).across / np.where(tip, loaded.q, root_f)
    return np.where(reached, xi - reach * np.sin(alpha) / np.sin(lean), np.nan)
