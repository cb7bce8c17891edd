"""States of a vibrissa that touches in two places, span by span.

The outer contact is that of `analytic.solver.general.states`. At the inner one, nearer to the
clamp, the vibrissa lies on a contour: it has the slope angle and the place of a point there. From
the outer contact back to the inner one the outer force alone bends it, from there on the sum of
both does, which is a dead force again: two spans in closed form, whose curvature is the same where
they meet, but for the couple of friction. A corner is part of a contour on which the slope angle
alone changes. Three numbers are added to a state: contour parameter and normal force of the inner
contact, and its distance from the outer one along the vibrissa.
"""

from typing import NamedTuple

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.contours.contour import Contour, ContourPoint
from analytic.solver.general.span import Start, back_to_clamp
from analytic.solver.general.states import InnerContact, States, Vibrissa

_DIFFERENCE = 1e-5  # truncation and round-off of second order are alike
_AHEAD = np.zeros((13, 6))  # the state itself, and two steps along each of its numbers
_WEIGHTS = np.zeros((6, 13))
for _k in range(6):
    _AHEAD[1 + 2 * _k, _k], _AHEAD[2 + 2 * _k, _k] = 1.0, 2.0
    _WEIGHTS[_k, [0, 1 + 2 * _k, 2 + 2 * _k]] = -1.5, 2.0, -0.5
_SIGNS = np.array([1.0, 1.0, -1.0, 1.0, -1.0, -1.0])  # of what is bent, in what it misses


class Pair(NamedTuple):
    """The contours that two contacts are on, which may be the same one."""

    outer: Contour
    inner: Contour

    def states(self, z: Floats, vibrissa: Vibrissa) -> States:
        """The states of given numbers, shape (n, 6)."""
        outer, inner, given = self._given(z)
        return _found(outer, inner, given, _bent(given, vibrissa), vibrissa)

    def rates(self, z: Floats, vibrissa: Vibrissa) -> tuple[States, Floats]:
        """And the derivatives of what they miss, shape (n, 6, 6)."""
        outer, inner, given = self._given(z)
        steps = np.full_like(given, _DIFFERENCE)
        steps[[1, 4]] *= np.maximum(vibrissa.least_force, given[[1, 4]])
        steps[2] = np.where(given[2] < 0, -steps[2], steps[2])
        bent = _bent(given[:, None] + _AHEAD.T[..., None] * steps[:, None], vibrissa)
        changes = _SIGNS[:, None, None] * np.array(bent[:6])
        rates = np.einsum("kr,mrn->nmk", _WEIGHTS, changes) / steps.T[:, None]
        for k, point, sign in ((0, outer, 1.0), (3, inner, -1.0)):
            rates[:, :, k] *= point.turning[:, None]
            along, up = (f(point.alpha) * point.stretch for f in (np.cos, np.sin))
            rates[:, 4, k] += sign * along
            rates[:, 5, k] += sign * up
            if k == 0:
                rates[:, 1, k] -= up
                rates[:, 2, k] += along
        return _found(outer, inner, given, _Bent(*(v[0] for v in bent)), vibrissa), rates

    def _given(self, z: Floats) -> tuple[ContourPoint, ContourPoint, Floats]:
        """The points on the contours, and the numbers with slope angles for their parameters."""
        outer, inner = self.outer.at(z[:, 0]), self.inner.at(z[:, 3])
        return outer, inner, np.array([outer.alpha, *z.T[1:3], inner.alpha, *z.T[4:]])


class _Bent(NamedTuple):
    """Both spans, as seen from the clamp and from the inner contact."""

    angle: Floats  # by which a clamp leans to the left that would hold it [rad]
    up: Floats
    reach: Floats  # of the outer contact from the foot
    turned: Floats  # slope angle of the inner contact's contour from that of the vibrissa [rad]
    x: Floats
    y: Floats  # of the outer contact from the inner one
    moment: Floats
    amplitude: Floats


def places(contact: States, shares: Floats) -> tuple[Floats, Floats, Floats]:
    """Arc length and place at shares of both spans, from their contacts on, shape (2 k, n).

    Shares are of shape (k, n), or (k, 1) of all states.
    """
    inner, vibrissa = contact.inner, contact.vibrissa
    assert inner is not None
    begin, apart = contact.arc_length, inner.apart
    numbers = contact.point.alpha, contact.force, contact.excess
    given = np.array([*numbers, inner.point.alpha, inner.force, apart])
    beyond = _outer(given, vibrissa, apart * shares)
    first = _inner(
        given, vibrissa, _outer(given, vibrissa, apart).start.kappa, (begin - apart) * shares
    )
    return (
        np.concatenate([begin - apart * shares, (begin - apart) * (1 - shares)]),
        np.concatenate([contact.point.xi - beyond.x, inner.point.xi - first.x]),
        np.concatenate([contact.point.eta - beyond.y, inner.point.eta - first.y]),
    )


class _Part(NamedTuple):
    """A span of a given length, back from its contact."""

    start: Start
    direction: Floats  # slope angle of its force
    gained: Floats  # less that curvature
    x: Floats
    y: Floats  # of the contact from there


def _outer(given: Floats, vibrissa: Vibrissa, length: Floats) -> _Part:
    """From the outer contact towards the inner one."""
    alpha, force, excess = given[:3]
    mu = vibrissa.friction
    lean, couple = np.arctan(mu), mu * vibrissa.radius * force
    slope, kappa = vibrissa.turned(excess) - lean, vibrissa.natural_curvature - couple
    return _part(slope, kappa, np.sqrt(1 + mu**2) * force, alpha + lean, length)


def _inner(given: Floats, vibrissa: Vibrissa, kappa: Floats, length: Floats) -> _Part:
    """From the inner contact, to which the outer span has come with a curvature, to the clamp."""
    alpha, force, _, inner_alpha, inner_force, _ = given
    mu = vibrissa.friction
    lean, push = np.arctan(mu), np.sqrt(1 + mu**2)
    across = push * (force * np.sin(alpha + lean) + inner_force * np.sin(inner_alpha + lean))
    onward = push * (force * np.cos(alpha + lean) + inner_force * np.cos(inner_alpha + lean))
    direction, bent = np.arctan2(across, onward), kappa - mu * vibrissa.radius * inner_force
    return _part(inner_alpha - direction, bent, np.hypot(across, onward), direction, length)


def _part(slope: Floats, kappa: Floats, force: Floats, direction: Floats, length: Floats) -> _Part:
    slope, kappa, force, length = np.broadcast_arrays(slope, kappa, force, length)
    start = back_to_clamp(slope, kappa, force, length)
    return _Part(start, direction, force * start.along - kappa, *start.way(direction))


def _bent(given: Floats, vibrissa: Vibrissa) -> _Bent:
    _, _, excess, inner_alpha, _, apart = given
    beyond = _outer(given, vibrissa, apart)
    due = np.pi / 4 - (inner_alpha - beyond.direction) / 2
    first = _inner(given, vibrissa, beyond.start.kappa, vibrissa.arc_length(excess) - apart)
    moment = vibrissa.natural_curvature + first.gained
    return _Bent(
        vibrissa.compliance * moment - 2 * first.start.angle_from(first.direction / 2),
        first.y + beyond.y,
        first.x + beyond.x,
        2 * beyond.start.angle_from(due),
        beyond.x,
        beyond.y,
        moment,
        np.maximum(first.start.amplitude, beyond.start.amplitude),
    )


def _found(
    outer: ContourPoint, inner: ContourPoint, given: Floats, bent: _Bent, vibrissa: Vibrissa
) -> States:
    _, force, excess, _, inner_force, apart = given
    missed = (bent.turned, outer.xi - bent.x - inner.xi, outer.eta - bent.y - inner.eta)
    return States(
        outer, force, excess, bent.moment, bent.up, bent.reach, bent.angle, bent.amplitude,
        vibrissa, InnerContact(inner, inner_force, apart, missed),
    )  # fmt: skip
