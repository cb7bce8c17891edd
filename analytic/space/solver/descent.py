"""A vibrissa on its way down: a chain of links that are as damped as they are stiff.

Where a side slides over a corner of a mesh, or a face ends to hold a tip, no branch says where the
vibrissa goes. Here the whole of it moves, as the joints of a chain with springs k, each with a
damper in proportion (Kelvin and Voigt's law), and every place of it stays off the body. In a step
its links turn by the v for which

    v . K v/2 + E' . v   is least,   d_j + d_j' . v >= 0,

K the second derivative of the springs' energy E and d_j the distances of a few places from the
body: the nearest one of each link that is near. The chain need not be exact: it only has to come so
near to a state at rest that the closed form finds it.
"""

from collections.abc import Iterator
from functools import cache
from typing import NamedTuple

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from analytic.numerics.arrays import Floats
from analytic.numerics.descent import barring_forces
from analytic.space.checks.rod import integrate_rod
from analytic.space.problem.bodies.body import Spot, across
from analytic.space.solver.contact import APART, Contact, Scene

_LINKS = 40
_GENTLE = 0.015  # rad, of a link in a step
_STEPS = 150
_NEAR = 0.02  # L; what is farther off the body does not touch in this step
_GONE = 10  # steps in a row without a force, and the vibrissa is free
_SINGULAR = 1e-12  # of constraints: two links that touch in one place
_HALVINGS = 12  # of a link, to find its place that is nearest to the body


class Touching(NamedTuple):
    """Where the chain touches, in case it is at rest."""

    place: Floats  # of the body, shape (3,) [L]
    on_parallel: Floats  # the same on the parallel surface
    arc_length: float  # [L]
    bent: float  # angle of the link there above the body's surface [rad]
    turned: float  # the largest turn of a link in the step to come [rad]


def descend(scene: Scene, start: Contact, foot: Floats) -> Iterator[Touching]:
    """Where a vibrissa that has lost its hold touches, step by step."""
    links = _links(scene, start)
    stiffness = _springs()
    free = 0
    for _ in range(_STEPS):
        near = list(_near(scene, foot, links))
        sides = across(links)
        before = np.vstack([scene.tangent, links[:-1]])
        pull = np.zeros((_LINKS + 1, 3))
        pull[:-1] = stiffness[:, None] * (links - before)
        slope = np.einsum("ikc,ic->ik", sides, pull[:-1] - pull[1:]).ravel()
        factor = cho_factor(_metric(stiffness, sides, links, before))
        step, force = -cho_solve(factor, slope), 0.0
        if near:
            rows = np.array([_rate(one, sides) for one in near])
            moved = cho_solve(factor, rows.T)
            gaps = np.array([one.gap for one in near]) + rows @ step
            forces = barring_forces(rows @ moved, gaps, _SINGULAR)
            step, force = step + moved @ forces, float(forces.max())
        size = float(np.abs(step).max())
        if force > 0:
            one = near[int(np.argmax(forces))]
            bent = float(np.arcsin(np.clip(-one.normal @ links[one.link], -1, 1)))
            yield Touching(one.point, one.point + APART * one.normal, one.arc_length, bent, size)
        free = 0 if force > 0 else free + 1
        if free > _GONE:
            return
        step = min(1.0, _GENTLE / max(size, 1e-300)) * step
        links = links + np.einsum("ik,ikc->ic", step.reshape(-1, 2), sides)
        links /= np.linalg.norm(links, axis=1)[:, None]


class _Near(NamedTuple):
    link: int
    along: float  # of the link's start [L]
    gap: float
    normal: Floats
    point: Floats

    @property
    def arc_length(self) -> float:
        return self.link / _LINKS + self.along


def _springs() -> Floats:
    """EI/h, and of half a cell at the clamp."""
    found = np.full(_LINKS, float(_LINKS))
    found[0] *= 2
    return found


def _links(scene: Scene, start: Contact) -> Floats:
    """Directions of the links of a vibrissa at rest."""
    plane, s = start.plane, start.arc_length
    force = -start.force * plane.normal
    moment = np.sqrt(start.force) * start.loaded.moment * plane.across
    place, along, _ = integrate_rod(scene.tangent, force, moment, s, 4 * _LINKS)
    middles = (np.arange(_LINKS) + 0.5) / _LINKS
    arcs = np.linspace(0, s, len(place))
    found = np.stack([np.interp(middles, arcs, column) for column in along.T], axis=1)
    return np.asarray(found / np.linalg.norm(found, axis=1)[:, None])


def _metric(stiffness: Floats, sides: Floats, links: Floats, before: Floats) -> Floats:
    """K of the springs, by the turns of the links."""
    found = np.zeros((_LINKS, 2, _LINKS, 2))
    i = np.arange(_LINKS)
    found[i, :, i, :] += stiffness[:, None, None] * np.eye(2)
    found[i[:-1], :, i[:-1], :] += stiffness[1:, None, None] * np.eye(2)
    beside = -stiffness[1:, None, None] * (sides[1:] @ sides[:-1].transpose(0, 2, 1))
    found[i[1:], :, i[:-1], :] = beside
    found[i[:-1], :, i[1:], :] = beside.transpose(0, 2, 1)
    return found.reshape(2 * _LINKS, 2 * _LINKS)


def _rate(one: _Near, sides: Floats) -> Floats:
    """How a distance changes with the links' turns."""
    arms = np.zeros(_LINKS)
    arms[: one.link] = 1 / _LINKS
    arms[one.link] = one.along
    return np.asarray((arms[:, None] * (sides @ one.normal)).ravel())


def _near(scene: Scene, foot: Floats, links: Floats) -> Iterator[_Near]:
    """The nearest place of each link that is near the body."""
    length = 1 / _LINKS
    joints = foot + np.vstack([np.zeros(3), np.cumsum(links, axis=0) * length])

    @cache
    def at_joint(joint: int) -> Spot:
        return scene.body.nearest(joints[joint], APART)

    link = _LINKS - 1
    while link >= 0:
        if at_joint(link + 1).normal @ links[link] <= 0:
            along, spot = length, at_joint(link + 1)
        elif at_joint(link).normal @ links[link] >= 0:
            along, spot = 0.0, at_joint(link)
        else:
            low, high = 0.0, length
            for _ in range(_HALVINGS):
                along = (low + high) / 2
                spot = scene.body.nearest(joints[link] + along * links[link], APART)
                if spot.normal @ links[link] < 0:
                    low = along
                else:
                    high = along
        gap = spot.distance - scene.radius
        if gap < _NEAR:
            yield _Near(link, along, gap, spot.normal, spot.point)
        link -= max(1, int(gap / length))
