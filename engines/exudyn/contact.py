"""The cable past any smooth convex contour: a circle that follows the contact until it stays.

Exudyn's cable touches circles. Where it touches, a circle of curvature of the line that its axis
feels, the contour moved out by the vibrissa's radius, has the contour's point, normal and
curvature. Where that is comes from the contact's own state: the clamp's force is along the normal,
so it shows how far from the circle's point the contact is; the circle is placed there and the cable
solved again, until it stays. Where the contour is straight the circle is so large that it is flat.
"""

import numpy as np

from analytic.problem.arrays import Floats
from analytic.problem.case import Case
from engines.exudyn.cable import Cable
from engines.stations import Row

_FLAT = 100.0  # L; a circle as large as this is flat
_SAME = 1e-9  # rad; the circle stays
_TRIES = 40  # three are usual
_FREE = 1e-9  # EI/L^2; the load of what does not touch
_POINTS = 400  # of the contour, whose tangents show whether the cable has gone into the object
_INSIDE = 1e-4  # L; ten times the depth of a contact, and of a turn of the contour between these
_POKES = -0.05  # cosine; a tip that pokes at right angles is on neither side


class Contact:
    """A cable, a contour and where they touch; see `engines.stations.Rest`.

    Parameters
    ----------
    case : Case
        Of a sweep to the left.
    elements : int
        Of the cable.
    penalty : float
        Force over penetration [EI/L^3].
    """

    def __init__(self, case: Case, elements: int, penalty: float) -> None:
        self._cable = Cable(elements, penalty)
        self._line = case.centreline
        last, first = case.reach
        self._range = last, first
        self._radius = case.radius
        self._t = first
        self._found = self._t, self._cable.state()
        self._state = self._found[1]
        self._marks = np.linspace(last, first, _POINTS)
        marks = self._line.at(self._marks)
        self._points = np.column_stack([marks.xi, marks.eta])
        self._normals = np.column_stack([np.sin(marks.alpha), -np.cos(marks.alpha)])
        self._lowest = self._points[np.argmin(self._points[:, 1])]
        self._touches = self._found_touches = False

    def at(self, foot_x: float) -> Row | None:
        """By circle after circle."""
        self._cable.go_back(self._state)
        t = self._t if self._touches else self._ahead(foot_x)
        for _ in range(_TRIES):
            point = self._line.at(np.array(t))
            alpha, stretch = float(point.alpha), float(point.stretch)
            radius = min(_FLAT, stretch / max(float(point.turning), stretch / _FLAT))
            inward = np.array([-np.sin(alpha), np.cos(alpha)])
            centre = np.array([point.xi - foot_x, point.eta]) + radius * inward
            clamp = self._cable.solve(centre, radius)
            if clamp is None:
                return None
            self._found_touches = bool(np.hypot(clamp[0], clamp[1]) > _FREE)
            if not self._found_touches:
                self._found = t, self._cable.state()
                return Row(tip_angle=self._tip_angle()) if self._is_ahead(foot_x) else None
            turned = float(np.arctan2(-clamp[0], clamp[1])) - alpha
            if abs(turned) < _SAME * max(1.0, radius):
                return None if self._is_inside(foot_x) else self._row(foot_x, t, clamp, centre)
            t = float(np.clip(self._moved(t, radius * turned / stretch), *self._range))
        return None

    def accept(self) -> None:
        """Go on from the circle and the cable of the last station."""
        self._t, self._state = self._found
        self._touches = self._found_touches

    def _moved(self, t: float, by: float) -> float:
        """Along the contour, but not past a place where it is not smooth: there is one more try."""
        breaks = self._line.breaks()
        ahead = breaks[(breaks - t) * np.sign(by) > 1e-12]
        stop = ahead[np.argmin(np.abs(ahead - t))] if len(ahead) else t + by
        beyond = float(stop + np.sign(by) * 1e-9)
        return beyond if abs(by) > abs(beyond - t) else t + by

    def _ahead(self, foot_x: float) -> float:
        """Where the contour is nearest to the free, upright cable."""
        x, y = self._points.T
        distance = np.hypot(x - foot_x, np.maximum(y - 1, 0))
        return float(self._marks[np.argmin(distance)])

    def _is_inside(self, foot_x: float) -> bool:
        """Whether a part of the cable is in the object: the circle is not all of it."""
        positions, tangents = self._cable.ends()
        # Middles of the cubic elements, by their ends.
        step = (tangents[:-1] - tangents[1:]) / (8 * (len(positions) - 1))
        middles = (positions[:-1] + positions[1:]) / 2 + step
        points = np.vstack([positions, middles]) + np.array([foot_x, 0.0])
        offset = points @ self._normals.T - (self._points * self._normals).sum(axis=1)
        return bool((offset.max(axis=1) < -_INSIDE).any())

    def _is_ahead(self, foot_x: float) -> bool:
        """Whether a free cable has the object on its left, or over it."""
        x, y = self._lowest
        return not self._is_inside(foot_x) and (foot_x > x or y > 1)

    def _tip_angle(self) -> float:
        _, tangents = self._cable.ends()
        return float(np.arctan2(tangents[-1, 1], tangents[-1, 0]))

    def _row(self, foot_x: float, t: float, clamp: Floats, centre: Floats) -> Row | None:
        point = self._line.at(np.array(t))
        alpha = float(point.alpha)
        axis = np.array([point.xi - foot_x, point.eta])
        normal = np.array([np.sin(alpha), -np.cos(alpha)])
        positions, tangents = self._cable.ends()
        # The perpendicular from the circle's centre would fall beyond the tip.
        beyond = float((centre - positions[-1]) @ tangents[-1]) > 0
        s = 1.0 if beyond else self._arc_length(axis, positions, tangents)
        tangent = tangents[min(int(s * (len(tangents) - 1)), len(tangents) - 1)]
        if normal @ [tangent[1], -tangent[0]] < _POKES * np.hypot(*tangent):
            return None  # with its other side: the object was let through
        self._found = t, self._cable.state()
        x, y = axis - self._radius * normal
        along = np.array([normal[1], -normal[0]])
        arm = axis[0] * clamp[1] - axis[1] * clamp[0]
        unbalanced = max(abs(float(clamp[:2] @ along)), abs(float(clamp[2]) - arm))
        return Row(
            float(clamp[0]),
            float(clamp[1]),
            float(clamp[2]),
            tip_angle=self._tip_angle(),
            phase="tip" if beyond else "tangent",
            contact_angle=alpha,
            contact_arc_length=s,
            contact_x=float(x) + foot_x,
            contact_y=float(y),
            residual=unbalanced,
        )

    def _arc_length(self, axis: Floats, positions: Floats, tangents: Floats) -> float:
        """Where along the cable that place is: the foot of its perpendicular on an element."""
        along = ((axis - positions) * tangents).sum(axis=1)
        element = int(np.clip(np.searchsorted(-along, 0.0) - 1, 0, len(along) - 2))
        share = along[element] / (along[element] - along[element + 1])
        return float((element + share) / (len(along) - 1))
