"""The order of a measured chain in its number of links, by chains of the same layout."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import root

from analytic.numerics.arrays import Floats
from compare.simulate.rigidity import as_intended, is_straight, smooth_rigidity, tapers, tip_of
from mujoco_models.inspect.measured import MeasuredBeam

_FEWEST = 4  # joints: two of them are ends, and the others have to be alike
_ALIKE = 1e-3  # relative; of the lengths of links that are one length
_AT_REST = 1e-12  # relative change of the rotations
_BALANCED = 1e-10  # rad


@dataclass(frozen=True)
class OrderInLinks:
    """What more links of the same layout would give."""

    links: float  # number of them: the length over that of a link
    first: float  # where it first bends, in links from the clamp: 0.5 is of second order
    order: float  # in the number of links: of the tip's distance from the exact cantilever's
    # Of the measured one: the largest distance of the tip from that of the exact cantilever with
    # the EI that its joints stand for, of all loads [L].
    error: float
    # Of chains of the same layout with twice and four times as many links, which the order is of.
    error_of_twice: float  # [L]
    error_of_fourfold: float  # [L]


def order_in_links(found: MeasuredBeam) -> OrderInLinks | None:
    """How fast a chain that is refined as it is laid out tends to the exact cantilever.

    Its layout is where the first and the last joint are within their links, and how much softer
    or stiffer than the others they are.
    """
    s = np.array([joint.s for joint in found.joints]) / found.length
    if len(s) < _FEWEST or tapers(found) or not is_straight(found):
        return None
    gaps = np.diff(s)
    link = float(gaps.mean())
    if np.ptp(gaps) > _ALIKE * link:
        return None
    rigidity = as_intended(found)
    loads = found.loads * found.length**2 / rigidity
    exact = tip_of(loads)
    own = [joint.compliance for joint in found.joints]
    meant = link * found.length / smooth_rigidity(found)
    # Relative to a whole link's: a hinge at the clamp may be twice as stiff, or not.
    softer = own[0] / meant[0], own[-1] / meant[-1]
    ends = s[0] / link, (1 - s[-1]) / link

    def refined(parts: int) -> tuple[float, float]:
        """Number of links, and how far the tip is off the exact one."""
        count = round(parts / link - sum(ends)) + 1
        links = sum(ends) + count - 1
        compliances = np.full(count, 1 / links)
        compliances[[0, -1]] *= softer
        tips = tips_of_chain((ends[0] + np.arange(count)) / links, compliances, loads)
        return links, _farthest(tips - exact)

    (twice, middle), (fourfold, fine) = map(refined, (2, 4))
    return OrderInLinks(
        links=1 / link,
        first=float(ends[0]),
        order=math.log(middle / fine) / math.log(fourfold / twice),
        error=_farthest(found.bent / found.length - exact),
        error_of_twice=middle,
        error_of_fourfold=fine,
    )


def _farthest(off: Floats) -> float:
    return float(np.linalg.norm(off, axis=1).max())


def tips_of_chain(places: Floats, compliances: Floats, loads: Floats) -> Floats:
    """Where the tip of a chain of rigid links is under a force across its unloaded axis."""
    lengths = np.diff(places, append=1.0)
    rotations = np.zeros(len(places))
    tips = []
    for load in np.asarray(loads, dtype=float).tolist():
        rotations = _at_rest(lengths, compliances, load, rotations)
        slopes = np.cumsum(rotations)
        along = places[0] + lengths @ np.cos(slopes)
        tips.append([lengths @ np.sin(slopes), 1 - along])
    return np.array(tips)


def _at_rest(lengths: Floats, compliances: Floats, load: float, start: Floats) -> Floats:
    """Rotations of the joints; a joint's moment is the load times its lever."""

    def off(rotations: Floats) -> Floats:
        levers = np.cumsum((lengths * np.cos(np.cumsum(rotations)))[::-1])[::-1]
        return np.asarray(load * compliances * levers - rotations)

    found = root(off, start, tol=_AT_REST)
    if np.abs(found.fun).max() > _BALANCED:
        raise ArithmeticError(f"a chain of {len(start)} links does not come to rest")
    return np.asarray(found.x)
