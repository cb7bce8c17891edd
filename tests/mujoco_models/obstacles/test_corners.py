"""Corners: what two polygons can touch each other with, and nothing held that should slide."""

import numpy as np
import pytest
import trimesh

from analytic import CLAMP_READINGS, Case, Sweep, mesh_section, polygon, solve_sweep
from compare import compare
from mujoco_models import Settings, simulate_sweep
from mujoco_models.obstacles.kinds import place


def regular(corners, radius=0.5, lowest=0.4):
    """The lower half of a regular polygon."""
    angle = np.linspace(-np.pi / 2, np.pi / 2, corners // 2 + 1)
    return polygon(np.column_stack([radius * np.sin(angle), lowest + radius * (1 - np.cos(angle))]))


SQUARE = polygon([(-0.3, 1.0), (-0.3, 0.4), (0.3, 0.4), (0.3, 1.0)])
TRIANGLE = polygon([(-0.6, 0.9), (0.0, 0.35), (0.6, 0.9)])
LEANING = polygon([(-0.5, 0.75), (-0.1, 0.35), (0.3, 0.45), (0.45, 0.9)])


def disagreement(profile, segments, beam="chain", stations=40, jumped=0):
    """The worst reading's rms, without so many stations at which the sweeps are a facet apart.

    Past a polygon the contact jumps from corner to corner, where its equilibrium folds; there a
    coarse beam is some 1e-3 L early or late.
    """
    case = Case(profile=profile, sweep=Sweep(stations=stations))
    simulated = simulate_sweep(case, Settings(beam=beam, segments=segments))
    assert (simulated.table["status"] == "ok").all()
    found = compare(solve_sweep(case), simulated)
    if jumped == 0:
        return max(found.disagreement[name].rms for name in CLAMP_READINGS)
    table = found.alignment.table
    errors = [
        (table[f"{name}_candidate"] - table[f"{name}_reference"]) / found.disagreement[name].scale
        for name in CLAMP_READINGS
    ]
    worst = np.sort(np.abs(errors), axis=1)[:, : len(table) - jumped]
    return float(np.sqrt(np.mean(worst**2, axis=1)).max())


@pytest.mark.parametrize(
    "profile",
    [SQUARE, *(pytest.param(p, marks=pytest.mark.slow) for p in (TRIANGLE, LEANING, regular(24)))],
)
def test_polygons_are_as_good_as_smooth_contours(profile):
    # 3/N^2, as past a smooth contour; two beads that hold a corner were off by 5e-2 to 1e-1.
    assert disagreement(profile, 20) < 3 / 20**2


@pytest.mark.slow
def test_the_order_is_two():
    """But for stations at which a joint's sphere is within 1e-4 L of the corner.

    There the sphere carries a part of the load with a normal of its own, and holds the corner a
    little: by up to 4e-3 of a force, at 2 of these 60 stations at N = 160.
    """
    segments = np.array([20, 40, 80, 160])
    errors = [disagreement(SQUARE, int(n), stations=60, jumped=3) for n in segments]
    order = -np.polyfit(np.log(segments), np.log(errors), 1)[0]
    assert order > 1.8  # observed 2.1
    assert errors[1] < 8e-4  # observed 5e-4
    assert errors[-1] < 5e-5  # observed 2.4e-5


@pytest.mark.slow
@pytest.mark.parametrize("corners", [3, 5, 12, 48, 200])
def test_any_number_of_corners(corners):
    rng = np.random.default_rng(corners)
    angle = np.sort(rng.uniform(-np.pi / 2, np.pi / 2, corners))
    points = np.column_stack([0.6 * np.sin(angle), 0.9 - 0.5 * np.cos(angle)])
    assert disagreement(polygon(points), 40, jumped=2) < 3 / 40**2


@pytest.mark.slow
@pytest.mark.parametrize("make", ["box", "icosphere"])
def test_meshes_with_edges(make, tmp_path):
    mesh = {
        "box": trimesh.creation.box((1, 1, 1)),
        "icosphere": trimesh.creation.icosphere(3, radius=0.5),
    }[make]
    mesh.export(tmp_path / "body.stl")
    profile = mesh_section(tmp_path / "body.stl", offset=(0.0, 0.9))
    assert len(place(Case(profile=profile), Settings()).corners) > 0
    assert disagreement(profile, 20, jumped=1) < 3 / 20**2


def test_a_link_that_cuts_a_corner_off_is_seen():
    obstacle = place(Case(profile=SQUARE), Settings())
    outside = np.array([[0.31, 0.0], [0.31, 0.9]])
    assert not obstacle.is_cut(outside)
    assert obstacle.is_cut(np.array([[0.31, 0.3], [0.2, 0.6]]))  # into the body
    assert obstacle.is_cut(np.array([[0.4, 0.45], [0.2, 0.39]]))  # across the corner
    assert not obstacle.is_cut(np.array([[0.4, 0.35], [0.2, 0.39]]))  # below it


def test_fine_polygons_keep_their_beads():
    """Where no corner turns by more than 2e-3 rad."""
    assert len(place(Case(profile=regular(4000, 1.0)), Settings()).corners) == 0
    assert len(place(Case(profile=regular(1000, 1.0)), Settings()).corners) > 0
