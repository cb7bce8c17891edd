"""Readings of the vibrissa against given points of a contour."""

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from analytic.problem.beam import Beam
from analytic.problem.contours.contour import Contour
from analytic.problem.errors import InputError
from analytic.solver.equilibria import equilibria, to_columns


def solve_contact(profile: Contour, alpha: ArrayLike, beam: Beam | None = None) -> pd.DataFrame:
    """Clamp readings and contact of a vibrissa that touches `profile` where its slope is `alpha`.

    Parameters
    ----------
    profile : Contour
        The body's contour [length].
    alpha : array_like, shape (n,)
        Slope angles of the contact points [rad].
    beam : Beam, optional
        The vibrissa; ``Beam()`` if not given.

    Returns
    -------
    pandas.DataFrame
        n rows with the columns of `Readings.table`, in the units of `beam`. ``status`` is
        ``"unreachable"``, and the readings NaN, where no vibrissa reaches.

    Raises
    ------
    InputError
        If an angle is not within [-pi/2, pi/2].
    """
    beam = Beam() if beam is None else beam
    angles = np.atleast_1d(np.asarray(alpha, dtype=float))
    outside = ~(np.abs(angles) <= np.pi / 2)
    if outside.any():
        raise InputError(
            "alpha",
            f"{angles[outside][0]} rad",
            "between -pi/2 and pi/2 rad, the slope angles of the lower side of a body",
            "angles are in rad",
        )
    centreline = profile.scaled(1 / beam.length).offset(beam.radius / beam.length)
    states = equilibria(centreline, centreline.parameter(angles))
    return pd.DataFrame(to_columns(states, beam))
