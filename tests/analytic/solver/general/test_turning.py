"""A clamp that turns, leans, or goes any way: against an integration and limits."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from analytic import (
    CLAMP_READINGS,
    WHISK_CASE_NAMES,
    Beam,
    Case,
    ClampPath,
    InputError,
    Readings,
    Sweep,
    Whisk,
    calibrate,
    catenary,
    circle,
    ellipse,
    find_events,
    named_case,
    parabola,
    reconstruct,
    relative_noise,
    solve_sweep,
    turn_back,
    two_circles,
)
from analytic.from_clamp.shape import deflected_shapes
from analytic.problem.quantities import between
from analytic.problem.support import Support
from compare import compare
from compare.simulate.dispatch import simulate
from engines.apart import _sweep
from engines.stations import sweep_stations
from mujoco_models import Settings, simulate_sweep
from mujoco_models.export.whisker import Whisker
from tests.analytic.solver.general.sound import (
    EXACT,
    FORCES,
    PLACES,
    PROFILES,
    assert_confirmed,
    rows,
)

ROWS = rows("beyond_whisking")
MORE = {"contact_y": "contact_y", "phi_contact": "tip_angle"}
EVENTS = {
    "first contact": "first_contact",
    "tangential": "phase_b_start",
    "back to the tip": "phase_b_end",
    "slip-off (fold)": "snap_off",
}
THIN = Beam(radius=0.0)


def way_of(rows):
    """From before the first contact through all rows that are no events, the last one last."""
    inner = rows[rows["event"].isna()]
    if rows["case"].iloc[0] != "dev3":
        angles = [rows["clamp_angle"].iloc[0] - 0.1, *inner["clamp_angle"]]
        return [Whisk(rows["foot_x"].iloc[0], angles[0], angle, 2) for angle in angles[1:]], inner
    p = np.array([-0.2, *inner["p"]])
    # Through its stations, which all lie on a line in the space of poses.
    return [ClampPath(1.5 - 2 * p, 0 * p, -0.5 + 0.8 * p)], inner


@pytest.mark.parametrize(
    "case", [pytest.param("dev0", marks=pytest.mark.slow), *sorted({*ROWS["case"]} - {"dev0"})]
)
def test_references(case):
    rows = ROWS[ROWS["case"] == case]
    profile = PROFILES[rows["profile"].iloc[0]]
    ways, inner = way_of(rows)
    swept = [solve_sweep(Case(THIN, profile, way)) for way in ways]
    table = pd.concat([found.table.iloc[1:] for found in swept])
    assert (table["status"] == "ok").all()
    np.testing.assert_array_equal(table["phase"], inner["state"])
    for reference, column in (FORCES | PLACES | MORE).items():
        np.testing.assert_allclose(table[column], inner[reference], **EXACT)
    far = {"sweep": Whisk(rows["foot_x"].iloc[0], ways[0].start, 3.0)} if len(ways) > 1 else None
    if far is None:
        p = np.linspace(-0.2, 2.0, 5)
        far = {"sweep": ClampPath(1.5 - 2 * p, 0 * p, -0.5 + 0.8 * p)}
    events = solve_sweep(Case(THIN, profile, **far)).provenance["events"]
    for _, row in rows.dropna(subset="event").iterrows():
        name = EVENTS.get(row["event"], "snap_off")
        travelled = np.hypot(2, 0.8) * (row["p"] + 0.2)
        value = row["clamp_angle"] if len(ways) > 1 else travelled
        # dev1's Phase B ends 1e-4 rad before the fold.
        assert events[name] == pytest.approx(value, rel=1e-11)


@pytest.mark.slow
@settings(max_examples=12, deadline=None)
@given(
    st.sampled_from(sorted(PROFILES)),
    st.floats(0.2, 0.9),
    st.sampled_from([0.0, -0.3, 0.2]),
    st.sampled_from([0.0, 0.2]),
    st.sampled_from([np.inf, 8.0]),
    st.sampled_from([None, 0.002]),
)
def test_whisks_meet_an_integration_and_their_mirror_image(
    profile, foot, natural, friction, stiffness, tip
):
    beam = Beam(natural_curvature=natural, tip_radius=tip)
    held = {"clamp_stiffness": stiffness, "friction": friction}
    try:
        case = Case(beam, PROFILES[profile], Whisk(foot, -1.3, 1.9, 40), **held)
    except InputError:
        assume(False)
    # Forces of 100 EI/L^2 where it is nearly let go: rounding of the clamp's readings, marched.
    readings, found, touching = assert_confirmed(case, integrated=1e-9, mirrored=1e-11, seen=1e-8)
    assert touching.sum() > 3
    apart = found["contact_angle"] - readings.table["contact_angle"]
    np.testing.assert_allclose(apart[touching], 0, atol=1e-8)


@pytest.mark.parametrize("friction", [0.0, 0.1])
def test_a_path_along_the_line_is_a_sweep(friction):
    case = Case(Beam(natural_curvature=-0.2), sweep=Sweep(30), friction=friction)
    line = ClampPath(case.foot_x, np.zeros(30), np.zeros(30))
    sweep, path = solve_sweep(case), solve_sweep(Case(case.beam, sweep=line, friction=friction))
    for name in (*CLAMP_READINGS, "contact_x", "tip_angle"):
        np.testing.assert_allclose(path.values(name), sweep.values(name), atol=1e-12)
    assert case.foot_x[0] - path.snap_off == pytest.approx(sweep.snap_off, abs=1e-12)


def test_a_path_that_lifts_the_foot_is_a_sweep_past_a_lower_object():
    x = np.linspace(2.8, -2.7, 200)
    lifted = solve_sweep(Case(sweep=ClampPath(x, np.full(200, 0.05), np.zeros(200))))
    low = solve_sweep(Case(profile=catenary(0.5, -0.85), sweep=Sweep(200, x[0], x[-1])))
    np.testing.assert_allclose(lifted.values("moment_z"), low.values("moment_z"), atol=1e-12)
    np.testing.assert_allclose(lifted.values("contact_y"), low.values("contact_y") + 0.05)


def test_out_and_back_lets_go_where_it_touched():
    x = np.concatenate([np.linspace(2.6, 0.8, 60), np.linspace(0.8, 2.6, 60)[1:]])
    found = solve_sweep(Case(sweep=ClampPath(x, 0 * x, 0 * x)))
    moment = found.values("moment_z")
    np.testing.assert_allclose(moment, moment[::-1], atol=1e-11)
    events = found.provenance["events"]
    assert events["first_contact"] + events["snap_off"] == pytest.approx(3.6, abs=1e-9)


def test_a_tip_that_comes_head_on_touches():
    """No place of the contour passes beside it: it went through the object, free and "ok"."""
    up, none = np.linspace(-0.2, 0.15, 12), np.zeros(12)
    case = Case(profile=circle(0.5, (0.0, 0.9)), sweep=ClampPath(none + 0.1, up, none))
    readings, _, touching = assert_confirmed(case, integrated=1e-10, seen=1e-9)
    first = 1.4 - np.sqrt(0.505**2 - 0.1**2) - 1  # of the foot, where the round tip touches
    assert readings.provenance["events"]["first_contact"] == pytest.approx(first + 0.2, abs=1e-9)
    np.testing.assert_array_equal(touching, up > first)


@pytest.mark.parametrize("name", WHISK_CASE_NAMES)
def test_named_cases_start_and_end_free(name):
    readings = solve_sweep(named_case(name))
    phase = readings.table["phase"]
    assert (readings.table["status"] == "ok").all()
    assert list(phase.iloc[[0, -1]]) == ["free", "free"]
    x, y = deflected_shapes(readings)
    touching = phase.ne("free").to_numpy()
    place = readings.values("contact_x", "contact_y")[touching, :, None]
    beside = np.hypot(x[touching] - place[:, 0], y[touching] - place[:, 1])
    np.testing.assert_allclose(beside.min(axis=1), 0.005, atol=1e-6)
    angle = reconstruct(readings)["contact_angle"]
    np.testing.assert_allclose(
        angle[touching], readings.values("contact_angle")[touching], atol=1e-9
    )
    noisy = reconstruct(readings, relative_noise(readings, 0.01))
    # Of the first ones the force drowns in noise of that size.
    assert noisy["uncertainty"][phase == "tangent"].median() < 0.05


def test_readings_keep_their_way_in_a_file(tmp_path):
    readings = solve_sweep(named_case("whisk-catenary"))
    again = Readings.read(readings.write(tmp_path / "whisk.parquet"))
    assert again.running == "clamp_angle"
    assert again.snap_off == readings.snap_off == pytest.approx(1.7137, abs=1e-4)
    assert Readings.of(again.mirrored().table).runs_right


# With its other side it lies down on the object; it was free in it, and "ok".
BEHIND = ClampPath([-0.108, -0.096, -0.08, -0.032], [-0.035, 0.002, 0.052, 0.244],
                   [-0.402, -0.316, -0.195, 0.352])  # fmt: skip

BAD = {
    "start of the clamp's way": lambda: Case(sweep=Whisk(0.6, 0.0, 1.0)),
    "whisk.stop": lambda: Whisk(0.0, 0.5, 0.5),
    "whisk.start": lambda: Whisk(0.0, np.nan, 0.5),
    "clamp path = of foot_x 3": lambda: ClampPath([1, 2, 3], [0, 0], [0, 0]),
    r"clamp path: foot_y\[1\]": lambda: ClampPath([1, 2], [0, np.inf], [0, 0]),
    "clamp path = the same": lambda: ClampPath([1, 1], [0, 0], [0, 0]),
    "clamp_angle = 0.1": lambda: Case(sweep=Whisk(0.6, -1.2, 1.0), clamp_angle=0.1),
    "way of the clamp = .* from behind": lambda: Case(
        profile=ellipse((0.19, 0.75), (0, 0.49)), sweep=BEHIND
    ),
    "height of the lowest point": lambda: Case(sweep=ClampPath([2, 1], [0, 0.3], [0, 0])),
}


@pytest.mark.parametrize("said", BAD)
def test_what_cannot_be_is_one_line(said):
    with pytest.raises(InputError, match=said) as caught:
        BAD[said]()
    assert "\n" not in str(caught.value)


def test_who_knows_no_way_but_a_sweep_says_so():
    case = named_case("whisk-catenary")
    readings = solve_sweep(case)
    plain = solve_sweep(named_case("catenary"))
    for refused in (
        lambda: simulate_sweep(case, Settings(beam="rod", planar=False)),
        lambda: simulate(case, Settings(), engine="dart"),
        lambda: compare(readings, readings, offset="auto"),
        lambda: calibrate(readings, case, ["flexural_rigidity"]),
        lambda: calibrate(plain, case, ["flexural_rigidity"]),
        lambda: turn_back(Case(sweep=case.sweep, friction=0.1), 0.0),
        lambda: between(case, 1.0, 0.0),
        lambda: reconstruct(readings, method="decision"),
    ):
        with pytest.raises(InputError, match=r"along its line|Sweep"):
            refused()
    assert "along its line" in str(_sweep("dart", case, Settings()))


SMOOTH = catenary(0.5, -0.8), parabola(0.5, 0.5), two_circles()


@pytest.mark.slow
@settings(max_examples=12, deadline=None)
@given(
    st.sampled_from(SMOOTH),
    st.floats(-0.6, 0.6),
    st.sampled_from([0.0, -0.3, 0.2]),
    st.sampled_from([0.0, 0.1]),
    st.sampled_from([np.inf, 8.0]),
)
def test_sweeps_meet_an_integration_and_their_mirror_image(
    profile, angle, natural, friction, stiffness
):
    """DOP853 from the clamp to the contact shares nothing with the solver."""
    beam = Beam(natural_curvature=natural)
    held = Support(stiffness, friction, angle)
    case = Case(beam, profile, Sweep(40), **held._asdict())
    # Forces of some 100 EI/L^2 next to the fold: rounding of the clamp's readings, marched.
    readings, _, _ = assert_confirmed(case, integrated=1e-10, seen=1e-9)
    assert readings.support == held
    assert readings.table["status"].isin(["ok", "sticks"])[:5].all()


def test_first_contact_is_that_of_a_leaning_rod():
    """Its tip is at (-sin, cos) of the angle from the foot."""
    for angle in (-0.5, 0.4):
        first = find_events(parabola(0.5, 0.5), clamp_angle=angle, beam=Beam(radius=0.0))
        height = np.cos(angle)
        x = np.sqrt((height - 0.5) / 0.5)
        assert first.first_contact.foot_x == pytest.approx(x + np.sin(angle), abs=1e-12)
        assert first.first_contact.tip_angle == pytest.approx(np.pi / 2 + angle, abs=1e-12)


@pytest.mark.parametrize("angle", [1.6, -2.0, np.nan, np.inf, "steep"])
def test_a_clamp_that_would_lie_on_the_foot_line_is_refused(angle):
    with pytest.raises(InputError, match="clamp_angle"):
        Case(clamp_angle=angle)


def test_an_overhang_at_rest_is_refused():
    with pytest.raises(InputError, match=r"clamp_angle = 1\.2, where the vibrissa at rest"):
        Case(Beam(natural_curvature=0.6), clamp_angle=1.2)


def test_who_cannot_lean_says_so():
    case = replace(named_case("catenary"), clamp_angle=0.1)
    for refused in (
        lambda: sweep_stations(case, lambda _: None, "mine", {}),
        lambda: Whisker(case, Settings(), None, 1.0).spec(),
        lambda: simulate_sweep(case, Settings(planar=False)),
        lambda: reconstruct(solve_sweep(replace(case, sweep=Sweep(9))), method="decision"),
    ):
        with pytest.raises(InputError, match=r"clamp_angle|leans"):
            refused()
