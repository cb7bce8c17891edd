"""A contact that PyElastica has not: a line of straight elements against any convex contour.

The contour, moved out by the vibrissa's radius, is a chain of arcs. Every point of the line in it
is pushed out along the normal there, in proportion to how deep it is, and an element's nodes bear
what the lever says. So forces are the gradient of one energy, the integral of squared depths along
the line. They change smoothly wherever a contact goes: from node to element, around a corner, or
along an edge on which whole elements lie.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from analytic.problem.arrays import Floats
from analytic.problem.case import Case

_POINTS = 4000  # of the contour; between them arcs: right to 1e-10 of the radius of curvature
_STRAIGHT = 1e-9  # rad; a piece of contour that turns less
_FINE = 1e-13  # L; of the ends of a contact
_HALVINGS = 30
_ITERATIONS = 50  # most take five
# Gauss's rule for a contact's length: exact for a circle, and for a node in an edge's either side.
CAP = 1e-3
_GAUSS = np.polynomial.legendre.leggauss(4)


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
    """Points of every element where it is pushed; depths are 0 where it is not."""

    # Shape (n_elements, n_points) each; how deep, where along the element, and for which share.
    depths: Floats
    places: Floats
    shares: Floats
    # Shape (2, n_elements, n_points); Whereto.
    normals: Floats
    # Shape (n_elements, n_points); By how much that turns along the contour.
    turns: Floats

    @classmethod
    def none(cls, elements: int) -> "Pressed":
        """To be written by `press`."""
        shape = elements, len(_GAUSS[0]) + 1
        each = [np.zeros(shape) for _ in range(3)]
        return cls(*each, np.zeros((2, *shape)), np.zeros(shape))


@njit(cache=True)
def press(nodes: Floats, foot_x: float, length: float, arcs: Arcs, pressed: Pressed) -> None:
    """Write where a line of nodes is in the contour."""
    depths, places, shares, normals, turns = pressed
    depths[:] = 0.0
    for i in range(len(depths)):
        x, y = nodes[0, i] + foot_x, nodes[1, i]
        run, rise = nodes[0, i + 1] - nodes[0, i], nodes[1, i + 1] - nodes[1, i]
        first, last = _depth(x, y, arcs)[0], _depth(x + run, y + rise, arcs)[0]
        if first + last + np.hypot(run, rise) <= 0:
            continue
        if first <= 0 and last <= 0 and not _dips(x, y, run, rise, arcs):
            continue
        begin = 0.0 if first > 0 else _end(x, y, run, rise, arcs)
        end = 1.0 if last > 0 else 1 - _end(x + run, y + rise, -run, -rise, arcs)
        for j in range(len(_GAUSS[0])):
            place = (begin + end + (end - begin) * _GAUSS[0][j]) / 2
            depth, right, up, turn = _depth(x + place * run, y + place * rise, arcs)
            depths[i, j], places[i, j] = max(depth, 0.0), place
            shares[i, j] = length * (end - begin) * _GAUSS[1][j] / 2
            normals[0, i, j], normals[1, i, j], turns[i, j] = right, up, turn
    depth, right, up, turn = _depth(nodes[0, -1] + foot_x, nodes[1, -1], arcs)
    depths[-1, -1], places[-1, -1], shares[-1, -1] = max(depth, 0.0), 1.0, CAP
    normals[0, -1, -1], normals[1, -1, -1], turns[-1, -1] = right, up, turn


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
def push(outer: Floats, stiffness: float, pressed: Pressed) -> None:
    """Add the forces on elements, by the lever, to those on nodes."""
    depths, places, shares, normals, turns = pressed
    for i in range(len(depths)):
        for j in range(depths.shape[1]):
            if depths[i, j] == 0:
                continue
            force = stiffness * shares[i, j] * depths[i, j]
            for k in range(2):
                outer[k, i] += (1 - places[i, j]) * force * normals[k, i, j]
                outer[k, i + 1] += places[i, j] * force * normals[k, i, j]


@njit(cache=True)
def stiffen(slopes: Floats, stiffness: float, pressed: Pressed) -> None:
    """Add the derivatives of those forces, by diagonals; where a contact ends it is not deep."""
    depths, places, shares, normals, turns = pressed
    reach = len(slopes) // 2
    block = np.empty((2, 2))
    for i in range(len(depths)):
        for j in range(depths.shape[1]):
            if depths[i, j] == 0:
                continue
            right, up = normals[0, i, j], normals[1, i, j]
            bent = turns[i, j] * depths[i, j]
            block[0, 0] = bent * up * up - right * right
            block[1, 1] = bent * right * right - up * up
            block[0, 1] = block[1, 0] = -(1 + bent) * right * up
            for a in range(2):
                for b in range(2):
                    lever = (places[i, j] if a else 1 - places[i, j]) * (
                        places[i, j] if b else 1 - places[i, j]
                    )
                    if i + a == 0 or i + b == 0:
                        continue
                    for k in range(2):
                        for m in range(2):
                            row, column = 3 * (i + a - 1) + k, 3 * (i + b - 1) + m
                            slopes[reach + row - column, column] += (
                                stiffness * shares[i, j] * lever * block[k, m]
                            )
