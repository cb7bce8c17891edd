"""A vibrissa with a weight at rest in MuJoCo, against the closed form."""

import pytest

from analytic import Beam, Case, Sweep, circle, solve_sweep
from analytic.problem.errors import InputError
from compare import compare
from mujoco_models import Motion, Settings, available_beams, simulate_motion, simulate_sweep
from mujoco_models.model.parts import parts_at_rest

ROUND = circle(1.0, lowest=(0.0, 0.4))
CASES = [
    Case(profile=ROUND, sweep=Sweep(60), weight=(0.0, -2.0)),
    Case(profile=ROUND, sweep=Sweep(60), weight=(0.0, 3.0)),
    Case(
        Beam(natural_curvature=-0.3),
        ROUND,
        Sweep(60),
        weight=(-0.7, -2.0),
        clamp_angle=0.1,
        clamp_stiffness=8.0,
    ),
]


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.weight}")
def test_against_the_closed_form(case):
    """Where the end hangs, a straight link leans from the object by up to its curvature times h/2.

    That is of first order in the links, and as large as the moment of what is beyond the contact.
    """
    exact, errors = solve_sweep(case), []
    for segments in (20, 40):
        readings = simulate_sweep(case, Settings(segments=segments))
        assert (readings.table["status"] == "ok").all()
        assert readings.snap_off == pytest.approx(exact.snap_off, abs=1e-3)
        found = compare(exact, readings)
        errors.append(max(x.rms for x in found.disagreement.values()))
    assert errors[1] < 2e-3
    assert errors[0] / errors[1] > 2


@pytest.mark.parametrize(
    "beam",
    [
        pytest.param(beam, marks=pytest.mark.slow if beam != "chain" else ())
        for beam in available_beams()
        if beam != "cable"
    ],
)
def test_what_touches_nothing_hangs_as_it_should(beam):
    case = Case(profile=ROUND, sweep=Sweep(2, start=3.0, stop=2.0), weight=(2.0, -6.0))
    exact = solve_sweep(case).table.iloc[0]
    off = []
    for segments in (20, 40):
        found = simulate_sweep(case, Settings(beam=beam, segments=segments)).table.iloc[0]
        assert found["status"] == "ok"
        assert found["force_x"] == pytest.approx(-2.0, abs=1e-9)
        assert found["force_y"] == pytest.approx(6.0, abs=1e-9)
        off.append(abs(found["tip_angle"] - exact["tip_angle"]))
    assert off[1] < 1e-2
    assert off[0] / off[1] > 3.5


def test_who_carries_no_weight_says_so():
    case = Case(profile=ROUND, sweep=Sweep(5), weight=(0.0, -1.0))
    with pytest.raises(InputError, match=r"weight_y = -1.*out of the plane"):
        simulate_sweep(case, Settings(planar=False))
    with pytest.raises(InputError, match=r"weight_y = -1.*drake"):
        parts_at_rest(case, Settings(), "drake")


@pytest.mark.slow
def test_in_motion_it_starts_at_rest_under_its_weight():
    case = Case(profile=ROUND, sweep=Sweep(30), weight=(0.3, -2.0))
    exact = solve_sweep(case)
    moved = simulate_motion(case, Motion(speed=0.01), Settings(segments=20))
    first = moved.table.iloc[0]
    assert first["kinetic_share"] < 1e-4
    assert first["tip_angle"] == pytest.approx(exact.table["tip_angle"].iloc[0], abs=1e-3)
    found = compare(exact, moved)
    assert max(x.rms for x in found.disagreement.values()) < 0.012  # of its speed, mostly
