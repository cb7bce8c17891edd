"""Whether the rest of a vibrissa stays outside the object that it touches in one place.

A convex body is where every one of its tangents says so: a point p is outside if it lies beyond the
tangent of some slope angle, (p - c(t)) n(t) >= 0 with the normal n = (sin alpha, -cos alpha). A
vibrissa that is bent towards the object, as one of natural curvature may be beyond its contact or
before it, can fail that: it would touch a second time, and the state is none.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.numerics.batches import take
from analytic.numerics.roots import zeros
from analytic.problem.clamp_path import Pose
from analytic.problem.contours.contour import Contour
from analytic.solver.general.pair import Pair, places
from analytic.solver.general.span import Trail, march
from analytic.solver.general.states import States, Vibrissa

_PLACES = np.linspace(0, 1, 17)[1:]  # parts of the loaded span, and of the free end
_FINE = np.linspace(0, 1, 257)[1:]  # the same where two contacts may be close to each other
_PARTS = _FINE.reshape(32, 8)  # of spans between two contacts, each of which one look may prove
_MARKS = np.linspace(0, 1, 33)  # of the places at which a vibrissa that varies is known
_STRAIGHT = 1e-12  # 1/L; rounding of a natural curvature that vanishes
_TANGENTS = 65
_CHUNK = 500  # contacts at a time, so that their places and tangents find room
_CHUNK_OF_TWO = 128
_BESIDE = 0.13  # L; twice as far as places are apart, and the cubic errs by 1e-5 L
_AT_ONCE = 2_000_000  # corners beside contacts, so that they find room
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
    chunk = _CHUNK if contact.inner is None else _CHUNK_OF_TWO
    if left.size:
        for some in np.array_split(left, 1 + left.size // chunk):
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
    s, x, y = _free(contact, _PLACES)
    if contact.inner is None:
        loaded = _loaded(contact, _PLACES)
        s, x, y = (np.concatenate(part) for part in zip(loaded, (s, x, y), strict=True))
    taper = contact.vibrissa.unloaded.taper(s)
    outside = np.asarray(_outside(contour, x, y, taper).all(axis=0))
    return outside if contact.inner is None else outside & _are_spans_outside(contour, contact)


def _are_spans_outside(contour: Contour, contact: States) -> Booleans:
    """Whether both spans between two contacts and the clamp are, which are of one radius.

    A part of them is, if its ends lie beyond the same tangent by more than its sagitta; where no
    tangent shows that, as next to the contacts, the part is looked at closely.
    """
    _, x, y = places(contact, np.append(0.0, _PARTS[:, -1])[:, None])
    _, beyond = _beyond_tangents(contour, x, y)
    beyond = beyond.reshape(2, len(_PARTS) + 1, len(contact.force), -1)
    proven = np.minimum(beyond[:, :-1], beyond[:, 1:]).max(axis=3)
    span, part, which = np.nonzero(~(proven > _sagittas(contact)[:, None]))
    _, x, y = places(take(contact, which), _PARTS[part].T)
    x, y = (np.where(span == 0, *np.split(values, 2)) for values in (x, y))
    outside = np.ones(len(contact.force), dtype=bool)
    outside[which[~_outside(contour, x, y, np.zeros_like(x)).all(axis=0)]] = False
    return outside


def _sagittas(contact: States) -> Floats:
    """No less than those of parts of the outer span and of the inner one, shape (2, n)."""
    inner, vibrissa = contact.inner, contact.vibrissa
    assert inner is not None
    couple, push = np.abs(vibrissa.friction) * vibrissa.radius, np.hypot(1, vibrissa.friction)
    # Along a span kappa^2/2 - F cos(angle to F) stays, and F is no larger than both forces.
    first = np.abs(vibrissa.natural_curvature) + couple * contact.force
    outer = np.sqrt(first**2 + 4 * push * contact.force)
    both = push * (contact.force + inner.force)
    largest = np.array([outer, np.sqrt((outer + couple * inner.force) ** 2 + 4 * both)])
    lengths = np.array([inner.apart, contact.arc_length - inner.apart]) / len(_PARTS)
    return np.asarray(largest * lengths**2 / 8)


def is_rest_clear(contour: Contour, vibrissa: Vibrissa, pose: Pose) -> Booleans:
    """Whether the unloaded vibrissa stays outside the object."""
    s = np.broadcast_to(_PLACES[:, None], (_PLACES.size, pose.foot_x.size))
    rest, clamp_angle = vibrissa.at_rest.shape, float(vibrissa.clamp_angle)
    x, y, _ = replace(rest, angle=rest.angle - clamp_angle).at(s)
    outside = _outside(contour, *pose.place(x, y), vibrissa.unloaded.taper(s))
    return np.asarray(outside.all(axis=0))


def _loaded(contact: States, shares: Floats) -> tuple[Floats, Floats, Floats]:
    """Arc length and place of parts of the loaded span, shape (k, n)."""
    if contact.inner is not None:
        return places(contact, shares[:, None])
    vibrissa, place = contact.vibrissa, contact.offset_point
    lean = np.arctan(vibrissa.friction)
    slope, push = contact.tip_angle - place.alpha - lean, np.hypot(1, vibrissa.friction)
    if vibrissa.rod is None:
        s = contact.arc_length * (1 - shares[:, None])
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
        march(
            vibrissa.rod,
            slope,
            -contact.couple if beyond is None else beyond - contact.couple,
            push * contact.force,
            contact.arc_length,
            direction=place.alpha + lean,
            trail=trail,
        )
        s, along, across, *_ = (np.concatenate(parts) for parts in zip(*trail, strict=True))
        reached = s.max(axis=1)
        order = np.argsort(reached)
        some = np.unique(order[np.searchsorted(reached[order], _MARKS * reached.max())])
        s, along, across = s[some], along[some], across[some]
    sin, cos = np.sin(place.alpha + lean), np.cos(place.alpha + lean)
    return s, place.xi - along * cos + across * sin, place.eta - along * sin - across * cos


def _free(contact: States, shares: Floats) -> tuple[Floats, Floats, Floats]:
    """Arc length and place of parts of the free end, shape (k, n)."""
    rest, place, begin = contact.vibrissa.unloaded, contact.offset_point, contact.arc_length
    hung = contact.vibrissa.hung(contact.tip_angle, begin)
    if hung is not None:
        return hung.s.T, place.xi + hung.x.T, place.eta + hung.y.T
    s = begin + (1 - begin) * shares[:, None]
    x, y, _ = rest.at(s)
    first_x, first_y, slope = rest.at(begin)
    x, y, turned = x - first_x, y - first_y, contact.tip_angle - slope
    sin, cos = np.sin(turned), np.cos(turned)
    return s, place.xi + x * cos - y * sin, place.eta + y * cos + x * sin


def _outside(contour: Contour, x: Floats, y: Floats, taper: Floats) -> Booleans:
    """Whether the vibrissa, thicker than at its tip by `taper`, is outside; of any shape."""
    return np.asarray(~(_gaps(contour, x, y, taper)[0] < taper - _INSIDE))


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

        nearest[left] = zeros(along, begin, end)
        point = contour.at(nearest[left])
        dx, dy = seen[left, 0] - point.xi, seen[left, 1] - point.eta
        gaps[left] = dx * np.sin(point.alpha) - dy * np.cos(point.alpha)
    return gaps.reshape(x.shape), nearest.reshape(x.shape)


def _beyond_tangents(contour: Contour, x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """Contour parameters of tangents, and how far places are beyond each, a row for each place."""
    low, high = contour.t_range
    t = np.unique(np.concatenate([np.linspace(low, high, _TANGENTS), contour.breaks()]))
    alpha, xi, eta = contour.at(t)[:3]
    ok = np.isfinite(xi) & np.isfinite(eta)
    t, alpha, xi, eta = (values[ok] for values in (t, alpha, xi, eta))
    normals = np.stack([np.sin(alpha), -np.cos(alpha)])
    # One product for all.
    beyond = np.column_stack([x.ravel(), y.ravel()]) @ normals
    return t, beyond - (xi * normals[0] + eta * normals[1])
