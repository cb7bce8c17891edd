"""Sweeps with friction, an elastic clamp and a natural curvature."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from analytic import (
    Beam,
    Case,
    Readings,
    Sweep,
    catenary,
    certify,
    circle,
    deflected_shapes,
    ellipse,
    find_events,
    named_case,
    parabola,
    polygon,
    solve_contact,
    solve_sweep,
    through_points,
    with_friction,
)
from analytic.problem.beam import Unloaded
from analytic.problem.reach import contact_range
from analytic.problem.rest import first_touch
from tests.analytic.solver.general.sound import READ, assert_sound

SQUARE = polygon([(-0.6, 0.45), (0.7, 0.4), (0.9, 1.5), (-0.5, 1.6)])
ROUND = np.linspace(0, 2 * np.pi, 17)[:-1]
SIXTEEN = polygon(np.column_stack([np.cos(ROUND), 1.4 + np.sin(ROUND)]))


def case_of(profile, natural=0.0, stiffness=math.inf, friction=0.0, stations=40, radius=0.005):
    beam = Beam(radius=radius, natural_curvature=natural)
    sweep = Sweep(stations)
    return Case(beam, profile, sweep, clamp_stiffness=stiffness, friction=friction)


@pytest.mark.parametrize("natural", [-0.8, pytest.param(0.0, marks=pytest.mark.slow), 0.6])
@pytest.mark.parametrize(("stiffness", "friction"), [(math.inf, 0.3), (2.0, 0.0), (8.0, 0.5)])
@pytest.mark.parametrize("profile", [named_case("catenary").profile, SQUARE, SIXTEEN])
def test_stations_balance(profile, natural, stiffness, friction):
    readings = assert_sound(case_of(profile, natural, stiffness, friction))
    assert (readings.table["status"] == "ok").sum() > 10
    assert readings.provenance["support"]["friction"] == friction


@pytest.mark.parametrize(("name", "stations"), [("catenary", 30), ("parabola", 60)])
def test_friction_of_either_sign(name, stations):
    """As the sweep has it, or by integration; near the parabola's fold is another state."""
    plain = replace(named_case(name), sweep=Sweep(stations))
    back = with_friction(plain, -0.2)
    both = (back.table["phase"] != "free") & (back.table["status"] == "ok")
    assert both.sum() > 20
    assert certify(back.with_friction(-0.2))[both].max(axis=None) < 1e-12
    found, swept = with_friction(plain, 0.5), solve_sweep(replace(plain, friction=0.5))
    both = (found.table["phase"] != "free") & (swept.table["status"] == "ok")
    for column in READ:
        assert np.abs((found.values(column) - swept.values(column))[both]).max() < 1e-11


@pytest.mark.parametrize("friction", [0.19, 0.197, 0.2])
def test_a_sweep_is_not_lost_where_the_curvature_jumps_and_no_kink_says_so(friction):
    """From radius 2 to 0.5: a sixth of the stations was lost when the clamp turned the curve."""
    case = named_case("two-circles")
    smooth = replace(through_points(case.profile.outline(*case.reach, 1000)), kinks=())
    found = solve_sweep(replace(case, profile=smooth, friction=friction))
    assert (found.table["status"] == "ok").mean() > 0.99


def test_phase_b_of_a_thin_vibrissa_shows_friction_and_clamp():
    """The first integral between clamp and contact, where only a thin one's is so simple."""
    rub = solve_sweep(case_of(named_case("catenary").profile, friction=0.3, radius=0.0)).table
    rub = rub[rub["phase"] == "tangent"]
    force = np.hypot(rub["force_x"], rub["force_y"])
    share = (rub["moment_z"] ** 2 - 2 * rub["force_y"]) / (2 * force)
    np.testing.assert_allclose(share, np.sin(np.arctan(0.3)), atol=1e-13)

    soft = solve_sweep(case_of(named_case("catenary").profile, stiffness=5.0, radius=0.0)).table
    soft = soft[soft["phase"] == "tangent"]
    turn = soft["moment_z"] / 5.0
    held = soft["force_y"] * np.cos(turn) + soft["force_x"] * np.sin(turn)
    np.testing.assert_allclose(soft["moment_z"] ** 2, 2 * held, rtol=1e-13)


@pytest.mark.parametrize(
    "beam", [Beam(), pytest.param(Beam(tip_radius=0.002), marks=pytest.mark.slow)]
)
def test_snap_off_is_a_fold_and_friction_delays_it(beam):
    profile = named_case("catenary").profile
    places = []
    for friction in (0.0, 0.1, 0.3):
        held = {"beam": beam, "clamp_stiffness": 6.0, "friction": friction}
        fold = find_events(profile, **held).snap_off
        beside = solve_contact(profile, fold.contact_angle + np.array([-1e-4, 0, 1e-4]), **held)
        rise = beside["foot_x"].to_numpy() - fold.foot_x
        assert rise[1] == pytest.approx(0, abs=1e-13)
        assert (rise[[0, 2]] > 1e-9).all() and (rise[[0, 2]] < 1e-6).all()
        places.append(fold.foot_x)
    assert places == sorted(places, reverse=True)


@pytest.mark.parametrize("natural", [-1.4, -0.7, 0.5])
@pytest.mark.parametrize("profile", [parabola(1.0, 0.4), parabola(30.0, 0.4), SQUARE])
def test_first_contact_is_that_of_two_rigid_bodies(natural, profile):
    reach = contact_range(profile)
    found = first_touch(profile, reach, Unloaded(natural))
    # Where the arc, moved to the right by more than its distance from the contour, ends touching.
    s = np.linspace(0, 1, 40001)[1:]
    x, y, _ = Unloaded(natural).at(s)
    grid = profile.at(np.linspace(profile.parameter(np.zeros(1))[0], reach[1], 20001))
    inside = (y > grid.eta.min()) & (y <= grid.eta.max())
    feet = np.interp(y[inside], grid.eta, grid.xi) - x[inside]
    # A corner lies between two samples of the arc, which are 2.5e-5 apart.
    assert found.p == pytest.approx(feet.max(), abs=2e-5)
    assert (found.excess < 0) == (s[inside][np.argmax(feet)] < 1 - 1e-3)


def test_tip_that_climbs_does_not_slide_on():
    """A vibrissa that is curved towards the object is straightened first, and its tip rises."""
    profile = named_case("parabola").profile
    smooth = solve_sweep(case_of(profile, 0.5, stations=200)).table
    rough = solve_sweep(case_of(profile, 0.5, friction=0.2, stations=200)).table
    climbs = np.diff(smooth["contact_angle"].dropna()) > 0
    assert 5 < climbs.sum() < 50
    sticks = (rough["status"] == "sticks").to_numpy()
    assert abs(sticks.sum() - climbs.sum()) < 10
    assert (np.diff(np.flatnonzero(sticks)) == 1).all()
    assert (rough["status"][~sticks] == "ok").all()


def test_file_keeps_what_the_certificate_needs(tmp_path):
    readings = solve_sweep(case_of(circle(1.0, lowest=(0, 0.4)), 0.3, 3.0, 0.2))
    back = Readings.read(readings.write(tmp_path / "sweep.parquet"))
    assert back.beam == readings.beam
    np.testing.assert_array_equal(certify(back), certify(readings))
    wrong = {"support": {"clamp_stiffness": 4.0, "friction": 0.2}}
    other = replace(back, provenance={**back.provenance, **wrong})
    assert certify(other).max(axis=None) > 1e-3


def test_curve_stays_on_its_branch_next_to_buckling():
    """A second branch passes by at a force of 12; steps that are too long continue on that one."""
    profile = named_case("two-circles").profile
    natural, stiffness = 0.4274252018552831, 1.1212627039210912
    beam = Beam(natural_curvature=natural)
    found = find_events(profile, beam, clamp_stiffness=stiffness)
    # In steps a fifth as long, shorter by far than the distance of the branches.
    assert found.snap_off.foot_x == pytest.approx(-1.121800216572, abs=1e-11)


def test_phase_b_of_a_vibrissa_that_touches_twice_is_that_of_both_contacts():
    """Its one contact does not go along the vibrissa: another one comes, and goes."""
    case = case_of(named_case("catenary").profile, natural=0.5, stations=60)
    events = find_events(case.profile, case.beam)
    assert events.phase_b_start == events.second_contact_start
    assert events.phase_b_end.foot_x == events.second_contact_end.foot_x
    assert {event.status for event in vars(events).values() if event} == {"ok"}
    found = solve_sweep(case).provenance["events"]
    for name in ("second_contact_start", "second_contact_end", "snap_off"):
        assert found[name] == pytest.approx(getattr(events, name).foot_x)
    bent_away = find_events(case.profile, Beam(natural_curvature=-0.5))
    assert bent_away.phase_b_start.status == "ok"


@pytest.mark.parametrize(
    ("case", "foot_x", "force_y"),
    [
        (case_of(named_case("shallow-catenary").profile, 0.5), 4.875, 1.869),
        (case_of(catenary(1.16196, -0.197741), 0.8405752616392289, 2.3098415819044864,
                 radius=0.009649280377654511), 0.4868, 0.3605),
    ],
    ids=["poked, the tip leans over", "poked on a soft clamp"],
)  # fmt: skip
def test_a_curve_next_to_buckling_is_not_left_for_the_other_one(case, foot_x, force_y):
    """Forces of MuJoCo's chain of 40, to its rms of 1e-3; the other curve has three to 20 times."""
    found = solve_sweep(replace(case, sweep=Sweep(2, stop=foot_x)), certified=True)
    assert found.values("force_y")[1] == pytest.approx(force_y, rel=2e-3)


def test_a_short_phase_b_between_two_points_of_the_path_is_seen():
    """Both points are of Phase A; between them the contact comes down from the tip by 1e-3 L."""
    object_ = ellipse((1.01661, 0.544838), (0.0, 0.557823))
    readings = solve_sweep(Case(profile=object_, sweep=Sweep(120), friction=0.3), certified=True)
    assert (readings.table["status"] == "ok").all()
    tangent = readings.table[readings.table["phase"] == "tangent"]
    assert len(tangent) > 10
    assert 0.99 < tangent["contact_arc_length"].min() < 0.9995


@pytest.mark.parametrize("friction", [0.1, 0.9])
def test_an_object_that_is_widest_where_the_tip_is(friction):
    """First contact is then along the contour, between both phases; nothing special comes of it."""
    sweep = Sweep(20, start=0.306, stop=-0.4)
    widest, lower = (
        solve_sweep(Case(profile=circle(0.3, (0.0, y)), sweep=sweep, friction=friction))
        for y in (0.7, 0.7 - 1e-9)
    )
    assert set(widest.table["status"]) == {"ok"}
    for name in READ:
        expected = lower.values(name)
        np.testing.assert_allclose(
            widest.values(name), expected, rtol=0, atol=1e-6 * np.abs(expected).max()
        )


@pytest.mark.slow
@pytest.mark.parametrize("corners", [16, 64])
def test_no_state_has_a_corner_beside_its_contact_in_it(corners):
    """Curved towards a polygon the vibrissa touches two corners on half of its way: 3e-4 L deep.

    Of few corners these are two contacts, of very many the states are refused.
    """
    angle = np.linspace(-np.pi / 2, np.pi / 2, corners)
    vertices = np.column_stack([0.6 * np.sin(angle), 1 - 0.6 * np.cos(angle)])
    beam = Beam(radius=0.0, natural_curvature=0.5)
    found = solve_sweep(Case(beam, polygon(vertices), Sweep(150)))
    table = found.table
    tangent = ((table["phase"] == "tangent") & (table["status"] == "ok")).to_numpy()
    assert tangent.sum() > 40
    twice = table.get("second_contact_x", table["contact_x"] * np.nan).notna()
    assert (twice if corners == 16 else table["status"] == "touches again").sum() > 20
    x, y = deflected_shapes(found)
    place, fine = np.linspace(0, 1, x.shape[1]), np.linspace(0, 1, 3000)
    begin, way = vertices[:-1], np.diff(vertices, axis=0)
    normal = np.column_stack([way[:, 1], -way[:, 0]]) / np.linalg.norm(way, axis=1)[:, None]
    for i in np.flatnonzero(tangent):
        # Two contacts are too close to each other for a spline.
        points = np.column_stack([x[i], y[i]])
        points = points if twice[i] else CubicSpline(place, points)(fine)
        outside = ((points[:, None] - begin) * normal).sum(axis=2).max(axis=1)
        assert outside.min() > -1e-6


def test_a_corner_beside_an_upright_vibrissa_is_touched_first():
    """Its slope angle is upright but for a rounding."""
    vertices = [(-0.4, 0.5), (-0.1, 0.3), (0.1, 0.3), (0.3, 0.4), (0.4, 0.5), (0.0, 3.3)]
    case = Case(Beam(), polygon(vertices), Sweep(40), friction=0.2)
    found = solve_sweep(case)
    assert found.provenance["events"]["first_contact"] == pytest.approx(0.405, abs=1e-12)
    touching = (found.table["status"] == "ok") & (found.table["phase"] != "free")
    assert touching.sum() > 20
    assert certify(found)[touching].max(axis=None) < 1e-11
