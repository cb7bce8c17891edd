"""Readings of the vibrissa against given points of a contour."""

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from analytic.problem.beam import Beam
from analytic.problem.errors import InputError
from analytic.problem.profile import Profile
from analytic.solver.equilibria import equilibria, to_table


def solve_contact(profile: Profile, alpha: ArrayLike, beam: Beam | None = None) -> pd.DataFrame:
    """Clamp readings and contact of a vibrissa that touches `profile` where its slope is `alpha`.

    Parameters
    ----------
    profile : Profile
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
        If an angle is not finite or lies outside the contour's range.
    """
    beam = Beam() if beam is None else beam
    angles = np.atleast_1d(np.asarray(alpha, dtype=float))
    low, high = profile.alpha_range
    outside = ~((angles >= low) & (angles <= high))
    if outside.any():
        raise InputError(
            "alpha",
            f"{angles[outside][0]} rad",
            f"between {low:.6g} and {high:.6g} rad, the contour's slope angles",
            "angles are in rad",
        )
    centreline = profile.scaled(1 / beam.length).offset(beam.radius / beam.length)
    return to_table(equilibria(centreline, angles), beam)
