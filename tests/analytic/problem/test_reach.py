"""Where an object can be touched no more, by plane geometry."""

import numpy as np
import pytest

from analytic import Beam, Case, circle, polygon
from analytic.problem.reach import out_of_reach


@pytest.mark.parametrize("radius", [0.0, 0.01])
def test_circle_is_out_of_reach_where_its_centre_is_a_radius_farther_away(radius):
    case = Case(Beam(radius=radius), circle(0.3, (0.2, 0.6)))
    expected = 0.2 - np.sqrt((1 + 0.3 + radius) ** 2 - 0.9**2)
    assert out_of_reach(case.centreline, *case.reach) == pytest.approx(expected, abs=1e-13)


@pytest.mark.parametrize("radius", [0.0, 0.01])
def test_corner_is_out_of_reach_where_it_is_a_length_away(radius):
    body = polygon([(0.3, 2.0), (0.5, 0.7), (0.8, 0.75), (0.9, 2.0)])
    case = Case(Beam(radius=radius), body)
    expected = 0.5 - np.sqrt((1 + radius) ** 2 - 0.7**2)
    assert out_of_reach(case.centreline, *case.reach) == pytest.approx(expected, abs=1e-12)
