"""The flexural rigidity that a measured model has along its beam, and shows at its tip."""

from functools import cache

import numpy as np
from scipy.optimize import brentq

from analytic import Beam
from analytic.numerics.arrays import Floats
from analytic.solver.elastica import frame, span
from mujoco_models.inspect.measured import Geom, MeasuredBeam

_POINTS = 2001  # of an integral along the beam
_BESIDE = 0.01  # of the first joint's place
_UNEVEN = 0.02  # relative; what tapers by less is uniform
_LEAST_COMPLIANCE = 0.01  # relative to a cell; what is left of a smooth course of EI
_STRAIGHT = 1e-6  # of the radius; a taper by less is the fit's rounding
_MUCH = 0.5  # of what a course from end to end leaves, some of its geoms are off
_STEPS = 2  # to a thicker stretch and back; beads have more
_CURVATURE = 0.01  # 1/L; the tip of such an arc is 0.005 L aside
_ACROSS = np.array(np.pi / 2)  # slope of a contour that presses along x


def smooth_rigidity(found: MeasuredBeam, at: Floats | None = None) -> Floats:
    """Flexural rigidity along the beam, without what single joints are off by.

    The fourth root of EI, in proportion to the radius of a round section, is fitted by a parabola
    in s with the least sum of deviations, over all joints but the first and the last: these stand
    for pieces of beam of other lengths, as the clamp and the tip are modelled.
    """
    wanted = np.array([joint.s for joint in found.joints]) if at is None else at
    return np.asarray(np.polyval(_root_along(found), wanted / found.length) ** 4)


@cache
def _root_along(found: MeasuredBeam) -> Floats:
    """The terms of that parabola, from the highest."""
    s = np.array([joint.s for joint in found.joints]) / found.length
    root = np.array([joint.flexural_rigidity for joint in found.joints]) ** 0.25
    inner = slice(1, -1) if len(s) > 4 else slice(None)
    return least_deviations(np.vander(s, 3 if len(s) > 6 else 1)[inner], root[inner])


def least_deviations(terms: Floats, values: Floats) -> Floats:
    """The fit of terms, in columns, with the least sum of deviations."""
    weights, most = np.ones(len(values)), max(float(np.abs(values).max()), 1e-9)
    for _ in range(50):
        fit = np.linalg.lstsq(weights[:, None] * terms, weights * values, rcond=None)[0]
        weights = 1 / np.sqrt(np.maximum(np.abs(values - terms @ fit), 1e-9 * most))
    return np.asarray(fit)


def as_intended(found: MeasuredBeam) -> float:
    """EI that a beam with that rigidity along it, clamped where this is, shows at its tip."""
    s = np.linspace(0, found.length, _POINTS)
    return _of_tip(s, smooth_rigidity(found, s))


def at_its_tip(found: MeasuredBeam) -> float:
    """The same of a beam that is as curved, whose tip moves by less."""
    return float(found.length**3 / (3 * flexibility(found, 0.0, found.length)))


def flexibility(found: MeasuredBeam, start: float, end: float) -> float:
    """How far the tip moves under a unit force by what bends between two arc lengths."""
    s = np.linspace(start, end, _POINTS)
    at = np.array([0.0, *(joint.s for joint in found.joints), found.length])
    arms = np.interp(s, at, [joint_arms(found)[0] + found.joints[0].s, *joint_arms(found), 0.0])
    return float(np.trapezoid(arms**2 / smooth_rigidity(found, s), s))


def joint_arms(found: MeasuredBeam) -> Floats:
    """How far ahead of each joint the tip is, along the vibrissa's first direction."""
    slopes = np.cumsum([joint.angle for joint in found.joints])
    links = np.diff([joint.s for joint in found.joints], append=found.length)
    return np.asarray(np.cumsum((links * np.cos(slopes))[::-1])[::-1])


def as_stated(beam: Beam) -> float:
    """EI that the tip of a vibrissa shows under a small force across it."""
    s = np.linspace(0, beam.length, _POINTS)
    return _of_tip(s, beam.rigidity_at(s))


def _of_tip(s: Floats, rigidity: Floats) -> float:
    flexibility = np.trapezoid((s[-1] - s) ** 2 / rigidity, s)
    return float(s[-1] ** 3 / (3 * flexibility))


def elastica_error(found: MeasuredBeam) -> float:
    """How far the tip is from the exact cantilever's of the same small deflection, at most [L]."""
    if tapers(found) or not is_straight(found):
        return float("nan")
    exact = tip_of(found.loads * found.length**2 / found.tip_rigidity)
    return float(np.linalg.norm(found.bent / found.length - exact, axis=1).max())


def by_its_clamp(found: MeasuredBeam) -> float:
    """EI that the tip shows by the first joint as it is and all others as they are meant."""
    first = found.joints[0]
    others = flexibility(found, first.cell, found.length)
    own = first.compliance * joint_arms(found)[0] ** 2
    return float(found.length**3 / (3 * (own + others)))


def by_its_links(found: MeasuredBeam) -> float:
    """EI that the tip shows by joints that stand for all of their cells, but for the first."""
    cells = np.array([joint.cell for joint in found.joints])
    each = cells / smooth_rigidity(found) * joint_arms(found) ** 2
    return float(found.length**3 / (3 * (flexibility(found, 0.0, cells[0]) + each[1:].sum())))


def clamp_stiffness(found: MeasuredBeam) -> float:
    """Rotational stiffness of the clamp that the first joint stands for beside its own cell."""
    bends = found.joints[0].cell / smooth_rigidity(found)[0]
    compliance = found.joints[0].compliance - bends
    if compliance <= _LEAST_COMPLIANCE * bends:
        return float("inf")
    return float(found.length / (as_intended(found) * compliance))


def hand_softens(found: MeasuredBeam) -> float:
    """How much less EI the tip shows by what turns between drive and clamp, relative."""
    turns = 0.0 if found.hand is None else found.hand.rotation
    return 3 * as_intended(found) / found.length * turns


def moving(found: MeasuredBeam) -> list[Geom]:
    """What touches and moves: not what is fixed to the foot."""
    start = found.joints[0].s
    return [g for g in found.geoms if g.meets and g.weight and g.end > start + _BESIDE * start]


def contact_stiffness(found: MeasuredBeam) -> float:
    """Median of what touches and moves [EI/L^3]."""
    stiffness = [g.stiffness for g in moving(found) if np.isfinite(g.stiffness)]
    unit = as_intended(found) / found.length**3
    return float(np.median(stiffness) / unit) if stiffness else float("nan")


def radii(found: MeasuredBeam) -> tuple[float, float]:
    """At the clamp and at the tip, of what touches: a straight course, of which some geoms are off.

    Beads on a thinner rod are one cylinder, and so is what gets thicker. Of a taper in steps, each
    is right in its middle.
    """
    own = [geom for geom in found.geoms if geom.meets] or [found.geoms[0]]
    radius, share = np.array([(geom.radius, geom.middle / found.length) for geom in own]).T
    beads = radius[-1] > radius[0] and np.diff(radius > radius.min()).sum() > _STEPS
    if beads or np.ptp(share) == 0:
        return (float(radius.max()),) * 2
    ends = [np.argmin(share), np.argmax(share)]
    courses = (
        np.polyfit(share[ends], radius[ends], 1),
        least_deviations(np.vander(share, 2), radius),
    )
    beside, least = (float(np.abs(np.polyval(one, share) - radius).sum()) for one in courses)
    slope, start = courses[int(least < beside * _MUCH)]  # steps are no geoms that are off
    if slope < -_STRAIGHT * start:
        return float(start), float(start + slope if start + slope > 0 else radius[-1])
    most = start if slope < _STRAIGHT * start else radius.max()
    return (float(radius[np.argmin(np.abs(radius - most))]),) * 2


def unevenness(found: MeasuredBeam) -> dict[Geom, float]:
    """By how much geoms that touch are thicker than a straight course of radii."""
    start, end = radii(found)
    return {
        geom: geom.radius - start - (end - start) * geom.middle / found.length
        for geom in found.geoms
        if geom.meets
    }


def counted_twice(found: MeasuredBeam) -> float:
    """The share of its capsules' volume where the round ends of one are in the next one."""
    balls = np.array([4 / 3 * np.pi * geom.radius**3 for geom in found.geoms if geom.rounded])
    rods = sum(np.pi * g.radius**2 * (g.end - g.start) for g in found.geoms if g.rounded)
    return float(balls[1:].sum() / (balls.sum() + rods)) if balls.size else 0.0


def is_cone(found: MeasuredBeam) -> bool:
    """Whether EI goes with the fourth power of a radius that is linear along it."""
    start, end = radii(found)
    s = np.linspace(0, 1, _POINTS)
    own = smooth_rigidity(found, s * found.length)
    meant = own[0] * (1 + (end / start - 1) * s) ** 4
    return bool(np.abs(own - meant).max() <= _UNEVEN * own.mean())


def tapers(found: MeasuredBeam) -> bool:
    """Whether EI changes along the beam, by more than two per cent."""
    rigidity = smooth_rigidity(found)
    return bool(np.ptp(rigidity) > _UNEVEN * rigidity.mean())


def is_curved(found: MeasuredBeam, stated: float = 0.0) -> bool:
    """Whether the beam at rest has another curvature than it should.

    The chords of an arc turn less than it does: by half of its first and of its last piece.
    """
    pieces = found.joints[0].s + found.length - found.joints[-1].s
    allowed = _CURVATURE + abs(stated) * pieces / 2
    return abs(found.natural_curvature - stated) * found.length > allowed


def is_straight(found: MeasuredBeam) -> bool:
    """Whether it is straight at rest, all along."""
    slopes = np.cumsum([joint.angle for joint in found.joints])
    links = np.diff([joint.s for joint in found.joints], append=found.length)
    aside = np.abs(np.cumsum(links * np.sin(slopes))).max()
    return not is_curved(found) and bool(aside < _CURVATURE / 2 * found.length)


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
