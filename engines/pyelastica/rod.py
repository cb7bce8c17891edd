"""PyElastica's rod, brought to rest on the forces that PyElastica has; see `engines.Stepper`.

The first element is held by its middle, so that the rod begins half an element before the clamp.
The foot stands and the object moves, which is the same at rest. PyElastica's own steps are
explicit, thousands a swing. Where they end, its forces and torques vanish, and that is what
Newton's method looks for here, downhill: a step is one to rest. Where the vibrissa jumps, from edge
to edge or off the object, the foot's way is halved until it is short, and the jump ends where
forces lead.
"""

from typing import Any

import elastica
import numpy as np
from scipy.linalg import solve_banded

from analytic.numerics.arrays import Floats
from analytic.problem.case import Case
from engines.agreement import State, hinges
from engines.pyelastica.contact import POINTS, Arcs, press, push

STIFFNESS = 1e5
"""S: of shear and stretch [EI/L^2]. A load of 20 stretches the rod by 2e-4."""
_REACH = 5  # unknowns; by so many at most are those apart that feel each other
_NUDGE = 1e-10  # L, rad; for derivatives: contacts are 1e-8 deep
_TURN = 0.1  # rad; no element turns farther in an iteration
_FIRST, _FASTER = 2e-3, 1.02  # rad; downhill, or it jumps over a short edge; and ever farther
_REST = 1e-5  # EI/L^2, EI/L; where it lies along an edge, whatever touches a little leaves 5e-6
_ITERATIONS = 400  # most rests take five; the way down from a fold, some hundred
_OVERSHOT = 0.1  # of the work at the begin of a move; so much may be undone at its end
_HALVINGS = 20  # of a move; contacts are 1e-6 of one deep
_DRAG = 0.05  # EI/L^3, EI/L; the softest way to bend a whole rod of 20 elements resists 0.6
_NEAR = 1e-4  # L; a way of the foot so short that it is the object that lets go, not the way
_ASIDE = 0.02  # L, rad; a rest so far from where the rod was led is on another branch
_DEEP = 2e-3  # L; contacts that are deeper lead Newton's method astray


class ElasticaRod:
    """A rod, an object beside it, and the state that both are in."""

    period = 1  # a step is to rest: none swings

    def __init__(self, case: Case, elements: int) -> None:
        self.layout = hinges(case, elements - 1, last=1.0)
        length = 1 / (elements - 0.5)
        self._radius, self._arcs = case.radius, Arcs.of(case)
        self._foot_x = float(case.foot_x[0]) / case.beam.length
        self._length, self._pressed = length, np.zeros((5, elements, POINTS))
        self._rod = _rod(elements, length)
        # Of every element but the first: its first node's place, its heading; then the tip's place.
        upright = np.column_stack([*self._rod.position_collection[:2, 1:], np.zeros(elements)])
        self._unknowns = upright.ravel()[:-1]
        index, every = np.arange(len(self._unknowns)), 2 * _REACH + 1
        self._apart = index % every == np.arange(every)[:, None]
        self._near = np.nonzero(np.abs(index[:, None] - index) <= _REACH)

    def step(self, foot_x: float) -> None:
        """To rest, or where no number is one."""
        far = abs(foot_x - self._foot_x)
        self._left(self._unknowns)  # until that finds a contact, ways are as an object is wide
        ways = 1 if self._pressed[0].any() else max(1, int(np.ceil(far / (2 * self._radius))))
        for place in np.linspace(self._foot_x, foot_x, 1 + ways)[1:].tolist():
            led = self._lead(place)
            rests = self._pressed[0].max() < _DEEP and self._settle(far < _NEAR)
            if not rests or (far >= _NEAR and np.abs(self._unknowns - led).max() > _ASIDE):
                self._unknowns = np.full_like(led, np.nan)
                return

    def _lead(self, foot_x: float) -> Floats:
        """Move the foot, and the rod as if all were linear; to where."""
        way, left = foot_x - self._foot_x, self._left(self._unknowns)
        if way:
            slopes = self._slopes()
            self._foot_x += np.copysign(_NUDGE, way)
            change = (self._left(self._unknowns) - left) / _NUDGE
            self._foot_x = foot_x
            self._unknowns = self._unknowns + _move(slopes, abs(way) * change, _TURN)
            self._left(self._unknowns)
        return self._unknowns

    def _settle(self, downhill: bool) -> bool:
        """Whether it found a rest; `downhill` from where it is, if its forces drive it away."""
        drag = 0.0
        for i in range(_ITERATIONS):
            turn = min(_TURN, _FIRST * _FASTER**i) if downhill else _TURN
            left = self._left(self._unknowns)
            if np.abs(left).max() < _REST:
                return True
            slopes = self._slopes()
            move = _move(slopes, left, turn)
            while left @ move < 0:
                if not downhill:
                    return False
                drag = max(_DRAG, 4 * drag)
                slopes[_REACH] -= drag
                move = _move(slopes, left, turn)
            drag = drag / 8 if drag > _DRAG else 0.0
            self._unknowns = self._unknowns + self._share(left, move) * move
        return False

    def _share(self, left: Floats, move: Floats) -> float:
        """How much of a move the forces do work along: beyond, contacts stop or let go."""
        work, low, high, share = left @ move, 0.0, 1.0, 1.0
        for _ in range(_HALVINGS):
            at = self._left(self._unknowns + share * move) @ move
            if abs(at) < _OVERSHOT * work or (share == 1 and at > 0):
                break
            low, high = (share, high) if at > 0 else (low, share)
            share = (low + high) / 2
        return share

    def _left(self, unknowns: Floats) -> Floats:
        """The forces on nodes and torques on elements that nothing balances."""
        rod, left = self._rod, np.empty(len(unknowns) + 1)
        sin, cos = np.sin(unknowns[2::3]), np.cos(unknowns[2::3])
        places, directors = rod.position_collection, rod.director_collection
        places[0, 1:], places[1, 1:] = unknowns[::3], unknowns[1::3]
        # Directors are in rows: z, to the right, and along.
        directors[1, 0, 1:], directors[1, 1, 1:] = cos, sin
        directors[2, 0, 1:], directors[2, 1, 1:] = -sin, cos
        rod.compute_internal_forces_and_torques(0.0)
        nodes = places[:2] + np.array([[self._foot_x], [0.0]])
        press(nodes, self._length, self._arcs, self._pressed)
        push(rod.internal_forces, self._pressed)
        left[::3], left[1::3] = rod.internal_forces[:2, 1:]
        left[2:-1:3] = rod.internal_torques[0, 1:]
        return left[:-1]

    def _slopes(self) -> Floats:
        """The derivatives of `_left`, by diagonals: those out of each other's reach at once."""
        left, nudges = self._left(self._unknowns), _NUDGE * self._apart
        changed = np.array([self._left(self._unknowns + nudge) - left for nudge in nudges])
        slopes = np.zeros((len(nudges), len(left)))
        row, column = self._near
        slopes[_REACH + row - column, column] = changed[column % len(nudges), row] / _NUDGE
        return slopes

    def look(self) -> State:
        """By nodes, and by stress and couple in the first element, carried to the foot."""
        rod = self._rod
        self._left(self._unknowns)
        nodes = rod.position_collection[:2].T
        element, point = np.nonzero(self._pressed[0])
        depth, place, stiffness, *normal = self._pressed[:, element, point]
        push, place = np.transpose(normal), place[:, None]
        axis = (1 - place) * nodes[element] + place * nodes[element + 1]
        # Directors are in rows; a rod of PyElastica's gets thinner where it is longer.
        fx, fy, _ = rod.director_collection[:, :, 0].T @ rod.internal_stress[:, 0]
        fx, fy = fx / rod.dilatation[0], fy / rod.dilatation[0]
        thinner = rod.voronoi_dilatation**3
        moment = rod.director_collection[:, 2, 0] @ rod.internal_couple[:, 0] / thinner[0]
        x, y = nodes[1]
        turns = np.diff(self._unknowns[2::3], prepend=0.0) / thinner
        return State(
            nodes[1:].copy(),
            -np.array([fx, fy, moment + x * fy - y * fx]),
            axis - self._radius * push,
            (stiffness * depth)[:, None] * push,
            turns,
        )

    def keep(self) -> tuple[float, Floats]:
        return self._foot_x, self._unknowns

    def go_back(self, kept: tuple[float, Floats]) -> None:
        self._foot_x, self._unknowns = kept


def _move(slopes: Floats, left: Floats, turn: float) -> Floats:
    """By which linear forces would vanish; no element turns farther than that."""
    move = solve_banded((_REACH, _REACH), slopes, -left, check_finite=False)
    return move * (turn / max(np.abs(move[2::3]).max(), turn))


def _rod(elements: int, length: float) -> Any:  # noqa: ANN401
    """An upright one whose rigidity is 1."""
    radius = 0.01  # not the vibrissa's: PyElastica computes rigidity from it
    rod = elastica.CosseratRod.straight_rod(
        elements,
        start=np.array([0.0, -length / 2, 0.0]),
        direction=np.array([0.0, 1.0, 0.0]),
        normal=np.array([0.0, 0.0, 1.0]),
        base_length=elements * length,
        base_radius=radius,
        density=1.0,
        youngs_modulus=4 / (np.pi * radius**4),
    )
    rod.shear_matrix[np.arange(3), np.arange(3)] = STIFFNESS
    return rod
