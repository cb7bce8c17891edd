"""Vibrissae whose rigidity, radius or natural curvature vary, by collocation."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from analytic import (
    Beam,
    Case,
    Sweep,
    catenary,
    certify,
    circle,
    ellipse,
    find_events,
    named_case,
    parabola,
    polygon,
    solve_sweep,
)
from analytic.problem.beam import Unloaded
from analytic.problem.rest import first_touch
from analytic.problem.rod import RodProperties
from analytic.problem.support import Support
from analytic.solver.general.clearance import is_rest_clear
from analytic.solver.general.columns import Units
from analytic.solver.general.path import follow
from analytic.solver.general.span import march
from analytic.solver.general.states import Vibrissa
from analytic.solver.general.states import states as states_of
from analytic.solver.general.stations import solve_places
from analytic.solver.residuals import residuals
from tests.analytic.solver.general.sound import READ, assert_sound

SQUARE = polygon([(-0.6, 0.45), (0.7, 0.4), (0.9, 1.5), (-0.5, 1.6)])
OBJECT = circle(1.0, lowest=(0, 0.4))


def cone(ratio):
    return lambda s: (1 - (1 - ratio) * s) ** 4


def bow(strength):
    return lambda s: strength * s


def case_of(beam, profile=OBJECT, stations=40, **held):
    return Case(beam, profile, Sweep(stations), **held)


BEAMS = {
    "taper 0.4": Beam(tip_radius=0.002),
    "taper 0.1": Beam(tip_radius=0.0005),
    "taper 0.05": Beam(tip_radius=0.00025),
    "graded": Beam(flexural_rigidity=[(0, 1), (0.2, 0.9), (0.5, 0.6), (0.8, 0.4), (1, 0.1)]),
    "two wires": Beam(flexural_rigidity=lambda s: np.where(s < 0.4, 1.0, 0.3)),
    "bow": Beam(natural_curvature=bow(-0.8)),
    "S": Beam(natural_curvature=lambda s: np.cos(4 * s) / 2),
    "cone and bow": Beam(tip_radius=0.002, natural_curvature=bow(-0.5)),
}


@pytest.mark.parametrize("i", range(len(BEAMS)))
def test_stations_balance(i):
    """Each of them past one of three bodies."""
    body = [named_case("parabola").profile, OBJECT, SQUARE][i % 3]
    case = case_of([*BEAMS.values()][i], body, clamp_stiffness=8.0, friction=0.2)
    assert (assert_sound(case).table["status"] == "ok").sum() > 10


@pytest.mark.slow
@settings(max_examples=20, deadline=None)
@given(
    varies=st.booleans(),
    ratio=st.floats(0.05, 1),
    grade=st.floats(-0.8, 0.8),
    natural=st.tuples(st.floats(-0.6, 0.4), st.floats(-0.6, 0.4)),
    compliance=st.just(0) | st.floats(1e-149, 1),
    friction=st.floats(0, 0.7),
    height=st.floats(0.25, 0.6),
    size=st.floats(0.8, 2),
    kind=st.sampled_from(["circle", "parabola", "catenary", "ellipse", "square"]),
)
def test_random_vibrissae_balance(
    varies, ratio, grade, natural, compliance, friction, height, size, kind
):
    profile = {
        "circle": lambda: circle(size, lowest=(0.1, height)),
        "parabola": lambda: parabola(1 / size, height),
        "catenary": lambda: catenary(1 / size, height - 1),
        "ellipse": lambda: ellipse(semi_axes=(size, 1.2), lowest=(0.0, height)),
        "square": lambda: SQUARE,
    }[kind]()
    beam = Beam(natural_curvature=natural[0] + natural[1])
    if varies:
        beam = Beam(
            flexural_rigidity=lambda s: (1 - (1 - ratio) * s) ** 4 * (1 + grade * s),
            natural_curvature=lambda s: natural[0] + natural[1] * s**2,
            tip_radius=0.005 * ratio,
        )
    stiffness = 1 / compliance if compliance else math.inf
    assert_sound(case_of(beam, profile, clamp_stiffness=stiffness, friction=friction))


@settings(max_examples=25, deadline=None)
@given(
    force=st.floats(0, 15),
    length=st.floats(0.1, 1),
    theta=st.floats(-0.5, 2),
    m=st.floats(-1, 1),
    ratio=st.floats(0.3, 1),
    wave=st.floats(0, 6),
)
def test_march_is_the_integral(force, length, theta, m, ratio, wave):
    """Of the pendulum's equation, by the Dormand-Prince method of order 8."""
    beam = Beam(flexural_rigidity=cone(ratio), natural_curvature=lambda s: np.cos(wave * s) / 2)
    given_ = (np.array([x]) for x in (theta, m, force, length))
    found = march(RodProperties.of(beam, beam.unloaded), *given_)

    def rate(s, state):
        slope, moment = state[:2]
        kappa = np.cos(wave * s) / 2 + moment / cone(ratio)(s)
        return [kappa, force * np.cos(slope), -np.cos(slope), -np.sin(slope)]

    end = solve_ivp(rate, (length, 0), [theta, m, 0, 0], method="DOP853", rtol=3e-14, atol=1e-14)
    # DOP853 errs by 1e-13 times how much an error at the contact grows: by up to e^5 here.
    np.testing.assert_allclose([x[0] for x in found[:4]], end.y[:, -1], rtol=1e-11, atol=2e-11)


@pytest.mark.parametrize("name", ["catenary", "two-circles", "tip-only"])
def test_collocation_of_a_uniform_vibrissa_is_the_closed_form(name):
    plain, case = solve_sweep(named_case(name)), named_case(name)
    rod = RodProperties(Unloaded(0.0, case.radius, case.radius), 1.0)
    vibrissa = Vibrissa(radius=case.radius, rod=rod)
    touch = first_touch(case.centreline, case.reach, Unloaded())
    path = follow(case.centreline, vibrissa, touch, case.reach, case.poses)
    for event, i in path.events().items():
        if event != "contact_length_minimum":
            found = None if i is None else path.p[i]
            assert found == pytest.approx(plain.provenance["events"][event], abs=1e-13)
    held = (plain.table["phase"] != "free").to_numpy()
    z, found = solve_places(path, case.poses, case.foot_x[held])
    states = states_of(case.centreline.at(z[:, 0]), z[:, 1], z[:, 2], vibrissa)
    assert found.all()
    # 2e-13: each is exact to a few roundings of forces of up to 20.
    np.testing.assert_allclose(states.moment, plain.values("moment_z")[held], atol=2e-13)
    force = np.hypot(plain.values("force_x"), plain.values("force_y"))[held]
    np.testing.assert_allclose(states.force, force, atol=2e-13)
    np.testing.assert_array_equal(states.tangent, (plain.table["phase"] == "tangent")[held])


@pytest.mark.parametrize(
    "varied",
    [
        lambda little: {"beam": Beam(tip_radius=0.005 * (1 - little))},
        pytest.param(
            lambda little: {"beam": Beam(flexural_rigidity=lambda s: 1 + little * s)},
            marks=pytest.mark.slow,
        ),
        pytest.param(
            lambda little: {"beam": Beam(natural_curvature=lambda s: little * s)},
            marks=pytest.mark.slow,
        ),
        lambda little: {"beam": Beam(natural_curvature=little)},
        lambda little: {"clamp_stiffness": 1 / little},
        lambda little: {"friction": little},
    ],
)
def test_limit_is_smooth(varied):
    """Readings change in proportion to a little of what the paper's vibrissa has not."""
    sweep, profile = Sweep(100, start=2.5, stop=-2.5), named_case("catenary").profile
    reference = solve_sweep(Case(profile=profile, sweep=sweep))

    def change(little):
        found = solve_sweep(Case(profile=profile, sweep=sweep, **varied(little)))
        both = (found.table["phase"] == reference.table["phase"]) & (reference.values("foot_x") > 0)
        return np.stack([(found.values(n) - reference.values(n))[both] for n in READ])

    once, twice = change(1e-6), change(2e-6)
    assert 1e-7 < np.abs(once).max() < 1e-3
    # The next order is smaller by 1e-6 times how strongly the first one acts, where it does most.
    np.testing.assert_allclose(twice, 2 * once, atol=1e-4 * np.abs(once).max())


@pytest.mark.parametrize("ratio", [0.7, 0.1, 0.05, 1e-3])
@pytest.mark.parametrize("a", [0.3, 0.9, 1.0])
def test_small_deflection_of_a_cone(a, ratio):
    """Of one that ends in a point w(a) = Q a^3/(3 (1 - a)); q a stands for a if it is cut off."""
    q = 1 - ratio
    force = 1e-5 * (1 - q * a) ** 2  # turns the contact by 1e-5 rad at most
    slope = force * a**2 * (3 - 2 * q * a) / (6 * (1 - q * a) ** 2)
    given_ = (np.array([x]) for x in (-slope, 0.0, force, a))
    found = march(RodProperties(Unloaded(), ratio), *given_)
    # 1e-9: what is left out goes with the square of the slope.
    assert -found.across[0] == pytest.approx(force * a**3 / (3 * (1 - q * a)), rel=1e-9)
    assert found.theta[0] == pytest.approx(0, abs=1e-9 * slope)
    assert found.m[0] == pytest.approx(-force * a, rel=1e-9)


def test_natural_bow_that_a_couple_straightens():
    """Under one couple a vibrissa is straight whose natural curvature goes with its compliance."""
    beam = Beam(flexural_rigidity=cone(0.5), natural_curvature=lambda s: 0.05 / cone(0.5)(s))
    lengths = np.linspace(0.1, 1.0, 7)
    slope, none = np.full(7, 0.4), np.zeros(7)
    found = march(RodProperties.of(beam, beam.unloaded), slope, np.full(7, -0.05), none, lengths)
    np.testing.assert_allclose(found.along, lengths * np.cos(0.4), rtol=1e-14)
    np.testing.assert_allclose(found.across, lengths * np.sin(0.4), rtol=1e-14)


def test_cone_touches_with_its_surface():
    """The spheres of the cone's radius about its axis touch the object once, and lie below it."""
    beam = Beam(radius=0.02, tip_radius=0.004)
    table = assert_sound(case_of(beam, stations=30)).table
    for row in table[table["phase"] != "free"].to_dict("records"):
        length, alpha = row["contact_arc_length"], row["contact_angle"]
        s, x, y = shape_of(beam, row)
        gap = np.hypot(x, y - 1.4) - 1.0 - beam.radius_at(s)
        assert gap.min() > -1e-9 and gap[-1] == pytest.approx(0, abs=1e-9)
        normal = beam.radius_at(length) * np.array([np.sin(alpha), -np.cos(alpha)])
        to_axis = [x[-1] - row["contact_x"], y[-1] - row["contact_y"]]
        np.testing.assert_allclose(to_axis, normal, atol=1e-9)


def shape_of(beam, row):
    """The loaded span of a straight beam, integrated from the clamp's readings."""

    def rate(s, z):
        cos, sin = np.cos(z[2]), np.sin(z[2])
        return [cos, sin, z[3] / beam.rigidity_at(s), row["force_y"] * cos - row["force_x"] * sin]

    s = np.linspace(0, row["contact_arc_length"], 2001)
    start = [row["foot_x"], 0, np.pi / 2, -row["moment_z"]]
    end = solve_ivp(rate, (0, s[-1]), start, t_eval=s, rtol=1e-11, atol=1e-12)
    return s, *end.y[:2]


@pytest.mark.parametrize("name", BEAMS)
def test_first_contact_is_that_of_two_rigid_bodies(name):
    beam = BEAMS[name]
    for profile in (OBJECT, parabola(1.0, 0.4), SQUARE):
        case = case_of(beam, profile)
        touch = first_touch(case.centreline, case.reach, beam.unloaded)
        vibrissa = Vibrissa.of(beam, Support())
        beside = touch.p + np.array([-1e-2, 1e-6])
        # Its 16 places may lie beside the contact, and one that goes along enters by a square.
        clear = is_rest_clear(case.centreline, vibrissa, case.poses.at(beside))
        assert list(clear) == [False, True]


@pytest.mark.slow
def test_curve_ends_where_a_flexible_tip_would_wind_up():
    """Past the snap-off the tip of a sharp cone turns on, into the body: thousands of states."""
    beam = Beam(radius=0.003, tip_radius=0.0003, natural_curvature=-0.4)
    case = case_of(
        beam, named_case("catenary").profile, stations=200, friction=0.3, clamp_stiffness=8.0
    )
    contour, vibrissa = case.centreline, Vibrissa.of(beam, Support(8.0, 0.3))
    touch = first_touch(contour, case.reach, vibrissa.unloaded)
    path = follow(contour, vibrissa, touch, case.reach, case.poses)
    assert path.complete
    assert len(path.z) < 100
    assert (assert_sound(case).table["status"] == "ok").all()


def test_other_units():
    case = case_of(BEAMS["cone and bow"], clamp_stiffness=4.0, friction=0.2)
    metres = Beam(50.0, 2.0, 0.25, tip_radius=0.1, natural_curvature=lambda s: -0.5 / 50 * s / 50)
    stiffness = 4.0 * metres.moment_unit
    body = OBJECT.scaled(50.0)
    other = solve_sweep(case_of(metres, body, clamp_stiffness=stiffness, friction=0.2))
    moment = other.values("moment_z") / metres.moment_unit
    np.testing.assert_allclose(moment, solve_sweep(case).values("moment_z"), atol=1e-11)


def test_residuals_find_a_wrong_rigidity():
    """The conditions are those of the vibrissa that is asked for."""
    case = case_of(Beam(tip_radius=0.002))
    table = solve_sweep(case).table
    columns = {name: table[name].to_numpy() for name in table}
    other = Beam(tip_radius=0.00201)
    vibrissa = Vibrissa.of(other, Support())
    missed = residuals(columns, vibrissa, Units.of(other))["residual_boundary"]
    assert 1e-5 < np.nanmax(missed) < 1e-1


@pytest.mark.slow
def test_a_cone_past_small_facets_lets_go_where_it_does_past_the_curve():
    """The foot turns back at every corner: at the first one 4.5 L before it lets go.

    Observed 2.6e-3 L apart, and 1.2e-3 past twice as many facets.
    """
    case = named_case("catenary")
    case = Case(Beam(tip_radius=0.002), case.profile, Sweep(40))
    smooth = solve_sweep(case)
    left, right = case.reach
    facets = polygon(case.profile.outline(left, right, 200))
    stations = Sweep(40, float(case.foot_x[0]), float(case.foot_x[-1]))
    found = solve_sweep(Case(case.beam, facets, stations))
    assert set(found.table["status"]) == {"ok"}
    assert found.snap_off == pytest.approx(smooth.snap_off, abs=4e-3)


@pytest.mark.slow
def test_a_sharp_tip_does_not_let_go_by_chance():
    """Shortly before it buckles one step of the curve reached another equilibrium, 0.47 L early."""
    raised = replace(named_case("tip-only"), sweep=Sweep(2))
    cones = (Beam(radius=0.005, tip_radius=0.005 * ratio) for ratio in (0.0199, 0.02, 0.0201))
    found = [solve_sweep(replace(raised, beam=cone)).snap_off for cone in cones]
    assert np.ptp(found) < 2e-4  # observed 1.1e-4


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [0.05, 0.005])
def test_a_sharp_cone_lets_go_at_a_state_that_balances(ratio):
    """A point next to the fold that missed its conditions by 5e-9 seemed to lie beyond it."""
    case = named_case("tip-only")
    case = replace(case, beam=Beam(tip_radius=0.005 * ratio), sweep=Sweep(2))
    found = find_events(case.profile, case.beam).snap_off
    assert found.status == "ok"
    assert found.foot_x == pytest.approx(solve_sweep(case).snap_off, abs=1e-12)


@pytest.mark.parametrize("beam", [Beam(tip_radius=0.002), Beam(natural_curvature=bow(-0.4))])
def test_phase_b_from_the_first_contact_on(beam):
    """On the side of the object; there is no force yet whose direction could be wrong."""
    found = find_events(circle(0.3, lowest=(0, 0.5)), beam)
    assert found.phase_b_start == found.first_contact
    assert found.first_contact.status == "ok" and found.first_contact.phase == "tangent"


@pytest.mark.slow
def test_a_thin_vibrissa_first_touches_the_corner_where_the_object_ends():
    """At a corner every slope has one place: the contour's end is as far right as the touch."""
    vertices = [(-0.6, 0.886), (-0.356, 0.498), (0.114, 0.409), (0.223, 0.436), (0.361, 0.501)]
    for natural in (lambda s: -0.2 - 0.6 * s, bow(-0.6), -0.4):
        beam = Beam(radius=0.0, natural_curvature=natural)
        found = solve_sweep(Case(beam, polygon(vertices), Sweep(20), friction=0.3))
        assert set(found.table["status"]) == {"ok"}
        assert certify(found).max(axis=None) < 1e-10
