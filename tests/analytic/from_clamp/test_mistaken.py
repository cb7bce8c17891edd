"""Readings in wrong units, or with wrong signs, are no contacts; which mistake it is, is found."""

import re
from dataclasses import replace

import pytest

from analytic import (
    Beam,
    Case,
    InputError,
    Sweep,
    calibrate,
    circle,
    named_case,
    reconstruct,
    relative_noise,
    require_beam,
    solve_sweep,
)
from analytic.from_clamp.reconstruct import doubt
from analytic.problem.named import NAMED_TABLES
from tests.analytic.noisy import noisy
from tests.conftest import exact_sweep

RIG = Case(Beam(0.06, 5e-6, 0.2e-3), circle(0.03, lowest=(0.004, 0.025)), Sweep(150))
FORCES = ("force_x", "force_y")


def mistaken(readings, **factors):
    columns = {name: factor * readings.values(name) for name, factor in factors.items()}
    return replace(readings, table=readings.table.assign(**columns))


@pytest.fixture(scope="module")
def rig():
    exact = solve_sweep(RIG)
    sensed = replace(exact, table=exact.table[["foot_x", *FORCES, "moment_z"]])
    return noisy(sensed, relative_noise(exact, 0.003), 7)


@pytest.mark.parametrize(
    ("factors", "likely"),
    [
        (dict.fromkeys(FORCES, 1e3), r"unit of both forces \(1000 times too large\)"),
        (dict.fromkeys((*FORCES, "moment_z"), 9.80665), r"flexural rigidity \(9.807 times"),
        (dict.fromkeys((*FORCES, "moment_z"), -1.0), "likely .*all signs"),
        (dict.fromkeys(FORCES, -1.0), "likely the signs of force_x and force_y or the signs of"),
        # A force that is made large enough is of a tip, whatever the other one is: alone it is
        # named if nothing else explains the readings.
        ({"force_y": 9.80665}, r"likely the unit of force_y \(9.807 times too large\)$"),
        # It was the unit of both: forces without a size are of a vibrissa next to unloaded.
        ({"force_y": 1e-3}, r"likely the unit of force_y \(1000 times too small\)$"),
        ({"moment_z": 1e-3}, r"likely the unit of moment_z \(1000 times too small\)$"),
    ],
)
def test_readings_of_no_such_vibrissa_are_refused_with_the_likely_mistake(rig, factors, likely):
    wrong = mistaken(rig, **factors)
    with pytest.raises(InputError, match=f"units and signs of .*{likely}"):
        require_beam(reconstruct(wrong), wrong)


def test_swapped_forces_are_named(rig):
    x, y = (rig.values(name) for name in FORCES)
    wrong = replace(rig, table=rig.table.assign(force_x=y, force_y=x))
    with pytest.raises(InputError, match="likely force_x and force_y, swapped"):
        require_beam(reconstruct(wrong), wrong)


@pytest.mark.parametrize(
    ("factors", "likely"),
    [
        (dict.fromkeys(FORCES, 1e-3), "likely the unit of both forces (1000 times too small)"),
        pytest.param(
            dict.fromkeys((*FORCES, "moment_z"), -1.0),
            "all signs (the vibrissa's action",
            marks=pytest.mark.slow,
        ),
        pytest.param(
            {"moment_z": 1e3},
            "likely the unit of moment_z (1000 times too large)",
            marks=pytest.mark.slow,
        ),
    ],
)
def test_a_calibration_that_is_refused_names_the_mistake(rig, factors, likely):
    """Of a vibrissa whose rigidity is to be found, and is a tenth off what the case says."""
    with pytest.raises(InputError, match=re.escape(likely)):
        calibrate(mistaken(rig, **factors), replace(RIG, beam=Beam(0.06, 5.5e-6, 0.2e-3)))


def test_a_moment_in_another_unit_is_no_force():
    """Of an unknown EI it was "force_x and moment_z, swapped": so large a force is of a tip."""
    exact = solve_sweep(Case(Beam(), circle(0.73, lowest=(0.22, 0.44)), Sweep(150)))
    read = noisy(exact, relative_noise(exact, 0.005), 7)
    wrong = replace(mistaken(read, moment_z=1e3), beam=Beam(1.0, 1.1))
    assert not any("swapped" in one for one in doubt(reconstruct(wrong), wrong).mistakes)


@pytest.mark.parametrize("name", ["moment_z", "force_x"])
def test_a_wrong_sign_is_named(rig, name):
    """Two thirds of its stations might be of a vibrissa that bends to the other side."""
    wrong = mistaken(rig, **{name: -1.0})
    said = doubt(reconstruct(wrong), wrong)
    assert said.mistakes == ["the sign of moment_z", "the sign of force_x"]
    assert str(said).endswith("likely the sign of moment_z or the sign of force_x")


def test_a_contact_at_the_tip_is_at_the_tip(rig):
    """Forces a thousand times too large put all of them next to the clamp."""
    found = reconstruct(mistaken(rig, **dict.fromkeys(FORCES, 1e3)))
    assert not (found["phase"] == "tip").any()
    neither = found["status"] == "neither phase"
    assert neither.sum() > 80
    assert (found["phase"][neither] == "unexplained").all()
    assert found.loc[neither, ["contact_x", "contact_arc_length"]].isna().all(axis=None)


@pytest.mark.parametrize("level", [0.0, 0.001, 0.01, 0.03])
@pytest.mark.parametrize("name", [name for name in NAMED_TABLES if name != "whisker"])
def test_good_readings_are_not_doubted(name, level):
    exact = exact_sweep(name)
    readings = noisy(exact, relative_noise(exact, level), 5)
    found = reconstruct(readings)
    assert not (found["status"] == "neither phase").any()
    assert doubt(found, readings) is None
    require_beam(found, readings)


def test_an_unstated_friction_leaves_the_contacts():
    """The paper's vibrissa is taken for one that rubs: its points stay, none is called a tip's."""
    exact = solve_sweep(replace(named_case("catenary"), friction=0.5))
    found = reconstruct(exact.with_friction(0.0))
    touching = (exact.table["phase"] != "free").to_numpy()
    assert (found["status"][touching] == "ok").all()
    tip = found["phase"] == "tip"
    assert (found["contact_arc_length"][tip] > 0.89).all()
