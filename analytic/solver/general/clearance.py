"""Whether the rest of a vibrissa stays outside the object that it touches in one place.

A convex body is where every one of its tangents says so: a point p is outside if it lies beyond the
tangent of some slope angle, (p - c(t)) n(t) >= 0 with the normal n = (sin alpha, -cos alpha). A
vibrissa that is bent towards the object, as one of natural curvature may be beyond its contact or
before it, can fail that: it would touch a second time, and the state is none.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.numerics.batches import take
from analytic.numerics.roots import zeros
from analytic.problem.beam import Unloaded
from analytic.problem.clamp_path import Pose
from analytic.problem.contours.contour import Contour
from analytic.solver.general.pair import Pair, places
from analytic.solver.general.span import Trail, march
from analytic.solver.general.states import States, Vibrissa

Line: TypeAlias = tuple[Floats, Floats, Floats]
"""Arc lengths and places along lines, shape (k, n)."""

_PARTS = np.linspace(0, 1, 17)  # ends of the parts of a line
_LEVELS = 2  # of parts: of 1/256 of a line; a bend of 10/L bulges there by 2e-5 L
_FINE = np.linspace(0, 1, 257)[1:, None]  # where a second contact is sought
_STRAIGHT = 1e-12  # 1/L; rounding of a natural curvature that vanishes
_TANGENTS = 65
_APART = 1e-12  # of contour parameters; of nearer ones each would be the best that is next to it
_CHUNK = 128  # contacts at a time, so that their places and tangents find room
_BESIDE = 0.13  # L; twice as far as places are apart, and the cubic errs by 1e-5 L
_AT_ONCE = 2_000_000  # corners beside contacts, so that they find room
_BOTH_SIDES = np.array([[-1.0], [1.0]])
_INSIDE = 1e-9  # L; by how much a point may seem to lie in the object


def is_clear(contour: Contour | Pair, contact: States, others: Sequence[Contour] = ()) -> Booleans:
    """Whether states touch the object, or two, and others too nowhere else."""
    if not isinstance(contour, Contour):
        if contour.inner is not contour.outer:
            others = (*others, contour.inner)
        contour = contour.outer
    clear = _are_outside(contour, contact, ~bends_one_way(contact))
    for other in others:
        clear &= _are_outside(other, contact, clear)
    return clear & _starts_outside(contact) & _passes_corners(contour, contact)


def _are_outside(contour: Contour, contact: States, doubtful: Booleans) -> Booleans:
    """Whether states are outside an object, as those are that are not doubtful."""
    outside = ~(doubtful | np.isnan(contact.excess))
    left = np.flatnonzero(doubtful & np.isfinite(contact.excess))
    if left.size:
        for some in np.array_split(left, 1 + left.size // _CHUNK):
            outside[some] = _is_outside(contour, take(contact, some))
    return outside


def deepest(objects: Sequence[Contour], contact: States) -> tuple[int, float, tuple[float, ...]]:
    """Which object a state is deepest in, at which arc length, and contour parameters there.

    That of what is nearest, and that of the vibrissa's slope: next to a corner, which it turns
    about, a facet is as near.
    """
    parts = zip(_loaded(contact, _FINE), _free(contact, _FINE), strict=True)
    s, x, y = (np.concatenate(part)[:, 0] for part in parts)
    taper = contact.vibrissa.unloaded.taper(s)
    found = [_gaps(contour, x, y, taper) for contour in objects]
    which = int(np.argmin([(gap - taper).min() for gap, _ in found]))
    gap, t = found[which]
    at = int(np.argmin(gap - taper))
    ends = [max(at - 1, 0), min(at + 1, len(s) - 1)]
    slope = np.arctan2(*(np.diff(values[ends]) * np.diff(s[ends]) for values in (y, x)))
    alike = objects[which].parameter(np.clip(slope, -np.pi / 2, np.pi / 2))
    return which, float(s[at]), (float(t[at]), float(alike[0]))


def has_passed(contour: Contour, contact: States) -> Booleans:
    """Whether the object's lowest place is right of states, as of what has gone through it."""
    parts = zip(_loaded(contact, _FINE), _free(contact, _FINE), strict=True)
    x, y = [np.concatenate([loaded[::-1], free]) for loaded, free in parts][1:]
    lowest = contour.at(contour.parameter(np.zeros(1)))
    above = (y > lowest.eta).astype(int)
    rises = np.diff(above, axis=0)
    share = (lowest.eta - y[:-1]) / np.where(rises, np.diff(y, axis=0), 1.0)
    left = x[:-1] + share * np.diff(x, axis=0) < lowest.xi
    return np.asarray((rises * left).sum(axis=0) > 0)


def _starts_outside(contact: States) -> Booleans:
    """Whether a vibrissa that goes along the object is not curved more towards it than it is."""
    point, natural = contact.offset_point, _towards(contact)
    flatter = natural * point.stretch <= point.turning * (1 + _INSIDE)
    return np.asarray(flatter | ~contact.tangent)


def _towards(contact: States) -> Floats:
    """Curvature just beyond the contact, towards the object there."""
    natural = contact.end_curvature
    return np.where(contact.side > 0, -natural, natural)


def _passes_corners(contour: Contour, contact: States) -> Booleans:
    """Whether a vibrissa, there a cubic, stays off corners closer than the places looked at."""
    clear = np.ones(len(contact.force), dtype=bool)
    s = contact.arc_length
    natural = _towards(contact)
    breaks = contour.breaks()
    some = np.flatnonzero((natural > _STRAIGHT) & np.isfinite(contact.excess))
    if not (breaks.size and some.size):
        return clear
    corners = contour.at(breaks)
    for few in np.array_split(some, 1 + some.size * breaks.size // _AT_ONCE):
        one, curved = take(contact, few), natural[few, None]
        offset_point, taper = one.offset_point, one.vibrissa.unloaded.taper(s[few])[:, None]
        sin, cos = np.sin(offset_point.alpha)[:, None], np.cos(offset_point.alpha)[:, None]
        x = corners.xi + taper * np.sin(corners.alpha) - offset_point.xi[:, None]
        y = corners.eta - taper * np.cos(corners.alpha) - offset_point.eta[:, None]
        onward = np.where(one.side > 0, -1.0, 1.0)[:, None]
        along, into = onward * (x * cos + y * sin), y * cos - x * sin
        behind = _BESIDE if one.inner is None else np.minimum(_BESIDE, one.inner.apart)[:, None]
        near = (along > -behind) & (along < np.minimum(_BESIDE, 1 - s[few])[:, None])
        back = np.maximum(-along, 0.0)
        rod, force = one.vibrissa.rod, one.force
        push = force if rod is None else force * rod.flexibility(s[few])
        bent = curved * along**2 / 2 - push[:, None] * back**3 / 6
        bent -= np.where(one.tangent, 0.0, one.excess)[:, None] * back
        clear[few] = ~(near & (bent > into + _INSIDE)).any(axis=1)
    return clear


def bends_one_way(contact: States) -> Booleans:
    """Whether the slope falls all along: the vibrissa is then below the tangent at its contact."""
    vibrissa, natural = contact.vibrissa, contact.vibrissa.natural_curvature
    if any(vibrissa.weight) or contact.inner is not None:
        return np.zeros(len(contact.force), dtype=bool)
    if vibrissa.rod is not None:
        # The moment about places on the way to the clamp grows, and then may fall to the clamp's.
        held = (contact.couple >= 0) & (contact.moment >= 0) & (contact.amplitude < np.pi)
        across = contact.tip_angle - contact.point.alpha <= np.pi / 2
        return np.asarray(held & across & (vibrissa.rod.most_curved <= _STRAIGHT))
    at_contact = natural - vibrissa.friction * vibrissa.radius * contact.force
    bent = (at_contact <= 0) & (natural <= contact.moment) & (contact.amplitude < np.pi)
    return np.asarray(bent & (natural <= 0) & (contact.side <= 0))


def _is_outside(contour: Contour, contact: States) -> Booleans:
    outside = np.ones(len(contact.force), dtype=bool)
    for span in range(2 if contact.inner is None else 3):

        def line(which: Integers, shares: Floats, span: int = span) -> Line:
            return _span(take(contact, which), span, shares)

        outside &= _is_line_outside(contour, line, contact.vibrissa, len(contact.force))
    return outside


def _span(contact: States, span: int, shares: Floats) -> Line:
    """The free end, and what is loaded; of two contacts beyond the inner one and before it."""
    if span == 0:
        return _free(contact, shares)
    found = _loaded(contact, shares)
    if contact.inner is None:
        return found
    s, x, y = (np.split(values, 2)[span - 1] for values in found)
    return s, x, y


def _is_line_outside(
    contour: Contour, line: Callable[[Integers, Floats], Line], vibrissa: Vibrissa, count: int
) -> Booleans:
    """Whether lines are outside, which have places by shares, or places of their own.

    A part of one is, if both its ends lie beyond the same tangent by more than it may bulge. Where
    no tangent shows that, as next to a contact, it is looked at closely.
    """
    which, shares = np.arange(count), np.repeat(_PARTS[:, None], count, axis=1)
    for _ in range(_LEVELS):
        s, x, y = line(which, shares)
        taper = vibrissa.unloaded.taper(s)
        _, beyond = _beyond_tangents(contour, x, y)
        beyond = beyond.reshape(*s.shape, -1) - taper[..., None]
        proven = np.minimum(beyond[1:], beyond[:-1]).max(axis=2) > _bulge(s, x, y) - _INSIDE
        part, of = np.nonzero(~proven & (np.diff(s, axis=0) != 0))
        which, ends = which[of], np.stack([part, part + 1])
        s, x, y = (values[ends, of] for values in (s, x, y))
        if not which.size or len(shares) != len(proven) + 1:
            break
        begin, end = shares[ends, of]
        shares = begin + (end - begin) * _PARTS[:, None]
    outside = np.ones(count, dtype=bool)
    if which.size:
        outside[which[~_are_chords_outside(contour, s, x, y, vibrissa.unloaded)]] = False
    return outside


def _bulge(s: Floats, x: Floats, y: Floats) -> Floats:
    """No less than how far a line is from its chords: on an ellipse, at most, about their ends."""
    dx, dy = np.diff(x, axis=0), np.diff(y, axis=0)
    return np.asarray(np.sqrt(np.maximum(np.diff(s, axis=0) ** 2 - dx**2 - dy**2, 0.0)) / 2)


def _are_chords_outside(
    contour: Contour, s: Floats, x: Floats, y: Floats, rest: Unloaded
) -> Booleans:
    """Whether both ends of parts are, shape (2, m), and no part has to be inside between them."""
    taper = rest.taper(s)
    gaps, nearest = _gaps(contour, x, y, taper + np.abs(np.diff(s, axis=0)))
    slope = np.arctan2(np.diff(y, axis=0), np.diff(x, axis=0)) + rest.lean * _BOTH_SIDES
    alike = contour.parameter((slope + np.pi / 2) % np.pi - np.pi / 2)
    t = np.concatenate([nearest, alike])
    alpha, xi, eta = (values.reshape(t.shape) for values in contour.at(t.ravel())[:3])
    dx, dy = x[:, None] - xi, y[:, None] - eta
    between = (dx * np.sin(alpha) - dy * np.cos(alpha) - taper[:, None]).min(axis=0).max(axis=0)
    deepest = -_bulge(s, x, y)[0] - _INSIDE
    return np.asarray((gaps >= taper - _INSIDE).all(axis=0) & (between >= deepest))


def is_rest_clear(contour: Contour, vibrissa: Vibrissa, pose: Pose) -> Booleans:
    """Whether the unloaded vibrissa stays outside the object."""
    rest, clamp_angle = vibrissa.at_rest.shape, float(vibrissa.clamp_angle)
    rest = replace(rest, angle=rest.angle - clamp_angle)

    def line(which: Integers, shares: Floats) -> Line:
        x, y, _ = rest.at(shares)
        return shares, *Pose(*(values[which] for values in pose)).place(x, y)

    return _is_line_outside(contour, line, vibrissa, pose.foot_x.size)


def _loaded(contact: States, shares: Floats) -> Line:
    """The loaded span back from its contact."""
    if contact.inner is not None:
        return places(contact, shares)
    vibrissa, place = contact.vibrissa, contact.offset_point
    lean = np.arctan(vibrissa.friction)
    slope, push = contact.tip_angle - place.alpha - lean, np.hypot(1, vibrissa.friction)
    if vibrissa.rod is None:
        s = contact.arc_length * (1 - shares)
        part = vibrissa.back_to_clamp(
            np.broadcast_to(slope, s.shape),
            np.broadcast_to(contact.couple, s.shape),
            np.broadcast_to(push * contact.force, s.shape),
            contact.arc_length - s,
            place.alpha + lean,
        )
        along, across = part.along, part.across
    else:
        trail: list[Trail] = []
        beyond = vibrissa.moment_beyond(contact.tip_angle, contact.arc_length)
        end = march(
            vibrissa.rod,
            slope,
            -contact.couple if beyond is None else beyond - contact.couple,
            push * contact.force,
            contact.arc_length,
            direction=place.alpha + lean,
            trail=trail,
        )
        s, along, across, *_ = (np.concatenate(parts) for parts in zip(*trail, strict=True))
        s = np.vstack([contact.arc_length, s, np.zeros_like(slope)])
        along, across = (
            np.vstack([np.zeros_like(slope), *between])
            for between in ((along, end.along), (across, end.across))
        )
    sin, cos = np.sin(place.alpha + lean), np.cos(place.alpha + lean)
    return s, place.xi - along * cos + across * sin, place.eta - along * sin - across * cos


def _free(contact: States, shares: Floats) -> Line:
    """The free end on from the contact."""
    rest, place, begin = contact.vibrissa.unloaded, contact.offset_point, contact.arc_length
    hung = contact.vibrissa.hung(contact.tip_angle, begin)
    if hung is not None:
        s, x, y = (np.pad(at.T, ((1, 0), (0, 0))) for at in (hung.s, hung.x, hung.y))
        s[0] = begin
        return s, place.xi + x, place.eta + y
    s = begin + (1 - begin) * shares
    x, y, _ = rest.at(s)
    first_x, first_y, slope = rest.at(begin)
    x, y, turned = x - first_x, y - first_y, contact.tip_angle - slope
    sin, cos = np.sin(turned), np.cos(turned)
    return s, place.xi + x * cos - y * sin, place.eta + y * cos + x * sin


def _gaps(contour: Contour, x: Floats, y: Floats, taper: Floats) -> tuple[Floats, Floats]:
    """How far places are outside, and the contour parameter of what they are next to."""
    t, beyond = _beyond_tangents(contour, x, y)
    seen = np.column_stack([x.ravel(), y.ravel()])
    best = np.argmax(beyond, axis=1)
    gaps, nearest = beyond[np.arange(len(seen)), best], t[best]
    left = np.flatnonzero(gaps < taper.ravel() - _INSIDE)
    if left.size:  # between two tangents there may be a better one
        begin, end = t[np.maximum(best[left] - 1, 0)], t[np.minimum(best[left] + 1, len(t) - 1)]

        def along(which: Integers, at: Floats) -> Floats:
            """Of the place, along the tangent: zero where the tangent is the best."""
            point = contour.at(at)
            place = seen[left[which]]
            dx, dy = place[:, 0] - point.xi, place[:, 1] - point.eta
            return np.asarray(dx * np.cos(point.alpha) + dy * np.sin(point.alpha))

        found = zeros(along, begin, end)
        point = contour.at(found)
        dx, dy = seen[left, 0] - point.xi, seen[left, 1] - point.eta
        gap = dx * np.sin(point.alpha) - dy * np.cos(point.alpha)
        # Along a facet all tangents are one, and what is between two of them may be none.
        nearest[left] = np.where(gap > gaps[left], found, nearest[left])
        gaps[left] = np.maximum(gaps[left], gap)
    return gaps.reshape(x.shape), nearest.reshape(x.shape)


def _beyond_tangents(contour: Contour, x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """Contour parameters of tangents, and how far places are beyond each, a row for each place."""
    low, high = contour.t_range
    t = np.unique(np.concatenate([np.linspace(low, high, _TANGENTS), contour.breaks()]))
    t = t[np.append(True, np.diff(t) > _APART)]
    alpha, xi, eta = contour.at(t)[:3]
    ok = np.isfinite(xi) & np.isfinite(eta)
    t, alpha, xi, eta = (values[ok] for values in (t, alpha, xi, eta))
    normals = np.stack([np.sin(alpha), -np.cos(alpha)])
    # One product for all.
    beyond = np.column_stack([x.ravel(), y.ravel()]) @ normals
    return t, beyond - (xi * normals[0] + eta * normals[1])
