"""Newton's method on MuJoCo's own balance of a beam that touches in one place.

Unknown are the turns of the links, the contact's force f and, unless the bead is held at the tip or
at a joint that protrudes, its arc length s. With the distance d of the bead from the obstacle

    springs = f d_q,    d = -f/k,    d_s = 0.

The last line says that the bead is the place of its link nearest to the obstacle. Eliminating all
but the contour's slope leaves a line; where that meets the contour, facet by facet, is the step.
"""

import math
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.linalg import eigvalsh_tridiagonal
from scipy.linalg.lapack import dgtsv, dpttrf

from analytic.problem.arrays import Floats
from mujoco_models.model.bead import BeadModel, Place, Touch
from mujoco_models.sweep.bead.contour import Bead, Way, contour_of

_ITERATIONS = 30
_SHARE = 0.1  # of the tolerance, that Newton's method may leave; the rest is for rounding
_ROUNDING = 4e-15  # L, of a distance
_LARGEST_TURN = 0.3  # rad, of a link in one step
_SAME = 1e-13  # L
_OUTWARD = 1e-12  # cosine; rounding of what is tangential
_ROUNDS, _CLOSE = 4, 1e-3  # in which a step knows how far the contour recedes, and how well
_NEAR = 1e-3  # L off the contour, beyond which a bead stays where it is on its link


class State(NamedTuple):
    """A configuration, and its contact; lengths in L."""

    angles: Floats  # of the joints, shape (n_joints,) [rad]
    link: int  # that carries the bead
    s: float  # arc length of the bead
    force: float  # [EI/L^2]
    sliding: bool  # whether the bead is where its link is tangential


class Settled(NamedTuple):
    """An equilibrium."""

    state: State
    place: Place
    touch: Touch
    stable: bool
    equations: "_Linearised"


class _Eliminated(NamedTuple):
    """What the turns of the links leave of the equations.

    Each has four columns: without a change, and by one of the force, of the normal, of the place.
    """

    turns: Floats  # of the links
    a: list[float]  # along the normal, of the bead
    b: list[float]  # along the contour, of the bead
    last: list[float]  # turn of the link that carries it
    runs: float  # the axis, along the contour
    turned: float  # the axis, along the normal, as its link turns


class _Reduced(NamedTuple):
    """Changes of force, arc length and place on the contour, at once and by the normal's turn."""

    f0: float
    f1: float
    s0: float
    s1: float
    way: Way


class Balance:
    """The equations of balance on a model."""

    def __init__(self, model: BeadModel, tolerance: float) -> None:
        self.model, self._tolerance = model, tolerance
        self.contour = contour_of(model.obstacle)

    def follow(self, held: Settled, moved: float, foot_x: float) -> Settled | None:
        """The equilibrium to which Newton's method leads from another one, the foot moved on."""
        after = held.equations.step(moved)
        return None if after is None else self.converge(after, foot_x)

    def converge(self, state: State, foot_x: float) -> Settled | None:
        """The equilibrium to which Newton's method leads."""
        model, k, stopped = self.model, self.model.contact_stiffness, 0
        left, most = _ITERATIONS, 2 * len(self.model.ends)
        while left:
            left -= 1
            model.place(foot_x, state.angles)
            state = self._inward(state)
            place = model.at(state.link, state.s)
            touch = model.touch(state.link, place)
            near = abs(touch.distance + state.force / k) < _NEAR and state.force > 0
            link = state.link
            if near or stopped:
                state = self._slid_or_held(state, place, touch, stopped)
            if state.link != link:
                place = model.at(state.link, state.s)
            equations = _Linearised(self, state, place, touch)
            if not math.isfinite(equations.out_of_balance + equations.missed):
                return None
            allowed = _SHARE * self._tolerance
            if (
                not stopped
                and equations.out_of_balance < allowed + _ROUNDING * k
                and equations.missed < allowed + _ROUNDING * k
            ):
                return Settled(state, place, touch, equations.is_stable(), equations)
            after = equations.step()
            if after is None:
                return None
            came = state.sliding and not after.sliding
            stopped = 0 if not came else 1 if after.s > state.s else -1
            state = after
            if stopped and most:  # from joint to joint takes two
                left, most = left + 2, most - 2
        return None

    def _inward(self, state: State) -> State:
        """A joint is the end of the link before it."""
        if state.link > 0 and state.s - self.model.layout.joints[state.link] < _SAME:
            return state._replace(link=state.link - 1, s=float(self.model.ends[state.link - 1]))
        return state

    def _slid_or_held(self, state: State, place: Place, touch: Touch, stopped: int) -> State:
        """Whether the bead slides: not at the tip, nor at a joint that protrudes.

        One that has just come to a joint is held there, unless the link beyond leads on.
        """
        model = self.model
        if state.s - model.layout.joints[0] < _SAME:
            return state._replace(sliding=False)
        at_end = model.ends[state.link] - state.s <= _SAME
        if not at_end or (_recedes(place, touch) > _OUTWARD and stopped <= 0):
            return state._replace(sliding=True)
        if state.link == len(model.ends) - 1 or stopped < 0:
            return state._replace(sliding=False)
        if _recedes(model.at(state.link + 1, state.s), touch) > -_OUTWARD:
            return state._replace(sliding=False)
        return state._replace(link=state.link + 1, sliding=True)


def _recedes(place: Place, touch: Touch) -> float:
    """How fast a bead comes off the obstacle as it goes towards the tip."""
    nx, ny = touch.normal
    return ny * math.cos(place.heading) - nx * math.sin(place.heading) - place.widening


class _Linearised:
    """The equations at one state, in which the model has been placed, and their derivatives."""

    def __init__(self, balance: "Balance", state: State, place: Place, touch: Touch) -> None:
        model = balance.model
        self._model, self._contour, self._k = (
            model,
            balance.contour,
            balance.model.contact_stiffness,
        )
        self._state, self._place, self._touch = state, place, touch
        nx, ny = touch.normal
        self._size = math.hypot(nx, ny)
        link = state.link
        joints = model.joints[: link + 1]
        arm = np.empty((2, link + 1))
        arm[:, :-1] = (joints[1:] - joints[:-1]).T
        x, y = joints[link].tolist()
        arm[:, -1] = place.x - x, place.y - y
        # A turn of a link moves all beyond it across its arm: this much along the normal ...
        self._outward, self._lever = np.array([[nx, ny], [-ny, nx]]) @ arm
        np.negative(self._lever, out=self._lever)
        self._springs = model.springs[: link + 1]
        moments = self._springs + state.force * self._lever[::-1].cumsum()[::-1]
        self.out_of_balance = max(float(moments.max()), -float(moments.min()))
        self._slope = _recedes(place, touch)
        if state.sliding:
            self.out_of_balance = max(self.out_of_balance, abs(self._slope) * state.force)
        self.missed = self._k * abs(touch.distance + state.force / self._k)

    @cached_property
    def _bead(self) -> Bead:
        place, touch = self._place, self._touch
        gap = touch.distance + place.radius
        return Bead(touch.slope, place.x, place.y, gap)

    @cached_property
    def _stiffness(self) -> tuple[Floats, Floats]:
        """Of the links' own angles: diagonal, and beside it."""
        springs = self._model.stiffness(self._state.angles)[: self._state.link + 1]
        own = springs + self._state.force * self._outward
        own[:-1] += springs[1:]
        return own, -springs[1:]

    @cached_property
    def _eliminated(self) -> _Eliminated | None:
        """The beam by the changes of force, place and normal of its contact."""
        place, touch, f = self._place, self._touch, self._state.force
        nx, ny = touch.normal
        cos, sin = math.cos(place.heading), math.sin(place.heading)
        own, beside = self._stiffness
        right = np.zeros((4, len(own)))
        right[0] = self._springs + f * self._lever
        right[0, :-1] -= self._springs[1:]
        right[1], right[2] = self._lever, f / self._size * self._outward
        turned = -nx * cos - ny * sin  # the axis, along the normal, as its link turns
        right[3, -1] = f * turned
        if len(own) > 1:
            *_, found, failed = dgtsv(beside, own, beside, right.T)
            if failed:
                return None
        else:
            found = right.T / own
        levers = np.array([self._lever, self._outward / self._size]) @ found
        runs = (ny * sin + nx * cos) / self._size  # the axis, along the contour
        a, b = levers.tolist()
        return _Eliminated(found, a, b, found[-1].tolist(), runs, turned)

    def _reduced(self, moved: float, rise: float, slide: float | None) -> _Reduced | None:
        """The changes by the normal's turn, of a bead that slides or is to slide so far."""
        reduced = self._eliminated
        if reduced is None:
            return None
        _, a, b, e, runs, turned = reduced
        k, (nx, ny) = self._k, self._touch.normal
        missed = rise - (self._touch.distance + nx * moved + self._state.force / k + a[0])
        pressed, follows = a[1] + 1 / k, a[3]
        if slide is None:
            turns = turned * e[1]
            slides = turned * (e[3] + self._place.bend)
            det = pressed * slides - follows * turns
            if det == 0:
                return None
            skewed, rolls = -(self._slope + turned * e[0]), -(runs + turned * e[2])
            f0 = (missed * slides - follows * skewed) / det
            f1 = (-a[2] * slides - follows * rolls) / det
            s0 = (pressed * skewed - missed * turns) / det
            s1 = (pressed * rolls + a[2] * turns) / det
        else:
            f0, f1, s0, s1 = (
                (missed - (follows + self._slope) * slide) / pressed,
                -a[2] / pressed,
                slide,
                0.0,
            )
        u0 = b[0] + b[1] * f0 + (b[3] + runs) * s0 - ny / self._size * moved
        u1 = b[2] + b[1] * f1 + (b[3] + runs) * s1
        return _Reduced(f0, f1, s0, s1, Way(u0, u1)) if math.isfinite(u0 + u1) else None

    def step(self, moved: float = 0.0) -> State | None:
        """The state after a step, with the foot moved as well."""
        state, eliminated = self._state, self._eliminated
        slide, rise = None if state.sliding else 0.0, 0.0
        reduced = self._reduced(moved, rise, slide)
        if reduced is None or eliminated is None:
            return None
        turn = self._contour.turn(self._bead, reduced.way)
        for _ in range(_ROUNDS):
            if abs(turn.rise - rise) < _CLOSE * (abs(turn.rise) + _SAME):
                break
            rise = turn.rise
            reduced = self._reduced(moved, rise, slide) or reduced
            turn = self._contour.turn(self._bead, reduced.way)
        force, slid = reduced.f0 + reduced.f1 * turn.by, reduced.s0 + reduced.s1 * turn.by
        turns = eliminated.turns @ np.array([1.0, force, turn.by, slid])
        share = min(1.0, _LARGEST_TURN / max(float(np.abs(turns).max()), 1e-300))
        s, sliding = state.s + share * slid, state.sliding
        low, high = self._model.layout.joints[state.link], self._model.ends[state.link]
        if sliding and not low < s < high:
            bound = float(low if s <= low else high)
            share *= (bound - state.s) / (s - state.s)
            s, sliding = bound, False
        turns *= share
        turns[1:] -= turns[:-1].copy()
        angles = np.zeros(len(state.angles))
        angles[: len(turns)] = state.angles[: len(turns)] + turns
        return State(angles, state.link, s, state.force + share * force, sliding)

    def is_stable(self) -> bool:
        """Whether the energy of springs and contact is least: by the inertia of its equations."""
        slide = None if self._state.sliding else 0.0
        reduced, eliminated = self._reduced(0.0, 0.0, slide), self._eliminated
        if reduced is None or eliminated is None:
            return False
        own, beside = self._stiffness
        negative = 0
        if len(own) == 1:
            negative = int(own[0] < 0)
        elif dpttrf(own, beside)[-1]:
            negative = int((eigvalsh_tridiagonal(own, beside) < 0).sum())
        force = self._state.force
        pressed = eliminated.a[1] + 1 / self._k
        negative += pressed > 0
        if self._state.sliding:
            follows = eliminated.a[3]
            slides = eliminated.turned * (eliminated.last[3] + self._place.bend) * force
            negative += pressed * (pressed * slides - follows**2) > 0
        negative += reduced.way.by_turn > self._contour.radius(self._bead)
        return bool(negative == 1 + self._state.sliding)
