"""Sweeps in which the clamp turns, compared: along its angle, or along its way."""

import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from analytic import Case, ClampPath, InputError, Sweep, Whisk, named_case, solve_sweep
from compare import compare
from compare.sense.phases import classify
from compare.simulate.budgets import measure_budget
from mujoco_models import Settings

_S = np.linspace(0, 1, 60)


@cache
def exact(name):
    whisk = named_case("whisk-circle")
    return solve_sweep(
        {
            "left": whisk,
            "right": whisk.mirrored(),
            "path": replace(
                whisk, sweep=ClampPath(0.4 - 0.2 * _S, 0.02 * _S, -0.55 + 2.5 * _S), name="path"
            ),
        }[name]
    )


@pytest.mark.parametrize("name", ["left", "right", "path"])
def test_phases_and_events_are_those_of_the_closed_form(name):
    readings = exact(name)
    np.testing.assert_array_equal(classify(readings).phase, readings.table["phase"])
    found = compare(readings, readings)
    assert found.agrees and found.stations > 40
    assert {one.rms for one in found.disagreement.values()} == {0.0}
    events, step = readings.provenance["events"], np.abs(np.diff(readings.running_values)).max()
    for which in ("first_contact", "phase_b_start"):
        assert found.events[which].reference == pytest.approx(events[which], abs=step / 20)
    assert found.snap_off.reference == events["snap_off"]


def test_other_stations_of_one_whisk_are_compared():
    case = named_case("whisk-circle")
    other = solve_sweep(replace(case, sweep=replace(case.sweep, stations=87)))
    found = compare(exact("left"), other)
    assert found.agrees
    # Between stations by a cubic spline; observed 4e-6.
    assert max(one.rms for one in found.disagreement.values()) < 2e-5


def test_what_is_off_is_said_in_rad():
    readings = exact("left")
    table = readings.table.assign(moment_z=1.05 * readings.values("moment_z"))
    found = compare(readings, replace(readings, table=table))
    assert found.likely.startswith("gain of moment_z +5")
    said = "".join(found.failures)
    assert " at clamp_angle = " in said and " rad in phase" in said and " rad apart" in said
    late = {**readings.provenance["events"], "snap_off": readings.snap_off + 0.02}
    late = replace(readings, provenance={**readings.provenance, "events": late})
    (said,) = compare(readings, late).failures
    assert "+2.00e-02 rad apart" in said
    away = replace(named_case("whisk-circle"), sweep=Whisk(0.4, -0.54, 1.96, 200))
    turned = solve_sweep(away)
    turned = replace(turned, table=turned.table.assign(clamp_angle=readings.clamp_angle))
    assert re.match(r"clamp_angle -9\.[5-9]\de-03 rad off", compare(readings, turned).likely)


def test_ways_that_differ_are_refused():
    case, readings = named_case("whisk-circle"), exact("left")
    farther = solve_sweep(replace(case, sweep=replace(case.sweep, foot_x=0.41)))
    along = solve_sweep(Case(profile=case.profile, sweep=Sweep(60)))
    path = exact("path")
    higher = replace(path, table=path.table.assign(foot_y=path.values("foot_y") + 1e-4))
    for one, other, said in (
        (readings, farther, "foot_x of analytic = up to 0.01 away"),
        (along, readings, "ways of the two clamps = over foot_x and over clamp_angle"),
        (path, higher, "foot_y of analytic = up to 0.0001 away"),
    ):
        with pytest.raises(InputError, match=said):
            compare(one, other)


@pytest.mark.slow
def test_a_budget_of_a_whisk_closes():
    case = named_case("whisk-circle")
    case = replace(case, sweep=replace(case.sweep, stations=60))
    found, _ = measure_budget(case, Settings(segments=20))
    assert found.closes and not found.undecided
    assert found.blame == "discretisation"
