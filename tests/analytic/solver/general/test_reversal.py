"""Hysteresis of a vibrissa that rubs."""

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic import (
    Beam,
    Case,
    InputError,
    Readings,
    Sweep,
    catenary,
    certify,
    circle,
    find_events,
    parabola,
    polygon,
    solve_sweep,
    stiction_limits,
    turn_back,
)

ROUGH = Case(profile=catenary(0.5, -0.8), sweep=Sweep(60), friction=0.3)
REAL = Case(
    Beam(natural_curvature=-0.4, radius=0.01),
    circle(1.0, lowest=(0, 0.4)),
    Sweep(60),
    clamp_stiffness=6.0,
    friction=0.25,
)
SQUARE = replace(
    REAL, profile=polygon([(-0.6, 0.45), (0.7, 0.4), (0.9, 1.5), (-0.5, 1.6)]), friction=0.2
)

BOWED = Beam(radius=0.02, tip_radius=0.006, natural_curvature=lambda s: -0.6 * s)
VARYING = replace(SQUARE, beam=BOWED, friction=0.2)


def certified(case, table, coefficient):
    """The largest miss of some rows, by integration from the clamp; `table` of one friction."""
    readings = Readings(table.drop(columns=["friction_angle", "sliding"]), case.beam)
    support = {"clamp_stiffness": None, "friction": coefficient}
    if case.clamp_stiffness < math.inf:
        support["clamp_stiffness"] = case.clamp_stiffness
    return certify(replace(readings, provenance={"support": support})).max(axis=None)


@pytest.mark.parametrize(
    "case", [ROUGH, REAL, SQUARE, pytest.param(VARYING, marks=pytest.mark.slow)]
)
def test_it_sticks_between_the_limits(case):
    table = turn_back(case, 0.0, 4000)
    limit = math.atan(case.friction)
    on, back = table["sliding"] == "on", table["sliding"] == "back"
    sticks = table["sliding"] == "sticks"
    assert on.sum() == 1 and sticks.sum() > 5 and back.sum() > 1000
    assert table["friction_angle"][on].iloc[0] == pytest.approx(limit)
    np.testing.assert_allclose(table["friction_angle"][back], -limit)
    angle = np.append(limit, table["friction_angle"][sticks])
    assert (np.diff(angle) < 0).all() and angle[-1] > -limit
    # From row to row the moment changes as little as foot and angle do: no jump.
    held = (on | sticks | back).to_numpy()
    moment = table["moment_z"].to_numpy()[held]
    assert np.abs(np.diff(moment)).max() < 0.1 * np.abs(moment).max()
    # And every sticking state balances.
    rows = table[sticks].iloc[::3]
    for _, row in rows.iterrows():
        one = row.to_frame().T.infer_objects()
        two = table.loc[[one.index[0], one.index[0]]].assign(
            foot_x=[row["foot_x"], row["foot_x"] - 1e-300]
        )
        assert certified(case, two, math.tan(row["friction_angle"])) < 1e-9


def test_what_rolls_does_not_slide():
    """The contact goes as far along the object as along the vibrissa, in Phase B of a thin one."""
    thin = replace(ROUGH, beam=Beam(radius=0.0))
    table = turn_back(thin, 0.0, 4000)
    rows = table[table["sliding"].isin(["on", "sticks"])]
    assert (rows["phase"] == "tangent").all() and len(rows) > 5
    # Arc length of cosh(x/2) - 0.8, from its curvature: d(alpha)/ds = 0.5/(...); by quadrature.
    xi = rows["contact_x"].to_numpy()
    s = np.array([np.trapezoid(np.hypot(1, 0.5 * np.sinh(g / 2)), g) for g in
                  (np.linspace(xi[0], x, 2001) for x in xi)])  # fmt: skip
    along = (rows["contact_arc_length"] - rows["contact_arc_length"].iloc[0]).to_numpy()
    np.testing.assert_allclose(along, s, atol=1e-9)


@pytest.mark.slow
def test_what_varies_does_not_slide_either():
    """Along a straight edge of the object, and the same on the side of a cone that is curved."""
    table = turn_back(VARYING, 0.2, 1000)
    rows = table[table["sliding"].isin(["on", "sticks"])]
    assert (rows["phase"] == "tangent").all() and len(rows) > 5
    assert np.ptp(rows["contact_angle"]) < 1e-12  # one edge
    # The side of the cone at rest: spheres about its axis, of which the envelope is touched.
    s = np.linspace(rows["contact_arc_length"].min(), rows["contact_arc_length"].max(), 4001)
    slope, radius = math.pi / 2 - 0.3 * s**2, 0.02 - 0.014 * s
    step = np.diff(s) / 2
    x, y = (
        np.append(0, np.cumsum(step * (f[1:] + f[:-1]))) for f in (np.cos(slope), np.sin(slope))
    )
    side = slope - math.asin(0.014)
    x, y = x - radius * np.sin(side), y + radius * np.cos(side)
    way = np.append(0, np.cumsum(np.hypot(np.diff(x), np.diff(y))))
    passed = np.interp(rows["contact_arc_length"], s, way)
    first = rows.iloc[0]
    on_edge = np.hypot(
        rows["contact_x"] - first["contact_x"], rows["contact_y"] - first["contact_y"]
    )
    assert on_edge.max() > 1e-5
    np.testing.assert_allclose(
        passed - passed[0], np.copysign(on_edge, passed - passed[0]), atol=1e-9
    )


def test_the_tip_of_a_thin_vibrissa_stays_where_it_is():
    tip = Case(Beam(radius=0.0), parabola(0.5, 0.7), Sweep(60), friction=0.3)
    table = turn_back(tip, 0.3, 2000)
    sticks = table[table["sliding"].isin(["on", "sticks"])]
    assert (sticks["phase"] == "tip").all() and len(sticks) > 5
    assert np.ptp(sticks["contact_x"]) < 1e-12 and np.ptp(sticks["contact_angle"]) < 1e-12


def test_back_it_is_the_sweep_with_the_other_friction():
    """And leaves the object where it first touched it."""
    table = turn_back(ROUGH, 0.0, 200)
    _, limit = stiction_limits(replace(ROUGH, sweep=Sweep(200, table["foot_x"].iloc[-1], 0.0)))
    back = table[table["sliding"] == "back"]
    there = limit.iloc[::-1].reset_index(drop=True)
    for name in ("foot_x", "force_x", "force_y", "moment_z", "contact_x"):
        np.testing.assert_allclose(back[name], there[name][back.index], atol=1e-9)
    assert certified(ROUGH, back.iloc[::-1].reset_index(drop=True), -0.3) < 1e-9
    free = table["foot_x"][table["sliding"] == "free"].min()
    touch = find_events(ROUGH.profile, friction=0.3).first_contact.foot_x
    assert touch <= free < touch + 0.03


def test_limits_of_stiction():
    onward, back = stiction_limits(REAL)
    exact = solve_sweep(REAL).table
    for name in ("force_x", "force_y", "moment_z", "contact_x", "tip_angle"):
        np.testing.assert_allclose(onward[name], exact[name], rtol=1e-10, atol=1e-10)
    both = (onward["phase"] != "free") & (back["phase"] != "free")
    assert both.sum() > 40
    # About to slide back the contact lies further on than about to slide on.
    assert (back["contact_x"] < onward["contact_x"])[both].all()
    less = replace(REAL, friction=1e-9)
    near, far = stiction_limits(less)
    np.testing.assert_allclose(near["moment_z"], far["moment_z"], atol=1e-6)


def test_to_the_right_it_is_the_mirror_image():
    one, other = turn_back(ROUGH, 0.1, 50), turn_back(ROUGH.mirrored(), -0.1, 50)
    np.testing.assert_allclose(other["force_x"], -one["force_x"], atol=1e-9)
    np.testing.assert_allclose(other["friction_angle"], -one["friction_angle"], atol=1e-9)
    assert (one["sliding"] == other["sliding"]).all()


def test_shortly_before_the_snap_off_what_is_not_solved_says_so():
    end = find_events(ROUGH.profile, friction=0.3).snap_off.foot_x
    table = turn_back(ROUGH, end + 0.05, 300)
    unsolved = table["sliding"] == "unsolved"
    assert unsolved.any()
    assert table.loc[unsolved, ["force_x", "moment_z", "contact_x"]].isna().all(axis=None)


@pytest.mark.parametrize(
    ("ask", "said"),
    [
        (lambda: turn_back(replace(ROUGH, friction=0.0), 0.0), "friction = 0.0: must be positive"),
        (lambda: turn_back(ROUGH, 3.0), "turn_at = 3.0: must be from"),
        (lambda: turn_back(ROUGH, math.nan), "turn_at = nan"),
        (lambda: stiction_limits(catenary(0.5, -0.8)), "case"),
        (lambda: stiction_limits(replace(ROUGH, friction=0.0)), "nothing sticks"),
    ],
)
def test_bad_input_is_one_line(ask, said):
    with pytest.raises(InputError) as error:
        ask()
    assert said in str(error.value) and "\n" not in str(error.value)
