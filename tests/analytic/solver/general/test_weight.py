"""A vibrissa that has a weight: readings, events, limits and checks by integration."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from analytic import (
    Beam,
    Case,
    ClampPath,
    Sweep,
    certify,
    circle,
    find_events,
    reconstruct,
    solve_contact,
    solve_sweep,
)
from analytic.from_clamp.shape import deflected_shapes
from analytic.problem.errors import InputError
from analytic.problem.table import as_table
from analytic.solver.general.sweep import solve
from tests.analytic.solver.general.sound import (
    EXACT,
    FORCES,
    PLACES,
    PROFILES,
    assert_confirmed,
    rows,
)

ROWS = rows("beyond_gravity")
THIN = Beam(radius=0.0)
BUCKLES = 7.837347438943  # w L^3/EI = 9/4 j^2, j the first zero of the Bessel function J_-1/3


@pytest.mark.parametrize(
    "of_case",
    [
        pytest.param(rows, marks=pytest.mark.slow if i else ())
        for i, (_, rows) in enumerate(ROWS.groupby("case"))
    ],
    ids=len,
)
def test_references(of_case):
    first = of_case.iloc[0]
    profile, weight = PROFILES[first["profile"]], (first["weight_x"], first["weight_y"])
    events = find_events(profile, THIN, weight=weight)
    found = {
        "first contact": events.first_contact,
        "tangential": events.phase_b_start,
        "back to the tip": events.phase_b_end,
        "snap-off (fold)": events.snap_off,
    }
    columns = solve(Case(THIN, profile, weight=weight), of_case["foot_x"].to_numpy()).columns
    table = as_table(columns)
    for number, (_, row) in enumerate(of_case.iterrows()):
        named = found.get(row["event"]) or table.iloc[number]
        at_fold = row["event"] == "snap-off (fold)"
        exact = {"rtol": 1e-7, "atol": 1e-7} if at_fold else EXACT
        np.testing.assert_allclose(named.foot_x, row["foot_x"], **EXACT)
        for reference, column in (FORCES | PLACES).items():
            np.testing.assert_allclose(getattr(named, column), row[reference], **exact)


def test_what_touches_nothing_hangs_from_its_clamp():
    table = solve_sweep(Case(sweep=Sweep(10), weight=(0.5, -1.0))).table
    free = table[table["phase"] == "free"].iloc[0]
    assert (free["force_x"], free["force_y"]) == (-0.5, 1.0)
    assert free["moment_z"] > 0.25  # the wind alone would make it w/2
    assert free["tip_angle"] < np.pi / 2


def test_a_small_weight_counts_in_proportion():
    profile = PROFILES["circle(1,(0,0.4))"]
    alpha = np.array([0.9, 0.3, -0.2])
    plain, light, heavy = (
        solve_contact(profile, alpha, weight=(0.0, w)) for w in (0.0, -1e-5, -2e-5)
    )
    for column in ("force_x", "force_y", "moment_z", "foot_x"):
        once, twice = light[column] - plain[column], heavy[column] - plain[column]
        np.testing.assert_allclose(twice, 2 * once, atol=1e-9)


def test_a_vertical_vibrissa_buckles_under_its_weight():
    Case(weight=(0.0, -BUCKLES * (1 - 1e-9)))
    with pytest.raises(InputError, match=r"weight = .*which buckles it at rest"):
        Case(weight=(0.0, -BUCKLES * (1 + 1e-9)))
    Case(weight=(0.0, 3 * BUCKLES / 2))  # hanging, it never does


@pytest.mark.parametrize(
    ("weight", "why"),
    [
        ((0.0, -21.0), r"weight\.y = -21.*between -20 and 20"),
        ((3.0, -9.9), r"weight = .*turns it by 1\.6.*at rest: must be"),
        ((np.nan, 0.0), r"weight\[0\] = nan"),
        (3.0, "weight = 3.0: must be two numbers"),
    ],
)
def test_a_weight_that_cannot_be(weight, why):
    with pytest.raises(InputError, match=why):
        Case(weight=weight)


def test_who_cannot_do_with_a_weight_says_so():
    path = ClampPath(foot_x=[3, 2, 1], foot_y=[0, 0, 0], clamp_angle=[0, 0.1, 0.2])
    with pytest.raises(InputError, match=r"weight = .*where the clamp turns"):
        Case(sweep=path, weight=(0.0, -1.0))
    with pytest.raises(InputError, match="weight_y = -1"):
        reconstruct(solve_sweep(Case(sweep=Sweep(5), weight=(0.0, -1.0))), method="decision")


VARIED = [
    Case(sweep=Sweep(12), friction=0.3, clamp_stiffness=5.0, weight=(0.5, -1.0)),
    Case(sweep=Sweep(12, direction="right"), clamp_angle=0.2, weight=(0.5, -3.0)),
    Case(Beam(natural_curvature=1.1), sweep=Sweep(20), weight=(-0.3, -2.0)),
    Case(
        Beam(natural_curvature=lambda s: 0.3 * s),
        circle(1.0, (0, 0.4)),
        Sweep(12),
        weight=(-0.3, 3.0),
    ),
    Case(
        Beam(0.1, 1e-4, 0.002, tip_radius=0.0008, natural_curvature=5.0),
        circle(0.1, (0, 0.04)),
        Sweep(12),
        weight=(0.0, -0.1),
    ),
]


@pytest.mark.slow
@pytest.mark.parametrize("case", VARIED, ids=lambda case: f"{case.weight}")
def test_integration_from_the_clamp_to_the_tip_confirms_it(case):
    readings, found, _ = assert_confirmed(case, integrated=1e-11, seen=1e-12)
    assert (readings.table["status"] == "ok").all()
    assert list(found["phase"]) == list(readings.table["phase"])
    x, y = deflected_shapes(readings)
    lengths = np.hypot(np.diff(x, axis=1), np.diff(y, axis=1)).sum(axis=1)
    np.testing.assert_allclose(lengths, case.beam.length, rtol=1e-3)


def test_a_certificate_shows_a_wrong_weight():
    readings = solve_sweep(Case(sweep=Sweep(12), weight=(0.0, -1.0)))
    readings.provenance["support"]["weight_y"] = -1.0001
    assert (certify(readings).max(axis=1) > 1e-6).all()


@pytest.mark.slow
@settings(max_examples=15, deadline=None)
@given(
    st.sampled_from(list(PROFILES.values())),
    st.floats(0, 6),
    st.floats(-np.pi, np.pi),
    st.floats(-0.4, 0.4),
    st.floats(0, 0.4),
)
def test_random_weights_against_an_integration(profile, size, direction, natural, friction):
    weight = size * np.sin(direction), -size * np.cos(direction)
    try:
        case = Case(
            Beam(natural_curvature=natural),
            profile,
            Sweep(12),
            weight=weight,
            friction=friction,
        )
        readings = solve_sweep(case)
    except InputError:
        assume(False)
    good = readings.table["status"].isin(["ok", "sticks"])
    assert not (readings.table["status"] == "diverged").any()
    assert certify(readings)[good].max(axis=None) < 1e-11
