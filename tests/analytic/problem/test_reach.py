"""Where an object can be touched no more, by plane geometry."""

import numpy as np
import pytest

from analytic import Beam, Case, circle, polygon
from analytic.problem.reach import out_of_reach


@pytest.mark.parametrize("radius", [0.0, 0.01])
@pytest.mark.parametrize(
    ("body", "centre", "size"),
    [
        (circle(0.3, (0.2, 0.6)), (0.2, 0.9), 0.3),
        (polygon([(0.3, 2.0), (0.5, 0.7), (0.8, 0.75), (0.9, 2.0)]), (0.5, 0.7), 0.0),
    ],
)
def test_a_body_is_out_of_reach_where_it_is_a_length_away(body, centre, size, radius):
    case = Case(Beam(radius=radius), body)
    expected = centre[0] - np.sqrt((1 + size + radius) ** 2 - centre[1] ** 2)
    assert out_of_reach(case.centreline, *case.reach) == pytest.approx(expected, abs=1e-12)
