"""Along the way of the foot: a contact begins, is followed, hops, and ends.

MuJoCo alone decides: distances of the straight vibrissa say where it touches and when it is clear,
Newton's method on MuJoCo's balance follows the stable equilibrium, and where that ends a descent on
the energy of MuJoCo's springs and contact says where the vibrissa goes.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from analytic.numerics.arrays import Floats
from analytic.numerics.walk import WalkEvent, first_clear, first_touch, first_unlike
from mujoco_models.space.balance import State
from mujoco_models.space.descent import descend
from mujoco_models.space.hop import features_around, over_faces
from mujoco_models.space.model import SpaceModel
from mujoco_models.space.rest import Rest, Settled
from mujoco_models.space.surface import Surface, surface_at

_TOUCH = 1e-10  # L of the way, to which the first contact is enclosed
# L beyond it, where a contact begins, or at the station if that is nearer: nearer to the touch a
# bead comes to rest on the upright side of a circle, as if the contour went on so.
_BEGIN = 1e-6, 1e-3
_ALONG = 1e-7  # L: as near as the nearest link; MuJoCo's vertices are in single precision
_FLAT = 5e-3  # L; past a body of a radius of curvature of 100 L it is as near over 4.5e-3 L
_EDGE = 1e-6  # L, to which it is known where a vibrissa along a face begins to
_SMALLEST = 1e-5  # L; an equilibrium that steps as small as this do not find has ended
_EVENT = 5e-4  # L, to which a change of phase is enclosed
# Of the contact in a step: more is another branch. Next to its end a branch is steep, so that steps
# are halved there.
_LEAP, _LEAST_LEAP = 5.0, 0.02  # of the step; L
_LONGEST = 0.1  # L of the way in a step, however far apart stations are
_TURNED = 0.2  # rad, of any link in a step: beyond a slip-off the vibrissa bends another way
_LEAP_ON_FACE = 0.3  # L; a side that lies on a face touches anywhere along it
_ASTRAY = 2.0  # of that; Newton's method that leads farther is not on its way there
# L, of the contact: what comes to rest farther away depends on its motion. This side's own limit,
# as is the next line: the closed form has others, which may be moved without these.
_LANDING = 0.12
# L, of the foot, for a way down that does not begin; by the first three alone 7 of 72 sweeps along
# a box's face, each begun elsewhere, ended unsettled at its edge.
_AHEAD = 0.0, 1e-3, 4e-3, 3e-4, 3e-3
_CROSSED = 1e-4  # L, to which it is enclosed where a contact leaves a face, an edge or a corner
_STEADY = 2e-3  # L, of the contact that goes on as it was beyond
_ASTRAY_BESIDE = 10 * _STEADY  # a step that leads farther does not end there
_SHORTER, _LONGER = 4.0, 2.0  # times the step where Newton's method fails, and where not
_INDIFFERENT = 1e-8  # of the softest eigenvalue: of zero rounding leaves up to 1e-10
_LOOSE = 1e-3  # EI/L^2; a contact that ends with less has been released


class Station(NamedTuple):
    """What a station comes to."""

    status: str
    settled: Settled | None  # None where nothing touches, or where it is not known what does


class Walk:
    """A walk along the way of the foot."""

    def __init__(
        self, model: SpaceModel, rest: Rest, foot: Callable[[float], Floats], marks: Floats
    ) -> None:
        self._model, self._rest, self._foot, self._marks = model, rest, foot, marks
        self._at = 0.0
        self._held: Settled | None = None
        self._lost = ""  # the status until the vibrissa is clear, where it has gone elsewhere
        self.events: list[WalkEvent] = []

    def go_to(self, target: float) -> Station:
        """Go on to a station."""
        while self._at < target:
            if self._held is None:
                self._seek(target)
            else:
                self._follow(target)
        if self._held is None:
            return Station(self._lost or "ok", None)
        exactly = self._rest.exactly(self._held, self._foot(target))
        if exactly is None:
            return Station("unsettled", None)
        self._held = exactly
        return Station("ok", self._held)

    def _gap(self, travel: float) -> float:
        """Between the body and the straight vibrissa [L]."""
        self._model.place(self._foot(travel), self._model.straight)
        return self._model.nearest_link()[0]

    def _seek(self, target: float) -> None:
        """Go on to the next contact, or to the station."""
        if self._lost:
            if self._gap(target) <= 0:
                self._at = target
                return
            self._lost = ""
            self._at = self._clear(self._at, target)
        corners = self._marks[(self._marks > self._at) & (self._marks < target)]
        touch = first_touch(self._gap, self._at, [*corners.tolist(), target], _TOUCH)
        if touch is None:
            self._at = target
            return
        self.events.append(WalkEvent("touch", touch))
        self._begin(touch, target)

    def _clear(self, low: float, high: float) -> float:
        """Where the straight vibrissa comes clear of the body, a little beyond."""
        found = first_clear(self._gap, low, [high], _TOUCH)
        assert found is not None
        return min(found + 2 * _TOUCH, high)

    def _begin(self, touch: float, target: float) -> None:
        """The contact of a vibrissa that is hardly bent."""
        model, (least, most) = self._model, _BEGIN
        at = min(max(touch + least, min(touch + most, target)), float(self._marks[-1]))
        foot = self._foot(at)
        model.place(foot, model.straight)
        nearest, link, s = model.nearest_link()
        lower = self._lowest(nearest + _ALONG, s)
        if s - lower[1] > _FLAT:  # along a face the vibrissa bends at its first edge
            link, s = lower
        start = State(model.straight, link, s, 0.0, False)
        surface = surface_at(model, model.touch(link, s))
        self._at, self._held = at, self._rest.settle(start, surface, foot, foot)
        if self._held is None:
            self._lost = "unsettled"

    def _lowest(self, near: float, s: float) -> tuple[int, float]:
        """Where the straight vibrissa, from the clamp on, first is so near to the body.

        Along a line the distance of a convex body falls to its least, and then rises.
        """
        model = self._model

        def link_at(s: float) -> int:
            return min(int(np.searchsorted(model.ends, s)), len(model.ends) - 1)

        def off(s: float) -> float:
            return model.touch(link_at(s), s).distance - near

        first = float(model.layout.joints[0])
        if off(first) > 0 > off(s):
            s = float(brentq(off, first, s, xtol=_EDGE))
        return link_at(s), s

    def _follow(self, target: float) -> None:
        """Along the stable branch to the station, or to its end and what comes after it."""
        stride = _LONGEST  # how far Newton's method leads
        while self._at < target:
            goal = min(target, self._at + stride)
            found = self._neighbour(goal)
            if found is not None and not found.stays:
                goal, found = self._to_the_edge(found, goal)
            held, step = self._held, goal - self._at
            assert held is not None
            if found is None:
                stride = step / _SHORTER
                if step <= _SMALLEST:
                    self._fall(held, goal)
                    return
            elif found.stays:
                self._go_on(found, goal)
                stride = min(max(_LONGER * step, stride), _LONGEST)
            else:
                beyond = self._across(held, found, goal)
                if beyond is None:
                    self._fall(held, goal)
                    return
                self._go_on(beyond, goal)

    def _go_on(self, found: Settled, goal: float) -> None:
        """To the next state of the same branch."""
        assert self._held is not None
        self._note_phase(self._held, goal, found)
        self._at, self._held = goal, found

    def _to_the_edge(self, found: Settled, goal: float) -> tuple[float, Settled | None]:
        """Up to the place where the contact leaves its face, edge or corner."""
        while goal - self._at > _CROSSED:
            middle = (self._at + goal) / 2
            between = self._neighbour(middle)
            if between is None:
                return middle, None
            if between.stays:
                self._go_on(between, middle)
            else:
                goal, found = middle, between
        return goal, found

    def _neighbour(self, goal: float) -> Settled | None:
        """The stable equilibrium on the same branch, of a mesh on the same face, edge or corner."""
        held, step = self._held, goal - self._at
        assert held is not None
        feature = held.surface.feature
        on_face = feature is not None and feature.flat
        farthest = _LEAP_ON_FACE if on_face else max(_LEAP * step, _LEAST_LEAP)
        found = self._rest.follow(held, self._foot(self._at), self._foot(goal), _ASTRAY * farthest)
        if found is None or _apart(found, held) > farthest:
            return None
        return found if _turned(found, held) <= _TURNED else None

    def _across(self, held: Settled, found: Settled, goal: float) -> Settled | None:
        """On the next face, edge or corner, where the equilibrium goes on as it was."""
        model, foot, state = self._model, self._foot(goal), found.state
        model.place(foot, state.configuration)
        touch = model.touch(state.link, state.s)
        if held.surface.feature is not None and held.surface.holds(state.link, touch.centre):
            _, link, s = model.nearest_link()  # another link is deeper
            state = state._replace(link=link, s=s, sliding=False)
            touch = model.touch(link, s)
        beyond = self._goes_on(held, state, surface_at(model, touch), foot)
        if beyond is not None or not (held.state.sliding and model.mesh is not None):
            return beyond
        # Next to a corner a side comes over several edges within a step.
        model.place(foot, held.state.configuration)
        for feature in features_around(model, model.contact(held.touch)):
            beyond = self._goes_on(held, held.state, Surface(model, feature), foot)
            if beyond is not None:
                return beyond
        return None

    def _goes_on(
        self, held: Settled, state: State, surface: Surface, foot: Floats
    ) -> Settled | None:
        """The stable equilibrium on a face, edge or corner, if it is next to the one before."""
        near = held.touch.centre
        found = self._rest.settle(state, surface, foot, foot, near, _ASTRAY_BESIDE)
        if found is None or not (found.stays and found.stable):
            return None
        return found if _apart(found, held) < _STEADY else None

    def _note_phase(self, held: Settled, goal: float, found: Settled) -> None:
        """Enclose a change between the tip and the side."""
        if _at_tip(held) == _at_tip(found):
            return

        def followed(held: Settled, low: float, high: float) -> Settled | None:
            between = self._rest.follow(held, self._foot(low), self._foot(high))
            return between if between is not None and between.stays else None

        high = first_unlike(held, self._at, goal, followed, _at_tip, _EVENT)
        self.events.append(WalkEvent("phase", high))

    def _fall(self, held: Settled, goal: float) -> None:
        """Where the vibrissa goes when no stable equilibrium is near any more."""
        clear, loose = self._gap(goal) > 0, held.state.force < _LOOSE
        hopped = landed = None
        if not (clear and loose):
            hopped = over_faces(self._rest, held, self._foot(goal), _LANDING)
            landed = hopped or self._descended(held, goal)
            if landed and landed.state.force > _LOOSE and not self._is_held(landed, goal):
                hopped = landed = None
        self._held = None
        if landed is None or (loose and not landed.stable):
            self.events.append(WalkEvent("release" if loose else "slip-off", self._at))
            self._lost = "" if clear else "slipped off"
        elif not landed.stable:
            self._lost = "unsettled"
        else:
            if hopped or _apart(landed, held) > _STEADY:  # or the same branch, where that is steep
                self.events.append(WalkEvent("hop", self._at))
            self._held = landed
        self._at = goal

    def _is_held(self, landed: Settled, goal: float) -> bool:
        """Whether a face across the clamp's tangent does not let the vibrissa turn about that."""
        return self._rest.softest(landed, self._foot(goal))[0] > _INDIFFERENT

    def _descended(self, held: Settled, goal: float) -> Settled | None:
        """Where the vibrissa goes down to.

        Just beyond the end of a branch the way down begins so slowly that the foot goes on.
        """
        for ahead in _AHEAD:
            at = min(goal + ahead, float(self._marks[-1]))
            landed = descend(self._rest, held, self._foot(at), _LANDING)
            if landed is None:
                return None
            if landed.stable:
                foot = self._foot(goal)
                back = self._rest.settle(landed.state, landed.surface, self._foot(at), foot)
                if back is not None and back.stays and back.stable:
                    return back
        return held._replace(stable=False)


def _apart(one: Settled, other: Settled) -> float:
    return float(np.linalg.norm(one.touch.centre - other.touch.centre))


def _turned(one: Settled, other: Settled) -> float:
    """By how much the link turns that turns most [rad]."""
    return float(np.linalg.norm(one.tangents - other.tangents, axis=1).max())


def _at_tip(found: Settled) -> bool:
    return not found.state.sliding and found.state.s == 1.0
