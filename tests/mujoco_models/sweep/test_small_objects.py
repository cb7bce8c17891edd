"""No object is too small, or too near between two stations, to be touched."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from analytic import CLAMP_READINGS, Beam, Case, Sweep, circle, ellipse, named_case, solve_sweep
from mujoco_models import Settings, available_beams, simulate_sweep
from mujoco_models.beams.chain import Chain
from mujoco_models.model.model import BeamModel
from mujoco_models.sweep.numerics import Numerics
from mujoco_models.sweep.sweep import run_sweep
from tests.fuzz.sweeps import trial


@pytest.mark.parametrize(
    ("radius", "stations"),
    [
        (0.1, 5),
        (0.05, 8),
        *(pytest.param(*s, marks=pytest.mark.slow) for s in [(0.02, 12), (0.002, 60)]),
    ],
)
def test_a_small_object_is_touched_between_stations(radius, stations):
    """Steps of the foot up to three times the object's width."""
    case = Case(profile=circle(radius, (0.0, 0.5)), sweep=Sweep(stations=stations))
    found = simulate_sweep(case, Settings(segments=20))
    exact = solve_sweep(case)
    assert (found.table["status"] == "ok").all()
    assert (found.table["phase"] == exact.table["phase"]).all()
    # Observed at most 4e-4: an object thinner than the beads' spacing.
    assert found.snap_off == pytest.approx(exact.snap_off, abs=1e-3)


def test_a_thin_vibrissa_is_no_trouble():
    """MuJoCo refuses bodies whose inertia is that of so thin a link."""
    case = Case(Beam(radius=1e-5), named_case("parabola").profile, Sweep(stations=12))
    found = simulate_sweep(case, Settings(segments=10, contour_points=400))
    assert (found.table["status"] == "ok").all()
    assert found.snap_off == pytest.approx(solve_sweep(case).snap_off, abs=2e-3)


@pytest.mark.parametrize("segments", [pytest.param(3, marks=pytest.mark.slow), 6])
def test_what_is_too_near_to_the_clamp_is_not_ok(segments):
    low = Case(profile=circle(0.05, (0.0, 0.06)), sweep=Sweep(12))
    found = simulate_sweep(low, Settings(segments=segments))
    touching = (solve_sweep(low).table["phase"] != "free").to_numpy()
    assert (found.table["status"][touching] != "ok").all()
    assert sum(found.provenance["unsettled"].values()) >= touching.sum()


PARABOLA = Case(profile=named_case("parabola").profile, sweep=Sweep(stations=12))
COARSE = Settings(segments=10, contour_points=800)


@cache
def sound():
    return run_sweep(PARABOLA, COARSE)


@pytest.mark.slow
@pytest.mark.parametrize("factor", [0.7, 1.3])
def test_a_wrong_stiffness_of_the_solver_does_not_move_the_snap_off_unseen(factor, monkeypatch):
    """30 % off, Newton's method stalls 0.03 L before the fold: MuJoCo's own balance decides."""
    expected, right = sound(), Chain.stiffness
    monkeypatch.setattr(Chain, "stiffness", lambda self, angles: factor * right(self, angles))
    found = run_sweep(PARABOLA, COARSE, numerics=Numerics(budget=2000))
    ok = (found.table["status"] == "ok").to_numpy()
    error = np.abs(found.values("force_y") - expected.values("force_y"))
    assert error[ok].max() < 1e-6
    if found.snap_off is not None:
        assert found.snap_off == pytest.approx(expected.snap_off, abs=1.1e-3)
    else:
        assert not ok.all()


def test_a_station_costs_bounded_effort():
    """Held to two evaluations, hardly a station comes to rest, and each says so."""
    found = run_sweep(PARABOLA, COARSE, numerics=Numerics(iterations=2, budget=50, least_budget=10))
    touching = sound().table["phase"] != "free"
    assert (found.table.loc[touching, "status"] == "unsettled").any()
    assert sum(found.provenance["unsettled"].values()) == (found.table["status"] != "ok").sum()
    assert any("evaluations" in reason for reason in found.provenance["unsettled"])


@pytest.mark.slow
def test_beads_slide_on_a_tip_sharper_than_they_are_dense():
    """Ellipse whose tip has a radius of 2e-3 L; a bead that stays there leans by up to 0.03 rad."""
    case = Case(Beam(radius=2e-3), ellipse((0.14, 9.2), (0.0, 0.25)), Sweep(stations=30))
    found = simulate_sweep(case, Settings(segments=40, contour_points=2000, contact_stiffness=1e7))
    exact = solve_sweep(case)
    both = (found.table["phase"] == "tangent") & (exact.table["phase"] == "tangent")
    error = (found.table["contact_angle"] - exact.table["contact_angle"])[both]
    assert (found.table["status"] == "ok").all()
    # Observed 2.8e-3; 1.9e-2 with beads that stay where they are.
    assert np.sqrt(np.mean(error**2)) < 6e-3


@pytest.mark.slow
def test_a_beam_that_lies_on_a_facet_as_long_as_itself_rests_on_hundreds_of_beads():
    """All of them are in the quadratic model: with a few at once it took 7,400 evaluations."""
    case = Case(Beam(radius=7.97e-3), ellipse((4.6181, 0.225519), (0.0, 0.296665)))
    settings = Settings(segments=18, contour_points=321, contact_stiffness=1.1e6)
    found = simulate_sweep(replace(case, sweep=Sweep(stations=12)), settings)
    assert (found.table["status"] == "ok").all()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("seed", "drawn"),
    [
        (
            710030,
            {},
        ),  # two of 60 stations did not rest where beads' slopes were averaged without loads
        # Shorter steps to a state that had become a neighbour failed at the same place.
        (1090083, {"kind": "polygon", "skip": 7}),
        (880018, {}),  # a facet of 1e-3 L, turned by single precision, was taken for a corner
        (
            830032,
            {},
        ),  # where steps were learnt from on the way to the free beam, 9 of 60 did not rest
    ],
)
def test_what_did_not_come_to_rest_once_does(seed, drawn, tmp_path):
    made = trial(seed, tmp_path, **drawn)
    found = simulate_sweep(made.case, made.settings)
    assert (found.table["status"] == "ok").all()
    assert found.snap_off is not None or seed != 830032


@pytest.fixture
def evaluated(monkeypatch):
    """Where the foot was at each evaluation."""
    feet, once = [], BeamModel.imbalance

    def noted(model, foot_x, angles):
        feet.append(foot_x)
        return once(model, foot_x, angles)

    monkeypatch.setattr(BeamModel, "imbalance", noted)
    return feet


@pytest.mark.slow
def test_a_contact_wider_than_a_window_rests_by_the_one_about_its_middle(tmp_path, evaluated):
    """What rested by the window next to it was taken for the best there is, and given up."""
    drawn = trial(1200039, tmp_path)
    found = simulate_sweep(drawn.case, drawn.settings)
    assert (found.table["status"] == "ok").all()
    assert len(evaluated) < 790  # observed 749; 823 if it is given up


@pytest.mark.slow
def test_a_way_that_has_come_to_its_end_is_not_sought_again_from_each_station(tmp_path, evaluated):
    """57 of 60 stations had taken 64,000 evaluations: each one failed where the first one had."""
    drawn = trial(1070014, tmp_path)
    found = simulate_sweep(drawn.case, drawn.settings)
    assert (found.table["status"] == "unsettled").sum() > 50
    assert any("so soft" in reason for reason in found.provenance["unsettled"])
    assert len(evaluated) < 10_000  # observed 2,900


@pytest.mark.slow
def test_a_beam_too_coarse_to_be_followed_says_that_it_is():
    """A contact as stiff as any holds no beam whose first joint is beyond the object."""
    case = Case(Beam(radius=0.0015), circle(0.008, (0.0, 0.0615)), Sweep(17))
    (why,) = simulate_sweep(case, Settings(segments=8)).provenance["unsettled"]
    assert "segments would do" in why


@pytest.mark.parametrize("beam", available_beams())
def test_contacts_on_few_segments_say_how_many_would_do(beam):
    """What is "ok" past a circle by the clamp is right to 7 % of the largest, all else is not."""
    case = Case(Beam(radius=0.005), circle(0.05, (0.0, 0.06)), Sweep(60))
    found, exact = simulate_sweep(case, Settings(beam=beam, segments=20)), solve_sweep(case)
    near = (found.values("contact_arc_length") < 0.13).nonzero()[0]
    assert len(near) > 1
    assert (found.table["status"][near] == "unsettled").all()
    assert any("times as many would do" in reason for reason in found.provenance["unsettled"])
    ok = (found.table["status"] == "ok") & (found.table["phase"] == exact.table["phase"])
    off = [
        np.abs(found.values(name) - exact.values(name)) / np.abs(exact.values(name)).max()
        for name in CLAMP_READINGS
    ]
    assert np.max(off, axis=0)[ok].max() < 0.07
    assert np.max(off, axis=0)[near].max() > 0.1
