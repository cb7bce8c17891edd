"""Stretch by stretch along the way of the foot: contacts slide, stick, change phase, and end."""

from collections.abc import Iterable, Iterator
from itertools import product
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from analytic.numerics.arrays import Floats
from analytic.space.problem.bodies.body import Feature, Spot, across
from analytic.space.problem.path import StraightVibrissa
from analytic.space.solver.contact import APART, Contact, Scene
from analytic.space.solver.panel import POINTS, Law, Panel, panel
from analytic.space.solver.sliding import BY_TRAVEL, Leg, Sliding, changed, state_of
from analytic.space.solver.stability import margin, second_variation

_LOOKED_AT = 720  # directions
_ALIKE = 1e-9  # of the foot's speed
_BEFORE = 1e-13  # L of the way: touching, but not within
_FIRST, _LONGEST, _SHORTEST = 0.02, 0.5, 1e-10  # of panels, along the curve's tangent
_LONGER, _SHORTER = 2.0, 0.25  # times the last one
_SHORT = 1e-3, 1e-6  # of panels past an edge, if something happens soon
_SEAM, _OTHERWISE = 1e-6, 1e-3  # of panels that end at a seam; 1/L, of curvatures past it
_AT_ONCE = 1e-9  # L of the way, from sticking to sliding or back
_WHOLLY = 1.0  # of rates: rounding may have made them
_SAFE = 0.8  # of a length that would just be short enough
LAST = "slip-off", "release"
NOTED = "phase", "stick", "slide"
_CLOSE = 1e-14  # of a panel, to which events are enclosed
# How much coarser the panel of a first contact may be: with so little force rounding leaves more of
# friction's direction, and it is steep. What follows forgets it.
_STEEP = 1e3
_AHEAD = 1e-8  # of the state's vector, past an edge
_BESIDE = 1e-6  # of the same, past a seam of faces that are 1e-7 rad apart
_MARKED = 1e-12  # L, to a corner of the way
_SAME = 1e-12  # L; a point that is farther from the body's nearest one is on another face or edge
LOOSE = 1e-5  # EI/L^2; a contact that ends with less has been released
_STILL = 1e-9  # of a speed: a contact that has just begun to slide hardly does


def first_slips(
    scene: Scene, way: StraightVibrissa, touch: float, friction: float
) -> Iterator[Sliding]:
    """States at first contact, still straight, by the direction of friction."""
    before, onward = touch - _BEFORE, way.onward(touch)
    lowest = way.lowest_contact(before, way.gap(before).arc_length)
    spot = scene.body.nearest(way.foot(before) + lowest * scene.tangent, APART)
    normal = spot.normal
    directions = _directions(normal, scene.tangent, onward, friction)
    for tau in directions if friction else [np.zeros(3)]:
        numbers = 0.0, lowest, touch
        force = normal + friction * tau
        place = spot.point + APART * normal
        vector = np.concatenate([place, friction * tau, force, np.array(numbers)])
        yield state_of(scene, vector, lowest < 1)


def _directions(normal: Floats, t: Floats, onward: Floats, friction: float) -> Iterator[Floats]:
    """Of friction that is along the velocity, of a vibrissa that is pressed."""
    sides = across(normal)

    def both(angle: Floats) -> tuple[Floats, Floats]:
        """Of the velocity: across friction, and along it."""
        tau = np.stack([np.cos(angle), np.sin(angle)], axis=-1) @ sides
        bends = normal + friction * tau
        bends = bends - np.multiply.outer(bends @ t, t)
        presses = bends @ normal
        pressed = -(onward @ normal) / np.where(presses > 0, presses, np.nan)
        beside = np.cross(normal, tau)
        return tuple(w @ onward + pressed * (bends * w).sum(axis=-1) for w in (beside, tau))

    angles = np.linspace(0, 2 * np.pi, _LOOKED_AT + 1) + 1e-3
    values = both(angles)[0]
    for i in np.flatnonzero(values[:-1] * values[1:] < 0):
        root = np.asarray(brentq(lambda x: float(both(x)[0]), angles[i], angles[i + 1], xtol=1e-15))
        if both(root)[1] <= _ALIKE:
            yield np.array([np.cos(root), np.sin(root)]) @ sides


class Stretch(NamedTuple):
    """A panel up to what happens first on it."""

    panel: Panel
    end: float  # share of it
    event: str | None  # none at its own end
    last: Sliding  # the state there
    astray: float  # logarithm of how much another direction of friction has grown up to there

    def at(self, travel: float) -> "Held":
        """The state where the foot has come so far."""
        share = self.panel.share_at(travel, self.end)
        state = self.panel.at(share, travel)
        velocity, speed = self.panel.velocity(share, state)
        return Held(state, velocity / speed, self)


class Held(NamedTuple):
    """A state on its stretch."""

    state: Sliding
    velocity: Floats  # of the vibrissa's point along the body by the foot's, shape (3,)
    stretch: Stretch

    @property
    def force(self) -> float:
        """Magnitude of the contact's force, friction and all [EI/L^2]."""
        return self.state.contact.force


class Branch:
    """The states of a contact, stretch by stretch."""

    def __init__(self, scene: Scene, way: StraightVibrissa, friction: float) -> None:
        self._scene, self._way, self._friction = scene, way, friction

    def begin(self, travel: float) -> Held | None:
        """The contact of a vibrissa that is hardly bent; none if friction holds it there."""
        for first in first_slips(self._scene, self._way, travel, self._friction):
            # Along an upright face the vibrissa bends about its lower end.
            low = first.contact.on_parallel - _AHEAD * self._scene.tangent
            scene = self._on(self._scene.body.nearest(low, APART))
            state = state_of(scene, first.vector, first.contact.tangent)
            found = self._panel(self._leg(travel), state, False, _FIRST, None)
            goes_on = "stick" if self._friction else "slip-off"
            if found is not None and self._margins(found, 1)[goes_on] > 0:
                return Held(state, np.zeros(3), self._stretch(found))
        return None

    def on_from(self, landed: Contact, travel: float) -> Held | None:
        """On from where a vibrissa without friction has landed."""
        numbers = np.array([landed.rotation, landed.arc_length, travel])
        parts = landed.on_parallel, np.zeros(3), landed.plane.lateral, numbers
        state = state_of(self._on(landed.spot), np.concatenate(parts), landed.tangent)
        found = self._panel(self._leg(travel), state, False, _FIRST, None)
        return found and Held(state, np.zeros(3), self._stretch(found))

    def after(self, stretch: Stretch) -> Stretch | None:
        """What follows; none after the last of a contact."""
        done, state, event = stretch.panel, stretch.last, stretch.event
        if event in LAST:
            return None
        sticks, leg, scene = done.law.sticks, done.law.leg, done.scene
        if event == "phase":
            state = state_of(scene, state.vector, not state.contact.tangent)
        elif event in ("stick", "slide"):
            sticks = not sticks
        elif event == "corner":
            leg = self._leg(state.travel)
        reach = min(done.reach * min(_change(done), _LONGER), _LONGEST)
        if event == "phase" or (event and not (self._friction and self._scene.body.smooth)):
            states = self._past_edge(stretch) if event == "edge" else [state]
            return self._lasting(stretch, leg, states, sticks, reach)
        found = self._panel(leg, state, sticks, reach, done if event is None else None)
        if self._friction and event is None and (found is None or found.reach < _SEAM):
            past = self._lasting(stretch, leg, _past_seam(stretch), sticks, reach)
            if past is not None and past.panel is not done:
                return past
        if found and found.law.rubs and self._margins(found, 0)["stick"] < -_STILL:
            found = self._panel(leg, state, True, reach, None)  # the foot has turned
        for most in _SHORT:
            if found is None:
                return None
            following = self._stretch(found, stretch.astray)
            turns = event is not None or found.law.sticks != done.law.sticks
            turns &= following.event in ("stick", "slide")
            if not turns or following.last.travel - state.travel > _AT_ONCE:
                return following
            # It turns before the first point of a panel, which has to be shorter to show it.
            found = self._panel(leg, state, found.law.sticks, most, None)
        return None  # it neither sticks nor slides, or rounding alone says which

    def _past_edge(self, stretch: Stretch) -> Iterator[Sliding]:
        """The state on the next face or edge, and past a seam of faces that are nearly one."""
        done, state = stretch.panel, stretch.last
        for ahead in (_AHEAD, _BESIDE):
            place = _onward(state, done.law, ahead)[:3]
            scene = self._on(self._scene.body.nearest(place, APART))
            near = state_of(scene, state.vector, state.contact.tangent)
            # The edge was found to `_SAME` only.
            yield done.law.settled(scene, near, BY_TRAVEL, state.travel) or near

    def _lasting(
        self, before: Stretch, leg: Leg, states: Iterable[Sliding], sticks: bool, reach: float
    ) -> Stretch | None:
        """Sliding or sticking past an edge, whichever goes on; neither, and it lets go there."""
        known, laws = False, (sticks, not sticks) if self._friction else (False,)
        for state in states:
            for law, most in product(laws, (reach, *_SHORT)):
                found = self._panel(leg, state, law, most, None)
                known |= found is not None
                if found is not None and min(self._margins(found, 1).values()) > 0:
                    return self._stretch(found, before.astray)
        return before._replace(event="slip-off") if known else None

    def _on(self, spot: Spot) -> Scene:
        """The face, edge or corner that a spot of a body with edges is on, alone."""
        smooth = self._scene.body.smooth
        return self._scene if smooth else self._scene._replace(body=Feature.of(spot))

    def _leg(self, travel: float) -> Leg:
        begins = self._way.marks[:-1]
        mark = float(begins[begins <= travel + _MARKED][-1])
        return Leg(self._way.foot(mark), self._way.onward(mark), mark)

    def _panel(
        self, leg: Leg, state: Sliding, sticks: bool, reach: float, before: Panel | None
    ) -> Panel | None:
        """As long as its polynomials may be."""
        law, scene = Law(leg, self._friction, sticks), self._on(state.contact.spot)
        allowed = 1 if state.contact.force > 0 else _STEEP
        while reach > _SHORTEST:
            found = panel(scene, law, state, reach, before)
            known = found is not None and found.rounded < _WHOLLY
            if found is not None and known and found.coarse <= allowed:
                return found
            reach *= max(_change(found), _SHORTER) if found is not None and known else _SHORTER
        return None

    def _stretch(self, found: Panel, astray: float = 0.0) -> Stretch:
        margins = [self._margins(found, i) for i in range(1, len(POINTS))]
        end, event = 1.0, None
        for kind in margins[0]:
            passed = [i for i, values in enumerate(margins, start=1) if values[kind] <= 0]
            if not passed:
                continue

            def left(share: float, kind: str = kind) -> float:
                return self._margin(found, share, found.at(share))[kind]

            low, high = float(POINTS[passed[0] - 1]), float(POINTS[passed[0]])
            share = low if left(low) <= 0 else float(brentq(left, low, high, xtol=_CLOSE))
            if share < end:
                end, event = share, kind
        last = found.states[-1] if event is None else found.at(end)
        return Stretch(found, end, event, last, found.astray(astray, end))

    def _margins(self, found: Panel, i: int) -> dict[str, float]:
        return self._margin(found, float(POINTS[i]), found.states[i])

    def _margin(self, found: Panel, share: float, state: Sliding) -> dict[str, float]:
        """What is positive up to an event."""
        velocity, speed = found.velocity(share, state)
        speed += found.rounded  # no reversal of the foot that rounding alone may have made
        contact, size = state.contact, float(np.sqrt(state.rub @ state.rub))
        if not self._friction:
            speed = margin(second_variation(contact, self._scene.radius))
        margins = {
            "slip-off": speed,
            "release": contact.force - LOOSE / 2,
            "phase": 1 - contact.arc_length if contact.tangent else state.leans_in,
        }
        if found.law.sticks:
            margins["slide"] = self._friction - size
        elif self._friction:
            margins["stick"] = -float(velocity @ state.rub) / size
        if not self._scene.body.smooth:
            nearest = self._scene.body.nearest(contact.on_parallel, APART).point
            margins["edge"] = _SAME - float(np.linalg.norm(nearest - contact.spot.point))
        ahead = self._way.marks[self._way.marks > found.law.leg.travel]
        if len(ahead) > 1:
            margins["corner"] = float(ahead[0]) - state.travel
        return margins


def _past_seam(stretch: Stretch) -> Iterator[Sliding]:
    """The state where a smooth body is curved otherwise: no polynomial goes across."""
    done, last = stretch.panel, stretch.last.contact
    for ahead in (_AHEAD, _BESIDE):
        vector = _onward(stretch.last, done.law, ahead)
        near = state_of(done.scene, vector, last.tangent)
        if np.abs(near.contact.spot.turning - last.spot.turning).max() > _OTHERWISE:
            found = done.law.settled(done.scene, near, done.by, float(done.by @ vector))
            if found is not None:
                yield found


def _onward(state: Sliding, law: Law, ahead: float) -> Floats:
    """A little farther along the curve; short panels' polynomials go astray past their ends."""
    rates = changed(state, law.along_curve(state))
    return np.asarray(state.vector + ahead * rates / np.sqrt(rates @ rates))


def _change(found: Panel) -> float:
    """How much longer a panel might be, or has to be shorter."""
    return _SAFE * float(max(found.coarse, 1e-12) ** (-1 / (len(POINTS) - 1)))
