"""A contact that PyElastica has not: a line of straight elements against any convex contour.

The contour, moved out by the vibrissa's radius, is a chain of arcs. Every point of the line that is
in it is pushed out along the normal there, in proportion to its depth, and an element's nodes bear
what the lever says. So forces are the gradient of one energy, an integral of squared depths along
the line. They change smoothly wherever a contact goes: from an element to the next, around a
corner, or along an edge on which elements lie.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from analytic.problem.arrays import Floats
from analytic.problem.case import Case

STIFFNESS = 1e9
"""Of a contact, by its length along the line [EI/L^4]; see `_CAP`.

A load of 20 EI/L^2 on a corner of radius 5e-3 L is 3e-5 L deep. Chosen on the parabola, from 1e7 to
1e10, where readings no longer change.
"""
_CAP = 1e-3  # L; the tip is pushed as so long a line; a load of 20 is 2e-5 L deep
_POINTS = 4000  # of the contour; between them arcs: right to 1e-10 of the radius of curvature
_STRAIGHT = 1e-9  # rad; a piece of contour that turns less
_HALVINGS = 30  # of an element; a contact that is shorter is not deep
_FINE = 1e-13  # L; how deep a contact is at its ends
_ITERATIONS = 50  # most take five
# Gauss's rule is exact where depths are linear or quadratic along the line, their slopes as well.
_KNOTS, _WEIGHTS = np.polynomial.legendre.leggauss(4)


class Arcs(NamedTuple):
    """The line that the axis of the vibrissa feels, from left to right; L = 1."""

    # Shape (n + 1, 3); The tangents there, and where along them those ends are.
    tangents: Floats
    # Shape (n, 2); Centre, or where a straight piece begins.
    centres: Floats
    # Shape (n,); Negative for a straight piece.
    radii: Floats

    @classmethod
    def of(cls, case: Case) -> "Arcs":
        """What of the case's contour is within reach."""
        last, first = case.reach
        line = case.centreline
        marks = np.concatenate([np.linspace(last, first, _POINTS), line.breaks()])
        on = line.at(np.unique(marks[(marks >= last) & (marks <= first)]))
        ends = np.column_stack([on.xi, on.eta])
        along = np.column_stack([np.cos(on.alpha), np.sin(on.alpha)])
        outward = np.column_stack([along[:, 1], -along[:, 0]])
        turn, chord = np.diff(on.alpha), np.hypot(*np.diff(ends, axis=0).T)
        straight = turn < _STRAIGHT
        radii = np.where(straight, 0.0, chord / (2 * np.sin(np.where(straight, 1.0, turn) / 2)))
        inward = radii[:, None] * (outward[:-1] + outward[1:]) / 2
        centres = np.where(straight[:, None], ends[:-1], (ends[:-1] + ends[1:]) / 2 - inward)
        radii[straight] = -1.0
        tangents = np.column_stack([along, (ends * along).sum(axis=1)])
        return cls(tangents, centres, radii)


class Pressed(NamedTuple):
    """Points of every element where it is pushed, and then its end, if that is the tip."""

    # Shape (n_elements, n_points), each; How deep; where that is 0 the rest says nothing.
    depths: Floats
    # Where along the element, and the stiffness there [EI/L^3].
    places: Floats
    stiffness: Floats
    # The slope of the contour's normal by place [1/L].
    turns: Floats
    # Shape (2, n_elements, n_points); Whereto.
    normals: Floats

    @classmethod
    def none(cls, elements: int) -> "Pressed":
        """To be written by `press`."""
        shape = elements, len(_KNOTS) + 1
        return cls(*(np.zeros(shape) for _ in range(4)), np.zeros((2, *shape)))

    @property
    def forces(self) -> Floats:
        """Shape (2, n_elements, n_points)."""
        return np.asarray(self.stiffness * self.depths * self.normals)


@njit(cache=True)
def press(nodes: Floats, length: float, arcs: Arcs, pressed: Pressed) -> None:
    """Write where a line of nodes is in the contour; `length` is that of its elements at rest."""
    pressed.depths[:] = 0.0
    for i in range(len(pressed.depths)):
        x, y = nodes[0, i], nodes[1, i]
        run, rise = nodes[0, i + 1] - x, nodes[1, i + 1] - y
        first, last = _depth(x, y, arcs)[0], _depth(x + run, y + rise, arcs)[0]
        if first + last + np.hypot(run, rise) <= 0:  # too far away
            continue
        if first <= 0 and last <= 0 and not _dips(x, y, run, rise, arcs):
            continue
        begin = 0.0 if first > 0 else _end(x, y, run, rise, arcs)
        end = 1.0 if last > 0 else 1 - _end(x + run, y + rise, -run, -rise, arcs)
        for j in range(len(_KNOTS)):
            place = (begin + end + (end - begin) * _KNOTS[j]) / 2
            _write(pressed, i, j, place, x + place * run, y + place * rise, arcs)
            pressed.stiffness[i, j] = STIFFNESS * length * (end - begin) * _WEIGHTS[j] / 2
    _write(pressed, -1, -1, 1.0, nodes[0, -1], nodes[1, -1], arcs)
    pressed.stiffness[-1, -1] = STIFFNESS * _CAP


@njit(cache=True)
def _write(
    pressed: Pressed, i: int, j: int, place: float, x: float, y: float, arcs: Arcs
) -> None:  # fmt: skip
    """One point."""
    depth, right, up, turn = _depth(x, y, arcs)
    pressed.depths[i, j], pressed.places[i, j] = max(depth, 0.0), place
    pressed.normals[0, i, j], pressed.normals[1, i, j], pressed.turns[i, j] = right, up, turn


@njit(cache=True)
def _dips(x: float, y: float, run: float, rise: float, arcs: Arcs) -> bool:
    """Whether an element is in the contour whose ends are not: depth is concave along it."""
    low, high = 0.0, 1.0
    for _ in range(_HALVINGS):
        place = (low + high) / 2
        depth, right, up, _ = _depth(x + place * run, y + place * rise, arcs)
        if depth > 0:
            return True
        if right * run + up * rise < 0:
            low = place
        else:
            high = place
    return False


@njit(cache=True)
def _end(x: float, y: float, run: float, rise: float, arcs: Arcs) -> float:
    """Where along an element a contact begins, by Newton's method from outside."""
    place = 0.0
    for _ in range(_ITERATIONS):
        depth, right, up, _ = _depth(x + place * run, y + place * rise, arcs)
        slope = -(right * run + up * rise)
        if depth > -_FINE or slope <= 0:
            break
        place -= depth / slope
    return min(place, 1.0)


@njit(cache=True)
def _depth(x: float, y: float, arcs: Arcs) -> tuple[float, float, float, float]:
    """How deep a point is, the normal there, and by how much it turns when the point moves on."""
    arc, beyond = 0, len(arcs.radii)
    while beyond - arc > 1:
        middle = (arc + beyond) // 2
        cos, sin, along = arcs.tangents[middle]
        if cos * x + sin * y > along:
            arc = middle
        else:
            beyond = middle
    to_x, to_y, radius = x - arcs.centres[arc, 0], y - arcs.centres[arc, 1], arcs.radii[arc]
    if radius < 0:
        cos, sin, _ = arcs.tangents[arc]
        return -(to_x * sin - to_y * cos), sin, -cos, 0.0
    out = np.hypot(to_x, to_y)
    return radius - out, to_x / out, to_y / out, 1 / out


@njit(cache=True)
def push(outer: Floats, pressed: Pressed) -> None:
    """Add the forces to those on nodes."""
    depths, places, stiffness, _, normals = pressed
    for i in range(len(depths)):
        for j in range(depths.shape[1]):
            force = stiffness[i, j] * depths[i, j]
            if force > 0:
                for k in range(2):
                    outer[k, i] += (1 - places[i, j]) * force * normals[k, i, j]
                    outer[k, i + 1] += places[i, j] * force * normals[k, i, j]


@njit(cache=True)
def stiffen(slopes: Floats, pressed: Pressed) -> None:
    """Add the derivatives of those forces, by diagonals; each node but the first has three rows.

    The ends of a contact move, too, but nothing is deep there.
    """
    depths, places, stiffness, turns, normals = pressed
    reach = len(slopes) // 2
    outward, along = np.empty(4), np.empty(4)
    for i in range(len(depths)):
        for j in range(depths.shape[1]):
            if depths[i, j] <= 0:
                continue
            bent = turns[i, j] * depths[i, j]
            for k in range(4):
                lever = places[i, j] if k > 1 else 1 - places[i, j]
                outward[k] = lever * normals[k % 2, i, j]
                along[k] = lever * normals[1 - k % 2, i, j] * (2 * (k % 2) - 1)
            for k in range(0 if i else 2, 4):
                row = 3 * (i - 1 + k // 2) + k % 2
                for m in range(0 if i else 2, 4):
                    column = 3 * (i - 1 + m // 2) + m % 2
                    slope = bent * along[k] * along[m] - outward[k] * outward[m]
                    slopes[reach + row - column, column] += stiffness[i, j] * slope
