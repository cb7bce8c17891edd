"""Sweeps in motion: their limit at rest, and what defaults cost."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import (
    CLAMP_READINGS,
    Beam,
    Case,
    InputError,
    Sweep,
    circle,
    named_case,
    polygon,
    solve_sweep,
)
from compare import compare
from mujoco_models import DivergedError, Motion, Settings, simulate_motion
from mujoco_models.dynamics.model import MovingModel
from mujoco_models.model.lookout import Lookout

CASE = replace(named_case("catenary"), sweep=Sweep(60))
# Smooth and coarse: many steps in little time.
SMOOTH = Settings(segments=10, contact_stiffness=1e4, obstacle="primitive")

SMOOTH_MESH = replace(SMOOTH, obstacle="mesh", contour_points=400)


def worst(reference, candidate):
    return max(x.rms for x in compare(reference, candidate).disagreement.values())


@pytest.mark.slow
def test_mujocos_default_contact_is_found_wanting():
    """0.02 s for a whisker whose first period is 28 ms: the tip sinks in and slips past."""
    steel = Motion(speed=0.05, timestep=1 / 28, solref=(20 / 28, 1.0), damping_ratio=0.05)
    stock = simulate_motion(CASE, steel, replace(SMOOTH, obstacle="mesh", contour_points=400))
    found = compare(solve_sweep(CASE), stock)
    assert not found.agrees
    assert max(x.rms for x in found.disagreement.values()) > 0.05
    assert stock.values("penetration").max() > 0.01


def test_beads_that_are_left_out_of_a_step_touch_nothing_in_it(monkeypatch):
    """To the last digit: MuJoCo finds the same contacts, and no others."""
    case = replace(CASE, sweep=Sweep(12))
    settings = replace(SMOOTH, obstacle="mesh", contour_points=400)
    swept = simulate_motion(case, Motion(speed=0.6, timestep=0.02), settings)
    monkeypatch.setattr(MovingModel, "_leave_out", lambda model: None)
    every = simulate_motion(case, Motion(speed=0.6, timestep=0.02), settings)
    for name in (*CLAMP_READINGS, "penetration"):
        np.testing.assert_array_equal(swept.values(name), every.values(name))


@pytest.mark.parametrize(
    "first", [circle(0.1, (0.0, 0.7)), pytest.param(None, marks=pytest.mark.slow)]
)
def test_two_objects_are_touched_at_once(first):
    """The contact passes from one to the other, and in between there are two."""
    box = polygon([(-0.35, 0.35), (-0.2, 0.35), (-0.15, 0.5), (-0.3, 0.55)])
    other = circle(0.3, (-0.25, 0.35)) if first else box
    way = Sweep(30, 0.11, -0.12) if first else Sweep(30, 0.11, -0.4)
    case = Case(Beam(radius=0.002), [circle(0.1, (0.0, 0.7)), other], way)
    exact, moved = solve_sweep(case), simulate_motion(case, Motion(speed=0.02), SMOOTH_MESH)
    for event in ("second_contact_start", "second_contact_end"):
        there, here = (s.provenance["events"][event] for s in (exact, moved))
        assert here == pytest.approx(there, abs=2e-3)
    both = exact.table["second_contact_x"].notna() & moved.table["second_contact_x"].notna()
    assert both.sum() >= 2
    for name, off in (("contact_x", 5e-3), ("second_contact_x", 5e-3)):
        assert np.abs(exact.values(name) - moved.values(name))[both].max() < off
    largest = np.nanmax(exact.values("second_contact_force"))
    off = exact.values("second_contact_force") - moved.values("second_contact_force")
    assert np.abs(off[both]).max() < 0.1 * largest


def test_each_object_shows_what_its_own_contact_needs(monkeypatch):
    found = []

    def follow(lookout, contacts):
        clearance = [lookout._obstacle.clearance(point)[0] for point in contacts.point]
        found.append((lookout, max(clearance, default=None)))

    monkeypatch.setattr(Lookout, "follow_contact", follow)
    objects = [circle(0.1, (0.0, 0.7)), circle(0.3, (-0.25, 0.35))]
    case = Case(Beam(radius=0.002), objects, Sweep(30, 0.11, -0.12))
    simulate_motion(case, Motion(speed=0.05), SMOOTH_MESH)
    touched = [(lookout, x) for lookout, x in found if x is not None]
    assert len({lookout for lookout, _ in touched}) == 2
    assert max(x for _, x in touched) < 0.01  # the other object is 0.07 L off


def test_a_vibrissa_whose_clamp_turns_moves_as_it_rests():
    """Its foot has no length, and still the mass that MuJoCo asks of what moves."""
    case = Case(profile=circle(0.5, (0.0, 0.4)), sweep=Sweep(12), clamp_stiffness=8.0)
    moved = simulate_motion(case, Motion(speed=0.1, timestep=0.04), SMOOTH)
    assert worst(solve_sweep(case), moved) < 0.02  # observed 0.010; a rigid clamp is 0.29 off


def test_a_sweep_in_motion_has_a_row_a_station():
    fast = Motion(speed=0.2, damping_ratio=0.5)
    moved = simulate_motion(CASE, fast, SMOOTH)
    assert len(moved.table) == 60
    assert set(moved.table["status"]) <= {"ok", "chattering", "lost"}
    # The foot comes by every station at a steady speed.
    assert np.diff(moved.values("time")) == pytest.approx(
        -np.diff(moved.values("foot_x")) / 0.2, rel=1e-3
    )
    share = moved.values("kinetic_share")
    assert (share >= 0).all()
    assert (share <= 1).all()
    assert moved.source == "mujoco chain in motion"
    for name in CLAMP_READINGS:
        assert np.isfinite(moved.values(f"{name}_raw")).all()


def test_a_sweep_to_the_right_is_the_mirror_image():
    fast = Motion(speed=0.4, damping_ratio=0.5)
    left = simulate_motion(CASE, fast, SMOOTH)
    right = simulate_motion(replace(CASE, sweep=Sweep(60, direction="right")), fast, SMOOTH)
    assert right.values("force_x") == pytest.approx(-left.values("force_x"), abs=1e-9)
    assert right.values("force_y") == pytest.approx(left.values("force_y"), abs=1e-9)
    assert right.values("moment_z_raw") == pytest.approx(-left.values("moment_z_raw"), abs=1e-9)
    assert right.snap_off == pytest.approx(-left.snap_off)


@pytest.mark.slow
def test_springs_that_are_too_stiff_for_the_step_are_reported(tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    kept = []
    with pytest.raises(DivergedError, match=r"diverged at t = .* T1.*shorten the time step"):
        simulate_motion(CASE, Motion(integrator="euler"), SMOOTH, keep=kept.append)
    # MuJoCo's own warning would go to the terminal and to a file.
    assert capfd.readouterr().err == ""
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({"speed": 0.0}, "motion.speed"),
        ({"speed": float("nan")}, "motion.speed"),
        ({"timestep": True}, "motion.timestep"),
        ({"integrator": "verlet"}, "motion.integrator"),
        ({"solref": (0.02,)}, "motion.solref"),
        ({"average": 1.5}, "motion.average"),
    ],
)
def test_bad_settings_are_one_line(change, name):
    with pytest.raises(InputError, match=name) as caught:
        Motion(**change)
    assert "\n" not in str(caught.value)


def test_what_cannot_move_yet_is_refused():
    with pytest.raises(InputError, match="planar"):
        simulate_motion(CASE, Motion(), replace(SMOOTH, planar=False))
    with pytest.raises(InputError, match="speed"):
        simulate_motion(CASE, Motion(speed=1e-6), SMOOTH)


def test_the_default_contact_is_as_stiff_as_the_step_allows():
    assert Motion(timestep=0.02).stiffness == pytest.approx(1e4)
    assert Motion(timestep=0.002).stiffness == pytest.approx(1e6)
    assert Motion(contact_stiffness=1e5).stiffness == 1e5
    assert Motion(timestep=0.02, integrator="implicitfast").stiffness == pytest.approx(2500)
    with pytest.raises(InputError, match="leave one of them out"):
        Motion(contact_stiffness=1e5, solref=(0.1, 1.0))


@pytest.mark.parametrize("stated", [None, 1e4])
def test_a_contact_yields_as_much_as_its_stiffness_says(stated):
    """At the tip, where there is one; a constant solref makes it 14 times harder here."""
    motion = Motion(speed=0.2, timestep=0.02, contact_stiffness=stated)
    moved = simulate_motion(replace(CASE, sweep=Sweep(30)), motion, SMOOTH)
    tip = moved.trusted & (moved.table["phase"] == "tip").to_numpy()
    force = np.hypot(moved.values("force_x_raw"), moved.values("force_y_raw"))[tip]
    assert tip.sum() > 5
    assert np.median(force / moved.values("penetration")[tip]) == pytest.approx(1e4, rel=0.1)


@pytest.mark.slow
def test_explicit_integrators_stay_finite_with_an_armature():
    """Nor do they chatter: with MuJoCo's own tolerance of 1e-8, 90 of 100 stations did."""
    mesh = Settings(segments=20, contour_points=800)
    stiff = Motion(speed=0.2, integrator="implicitfast", armature=1.0, contact_stiffness=1e3)
    assert (simulate_motion(CASE, stiff, mesh).table["status"] == "ok").all()
    with pytest.raises(DivergedError, match="soften contacts"):
        simulate_motion(CASE, replace(stiff, contact_stiffness=1e4), mesh)
