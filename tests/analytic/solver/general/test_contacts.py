"""Contacts at given points of a contour: many at once, and those with more than one state."""

import numpy as np
import pandas as pd
import pytest

from analytic import Beam, Sweep, catenary, parabola, polygon, solve_contact, solve_sweep
from analytic.problem.case import Case

SQUARE = polygon([(-0.6, 0.45), (0.7, 0.4), (0.9, 1.5), (-0.5, 1.6)])
COLUMNS = ["foot_x", "force_x", "force_y", "moment_z", "contact_arc_length", "tip_angle"]


@pytest.mark.parametrize(
    ("natural", "held"),
    [(0.4, {}), (-0.7, {"friction": -0.3}), (0.0, {"clamp_stiffness": 2.0, "friction": 0.2})],
)
@pytest.mark.parametrize("profile", [catenary(0.5, -0.8), SQUARE])
def test_many_contacts_are_those_solved_one_by_one(profile, natural, held):
    beam = Beam(natural_curvature=natural)
    angles = np.random.default_rng(3).permutation(np.linspace(-0.5, 0.9, 2500))
    many = solve_contact(profile, angles, beam, **held)
    few = solve_contact(profile, angles[:300], beam, **held)
    assert list(many["status"][:300]) == list(few["status"])
    assert (few["status"] == "ok").sum() > 50
    # 1e-11: some 1e-16 of misses, at forces of up to 20 and next to the end of reach.
    pd.testing.assert_frame_equal(many[COLUMNS][:300], few[COLUMNS], rtol=0, atol=1e-11)


def test_contacts_are_the_stations_of_the_sweep():
    beam, held = Beam(natural_curvature=-0.4), {"clamp_stiffness": 6.0, "friction": 0.2}
    swept = solve_sweep(Case(beam, parabola(0.7, 0.4), Sweep(60), **held)).table
    swept = swept[swept["phase"] != "free"].reset_index(drop=True)
    found = solve_contact(parabola(0.7, 0.4), swept["contact_angle"], beam, **held)
    # Next to first contact the angle hardly determines the force.
    pd.testing.assert_frame_equal(found[COLUMNS], swept[COLUMNS], rtol=0, atol=1e-9)
    assert list(found["phase"]) == list(swept["phase"])


def test_vibrissa_out_of_reach_has_no_readings():
    found = solve_contact(parabola(0.5, 0.5), [-1.4, 0.1, 1.4], friction=0.3)
    assert list(found["status"]) == ["unreachable", "ok", "unreachable"]
    assert found.loc[[0, 2], ["force_x", "force_y", "moment_z"]].isna().all(axis=None)
