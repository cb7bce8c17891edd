"""Do springs, contacts and clamp agree? A test of a state at rest that needs no reference.

An engine says where its joints are, what its clamp holds, and which forces the object exerts where.
At rest these determine each other. The moment that the case's own springs have in that shape, a
number that the engine has no part in, must be the moment of all contacts beyond the joint, and the
clamp must hold their sum; each contact must be where vibrissa and object are, and push along the
normal there. So half a reading, a body asleep, a soft spring or a force at the wrong place shows.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from analytic.numerics.arrays import Floats, Integers
from analytic.problem.case import Case
from mujoco_models.beams.layout import Layout
from mujoco_models.beams.vibrissa import Vibrissa

# Of the largest force or moment, L = EI = 1. A chain of 40 links is the rod to 5e-4 at best: a
# disagreement that is no more adds as much at most.
_FORCES = 1e-3
_LEAST = 1e-2  # EI/L^2, EI/L; forces and moments below that are counted as if they were so large
_PLACES = 1e-3  # L; a soft contact is F/k deep: 5e-4 L under the largest load at 1e4 EI/L^3
_NORMALS = 5e-3  # rad; ten times what a fine polygon turns; of a friction as large, too
_FEELS = 1e-2  # of the largest force; smaller ones may be anywhere
_POINTS = 2000  # of the contour; a distance is then right to 1e-6 of its radius of curvature


@dataclass(frozen=True)
class State:
    """What an engine reports, seen from the foot; dimensionless: L = EI = 1.

    Attributes
    ----------
    joints : array, shape (n_joints + 1, 2)
        Where the joints are, as `hinges` has them, and the tip.
    clamp : array, shape (3,)
        Force and moment of the clamp on the vibrissa, at the foot: what its sensor reads.
    points : array, shape (n_contacts, 2)
        Where the object pushes, on the surface of the vibrissa.
    forces : array, shape (n_contacts, 2)
        What it pushes with, on the vibrissa.
    turns : array, shape (n_joints,), optional
        What bends at each joint [rad], where places do not say all of it: of a rod that shears,
        between its sections.
    """

    joints: Floats
    clamp: Floats
    points: Floats
    forces: Floats
    turns: Floats | None = None


def hinges(case: Case, count: int, last: float = 0.5) -> Layout:
    """Hinges at the centres of equal cells, which makes a chain of second order.

    Parameters
    ----------
    case : Case
        The problem; its foot moves to the left.
    count : int
        How many, that of a clamp that turns not among them.
    last : float
        How far from the tip the last one is, in cells. That is 1 for a rod whose first element is
        held by its middle, and whose nodes are the hinges.

    Returns
    -------
    Layout
        Among others ``joints``, their arc lengths [L], and ``compliances``, by how much each
        turns under a moment [L/EI].
    """
    cell = 1 / (count - 0.5 + last)
    edges: Floats = cell * np.arange(count + 1.0)
    vibrissa = Vibrissa.of(case.beam, case.support)
    joints: Floats = edges[:-1] + cell / 2
    return Layout.of(joints, np.full(count, cell), edges, np.inf, vibrissa)


class Agreement:
    """The test for the vibrissa and the object of a case.

    Parameters
    ----------
    case : Case
        The problem; its foot moves to the left.
    layout : Layout
        Where the engine's vibrissa bends, as `hinges` has it.
    """

    def __init__(self, case: Case, layout: Layout) -> None:
        self._layout, self._surface = layout, Surface(case)
        vibrissa, tip = layout.vibrissa, case.beam.unloaded.tip_radius
        self._thickness = case.radius * vibrissa.thickness(np.append(layout.joints, 1.0))
        self._beyond_tip = self._thickness - tip

    def imbalance(self, state: State) -> float:
        """Between springs and contacts.

        Parameters
        ----------
        state : State
            At rest or not.

        Returns
        -------
        float
            The largest moment at a joint over the largest force or moment.
        """
        return float(np.abs(self._springs(state) + self._pushes(state)).max() / self._scale(state))

    def is_clear(self, joints: Floats, foot_x: float) -> bool:
        """Whether nothing of a vibrissa is in the object.

        Parameters
        ----------
        joints : array, shape (n_joints + 1, 2)
            Where its joints and its tip are, as those of a state [L].
        foot_x : float
            Where the foot is [L].

        Returns
        -------
        bool
            True if it is outside, or as deep as contacts may be.
        """
        return self._inside(joints, foot_x) < _PLACES

    def _inside(self, joints: Floats, foot_x: float) -> float:
        out, _ = self._surface.outward(joints + np.array([foot_x, 0.0]))
        return float((self._beyond_tip - out).max())

    def doubt(self, state: State, foot_x: float) -> str:
        """Why a state at rest cannot be trusted.

        Parameters
        ----------
        state : State
            At rest.
        foot_x : float
            Where the foot is [L].

        Returns
        -------
        str
            What disagrees most, by how much; empty if nothing does.
        """
        if not all(x is None or np.isfinite(x).all() for x in vars(state).values()):
            return "a number is missing"
        found = [
            (size / limit, f"{what} disagree") for what, size, limit in self._each(state, foot_x)
        ]
        worst, what = max(found)
        return what if worst > 1 else ""

    def _each(self, state: State, foot_x: float) -> Iterator[tuple[str, float, float]]:
        """What may disagree, by how much, and how much of that is nothing."""
        layout, scale, foot = self._layout, self._scale(state), np.array([foot_x, 0.0])
        yield "springs and contacts", self.imbalance(state), _FORCES
        held = state.clamp + resultant(state.points, state.forces)
        yield "clamp and contacts", float(np.abs(held).max()) / scale, _FORCES
        yield "foot and clamp", float(np.hypot(*(state.joints[0] - layout.base[0]))), _PLACES
        chords = np.hypot(*np.diff(state.joints, axis=0).T)
        yield (
            "links and their lengths",
            float(np.abs(np.cumsum(chords - layout.chords)).max()),
            _PLACES,
        )
        if state.turns is not None:
            apart = np.abs(state.turns - self._bent(state))
            yield "turns and places", float(apart.max()), _NORMALS
        yield "vibrissa and object", self._inside(state.joints, foot_x), _PLACES
        size = np.hypot(*state.forces.T)
        felt = size > _FEELS * max(size.max(initial=0.0), _LEAST)
        if not felt.any():
            return
        push = state.forces[felt] / size[felt, None]
        link, place, beside = on_axis(state, state.points[felt])
        thickness = np.interp(link + place, np.arange(len(self._thickness)), self._thickness)
        yield "contacts and vibrissa", float(np.abs(beside - thickness).max()), _PLACES
        axis = state.points[felt] + thickness[:, None] * push
        out, normal = self._surface.outward(axis + foot)
        apart = out - thickness + self._thickness[-1]
        yield "contacts and object", float(np.abs(apart).max()), _PLACES
        turned = np.hypot(*(push - normal).T)
        yield "forces and normals", float(turned.max()), _NORMALS

    def _springs(self, state: State) -> Floats:
        turns = self._bent(state) if state.turns is None else state.turns
        return np.asarray(-turns / self._layout.compliances)

    def _bent(self, state: State) -> Floats:
        """By how much each joint is turned, by the places of all."""
        x, y = np.diff(state.joints, axis=0).T
        turns = np.diff(np.arctan2(-x, y) - self._layout.headings, prepend=0.0)
        return np.asarray((turns + np.pi) % (2 * np.pi) - np.pi)

    def _pushes(self, state: State) -> Floats:
        """The moments at the joints of all contacts beyond."""
        link, _, _ = on_axis(state, state.points)
        arms = state.points[:, None] - state.joints[:-1]
        fx, fy = state.forces[:, 0, None], state.forces[:, 1, None]
        carried = np.arange(arms.shape[1]) <= link[:, None]
        return np.asarray((carried * (arms[:, :, 0] * fy - arms[:, :, 1] * fx)).sum(axis=0))

    def _scale(self, state: State) -> float:
        """The largest force or moment that anything reports."""
        contacts = resultant(state.points, state.forces)
        reported = self._springs(state), state.clamp, contacts
        return max(_LEAST, *(float(np.abs(x).max()) for x in reported))


def resultant(points: Floats, forces: Floats) -> Floats:
    """Sum of forces, and their moment about the origin, shape (3,)."""
    (x, y), (fx, fy) = points.T, forces.T
    return np.array([fx.sum(), fy.sum(), (x * fy - y * fx).sum()])


def on_axis(state: State, points: Floats) -> tuple[Integers, Floats, Floats]:
    """Which link is nearest to points, where along it (0 to 1), and how far from it they are."""
    begins, ways = state.joints[:-1], np.diff(state.joints, axis=0)
    arms = points[:, None] - begins
    place = np.clip((arms * ways).sum(axis=2) / (ways**2).sum(axis=1), 0, 1)
    beside = np.linalg.norm(arms - place[:, :, None] * ways, axis=2)
    link = beside.argmin(axis=1)
    each = np.arange(len(points))
    return link, place[each, link], beside[each, link]


class Surface:
    """What the centreline of a case's vibrissa feels, dimensionless: L = 1.

    The contour as lines that have it on one side.
    """

    def __init__(self, case: Case) -> None:
        last, first = case.reach
        line = case.centreline
        marks = np.concatenate([[last], line.breaks(), [first]])
        middles = (marks[1:] + marks[:-1]) / 2  # one on every edge
        middles = middles[(middles > last) & (middles < first)]
        on = line.at(np.concatenate([np.linspace(last, first, _POINTS), middles]))
        self._normals = np.column_stack([np.sin(on.alpha), -np.cos(on.alpha)])
        self._heights = on.xi * self._normals[:, 0] + on.eta * self._normals[:, 1]

    def outward(self, points: Floats) -> tuple[Floats, Floats]:
        """How far out points are, negative inside, shape (n,), and the normals there, (n, 2)."""
        out = points @ self._normals.T - self._heights
        return out.max(axis=1), self._normals[out.argmax(axis=1)]
