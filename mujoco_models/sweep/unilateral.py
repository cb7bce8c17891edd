"""Which contacts push, and how hard, in a quadratic model of the energy.

A beam that lies on a facet may rest on thousands of beads. What those give way by follows from the
turns of far fewer links, but for each one's own softness: Sherman, Morrison and Woodbury's formula
makes the cost linear in the contacts.
"""

from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dposv

from analytic.problem.arrays import Booleans, Floats, Integers

_TRIALS = 5  # of sets of contacts that may be the loaded ones
_MOST = 3  # times the contacts: so many are pressed; usually fewer than there are
_CUT = 1e-13  # of the largest gap: what rounding leaves open


class _Few(NamedTuple):
    """The compliance of contacts as a matrix."""

    whole: Floats  # shape (n, n); [L^3/EI]

    def forces(self, held: Integers, gap: Floats) -> Floats | None:
        """What closes the gaps of those that are held; None if that is not stable."""
        among = self.whole.take(held, axis=0).take(held, axis=1)
        _, found, failed = dposv(among, -gap)
        return None if failed else found

    def moved(self, force: Floats) -> Floats:
        """How far forces move all contacts."""
        return np.asarray(self.whole @ force)


class _Many(NamedTuple):
    """The same where contacts outnumber the links, which is what its rank is."""

    # Shape (n, n_links); How far each contact moves as a link turns, and how links turn under a
    # unit of its force.
    comes: Floats
    # Shape (n, n_links); How far each contact moves as a link turns, and how links turn under a
    # unit of its force.
    turns: Floats
    soft: Floats  # shape (n,); The contacts' own [L^3/EI]

    @property
    def whole(self) -> Floats:
        """As a matrix."""
        return np.asarray(self.comes @ self.turns.T + np.diag(self.soft))

    def forces(self, held: Integers, gap: Floats) -> Floats | None:
        """What closes the gaps of those that are held; None if that is not stable."""
        comes, stiff = self.comes[held], 1 / self.soft[held]
        pushed = self.turns[held].T * stiff
        links = np.linalg.solve(np.eye(comes.shape[1]) + pushed @ comes, pushed @ gap)
        return np.asarray(-stiff * (gap - comes @ links))

    def moved(self, force: Floats) -> Floats:
        """How far forces move all contacts."""
        return np.asarray(self.comes @ (force @ self.turns) + self.soft * force)


def unilateral(comes: Floats, turns: Floats, soft: Floats, gap: Floats, guess: Booleans) -> Floats:
    """Contact forces that push, or are zero where a gap stays open.

    What pulls is let go and what is cut is pressed, until nothing does; usually at once. If that
    goes round in circles, an active-set method that never does finds them.
    """
    compliance: _Few | _Many
    if len(gap) > comes.shape[1]:
        compliance = _Many(comes, turns, soft)
    else:
        whole = comes @ turns.T
        whole.reshape(-1)[:: len(gap) + 1] += soft
        compliance = _Few(whole)
    for _ in range(_TRIALS):
        force, held = np.zeros(len(gap)), guess.nonzero()[0]
        if held.size:
            found = compliance.forces(held, gap.take(held))
            if found is None:
                break
            force[held] = found
        wrong = np.where(guess, force, compliance.moved(force) + gap) < 0
        if not np.count_nonzero(wrong):
            return force
        guess = guess ^ wrong
    return _active_set(compliance, gap)


def _active_set(compliance: _Few | _Many, gap: Floats) -> Floats:
    """Contact forces by the method of Lawson and Hanson (*Solving least squares problems*, 1974).

    The contact that is cut deepest is pressed too, one after the other; what would pull then is let
    go on the way there. The energy falls with each that is added, so that no set comes twice.
    """
    force, held = np.zeros(len(gap)), np.zeros(len(gap), dtype=bool)
    for _ in range(_MOST * len(gap)):
        left = compliance.moved(force) + gap
        left[held] = 0.0
        if left.min() >= -_CUT * np.abs(gap).max():
            return force
        pressed = left.argmin()
        held[pressed] = True
        while True:
            wanted = np.zeros(len(gap))
            found = compliance.forces(held.nonzero()[0], gap[held])
            if found is None:
                raise np.linalg.LinAlgError("the stiffness of contacts is not positive definite")
            wanted[held] = found
            pulls = held & (wanted < 0)
            if not pulls.any():
                break
            share = force[pulls] / (force[pulls] - wanted[pulls])
            force += share.min() * (wanted - force)
            held[pulls.nonzero()[0][share == share.min()]] = False
            force[~held] = 0.0
        force = wanted
        if not held[pressed]:
            return force  # it would pull at once: rounding is all that is left
    raise np.linalg.LinAlgError("no set of contacts pushes alone")
