"""MuJoCo in space against the closed form, and its stiffness against its own moments."""

import mujoco
import numpy as np
import pytest

from analytic import Beam, InputError, catenary, circle, parabola
from analytic.space import (
    FootPath,
    SpatialCase,
    cylinder,
    ellipsoid,
    prism,
    reconstruct_space,
    solve_space,
    sphere,
)
from analytic.space.problem.readings import CONTACT_POINT, FORCE, MOMENT
from mujoco_models import DivergedError, Settings, SpatialSettings, simulate_space
from mujoco_models.beams.cable import Cable
from mujoco_models.beams.spatial import SpatialChain
from mujoco_models.space.balance import Balance, State
from mujoco_models.space.sweep import compiled

BALL = sphere(1.0, (0.0, 1.4, 0.0))
CASES = {
    "sphere": (BALL, [[1.3, 0.3], [-1.5, 0.2]], (0, 1, 0)),
    "leaning": (BALL, [[1.3, 0.02], [-1.5, 0.05]], (0.2, 1, 0.1)),
    "ellipsoid": (ellipsoid((1, 0.7, 1.6), (0, 1.1, 0)), [[1.5, 0.3], [-1.5, -0.1]], (0.1, 1, 0)),
    "cylinder": (cylinder(0.3, (0, 0.8, 0), (0.2, 0.1, 1)), [[1.0, 0.0], [-1.0, 0.5]], (0, 1, 0)),
    "prism": (prism(catenary(0.5, -0.8), (0.2, 0.1, 1)), [[2.5, 0.0], [-1.0, 0.5]], (0, 1, 0)),
}


def case_of(name, stations=30, beam=None):
    body, points, tangent = CASES[name]
    path = FootPath(points, tangent=tangent, stations=stations)
    return SpatialCase(beam or Beam(), body=body, path=path)


def worst_rms(reference, candidate):
    """Of the six components, over the largest of force or of moment."""
    both = reference.touching & candidate.touching
    found = []
    for names in (FORCE, MOMENT):
        exact, other = (r.values(*names)[both] for r in (reference, candidate))
        found.append(np.sqrt(((other - exact) ** 2).mean(axis=0)).max() / np.abs(exact).max())
    return max(found)


def left(readings):
    """Where the vibrissa slips off."""
    return [e["travel"] for e in readings.provenance["events"] if e["kind"] == "slip-off"]


@pytest.mark.parametrize(
    ("beam", "joints"), [("chain", "ball"), ("chain", "universal"), ("rod", "universal")]
)
def test_the_stiffness_is_the_derivative_of_mujocos_own_moments(beam, joints):
    if beam == "rod" and mujoco.__version__ < "4":
        pytest.skip("MuJoCo 3 has no elastic one-dimensional flex")
    model = compiled(case_of("sphere"), SpatialSettings(beam=beam, joints=joints, segments=12))
    balance, random = Balance(model, 1e-8), np.random.default_rng(0)
    size, foot, force = model.model.nv, np.array([0.6, 0.0, 0.25]), 3.0
    bent = model.straight.copy()
    mujoco.mj_integratePos(model.model, bent, 0.05 * random.normal(size=size), 1.0)

    def system(configuration):
        model.place(foot, configuration)
        tip = len(model.ends) - 1
        state = State(configuration, tip, 0.98, force, True)
        touch = model.touch(tip, 0.98)
        return balance.linearised(state, touch, 0.0, model.turning(tip, touch))

    step, columns = 1e-5, []
    for i in range(size):
        sides = []
        for sign in (1, -1):
            moved = bent.copy()
            mujoco.mj_integratePos(model.model, moved, sign * step * np.eye(size)[i], 1.0)
            found = system(moved)
            sides.append(-found.springs - force * found.push)
        columns.append((sides[0] - sides[1]) / (2 * step))
    ours, differences = system(bent).stiffness, np.array(columns)
    # Moments about a ball's own axes turn with it: only the symmetric part is the energy's.
    differences = (differences + differences.T) / 2
    assert np.abs(ours - differences).max() < 1e-7 * np.abs(ours).max()


@pytest.mark.parametrize("name", ["sphere", pytest.param("leaning", marks=pytest.mark.slow)])
def test_smooth_bodies_agree_with_the_closed_form(name):
    case = case_of(name)
    exact, found = solve_space(case), simulate_space(case, SpatialSettings(segments=20))
    assert (found.table["status"] == "ok").all()
    assert found.table["residual"].max() < 1e-8 * (1 + np.nanmax(np.abs(exact.values(*FORCE))))
    assert found.table["discrepancy"].max() < 1e-8
    assert (found.touching == exact.touching).all()
    assert worst_rms(exact, found) < 1e-3
    assert (found.table["phase"] == exact.table["phase"]).mean() > 0.96
    on = exact.touching
    apart = np.linalg.norm(
        (found.values(*CONTACT_POINT) - exact.values(*CONTACT_POINT))[on], axis=1
    )
    assert apart.max() < 2e-3


# Flat within reach, touched on the side above its widest place, and at the widest place itself.
FLAT = prism(parabola(0.005, 0.6), (0.1, 0.05, 1)), [[9.8, 0.1], [7.4, 0.0]]
BESIDE = prism(circle(0.17, (0.0, 0.594)), (0.368, 0.412, 0.834)), [[0.4, 0.02], [-0.4, 0.01]]
UPRIGHT = prism(circle(0.1, (0.0, 0.5))), [[0.12, 0.0], [-0.9, 0.0]]


@pytest.mark.slow
@pytest.mark.parametrize(("body", "points"), [FLAT, BESIDE, UPRIGHT])
def test_prisms_are_touched_where_they_are_flat(body, points):
    """A cylinder of 100 L was off by more than rest allows, a side had none, and one lost hold."""
    case = SpatialCase(Beam(radius=2e-3), body=body, path=FootPath(points, stations=15))
    exact, found = solve_space(case), simulate_space(case, SpatialSettings(segments=20))
    assert (found.table["status"] == "ok").all()
    assert (found.touching == exact.touching).all() and exact.touching.sum() > 4
    assert worst_rms(exact, found) < 2e-3
    for ours, theirs in zip(left(found), left(exact), strict=True):
        assert ours == pytest.approx(theirs, abs=2e-3)


def test_normals_of_a_flat_prism_turn_as_its_contour_does():
    """Not as those of the smaller cylinder that MuJoCo has in its place."""
    case = SpatialCase(Beam(radius=2e-3), body=FLAT[0], path=FootPath(FLAT[1]))
    model = compiled(case, SpatialSettings(segments=6))
    model.place(np.array([0.0, -0.35, 0.0]), model.straight)
    touch = model.touch(5, 1.0)
    spot = FLAT[0].nearest(touch.centre, 0.0)
    assert 0 < np.trace(spot.turning) < 0.02
    # This bead is 0.05 L inside, which is 5e-3 of the cylinder's 10 L.
    assert np.trace(model.turning(5, touch)) == pytest.approx(np.trace(spot.turning), rel=1e-2)


@pytest.mark.slow
@pytest.mark.parametrize("name", list(CASES))
def test_forty_segments_are_within_3e_3_of_the_closed_form(name):
    case = case_of(name, 60)
    exact, found = solve_space(case), simulate_space(case)
    assert (found.table["status"] != "unsettled").all()
    assert worst_rms(exact, found) < 1e-3
    for ours, theirs in zip(left(found), left(exact), strict=True):
        assert ours == pytest.approx(theirs, abs=5e-3)
    points = reconstruct_space(found)[list(CONTACT_POINT)].to_numpy()
    both = exact.touching & found.touching
    apart = np.linalg.norm((points - exact.values(*CONTACT_POINT))[both], axis=1)
    assert np.sqrt((apart**2).mean()) < 2e-3


@pytest.mark.slow
@pytest.mark.parametrize("semi_axes", [(0.5, 0.35, 0.8), (0.38, 0.06, 0.19)])
def test_past_any_ellipsoid_it_rests_as_well_as_mujoco_has_distances(semi_axes):
    """Just after the touch their error is most of the force; a steep branch is no hop."""
    body = ellipsoid(semi_axes, (0, semi_axes[1] + 0.55, 0))
    path = FootPath([[0.75, 0.15], [-0.95, -0.05]], tangent=(0.1, 1, 0.05), stations=60)
    case = SpatialCase(Beam(radius=5e-3), body=body, path=path)
    found, exact = simulate_space(case), solve_space(case)
    assert set(found.table["status"]) <= {"ok", "slipped off"}
    kinds = [[e["kind"] for e in r.provenance["events"]] for r in (found, exact)]
    assert kinds[0] == kinds[1]


@pytest.mark.slow
def test_the_chain_is_of_second_order():
    case = case_of("sphere", 40)
    exact = solve_space(case)
    errors = [
        worst_rms(exact, simulate_space(case, SpatialSettings(segments=n))) for n in (10, 20, 40)
    ]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (np.abs(orders - 2) < 0.5).all(), (errors, orders)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("body", "points"),
    [
        (BALL, [[1.3, 0.0], [-1.5, 0.0]]),
        (ellipsoid((1, 0.7, 1.6), (0, 1.1, 0)), [[1.5, 0.0], [-1.5, 0.0]]),
        (prism(parabola(2, 0.4), (0.1, 0.3, 1)), [[1.5, 0.0], [-1.5, 0.3]]),
    ],
)
def test_where_it_slips_off(body, points):
    """On the axis of a sphere the vibrissa is a pendulum on its head; it drops to either side."""
    case = SpatialCase(body=body, path=FootPath(points, stations=40))
    exact, found = left(solve_space(case)), left(simulate_space(case))
    assert len(exact) == 1
    assert found == pytest.approx(exact, abs=5e-3)


@pytest.mark.slow
def test_where_it_slips_off_hangs_on_no_distance_between_stations():
    """Beyond, the vibrissa is stable on the other side: a long step would go on there."""
    body = ellipsoid((1.54, 0.327, 0.456), (0, 0.737, 0))
    found = {}
    for stations in (60, 20, 15, 10):
        path = FootPath([[0.8, 3.11], [-0.8, -2.67]], 0.0, (0.11, 1, 0.09), stations)
        case = SpatialCase(body=body, path=path)
        found[stations] = left(simulate_space(case, SpatialSettings(segments=10)))
        assert found[stations] == pytest.approx(found[60], abs=2e-5), stations
    assert left(solve_space(case)) == pytest.approx(found[60], abs=5e-3)


@pytest.mark.slow
def test_balls_and_universal_joints_agree_and_so_does_the_rod():
    case = case_of("sphere", 40)
    ball, universal = (
        simulate_space(case, SpatialSettings(joints=joints)) for joints in ("ball", "universal")
    )
    assert worst_rms(ball, universal) < 3e-4
    if mujoco.__version__ >= "4":
        rod = simulate_space(case, SpatialSettings(beam="rod", joints="universal"))
        assert worst_rms(solve_space(case), rod) < 1e-3


@pytest.mark.skipif(mujoco.__version__ >= "4", reason="MuJoCo 4 has no composite cable")
def test_the_cable_is_the_chain_on_balls():
    """Turned alike, its balls have the chain's moments, each over its own stiffness."""
    turns = 0.05 * np.random.default_rng(0).normal(size=(30, 3))
    found = []
    # The cable's segments are along their own x axis, the chain's links along y.
    for beam, swap in (
        (
            Cable(Settings(beam="cable", segments=40), np.inf),
            np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]]),
        ),
        (SpatialChain(Settings(segments=40), np.inf), np.eye(3)),
    ):
        model = beam.spec(0.005).compile()
        data, velocity = mujoco.MjData(model), np.zeros((model.nv // 3, 3))
        velocity[:30] = turns @ swap.T
        mujoco.mj_integratePos(model, data.qpos, velocity.ravel(), 1.0)
        mujoco.mj_forward(model, data)
        moments = data.qfrc_passive.reshape(-1, 3)[:30] @ swap
        found.append(moments * beam.layout.compliances[:30, None])
    assert np.abs(found[0] - found[1]).max() < 1e-13 * np.abs(found[1]).max()


def test_settings_that_cannot_be_are_refused_in_one_line():
    for wrong, says in (
        ({"joints": "hinge"}, "ball, universal"),
        ({"segments": 1}, "between 2 and 400"),
        ({"segments": None}, "segments = None: must be a whole number"),
        ({"beam": "rod"}, "cannot resist twisting"),
        ({"beam": "cable"}, "'chain' or 'rod' in space"),
    ):
        with pytest.raises(InputError, match=says) as refused:
            SpatialSettings(**wrong)
        assert "\n" not in str(refused.value)
    with pytest.raises(InputError, match="cannot collide a line"):
        simulate_space(case_of("sphere", beam=Beam(radius=0.0)))


def test_a_divergence_names_its_station_and_keeps_the_others(monkeypatch):
    """MuJoCo's springs give NaN from the seventh station on."""
    sound, count, kept = mujoco.mj_forward, iter(range(10**9)), []

    def broken(model, data):
        sound(model, data)
        if next(count) >= 6:
            data.qfrc_passive[2] = np.nan

    monkeypatch.setattr(mujoco, "mj_forward", broken)
    with pytest.raises(
        DivergedError, match=r"diverged at station 7 of 20, travel = .*foot_z = .*: "
    ):
        simulate_space(case_of("sphere", 20), SpatialSettings(segments=8), keep=kept.append)
    assert kept[0].table["status"].tolist() == ["ok"] * 6 + ["diverged"]
    assert np.isnan(kept[0].values(*FORCE)[-1]).all()
