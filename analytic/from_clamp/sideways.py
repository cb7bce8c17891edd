r"""Whether the planar vibrissa keeps to its plane, when nothing but the obstacle holds it there.

The obstacle is a frictionless prism along z, the vibrissa's section round. Both phases of contact
are then the same problem: the obstacle presses with the dead force F = f (sin alpha, -cos alpha, 0)
at arc length s1, since a displacement along z is along the prism, and at tangential contact one
along the vibrissa does not change the distance to first order.

**Twist.** The contact applies no moment about the vibrissa's axis, so the vibrissa at rest is not
twisted; of all with one centreline the untwisted one has the least energy, whatever its torsional
stiffness GJ. What follows is about the centreline alone, and GJ drops out of it *exactly*.

**Stability.** Let psi(s) be the elevation of the tangent out of the plane and theta = phi - alpha.
The second variation of the energy is

    J = (1/2) int_0^s1 [psi'^2 - (kappa^2 + f sin theta) psi^2] ds,   psi(0) = 0.

A turn of the whole vibrissa about the direction of the force changes nothing, so psi = cos theta
solves Jacobi's equation; and psi' = -kappa sin theta vanishes at the contact, where kappa does. By
Jacobi's criterion J is positive definite if and only if cos theta has no zero from the contact to
the clamp. Theta is pi/2 - alpha at the clamp and falls to phi1 - alpha, within [0, pi/2), at the
contact: no zero for alpha > 0, exactly one for alpha < 0. **The planar vibrissa is stable in space
if and only if alpha > 0**; at alpha = 0 it turns freely about the tangent at its clamp.

**No other equilibria.** Untwisted, with a moment everywhere normal to F, the vibrissa lies in the
plane of F and of the tangent at its clamp. If that is not the plane of the sweep, then alpha = 0,
and it is turned by tau, cos tau = (xi - x0)/X, where X is the reach at alpha = 0. Such equilibria
exist for x0 > xi - X, that is, *before* stability is lost, and are unstable: whichever way they
turn, the contact slides up the object's side, and the vibrissa unbends. So beyond that place there
is nothing to bend out to. The vibrissa swings round the tangent at its clamp, off the object or to
its other side, bent the other way. Before it, only turns of less than tau are safe.

**Stiffness.** Under a force Z along z at the contact psi = Z cos(phi)/(f sin alpha): the vibrissa
turns as a whole about the tangent at its clamp, like a pendulum. With X = int cos(phi) ds,

    Z/z = f sin(alpha)/X = -F_Ax/(xi - x0).

So the clamp shows it: a sweep is held in its plane as long as `force_x` has not changed its sign.
"""

import numpy as np

from analytic.from_clamp.contact import located
from analytic.numerics.arrays import Floats
from analytic.problem.readings import Readings, require_readings


def sideways_stiffness(readings: Readings) -> Floats:
    """How stiffly the vibrissa is held in the plane of its sweep, from what its clamp feels.

    Parameters
    ----------
    readings : Readings
        Only the four sensed columns are used.

    Returns
    -------
    array, shape (stations,)
        Force across the plane over displacement, at the contact [force/length]: negative where the
        vibrissa leaves the plane unless something holds it. NaN where nothing touches.
    """
    require_readings(readings).require_plain("the sideways stiffness")
    contact_x = located(readings).xi * readings.beam.length
    return np.asarray(-readings.values("force_x") / (contact_x - readings.values("foot_x")))
