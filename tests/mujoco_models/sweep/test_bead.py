"""A chain that touches with one bead that slides along it."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import (
    CLAMP_READINGS,
    Beam,
    Case,
    InputError,
    Readings,
    Sweep,
    circle,
    named_case,
    polygon,
    solve_sweep,
)
from mujoco_models import Settings, simulate_sweep
from mujoco_models.sweep.bead.contour import Bead, Smooth, Way, contour_of
from mujoco_models.sweep.sweep import with_one_bead
from tests.mujoco_models.sweep.test_beyond_the_paper import case_of

ONE = Settings(touch="bead", segments=20)
BOWED = [[-1, 0.4], [0, 0.3999], [1, 0.4], [1, 2], [-1, 2]]


def off(case: Case, found: Readings) -> list[float]:
    """Rms of each reading from the closed form, over its largest magnitude."""
    exact = solve_sweep(case)
    ok = ((found.table["status"] == "ok") & (exact.table["status"] == "ok")).to_numpy()
    errors = []
    for name in CLAMP_READINGS:
        error = (found.table[name] - exact.table[name]).to_numpy()[ok]
        errors.append(float(np.sqrt(np.mean(error**2)) / exact.table[name].abs().max()))
    return errors


@pytest.mark.parametrize("obstacle", ["mesh", "primitive"])
@pytest.mark.parametrize("name", ["parabola", "tip-only"])
def test_agrees(name, obstacle):
    case = replace(named_case(name), sweep=Sweep(50))
    found = simulate_sweep(case, replace(ONE, obstacle=obstacle))
    assert (found.table["status"] == "ok").all()
    assert found.table["residual"].max() < 1e-8
    assert found.table["discrepancy"].max() < 1e-6
    assert max(off(case, found)) < 1.2e-3
    assert found.snap_off == pytest.approx(solve_sweep(case).snap_off, abs=2e-4)


def test_is_of_second_order():
    case = replace(named_case("parabola"), sweep=Sweep(50))
    settings = replace(ONE, obstacle="primitive")
    coarse, fine = (
        max(off(case, simulate_sweep(case, replace(settings, segments=n)))) for n in (20, 40)
    )
    assert coarse / fine == pytest.approx(4, rel=0.1)


def test_shares_no_load_so_that_softness_is_proportional():
    """Ten times as hard a contact leaves a tenth: there is no other bead to hand a load over to."""
    case = replace(named_case("parabola"), sweep=Sweep(20))
    settings = replace(ONE, obstacle="primitive")
    soft, hard, harder = (
        simulate_sweep(case, replace(settings, contact_stiffness=k)).table["force_y"].to_numpy()
        for k in (1e5, 1e6, 1e7)
    )
    touching = (hard != 0) & (soft != 0)
    ratio = np.abs(soft - hard)[touching].max() / np.abs(hard - harder)[touching].max()
    assert ratio == pytest.approx(10, rel=0.02)


@pytest.mark.parametrize("touch", ["bead", "beads"])
def test_sharp_ends_of_a_gently_bowed_side(touch):
    """Beads alone would hold the ends as if they were rough: 0.38 of a reading."""
    case = Case(beam=Beam(radius=1e-3), profile=polygon(np.array(BOWED)), sweep=Sweep(20))
    found = simulate_sweep(case, replace(ONE, touch=touch))
    assert (found.table["status"] == "ok").all()
    assert max(off(case, found)) < 4e-3


@pytest.mark.parametrize(
    "beam",
    [Beam(tip_radius=0.002), Beam(natural_curvature=-0.5)],
    ids=["cone", "curved away"],
)
def test_cones_and_curves(beam):
    case = replace(named_case("tip-only"), beam=beam, sweep=Sweep(20))
    found = simulate_sweep(case, ONE)
    assert (found.table["status"] == "ok").all()
    assert max(off(case, found)) < 3e-3


def test_an_elastic_clamp():
    case = replace(named_case("parabola"), clamp_stiffness=8.0, sweep=Sweep(20))
    assert max(off(case, simulate_sweep(case, ONE))) < 2e-3


@pytest.mark.parametrize("touch", ["bead", "beads"])
@pytest.mark.parametrize("segments", [3, 4, 5, 6])
def test_what_is_too_near_to_the_clamp_is_not_ok(touch, segments):
    low = Case(profile=circle(0.05, (0.0, 0.06)), sweep=Sweep(12))
    found = simulate_sweep(low, Settings(touch=touch, segments=segments))
    touching = (solve_sweep(low).table["phase"] != "free").to_numpy()
    assert (found.table["status"][touching] != "ok").all()
    assert sum(found.provenance["unsettled"].values()) >= touching.sum()


def test_not_out_of_the_plane():
    with pytest.raises(InputError, match="touch"):
        Settings(touch="bead", planar=False)


def test_the_turn_of_a_bead_on_facets_is_that_of_their_polygon():
    """By brute force: the first place on the offset polygon that is on the beam's line."""
    case = Case(profile=polygon(np.array([[-1, 1], [0, 0.4], [0.8, 0.7], [1, 1]])))
    contour = contour_of(with_one_bead(case, ONE).model.obstacle)
    start = Bead(0.0, 0.0, 0.39, 0.01)  # below the lowest vertex
    for way in (Way(2e-3, 0.004), Way(0.2, -0.5), Way(-0.2, -0.5), Way(0.003, -0.05)):
        found = contour.turn(start, way)
        if abs(found.by) < 0.3:
            assert found.along == pytest.approx(way.at_once + way.by_turn * found.by, abs=1e-12)
        assert found.by * way.at_once > 0


def test_the_turn_of_a_bead_on_a_circle():
    case = Case(profile=circle(1.0, (0.0, 0.4)))
    walk = with_one_bead(case, replace(ONE, obstacle="primitive"))
    contour = contour_of(walk.model.obstacle)
    assert isinstance(contour, Smooth)
    found = contour.turn(Bead(0.1, 0.0, 0.0, 0.005), Way(0.01, -0.5))
    assert found.by == pytest.approx(0.01 / 1.505, rel=1e-9)


def test_what_else_touches_is_noticed():
    """A vibrissa curved towards the object: just where the closed form has two contacts."""
    case = case_of("catenary", 0.5, stations=40)
    table = simulate_sweep(case, Settings(segments=20, contour_points=800, touch="bead")).table
    again = table["status"] == "touches again"
    assert again.sum() > 10
    assert (again == (solve_sweep(case).table["status"] == "touches again")).all()
    assert table.loc[again, "contact_x"].isna().all()
