"""Contact points by any method, from readings with a known level of noise."""

import numpy as np
import pandas as pd

from analytic import Readings, reconstruct, reconstruct_by_decision

_EXACT = 1e-6  # of criterion (26), for readings without noise
_SIGMAS = 4.0  # times the noise; the criterion has errors of its size


def contacts_by(sensed: Readings, method: str, level: float) -> pd.DataFrame:
    if method != "decision":
        return reconstruct(sensed, method=method)
    # Where noise makes an impossible force, the square root of the closed form is none.
    with np.errstate(invalid="ignore"):
        return reconstruct_by_decision(sensed, tolerance=max(_EXACT, _SIGMAS * level))
