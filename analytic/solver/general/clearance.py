"""Whether the rest of a vibrissa stays outside the object that it touches in one place.

A convex body is where every one of its tangents says so: a point p is outside if it lies beyond the
tangent of some slope angle, (p - c(t)) n(t) >= 0 with the normal n = (sin alpha, -cos alpha). A
vibrissa that is bent towards the object, as one of natural curvature may be beyond its contact or
before it, can fail that: it would touch a second time, and the state is none.
"""

import numpy as np

from analytic.problem.arrays import Booleans, Floats
from analytic.problem.contours.contour import Contour
from analytic.problem.roots import zeros
from analytic.solver.general.span import back_to_clamp
from analytic.solver.general.states import States, Vibrissa

_PLACES = np.linspace(0, 1, 17)[1:]  # parts of the loaded span, and of the free end
_TANGENTS = 65
_INSIDE = 1e-9  # L; by how much a point may seem to lie in the object


def is_clear(centreline: Contour, contact: States) -> Booleans:
    """Whether states touch the object nowhere else.

    Parameters
    ----------
    centreline : Contour
        Contour that the centreline feels, in units of the vibrissa's length.
    contact : States
        Of n contacts.

    Returns
    -------
    array of bool, shape (n,)
        False where another part of the vibrissa would be inside; looked at in 16 places of the
        loaded span and 16 of the free end.
    """
    clear = _bends_one_way(contact)
    left = np.flatnonzero(~clear)
    if left.size:
        clear[left] = _is_outside(centreline, contact.at(left))
    return clear & _starts_outside(contact)


def _starts_outside(contact: States) -> Booleans:
    """Whether a vibrissa leaves its contact to the outside of the object.

    A tip comes from below the tangent there; a vibrissa that goes along is not curved more than the
    object.
    """
    point, natural = contact.point, contact.vibrissa.natural_curvature
    below = contact.excess <= np.pi + _INSIDE
    flatter = natural * point.stretch <= point.turning * (1 + _INSIDE)
    return np.asarray(below & (flatter | ~contact.tangent))


def _bends_one_way(contact: States) -> Booleans:
    """Whether the slope falls all along: the vibrissa is then below the tangent at its contact."""
    natural, _, mu, radius = contact.vibrissa
    at_contact = natural - mu * radius * contact.force
    bent = (at_contact <= 0) & (natural <= contact.moment) & (contact.swing < np.pi)
    return np.asarray(bent & (natural <= 0))


def _is_outside(centreline: Contour, contact: States) -> Booleans:
    x, y = (np.concatenate(parts) for parts in zip(_loaded(contact), _free(contact), strict=True))
    return np.asarray(_outside(centreline, x, y).all(axis=0))


def is_rest_clear(centreline: Contour, vibrissa: Vibrissa, foot_x: Floats) -> Booleans:
    """Whether the unloaded vibrissa stays outside the object.

    Parameters
    ----------
    centreline : Contour
        Contour that the centreline feels, in units of the vibrissa's length.
    vibrissa : Vibrissa
        Its numbers.
    foot_x : array, shape (n,)
        Foot positions [L].

    Returns
    -------
    array of bool, shape (n,)
        False where some of its 16 places would be inside.
    """
    x, y, _ = vibrissa.unloaded.at(_PLACES[:, None])
    outside = _outside(centreline, x + foot_x, np.broadcast_to(y, (y.size, foot_x.size)))
    return np.asarray(outside.all(axis=0))


def _loaded(contact: States) -> tuple[Floats, Floats]:
    """Places of the loaded span, shape (16, n)."""
    natural, _, mu, radius = contact.vibrissa
    lean = np.arctan(mu)
    length = contact.arc_length * _PLACES[:, None]
    theta, kappa, force = (
        np.broadcast_to(values, length.shape)
        for values in (
            np.maximum(contact.excess, 0.0) - lean,
            natural - mu * radius * contact.force,
            np.sqrt(1 + mu**2) * contact.force,
        )
    )
    part = back_to_clamp(theta, kappa, force, length)
    sin, cos = np.sin(contact.point.alpha + lean), np.cos(contact.point.alpha + lean)
    return (
        contact.point.xi - part.along * cos + part.across * sin,
        contact.point.eta - part.along * sin - part.across * cos,
    )


def _free(contact: States) -> tuple[Floats, Floats]:
    """Places of the free end, an arc that starts along the contour, shape (16, n)."""
    length = (1 - contact.arc_length) * _PLACES[:, None]
    x, y, _ = contact.vibrissa.unloaded.at(length)
    sin, cos = np.sin(contact.tip_angle), np.cos(contact.tip_angle)
    return contact.point.xi + x * sin + y * cos, contact.point.eta + y * sin - x * cos


def _outside(centreline: Contour, x: Floats, y: Floats) -> Booleans:
    """Whether points are outside the object, of any shape."""
    low, high = centreline.t_range
    t = np.unique(np.concatenate([np.linspace(low, high, _TANGENTS), centreline.breaks()]))
    alpha, xi, eta = centreline.at(t)[:3]
    ok = np.isfinite(xi) & np.isfinite(eta)
    t, alpha, xi, eta = (values[ok] for values in (t, alpha, xi, eta))
    places = np.column_stack([x.ravel(), y.ravel()])
    # One product for all: beyond[i, j] of place i and tangent j.
    normals = np.stack([np.sin(alpha), -np.cos(alpha)])
    beyond = places @ normals - (xi * normals[0] + eta * normals[1])
    best = np.argmax(beyond, axis=1)
    outside = ~(beyond[np.arange(len(places)), best] < -_INSIDE)
    left = np.flatnonzero(~outside)
    if left.size:  # between two tangents there may be a better one
        begin, end = t[np.maximum(best[left] - 1, 0)], t[np.minimum(best[left] + 1, len(t) - 1)]

        def along(at: Floats) -> Floats:
            """Of the place, along the tangent: zero where the tangent is the best."""
            point = centreline.at(at)
            dx, dy = places[left, 0] - point.xi, places[left, 1] - point.eta
            return np.asarray(dx * np.cos(point.alpha) + dy * np.sin(point.alpha))

        point = centreline.at(zeros(along, begin, end))
        dx, dy = places[left, 0] - point.xi, places[left, 1] - point.eta
        outside[left] = dx * np.sin(point.alpha) - dy * np.cos(point.alpha) >= -_INSIDE
    return np.asarray(outside.reshape(x.shape))
