"""The three beams: convergence of the cantilever, agreement of the sweep, honest readings."""

from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pandas as pd
import pytest

from analytic import CASE_NAMES, InputError, named_case
from compare import compare
from mujoco_models import Settings, available_beams, load_tip, simulate_sweep
from mujoco_models.beams.chain import Chain
from tests.conftest import exact_sweep, simulated_sweep

BEAMS, LACKING = available_beams(), list(available_beams().missing)
SEGMENTS = np.array([10, 20, 40, 80])
EXACT = pd.read_csv(
    Path(__file__).parents[2] / "data" / "cantilever_tip_load.csv", index_col="PL2_EI"
)
# Tip error at N = 40 and P L^2/EI = 10, twice what was measured; the rod bends by tangents.
TIP_ERROR = {"chain": 3e-4, "cable": 5e-4, "rod": 7.5e-4}


def tip_errors(beam, clamp, load, springs="linear"):
    exact = EXACT.loc[load, ["w_over_L", "u_over_L"]].to_numpy()
    settings = [Settings(beam, int(n), clamp=clamp, springs=springs) for n in SEGMENTS]
    return np.array([np.linalg.norm(np.subtract(load_tip(load, s), exact)) for s in settings])


def order(errors):
    return -np.polyfit(np.log(SEGMENTS), np.log(errors), 1)[0]


@pytest.mark.parametrize("load", [1, 2, 5, 10])
@pytest.mark.parametrize("beam", BEAMS)
def test_cantilever_is_of_second_order(beam, load):
    errors = tip_errors(beam, "second-order", load)
    assert order(errors) >= 1.9
    assert errors[2] <= TIP_ERROR[beam]


@pytest.mark.parametrize(("load", "share"), [(1, 0.3), (2, 0.55), (5, 0.75), (10, 0.8)])
def test_arcs_leave_less(load, share):
    """Of the second order the pull along the beam is left, which grows with the load."""
    errors = tip_errors("chain", "second-order", load, "arc")
    assert order(errors) >= 1.9
    assert (errors < share * tip_errors("chain", "second-order", load)).all()


def test_a_closed_circle_of_arcs_is_exact():
    """Hinges that bend alike make links the sides about a circle, and the moment is its EI/R."""
    chain = Chain(Settings(segments=12, springs="arc"), spacing=1.0)
    turn = np.full(12, 2 * np.pi / 12)
    model = chain.spec(0.005).compile()
    data = mujoco.MjData(model)
    chain.place(data, turn)
    mujoco.mj_forward(model, data)
    circumscribed = 2 * np.tan(np.pi / 12) * 12
    np.testing.assert_allclose(-chain.moments(data.qfrc_passive), circumscribed, rtol=1e-3)


@pytest.mark.parametrize("load", [1, 2, 5, 10])
@pytest.mark.parametrize("beam", BEAMS)
def test_naive_clamp_is_of_first_order(beam, load):
    errors = tip_errors(beam, "naive", load)
    assert 0.9 <= order(errors) <= 1.2
    # Observed 50 (rod under 10, whose law errs most there) and more.
    assert errors[2] > 40 * tip_errors(beam, "second-order", load)[2]


@pytest.mark.slow
@pytest.mark.parametrize("name", CASE_NAMES)
@pytest.mark.parametrize("beam", [beam for beam in BEAMS if beam != "chain"])
def test_sweep_agrees_with_the_exact_solution(beam, name):
    """As the chain does by `sweep/test_chain_sweep.py`."""
    simulated = simulated_sweep(name, Settings(beam=beam))
    found = compare(exact_sweep(name), simulated)
    # Its tangent law stiffens the rod by (curvature h)^2/3, most where the sweep loads it most.
    limit = 2e-3 if beam == "rod" else 1.5e-3
    assert max(d.rms for d in found.disagreement.values()) <= limit
    assert abs(found.snap_off.difference) <= 1e-3
    assert (simulated.table["status"] == "ok").mean() >= 0.995


@pytest.mark.parametrize("beam", BEAMS)
def test_clamp_reads_what_holds_the_beam(beam):
    case = named_case("catenary")
    case = replace(case, sweep=replace(case.sweep, stations=40))
    table = simulate_sweep(case, Settings(beam=beam, segments=20, contour_points=400)).table
    assert table["force_y"].max() > 1
    assert table["discrepancy"].max() < 1e-7


@pytest.mark.parametrize("beam", LACKING)
def test_a_beam_of_another_version_is_refused(beam):
    with pytest.raises(InputError, match="install mujoco"):
        simulate_sweep(named_case("catenary"), Settings(beam=beam))


@pytest.mark.skipif("rod" in LACKING, reason="MuJoCo 4 only")
def test_rod_on_links_bends_as_a_flexcomp_does():
    """Moments of the flex bound to links are those of its forces on free vertices."""
    from mujoco_models.beams.rod import Rod

    rod = Rod(Settings(beam="rod", segments=8), spacing=1.0)
    radius = 0.005
    angles = np.linspace(-0.1, -0.4, 7)
    model = rod.spec(radius).compile()
    data = mujoco.MjData(model)
    rod.place(data, angles)
    mujoco.mj_forward(model, data)
    on_links = rod.moments(data.qfrc_passive)

    at = np.array([-rod.layout.joints[0], *rod.layout.joints, 1.0])
    free = mujoco.MjSpec.from_string(f"""
    <mujoco><worldbody><body name="foot">
      <flexcomp name="rod" type="direct" dim="1" radius="{radius}" mass="1"
          point="{" ".join(f"0 {y!r} 0" for y in at.tolist())}"
          element="{" ".join(f"{i} {i + 1}" for i in range(8))}">
        <pin id="0 1"/><elasticity young="{4 / (np.pi * radius**4)!r}"/>
        <contact contype="0" conaffinity="0" selfcollide="none"/>
      </flexcomp></body></worldbody></mujoco>""").compile()
    state = mujoco.MjData(free)
    heading = np.pi / 2 + np.cumsum(angles)
    edges = rod.layout.lengths[:, None] * np.column_stack(
        [np.cos(heading), np.sin(heading), np.zeros(7)]
    )
    vertices = np.vstack([[0, at[1], 0], edges]).cumsum(axis=0)
    slides = np.array(
        [free.joint(i).type[0] == mujoco.mjtJoint.mjJNT_SLIDE for i in range(free.njnt)]
    )
    offset = vertices[1:].copy()
    offset[:, 1] -= at[2:]
    state.qpos[slides] = offset.ravel()
    mujoco.mj_forward(free, state)
    forces = state.qfrc_passive[slides].reshape(-1, 3)
    on_vertices = [
        np.cross(vertices[j + 1 :] - vertices[j], forces[j:])[:, 2].sum() for j in range(7)
    ]
    np.testing.assert_allclose(on_links, on_vertices, rtol=1e-6)
