"""A contact that PyElastica has not: a line of nodes against any convex contour, consistently.

The contour, moved out by the vibrissa's radius, is a chain of arcs. Every node in it is pushed
along its normal. An element that it is tangent to, deeper than its nodes are, is pushed there at
right angles, and both its nodes bear what the lever says; the deeper one is then spared. So force
and place come out of one energy, by the square of depths, and do not jump where a contact goes from
element to node.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from analytic.problem.arrays import Booleans, Floats
from analytic.problem.case import Case

_POINTS = 4000  # of the contour; between them arcs: right to 1e-10 of the radius of curvature
_DEEP = 2  # radii of the vibrissa
_STRAIGHT = 1e-9  # rad; a piece of contour that turns less


class Arcs(NamedTuple):
    """The line that the axis of the vibrissa feels, from left to right; L = 1."""

    # Shape (n + 1,); Slope angle at the ends of the arcs.
    alpha: Floats
    # Shape (n + 1, 3); The tangents there, and where along them those ends are.
    tangents: Floats
    # Shape (n, 2); Centre, or where a straight piece begins.
    centres: Floats
    # Shape (n,); Negative for a straight piece.
    radii: Floats
    # How deep a contact can be: what is deeper is past the object.
    deepest: float

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
        return cls(on.alpha, tangents, centres, radii, _DEEP * case.radius)


@njit(cache=True)
def touch(
    nodes: Floats, foot_x: float, arcs: Arcs, held: Booleans, depths: Floats, normals: Floats,
    places: Floats,
) -> None:  # fmt: skip
    """Write how deep elements and then nodes are, 0 for what is spared; whereto, and where.

    What is held counts even if it is outside: contacts that come and go between two iterations
    would never end.
    """
    count = nodes.shape[1] - 1
    depths[:] = -np.inf
    before, before_held = -1.0, False  # how deep the line of the element before is
    for i in range(count + 1):
        line, line_held = -1.0, False
        if i < count:
            line, along, right, up = _beside(nodes[:, i], nodes[:, i + 1], foot_x, arcs)
            line_held = held[i]
            if held[i] and not 0 < along < 1:
                held[count + i + (along > 0)] = True
            if 0 < along < 1 and (held[i] or line > 0) and line < arcs.deepest:
                depths[i], places[i] = line, along
                normals[0, i], normals[1, i] = right, up
        k = count + i
        if i > 0 and (max(line, before) > 0 or line_held or before_held or held[k]):
            depth, right, up = _depth(nodes[0, i] + foot_x, nodes[1, i], arcs)
            if (depth > 0 or held[k]) and depth < arcs.deepest:
                depths[k], normals[0, k], normals[1, k] = depth, right, up
        before, before_held = line, line_held
    for i in range(count):
        first, last = depths[count + i], depths[count + i + 1]
        if depths[i] <= max(first, last):
            depths[i] = -np.inf
        else:
            depths[count + i + (last > first)] = -np.inf
    for i in range(2 * count + 1):
        if depths[i] == -np.inf:
            depths[i] = 0.0


@njit(cache=True)
def _beside(
    begin: Floats, end: Floats, foot_x: float, arcs: Arcs
) -> tuple[float, float, float, float]:
    """How deep the line of an element is, where along it, and the normal there."""
    run, rise = end[0] - begin[0], end[1] - begin[1]
    length = np.hypot(run, rise)
    right, up = rise / length, -run / length
    slope = np.arctan2(rise, run)
    if slope < -np.pi / 2:
        slope += 2 * np.pi
    arc = min(max(np.searchsorted(arcs.alpha, slope) - 1, 0), len(arcs.radii) - 1)
    bulge = max(arcs.radii[arc], 0.0)
    to_x = arcs.centres[arc, 0] + bulge * right - begin[0] - foot_x
    to_y = arcs.centres[arc, 1] + bulge * up - begin[1]
    return to_x * right + to_y * up, (to_x * run + to_y * rise) / length**2, right, up


@njit(cache=True)
def _depth(x: float, y: float, arcs: Arcs) -> tuple[float, float, float]:
    """How deep a point is, and the normal there."""
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


@njit(cache=True)
def push(outer: Floats, forces: Floats, places: Floats) -> None:
    """Add the forces on elements, by the lever, and on nodes to those on nodes."""
    count = len(places)
    for k in range(2):
        for i in range(count):
            outer[k, i] += (1 - places[i]) * forces[k, i] + forces[k, count + i]
            outer[k, i + 1] += places[i] * forces[k, i]
        outer[k, count] += forces[k, 2 * count]
