"""Shipped models disagree with the closed form by what `inspect` predicts of them."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import Case, InputError, Sweep, circle, solve_sweep
from compare import compare
from compare.simulate.inspection import Inspection
from compare.simulate.rigidity import by_its_clamp, clamp_stiffness
from mujoco_models import (
    DivergedError,
    Motion,
    OwnModel,
    Settings,
    inspect_model,
    shipped_models,
    simulate_model,
)
from tests.compare.simulate.faults import WIRE, cables, faults_in, rods
from tests.mujoco_models.inspect.rods import Rod

STATED = dict.fromkeys(shipped_models(), WIRE) | {"tapered-whisker": replace(WIRE, tip_radius=5e-5)}
COARSE = Settings(contour_points=400)


def inspected(name):
    return Inspection(inspect_model(shipped_models()[name]), STATED[name])


def case_of(beam, clamp=np.inf):
    stiffness = clamp * 6.44e-4 / 0.1 if np.isfinite(clamp) else np.inf
    return Case(beam, circle(0.08, (0, 0.04)), Sweep(60), clamp_stiffness=stiffness)


def swept(name, contact="own", speed=0.1):
    own = OwnModel(shipped_models()[name], contact=contact)
    return simulate_model(case_of(STATED[name]), own, Motion(speed=speed), COARSE)


def worst(case, moved):
    return max(d.rms for d in compare(solve_sweep(case), moved).disagreement.values())


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "at_most"),
    [
        ("sound-chain", 6e-3),
        pytest.param("sound-rod", 1e-2, marks=rods),  # observed 5.5e-3; past 3200 points 7.4e-3
    ],
)
def test_what_is_called_sound_agrees(name, at_most):
    assert inspected(name).sound
    assert worst(case_of(STATED[name]), swept(name)) < at_most


@pytest.mark.slow
def test_a_foot_without_speed_chatters_where_it_was_predicted():
    """The `tapered-whisker` has contacts that are too hard for its step, and a mocap foot."""
    found = inspected("tapered-whisker")
    assert any("mocap" in r.text for r in found.remarks if r.subject == "foot")
    case, moved = case_of(STATED["tapered-whisker"]), swept("tapered-whisker")
    exact = solve_sweep(case)
    ahead = exact.values("force_x") < 0
    # Observed 0.026, by MuJoCo 3 0.0303: a cone whose last joints are as soft as a hundredth of
    # the first.
    for name in ("force_x", "force_y", "moment_z"):
        off = np.abs(moved.values(name) - exact.values(name))[ahead]
        assert off.max() < 0.035 * np.nanmax(np.abs(exact.values(name)))
    assert moved.trusted[ahead].all()
    contact = (exact.values("force_x") > 0) & (exact.table["phase"] != "free").to_numpy()
    assert (~moved.trusted[contact]).mean() > 0.4


@pytest.mark.slow
def test_a_hinge_at_the_clamp_is_the_spring_that_was_measured():
    """40 EI/L of the `tutorial-chain`: its own contacts, found too soft, are off by a half."""
    found = inspected("tutorial-chain")
    assert worst(case_of(WIRE), swept("tutorial-chain")) > 0.3
    moved = swept("tutorial-chain", contact="ours")
    assert worst(case_of(WIRE), moved) > 0.05
    assert worst(case_of(WIRE, clamp_stiffness(found.found)), moved) < 0.01  # observed 6.4e-3


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", [pytest.param("cable", marks=cables), pytest.param("rod", marks=rods)]
)
def test_a_first_edge_that_is_rigid_is_as_stiff_as_was_measured(tmp_path, name):
    """7.9 % more than its joints say; the moments are up to 12 % more, by where it is touched."""
    path = tmp_path / "rigid.xml"
    text = shipped_models()["cable"].read_text() if name == "cable" else Rod(ahead=0.0).text
    path.write_text(text)
    found = Inspection(inspect_model(path), WIRE)
    assert "clamp" in faults_in(found)
    own = OwnModel(path, contact="ours" if name == "cable" else "own")
    if name == "cable":  # explicit in its springs, and its step is too long for them, as was found
        assert "time step" in faults_in(found)
        with pytest.raises(DivergedError, match="shorten the time step"):
            simulate_model(case_of(WIRE), own, Motion(speed=0.1), COARSE)
        path.write_text(text.replace('timestep="0.0005"', 'timestep="1e-4"'))
    moved = simulate_model(case_of(WIRE), own, Motion(speed=0.1), COARSE)
    exact = solve_sweep(case_of(WIRE))
    # The cable's contact chatters, as it is explicit; the means over a station's way hold.
    touches = (exact.table["phase"] == "tangent").to_numpy()
    ratio = np.median(moved.values("moment_z")[touches] / exact.values("moment_z")[touches])
    off = by_its_clamp(found.found) / WIRE.flexural_rigidity
    assert off == pytest.approx(1.079, abs=1e-3)
    assert ratio == pytest.approx(off, abs=0.025)


@pytest.mark.slow
@rods
def test_a_rod_whose_sensors_read_nothing_is_refused():
    asked = {"clamp", "edges", "force sensor", "torque sensor", "contact"}
    assert faults_in(inspected("rod")) == asked
    with pytest.raises(InputError, match="reads nothing of a flex's contacts") as caught:
        swept("rod")
    assert "\n" not in str(caught.value)


@pytest.mark.slow
@rods
def test_a_rod_that_can_leave_the_plane_slips_off_sideways(tmp_path):
    """As its note says: without friction nothing holds it there, and it lets go 0.09 L early."""
    text = shipped_models()["sound-rod"].read_text()
    assert 'dof="2d"' in text
    path = tmp_path / "spatial.xml"
    path.write_text(text.replace('dof="2d"', ""))
    found = Inspection(inspect_model(path), WIRE)
    assert [remark.subject for remark in found.remarks] == ["plane"]
    moved = simulate_model(case_of(WIRE), OwnModel(path), Motion(speed=0.1), COARSE)
    exact = solve_sweep(case_of(WIRE)).provenance["events"]["snap_off"]
    assert moved.provenance["events"]["snap_off"] - exact > 0.05 * 0.1
    assert swept("sound-rod").provenance["events"]["snap_off"] < exact


def test_the_mistakes_are_refused_or_come_to_the_end_that_was_predicted(tmp_path):
    """It touches itself and nothing moves its foot; on a slide its step is too long for it."""
    faults = [str(fault) for fault in inspected("mistakes").faults]
    for said in ("whisker0 and whisker1 touch", "nothing can move", "euler becomes unstable"):
        assert any(said in fault for fault in faults), faults
    with pytest.raises(InputError, match="whisker0 and whisker1: must be none"):
        swept("mistakes")
    text = shipped_models()["mistakes"].read_text()
    rail = '<body name="foot"><joint type="slide" axis="1 0 0" armature="10"/>'
    path = tmp_path / "moved.xml"
    path.write_text(text.replace('<body name="foot">', rail))
    with pytest.raises(DivergedError, match="shorten the time step"):
        simulate_model(case_of(WIRE), OwnModel(path), Motion(speed=0.1), COARSE)
