"""Which contacts push, and how hard, in a quadratic model of the energy."""

import numpy as np
from scipy.linalg.lapack import dposv

from analytic.numerics.arrays import Booleans, Floats

_TRIALS = 5  # of sets of contacts that may be the loaded ones


def unilateral(comes: Floats, turns: Floats, soft: Floats, gap: Floats, guess: Booleans) -> Floats:
    """Contact forces that push, or are zero where a gap stays open.

    What pulls is let go and what is cut is pressed, until nothing does; usually at once. If that
    goes round in circles, least squares of forces that push find them.
    """
    compliance = comes @ turns.T
    compliance.reshape(-1)[:: len(gap) + 1] += soft
    for _ in range(_TRIALS):
        force, held = np.zeros(len(gap)), guess.nonzero()[0]
        if held.size:
            among = compliance.take(held, axis=0).take(held, axis=1)
            _, force[held], failed = dposv(among, -gap.take(held))
            if failed:
                break
        wrong = np.where(guess, force, compliance @ force + gap) < 0
        if not np.count_nonzero(wrong):
            return force
        guess = guess ^ wrong
    from analytic.numerics.descent import barring_forces  # slow to load, and few steps need it

    return barring_forces(compliance, gap, 0.0)
