"""The contact of the elastica that has one station's clamp readings, in closed form."""

from typing import NamedTuple

import numpy as np

from analytic.problem.arrays import Floats
from analytic.problem.columns import SENSED
from analytic.problem.readings import Readings
from analytic.solver.elastica import frame, span_of_moment

UNLOADED = 1e-9
"""Force that has no direction to speak of, over EI/L^2."""
LONGEST = 1.1
"""Longest arc length of a contact, over L; one at the tip may seem so through noise."""


class Contact(NamedTuple):
    """Contact points of the centreline, dimensionless; arrays of one shape."""

    alpha: Floats
    arc_length: Floats
    xi: Floats
    eta: Floats

    def surface(self, radius: float) -> tuple[Floats, Floats]:
        """The contact on the body's surface.

        Parameters
        ----------
        radius : float
            Of the vibrissa [L].

        Returns
        -------
        x, y : array, shape (...)
            Coordinates [L], of the shape of the contacts.
        """
        return self.xi - radius * np.sin(self.alpha), self.eta + radius * np.cos(self.alpha)


def dimensionless(readings: Readings) -> Floats:
    """The sensed columns over L, EI/L^2 and EI/L.

    Parameters
    ----------
    readings : Readings
        One sweep.

    Returns
    -------
    array, shape (4, stations)
        ``foot_x, force_x, force_y, moment_z``.
    """
    beam = readings.beam
    units = (beam.length, beam.force_unit, beam.force_unit, beam.moment_unit)
    return np.array([readings.values(n) / u for n, u in zip(SENSED, units, strict=True)])


def sides(sensed: Floats) -> Floats:
    """To which side the vibrissa bends, by the sign of its moment.

    Parameters
    ----------
    sensed : array, shape (4, ...)
        Dimensionless.

    Returns
    -------
    array, shape (4, ...)
        Factors that turn `sensed` into readings of a vibrissa that bends to the right.
    """
    side = np.where(sensed[3] < 0, -1.0, 1.0)
    return np.stack([side, side, np.ones_like(side), side])


def contact_of(sensed: Floats) -> Contact:
    """Contacts of stations, each bent to its own side.

    Parameters
    ----------
    sensed : array, shape (4, stations)
        Dimensionless.

    Returns
    -------
    Contact
        NaN where no elastica has such readings, or none is given.
    """
    turned = sides(sensed)
    found = contact_bent_right(turned * sensed)
    return Contact(turned[0] * found.alpha, found.arc_length, turned[0] * found.xi, found.eta)


def located(readings: Readings) -> Contact:
    """Contacts of a sweep, station by station, on the vibrissa.

    Parameters
    ----------
    readings : Readings
        Only the four sensed columns are used.

    Returns
    -------
    Contact
        Each of shape (stations,); NaN without a force, and where no such vibrissa has the readings.

    Raises
    ------
    InputError
        If the vibrissa is curved at rest, its clamp turns, or the object rubs.
    """
    readings.require_plain("the contact from the clamp")
    sensed = dimensionless(readings)
    found = contact_of(np.where(np.hypot(sensed[1], sensed[2]) > UNLOADED, sensed, np.nan))
    there = (found.arc_length >= 0) & (found.arc_length <= LONGEST)
    return Contact(*(np.where(there, values, np.nan) for values in found))


def contact_bent_right(sensed: Floats) -> Contact:
    """Slope angle, arc length and position of the contact, for moments from 0 up.

    The force's direction is the contour's normal, so tan(alpha) = -F_x/F_y; force and moment fix
    the modulus, k^2 = (1 + (M^2 - 2 F_y)/(2 f))/2, and with it the whole elastica up to where its
    curvature vanishes, which is the contact.

    Parameters
    ----------
    sensed : array, shape (4, ...)
        Dimensionless.

    Returns
    -------
    Contact
        Of the shape of a row.
    """
    foot_x, force_x, force_y, moment = sensed
    root_f = np.sqrt(np.hypot(force_x, force_y))
    alpha = np.arctan2(-force_x, force_y)
    loaded = span_of_moment(moment / root_f, alpha)
    up, across = frame(loaded, alpha)
    return Contact(alpha, loaded.q / root_f, foot_x + across / root_f, up / root_f)
