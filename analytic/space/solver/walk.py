"""Along the way of the foot: contacts begin, are followed, hop, and end by release or slip-off."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.numerics.walk import WalkEvent
from analytic.space.problem.path import StraightVibrissa
from analytic.space.solver.branch import LAST, LOOSE, NOTED, Branch, Held
from analytic.space.solver.contact import Scene
from analytic.space.solver.hop import DependsOnMotion, landing
from analytic.space.solver.panel import FAINT

_CLOSE = 1e-12  # L of the way: a vibrissa that has just come clear does not touch
_BEYOND = 1e-8  # L, of the foot, where it lands: where it slips off is known to 2e-9 L
_BESIDE = 1e-6  # L, of the foot: whether it goes away from the body


class Walked(NamedTuple):
    """The states of the stations; lengths in L."""

    # none where the vibrissa is free, or where it is not known where it is.
    contacts: list[Held | None]
    # "ok", or why it is not known, up to where the straight vibrissa is clear of the body again.
    statuses: list[str]
    events: list[WalkEvent]


class Walk:
    """Goes from contact to contact."""

    def __init__(self, scene: Scene, way: StraightVibrissa, friction: float = 0.0) -> None:
        self._scene, self._way, self._rubs = scene, way, friction > 0
        self._branch = Branch(scene, way, friction)
        self._events: list[WalkEvent] = []

    def along(self, travel: Sequence[float] | Floats) -> Walked:
        """Every station's state, in order."""
        contacts: list[Held | None] = []
        statuses: list[str] = []
        contact: Held | None = None
        at, unknown_until, status = 0.0, 0.0, "ok"
        touch = self._way.next_touch(0.0)
        for station in travel:
            while True:
                if contact is None:
                    if touch is None or touch >= station:
                        break
                    at, contact = touch, self._branch.begin(touch)
                    self._note("touch", touch)
                    if contact is None:
                        touch, unknown_until = self._clear_of(at + 10 * _CLOSE)
                        status = "slipped off"
                        if self._rubs:  # it is dragged along to where it would be clear, too
                            unknown_until, status = np.inf if touch is None else touch, "sticks"
                        else:
                            self._note("slip-off", at)
                        continue
                at, contact, arrived = self._follow(contact, at, station)
                if arrived:
                    break
                try:
                    landed, elsewhere = self._land(contact, at), False
                except DependsOnMotion:
                    landed, elsewhere = None, True
                if landed is not None:
                    at, contact = landed
                    continue
                status = self._end(contact, at)
                touch, unknown_until = self._clear_of(at)
                if status == "ok":
                    unknown_until = at
                elif status == "diverged" and contact.stretch.event != "release":
                    # It may hold on long after the straight one is clear.
                    touch, unknown_until = None, np.inf
                elif elsewhere:
                    unknown_until = np.inf if touch is None else touch
                contact = None
            contacts.append(contact)
            known = contact is not None or station >= unknown_until
            statuses.append("ok" if known else status)
        return Walked(contacts, statuses, self._events)

    def _follow(self, held: Held, at: float, to: float) -> tuple[float, Held, bool]:
        """As far as its equilibrium goes; whether that is all."""
        stretch = held.stretch
        while stretch.last.travel < to:
            following = self._branch.after(stretch)
            if following is None or following.astray == np.inf:
                at, last = stretch.last.travel, stretch.last
                if stretch.event not in LAST and last.contact.force < FAINT and self._leaves(at):
                    stretch = stretch._replace(event="release")
                if stretch.event == "release":
                    at = max(at, self._way.next_clear(at) or at)
                return at, held._replace(state=last, stretch=stretch), False
            if stretch.event in NOTED and (self._rubs or following.panel is not stretch.panel):
                self._note(stretch.event, stretch.last.travel)
            stretch = following
        return to, stretch.at(to), True

    def _land(self, held: Held, travel: float) -> tuple[float, Held] | None:
        """The state to which a vibrissa hops, and where its foot is then."""
        if held.stretch.event != "slip-off" or (self._rubs and self._scene.body.smooth):
            return None
        if self._rubs:  # past edges it may be caught again, on a face or by a corner
            raise DependsOnMotion
        beyond = min(travel + _BEYOND, float(self._way.marks[-1]))
        feet = self._way.foot(travel), self._way.foot(beyond)
        landed = landing(self._scene, held.state.contact, *feet)
        found = None if landed is None else self._branch.on_from(landed, beyond)
        if found is None:
            return None
        self._note("hop", travel)
        return beyond, found

    def _end(self, contact: Held, travel: float) -> str:
        """Note how a contact ends; the status of stations up to where the vibrissa is clear."""
        if contact.stretch.event not in LAST:
            return "diverged"
        lost = contact.stretch.event == "release" and contact.force >= LOOSE
        # One that has only begun is as loose, but the straight vibrissa is on its way in.
        released = lost or (contact.force < LOOSE and self._leaves(travel))
        self._note("release" if released else "slip-off", travel)
        return "diverged" if lost else "ok" if released else "slipped off"

    def _leaves(self, travel: float) -> bool:
        return bool(self._way.gap(travel + _BESIDE).size > self._way.gap(travel).size)

    def _clear_of(self, travel: float) -> tuple[float | None, float]:
        """Where the straight vibrissa touches next, and from where on it is clear."""
        clear: float | None = travel
        if self._way.gap(travel).size <= 0:
            clear = self._way.next_clear(travel)
        if clear is None:
            return None, np.inf
        return self._way.next_touch(clear + 10 * _CLOSE), clear

    def _note(self, kind: str, travel: float) -> None:
        self._events.append(WalkEvent(kind, travel))
