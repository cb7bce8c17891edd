"""Friction in space: rows of an own integration, limits, and Coulomb's law step by step."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.optimize import root

from analytic import Beam, Case, InputError, Sweep, catenary, circle, polygon, solve_sweep
from analytic.numerics.arrays import Floats
from analytic.space import (
    Body,
    FootPath,
    SpatialCase,
    SpatialReadings,
    cylinder,
    ellipsoid,
    polyhedron,
    prism,
    rod_residuals,
    solve_space,
    sphere,
)
from analytic.space.checks.rod import integrate_rod
from analytic.space.problem.readings import CONTACT_POINT, FORCE, FRICTION, MOMENT, NORMAL
from analytic.space.solver.branch import Branch, Held
from analytic.space.solver.contact import Scene
from analytic.space.solver.walk import Walk

TABLE = pd.read_csv(Path(__file__).parents[2] / "data" / "beyond_friction_space.csv")
THIN = Beam(radius=0.0)
BALL = sphere(1.0, centre=(0, 1.4, 0))
EGG = ellipsoid((1.0, 0.7, 1.6), centre=(0.0, 1.1, 0.0))
OBLIQUE = FootPath([[1.3, 0.3], [-0.2, 0.1]], tangent=(0.1, 1, 0.05), stations=20)
CLAMP = (*FORCE, *MOMENT)


def _vector(row: pd.Series, name: str) -> Floats:
    return row[[f"{name}_{axis}" for axis in "xyz"]].to_numpy(dtype=float)


def _swept(body: Body, path: FootPath, friction: float) -> SpatialReadings:
    return solve_space(SpatialCase(THIN, body=body, path=path, friction=friction))


@pytest.mark.parametrize(
    "name", ["dev0", *(pytest.param(name, marks=pytest.mark.slow) for name in ("dev1", "dev2"))]
)
def test_rows_of_an_own_integration(name: str) -> None:
    # dev2 may begin in two directions; the first that is found is the one that was followed there.
    rows = TABLE[TABLE["case"] == name].iloc[1:]
    first = rows.iloc[0]
    start, onward = _vector(first, "start"), _vector(first, "direction")
    stop = start + 2.6 * onward
    body = ellipsoid(_vector(first, "semi_axis"), _vector(first, "centre"))
    path = FootPath([start[[0, 2]], stop[[0, 2]]], start[1], _vector(first, "tangent"))
    case = SpatialCase(THIN, body=body, path=path, friction=first["friction"])
    ways = rows["way"].to_numpy()
    fold = rows["event"].iloc[-1] == "slip-off (fold)"
    stations = np.append(ways[:-1], ways[-1] - 1e-9 * fold)
    walked = Walk(Scene(body, path.clamp_tangent, 0.0), case.way, first["friction"]).along(stations)
    for (_, row), held in zip(rows.iterrows(), walked.contacts, strict=True):
        assert isinstance(held, Held)
        # What friction's direction leaves of the path: 1e-7. All else is exact but for that.
        event = row["event"] if isinstance(row["event"], str) else ""
        within = 1e-7 if "fold" in event else 1e-9
        state = held.stretch.last if "fold" in event else held.state
        contact = state.contact
        moment = np.sqrt(contact.force) * contact.loaded.moment * contact.plane.across
        assert np.abs(state.rub / row["friction"] - _vector(row, "tau")).max() < 1e-7
        for found, expected in (
            (contact.spot.point, _vector(row, "contact")),
            (contact.spot.normal, _vector(row, "normal")),
            (-contact.force * contact.plane.normal, _vector(row, "force")),
            (moment, _vector(row, "moment")),
            (contact.arc_length, row["s1"]),
        ):
            assert np.abs(found - expected).max() < within
    # At rest with the friction of the row itself: 1e-11, without what the path leaves.
    for held in walked.contacts:
        assert held is not None
        state, law = held.state, held.stretch.panel.law
        assert np.abs(law.missed(state)).max() < 1e-14
    events = {event.kind: event.travel for event in walked.events}
    for kind, label in (("phase", "tangential"), ("slip-off", "slip-off (fold)")):
        for way in rows["way"][rows["event"] == label]:
            at = [event.travel for event in walked.events if event.kind == kind]
            at += [held.stretch.last.travel for held in walked.contacts[-1:] if kind == "slip-off"]
            assert min(abs(one - way) for one in at) < 2e-11
    assert "touch" in events


@pytest.mark.parametrize("friction", [0.1, 0.3])
def test_across_a_prism_it_is_the_plane_s(friction: float) -> None:
    contour = catenary(0.5, -0.8)
    plane = solve_sweep(
        Case(THIN, contour, Sweep(start=2.45, stop=1.0, stations=20), friction=friction)
    )
    path = FootPath([[2.45, 0.0], [1.0, 0.0]], stations=20)
    space = _swept(prism(contour), path, friction)
    for column in ("force_x", "force_y", "moment_z", "contact_arc_length"):
        differs = np.abs(plane.values(column) - space.values(column))
        assert np.nanmax(differs) < 1e-13
    assert np.nanmax(np.abs(space.values("friction_z"))) < 1e-15


@pytest.mark.slow
@pytest.mark.parametrize("body", [BALL, EGG])
def test_little_friction_differs_in_proportion(body: Body) -> None:
    free = _swept(body, OBLIQUE, 0.0).values(*CLAMP)
    apart = [
        np.nanmax(np.abs(_swept(body, OBLIQUE, friction).values(*CLAMP) - free))
        for friction in (1e-4, 1e-5)
    ]
    assert apart[0] / apart[1] == pytest.approx(10, rel=2e-2)
    assert apart[1] < 2e-4


@pytest.mark.slow
def test_a_foot_that_turns_back_leaves_its_tip_where_it_is() -> None:
    path = FootPath([[1.3, 0.3], [0.2, 0.2], [1.3, 0.3]], stations=60)
    readings = _swept(BALL, path, 0.3)
    slides = [e["travel"] for e in readings.provenance["events"] if e["kind"] == "slide"]
    turned = path.marks[1]
    travel, friction = readings.values("travel"), readings.values(*FRICTION)
    held = (travel > turned) & (travel < slides[0])
    size = np.linalg.norm(friction, axis=1)
    rubs = readings.touching & (travel < turned)
    assert (readings.table["slip_speed"][held] == 0).all()
    assert (size[held] < 0.3).all()
    np.testing.assert_allclose(size[rubs], 0.3, atol=1e-14)


def test_the_tip_that_sticks_stays() -> None:
    # Not long: bent as it is, only friction's turning about lets the foot come back without slip.
    path = FootPath([[1.3, 0.3], [0.6, 0.3], [1.3, 0.3]])
    case = SpatialCase(THIN, body=BALL, path=path, friction=0.5)
    walker = Walk(Scene(BALL, path.clamp_tangent, 0.0), case.way, 0.5)
    walked = walker.along(0.7 + np.linspace(0, 7e-4, 6))
    states = [held.state for held in walked.contacts if held is not None]
    assert not states[-1].contact.tangent
    places = np.array([state.contact.spot.point for state in states])
    assert np.abs(places - places[0]).max() < 1e-13
    sizes = [np.linalg.norm(state.rub) for state in states]
    assert sizes[0] == pytest.approx(0.5)
    assert (np.array(sizes[1:]) < 0.5).all()


@pytest.mark.parametrize("body", [BALL, EGG])
def test_integrated_from_the_clamp_it_is_at_rest(body: Body) -> None:
    readings = _swept(body, OBLIQUE, 0.3)
    assert rod_residuals(readings).max() < 1e-10
    planted = readings.table.assign(friction_x=-readings.table["friction_x"])
    wrong = SpatialReadings(planted, readings.beam, readings.tangent)
    assert np.nanmax(rod_residuals(wrong)) > 1e-3


def _coulomb(friction: float, foot: Floats, onward: Floats, way: float, steps: int) -> Floats:
    """Direction of friction on a tip after many small steps, by integration of the rod alone."""
    centre, t = np.array([0.0, 1.4, 0.0]), np.array([0.0, 1.0, 0.0])
    both = np.eye(3)[[0, 2]]
    place = foot + t
    normal = place - centre
    found = np.array([*(-1e-3 * normal), *(1e-3 * np.cross(t, normal) @ both.T)])
    size = way / steps
    for i in range(steps):
        here = foot + (i + 1) * size * onward

        def missed(x: Floats, here: Floats = here, place: Floats = place) -> Floats:
            force, moment = x[:3], x[3:] @ both
            ends, along, bending = integrate_rod(t, force, moment, 1.0)
            tip = here + ends[-1]
            normal = (tip - centre) / np.linalg.norm(tip - centre)
            slip = tip - place
            slip = slip - (slip @ normal) * normal
            pressed = -force @ normal
            shear = force + pressed * normal - friction * pressed * slip / np.linalg.norm(slip)
            free = np.linalg.svd(normal[None])[2][1:]
            straight = np.linalg.svd(along[-1][None])[2][1:]
            return np.array(
                [np.linalg.norm(tip - centre) - 1, *(free @ shear), *(straight @ bending[-1])]
            )

        solved = root(missed, found, tol=1e-12)
        assert np.abs(solved.fun).max() < 1e-9
        found = solved.x
        place = here + integrate_rod(t, found[:3], found[3:] @ both, 1.0)[0][-1]
    normal = (place - centre) / np.linalg.norm(place - centre)
    shear = -found[:3] - (-found[:3] @ normal) * normal
    return np.asarray(shear / np.linalg.norm(shear))


@pytest.mark.slow
def test_coulomb_s_law_step_by_step() -> None:
    friction, aside, turn = 0.3, 0.3, 0.1
    onward = np.array([-np.cos(turn), 0.0, np.sin(turn)])
    path = FootPath([[1.3, aside], [1.3 + onward[0], aside + onward[2]]])
    case = SpatialCase(THIN, body=BALL, path=path, friction=friction)
    touch = case.way.next_touch(0.0)
    assert touch is not None
    way = 0.15
    walker = Walk(Scene(BALL, path.clamp_tangent, 0.0), case.way, friction)
    (held,) = walker.along([touch + way]).contacts
    assert isinstance(held, Held)
    exact = held.state.rub / friction
    coarse, fine = (
        _coulomb(friction, case.way.foot(touch), onward, way, steps) for steps in (20, 40)
    )
    missed = np.abs(coarse - exact).max(), np.abs(fine - exact).max()
    assert missed[1] < 0.05 * way
    # Of first order: what is left of twice the finer one less the coarser is of second.
    assert np.abs(2 * fine - coarse - exact).max() < max(0.3 * missed[1], 1e-5)


SHARP = polygon([(-1.2, 1.3), (-0.5, 0.6), (0, 0.4), (0.5, 0.6), (1.2, 1.3)])


@pytest.mark.slow
@pytest.mark.parametrize("friction", [0.1, 0.3])
def test_across_edges_it_is_the_plane_s(friction: float) -> None:
    """But for the moment of friction at the skin, which goes with the radius."""
    path = FootPath([[1.2, 0.0], [-1.3, 0.0]], stations=60)
    off = {}
    for radius in (1e-3, 1e-5):
        beam = Beam(radius=radius)
        way = Sweep(start=1.2, stop=-1.3, stations=60)
        plane = solve_sweep(Case(beam, SHARP, way, friction=friction))
        space = solve_space(SpatialCase(beam, body=prism(SHARP), path=path, friction=friction))
        ok = space.trusted
        assert ok.sum() > 45 and (plane.table["phase"] == space.table["phase"])[ok].all()
        names = ("force_x", "force_y", "moment_z")
        apart = [np.abs(plane.values(x) - space.values(x))[ok].max() for x in names]
        off[radius] = max(apart)
        events = [e["foot"][0] for e in space.provenance["events"] if e["kind"] == "phase"]
        there = [plane.provenance["events"][x] for x in ("phase_b_start", "phase_b_end")]
        np.testing.assert_allclose(events, there, atol=radius)
    assert off[1e-5] < 6e-5
    assert off[1e-3] / off[1e-5] == pytest.approx(100, rel=0.02)


def _solid(seed: int) -> SpatialCase:
    """Past a polyhedron of random corners on a sphere."""
    draw = np.random.default_rng(seed)
    corners = draw.normal(size=(int(draw.integers(6, 30)), 3))
    corners *= draw.uniform(0.4, 1.0) / np.linalg.norm(corners, axis=1)[:, None]
    body = polyhedron(corners + np.array([0, draw.uniform(1.0, 1.5), 0]))
    path = FootPath([[1.4, draw.uniform(-0.4, 0.4)], [-1.4, draw.uniform(-0.4, 0.4)]], stations=150)
    beam = Beam(radius=float(10 ** draw.uniform(-4, -2.3)))
    return SpatialCase(beam, body=body, path=path, friction=float(draw.uniform(0.05, 0.6)))


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 3, 6, 7])
def test_past_a_polyhedron_it_is_at_rest_and_slides_against_friction(seed: int) -> None:
    """From station to station a tip moves against the friction on it, or does not move."""
    case = _solid(seed)
    readings = solve_space(case)
    assert np.nanmax(rod_residuals(readings)) < 1e-10
    rub, touching = readings.values(*FRICTION), readings.touching
    assert np.linalg.norm(rub, axis=1)[touching].max() <= case.friction * (1 + 1e-9)
    tips = touching & (readings.table["phase"] == "tip")
    normal = readings.values(*NORMAL)
    tip = readings.values(*CONTACT_POINT) + case.beam.radius * normal
    travel, found = readings.values("travel"), 0
    events = np.searchsorted(travel, [e["travel"] for e in readings.provenance["events"]]) - 1
    for i in np.setdiff1d(np.flatnonzero(tips[:-1] & tips[1:]), events):
        moved, mean = tip[i + 1] - tip[i], (rub[i] + rub[i + 1]) / 2
        size = np.linalg.norm(moved)
        if size > 1e-6 and np.linalg.norm(normal[i + 1] - normal[i]) < 1e-12:  # on one face
            found += 1
            cosine = moved @ mean / size / np.linalg.norm(mean)
            assert cosine < -1 + 1e-4
    assert found > 3 or not tips.any()


@pytest.mark.slow
def test_past_an_edge_it_is_at_rest_before_it_goes_on() -> None:
    """An edge is met to 1e-12 L: a state so far from rest can be the start of no panel."""
    case = _solid(43)
    readings = solve_space(replace(case, path=replace(case.path, stations=40)))
    assert set(readings.table["status"]) <= {"ok", "slipped off"}
    assert [e["kind"] for e in readings.provenance["events"]][-1] == "slip-off"


def test_along_an_upright_face_it_bends_about_the_lower_edge() -> None:
    """And slides along it; where its tip comes there it neither slides nor sticks: it slips off."""
    cube = polyhedron([(x, y, z) for x in (-0.6, 0.6) for y in (0.6, 2) for z in (-1, 1)])
    path = FootPath([[1.2, 0.3], [-0.9, 0.2]], stations=40)
    case = SpatialCase(Beam(radius=2e-3), body=cube, path=path, friction=0.3)
    readings = solve_space(case)
    assert [e["kind"] for e in readings.provenance["events"]] == ["touch", "phase", "slip-off"]
    assert readings.touching.sum() > 10
    place = readings.values(*CONTACT_POINT)[readings.touching]
    np.testing.assert_allclose(place[:, :2], 0.6, atol=1e-11)
    assert np.ptp(place[:, 2]) > 0.01
    assert np.nanmax(rod_residuals(readings)) < 1e-10


def test_where_a_flat_side_becomes_round_it_goes_on() -> None:
    """No polynomial goes across; it neither slid nor stuck there, and what held on was "free".

    Nor does it go back: a short panel's polynomial, far past its end, was on the flat side again.
    """
    path = FootPath([[1.3, 0.12], [-0.4, -0.03]], tangent=(-0.13, 1.0, 0.01), stations=30)
    readings = _swept(prism(circle(0.223, (0, 0.183))), path, 0.05)
    assert set(readings.table["status"]) == {"ok"}
    assert [e["kind"] for e in readings.provenance["events"]][-1] == "slip-off"
    assert np.nanmax(rod_residuals(readings)) < 1e-10
    body = prism(circle(0.07, (0, 0.386)), (0.863, 0.379, 0.335))
    path = FootPath([[1.3, -0.103], [-0.481, -0.259]], stations=20)
    case = SpatialCase(Beam(radius=5e-3), body=body, path=path, friction=2e-4)
    assert set(solve_space(case).table["status"]) == {"ok"}


def test_where_no_law_goes_on_past_a_phase_it_slips_off() -> None:
    """As without friction, and as much later as there is friction."""
    body = cylinder(0.04, through=(0, 0.64, 0), axis=(0.83, -0.56, -0.03))
    path = FootPath([[1.3, 0.05], [-1.3, -0.18]], stations=5)
    last = [_swept(body, path, x).provenance["events"][-1] for x in (0.0, 0.01, 0.02)]
    assert [event["kind"] for event in last] == ["slip-off"] * 3
    off = [event["travel"] for event in last]
    assert off[2] - off[1] == pytest.approx(off[1] - off[0], rel=0.05)


@pytest.mark.parametrize("way", [1, -1])
def test_next_to_release_rounding_makes_no_events(way: int) -> None:
    """Its mirror image stuck and slid ten times at one place, was lost, or slipped off."""
    axis = (0.6831191, 0.24007089, -way * 0.68972042)
    body = cylinder(0.47403191, through=(0, 0.58487292, 0), axis=axis)
    feet = [(1.3, 0.10842962), (-1.25966221, 0.07214567), (-0.27848485, -0.23946986)]
    path = FootPath([(x, way * z) for x, z in (*feet, (-1.3, -0.26385344))], stations=30)
    case = SpatialCase(Beam(radius=1e-3), body=body, path=path, friction=0.22)
    kinds = [e["kind"] for e in solve_space(case).provenance["events"]]
    assert kinds[:2] == ["touch", "release"] and "slip-off" not in kinds


@pytest.mark.parametrize("way", [1, -1])
def test_where_friction_goes_astray_nothing_is_known(way: int) -> None:
    """Rounding grew by e^2000 along it: mirror images ended by slip-offs at different places."""
    body = prism(circle(0.37, (0, 0.512)), (-0.814, 0.012, way * 0.58))
    feet = [(1.3, way * -0.098), (-0.927, way * -0.085)]
    path = FootPath(feet, tangent=(-0.096, 1.0, way * -0.128), stations=20)
    readings = _swept(body, path, 0.5)
    assert set(readings.table["status"]) == {"ok", "diverged"}
    assert readings.table["status"].iloc[-1] == "diverged"
    assert [event["kind"] for event in readings.provenance["events"]] == ["touch"]


@pytest.mark.slow
@pytest.mark.parametrize("way", [1, -1])
def test_a_stick_that_ends_before_a_panels_first_point_is_followed(way: int) -> None:
    """Its margin was 0 there but for rounding, and so one mirror image was lost at a corner."""
    body = prism(circle(0.21, (0, 0.631)), (0.869, 0.216, way * 0.446))
    feet = [(1.3, 0.065), (-0.195, -0.239), (0.157, -0.111)]
    path = FootPath([(x, way * z) for x, z in feet], tangent=(0.027, 1, way * 0.019), stations=20)
    readings = _swept(body, path, 0.002)
    assert set(readings.table["status"]) == {"ok"}
    assert "slide" in [event["kind"] for event in readings.provenance["events"]]


def test_once_it_cannot_be_followed_nothing_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    """It may hold on long after the straight vibrissa is clear of the body, or back again."""
    monkeypatch.setattr(Branch, "after", lambda *_: None)
    path = FootPath([[1.2, 0.1], [-1.2, 0.1], [1.2, 0.1]], stations=40)
    status = _swept(sphere(0.2, (0, 0.5, 0)), path, 0.3).table["status"]
    assert (status[status.ne("ok").argmax() :] == "diverged").all()


def test_what_sticks_at_first_contact_is_never_called_free(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where it comes loose, and whether it touches then, is not known."""
    monkeypatch.setattr(Branch, "begin", lambda *_: None)
    body, path = sphere(0.5, (0, 1, 0)), FootPath([[1.2, 0.1], [-1.2, 0.1]], stations=40)
    table = _swept(body, path, 0.3).table
    touched = table["travel"] > 0.75
    assert (table["status"][touched] == "sticks").all()
    assert (table["status"][table["travel"] < 0.7] == "ok").all()


def test_edges_without_a_radius_and_odd_numbers_are_refused() -> None:
    cube = polyhedron([(x, y, z) for x in (-1, 1) for y in (0.6, 2) for z in (-1, 1)])
    path = FootPath([[1.4, 0.3], [-0.2, 0.1]])
    for body in (cube, prism(SHARP)):
        with pytest.raises(InputError, match="edges"):
            _swept(body, path, 0.2)
    for friction in (-0.1, 2.0, 1e-8, float("nan")):
        with pytest.raises(InputError, match="friction"):
            _swept(BALL, path, friction)
