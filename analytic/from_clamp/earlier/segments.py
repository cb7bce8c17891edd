"""A vibrissa of straight segments, bent joint by joint from the contact to the base.

B. W. Quist and M. J. Z. Hartmann, Mechanical signals at the base of a rat vibrissa: the effect of
intrinsic vibrissa curvature and implications for tactile exploration, Journal of Neurophysiology
107, 2012. Their model takes the force to be normal to the vibrissa, which it is at a tangential
contact; at the tip it is not, and the answer is off whatever the number of segments.
"""

from typing import NamedTuple

import numpy as np

from analytic.from_clamp.earlier.sensed import Answer, Sensed
from analytic.problem.arrays import Booleans, Floats, Integers
from analytic.problem.roots import zeros

_ROUNDING = 1e-9  # of a segment; nearer to a joint the contact is at the joint


class _Bent(NamedTuple):
    """The base as seen from the contact, whose tangent is the x-axis; arrays of shape (n,)."""

    x: Floats
    y: Floats
    turned: Floats


def by_segments(sensed: Sensed, segments: int = 40, half_cell: bool = False) -> Answer:
    """The contact from which the segments turn the base by as much as the force says."""
    force = np.hypot(sensed.across, sensed.along)
    # Where the force is normal to the vibrissa, at the contact, the base is turned away by so much.
    turn = np.arctan2(sensed.along, sensed.across)
    half = 0.5 / segments if half_cell else 0.0
    whole, found = _bracket(force, turn, segments, half)
    at = np.flatnonzero(found & (turn > 0))

    def beyond(which: Integers, rest: Floats) -> Floats:
        some = at[which]
        return _bend(force[some], rest, whole[some], segments, half).turned - turn[some]

    rest = np.zeros_like(force)  # a contact that turns nothing away is at the base
    rest[at] = zeros(beyond, rest[at], np.full(at.size, 1 / segments))
    across, height = _from_base(_bend(force, rest, whole, segments, half))
    return Answer(sensed.foot_x + across, height).where(found)


def contact_under(
    force: Floats, arc_length: Floats, segments: int = 40, half_cell: bool = False
) -> Answer:
    """Where the model has the contact, given the force's size and place: its forward problem."""
    whole = np.floor(arc_length * segments + _ROUNDING)
    rest = np.maximum(arc_length - whole / segments, 0.0)
    half = 0.5 / segments if half_cell else 0.0
    return Answer(*_from_base(_bend(force, rest, whole, segments, half)))


def _from_base(bent: _Bent) -> tuple[Floats, Floats]:
    """The contact as the base sees it: to the side, and along its tangent."""
    cos, sin = np.cos(bent.turned), np.sin(bent.turned)
    return np.abs(cos * bent.y - sin * bent.x), -(cos * bent.x + sin * bent.y)


def _bracket(force: Floats, turn: Floats, segments: int, half: float) -> tuple[Floats, Booleans]:
    """How many whole segments there are between the base and the first contact that fits."""
    h = 1 / segments
    x, y, turned = np.full_like(force, -h), np.zeros_like(force), np.zeros_like(force)
    whole = np.zeros_like(force)
    found = turned - half * x * force >= turn  # the contact is on the first segment
    for number in range(1, segments):
        x, y, turned = _joint(force, x, y, turned, h)
        now = ~found & (turned - half * x * force >= turn)
        whole[now] = number
        found |= now
    return whole, found


def _bend(force: Floats, rest: Floats, whole: Floats, segments: int, half: float) -> _Bent:
    """From a contact at `rest` beyond so many whole segments."""
    x, y, turned = -rest, np.zeros_like(force), np.zeros_like(force)
    for number in range(int(whole.max(initial=0))):
        there = number < whole
        nx, ny, nturned = _joint(force, x, y, turned, 1 / segments)
        x, y = np.where(there, nx, x), np.where(there, ny, y)
        turned = np.where(there, nturned, turned)
    return _Bent(x, y, turned - half * x * force)


def _joint(
    force: Floats, x: Floats, y: Floats, turned: Floats, h: float
) -> tuple[Floats, Floats, Floats]:
    """Bend at a joint, and go on to the next."""
    turned = turned - force * x * h
    return x - h * np.cos(turned), y - h * np.sin(turned), turned
