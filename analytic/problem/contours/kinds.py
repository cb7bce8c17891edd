"""The kinds of contour by the names that case files give them, each with what makes it."""

from collections.abc import Callable, Mapping
from types import MappingProxyType

from analytic.problem.contours.contour import Contour
from analytic.problem.contours.families import catenary, circle, ellipse, parabola, two_circles
from analytic.problem.contours.mesh_section import mesh_section
from analytic.problem.contours.polygon import polygon
from analytic.problem.contours.through_points import through_points

CONTOURS: Mapping[str, Callable[..., Contour]] = MappingProxyType(
    {
        "catenary": catenary,
        "parabola": parabola,
        "circle": circle,
        "ellipse": ellipse,
        "two-circles": two_circles,
        "polygon": polygon,
        "points": through_points,
        "mesh": mesh_section,
    }
)
"""Factories of contours by kind."""
