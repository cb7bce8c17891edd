"""Corners: what two polygons can touch each other with, and nothing held that should slide."""

import mujoco
import numpy as np
import pandas as pd
import pytest
import trimesh
from scipy.optimize import brentq

from analytic import CLAMP_READINGS, Beam, Case, Sweep, mesh_section, polygon, solve_sweep
from compare import compare
from mujoco_models import Settings, available_beams, simulate_sweep
from mujoco_models.obstacles.corners import Corners, upright
from mujoco_models.obstacles.kinds import place
from mujoco_models.sweep.sweep import set_out


def regular(corners, radius=0.5, lowest=0.4):
    """The lower half of a regular polygon."""
    angle = np.linspace(-np.pi / 2, np.pi / 2, corners // 2 + 1)
    return polygon(np.column_stack([radius * np.sin(angle), lowest + radius * (1 - np.cos(angle))]))


SQUARE = polygon([(-0.3, 1.0), (-0.3, 0.4), (0.3, 0.4), (0.3, 1.0)])
TRIANGLE = polygon([(-0.6, 0.9), (0.0, 0.35), (0.6, 0.9)])
STEEP = polygon([(-0.25, 0.75), (-0.1, 1.1), (-0.2, 1.2)])  # its lower side is one facet
BLADE = polygon([(-0.57, 0.31), (0.51, 1.08), (-0.33, 0.98)])  # the same, past which it goes far
LEANING = polygon([(-0.5, 0.75), (-0.1, 0.35), (0.3, 0.45), (0.45, 0.9)])


def errors(profile, segments, beam="chain", stations=40):
    """Of each reading at each station in contact, over its largest magnitude, shape (3, n)."""
    case = Case(profile=profile, sweep=Sweep(stations=stations))
    simulated = simulate_sweep(case, Settings(beam=beam, segments=segments))
    assert (simulated.table["status"] == "ok").all()
    found = compare(solve_sweep(case), simulated)
    table = found.alignment.table
    return np.array(
        [
            (table[f"{name}_candidate"] - table[f"{name}_reference"])
            / found.disagreement[name].scale
            for name in CLAMP_READINGS
        ]
    )


def disagreement(profile, segments, jumped=0, **options):
    """The worst reading's rms, without so many stations at which the sweeps are a facet apart.

    Past a polygon the contact jumps from corner to corner, where its equilibrium folds; there a
    coarse beam is some 1e-3 L early or late.
    """
    error = np.sort(np.abs(errors(profile, segments, **options)), axis=1)
    kept = error[:, : error.shape[1] - jumped]
    return float(np.sqrt(np.mean(kept**2, axis=1)).max())


@pytest.mark.parametrize(
    "profile",
    [
        SQUARE,
        *(
            pytest.param(p, marks=pytest.mark.slow)
            for p in (TRIANGLE, STEEP, BLADE, LEANING, regular(24))
        ),
    ],
)
def test_polygons_are_as_good_as_smooth_contours(profile):
    # 3/N^2, as past a smooth contour; two beads that hold a corner were off by 5e-2 to 1e-1.
    assert disagreement(profile, 20) < 3 / 20**2


def test_sharp_ends_of_a_gently_bowed_side():
    """Beads alone would hold the ends as if they were rough: 0.38 of a reading."""
    bowed = polygon(np.array([[-1, 0.4], [0, 0.3999], [1, 0.4], [1, 2], [-1, 2]]))
    assert np.sqrt(np.mean(errors(bowed, 20, stations=20) ** 2, axis=1)).max() < 4e-3


@pytest.mark.slow
@pytest.mark.parametrize("beam", [available_beams()[0], available_beams()[1]])
@pytest.mark.parametrize("profile", [SQUARE, TRIANGLE], ids=["square", "triangle"])
def test_the_order_is_two(profile, beam):
    """At every station, in every reading: none of them jumps here, and none is left out."""
    segments = np.array([20, 40, 80, 160])
    found = [errors(profile, int(n), beam, stations=60) for n in segments]
    rms = np.array([np.sqrt(np.mean(error**2, axis=1)) for error in found])
    largest = np.array([np.abs(error).max(axis=1) for error in found])
    for error in (rms, largest):
        order = -np.polyfit(np.log(segments), np.log(error), 1)[0]
        # Observed 1.8 to 2.1, of MuJoCo 3's cable 1.70: with each number of segments the corner is
        # at another place between two joints, and from one to the next the order is 1.5 to 2.6.
        assert (order > 1.65).all()
        assert (error[1:] < error[:-1]).all()
    assert (rms[1] < 1e-3).all()  # observed 6e-4
    assert (rms[-1] < 5e-5).all()  # observed 3.4e-5
    assert (largest[-1] < 2e-4).all()  # observed 1.0e-4


@pytest.mark.parametrize("stiffness", [1e5, 1e7])
@pytest.mark.parametrize("beam", [available_beams()[0], available_beams()[1]])
def test_a_corner_slides_past_a_joint(beam, stiffness):
    """There three geoms reach it: two links and the bead between them; one of them carries it.

    If all three did, they would hold it: by 4e-3 of a force at 1e7, by more at 1e5.
    """
    case = Case(profile=SQUARE, sweep=Sweep(stations=60))
    walk = set_out(case, Settings(beam=beam, segments=40, contact_stiffness=stiffness))
    joints = walk.model.layout.joints
    joint = joints[np.searchsorted(joints, 0.65)]

    def row(foot_x):
        walk.go_to(float(foot_x))
        return walk.row()

    def beyond(foot_x):
        return row(foot_x)["contact_arc_length"] - joint

    for foot_x in case.foot_x[:13]:  # up to where the corner is nearest to the clamp
        walk.go_to(float(foot_x))
    here = brentq(beyond, case.foot_x[13], case.foot_x[28], xtol=1e-7)
    feet = here + np.linspace(4e-4, -4e-4, 41)
    table = pd.DataFrame([row(foot_x) for foot_x in feet])
    assert (table["status"] == "ok").all()
    assert np.ptp(table["contact_arc_length"]) < 1e-3
    for name in CLAMP_READINGS:
        line = np.polyval(np.polyfit(feet - here, table[name], 1), feet - here)
        assert np.abs(table[name] - line).max() < 2e-4 * np.abs(table[name]).max(), name


@pytest.mark.slow
@pytest.mark.parametrize("corners", [5, 48])
def test_any_number_of_corners(corners):
    rng = np.random.default_rng(corners)
    angle = np.sort(rng.uniform(-np.pi / 2, np.pi / 2, corners))
    points = np.column_stack([0.6 * np.sin(angle), 0.9 - 0.5 * np.cos(angle)])
    assert disagreement(polygon(points), 40, jumped=2) < 3 / 40**2


TWELVE = polygon(
    [(-0.1681, 1.3834), (-0.1058, 0.7262), (-0.1028, 0.7174), (-0.0962, 0.6994),
     (-0.0661, 0.6375), (-0.0177, 0.5911), (-0.0048, 0.5882), (0.0224, 0.5942),
     (0.0254, 0.5959), (0.1201, 0.7797), (0.1501, 0.932), (0.1709, 1.1906)]
)  # fmt: skip


def test_a_tip_stays_on_its_facet_as_long_as_that_holds_it():
    """A long step of the foot finds it at rest on the next facet, too: 0.6 of a force off."""
    error = np.abs(errors(TWELVE, 40, stations=60))
    assert error.max() < 6 / 40**2  # the discretisation's, with a margin of ten


def test_a_link_that_cuts_a_corner_off_is_seen():
    obstacle = place(Case(profile=SQUARE), Settings())
    outside = np.array([[0.31, 0.0], [0.31, 0.9]])
    assert not obstacle.is_cut(outside)
    assert obstacle.is_cut(np.array([[0.31, 0.3], [0.2, 0.6]]))  # into the body
    assert obstacle.is_cut(np.array([[0.4, 0.45], [0.2, 0.39]]))  # across the corner
    assert not obstacle.is_cut(np.array([[0.4, 0.35], [0.2, 0.39]]))  # below it


def test_a_place_is_outside_of_the_object_whose_edge_it_meets():
    """Before another one's corner it may well be."""
    low = np.array([(-0.6, 0.9), (0.0, 0.35), (0.6, 0.9)])
    moved = [low + np.array([x, 0]) for x in (0, 3)]
    parts = [Corners.of(place, upright(place, 0.1), 1e-3, (False, False)) for place in moved]
    both = Corners.of_all(parts)
    edge = int(np.flatnonzero(both.of_object == 0)[0])
    inside, below = np.array([0.0, 0.7, 0.0]), np.array([0.0, 0.3, 0.0])
    assert not parts[0].in_front(inside, 0) and not both.in_front(inside, edge)
    assert both.in_front(below, edge)
    assert both.in_front(inside, len(parts[0]))  # of the other


def test_fine_polygons_keep_their_beads():
    """Where no corner turns by more than 2e-3 rad."""
    assert len(place(Case(profile=regular(4000, 1.0)), Settings()).corners) == 0
    assert len(place(Case(profile=regular(1000, 1.0)), Settings()).corners) > 0


@pytest.mark.slow
@pytest.mark.parametrize("beam", sorted({"chain", "rod"} & set(available_beams())))
def test_the_tip_comes_round_an_edge_that_leans(beam, tmp_path):
    """The normal turns slower there than at an upright edge, and more the deeper the tip is."""
    trimesh.creation.icosphere(subdivisions=1, radius=0.3209).export(tmp_path / "ball.stl")
    ball = mesh_section(tmp_path / "ball.stl", height=0.05, offset=(0.0, 1.1248))
    case = Case(Beam(radius=1.92e-3), ball, Sweep(stations=12))
    found = simulate_sweep(case, Settings(segments=11, beam=beam, contact_stiffness=1.4e4))
    assert (found.table["status"] == "ok").all()
    assert found.snap_off == pytest.approx(solve_sweep(case).snap_off, abs=0.02)  # 3/N^2


@pytest.mark.parametrize(
    "profile", [*(pytest.param(p, marks=pytest.mark.slow) for p in (SQUARE, LEANING)), regular(24)]
)
def test_links_that_are_not_searched_have_no_contact(profile):
    """Bent at random, near the object and far from it, some of them right through it."""
    case = Case(profile=profile, sweep=Sweep(stations=60))
    model = set_out(case, Settings(segments=30)).model
    draw = np.random.default_rng(1)
    touched = 0
    for _ in range(400):
        bends = draw.normal(scale=0.05, size=30) + draw.normal(scale=0.05)
        model.imbalance(case.poses.at(draw.uniform(-1.5, 1.5, ())), bends)
        found = [contact.geom.tolist() for contact in model.data.contact]
        mujoco.mj_collision(model.model, model.data)
        assert found == [contact.geom.tolist() for contact in model.data.contact]
        touched += len(found) > 0
    assert touched > 50
