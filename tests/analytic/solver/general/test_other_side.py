"""A vibrissa that is curved towards the object and lies down on its other side."""

import numpy as np
import pytest

from analytic import Beam, Case, Sweep, catenary, certify, find_events, solve_sweep
from analytic.problem.clamp_path import along_x
from analytic.problem.support import Support
from analytic.solver.general.balance import states_at
from analytic.solver.general.states import Vibrissa
from analytic.solver.general.stations import solve_near
from tests.analytic.solver.general.sound import EXACT, FORCES, PLACES, assert_confirmed, rows

ROWS = rows("beyond_other_side")
PROFILE = catenary(0.5, -0.8)
SWEPT = [(0.95, 0.0, 0.0), (1.0, 0.0, 0.0), (1.1, 0.1, 0.01)]  # curvature, friction, radius


def rows_of(natural, friction, radius):
    same = ROWS["natural_curvature"].eq(natural) & ROWS["friction"].eq(friction)
    return ROWS[same & ROWS["radius"].eq(radius)]


def beam_of(natural, radius):
    return Beam(radius=radius, natural_curvature=natural)


@pytest.mark.parametrize(
    ("natural", "friction", "radius"),
    [SWEPT[0], *(pytest.param(*one, marks=pytest.mark.slow) for one in SWEPT[1:])],
)
def test_references_of_sweeps(natural, friction, radius):
    rows = rows_of(natural, friction, radius)
    beam = beam_of(natural, radius)
    events = find_events(PROFILE, beam, friction=friction)
    named = rows.dropna(subset="event").set_index("event")["foot_x"]
    found = {
        "first contact": events.first_contact,
        "tip lies down on its other side": events.back_start,
        "back to the tip": events.back_end,
        "release (force falls to zero)": events.snap_off,
    }
    for event, place in named.items():
        assert found[event].foot_x == pytest.approx(place, rel=1e-11)
    assert (found["back to the tip"] is None) == ("back to the tip" not in named)
    for _, row in rows[rows["event"].isna()].iterrows():
        sweep = Sweep(2, stop=row["foot_x"])
        readings = solve_sweep(Case(beam, PROFILE, sweep, friction=friction))
        last = readings.table.iloc[-1]
        assert last["status"] == "ok"
        assert last["phase"] == row["state"].split()[0]
        for reference, column in (FORCES | PLACES).items():
            np.testing.assert_allclose(last[column], row[reference], **EXACT)
        turned = last["tip_angle"] - natural * (1 - last["contact_arc_length"])
        np.testing.assert_allclose(turned, row["phi_contact"], **EXACT)


def test_references_of_equilibria_with_friction():
    rows = rows_of(1.0, 0.2, 0.0)
    vibrissa = Vibrissa.of(beam_of(1.0, 0.0), Support(friction=0.2))
    start = rows[["alpha", "f", "s1"]].to_numpy(float)
    start[:, 2] = np.pi + 1 - start[:, 2]
    pose = along_x(0.0).at(rows["foot_x"].to_numpy())
    z, balanced = solve_near(PROFILE, vibrissa, pose, start + 1e-3)
    assert balanced.all()
    found = states_at(PROFILE, z, vibrissa)
    assert (found.side == 1).all()
    np.testing.assert_allclose(found.moment, rows["M_Az"], **EXACT)
    np.testing.assert_allclose(found.arc_length, rows["s1"], **EXACT)
    np.testing.assert_allclose(found.force, rows["f"], **EXACT)


@pytest.mark.parametrize(("natural", "friction", "radius"), SWEPT)
def test_whole_sweeps_balance_and_show_the_contact(natural, friction, radius):
    case = Case(beam_of(natural, radius), PROFILE, Sweep(60), friction=friction)
    readings, seen, _ = assert_confirmed(case, integrated=1e-12, mirrored=1e-13, seen=1e-12)
    assert (readings.table["status"] == "ok").all()
    assert list(seen["phase"]) == list(readings.table["phase"])


def test_a_cone_lies_down_too():
    """Its axis leans the other way there."""
    beam = Beam(radius=0.02, tip_radius=0.01, natural_curvature=1.1)
    readings = solve_sweep(Case(beam, PROFILE, Sweep(60)))
    assert readings.provenance["events"]["back_start"] is not None
    assert (readings.table["status"] == "ok").all()
    assert certify(readings).max(axis=None) < 1e-10
