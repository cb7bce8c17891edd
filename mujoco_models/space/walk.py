"""Along the way of the foot: a contact begins, is followed, hops, and ends.

MuJoCo alone decides: distances of the straight vibrissa say where it touches and when it is clear,
Newton's method on MuJoCo's balance follows the stable equilibrium, and where that ends a descent on
the energy of MuJoCo's springs and contact says where the vibrissa goes.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from analytic.problem.arrays import Floats
from mujoco_models.space.model import SpaceModel
from mujoco_models.space.rest import Rest, Settled, State

_TOUCH = 1e-10  # L of the way, to which the first contact is enclosed
_BEGIN = 1e-6  # L beyond it, where a contact begins
_SMALLEST = 1e-5  # L; an equilibrium that steps as small as this do not find has ended
_EVENT = 5e-4  # L, to which a change of phase and a hop are enclosed
_TURN = 0.02  # rad, of a facet's normal in a step: more may be a facet that was left out
_TURN_OF_SIDE = 0.1  # the same where the vibrissa runs over edges, with normals between the facets'
# Of the contact in a step: more is another branch. Next to its end a branch is steep, so that steps
# are halved there.
_LEAP, _LEAST_LEAP = 5.0, 0.02  # of the step; L
_LANDING = 0.12  # L, of the contact: what comes to rest farther away depends on its motion
_HOPS = (
    0.0,
    2e-3,
    5e-3,
    2e-2,
)  # L: widths over which facets are smooth when the next one is looked for
_GIVEN_UP = 3  # unsettled stations in a row: from then on all are, until the vibrissa comes clear
_LOOSE = 1e-3  # EI/L^2; a contact that ends with less has been released


class Event(NamedTuple):
    """What happens on the way, and where."""

    kind: str
    """``"touch"``, ``"phase"``, ``"hop"``, ``"release"`` or ``"slip-off"``."""
    travel: float
    """Along the way [L]."""


class Station(NamedTuple):
    """What a station comes to."""

    status: str
    settled: Settled | None
    """None where nothing touches, or where it is not known what does."""


class Walk:
    """A walk along the way of the foot.

    Parameters
    ----------
    model : SpaceModel
        MuJoCo's.
    rest : Rest
        Newton's method on it.
    foot : callable
        Maps a distance along the way [L] to the foot's position [L], shape (3,).
    marks : array
        Where along the way its corners are [L].
    """

    def __init__(
        self,
        model: SpaceModel,
        rest: Rest,
        foot: Callable[[float], Floats],
        marks: Floats,
    ) -> None:
        self._model, self._rest, self._foot, self._marks = model, rest, foot, marks
        self._at = 0.0
        self._held: Settled | None = None
        self._lost = False
        self._failures = 0
        self.events: list[Event] = []

    def go_to(self, target: float) -> Station:
        """Go on to a station.

        Parameters
        ----------
        target : float
            Along the way, not before the last one [L].

        Returns
        -------
        Station
            What it comes to.
        """
        if self._failures == _GIVEN_UP:
            if self._gap(target) <= 0:
                self._at = target
                return Station("unsettled", None)
            self._held, self._failures, self._at = None, 0, self._clear(self._at, target)
        settled = True
        while self._at < target and settled:
            settled = self._follow(target) if self._held is not None else self._seek(target)
        if self._held is None:
            return Station("slipped off" if self._lost else "ok", None)
        self._failures = 0 if settled else self._failures + 1
        if not settled:
            return Station("unsettled", None)
        return Station("ok", self._held)

    def _gap(self, travel: float) -> float:
        """Between the body and the straight vibrissa [L]."""
        self._model.place(self._foot(travel), self._model.straight)
        return self._model.nearest_link()[0]

    def _seek(self, target: float) -> bool:
        """Go on to the next contact, or to the station."""
        if self._lost:
            if self._gap(target) <= 0:
                self._at = target
                return True
            self._lost = False
            self._at = self._clear(self._at, target)
        touch = self._next_touch(self._at, target)
        if touch is None:
            self._at = target
            return True
        self.events.append(Event("touch", touch))
        self._begin(touch)
        return True

    def _clear(self, low: float, high: float) -> float:
        """Where the straight vibrissa comes clear of the body, a little beyond."""
        if self._gap(low) > 0:
            return low
        return min(float(brentq(self._gap, low, high, xtol=_TOUCH)) + 2 * _TOUCH, high)

    def _next_touch(self, low: float, high: float) -> float | None:
        """Where the straight vibrissa touches.

        Along a straight leg of the way its distance from a convex body is convex, and it changes by
        no more than the foot moves.
        """
        corners = self._marks[(self._marks > low) & (self._marks < high)]
        for end in (*corners.tolist(), high):
            gaps = self._gap(low), self._gap(end)
            if gaps[1] > 0 and sum(gaps) < end - low:
                least = float(
                    minimize_scalar(
                        self._gap, bounds=(low, end), method="bounded", options={"xatol": 1e-9}
                    ).x
                )
                end, gaps = (least, (gaps[0], -1.0)) if self._gap(least) <= 0 else (end, gaps)
            if gaps[1] <= 0:
                if gaps[0] <= 0:
                    return low
                return float(brentq(self._gap, low, end, xtol=_TOUCH))
            low = end
        return None

    def _begin(self, touch: float) -> None:
        """The contact of a vibrissa that is hardly bent."""
        model, at = self._model, min(touch + _BEGIN, float(self._marks[-1]))
        foot = self._foot(at)
        model.place(foot, model.straight)
        _, link, s = model.nearest_link()
        start = State(model.straight, link, s, 0.0, False)
        self._at, self._held = at, self._rest.settle(start, foot, foot)

    def _follow(self, target: float) -> bool:
        """Along the stable branch to the station, or to its end and what comes after it.

        Returns
        -------
        bool
            False if the vibrissa does not come to rest.
        """
        failed = np.inf
        while self._at < target:
            held = self._held
            assert held is not None
            goal = target if failed == np.inf else (self._at + failed) / 2
            step = goal - self._at
            found = self._neighbour(held, goal, step)
            if found is None and step > _SMALLEST:
                failed = goal
                continue
            if found is None:
                return self._fall(held, goal)
            self._note_phase(held, goal, found)
            if self._turned(held, found) > _TURN:
                self.events.append(Event("hop", goal))
            self._at, self._held = goal, found
            failed = np.inf if goal >= failed else failed
            failed = np.inf if failed - goal < _SMALLEST else failed
        return True

    def _neighbour(self, held: Settled, goal: float, step: float) -> Settled | None:
        """The stable equilibrium on the same branch."""
        found = self._rest.settle(held.state, self._foot(self._at), self._foot(goal))
        if found is None or found.stability <= 0:
            return None
        if _apart(found, held) > max(_LEAP * step, _LEAST_LEAP):
            return None
        turn = _TURN_OF_SIDE if held.state.sliding and found.state.sliding else _TURN
        if step > _EVENT and self._turned(held, found) > turn:
            return None
        return found

    def _turned(self, held: Settled, found: Settled) -> float:
        """By how much the normal of a faceted body has jumped [rad]."""
        if not self._model.shape.faceted:
            return 0.0
        turned = found.touch.normal - held.touch.normal
        expected = held.turning @ (found.touch.centre - held.touch.centre)
        return float(min(np.linalg.norm(turned), np.linalg.norm(turned - expected)))

    def _note_phase(self, held: Settled, goal: float, found: Settled) -> None:
        """Enclose a change between the tip and the side."""
        low, high = self._at, goal
        if _at_tip(held) == _at_tip(found):
            return
        while high - low > _EVENT:
            middle = (low + high) / 2
            between = self._rest.settle(held.state, self._foot(low), self._foot(middle))
            if between is None:
                break
            if _at_tip(between) == _at_tip(held):
                low, held = middle, between
            else:
                high = middle
        self.events.append(Event("phase", high))

    def _fall(self, held: Settled, goal: float) -> bool:
        """Where the vibrissa goes when no stable equilibrium is near any more."""
        gap = self._gap(goal)
        if held.state.force < _LOOSE or gap > 0:
            released = held.state.force < _LOOSE
            self.events.append(Event("release" if released else "slip-off", self._at))
            self._held, self._lost, self._at = None, gap <= 0, goal
            return True
        for wide in _HOPS if self._model.shape.faceted else _HOPS[:1]:
            found = self._rest.settle(held.state, self._foot(self._at), self._foot(goal), wide)
            if found is not None and found.stability > 0 and _apart(found, held) < _LANDING:
                self.events.append(Event("hop", self._at))
                self._note_phase(held, goal, found)
                self._held, self._at = found, goal
                return True
        landed = self._rest.descend(held, self._foot(goal), _LANDING)
        if landed is None:
            self.events.append(Event("slip-off", self._at))
            self._held, self._lost, self._at = None, True, goal
            return True
        if not landed.stability > 0:
            return False
        self.events.append(Event("hop", self._at))
        self._held, self._at = landed, goal
        return True


def _apart(one: Settled, other: Settled) -> float:
    return float(np.linalg.norm(one.touch.centre - other.touch.centre))


def _at_tip(found: Settled) -> bool:
    return not found.state.sliding and found.state.s == 1.0
