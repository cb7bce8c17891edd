"""Methods of small deflections: the beam bends little, and the force along it does nothing."""

import numpy as np

from analytic.from_clamp.earlier.sensed import Answer, LoadedStations
from analytic.problem.arrays import Floats


def binary(sensed: LoadedStations) -> Answer:
    """The tip of the straight vibrissa, wherever there is a load: contact or no contact."""
    return Answer(sensed.foot_x, np.ones_like(sensed.foot_x))


def from_moment_and_travel(sensed: LoadedStations) -> Answer:
    """The height of a point object that a cantilever is pushed against, from moment and travel.

    A cantilever that is displaced by delta at the height eta has the moment 3 delta/eta^2 at its
    clamp (the idea of M. Kaneko, N. Kanayama and T. Tsuji, Active antenna for contact sensing,
    IEEE Transactions on Robotics and Automation 14, 1998, for a translation; derived here).
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        height = np.sqrt(3 * sensed.travel / sensed.moment)
    return _at(sensed.foot_x + sensed.travel, height)


def from_slope_and_travel(sensed: LoadedStations, sensor: float = 0.05) -> Answer:
    """The same from the slope at a short distance from the clamp; needs no flexural rigidity.

    With the slope tau at the distance x of the sensor and the travel delta, the height d solves
    2 tau d^3 - 6 delta x d + 3 delta x^2 = 0, its largest root (the idea of D. Kim and R. Moeller,
    Biomimetic whiskers for shape recognition, Robotics and Autonomous Systems 55, 2007; derived
    here). The slope is what the clamp's readings make of it, M x - Q x^2/2.
    """
    slope = sensor * sensed.moment - sensor**2 * sensed.across / 2
    with np.errstate(divide="ignore", invalid="ignore"):
        # d^3 - 3 a d + b = 0 has the largest root 2 sqrt(a) cos(arccos(-b/(2 a^1.5))/3).
        a = sensed.travel * sensor / slope
        b = 1.5 * sensed.travel * sensor**2 / slope
        height = 2 * np.sqrt(a) * np.cos(np.arccos(-b / (2 * a**1.5)) / 3)
    return _at(sensed.foot_x + sensed.travel, height)


def from_force_and_moment(sensed: LoadedStations) -> Answer:
    """A cylinder of small deflection: the lever a = M/Q, and the deflection Q a^3/3 there.

    After J. A. Birdwell and others, Biomechanical models for radial distance determination by the
    rat vibrissal system, Journal of Neurophysiology 98, 2007.
    """
    lever, deflection = _lever(sensed), sensed.across
    with np.errstate(over="ignore", invalid="ignore"):
        return _at(sensed.foot_x + deflection * lever**3 / 3, lever)


def from_force_and_moment_of_cone(sensed: LoadedStations) -> Answer:
    """A cone that ends in a point: the lever a = M/Q, the deflection Q a^3/(3 (1 - a)) there.

    After Birdwell and others, as `from_force_and_moment`; the flexural rigidity at the base is 1.
    """
    lever = _lever(sensed)
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        deflection = sensed.across * lever**3 / (3 * (1 - lever))
    return _at(sensed.foot_x + deflection, lever).where(lever < 1)


def from_beam_column(sensed: LoadedStations) -> Answer:
    """Second-order theory: small slopes, but the force along the beam bends it, too.

    M = Q tan(k a)/k with k^2 = P gives the height a, and the deflection is (Q/P)(tan(k a)/k - a);
    S. P. Timoshenko and J. M. Gere, Theory of elastic stability, 1961, section 1.11.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        k = np.sqrt(sensed.along)
        height = np.arctan(k * sensed.moment / sensed.across) / k
        deflection = (sensed.moment - sensed.across * height) / sensed.along
    return _at(sensed.foot_x + deflection, height)


def _lever(sensed: LoadedStations) -> Floats:
    with np.errstate(divide="ignore", invalid="ignore"):
        return sensed.moment / sensed.across


def _at(x: Floats, y: Floats) -> Answer:
    """That point, if it is above the clamp."""
    with np.errstate(invalid="ignore"):
        return Answer(x, y).where(np.isfinite(x) & (y > 0))
