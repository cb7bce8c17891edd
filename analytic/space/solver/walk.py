"""Along the way of the foot: contacts begin, are followed, hop, and end by release or slip-off."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from operator import attrgetter
from typing import Generic, NamedTuple, Protocol, TypeVar

import numpy as np

from analytic.numerics.walk import WalkEvent, first_unlike
from analytic.problem.arrays import Floats
from analytic.space.problem.bodies.polyhedron import Polyhedron
from analytic.space.problem.path import StraightVibrissa
from analytic.space.solver.contact import APART, Contact, Scene, contact_at
from analytic.space.solver.hop import DependsOnMotion, landing
from analytic.space.solver.newton import settle, settle_whole
from analytic.space.solver.stability import is_stable

_CLOSE = 1e-13  # L of the way, to which events are enclosed
_BEYOND = 1e-9  # L: a state that is missing at one place only was missed by Newton's method
_BESIDE = 1e-6  # L: beside a seam, of faces that are 1e-7 rad apart, contacts are on neither
_PACE = 10.0  # of the foot's, that the axis may have there: normals turn at once about a corner
_MISSES = 200  # of these between two stations, and of edges that are crossed
_BARELY = 1e-7  # L and rad: how far a contact that has just begun is bent
LOOSE = 1e-5  # EI/L^2; a contact that ends with less has been released
_LEAP = 0.3  # L on the parallel surface between neighbouring states: more is another branch
_STEADY = 1e-6  # the same across an edge, where the foot moves by 1e-9
_TANGENT = attrgetter("tangent")


class Touching(Protocol):
    """A state of a vibrissa that touches."""

    @property
    def force(self) -> float:
        """Magnitude of the contact's force [EI/L^2]."""


Held = TypeVar("Held", bound=Touching)


class Walked(NamedTuple, Generic[Held]):
    """The states of the stations; lengths in L."""

    # none where the vibrissa is free, or where it is not known where it is.
    contacts: list[Held | None]
    # "ok", or why it is not known, up to where the straight vibrissa is clear of the body again.
    statuses: list[str]
    events: list[WalkEvent]


class Walker(ABC, Generic[Held]):
    """Goes from contact to contact; how one is followed is for each kind of walker to say."""

    def __init__(self, scene: Scene, way: StraightVibrissa) -> None:
        self._scene = scene
        self._way = way
        self._events: list[WalkEvent] = []

    def along(self, travel: Sequence[float] | Floats) -> Walked[Held]:
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
                    at, contact = touch, self._begin(touch)
                    self._note("touch", touch)
                    if contact is None:  # it is dragged along to where it would be clear, too
                        touch, _ = self._clear_of(at)
                        unknown_until, status = np.inf if touch is None else touch, "sticks"
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
                elif elsewhere:
                    unknown_until = np.inf if touch is None else touch
                contact = None
            contacts.append(contact)
            known = contact is not None or station >= unknown_until
            statuses.append("ok" if known else status)
        return Walked(contacts, statuses, self._events)

    @abstractmethod
    def _begin(self, travel: float) -> Held | None:
        """The contact of a vibrissa that is hardly bent; none if friction holds it there."""

    @abstractmethod
    def _follow(self, contact: Held, at: float, to: float) -> tuple[float, Held, bool]:
        """As far as its equilibrium goes; whether that is all."""

    def _land(self, contact: Held, travel: float) -> tuple[float, Held] | None:
        """The state to which a vibrissa hops, and where its foot is then."""
        return None

    def _end(self, contact: Held, travel: float) -> str:
        """Note how a contact ends; the status of stations up to where the vibrissa is clear."""
        # One that has only begun is as loose, but the straight vibrissa is on its way in.
        leaves = self._way.gap(travel + _BESIDE).size > self._way.gap(travel).size
        released = contact.force < LOOSE and leaves
        self._note("release" if released else "slip-off", travel)
        return "ok" if released else "slipped off"

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


class Gliding(Walker[Contact]):
    def __init__(self, scene: Scene, way: StraightVibrissa) -> None:
        super().__init__(scene, way)
        self._smooth = not isinstance(scene.body, Polyhedron)

    def _begin(self, travel: float) -> Contact:
        gap = self._way.gap(travel)
        x = gap.spot.point + APART * gap.spot.normal
        upright = gap.spot.normal @ self._scene.tangent >= -_BARELY
        if gap.arc_length == 1 and not upright:
            return contact_at(self._scene, x, _BARELY, tangent=False)
        lowest = self._way.lowest_contact(travel, gap.arc_length)
        x = x - (gap.arc_length - lowest + _BARELY) * self._scene.tangent
        return contact_at(self._scene, x, lowest, tangent=True)

    def _follow(self, contact: Contact, at: float, to: float) -> tuple[float, Contact, bool]:
        """As far as there is a stable equilibrium near the one before."""
        failed, missed = np.inf, 0
        while at < to:
            if failed - at <= _CLOSE:
                missed += 1
                beyond, found = self._beyond(contact, failed, to)
                if found is None or missed > _MISSES:
                    return at, contact, False
                goal, failed = beyond, np.inf
            else:
                goal = to if failed == np.inf else (at + failed) / 2
                found = self._stable_at(contact, goal)
                if found is None:
                    failed = goal
                    continue
            if found.tangent != contact.tangent:
                self._note("phase", first_unlike(contact, at, goal, self._on, _TANGENT, _CLOSE))
            at, contact = goal, found
        return at, contact, True

    def _stable_at(self, start: Contact, travel: float) -> Contact | None:
        """On the same face, edge or corner of a mesh."""
        foot = self._way.foot(travel)
        found = self._on_feature(start, foot)
        if found is None or _apart(found, start) > _LEAP:
            return None
        if not self._smooth:
            found = settle_whole(self._scene, found, foot)
        return found if found is not None and is_stable(found, self._scene.radius) else None

    def _on(self, start: Contact, _: float, travel: float) -> Contact | None:
        return self._stable_at(start, travel)

    def _on_feature(self, start: Contact, foot: Floats) -> Contact | None:
        feature = self._scene.body.feature(start.spot)
        return settle(self._scene._replace(body=feature), start, foot)

    def _beyond(self, contact: Contact, failed: float, to: float) -> tuple[float, Contact | None]:
        """Where it goes on, and the state there; beside a seam of two faces none is found."""
        beyond = failed
        for step in (_BEYOND, _BESIDE):
            beyond = min(failed + step, to)
            found = self._across(contact, beyond, _STEADY + _PACE * step)
            if found is not None:
                return beyond, found
        return beyond, None

    def _across(self, start: Contact, travel: float, steady: float) -> Contact | None:
        """On the next face, edge or corner, where the state goes on as it was."""
        foot = self._way.foot(travel)
        ahead = self._on_feature(start, foot)
        if ahead is None:
            return None
        beside = contact_at(self._scene, ahead.on_parallel, ahead.free, ahead.tangent)
        found = self._stable_at(beside, travel)
        if found is None or np.linalg.norm(found.centre - start.centre) >= steady:
            return None
        return found

    def _land(self, contact: Contact, travel: float) -> tuple[float, Contact] | None:
        if contact.force < LOOSE:
            return None
        beyond = min(travel + _BEYOND, float(self._way.marks[-1]))
        foot = self._way.foot(beyond)
        landed = landing(self._scene, contact, self._way.foot(travel), foot)
        if landed is None:
            return None
        self._note("hop", travel)
        return beyond, landed


def _apart(one: Contact, other: Contact) -> float:
    return float(np.linalg.norm(one.on_parallel - other.on_parallel))
