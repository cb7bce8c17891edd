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

from analytic.numerics.arrays import Floats
from analytic.problem.case import Case

STIFFNESS = 1e9
"""Of a contact, by its length along the line [EI/L^4]; see `_CAP`.

A load of 20 EI/L^2 on a corner of radius 5e-3 L is 3e-5 L deep. On a parabola 1e7 would do; on a
hexagon 1e8 turns a force at a corner by 8e-3 rad.
"""
_CAP = 1e-3  # L; the tip is pushed as so long a line; a load of 20 is 2e-5 L deep
_POINTS = 4000  # of the contour; between them arcs: right to 1e-10 of the radius of curvature
_STRAIGHT = 1e-9  # rad; a piece of contour that turns less
_HALVINGS = 50  # of an element, to find where a contact ends, to rounding: derivatives need it
POINTS = 5  # of an element: those of Gauss's rule, and its end
_KNOTS, _WEIGHTS = np.polynomial.legendre.leggauss(POINTS - 1)


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


@njit(cache=True)
def press(nodes: Floats, length: float, arcs: Arcs, pressed: Floats) -> None:
    """Write what pushes points of elements, whose `length` is that at rest; the last is the tip.

    Shape (5, n_elements, `POINTS`): how deep they are, or 0; and if not 0 where along the element,
    the stiffness there [EI/L^3], and the normal.
    """
    pressed[0] = 0.0
    for i in range(pressed.shape[1]):
        begin, end = _span(nodes[:, i], nodes[:, i + 1], arcs)
        for j in range(len(_KNOTS) if end > begin else 0):
            place = (begin + end + (end - begin) * _KNOTS[j]) / 2
            depth, right, up = _depth(nodes[:, i], nodes[:, i + 1], place, arcs)
            stiffness = STIFFNESS * length * (end - begin) * _WEIGHTS[j] / 2
            pressed[:, i, j] = max(depth, 0.0), place, stiffness, right, up
    depth, right, up = _depth(nodes[:, -2], nodes[:, -1], 1.0, arcs)
    pressed[:, -1, -1] = max(depth, 0.0), 1.0, STIFFNESS * _CAP, right, up


@njit(cache=True)
def push(outer: Floats, pressed: Floats) -> None:
    for i in range(pressed.shape[1]):
        for depth, place, stiffness, right, up in pressed[:, i].T:
            if depth > 0:
                for k, force in enumerate((stiffness * depth * right, stiffness * depth * up)):
                    outer[k, i] += (1 - place) * force
                    outer[k, i + 1] += place * force


@njit(cache=True)
def _span(first: Floats, last: Floats, arcs: Arcs) -> tuple[float, float]:
    """Where along an element a contact begins and ends: depth is a concave function there."""
    run, rise = last[0] - first[0], last[1] - first[1]
    before, after = _depth(first, last, 0.0, arcs)[0], _depth(first, last, 1.0, arcs)[0]
    if before + after + np.hypot(run, rise) <= 0:  # too far away
        return 0.0, 0.0
    low, high, top = 0.0, 1.0, 1.0 if after > before else 0.0
    for _ in range(_HALVINGS if max(before, after) <= 0 else 0):
        top = (low + high) / 2
        depth, right, up = _depth(first, last, top, arcs)
        if depth > 0:
            break
        low, high = (top, high) if right * run + up * rise < 0 else (low, top)
    begin = 0.0 if before > 0 else _edge(first, last, 0.0, top, arcs)
    return begin, 1.0 if after > 0 else _edge(first, last, 1.0, top, arcs)


@njit(cache=True)
def _edge(first: Floats, last: Floats, outside: float, inside: float, arcs: Arcs) -> float:
    """Where along an element it is not deep any more; `inside` if it is not even there."""
    for _ in range(_HALVINGS):
        middle = (outside + inside) / 2
        deep = _depth(first, last, middle, arcs)[0] > 0
        outside, inside = (outside, middle) if deep else (middle, inside)
    return inside


@njit(cache=True)
def _depth(first: Floats, last: Floats, place: float, arcs: Arcs) -> tuple[float, float, float]:
    """How deep a point of an element is, and the normal there."""
    x = (1 - place) * first[0] + place * last[0]
    y = (1 - place) * first[1] + place * last[1]
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
        return -(to_x * sin - to_y * cos), sin, -cos
    out = np.hypot(to_x, to_y)
    return radius - out, to_x / out, to_y / out
