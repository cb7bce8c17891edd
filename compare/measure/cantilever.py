"""The exact cantilever under a dead load on its tip, across its undeformed axis."""

import numpy as np
from scipy.optimize import brentq

from analytic.problem.arrays import Floats
from analytic.solver.elastica import frame, span

_ACROSS = np.array(np.pi / 2)  # slope of a contour that presses along x


def tip_of(loads: Floats) -> Floats:
    """Where the tip of the inextensible elastica is: across, and how far it has come down.

    It is the vibrissa whose tip is pressed by an upright wall without friction.
    """
    return np.array([_tip(np.sqrt(load)) for load in np.asarray(loads, dtype=float).tolist()])


def _tip(root: float) -> tuple[float, float]:
    """Of the root of P L^2/EI; the tip's rotation is found from it."""
    turned = brentq(
        lambda w: float(span(np.array(w), _ACROSS).q) - root, 1e-14, np.pi / 2 - 1e-14, xtol=1e-15
    )
    up, across = frame(span(np.array(turned), _ACROSS), _ACROSS)
    return float(across) / root, 1 - float(up) / root
