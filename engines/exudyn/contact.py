"""The cable past any convex contour, smooth or with corners: a joint that moves along it.

The cable is held at a point of the line that its axis feels, the contour moved out by the
vibrissa's radius: by its tip, or by a joint through which it slides. The object does not rub, so
the joint is moved along that line until its force has no part along it. A polygon's line is made
of edges, on which the normal stays and the point moves, and of arcs about the corners, on which
the normal turns; on both, and on a smooth contour, that part of the force is a continuous function
of the place, with a root to be found.

Which root, is said by the energy E(t) of a cable that is held at t, whose derivative is that force.
A tip goes downhill, and stays where E is least. A cable that lies alongside must be outside of the
object everywhere, so it is held at the one place that keeps all of it outside: where E is largest.
A tip that finds no place to stay has let go.
"""

import numpy as np
from scipy.optimize import brentq

from analytic.numerics.arrays import Floats
from analytic.problem.case import Case
from analytic.problem.rest import first_touch
from engines.agreement import Surface
from engines.exudyn.cable import Cable, LostError
from engines.stations import Row, free_row
from mujoco_models.beams.vibrissa import Vibrissa

_STILL = 1e-7  # EI/L^2; the force along the contour that is none
_CLOSE = 1e-10  # L, or rad about a corner; how well a root is known
_PROBE, _LONGEST = 1e-5, 0.02  # L, or rad; the steps in which a root is looked for
_SHORT = 1e-3  # L; a step of the foot in which a vibrissa can be seen to let go
_TURNS = 4  # changes between tip and side at a station
_ALONG = 1e-9  # cosine; a tip that lies alongside
_POINTS = 400  # of contour and vibrissa, to find where the one is clear of the other
_INSIDE = 1e-4  # L; a cable deeper than that has gone into the object


class CableOnContour:
    """A cable, a contour and where they touch; see `engines.stations.Rest`."""

    def __init__(self, case: Case, elements: int) -> None:
        rest, self._line = case.beam.unloaded, case.centreline
        self._rest, self._radius, self._free = rest, case.radius, free_row(case)
        self._cable = Cable(elements, Vibrissa.of(case.beam, case.support))
        self._last, self._first = case.reach
        self._breaks = self._line.breaks()
        self._surface = Surface(case)
        # Between the two feet the vibrissa at rest is in the object.
        touch = first_touch(self._line, case.reach, rest)
        self._near, self._far = touch.p, self._last_touch()
        if touch.excess < 0:
            s = np.array(1 + touch.excess)
            self._cable.let_slide(float(s), np.array(rest.at(s)[:2]))
        self._t, self._state, self._has_let_go = touch.t, self._cable.state(), False
        self._found = self._t, self._state, self._has_let_go
        self._foot_x = self._accepted_at = np.inf

    def _last_touch(self) -> float:
        """The foot position left of which the vibrissa at rest is clear of the object [L]."""
        s = np.linspace(0, 1, _POINTS)
        x, y, _ = self._rest.at(s)
        on = self._line.at(np.linspace(self._last, self._first, _POINTS))
        beside = on.eta <= y[-1]
        return float((on.xi - np.interp(on.eta, y, x))[beside].min())

    def at(self, foot_x: float) -> Row | None:
        """By moving the joint from where it was."""
        way, self._foot_x = self._accepted_at - foot_x, foot_x
        if foot_x >= self._near or self._has_let_go:
            self._found = self._t, self._state, self._has_let_go
            return self._free
        self._cable.go_back(self._state)
        try:
            t = self._settle(self._t)
        except LostError:
            return None
        if t is None:
            # Not in a long step, in which it may have been touched and let go of unseen.
            self._found = self._last, self._state, True
            return self._free if way < _SHORT and foot_x <= self._far else None
        return None if self._is_inside() else self._row(t)

    def accept(self) -> None:
        """Go on from the joint and the cable of the last station."""
        self._t, self._state, self._has_let_go = self._found
        self._accepted_at = self._foot_x

    def _settle(self, t: float) -> float | None:
        """Where it is held at rest, by the tip or by the side; None if nowhere."""
        cable = self._cable
        for _ in range(_TURNS):
            found = self._root(t)
            if found is None:
                return None
            t = found
            if cable.held.slides and cable.beyond:
                cable.hold_tip()
            elif not cable.held.slides and self._lies_alongside(t):
                cable.let_slide(1.0, cable.held.point)
            else:
                # The object pushes: an object does not pull.
                return t if float(self._clamp[:2] @ self._outward(t)) <= 0 else None
        raise LostError  # neither of the two

    def _root(self, t: float) -> float | None:
        """The next place where the joint stays; tip and side go there in their own direction.

        By secants. Just before a fold a second root, where the tip would not stay, is near the
        first; secants come to that from its own side, and do not step over both.
        """
        towards = 1 if self._cable.held.slides else -1
        here, slope = self._along(t), None
        while abs(here) > _STILL:
            way = towards if here > 0 else -towards
            ahead = self._ahead(t, way * self._step(t, way * here, slope))
            if ahead == t:
                return None  # the end of the contour
            there = self._along(ahead)
            if there * here <= 0:
                return self._between({t: here, ahead: there})
            slope = (there - here) / (ahead - t)
            if ahead in self._breaks and not self._cable.held.slides:
                slope = None
            t, here = ahead, there
        return t

    def _between(self, ends: dict[float, float]) -> float:
        """The root between two places, with the cable held there."""

        def along(t: float) -> float:
            force = ends[t] if t in ends else self._along(t)
            return 0.0 if abs(force) < _STILL else force

        begin, end = ends
        root = float(brentq(along, begin, end, xtol=_CLOSE))
        self._along(root)
        return root

    def _step(self, t: float, here: float, slope: float | None) -> float:
        """How far to go downhill: to where the secant says that it ends."""
        unit = 1 / max(1.0, float(self._line.at(np.array(t)).stretch))
        if slope is None:
            return _PROBE * unit
        rest = -here / slope if slope else np.inf
        return float(np.clip(rest, _CLOSE, _LONGEST * unit)) if rest > 0 else _LONGEST * unit

    def _ahead(self, t: float, step: float) -> float:
        """A step along the contour; that of a tip ends where the contour is not smooth."""
        to = t + step
        if not self._cable.held.slides:
            between = self._breaks[(self._breaks - t) * (self._breaks - to) < 0]
            if len(between):
                to = float(between[np.argmin(np.abs(between - t))])
        return float(np.clip(to, self._last, self._first))

    def _along(self, t: float) -> float:
        """The part of the object's force along the contour, if the cable is held there."""
        point = self._line.at(np.array(t))
        place = np.array([float(point.xi) - self._foot_x, float(point.eta)])
        self._clamp = self._cable.solve(place)
        along = np.array([np.cos(point.alpha), np.sin(point.alpha)])
        return float(-self._clamp[:2] @ along)

    def _outward(self, t: float) -> Floats:
        alpha = float(self._line.at(np.array(t)).alpha)
        return np.array([np.sin(alpha), -np.cos(alpha)])

    def _lies_alongside(self, t: float) -> bool:
        """Whether a cable that is held at its tip comes out of the object."""
        _, tangents = self._cable.ends()
        return float(tangents[-1] @ self._outward(t)) > _ALONG

    def _is_inside(self) -> bool:
        positions, tangents = self._cable.ends()
        # Middles of the cubic elements, by their ends.
        step = (tangents[:-1] - tangents[1:]) / (8 * (len(positions) - 1))
        middles = (positions[:-1] + positions[1:]) / 2 + step
        points = np.vstack([positions, middles]) + np.array([self._foot_x, 0.0])
        return bool((self._surface.outward(points)[0] < -_INSIDE).any())

    def _row(self, t: float) -> Row:
        self._found = t, self._cable.state(), False
        point, outward, clamp = self._line.at(np.array(t)), self._outward(t), self._clamp
        axis = np.array([float(point.xi), float(point.eta)])
        x, y = axis - self._radius * outward
        along = np.array([-outward[1], outward[0]])
        arm = (axis[0] - self._foot_x) * clamp[1] - axis[1] * clamp[0]
        _, tangents = self._cable.ends()
        return Row(
            float(clamp[0]),
            float(clamp[1]),
            float(clamp[2]),
            tip_angle=float(np.arctan2(tangents[-1, 1], tangents[-1, 0])),
            phase="tangent" if self._cable.held.slides else "tip",
            contact_angle=float(point.alpha),
            contact_arc_length=self._cable.held.arc_length,
            contact_x=float(x),
            contact_y=float(y),
            residual=max(abs(float(clamp[:2] @ along)), abs(float(clamp[2]) - arm)),
        )
