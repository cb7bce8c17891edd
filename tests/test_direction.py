"""Sweeps to the right: mirror images, and where they differ from sweeps to the left."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from analytic import (
    CLAMP_READINGS,
    COLUMNS,
    Case,
    InputError,
    Readings,
    Sweep,
    certify,
    circle,
    named_case,
    polygon,
    reconstruct,
    reconstruct_by_decision,
    solve_sweep,
    through_points,
)
from compare import classify, compare
from compare.simulate.budgets import measure_budget
from mujoco_models import Settings, simulate_sweep
from tests.conftest import simulated_sweep

RIGHT = Sweep(direction="right")


def to_the_right(name: str) -> Case:
    return replace(named_case(name), sweep=RIGHT)


@pytest.fixture(scope="module")
def rightward() -> Readings:
    return solve_sweep(to_the_right("two-circles"), certified=True)


@pytest.fixture(scope="module")
def simulated_rightward() -> Readings:
    return simulate_sweep(to_the_right("two-circles"))


@pytest.mark.parametrize(
    "contour",
    [
        named_case("two-circles").profile,
        named_case("catenary").profile.offset(0.01),
        through_points([(-1, 1.2), (-0.5, 0.5), (0, 0.4), (1, 1.2)]),
        polygon([(-1, 1.2), (-0.4, 0.45), (0.1, 0.4), (1.5, 1.2)]),
        polygon([(-1, 1.2), (-0.4, 0.45), (0.1, 0.4), (1.5, 1.2)]).offset(0.01),
    ],
    ids=["two circles", "offset catenary", "points", "polygon", "offset polygon"],
)
def test_mirrored_contour(contour):
    low, high = contour.t_range
    image = contour.mirrored()
    t = np.linspace(low, high, 201)[1:-1] + 1e-7  # no break of either is hit
    here, there = contour.at(t), image.at(image.t_range[0] + (high - t))
    np.testing.assert_allclose(there.alpha, -here.alpha, atol=1e-12)
    np.testing.assert_allclose(there.xi, -here.xi, atol=1e-10)  # the contours' poles amplify
    np.testing.assert_allclose(there.eta, here.eta, atol=1e-10)
    np.testing.assert_allclose(there.stretch, here.stretch, rtol=1e-6)
    np.testing.assert_array_equal(there.turning, here.turning)
    back = image.mirrored().at(t)
    np.testing.assert_allclose(back.xi, here.xi, rtol=1e-15)


def test_a_symmetric_object_has_mirrored_readings():
    """To the last digit but the rounding of the first contact's place."""
    object_ = circle(1, (0, 0.4))
    left = solve_sweep(Case(profile=object_, sweep=Sweep(60, 1.0, -1.6)))
    right = solve_sweep(Case(profile=object_, sweep=Sweep(60, -1.0, 1.6, "right")))
    pd.testing.assert_frame_equal(right.mirrored().table, left.table, rtol=1e-12, atol=1e-12)
    assert right.snap_off == pytest.approx(-left.snap_off, abs=1e-13)


@pytest.mark.parametrize("name", ["catenary", "two-circles"])
def test_hysteresis(name):
    """The one sweep lets go elsewhere than the other one touches."""
    left, right = solve_sweep(named_case(name)), solve_sweep(to_the_right(name))
    for one, other, way in ((left, right, -1), (right, left, 1)):
        let_go = one.snap_off
        touched = other.provenance["events"]["first_contact"]
        assert way * (let_go - touched) > 0.1  # the vibrissa is dragged on
        between = (let_go + touched) / 2
        loaded, free = (
            np.interp(between, *sorted_by_foot(readings)) > 0 for readings in (one, other)
        )
        assert loaded and not free


@pytest.mark.slow
def test_mujoco_shows_the_hysteresis(simulated_rightward):
    """Each sweep lets go beyond the place where the other one touches, and goes on, free."""
    leftward = simulated_sweep("two-circles")
    for one, other, way in (
        (leftward, simulated_rightward, -1),
        (simulated_rightward, leftward, 1),
    ):
        touched = other.table.loc[other.table["phase"] != "free", "foot_x"].iloc[0]
        assert way * (one.snap_off - touched) > 0.1
        after = one.table[way * (one.table["foot_x"] - one.snap_off) > 0]
        assert len(after) > 2
        assert (after["phase"] == "free").all()
        assert (after["status"] == "ok").all()
        assert (after[list(CLAMP_READINGS)].abs() < 1e-9).all(axis=None)


def sorted_by_foot(readings):
    order = np.argsort(readings.values("foot_x"))
    return readings.values("foot_x")[order], readings.values("force_y")[order]


def test_signs(rightward):
    table = rightward.table[rightward.table["phase"] != "free"]
    assert (np.diff(rightward.values("foot_x")) > 0).all()
    assert (table["moment_z"] < 0).all()
    assert (table["force_y"] > 0).all()
    np.testing.assert_allclose(
        table["contact_angle"], np.arctan2(-table["force_x"], table["force_y"]), atol=1e-12
    )
    assert (
        rightward.table["phase"].unique() == ["free", "tangent", "tip"]
    ).all()  # an upright side comes first
    assert rightward.trusted.all()  # certified
    assert certify(rightward).max(axis=None) < 1e-9
    assert list(rightward.table)[: len(COLUMNS)] == list(COLUMNS)
    xi, eta = named_case("two-circles").outline()
    np.testing.assert_allclose(rightward.provenance["contour"], [xi, eta])


@pytest.mark.parametrize("method", [reconstruct, reconstruct_by_decision])
def test_reconstruction(rightward, method):
    found = method(rightward)
    for name in ("contact_x", "contact_y", "contact_angle", "contact_arc_length"):
        np.testing.assert_allclose(found[name], rightward.values(name), atol=1e-7)
    assert (classify(rightward).phase == rightward.table["phase"]).all()


def test_mujoco_agrees(rightward, simulated_rightward):
    found = compare(rightward, simulated_rightward)
    assert found.agrees, found.failures
    for name in CLAMP_READINGS:
        assert found.disagreement[name].rms < 1.2e-3, name  # as to the left
        assert found.disagreement[name].phase in ("tip", "tangent")
    assert abs(found.snap_off.difference) < 3e-4
    assert min(found.phase_agreement().values()) >= 0.99
    for name in ("first_contact", "phase_b_end"):
        assert found.transitions[name].agrees(3e-3)
        assert found.transitions[name].reference == pytest.approx(
            rightward.provenance["events"][name], abs=2e-3
        )


def test_the_window_before_snap_off_is_at_the_far_end(rightward):
    """An error there is not held against the candidate."""
    column = rightward.values("force_x").copy()
    last = np.flatnonzero(rightward.table["phase"] != "free")[-1]
    column[last] *= 1.5
    found = compare(rightward, replace(rightward, table=rightward.table.assign(force_x=column)))
    assert found.disagreement["force_x"].max == 0
    assert found.disagreement["force_x"].max_before_snap_off > 0.1


@pytest.mark.parametrize(
    ("way", "said"),
    [
        ({"start": 0.0, "direction": "right"}, "at most -0.92"),
        ({"stop": -3.0, "direction": "right"}, "more than the start"),
        ({"start": -1.5, "stop": 1.0}, "at least 0.92"),
        ({"direction": "up"}, "sweep.direction = 'up': must be left or right"),
    ],
)
def test_bad_sweeps(way, said):
    with pytest.raises(InputError, match=said):
        Case(profile=circle(1, (0, 0.4)), sweep=Sweep(**way))


@pytest.mark.slow
@pytest.mark.usefixtures("in_turn")
def test_the_measured_budget_of_a_mirrored_case_is_the_same():
    case = replace(named_case("two-circles"), sweep=Sweep(stations=24))
    (one, _), (other, _) = (
        measure_budget(c, Settings(segments=10)) for c in (case, case.mirrored())
    )
    assert one.stations == other.stations
    for name, by_reading in one.parts.items():
        for reading, part in by_reading.items():
            assert other.parts[name][reading].rms == pytest.approx(part.rms, rel=1e-3, abs=1e-8)
