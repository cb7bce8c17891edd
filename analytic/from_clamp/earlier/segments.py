"""A vibrissa of straight segments, bent joint by joint from the contact to the base.

B. W. Quist and M. J. Z. Hartmann, Mechanical signals at the base of a rat vibrissa: the effect of
intrinsic vibrissa curvature and implications for tactile exploration, Journal of Neurophysiology
107, 2012. Their model takes the force to be normal to the vibrissa, which it is at a tangential
contact; at the tip it is not, and the answer is off whatever the number of segments.
"""

from typing import NamedTuple

import numpy as np

from analytic.from_clamp.earlier.sensed import Answer, LoadedStations
from analytic.numerics.roots import zeros
from analytic.problem.arrays import Floats, Integers


class BaseSeen(NamedTuple):
    """The base as seen from the contact, whose tangent is the x-axis; arrays of shape (n,)."""

    x: Floats
    y: Floats
    turned: Floats


def by_segments(sensed: LoadedStations, segments: int = 40, half_cell: bool = False) -> Answer:
    """The contact from which the segments turn the base by as much as the force says."""
    force = np.hypot(sensed.across, sensed.along)
    # Where the force is normal to the vibrissa, at the contact, the base is turned away by so much.
    turn = np.arctan2(sensed.along, sensed.across)
    half = 0.5 / segments if half_cell else 0.0
    size, every = np.full_like(force, 1 / segments), np.ones_like(force)
    enough = np.array(
        [bent(force, size, n * every, segments, half).turned >= turn for n in range(segments)]
    )
    found, whole = np.asarray(enough.any(axis=0)), enough.argmax(axis=0).astype(float)
    at = np.flatnonzero(found & (turn > 0))

    def beyond(which: Integers, rest: Floats) -> Floats:
        some = at[which]
        return bent(force[some], rest, whole[some], segments, half).turned - turn[some]

    rest = np.zeros_like(force)  # a contact that turns nothing away is at the base
    rest[at] = zeros(beyond, rest[at], size[at])
    across, height = from_base(bent(force, rest, whole, segments, half))
    return Answer(sensed.foot_x + across, height).where(found)


def from_base(seen: BaseSeen) -> tuple[Floats, Floats]:
    """The contact as the base sees it: to the side, and along its tangent."""
    cos, sin = np.cos(seen.turned), np.sin(seen.turned)
    return np.abs(cos * seen.y - sin * seen.x), -(cos * seen.x + sin * seen.y)


def bent(force: Floats, rest: Floats, whole: Floats, segments: int, half: float) -> BaseSeen:
    """From a contact at `rest` beyond so many whole segments, joint by joint."""
    h = 1 / segments
    x, y, turned = -rest, np.zeros_like(force), np.zeros_like(force)
    for number in range(int(whole.max(initial=0))):
        there = number < whole
        turned = np.where(there, turned - force * x * h, turned)
        x = np.where(there, x - h * np.cos(turned), x)
        y = np.where(there, y - h * np.sin(turned), y)
    return BaseSeen(x, y, turned - half * x * force)
