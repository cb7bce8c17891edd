"""Contacts at given points of a contour."""

import pandas as pd
import pytest

from analytic import Beam, Sweep, catenary, parabola, solve_contact, solve_sweep
from analytic.problem.case import Case

COLUMNS = ["foot_x", "force_x", "force_y", "moment_z", "contact_arc_length", "tip_angle"]


@pytest.mark.parametrize(
    ("profile", "beam", "held"),
    [
        (
            parabola(0.7, 0.4),
            Beam(natural_curvature=-0.4),
            {"clamp_stiffness": 6.0, "friction": 0.2},
        ),
        (catenary(0.5, -0.8), Beam(), {"clamp_angle": 0.25, "friction": 0.1}),
        (parabola(0.5, 0.5), Beam(), {"weight": (0.5, -1.0)}),
    ],
)
def test_contacts_are_the_stations_of_the_sweep(profile, beam, held):
    swept = solve_sweep(Case(beam, profile, Sweep(30), **held)).table
    swept = swept[swept["phase"] != "free"].reset_index(drop=True)
    found = solve_contact(profile, swept["contact_angle"], beam, **held)
    # Next to first contact the angle hardly determines the force.
    pd.testing.assert_frame_equal(found[COLUMNS], swept[COLUMNS], rtol=0, atol=1e-9)
    assert list(found["phase"]) == list(swept["phase"])


def test_vibrissa_out_of_reach_has_no_readings():
    found = solve_contact(parabola(0.5, 0.5), [-1.4, 0.1, 1.4], friction=0.3)
    assert list(found["status"]) == ["unreachable", "ok", "unreachable"]
    assert found.loc[[0, 2], ["force_x", "force_y", "moment_z"]].isna().all(axis=None)
